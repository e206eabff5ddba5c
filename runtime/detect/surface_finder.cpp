#include "detect/surface_finder.h"

#include <cmath>
#include <limits>

#include "detect/surface_tree.h"
#include "detect/surfaces.h"
#include "detect/triangle_pairs.h"
#include "detect/untangle.h"
#include "detect/vertex_pairs.h"

namespace taut {
namespace {

// Of its owner, a soft body or a shape.
bool is_still(const SurfaceScene& scene, uint64_t feature) {
    const auto index = static_cast<uint32_t>(feature >> 32);
    constexpr uint32_t kShape = 1u << 31;
    return index & kShape ? !moves_now(scene, index & ~kShape) : !scene.softs.mesh[index].awake;
}

// Whether a surface is among those whose contacts are found anew.
bool is_listed(const Softs& softs, uint64_t feature) {
    return std::ranges::binary_search(softs.listed, static_cast<uint32_t>(feature >> 32));
}

auto features_of(const SurfaceContact& contact) { return std::pair(contact.a, contact.b); }
auto features_of_name(const SurfaceContactName& name) { return std::pair(name.a, name.b); }

// Of those from an index on.
void list_names(const Array<SurfaceContact>& contacts, Array<SurfaceContactName>& names, size_t from = 0) {
    names.clear();
    reserve_more(names, contacts.size() - from);
    for (auto i = static_cast<uint32_t>(from); i < contacts.size(); ++i)
        names.push_back({contacts[i].a, contacts[i].b, i});
}

}  // namespace

SurfaceFinder::SurfaceFinder(const SurfaceScene& scene)
    : scene_(scene), before_(scene.pairs.surfaces.contact), found_(scene.pairs.surfaces.found) {
    list_names(scene.pairs.surfaces.contact, scene.pairs.surfaces.name_before);
    name_before_ = scene.pairs.surfaces.name_before;
    found_.clear();
}

const SurfaceContact* SurfaceFinder::before(uint64_t a, uint64_t b) const {
    const auto at = std::ranges::lower_bound(name_before_, std::pair(a, b), {}, features_of_name);
    return at != name_before_.end() && features_of_name(*at) == std::pair(a, b) ? &before_[at->index] : nullptr;
}

// Whether a feature of a surface has contacts found anew: by the triangle that owns it.
static bool renews_feature(const Softs& softs, uint64_t feature) {
    const SurfaceMesh& mesh = softs.mesh[feature >> 32];
    const uint32_t index = index_of(feature);
    switch (part_of(feature)) {
        case SurfacePart::vertex:
            return mesh.renews(mesh.owner[index]);
        case SurfacePart::face:
            return mesh.renews(index);
        case SurfacePart::edge:
            return mesh.renews(mesh.edge[index].triangle[0]);
        case SurfacePart::cut:
            return mesh.renews(mesh.edge[index / 2].triangle[0]);
    }
    return true;
}

// What is within a solid leaves it by the nearest of all faces.
bool SurfaceFinder::renews_all(uint32_t soft, uint32_t collider) const {
    const Collider& of = scene_.colliders.record[collider];
    return scene_.renewed.empty() || scene_.nodes.info[of.node].kind != NodeKind::fixed ||
           scene_.softs.record[soft].kind == SoftKind::solid;
}

bool SurfaceFinder::renews(const SurfaceContact& contact) const {
    if (scene_.renewed.empty()) return true;
    const bool of_shape = is_of_shape(contact.b);
    if (!is_listed(scene_.softs, contact.a) || !(of_shape || is_listed(scene_.softs, contact.b))) return false;
    if (!std::ranges::all_of(contact.node, [&](uint32_t node) { return node == kNone || scene_.may_renew(node); }))
        return false;
    if (renews_feature(scene_.softs, contact.a)) return true;
    return of_shape ? renews_all(static_cast<uint32_t>(contact.a >> 32), collider_of_shape(contact.b))
                    : renews_feature(scene_.softs, contact.b);
}

void SurfaceFinder::keep_still() {
    for (const SurfaceContact& contact : before_)
        if ((is_still(scene_, contact.a) && is_still(scene_, contact.b)) || !renews(contact)) found_.push_back(contact);
}

SurfaceTouch SurfaceFinder::touch_of(uint32_t positive, uint32_t negative) const {
    SurfaceTouch touch{};
    touch.collider[0] = positive;
    touch.collider[1] = negative;
    const taut_material &one = scene_.colliders.traits[positive].material,
                        &other = scene_.colliders.traits[negative].material;
    touch.friction = friction_of(one, other);
    touch.restitution = restitution_of(one, other);
    return touch;
}

bool SurfaceFinder::tied(std::span<const uint32_t> a, std::span<const uint32_t> b) const {
    const Array<uint64_t>& joined = scene_.pairs.joined;
    if (joined.empty()) return false;
    for (const uint32_t one : a)
        for (const uint32_t other : b)
            if (one == other || std::binary_search(joined.begin(), joined.end(), pair_key(one, other))) return true;
    return false;
}

bool moves_now(const SurfaceScene& scene, uint32_t collider) {
    const Collider& of = scene.colliders.record[collider];
    return moves_now(scene.nodes, of.node) || (of.node_b != kNone && moves_now(scene.nodes, of.node_b));
}

Nearest Passing::nearest(const Vec3f (&at)[4]) const {
    switch (of) {
        case Of::vertex_face:
            return nearest_of_face(at);
        case Of::edge_edge:
            return nearest_of_segments(at);
        case Of::vertex_edge:
            return nearest_of_edge(at, 1, 2);
        case Of::vertex_vertex:
            break;
    }
    return {at[0] - at[1], {1, -1, 0, 0}, true};
}

float Passing::speed() const {
    float squared = 0;
    for (int i = 0; i < first(); ++i)
        for (int k = first(); k < points(); ++k) squared = std::max(squared, (v[i] - v[k]).squaredNorm());
    return std::sqrt(squared);
}

float Passing::size() const {
    float squared = std::numeric_limits<float>::infinity();
    for (const int begin : {0, first()})
        for (int i = begin, end = begin == 0 ? first() : points(); i < end; ++i)
            for (int k = begin; k < i; ++k) squared = std::min(squared, (x[i] - x[k]).squaredNorm());
    return std::sqrt(squared);
}

bool meet(const Passing& passing, float reach, float time, Nearest& out, float& met) {
    const float speed = passing.speed();
    met = 0;
    for (int step = 0;; ++step) {
        Vec3f at[4];
        passing.at(met, at);
        out = passing.nearest(at);
        const float beyond = out.distance() - reach;
        if (!(beyond > 0)) return true;
        if (step == kMostAdvances) return met > 0;
        if (!(beyond < speed * (time - met))) return false;
        met += beyond / speed;
    }
}

// When two points on their way are nearest, within a time.
static float passing_time(const Vec3f& apart, const Vec3f& parting, float time) {
    const float squared = parting.squaredNorm();
    return squared > 0 ? std::clamp(-apart.dot(parting) / squared, 0.0f, time) : 0;
}

// Of two features that do not touch now nor in a time, where they come nearest: so nothing that slides over an edge
// within what is flat is stopped by it.
static void pass_by(const Passing& passing, float both, float time, Nearest& near) {
    Vec3f apart = Vec3f::Zero(), parting = Vec3f::Zero();
    for (int i = 0; i < passing.points(); ++i) {
        apart += near.weight[i] * passing.x[i];
        parting += near.weight[i] * passing.v[i];
    }
    Vec3f at[4];
    passing.at(passing_time(apart, parting, time), at);
    const Nearest then = passing.nearest(at);
    if (apart.norm() > both && then.inside && then.distance() >= both) near = then;
}

bool is_through(const Passing& passing, const SurfaceContact& was) {
    const Nearest near = passing.nearest(passing.x);
    return near.inside && near.apart.dot(was.normal) < 0 && near.distance() < passing.size();
}

void carry_force(const SurfaceContact& was, SurfaceContact& contact) {
    contact.in_block = was.in_block;
    contact.force = was.force;
    contact.pushed = was.pushed;
    contact.push = was.push;
    contact.rubbed = was.rubbed;
    contact.approach = was.approach;
    if (same_tangents(was.normal, contact.normal)) return;
    const Vec3f one = tangent_of(was.normal), other = was.normal.cross(one), to = tangent_of(contact.normal);
    const Vec3f along = was.force.tangent1 * one + was.force.tangent2 * other;
    contact.force.tangent1 = along.dot(to);
    contact.force.tangent2 = along.dot(contact.normal.cross(to));
}

bool touch(const Passing& passing, const SurfaceTouch& of, float time, const SurfaceContact* was, const Vec3f& facing,
           SurfaceContact& contact) {
    Nearest near;
    if (was && is_through(passing, *was)) {
        near = passing.nearest(passing.x);
    } else {
        float met = 0;
        if (!meet(passing, of.both + of.margin, time, near, met) || !near.inside) return false;
        pass_by(passing, of.both, time, near);
    }
    const float distance = near.distance();
    if (!(distance > 1e-12f)) {
        if (!was) return false;  // it will be off the next frame, whichever way
        near.apart = was->normal;
    }
    contact.normal = near.apart.normalized();
    const float known = was ? contact.normal.dot(was->normal) : contact.normal.dot(facing);
    if (known < 0) {
        // What comes to a solid's side from within has come in elsewhere, and is stopped there.
        if (!was && passing.nearest(passing.x).distance() > of.both + of.margin) return false;
        contact.normal = -contact.normal;
    }
    contact.gap = -of.both;
    for (int i = 0; i < passing.points(); ++i) {
        contact.weight[i] = near.weight[i];
        contact.gap += near.weight[i] * contact.normal.dot(passing.x[i]);
    }
    // Its distance stays that of the features: what is nearer to something else is held by that.
    const Vec3f turned = passing.feature[1].in_cone(-passing.feature[0].in_cone(-contact.normal));
    if (turned != contact.normal) {
        float clear = -of.both;
        for (int i = 0; i < passing.points(); ++i) clear += near.weight[i] * turned.dot(passing.x[i]);
        if (clear > -depth_within(of.both, of.margin)) contact.normal = turned;
    }
    contact.friction = of.friction;
    contact.restitution = of.restitution;
    contact.collider[0] = of.collider[0];
    contact.collider[1] = of.collider[1];
    if (was) {
        carry_force(*was, contact);
    }
    return true;
}

// Of what is round, the point of its axis that is nearest to another, in the frame of a mesh.
static Vec3f point_on_axis(const SurfaceScene& scene, uint32_t collider, const SurfaceMesh& mesh, const Vec3f& to) {
    const collision::Shape& shape = scene.shapes[scene.colliders.record[collider].shape].shape;
    const collision::Placement& at = scene.pairs.placement[collider];
    const Vec3f middle = (at.position - mesh.origin).cast<float>();
    const float half = shape.kind == collision::ShapeKind::capsule ? shape.size.y() : 0;
    const Vec3f along = at.rotation.col(1);
    return middle + std::clamp(along.dot(to - middle), -half, half) * along;
}

// Pairs of vertices with what is round and passes by: the normal is that of where they come nearest, lest something
// that slides over a vertex within what is flat is stopped by it. Levers stay.
static void turn_to_passage(const SurfaceScene& scene) {
    Pairs& pairs = scene.pairs;
    for (const ActivePair& active : pairs.active) {
        const VertexPair of(scene.nodes, scene.softs, active);
        if (!of.mesh() || active.spans()) continue;
        Pair& pair = pairs.list[active.pair];
        const uint32_t collider = of.is_second() ? pair.collider_a() : pair.collider_b();
        const collision::ShapeKind kind = scene.shapes[scene.colliders.record[collider].shape].shape.kind;
        if (kind != collision::ShapeKind::sphere && kind != collision::ShapeKind::capsule) continue;
        const SurfaceMesh& mesh = *of.mesh();
        const Vec3f& x = mesh.x[of.vertex()];
        const Vec3f middle = point_on_axis(scene, collider, mesh, x), apart = middle - x;
        const NodeMotion& other = scene.nodes.motion[of.is_second() ? active.a : active.b];
        const Vec3f arm = (mesh.origin - other.x).cast<float>() + middle;
        const Vec3f parting = other.v.cast<float>() + other.w.cast<float>().cross(arm) - mesh.v[of.vertex()];
        const float both = mesh.radius + (of.is_second() ? pair.round_a : pair.round_b);
        const Vec3f then = apart + passing_time(apart, parting, static_cast<float>(scene.time)) * parting;
        if (pair.then > 0 || !(apart.norm() > both) || !(then.norm() >= both)) continue;
        const Vec3f normal = then.normalized();
        pair.manifold.normal = of.is_second() ? Vec3f(-normal) : normal;
        pair.manifold.points[0].separation = normal.dot(apart) - both;
    }
}

// Into SurfaceContacts::found.
static void find(Team& team, const SurfaceScene& scene) {
    SurfaceContacts& surfaces = scene.pairs.surfaces;
    surfaces.crossing.clear();
    SurfaceFinder finder(scene);
    find_surface_pairs(team, finder);
    untangle(finder, surfaces.found);
    find_surface_shapes(finder);
    finder.keep_still();
}

// Of two lists in order.
static void merge_names(std::span<const SurfaceContactName> one, std::span<const SurfaceContactName> other,
                        Array<SurfaceContactName>& out) {
    out.resize(one.size() + other.size());
    std::ranges::merge(one, other, out.begin(), {}, features_of_name, features_of_name);
}

// Those found, by features. What stays within a frame comes last, in order, and is most of them.
static void order_found(SurfaceContacts& surfaces) {
    Array<SurfaceContactName>& names = surfaces.name_found;
    list_names(surfaces.found, names);
    auto stays = names.empty() ? names.end() : names.end() - 1;
    while (stays != names.begin() && features_of_name(stays[-1]) < features_of_name(*stays)) --stays;
    std::ranges::sort(names.begin(), stays, {}, features_of_name);
    merge_names({names.begin(), stays}, {stays, names.end()}, surfaces.order);
}

static void take_found(SurfaceContacts& surfaces) {
    surfaces.contact.clear();
    for (const SurfaceContactName& name : surfaces.order) surfaces.contact.push_back(surfaces.found[name.index]);
}

void find_surface_contacts(Team& team, const SurfaceScene& scene) {
    SurfaceContacts& surfaces = scene.pairs.surfaces;
    if (scene.softs.ids.count() == 0 && surfaces.contact.empty()) return;
    refit_surfaces(team, scene);
    if (!surfaces.gone.empty()) {
        std::ranges::sort(surfaces.gone);
        std::erase_if(surfaces.contact, [&](const SurfaceContact& contact) {
            return std::ranges::any_of(contact.node,
                                       [&](uint32_t node) { return std::ranges::binary_search(surfaces.gone, node); });
        });
        surfaces.gone.clear();
        ++surfaces.version;
    }
    find(team, scene);
    order_found(surfaces);
    bool same = surfaces.contact.size() == surfaces.found.size();
    for (uint32_t i = 0; i < surfaces.found.size() && same; ++i)
        same = std::ranges::equal(surfaces.contact[i].node, surfaces.found[surfaces.order[i].index].node);
    surfaces.version += same ? 0 : 1;
    take_found(surfaces);
    turn_to_passage(scene);
    for (const ActivePair& active : scene.pairs.active)
        turn_into_cone(scene.nodes, scene.colliders, scene.shapes, scene.softs, scene.pairs, active);
}

// What pushed in the frame, and is not there any more, stays in the list to its end for what it gave, out of touch.
static void keep_pushes(SurfaceContacts& surfaces) {
    constexpr float kApart = 1;  // [m]
    const size_t found = surfaces.found.size();
    size_t now = 0;
    for (const SurfaceContact& was : surfaces.contact) {
        const auto name = features_of(was);
        while (now < found && features_of_name(surfaces.order[now]) < name) ++now;
        if (now < found && features_of_name(surfaces.order[now]) == name) continue;
        if (!(was.pushed > 0)) continue;
        SurfaceContact& kept = surfaces.found.emplace_back(was);
        kept.force = {};
        kept.gap = kApart;
    }
    list_names(surfaces.found, surfaces.name_found, found);
    std::swap(surfaces.order, surfaces.name_merged);
    merge_names(surfaces.name_merged, surfaces.name_found, surfaces.order);
}

void renew_surface_contacts(Team& team, const SurfaceScene& scene, const PreSolve& pre_solve,
                            Array<uint32_t>& successor) {
    SurfaceContacts& surfaces = scene.pairs.surfaces;
    refit_surfaces(team, scene);
    find(team, scene);
    filter_surfaces(scene.nodes, scene.colliders, scene.shapes, pre_solve, scene.pairs, surfaces.found);
    order_found(surfaces);
    keep_pushes(surfaces);
    successor.assign(surfaces.contact.size(), kNone);
    for (uint32_t now = 0, was = 0; now < surfaces.order.size() && was < surfaces.contact.size();) {
        const auto one = features_of(surfaces.contact[was]), other = features_of_name(surfaces.order[now]);
        if (one == other) successor[was] = now;
        was += one <= other;
        now += other <= one;
    }
    ++surfaces.version;
    take_found(surfaces);
}

}  // namespace taut
