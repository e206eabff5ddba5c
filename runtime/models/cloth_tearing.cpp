#include "models/cloth_tearing.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "base/log.h"
#include "models/air.h"
#include "models/bodies.h"
#include "models/soft_reading.h"
#include "models/tethers.h"
#include "sleep/wake.h"
#include "state/mesh_edges.h"
#include "threads/gather.h"

namespace taut {
namespace {

// Of an edge of a triangle, from its corner k to the next: length over that at rest, less 1.
double strain_of(const World& world, const Soft& soft, uint32_t triangle, uint32_t k, const double (&rest)[3]) {
    const uint32_t* corner = &soft.triangle[3 * size_t{triangle}];
    return (vertex_of(world, soft, corner[(k + 1) % 3]) - vertex_of(world, soft, corner[k])).norm() / rest[k] - 1;
}

bool is_stretched(const World& world, const Soft& soft, uint32_t triangle) {
    const auto sleeps = [&](uint32_t k) { return world.nodes.sleeps(soft.node[soft.triangle[3 * triangle + k]]); };
    if (sleeps(0) || sleeps(1) || sleeps(2)) return false;
    double rest[3];
    rest_edges(soft, triangle, rest);
    bool any = false;
    for (uint32_t k = 0; k < 3; ++k) any = any || strain_of(world, soft, triangle, k, rest) > soft.tear_strain;
    return any;
}

double area_of(const Soft& soft, uint32_t triangle) {
    const double* g = &soft.rest[6 * size_t{triangle}];
    return 0.5 / std::abs(g[2] * g[5] - g[3] * g[4]);
}

// One step's tears of one cloth. Each is told by the mesh as the step found it: they keep apart by a ring of triangles.
class Tearing {
public:
    Tearing(World& world, uint32_t index)
        : world_(world),
          index_(index),
          soft_(world.softs.record[index]),
          edges_(world.memory),
          edge_at_(world.memory),
          begins_(world.memory),
          ring_begin_(world.memory),
          ring_(world.memory),
          touched_(world.memory),
          stretched_(world.memory),
          cut_(world.memory),
          parts_(world.memory),
          moved_(world.memory) {}

    void run() {
        find_mesh();
        find_stretched();
        for (const Stretched& each : stretched_) tear_at(each);
        if (!stretched_.empty()) renumber();
    }

private:
    // Edges have other numbers from now on, by which contacts know each other again.
    void renumber() {
        soft_.mesh_version = ++world_.softs.version;
        std::erase_if(world_.pairs.surfaces.contact, [&](const SurfaceContact& contact) {
            return std::ranges::any_of(
                contact.node, [&](uint32_t node) { return node != kNone && world_.nodes.info[node].soft == index_; });
        });
        ++world_.pairs.surfaces.version;
    }

    struct Stretched {
        double strain;
        uint32_t edge;
    };
    // A new vertex: what of an old one some of its triangles take along.
    struct Part {
        uint32_t of;
        double mass = 0;  // [kg]
        uint32_t node = kNone;
    };
    struct Moved {
        uint32_t corner, part;
    };

