// Internal faces: where solids lie side by side, as the tiles of a floor, the faces between them are inside of what
// they make up together. A body that lies on one solid cannot come by those of the next, yet the axis that parts it
// from that solid most is as a rule the normal of just such a face, and it would trip over the joint ("ghost
// collision").
//
// A contact holds its body on the near side of a plane, n . p >= c. What of another solid's faces stays below it,
// n . p <= c, the body does not meet, but for faces that go on in the plane, or fall away from it behind the contact:
// these it comes onto. Edges and vertices are met along normals between those of their faces, of which the internal
// ones do not count; so the contact is along a face that rises above the plane, or along the plane's normal with what
// is below it, whichever separates most.
#include "collision/internal_face.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/face_contact.h"
#include "collision/narrowphase/surface.h"

namespace taut::collision {
namespace {

// Directions closer than this are one, as edges that bend by less are flat: sine.
constexpr float kBend = 1e-3f;

constexpr float kNowhere = -1e30f;  // height of what is not near the body

// The plane of a cover as a contact of a body with another solid sees it.
class Horizon {
public:
    Horizon(const Shape& body, const SolidContact& contact, const Cover& cover)
        : cover_(cover), slack_(flush_tolerance(body)) {
        at_ = Vec3f::Zero();
        for (int k = 0; k < contact.count; ++k) at_ += contact.points[k] / float(contact.count);
    }

    float slack() const { return slack_; }
    float height(const Vec3f& p) const { return cover_.normal.dot(p) - cover_.offset; }
    // Whether a face looks the plane's way, to the tolerance over all of the body.
    bool is_level(const Vec3f& normal) const {
        const float along = normal.dot(cover_.normal);
        return along > 0 && (normal - along * cover_.normal).norm() <= std::max(kBend, slack_ / cover_.reach);
    }
    // Whether a face that does not rise above the plane goes on in it, or falls away from it behind the contact.
    bool goes_on(const Vec3f& normal) const {
        const float along = normal.dot(cover_.normal);
        if (along <= kBend) return false;
        return is_level(normal) || (normal - along * cover_.normal).dot(at_ - cover_.middle) > 0;
    }
    // How high a polygon reaches near the body; kNowhere: it does not. u, v: tangents of its plane.
    float top(Polygon& polygon, const Vec3f& u, const Vec3f& v) const {
        const float x = u.dot(cover_.body), y = v.dot(cover_.body), r = cover_.reach;
        const std::array<Side, 4> sides = {{{1, 0, x + r}, {-1, 0, r - x}, {0, 1, y + r}, {0, -1, r - y}}};
        clip(polygon, sides, 0);
        float most = kNowhere;
        for (int i = 0; i < polygon.count; ++i) most = std::max(most, polygon.points[i].z);
        return most;
    }

private:
    const Cover& cover_;
    float slack_;
    Vec3f at_;  // middle of the contact
};

// The faces of a box or hull.
class FacesMet {
public:
    FacesMet(const Polytope& solid, const Horizon& horizon) : solid_(solid), horizon_(horizon) {}

