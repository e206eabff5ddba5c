// What surfaces of soft bodies have found so far, and what they had in touch before.
#pragma once

#include <span>

#include "detect/nearest.h"
#include "detect/surface_cone.h"
#include "detect/surface_contacts.h"

namespace taut {

enum class SurfacePart : uint64_t { vertex, edge, face, cut };

// Names of features in SurfaceContact.
constexpr uint64_t feature_of(uint32_t soft, SurfacePart part, uint32_t index) {
    return uint64_t{soft} << 32 | static_cast<uint64_t>(part) << 30 | index;
}
constexpr uint32_t index_of(uint64_t feature) { return static_cast<uint32_t>(feature) & ((1u << 30) - 1); }
constexpr SurfacePart part_of(uint64_t feature) { return static_cast<SurfacePart>(feature >> 30 & 3); }
constexpr bool is_of_shape(uint64_t feature) { return feature >> 63 != 0; }
constexpr uint32_t collider_of_shape(uint64_t feature) { return static_cast<uint32_t>(feature >> 32) & ~(1u << 31); }
constexpr uint64_t feature_of_shape(uint32_t collider, uint32_t number) {
    return uint64_t{1} << 63 | uint64_t{collider} << 32 | number;
}

// Whether forces or its host move a node in this frame.
inline bool moves_now(const Nodes& nodes, uint32_t node) {
    const NodeKind kind = nodes.info[node].kind;
    return nodes.rest[node] != Rest::asleep && (moves_by_forces(kind) || kind == NodeKind::kinematic);
}
bool moves_now(const SurfaceScene& scene, uint32_t collider);

// What two sides make of their contacts.
struct SurfaceTouch {
    uint32_t collider[2];  // of the sides whose weights are positive, negative
    float friction, restitution;
    float both;    // radii of the two features together [m]
    float margin;  // how far apart they get contacts [m]
};

class SurfaceFinder {
public:
    explicit SurfaceFinder(const SurfaceScene& scene);

    // A contact of two features in touch before; null: they were not.
    const SurfaceContact* before(uint64_t a, uint64_t b) const;
    // What materials make of two colliders' contacts, but for their sizes.
    SurfaceTouch touch_of(uint32_t positive, uint32_t negative) const;
    // Whether a joint or attachment forbids a contact between two sides.
    bool tied(std::span<const uint32_t> a, std::span<const uint32_t> b) const;
    // Within a frame those alone whose nodes may all be renewed.
    void add(const SurfaceContact& contact) {
        for (const uint32_t node : contact.node)
            if (node != kNone && !scene_.may_renew(node)) return;
        found_.push_back(contact);
    }
    std::span<const SurfaceContact> all_before() const { return before_; }
    // Whether one of before is found anew, or is not there any more.
    bool renews(const SurfaceContact& contact) const;
    // Whether all those of a soft body with a shape are: also of triangles that keep to their ways.
    bool renews_all(uint32_t soft, uint32_t collider) const;
    // Those in touch before of which no side has moved since, or that are not to be renewed: they stay.
    void keep_still();

    const SurfaceScene& scene() const { return scene_; }

private:
    const SurfaceScene& scene_;
    std::span<const SurfaceContact> before_;
    std::span<const SurfaceContactName> name_before_;  // of the same
    Array<SurfaceContact>& found_;
};

// Two features under way, of four points in all, of which those of the first come first.
struct Passing {
    enum class Of : uint8_t { vertex_face, edge_edge, vertex_edge, vertex_vertex };

    Of of;
    Vec3f x[4];  // [m]; unused ones 0
    Vec3f v[4];  // [m/s]
    // Vertices and edges of surfaces among the two, beyond whose normals no contact points.
    SurfaceFeature feature[2];

    int first() const { return of == Of::edge_edge ? 2 : 1; }
    int points() const { return of == Of::vertex_vertex ? 2 : of == Of::vertex_edge ? 3 : 4; }
    void at(float time, Vec3f (&out)[4]) const {
        for (int i = 0; i < 4; ++i) out[i] = x[i] + time * v[i];
    }
    Nearest nearest(const Vec3f (&at)[4]) const;
    // Of a point of one against one of the other, at most [m/s].
    float speed() const;
    // Its shortest edge [m]: what is further through than that was never through.
    float size() const;
};

// When two features first come within a reach, by conservative advancement: the distance falls no faster than they
// move. Where they are then, in out, and when, in met [s]; false: not in the time.
bool meet(const Passing& passing, float reach, float time, Nearest& out, float& met);

// Whether they are on the wrong side by what they were before, and not too far for that.
bool is_through(const Passing& passing, const SurfaceContact& was);

// What a contact takes over of the one before, whose normal may be another.
void carry_force(const SurfaceContact& was, SurfaceContact& contact);

// Meets and gives weights, normal and gap. was: their contact before, whose side counts, or null. facing: outward of
// the second feature where that is a solid's, else 0. False: they do not touch within both features.
bool touch(const Passing& passing, const SurfaceTouch& of, float time, const SurfaceContact* was, const Vec3f& facing,
           SurfaceContact& contact);

// Contacts of a surface with itself and of two with each other; of one with shapes.
void find_surface_pairs(Team& team, SurfaceFinder& finder);
void find_surface_shapes(SurfaceFinder& finder);

}  // namespace taut
