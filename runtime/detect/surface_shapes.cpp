// Surfaces of soft bodies with shapes, but for their vertices: edges, which are capsules, with a shape by its own
// kernels, or with the axis of a round one; faces with what stands out of it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "detect/detect.h"
#include "detect/surface_finder.h"
#include "detect/surface_tree.h"
#include "detect/surfaces.h"
#include "detect/vertex_pairs.h"

namespace taut {
namespace {

constexpr float kSuffices = 0.125f;  // of the margin: what is nearer by less than this than vertices is theirs too
constexpr float kWithin = 0.98f;     // of an edge, from its middle: what is nearer to an end is the vertex's

// Of a collider that nobody's vertex is: in the frame of one surface.
class SurfaceShape {
public:
    SurfaceShape(SurfaceFinder& finder, uint32_t soft, uint32_t collider)
        : finder_(finder),
          scene_(finder.scene()),
          index_(soft),
          collider_(collider),
          soft_(scene_.softs.record[soft]),
          mesh_(scene_.softs.mesh[soft]),
          of_(scene_.colliders.record[collider]),
          shape_(scene_.shapes[of_.shape].shape),
          at_(scene_.renewed.empty() ? scene_.pairs.placement[collider]
                                     : placement_of(scene_.nodes, of_, scene_.elapsed)),
          all_(finder.renews_all(soft, collider)),
          time_(static_cast<float>(scene_.time)) {
        at_.position -= mesh_.origin;
        const NodeMotion& motion = scene_.nodes.motion[of_.node];
        centre_ = (scene_.place_of(of_.node) - mesh_.origin).cast<float>();
        velocity_ = motion.v.cast<float>();
        spin_ = spans() ? Vec3f(Vec3f::Zero()) : Vec3f(motion.w.cast<float>());
        in_block_ = scene_.elements.set[soft_.sets.front().set].solve != JointSolve::swept;
        margin_ = std::min(mesh_.margin, scene_.pairs.travel[collider].margin);
        way_ = time_ * (velocity_ - mesh_.drift);
    }

    void find() {
        SurfaceBox box = box_of_shape();
        if (mesh_.node.empty() || !mesh_.node.front().box.meets(box)) return;
        list_ends();
        Array<uint32_t>& near = scene_.pairs.surfaces.near;
        near.clear();
        for_triangles_in(mesh_, box, [&](uint32_t t) {
            if (renews(t)) near.push_back(t);
        });
        for (const uint32_t t : near) {
            for (uint32_t k = 0; k < 3; ++k) {
                if (mesh_.owns[t] >> k & 1) find_edge(mesh_.edge_of[3 * t + k]);
                if (mesh_.owns[t] >> (3 + k) & 1 && lacks_pair(soft_.triangle[3 * t + k]))
                    find_vertex(soft_.triangle[3 * t + k]);
            }
        }
        if (!near.empty()) find_faces(box);
    }

private:
    bool spans() const { return of_.node_b != kNone; }
    bool renews(uint32_t t) const { return all_ || mesh_.renews(t); }
    bool is_round() const {
        return shape_.kind == collision::ShapeKind::sphere || shape_.kind == collision::ShapeKind::capsule;
    }
    // Whether a vertex has no pair with it: grains have none, and within a frame none begins.
    bool lacks_pair(uint32_t vertex) const {
        if (of_.grain || scene_.renewed.empty()) return of_.grain;
        const uint32_t own = scene_.nodes.info[soft_.node[vertex]].collider;
        const uint64_t key = pair_key(own, collider_);
        NearPairs& near = scene_.pairs.near;
        size_t begin = 0, end = near.size();
        while (begin < end) {
            const size_t middle = (begin + end) / 2;
            if (near[middle].key < key)
                begin = middle + 1;
            else
                end = middle;
        }
        return begin == near.size() || near[begin].key != key || near[begin].pair == kNone;
    }
    Vec3f velocity_at(const Vec3f& point) const { return velocity_ + spin_.cross(point - centre_); }