    bool rises(const Face& face) const { return top(face) > horizon_.slack(); }
    // How high a face reaches near the body.
    float top(const Face& face) const {
        Polygon polygon;
        for (const uint8_t corner : solid_.loop_of(face)) {
            const Vec3f& p = solid_.vertices[corner];
            polygon.points[polygon.count] = {face.u.dot(p), face.v.dot(p), horizon_.height(p), uint32_t(polygon.count)};
            ++polygon.count;
        }
        return horizon_.top(polygon, face.u, face.v);
    }
    bool is_internal(const Face& face) const { return !horizon_.goes_on(face.normal) && !rises(face); }
    bool touches(const SolidContact& contact, const Face& face) const {
        return std::any_of(contact.points, contact.points + contact.count, [&](const Vec3f& p) {
            return std::fabs(face.normal.dot(p) - face.offset) <= horizon_.slack();
        });
    }
    // Whether the contact is along a normal that only an internal face lends it.
    bool is_internal(const SolidContact& contact) const {
        bool internal = false;
        for (const Face& face : solid_.faces) {
            const float along = contact.normal.dot(face.normal);
            if (along <= kBend || !touches(contact, face)) continue;
            const bool hidden = is_internal(face);
            if (!hidden && (contact.normal - face.normal).norm() <= kBend) return false;
            internal = internal || hidden;
        }
        return internal;
    }
    // The sides of a face that rises over an edge that it shares with an internal one: on beyond it, below the plane,
    // it hinders nobody, and what comes up to it meets it in time.
    std::span<const Side> open_sides(const Face& face, std::array<Side, kMaxVertices>& room) const {
        const auto sides = solid_.sides_of(face);
        if (!rises(face)) return sides;
        const auto loop = solid_.loop_of(face);
        size_t count = 0;
        for (size_t i = 0; i < sides.size(); ++i)
            if (!is_internal(across(face, loop[i], loop[i + 1 < loop.size() ? i + 1 : 0]))) room[count++] = sides[i];
        return std::span(room).first(count);
    }

private:
    // The other face at an edge.
    const Face& across(const Face& face, uint8_t from, uint8_t to) const {
        for (const Edge& edge : solid_.edges) {
            if (edge.from == from && edge.to == to) return solid_.faces[edge.right];
            if (edge.from == to && edge.to == from) return solid_.faces[edge.left];
        }
        return face;
    }

    const Polytope& solid_;
    const Horizon& horizon_;
};

// The points of a body over a face.
void touch_face(const FlatFace& face, const Solid& body, const Pose& pose, uint32_t base, float slack,
                const Wanted& wanted, Manifold& out) {
    const Feature feature = body.feature_along(pose.rotation.transpose() * -face.normal);
    if (!body.polytope()) return face_contact(face, body, pose, base, slack, wanted, out);
    const FlatFace incident = body.face(feature.face);
    Polygon polygon;
    for (const uint8_t corner : incident.loop) {
        const Vec3f p = pose * incident.vertices[corner];
        polygon.points[polygon.count] = {face.u.dot(p), face.v.dot(p), face.normal.dot(p) - face.offset,
                                         uint32_t(polygon.count)};
        ++polygon.count;
    }
    clip(polygon, face.sides, slack);
    out.normal = face.normal;
    add_points(polygon, {face.u, face.v, face.normal, face.offset}, base | uint32_t(feature.face) << 14, wanted, out);
}

// What is below the plane is met along the plane's own normal: from each point of the body as far down to the face.
void lean(const Vec3f& normal, Manifold& out) {
    const float along = out.normal.dot(normal);
    for (int k = 0; k < out.count; ++k) {
        ContactPoint& point = out.points[k];
        const Vec3f of_body = point.position + 0.5f * point.separation * out.normal;
        point.separation /= along;
        point.position = of_body - 0.5f * point.separation * normal;
    }
    out.normal = normal;
}

// How high the triangles of a facet near the body reach.
class FacetTop final : public TriangleSink {
public:
    FacetTop(const Shape& shape, uint32_t facet, const Horizon& horizon)
        : surface_(*shape.surface), scale_(shape.size), facet_(facet), horizon_(horizon) {}

    void take(uint32_t triangle) override {
        if (surface_.facet_of[triangle] != facet_) return;
        Vec3f at[3];
        const Corners corners = surface_.corners(triangle);
        for (size_t i = 0; i < 3; ++i) at[i] = surface_.vertex(corners[i]).cwiseProduct(scale_);
        const Vec3f u = (at[1] - at[0]).normalized(), v = u.cross(at[2] - at[0]).cross(u).normalized();
        Polygon polygon;
        polygon.count = 3;
        for (uint32_t i = 0; i < 3; ++i) polygon.points[i] = {u.dot(at[i]), v.dot(at[i]), horizon_.height(at[i]), i};
        top = std::max(top, horizon_.top(polygon, u, v));
    }

