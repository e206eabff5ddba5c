#include "detect/obstacles.h"

#include <algorithm>
#include <utility>

#include "detect/surfaces.h"

namespace taut {
namespace {

bool is_obstacle(const Nodes& nodes, const Collider& collider) {
    if (collider.node == kNone || collider.sensor || collider.node_b != kNone) return false;
    if (!nodes.enabled(collider.node)) return false;
    const NodeKind kind = nodes.info[collider.node].kind;
    return (kind == NodeKind::fixed || kind == NodeKind::kinematic) && nodes.info[collider.node].soft == kNone;
}

// Box of a shape's box, turned.
void find_box(const collision::Box& box, Obstacle& out) {
    const Vec3 half = 0.5 * (box.hi - box.lo).cast<double>(), middle = 0.5 * (box.hi + box.lo).cast<double>();
    const Vec3 reach = out.rotation.cwiseAbs() * half, at = out.position + out.rotation * middle;
    out.lo = at - reach;
    out.hi = at + reach;
}

// ---------------------------------------------------------------- soft bodies

// Where it is and, as it moves now, goes in the frame [m].
collision::ItemBox swept_box(const ObstacleScene& scene, const Soft& soft) {
    collision::ItemBox box;
    for (const uint32_t node : soft.node) {
        const NodeMotion& motion = scene.nodes.motion[node];
        box.add(motion.x);
        box.add(Vec3(motion.x + scene.time * (motion.v + scene.time * soft.gravity_scale * scene.gravity)));
    }
    return box;
}

const ElementSet& stretch_of(const ObstacleScene& scene, const Soft& soft) {
    return scene.elements.set[soft.sets[0].set];
}

// Against compression on one side [Pa]; of a cloth over its thickness.
double modulus_of(const ObstacleScene& scene, const Soft& soft, double radius) {
    const double stiffness = stretch_of(scene, soft).stiffness[0];
    return soft.kind == SoftKind::solid ? stiffness : stiffness / (2 * radius);
}

// Whether it has an inside that is known.
bool has_cells(const ObstacleScene& scene, const Soft& soft) {
    return soft.kind == SoftKind::solid && (stretch_of(scene, soft).type->row.nodes == 4 || soft.cell_points > 1);
}

void list_cells(const ElementSet& set, uint32_t cell_points, Array<uint32_t>& out) {
    // Six about the diagonal from corner 0 to 6, as shape_functions.h numbers them.
    static constexpr uint32_t kCut[6][2] = {{1, 2}, {2, 3}, {3, 7}, {7, 4}, {4, 5}, {5, 1}};
    for (uint32_t e = 0; e < set.size(); e += cell_points) {
        if (!set.lives(e)) continue;
        const std::span<const uint32_t> node = set.nodes_of(e);
        if (node.size() == 4)
            out.insert(out.end(), node.begin(), node.end());
        else
            for (const auto& cut : kCut) out.insert(out.end(), {node[0], node[cut[0]], node[cut[1]], node[6]});
    }
}

void make_shape(const ObstacleScene& scene, uint32_t index, SoftShape& out) {
    const Soft& soft = scene.softs.record[index];
    if (out.soft == index && out.mesh_version == soft.mesh_version) return;
    out.soft = index;
    out.mesh_version = soft.mesh_version;
    out.triangle.clear();
    for (const uint32_t vertex : soft.triangle) out.triangle.push_back(soft.node[vertex]);
    out.vertex.assign(out.triangle.begin(), out.triangle.end());
    std::ranges::sort(out.vertex);
    out.vertex.erase(std::unique(out.vertex.begin(), out.vertex.end()), out.vertex.end());
    out.cell.clear();
    if (has_cells(scene, soft)) list_cells(stretch_of(scene, soft), soft.cell_points, out.cell);
    const auto box_of = [&](const Array<uint32_t>& node, uint32_t corners) {
        return [&scene, &node, corners](uint32_t i) {
            collision::ItemBox box;
            for (uint32_t k = 0; k < corners; ++k) box.add(scene.nodes.motion[node[corners * size_t{i} + k]].x);
            return box;
        };
    };
    out.surface.build(static_cast<uint32_t>(out.triangle.size() / 3), box_of(out.triangle, 3));
    out.cells.build(static_cast<uint32_t>(out.cell.size() / 4), box_of(out.cell, 4));
}

// Who meets whom, and what is solved together for that.
class SoftMeetings {
public:
    SoftMeetings(const ObstacleScene& scene, Obstacles& out) : scene_(scene), out_(out) {}