    // About its way, as seen from what moves as the surface does on average.
    SurfaceBox box_of_shape() const {
        const collision::Box tight = collision::bounds(shape_, at_);
        SurfaceBox box{tight.lo, tight.hi};
        float grow = margin_;
        if (spans()) {
            const NodeMotion& other = scene_.nodes.motion[of_.node_b];
            const SurfaceBox moved = box.swept(time_ * (other.v.cast<float>() - mesh_.drift));
            box.add(moved);
        } else {
            const float reach = (at_.position.cast<float>() - centre_).norm() + scene_.pairs.stance[collider_].size;
            grow += std::min(time_ * spin_.norm(), 2.0f) * reach;
        }
        return box.swept(way_).grown(grow);
    }

    // Of a round one: its axis, and how fast its ends move.
    void list_ends() {
        if (!is_round()) return;
        const float half = shape_.kind == collision::ShapeKind::capsule ? shape_.size.y() : 0;
        for (int k = 0; k < 2; ++k) {
            const uint32_t node = k == 0 ? of_.node : of_.node_b;
            if (spans()) {
                end_[k] = (scene_.place_of(node) - mesh_.origin).cast<float>();
                speed_[k] = scene_.nodes.motion[node].v.cast<float>();
            } else {
                end_[k] = at_.position.cast<float>() + at_.rotation * Vec3f(0, k == 0 ? -half : half, 0);
                speed_[k] = velocity_at(end_[k]);
            }
        }
    }

    void add(SurfaceContact& contact, uint64_t feature, uint32_t number) {
        contact.a = feature;
        contact.b = feature_of_shape(collider_, number);
        const auto solved = [&](uint32_t node) { return node != kNone && scene_.nodes.solved(node); };
        if (std::ranges::none_of(contact.node, solved)) return;
        uint32_t own[4];
        size_t count = 0;
        bool tied = false;
        for (int i = 0; i < 4; ++i)
            if (contact.node[i] != kNone && scene_.nodes.info[contact.node[i]].soft == index_)
                own[count++] = contact.node[i];
        const uint32_t ends[2] = {of_.node, spans() ? of_.node_b : of_.node};
        tied = finder_.tied(ends, {own, count});
        if (!tied) finder_.add(contact);
    }

    SurfaceTouch touch_of(bool shape_is_positive, float radius) const {
        SurfaceTouch touch = shape_is_positive ? finder_.touch_of(collider_, mesh_.collider)
                                               : finder_.touch_of(mesh_.collider, collider_);
        touch.both = mesh_.radius + radius;
        touch.margin = margin_;
        return touch;
    }

    void place_vertex(uint32_t vertex, int i, Passing& passing, SurfaceContact& contact) const {
        passing.x[i] = mesh_.x[vertex];
        passing.v[i] = mesh_.v[vertex];
        contact.node[i] = soft_.node[vertex];
    }

    // Whether vertices, which have contacts of their own, are about as near to the axis of what is round, or the middle
    // of a ball, as a feature that they bound: when it comes to touch it, for from afar all are, and still at the end
    // of the time, where the vertex was held: an edge may turn about one that rests. In a block, whose contacts are
    // found once a frame and where those that push two ways would do work, those that are needed as it begins do.
    bool vertices_suffice(std::span<const uint32_t> vertices, const Passing& passing, float both) const {
        Nearest near;
        float met = 0;
        const bool met_ever =
            !in_block_ && (meet(passing, both, time_, near, met) || meet(passing, both + margin_, time_, near, met));
        if (!met_ever) met = 0;
        return std::ranges::any_of(vertices, [&](uint32_t vertex) {
            const Nearest own = nearest_of_vertex(vertex, met, Vec3f::Zero());
            if (!suffices(own, passing, met, Vec3f::Zero())) return false;
            if (in_block_) return true;
            const Vec3f normal = own.apart.normalized();
            float closing = -normal.dot(mesh_.v[vertex]);
            for (int k = 0; k < 2; ++k) closing -= own.weight[k + 1] * normal.dot(speed_[k]);
            const Vec3f held = -std::max(closing, 0.0f) * normal;
            return suffices(nearest_of_vertex(vertex, time_, (time_ - met) * held), passing, time_,
                            (time_ - met) * held);
        });
    }
    // From the axis to a vertex after a time, the axis shifted.
    Nearest nearest_of_vertex(uint32_t vertex, float time, const Vec3f& shift) const {
        const Vec3f x[4] = {mesh_.x[vertex] + time * mesh_.v[vertex], end_[0] + time * speed_[0] + shift,
                            end_[1] + time * speed_[1] + shift, Vec3f::Zero()};
        return nearest_of_edge(x, 1, 2);
    }
    // passing: of the shape first.
    bool suffices(const Nearest& own, const Passing& passing, float time, const Vec3f& shift) const {
        Vec3f at[4];
        passing.at(time, at);
        for (int i = 0; i < passing.first(); ++i) at[i] += shift;
        return own.distance() - passing.nearest(at).distance() < kSuffices * margin_;
    }