    float top = kNowhere;

private:
    const Surface& surface_;
    const Vec3f scale_;
    const uint32_t facet_;
    const Horizon& horizon_;
};

// Edges and vertices in the plane or below it; facets that end there.
bool is_internal_part(const Shape& shape, uint32_t part, const SolidContact& contact, const Cover& cover,
                      const Horizon& horizon) {
    if (horizon.goes_on(contact.normal)) return false;
    if (!is_face(part))
        return std::all_of(contact.points, contact.points + contact.count,
                           [&](const Vec3f& p) { return horizon.height(p) <= horizon.slack(); });
    const Vec3f reach = Vec3f::Constant(cover.reach);
    const Vec3f p = (cover.body - reach).cwiseQuotient(shape.size), q = (cover.body + reach).cwiseQuotient(shape.size);
    FacetTop found(shape, part - 1, horizon);
    shape.surface->find({p.cwiseMin(q), p.cwiseMax(q)}, found);
    return found.top <= horizon.slack();
}

bool is_polytope(const Shape& shape) { return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull; }

Pose pose_in(const Placement& solid, const Placement& body) {
    const Mat3f back = solid.rotation.transpose();
    return {back * body.rotation, back * (body.position - solid.position).cast<float>()};
}

}  // namespace

// As of clipping.
float flush_tolerance(const Shape& body) { return flush_slack(inner_radius(body)); }

bool is_internal(const Shape& body, const Shape& solid, uint32_t part, const SolidContact& contact,
                 const Cover& cover) {
    const Horizon horizon(body, contact, cover);
    if (has_parts(solid)) return is_internal_part(solid, part, contact, cover, horizon);
    if (!is_polytope(solid)) return false;
    const PolytopeOf polytope(solid);
    return FacesMet(polytope.view(), horizon).is_internal(contact);
}

void collide_open(const Shape& body, const Placement& at_body, const Shape& solid, const Placement& at_solid,
                  const SolidContact& contact, const Cover& cover, bool solid_is_b, float margin, Manifold& out) {
    out.count = 0;
    if (!is_polytope(solid)) return;
    const Horizon horizon(body, contact, cover);
    const Solid sides(solid), other(body);
    const FacesMet faces(*sides.polytope(), horizon);
    const Pose pose = pose_in(at_solid, at_body);
    const auto lowest = [&](const Vec3f& normal) {
        const Vec3 down = (pose.rotation.transpose() * -normal).cast<double>().normalized();
        return normal.dot(pose * furthest_point(body, down).cast<float>());
    };
    int best = -1;
    float most = -1e30f;
    for (int i = 0; i < sides.faces(); ++i) {
        const Face& face = sides.polytope()->faces[size_t(i)];
        const float top = faces.top(face);
        const bool rises = top > horizon.slack();
        if (top == kNowhere || (!rises && face.normal.dot(cover.normal) <= kBend)) continue;
        const float separation = rises ? lowest(face.normal) - face.offset : lowest(cover.normal) - cover.offset - top;
        if (separation <= most) continue;
        best = i;
        most = separation;
    }
    if (best < 0 || most > margin) return;
    const bool rises = faces.rises(sides.polytope()->faces[size_t(best)]);
    FlatFace face = sides.face(best);
    std::array<Side, kMaxVertices> room;
    const auto open = faces.open_sides(sides.polytope()->faces[size_t(best)], room);
    if (open.size() < face.sides.size()) face.loop = {};
    face.sides = open;
    const float slack = flush_slack(sides.polytope()->inner_radius);
    touch_face(face, other, pose, face_base(solid_is_b, best, 0), slack, margin, out);
    if (!rises && !horizon.is_level(face.normal)) lean(cover.normal, out);
    // From the solid's frame to axes of the world.
    const Vec3f from_a = solid_is_b ? Vec3f((at_solid.position - at_body.position).cast<float>()) : Vec3f::Zero();
    const Vec3f normal = at_solid.rotation * out.normal;
    out.normal = solid_is_b ? Vec3f(-normal) : normal;
    for (int k = 0; k < out.count; ++k) out.points[k].position = from_a + at_solid.rotation * out.points[k].position;
}

}  // namespace taut::collision