    void find() {
        const Softs& softs = scene_.softs;
        out_.between.clear();
        out_.tie.clear();
        uint32_t used = 0;
        for (uint32_t s = 0; s < softs.record.size(); ++s) {
            if (softs.record[s].node.empty() || collider_of(scene_.nodes, softs.record[s]) == kNone) continue;
            if (used == out_.softs.size()) out_.softs.emplace_back(*out_.tie.get_allocator().memory);
            make_shape(scene_, s, out_.softs[used++]);
        }
        while (out_.softs.size() > used) out_.softs.pop_back();
        for (SoftShape& each : out_.softs)
            each.swept = swept_box(scene_, scene_.softs.record[each.soft]), each.tied = false;
        for (SoftShape& one : out_.softs) {
            one.first = static_cast<uint32_t>(out_.between.size());
            for (uint32_t k = 0; k < used; ++k) meet(static_cast<uint32_t>(&one - out_.softs.data()), k);
            one.meetings = static_cast<uint32_t>(out_.between.size()) - one.first;
        }
    }

private:
    const Soft& soft_of(uint32_t i) const { return scene_.softs.record[out_.softs[i].soft]; }
    void meet(uint32_t i, uint32_t k) {
        const Soft &one = soft_of(i), &other = soft_of(k);
        if (out_.softs[k].cell.empty()) return;
        const ColliderTraits& a = scene_.colliders.traits[collider_of(scene_.nodes, one)];
        const ColliderTraits& b = scene_.colliders.traits[collider_of(scene_.nodes, other)];
        if (i == k ? !one.self : !filters_agree(a.filter, b.filter)) return;
        if (i != k && !out_.softs[i].swept.meets(out_.softs[k].swept)) return;
        const double stiffness = std::min(modulus_of(scene_, one, out_.radius[out_.softs[i].soft]),
                                          modulus_of(scene_, other, out_.radius[out_.softs[k].soft]));
        out_.between.push_back({i, k, static_cast<double>(friction_of(a.material, b.material)), stiffness});
        tie(i);
        tie(k);
        out_.tie.insert(out_.tie.end(), {one.node.front(), other.node.front()});
    }
    void tie(uint32_t i) {
        if (std::exchange(out_.softs[i].tied, true)) return;
        const Array<uint32_t>& node = soft_of(i).node;
        for (size_t n = 1; n < node.size(); ++n) out_.tie.insert(out_.tie.end(), {node[n - 1], node[n]});
    }

    const ObstacleScene& scene_;
    Obstacles& out_;
};

}  // namespace

void find_obstacles(const ObstacleScene& scene, Obstacles& out) {
    const auto& [nodes, colliders, shapes, softs, elements, time, gravity] = scene;
    out.list.clear();
    out.met.clear();
    out.first.assign(softs.record.size(), 0);
    out.count.assign(softs.record.size(), 0);
    out.radius.assign(softs.record.size(), 0);
    out.push.clear();
    out.penalties = false;
    for (uint32_t c = 0; c < colliders.record.size(); ++c)
        if (is_obstacle(nodes, colliders.record[c]))
            out.list.push_back({&shapes[colliders.record[c].shape].shape, c, colliders.record[c].node});
    for (uint32_t s = 0; s < softs.record.size(); ++s) {
        const uint32_t own = softs.record[s].node.empty() ? kNone : collider_of(nodes, softs.record[s]);
        out.first[s] = static_cast<uint32_t>(out.met.size());
        if (own == kNone) continue;
        out.radius[s] = collision::ball_radius(shapes[colliders.record[own].shape].shape);
        const ColliderTraits& traits = colliders.traits[own];
        for (uint32_t i = 0; i < out.list.size(); ++i) {
            const ColliderTraits& other = colliders.traits[out.list[i].collider];
            if (!filters_agree(traits.filter, other.filter)) continue;
            const auto friction = static_cast<double>(friction_of(traits.material, other.material));
            out.met.push_back({i, friction, modulus_of(scene, softs.record[s], out.radius[s])});
            out.penalties = out.penalties || !out.list[i].exact();
        }
        out.count[s] = static_cast<uint32_t>(out.met.size()) - out.first[s];
    }
    SoftMeetings(scene, out).find();
}

void place_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, double elapsed,
                     Obstacles& obstacles) {
    for (Obstacle& each : obstacles.list) {
        const Collider& collider = colliders.record[each.collider];
        const NodeMotion& motion = nodes.motion[each.node];
        const Mat3 turn = (rotation_from_vector(elapsed * motion.w) * motion.q).normalized().toRotationMatrix();
        each.v = motion.v;
        each.w = motion.w;
        each.centre = motion.x + elapsed * motion.v;
        each.rotation = turn * collider.rotation.toRotationMatrix();
        each.position = each.centre + turn * (collider.position - nodes.mass[each.node].centre);
        const ColliderTraits& traits = colliders.traits[each.collider];
        each.surface_v = each.rotation * traits.surface_velocity.cast<double>();
        each.surface_w = each.rotation * traits.surface_spin.cast<double>();
        find_box(shapes[collider.shape].box, each);
    }
}

}  // namespace taut