    SurfaceFeature edge_feature(uint32_t e) const {
        return held_feature(scene_.nodes, {SurfaceFeature::Of::edge, &soft_, &mesh_, e});
    }
    SurfaceFeature vertex_feature(uint32_t v) const {
        return held_feature(scene_.nodes, {SurfaceFeature::Of::vertex, &soft_, &mesh_, v});
    }
    // From the shape to a feature, of which x is a point [m].
    Vec3f normal_to(const SurfaceFeature& feature, const collision::Manifold& manifold, const Vec3f& x) const {
        return -turn_normal(feature, shape_, at_, x.cast<double>(), manifold.normal, margin_).normal;
    }

    void find_edge(uint32_t e) {
        if (is_round())
            find_round_edge(e);
        else if (shape_.kind != collision::ShapeKind::plane)
            find_capsule(e);
    }

    void find_round_edge(uint32_t e) {
        const SurfaceEdge& edge = mesh_.edge[e];
        const bool ball = shape_.kind == collision::ShapeKind::sphere;
        SurfaceContact contact;
        Passing passing{};
        passing.of = ball ? Passing::Of::vertex_edge : Passing::Of::edge_edge;
        const int first = ball ? 1 : 2;
        for (int k = 0; k < first; ++k) passing.x[k] = end_[k], passing.v[k] = speed_[k];
        contact.node[0] = of_.node;
        if (spans()) contact.node[1] = of_.node_b;
        for (int k = 0; k < 2; ++k) place_vertex(edge.vertex[k], first + k, passing, contact);
        passing.feature[1] = edge_feature(e);
        const uint64_t feature = feature_of(index_, SurfacePart::edge, e);
        const SurfaceTouch of = touch_of(true, shape_.size.x());
        if (!touch(passing, of, time_, finder_.before(feature, feature_of_shape(collider_, kAxis)), Vec3f::Zero(),
                   contact))
            return;
        if (vertices_suffice(edge.vertex, passing, of.both)) return;
        Vec3f middle = Vec3f::Zero();
        for (int k = 0; k < first; ++k) middle += contact.weight[k] * passing.x[k];
        if (!spans()) {
            contact.skin = -shape_.size.x() * contact.normal;
            contact.lever = middle + contact.skin - centre_;
            if (!ball) {  // both ends are one body's
                contact.weight[0] += contact.weight[1];
                contact.weight[1] = contact.weight[2], contact.node[1] = contact.node[2];
                contact.weight[2] = contact.weight[3], contact.node[2] = contact.node[3];
                contact.weight[3] = 0, contact.node[3] = kNone;
            }
        }
        add(contact, feature, kAxis);
    }

    void find_capsule(uint32_t e) {
        const uint32_t* vertex = mesh_.edge[e].vertex;
        const Vec3f &from = mesh_.x[vertex[0]], &to = mesh_.x[vertex[1]];
        const float length = (to - from).norm();
        if (!(length > 0)) return;
        const Vec3f along = (1 / length) * (to - from);
        collision::Shape capsule;
        capsule.kind = collision::ShapeKind::capsule;
        capsule.size = {mesh_.radius, 0.5f * length, 0};
        const Vec3f middle = 0.5f * (from + to);
        const collision::Placement at{
            middle.cast<double>(), turn_between(Vec3::UnitY(), along.cast<double>()).toRotationMatrix().cast<float>()};
        const Vec3f of_shape = velocity_at(middle);
        float speed = 0;
        for (int k = 0; k < 2; ++k) speed = std::max(speed, (mesh_.v[vertex[k]] - of_shape).norm());
        const float reach = margin_ + time_ * speed;
        const auto take = [&](const collision::Manifold& manifold, uint32_t part) {
            for (int k = 0; k < manifold.count; ++k)
                take_point(e, manifold, manifold.points[k], middle, (2 / length) * along,
                           part + static_cast<uint32_t>(k));
        };
        if (!collision::has_parts(shape_)) {
            collision::PairCache cache;
            collision::Manifold manifold;
            collision::collide(capsule, at, shape_, at_, reach, cache, manifold);
            take(manifold, kCapsule);
            return;
        }
        collision::collide_parts(capsule, at, shape_, at_, reach, scene_.pairs.parts);
        for (const collision::PartManifold& part : scene_.pairs.parts.found)
            if (!part.is_face()) take(part.manifold, kCapsule + 2 * part.part);
    }

