#include "movers/body_motion.h"

#include "api/access.h"
#include "state/nodes.h"

namespace taut {

taut_result read_motion(taut_body body, BodyMotion& out) {
    taut_pose pose;
    taut_vec3 linear, angular, centre;
    float mass = 0;
    taut_sym3 inertia;
    uint32_t locked = 0;
    taut_result result = taut_body_get_kind(body, &out.kind);
    if (result == TAUT_OK) result = taut_body_get_pose(body, &pose);
    if (result == TAUT_OK) result = taut_body_get_velocity(body, &linear, &angular);
    if (result == TAUT_OK) result = taut_body_get_mass(body, &mass, &centre, &inertia);
    if (result == TAUT_OK) result = taut_body_get_locked_axes(body, &locked);
    if (result != TAUT_OK) return result;
    out.rotation = to_quat(pose.rotation);
    out.origin = to_vec(pose.position);
    out.centre = out.origin + out.rotation * to_vec(centre);
    out.linear = to_vec(linear);
    out.angular = to_vec(angular);
    out.inv_mass = mass > 0 ? 1 / static_cast<double>(mass) : 0.0;
    out.inv_inertia.setZero();  // of a particle, which does not turn
    const Mat3 own = Sym3{inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.xz, inertia.yz}.matrix();
    if (mass > 0 && own.determinant() > 0) {
        const Mat3 turn = out.rotation.toRotationMatrix();
        out.inv_inertia = turn * own.inverse() * turn.transpose();
        const Locks locks{static_cast<uint8_t>(locked)};
        if (locks.any_angular()) out.inv_inertia = free_inverse(turn * own * turn.transpose(), locks);
        for (int i = 0; i < 3; ++i) out.unlocked[i] = locks.linear(i) ? 0 : 1;
    }
    return TAUT_OK;
}

}  // namespace taut
