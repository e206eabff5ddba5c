// Any two convex shapes that answer "which of your points lies furthest along d", by libccd's MPR; faces are
// clipped where both shapes have one that meets the direction found.
#include <cmath>

#include <ccd/ccd.h>

#include "collision/manifold.h"
#include "collision/narrowphase/convex.h"

namespace taut::collision {
namespace {

// MPR's own stop [m]; it halves its error about every step, so the bound on steps is far off.
constexpr double kTolerance = 1e-5;
constexpr unsigned long kMaxSteps = 100;

// A face meets the direction if its normal is within 8 degrees of it.
constexpr float kMeets = 0.99f;

// A shape placed about a's origin, grown by half the margin so that near shapes overlap.
struct Placed {
    const Shape& shape;
    Vec3 position;
    Mat3 rotation;
    double grown;
};

void support_of(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out) {
    const Placed& placed = *static_cast<const Placed*>(object);
    const Vec3 d = Vec3(direction->v[0], direction->v[1], direction->v[2]).normalized();
    const Vec3 local = placed.rotation.transpose() * d;
    const Vec3 p = placed.rotation * furthest_point(placed.shape, local) + placed.position + d * placed.grown;
    ccdVec3Set(out, p.x(), p.y(), p.z());
}

void centre_of(const void* object, ccd_vec3_t* out) {
    const Placed& placed = *static_cast<const Placed*>(object);
    const Vec3 local = placed.shape.hull ? Vec3(placed.shape.hull->centre.cast<double>()) : Vec3(Vec3::Zero());
    const Vec3 p = placed.rotation * local + placed.position;
    ccdVec3Set(out, p.x(), p.y(), p.z());
}

bool has_faces(const Shape& shape) { return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull; }

// The face that looks most along the direction; null if none meets it.
const Face* face_towards(const Polytope& polytope, const Vec3f& direction) {
    const Face* best = nullptr;
    float most = kMeets;
    for (const Face& face : polytope.faces) {
        const float dot = face.normal.dot(direction);
        if (dot > most) {
            most = dot;
            best = &face;
        }
    }
    return best;
}

// b's face against a's along the unit normal; false if one of them has none there.
bool clip_faces(const Placed& a, const Placed& b, float margin, Manifold& out) {
    const PolytopeOf storage_a(a.shape);
    const PolytopeOf storage_b(b.shape);
    const Polytope& polytope_a = storage_a.view();
    const Polytope& polytope_b = storage_b.view();
    const Mat3f axes_a = a.rotation.cast<float>();
    const Mat3f axes_b = b.rotation.cast<float>();
    const Vec3f normal_in_a = axes_a.transpose() * out.normal;
    const Face* reference = face_towards(polytope_a, normal_in_a);
    const Face* incident = face_towards(polytope_b, axes_b.transpose() * -out.normal);
    if (!reference || !incident) return false;

    const float slant = reference->normal.dot(normal_in_a);
    const Mat3f b_in_a = axes_a.transpose() * axes_b;
    const Vec3f offset = axes_a.transpose() * b.position.cast<float>();
    Polygon polygon;
    for (const int corner : polytope_b.loop_of(*incident)) {
        const Vec3f p = b_in_a * polytope_b.vertices[size_t(corner)] + offset;
        const float height = (reference->normal.dot(p) - reference->offset) / slant;
        polygon.points[polygon.count] = {reference->u.dot(p), reference->v.dot(p), height, uint32_t(polygon.count)};
        ++polygon.count;
    }
    clip(polygon, polytope_a.sides_of(*reference), flush_slack(polytope_a.inner_radius));
    const uint32_t base =
        face_base(false, int(reference - polytope_a.faces.data()), int(incident - polytope_b.faces.data()));
    add_points(polygon, {reference->u, reference->v, reference->normal, reference->offset}, base, margin, out);
    for (int i = 0; i < out.count; ++i) out.points[i].position = axes_a * out.points[i].position;
    return out.count > 0;
}

}  // namespace

void collide_support_mapped(const Shape& shape_a, const Placement& at_a, const Shape& shape_b, const Placement& at_b,
                            float margin, Manifold& out) {
    out.count = 0;
    const double grown = 0.5 * double(margin);
    const Placed a = {shape_a, Vec3::Zero(), at_a.rotation.cast<double>(), grown};
    const Placed b = {shape_b, at_b.position - at_a.position, at_b.rotation.cast<double>(), grown};
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = support_of;
    ccd.center1 = ccd.center2 = centre_of;
    ccd.mpr_tolerance = kTolerance;
    ccd.max_iterations = kMaxSteps;
    ccd_real_t depth;
    ccd_vec3_t direction, position;
    if (ccdMPRPenetration(&a, &b, &ccd, &depth, &direction, &position) != 0) return;
    out.normal = Vec3(direction.v[0], direction.v[1], direction.v[2]).normalized().cast<float>();
    if (!out.normal.allFinite() || out.normal.squaredNorm() < 0.5f) out.normal = Vec3f::UnitY();  // centres coincide
    if (has_faces(shape_a) && has_faces(shape_b) && clip_faces(a, b, margin, out)) return;
    const Vec3f middle = Vec3(position.v[0], position.v[1], position.v[2]).cast<float>();
    out.count = 1;
    out.points[0] = {middle, margin - float(depth), vertex_feature(0)};
}

}  // namespace taut::collision