    // Of an edge: share: from -1 to 1 along it, times a place from its middle.
    void take_point(uint32_t e, const collision::Manifold& manifold, const collision::ContactPoint& point,
                    const Vec3f& middle, const Vec3f& share, uint32_t number) {
        const float t = share.dot(point.position);
        if (!(std::abs(t) < kWithin)) return;
        const uint32_t* vertex = mesh_.edge[e].vertex;
        SurfaceContact contact;
        const Vec3f place = middle + point.position;
        contact.normal = normal_to(edge_feature(e), manifold, middle);
        contact.node[0] = of_.node;
        contact.weight[0] = -1;
        contact.lever = place - centre_;
        float closing = contact.normal.dot(velocity_at(place));
        for (int k = 0; k < 2; ++k) {
            contact.node[k + 1] = soft_.node[vertex[k]];
            contact.weight[k + 1] = 0.5f * (k == 0 ? 1 - t : 1 + t);
            closing -= contact.weight[k + 1] * contact.normal.dot(mesh_.v[vertex[k]]);
        }
        contact.gap = point.separation;
        if (contact.gap - time_ * std::max(closing, 0.0f) > margin_) return;
        finish(contact, feature_of(index_, SurfacePart::edge, e), number);
    }

    void find_vertex(uint32_t vertex) {
        if (of_.grain)
            find_grain(vertex);
        else if (is_round())
            find_round_vertex(vertex);
        else
            find_ball(vertex);
    }

    void find_grain(uint32_t vertex) {
        SurfaceContact contact;
        Passing passing{};
        passing.of = Passing::Of::vertex_vertex;
        passing.x[0] = end_[0], passing.v[0] = speed_[0];
        contact.node[0] = of_.node;
        place_vertex(vertex, 1, passing, contact);
        passing.feature[1] = vertex_feature(vertex);
        const uint64_t feature = feature_of(index_, SurfacePart::vertex, vertex);
        if (touch(passing, touch_of(true, shape_.size.x()), time_,
                  finder_.before(feature, feature_of_shape(collider_, kAxis)), Vec3f::Zero(), contact))
            add(contact, feature, kAxis);
    }

    void find_round_vertex(uint32_t vertex) {
        const bool ball = shape_.kind == collision::ShapeKind::sphere;
        SurfaceContact contact;
        Passing passing{};
        passing.of = ball ? Passing::Of::vertex_vertex : Passing::Of::vertex_edge;
        place_vertex(vertex, 0, passing, contact);
        passing.feature[0] = vertex_feature(vertex);
        const int points = ball ? 2 : 3;
        for (int k = 1; k < points; ++k) passing.x[k] = end_[k - 1], passing.v[k] = speed_[k - 1];
        contact.node[1] = of_.node;
        if (spans()) contact.node[2] = of_.node_b;
        const uint64_t feature = feature_of(index_, SurfacePart::vertex, vertex);
        const SurfaceTouch of = touch_of(false, shape_.size.x());
        if (!touch(passing, of, time_, finder_.before(feature, feature_of_shape(collider_, kAxis)), Vec3f::Zero(),
                   contact))
            return;
        if (!spans()) {  // what may turn comes first
            Vec3f middle = Vec3f::Zero();
            for (int k = 1; k < points; ++k) middle -= contact.weight[k] * passing.x[k];
            contact.node[1] = std::exchange(contact.node[0], of_.node);
            contact.weight[0] = -1, contact.weight[1] = 1, contact.weight[2] = 0;
            contact.skin = shape_.size.x() * contact.normal;
            contact.lever = middle + contact.skin - centre_;
        }
        add(contact, feature, kAxis);
    }

