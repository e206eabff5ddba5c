// Anchors and attachments for tests, made through the public C API.
#pragma once

#include "physics/deformable_lab.h"

namespace lab {

inline taut_anchor anchor_on(const World& world, taut_body body, const Vec& place) {
    taut_anchor out{};
    ok(taut_world_get_anchor(world.handle, body, place.pos(), &out));
    return out;
}
inline taut_anchor anchor_in_world(const World& world, const Vec& place) { return anchor_on(world, {}, place); }
inline taut_anchor anchor_on(taut_cloth cloth, const Vec& place) {
    taut_anchor out{};
    ok(taut_cloth_find_anchor(cloth, place.pos(), &out, nullptr));
    return out;
}
inline taut_anchor anchor_on(taut_solid solid, const Vec& place) {
    taut_anchor out{};
    ok(taut_solid_find_anchor(solid, place.pos(), &out, nullptr));
    return out;
}
// Of particles, with these weights.
inline taut_anchor anchor_of(const std::vector<taut_body>& bodies, const std::vector<double>& weights) {
    taut_anchor out{};
    out.count = static_cast<uint32_t>(bodies.size());
    for (size_t n = 0; n < bodies.size(); ++n) {
        out.bodies[n] = bodies[n];
        out.weights[n] = static_cast<float>(weights[n]);
    }
    return out;
}

struct AttachmentPlan {
    taut_attachment_kind kind = TAUT_ATTACHMENT_BALL;
    double length = 0, compliance = 0, damping = 0, break_force = 0, break_torque = 0;
    taut_joint_solve solve = TAUT_JOINT_SOLVE_DIRECT;
    bool collide = false;
    bool pulls = false;
    double limit = 0, limit_compliance = 0;
};

inline taut_attachment attach(const World& world, const taut_anchor& a, const taut_anchor& b,
                              const AttachmentPlan& plan = {}) {
    taut_attachment_def def;
    taut_attachment_def_init(&def);
    def.kind = plan.kind;
    def.a = a;
    def.b = b;
    def.length = static_cast<float>(plan.length);
    def.compliance = static_cast<float>(plan.compliance);
    def.damping = static_cast<float>(plan.damping);
    def.break_force = static_cast<float>(plan.break_force);
    def.break_torque = static_cast<float>(plan.break_torque);
    def.solve = plan.solve;
    def.collide_connected = plan.collide ? 1 : 0;
    def.pulls = plan.pulls ? 1 : 0;
    def.limit = static_cast<float>(plan.limit);
    def.limit_compliance = static_cast<float>(plan.limit_compliance);
    taut_attachment out{};
    ok(taut_world_add_attachment(world.handle, &def, &out));
    return out;
}

inline Vec force_of(taut_attachment attachment) {
    taut_vec3 out{};
    ok(taut_attachment_get_force(attachment, &out));
    return out;
}
inline double error_of(taut_attachment attachment) {
    float out = 0;
    ok(taut_attachment_get_error(attachment, &out));
    return static_cast<double>(out);
}

// Two end points of an attachment.
inline std::pair<Vec, Vec> points_of(taut_attachment attachment) {
    taut_pos a{}, b{};
    ok(taut_attachment_get_points(attachment, &a, &b));
    return {a, b};
}

}  // namespace lab