    uint32_t triangles() const { return soft_.triangles(); }
    std::span<const uint32_t> ring(uint32_t vertex) const {
        return {&ring_[ring_begin_[vertex]], ring_begin_[vertex + 1] - ring_begin_[vertex]};
    }
    uint32_t corner_at(uint32_t t, uint32_t vertex) const {
        const uint32_t* corner = &soft_.triangle[3 * size_t{t}];
        return static_cast<uint32_t>(std::find(corner, corner + 3, vertex) - corner);
    }
    static uint32_t next(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    // Of a triangle's two edges at its corner k.
    uint32_t edge_beside(uint32_t t, uint32_t k, bool before) const {
        return edge_at_[3 * t + (before ? (k + 2) % 3 : k)];
    }
    bool is_pinned(uint32_t vertex) const { return taut::is_pinned(world_, soft_, vertex); }

    void find_mesh() {
        find_edges(soft_.triangle, edges_);
        edge_at_.assign(soft_.triangle.size(), kNone);
        begins_.assign(2 * edges_.size(), kNone);
        for (uint32_t e = 0; e < edges_.size(); ++e) {
            const MeshEdge& edge = edges_[e];
            for (uint32_t side = 0; side < 2 && edge.triangle[side] != kNone; ++side) {
                const uint32_t t = edge.triangle[side];
                begins_[2 * e + side] = 3 * t + corner_at(t, side == 0 ? edge.a : edge.b);
                edge_at_[begins_[2 * e + side]] = e;
            }
        }
        const uint32_t vertices = soft_.vertices();
        ring_begin_.assign(vertices + 1, 0);
        for (const uint32_t vertex : soft_.triangle) ++ring_begin_[vertex + 1];
        for (uint32_t v = 0; v < vertices; ++v) ring_begin_[v + 1] += ring_begin_[v];
        ring_.resize(soft_.triangle.size());
        Array<uint32_t> to(ring_begin_);
        for (uint32_t i = 0; i < soft_.triangle.size(); ++i) ring_[to[soft_.triangle[i]]++] = i / 3;
        touched_.assign(vertices, 0);
    }

    void find_stretched() {
        for (uint32_t e = 0; e < edges_.size(); ++e) {
            const uint32_t t = edges_[e].triangle[0];
            double rest[3];
            rest_edges(soft_, t, rest);
            const double strain = strain_of(world_, soft_, t, begins_[2 * e] - 3 * t, rest);
            if (strain > soft_.tear_strain) stretched_.push_back({strain, e});
        }
        std::ranges::sort(stretched_, [](const Stretched& a, const Stretched& b) {
            return a.strain != b.strain ? a.strain > b.strain : a.edge < b.edge;
        });
    }

    // Whether nothing about a vertex is part of a tear of this step, whose load is not known yet.
    bool may_tear(uint32_t vertex) const {
        return !is_pinned(vertex) && std::ranges::none_of(ring(vertex), [&](uint32_t t) {
            const uint32_t* corner = &soft_.triangle[3 * size_t{t}];
            return touched_[corner[0]] || touched_[corner[1]] || touched_[corner[2]];
        });
    }

    // Whether a triangle lies on the side of a vertex to which `along` points.
    bool is_ahead(uint32_t t, uint32_t vertex, const Vec3& along) const {
        Vec3 middle = Vec3::Zero();
        for (uint32_t k = 0; k < 3; ++k) middle += vertex_of(world_, soft_, soft_.triangle[3 * t + k]);
        return (middle / 3 - vertex_of(world_, soft_, vertex)).dot(along) > 0;
    }

    // Edges at a vertex between triangles ahead of it and behind it, into out; their length at rest together [m].
    double find_cut(uint32_t vertex, const Vec3& along, Array<uint32_t>& out) const {
        out.clear();
        double length = 0;
        for (const uint32_t t : ring(vertex)) {
            const uint32_t k = corner_at(t, vertex);
            double rest[3];
            rest_edges(soft_, t, rest);
            for (const bool before : {false, true}) {
                const uint32_t e = edge_beside(t, k, before);
                const uint32_t* sides = edges_[e].triangle;
                if (sides[1] == kNone || sides[0] != t) continue;
                if (is_ahead(sides[0], vertex, along) == is_ahead(sides[1], vertex, along)) continue;
                out.push_back(e);
                length += rest[before ? (k + 2) % 3 : k];
            }
        }
        return length;
    }

    void tear_at(const Stretched& stretched) {
        const MeshEdge& edge = edges_[stretched.edge];
        const Vec3 along = vertex_of(world_, soft_, edge.b) - vertex_of(world_, soft_, edge.a);
        double least = 0;
        uint32_t at = kNone;
        Array<uint32_t> cut(world_.memory);
        for (const uint32_t end : {std::min(edge.a, edge.b), std::max(edge.a, edge.b)}) {
            if (!may_tear(end)) continue;
            const double length = find_cut(end, along, cut);
            if (cut.empty() || (at != kNone && length >= least)) continue;
            least = length;
            at = end;
            cut_.swap(cut);
        }
        if (at == kNone) return;
        split(at);
        if (!parts_.empty() && has_room()) commit(stretched);
    }

    bool is_cut(uint32_t edge) const { return std::ranges::find(cut_, edge) != cut_.end(); }

    // The vertices of the cut, and what becomes of their triangles.
    void split(uint32_t at) {
        parts_.clear();
        moved_.clear();
        Array<uint32_t> ends(world_.memory);
        ends.push_back(at);
        for (const uint32_t e : cut_) ends.push_back(edges_[e].a == at ? edges_[e].b : edges_[e].a);
        std::sort(ends.begin() + 1, ends.end());
        for (const uint32_t vertex : ends) find_fans(vertex);
    }

    // Fans of a vertex's triangles, of which the first keeps it.
    void find_fans(uint32_t vertex) {
        const auto all = ring(vertex);
        Array<uint32_t> fan(all.size(), kNone, world_.memory), queue(world_.memory);
        double whole = 0;
        for (const uint32_t t : all) whole += area_of(soft_, t);
        for (uint32_t first = 0, count = 0; first < all.size(); ++first) {
            if (fan[first] != kNone) continue;
            queue.assign(1, first);
            fan[first] = count;
            double area = 0;
            for (size_t i = 0; i < queue.size(); ++i) {
                const uint32_t t = all[queue[i]], k = corner_at(t, vertex);
                area += area_of(soft_, t);
                if (count > 0) moved_.push_back({3 * t + k, static_cast<uint32_t>(parts_.size())});
                for (const bool before : {false, true}) {
                    const uint32_t e = edge_beside(t, k, before);
                    if (edges_[e].triangle[1] == kNone || is_cut(e)) continue;
                    const uint32_t other = edges_[e].triangle[edges_[e].triangle[0] == t];
                    const auto place = static_cast<uint32_t>(std::ranges::find(all, other) - all.begin());
                    if (fan[place] != kNone) continue;
                    fan[place] = count;
                    queue.push_back(place);
                }
            }
            if (count++ > 0) parts_.push_back({vertex, area / whole * soft_.mass[vertex], kNone});
        }
    }

    bool has_room() const {
        const auto fits = [&](const IdPool& ids, uint32_t most) {
            return ids.slots() + parts_.size() < kMaxSlots && (most == 0 || ids.count() + parts_.size() <= most);
        };
        return soft_.vertices() + parts_.size() <= TAUT_DEFORMABLE_MAX &&
               fits(world_.nodes.ids, world_.def.max_bodies) && fits(world_.colliders.ids, world_.def.max_colliders);
    }

    // ---------------------------------------------------------------- what changes

    // Throws std::bad_alloc with nothing changed.
    void commit(const Stretched& stretched) {
        const uint32_t before = soft_.vertices();
        TetherPlan tethers(world_.memory);
        try {
            reserve();
            for (Part& part : parts_) part.node = add_part(part);
            take_corners(before);
            plan_tethers(world_, soft_, kNone, false, tethers);
        } catch (...) {
            give_back(before);
            throw;
        }
        for (const Part& part : parts_) {
            soft_.mass[part.of] -= part.mass;
            weigh(part.of);
        }
        retie();
        set_tethers(world_, soft_, tethers);
        tell(stretched, before);
        for (const Part& part : parts_) wake(world_, soft_.node[part.of]);
    }

    void reserve() {
        const auto count = static_cast<uint32_t>(parts_.size()), cuts = static_cast<uint32_t>(cut_.size());
        reserve_more(world_.torn, count);
        reserve_more(soft_.node, count);
        reserve_more(soft_.mass, count);
        reserve_more(soft_.corner, 2 * soft_.sets.size() * cuts);
        for (const SoftSet& each : soft_.sets)
            if (each.part != SoftPart::tether) reserve_elements(world_.elements.set[each.set], cuts);
        world_.nodes.mass.reserve_values(2 * count);
    }

    uint32_t add_part(const Part& part) {
        const uint32_t from = soft_.node[part.of];
        Nodes& nodes = world_.nodes;
        NodeMass mass = nodes.mass[from];
        if (mass.mass > 0) mass.mass = part.mass, mass.inv_mass = 1 / part.mass;
        ColliderPlan sphere;
        const uint32_t collider = nodes.info[from].collider;
        if (collider != kNone) {
            static_cast<Collider&>(sphere) = world_.colliders.record[collider];
            sphere.traits = world_.colliders.traits[collider];
        }
        const NodeInfo info = nodes.info[from];
        const NodeMotion motion = nodes.motion[from];
        const uint32_t node = add_node(world_, info, motion, mass, {&sphere, collider != kNone ? 1u : 0u});
        nodes.before[node] = nodes.before[from];
        if (!nodes.history.empty()) nodes.history[node] = nodes.history[from];
        return node;
    }

    void take_corners(uint32_t before) {
        for (const Part& part : parts_) {
            soft_.node.push_back(part.node);
            soft_.mass.push_back(part.mass);
        }
        for (const Moved& each : moved_) soft_.triangle[each.corner] = before + each.part;
    }

    void give_back(uint32_t before) {
        for (const Moved& each : moved_) soft_.triangle[each.corner] = parts_[each.part].of;
        soft_.node.resize(before);
        soft_.mass.resize(before);
        for (const Part& part : parts_)
            if (part.node != kNone) drop_node(world_, part.node);  // no pairs yet: does not throw
    }

    void weigh(uint32_t vertex) {
        const uint32_t node = soft_.node[vertex];
        NodeMass mass = world_.nodes.mass[node];
        if (mass.mass == 0) return;
        mass.mass = soft_.mass[vertex];
        mass.inv_mass = 1 / mass.mass;
        world_.nodes.mass.set(node, mass);
    }

    // Elements go with the corners of their triangles.
    void retie() {
        size_t end = 0;
        for (const SoftSet& each : soft_.sets) {
            if (each.part == SoftPart::tether) continue;
            ElementSet& set = world_.elements.set[each.set];
            const auto nodes = static_cast<uint32_t>(set.type->row.nodes);
            const size_t first = end;
            end += size_t{set.size()} * nodes;
            for (uint32_t e = set.size(); e-- > 0;) {
                uint32_t* corner = &soft_.corner[first + size_t{e} * nodes];
                if (crosses({corner, nodes})) {
                    world_.elements.erase(set, e);
                    const auto at = soft_.corner.begin() + (corner - soft_.corner.data());
                    soft_.corner.erase(at, at + nodes);
                    end -= nodes;
                    continue;
                }
                uint32_t node[kMaxNodes];
                for (uint32_t n = 0; n < nodes; ++n) node[n] = soft_.node[soft_.triangle[corner[n]]];
                world_.elements.tie(set, e, {node, nodes});
                if (nodes == 2 && corner[0] / 3 == corner[1] / 3) end += halve(set, e, corner, end);
            }
        }
    }

    // Whether an element goes from one triangle to another across the cut: its last two nodes, of links and of bends,
    // are those that the edge does not have.
    bool crosses(std::span<const uint32_t> corner) const {
        const size_t n = corner.size();
        return n != 3 && std::ranges::any_of(cut_, [&](uint32_t e) {
                   const uint32_t a = next(next(begins_[2 * e])), b = next(next(begins_[2 * e + 1]));
                   return (corner[n - 2] == a && corner[n - 1] == b) || (corner[n - 2] == b && corner[n - 1] == a);
               });
    }

    // A link along the cut becomes one of half its stiffness on either side; what it carries is shared. How many
    // corners the set's list, which ends there, has gained.
    size_t halve(ElementSet& set, uint32_t e, const uint32_t* corner, size_t end) {
        const bool turned = next(corner[0]) != corner[1];
        const uint32_t begin = turned ? corner[1] : corner[0], edge = edge_at_[begin];
        if (!is_cut(edge)) return 0;
        const uint32_t other = begins_[2 * edge + (begins_[2 * edge] == begin)];
        const uint32_t twin[2] = {turned ? other : next(other), turned ? next(other) : other};
        const uint32_t node[2] = {soft_.node[soft_.triangle[twin[0]]], soft_.node[soft_.triangle[twin[1]]]};
        const uint32_t last = set.size();
        set.softness[e] *= 2;
        world_.elements.insert(set, last, node, set.softness[e]);
        std::copy_n(set.data_of(e), set.type->numbers, set.data_of(last));
        *set.lambda_of(e) *= 0.5;
        *set.lambda_of(last) = *set.lambda_of(e);
        set.fresh[last] = set.fresh[e];
        if (!set.slow_turn.empty()) set.slow_turn[last] = set.slow_turn[e];
        if (set.pulls) {
            set.memory[e].upper *= 0.5f;
            set.memory[last] = set.memory[e];
        }
        soft_.corner.insert(soft_.corner.begin() + static_cast<ptrdiff_t>(end), twin, twin + 2);
        return 2;
    }

    void tell(const Stretched& stretched, uint32_t before) {
        const MeshEdge& edge = edges_[stretched.edge];
        for (uint32_t i = 0; i < parts_.size(); ++i) {
            world_.torn.push_back({world_.cloth_handle(index_),
                                   soft_.user_data,
                                   {edge.a, edge.b},
                                   parts_[i].of,
                                   before + i,
                                   static_cast<float>(stretched.strain),
                                   world_.window.steps});
            // What these had as the step began, and what is about it.
            for (const uint32_t t : ring(parts_[i].of))
                for (uint32_t k = 0; k < 3; ++k)
                    if (const uint32_t v = soft_.triangle[3 * t + k]; v < touched_.size()) touched_[v] = 1;
            touched_[parts_[i].of] = 1;
        }
    }

    World& world_;
    uint32_t index_;
    Soft& soft_;
    Array<MeshEdge> edges_;              // of the mesh as the step found it
    Array<uint32_t> edge_at_;            // of each corner: that from there to the next
    Array<uint32_t> begins_;             // [2] of each edge: corners from which its triangles go along it
    Array<uint32_t> ring_begin_, ring_;  // of each vertex: its triangles, in ascending order
    Array<uint8_t> touched_;             // by vertex: beside a tear of this step
    Array<Stretched> stretched_;
    Array<uint32_t> cut_;  // edges of the tear that is made
    Array<Part> parts_;
    Array<Moved> moved_;
};

}  // namespace

namespace {

// A closed cloth that tears loses what is within; air goes by the new triangles, or by the old where memory fails.
void open_air(World& world, Soft& soft) {
    soft.air.pressure = soft.air.gas = 0;
    if (!soft.air.any()) return;
    try {
        list_surface(soft, soft.vertices());
    } catch (const std::bad_alloc&) {
        log_line(world.def.hooks, TAUT_LOG_WARNING, "air acts on a torn cloth as if it were whole: out of memory");
    }
}

}  // namespace

void tear_cloths(World& world) {
    for (uint32_t index = 0; index < world.softs.ids.slots(); ++index) {
        if (!world.softs.ids.live(index)) continue;
        Soft& soft = world.softs.record[index];
        if (!(soft.tear_strain > 0)) continue;
        const uint32_t vertices = soft.vertices();
        gather(world.team, soft.triangles(), world.pairs.picked,
               [&](uint32_t t) { return is_stretched(world, soft, t); });
        if (world.pairs.picked.empty()) continue;
        try {
            Tearing(world, index).run();
        } catch (const std::bad_alloc&) {
            log_line(world.def.hooks, TAUT_LOG_WARNING, "a cloth did not tear: out of memory");
        }
        if (soft.vertices() > vertices) open_air(world, soft);
    }
}

}  // namespace taut