    // A vertex as a ball.
    void find_ball(uint32_t vertex) {
        collision::Shape ball;
        ball.kind = collision::ShapeKind::sphere;
        ball.size = {mesh_.radius, 0, 0};
        const Vec3f& middle = mesh_.x[vertex];
        const collision::Placement at{middle.cast<double>(), Mat3f::Identity()};
        const float reach = margin_ + time_ * (mesh_.v[vertex] - velocity_at(middle)).norm();
        const auto take = [&](const collision::Manifold& manifold, uint32_t part) {
            for (int k = 0; k < manifold.count; ++k)
                take_point_of_vertex(vertex, manifold, manifold.points[k], part + static_cast<uint32_t>(k));
        };
        if (!collision::has_parts(shape_)) {
            collision::PairCache cache;
            collision::Manifold manifold;
            collision::collide(ball, at, shape_, at_, reach, cache, manifold);
            take(manifold, kCapsule);
            return;
        }
        collision::collide_parts(ball, at, shape_, at_, reach, scene_.pairs.parts);
        for (const collision::PartManifold& part : scene_.pairs.parts.found)
            take(part.manifold, kCapsule + 2 * part.part);
    }

    void take_point_of_vertex(uint32_t vertex, const collision::Manifold& manifold,
                              const collision::ContactPoint& point, uint32_t number) {
        SurfaceContact contact;
        const Vec3f place = mesh_.x[vertex] + point.position;
        contact.normal = normal_to(vertex_feature(vertex), manifold, mesh_.x[vertex]);
        contact.node[0] = of_.node, contact.node[1] = soft_.node[vertex];
        contact.weight[0] = -1, contact.weight[1] = 1;
        contact.lever = place - centre_;
        contact.gap = point.separation;
        const float closing = contact.normal.dot(velocity_at(place) - mesh_.v[vertex]);
        if (contact.gap - time_ * std::max(closing, 0.0f) > margin_) return;
        finish(contact, feature_of(index_, SurfacePart::vertex, vertex), number);
    }
    void finish(SurfaceContact& contact, uint64_t feature, uint32_t number) {
        const SurfaceTouch of = touch_of(false, 0);
        contact.friction = of.friction, contact.restitution = of.restitution;
        std::ranges::copy(of.collider, contact.collider);
        if (const SurfaceContact* was = finder_.before(feature, feature_of_shape(collider_, number)))
            carry_force(*was, contact);
        add(contact, feature, number);
    }

    void find_faces(const SurfaceBox& box) {
        Array<collision::Corner>& corners = scene_.pairs.surfaces.corner;
        const Mat3f back = at_.rotation.transpose();
        const SurfaceBox& root = mesh_.node.front().box;
        // Where its corners are that get to the surface.
        const SurfaceBox met = SurfaceBox{root.lo.cwiseMax(box.lo), root.hi.cwiseMin(box.hi)}.swept(-way_);
        const Vec3f &lo = met.lo, &hi = met.hi;
        const Vec3f middle = back * (0.5f * (lo + hi) - at_.position.cast<float>());
        const Vec3f half = 0.5f * (back.cwiseAbs() * (hi - lo));
        collision::list_corners(shape_, {middle - half, middle + half}, corners);
        for (const collision::Corner& corner : corners) {
            Vec3f at = at_.position.cast<float>() + at_.rotation * corner.at, velocity = velocity_at(at);
            uint32_t node = of_.node;
            if (spans()) {  // its own axis lies by its ends as they are now
                node = corner.number == 0 ? of_.node : of_.node_b;
                at = end_[corner.number];
                velocity = speed_[corner.number];
            }
            SurfaceBox about = SurfaceBox::none();
            about.add(at);
            about = about.swept(time_ * (velocity - mesh_.drift)).grown(corner.radius + margin_);
            Within within;
            for_triangles_in(mesh_, about, [&](uint32_t t) {
                if (renews(t)) find_face(t, corner, at, velocity, node, within);
            });
            if (within.any) add(within.contact, within.feature, corner.number);
        }
    }

    // Of a corner within a solid, the contact with the face that it leaves by the shortest way.
    struct Within {
        bool any = false;
        SurfaceContact contact;
        uint64_t feature = 0;
    };

