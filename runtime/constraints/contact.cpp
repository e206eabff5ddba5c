// Contact point with the normal and tangents of its detection.
// C = basis (p_b - p_a) + offset: separation and slip [m], p = x + R s + skin;  J = basis of the ball joint's J with
// the levers R s + skin;  K: the force basis^T lambda at the levers R s, as the skin does not turn. Row 0 pushes only,
// rows 1 and 2 stay within friction * row 0; their C is not enforced, only J v = 0 on the cone.
#include "constraints/contact.h"

#include <algorithm>

#include "constraints/constraint.h"
#include "constraints/lever.h"
#include "constraints/random.h"

namespace taut {
namespace {

void evaluate_contact(const void* data, const Pose* x, double* error, double* jacobian) {
    const auto& point = *static_cast<const ContactData*>(data);
    const Vec3 ra = x[0].R * point.anchor_a + point.skin_a, rb = x[1].R * point.anchor_b + point.skin_b;
    Vec3::Map(error) = point.basis * ((x[1].x - x[0].x) + (rb - ra)) + point.offset;
    if (!jacobian) return;
    set_block(jacobian, 3, 0, 0, -point.basis);
    set_block(jacobian, 3, 0, 3, point.basis * hat(ra));
    set_block(jacobian, 3, 1, 0, point.basis);
    set_block(jacobian, 3, 1, 3, -point.basis * hat(rb));
}

void stiffness_of_contact(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const auto& point = *static_cast<const ContactData*>(data);
    const Vec3 f = point.basis.transpose() * Vec3::Map(lambda);
    std::fill(k, k + 12 * 12, 0.0);
    add_block(k, 3, 3, lever_stiffness(-f, x[0].R * point.anchor_a, part));
    add_block(k, 9, 9, lever_stiffness(f, x[1].R * point.anchor_b, part));
}

void sample_contact(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& point = *static_cast<ContactData*>(data);
    point.anchor_a = random.vector();
    point.anchor_b = random.vector();
    point.offset = random.vector();
    point.basis = random.rotation().toRotationMatrix();
    random.poses(x, 2);
}

}  // namespace

const ConstraintType kContact{
    "contact",     3, 2, sizeof(ContactData), Bound::cone, false, 0, evaluate_contact, stiffness_of_contact, nullptr,
    sample_contact};

}  // namespace taut