    void find_face(uint32_t t, const collision::Corner& corner, const Vec3f& at, const Vec3f& velocity, uint32_t node,
                   Within& within) {
        const uint32_t* vertex = &soft_.triangle[3 * size_t{t}];
        SurfaceContact contact;
        Passing passing{};
        passing.of = Passing::Of::vertex_face;
        passing.x[0] = at, passing.v[0] = velocity;
        contact.node[0] = node;
        for (int k = 0; k < 3; ++k) place_vertex(vertex[k], k + 1, passing, contact);
        const uint64_t feature = feature_of(index_, SurfacePart::face, t);
        Vec3f facing = Vec3f::Zero();
        if (soft_.kind == SoftKind::solid) facing = (passing.x[2] - passing.x[1]).cross(passing.x[3] - passing.x[1]);
        const SurfaceTouch of = touch_of(true, corner.radius);
        if (!touch(passing, of, time_, finder_.before(feature, feature_of_shape(collider_, corner.number)), facing,
                   contact))
            return;
        if (is_round() && vertices_suffice({vertex, 3}, passing, of.both)) return;
        if (!spans()) {
            contact.skin = -corner.radius * contact.normal;
            contact.lever = at + contact.skin - centre_;
        }
        if (soft_.kind == SoftKind::solid && contact.gap + of.both < 0) {
            if (!within.any || contact.gap > within.contact.gap) within = {true, contact, feature};
            return;
        }
        add(contact, feature, corner.number);
    }

    static constexpr uint32_t kAxis = 1u << 31;     // in place of a corner's number
    static constexpr uint32_t kCapsule = 1u << 30;  // likewise: a point of a capsule's manifold

    SurfaceFinder& finder_;
    const SurfaceScene& scene_;
    uint32_t index_, collider_;
    const Soft& soft_;
    const SurfaceMesh& mesh_;
    const Collider& of_;
    const collision::Shape& shape_;
    collision::Placement at_;  // in the mesh's frame
    bool all_;                 // triangles meet it anew
    float time_, margin_ = 0;
    bool in_block_;                   // its elements are solved directly
    Vec3f centre_, velocity_, spin_;  // of its node
    Vec3f way_;                       // of it, as seen from what moves as the surface does on average
    Vec3f end_[2] = {Vec3f::Zero(), Vec3f::Zero()}, speed_[2] = {Vec3f::Zero(), Vec3f::Zero()};
};

// Colliders whose boxes one meets, but for vertices of surfaces.
class NearShapes final : public collision::Visitor {
public:
    NearShapes(const SurfaceScene& scene, const SurfaceMesh& mesh) : scene_(scene), mesh_(mesh) {}

    void visit(uint32_t id, collision::Probe&) override {
        const Collider& collider = scene_.colliders.record[id];
        if (collider.sensor || is_surface_vertex(scene_.nodes, scene_.softs, collider.node)) return;
        if (!mesh_.awake && !moves_now(scene_, id)) return;
        if (!filters_agree(scene_.colliders.traits[id].filter, scene_.colliders.traits[mesh_.collider].filter)) return;
        // Vertices alone meet planes, and find those by pairs but within a frame.
        const bool flat = scene_.shapes[collider.shape].shape.kind == collision::ShapeKind::plane;
        if (flat && scene_.renewed.empty()) return;
        scene_.pairs.surfaces.colliders.push_back(id);
    }

private:
    const SurfaceScene& scene_;
    const SurfaceMesh& mesh_;
};

}  // namespace

void find_surface_shapes(SurfaceFinder& finder) {
    const SurfaceScene& scene = finder.scene();
    for (const uint32_t s : scene.softs.listed) {
        const SurfaceMesh& mesh = scene.softs.mesh[s];
        if (mesh.node.empty()) continue;
        Array<uint32_t>& colliders = scene.pairs.surfaces.colliders;
        colliders.clear();
        const SurfaceBox box = mesh.node.front().box.swept(static_cast<float>(scene.time) * mesh.drift);
        collision::Probe probe{mesh.origin, Vec3::Zero(), box.lo.cast<double>(), box.hi.cast<double>()};
        NearShapes near(scene, mesh);
        // Vertices are among grains.
        const bool grains = !scene.colliders.grains.empty();
        scene.broadphase.visit(
            probe, near,
            grains ? collision::Broadphase::kAll : collision::Broadphase::kMoving | collision::Broadphase::kStanding);
        std::ranges::sort(colliders);
        for (const uint32_t collider : colliders) SurfaceShape(finder, s, collider).find();
    }
}

}  // namespace taut
