// A body as its state is told by the interface: how its points move, and what it takes to move them.
#pragma once

#include <taut/body.h>

#include "base/math.h"

namespace taut {

struct BodyMotion {
    taut_body_kind kind = TAUT_BODY_STATIC;
    Vec3 origin = Vec3::Zero(), centre = Vec3::Zero();  // [m]
    Quat rotation = Quat::Identity();
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();  // of the centre of mass [m/s], [rad/s]
    double inv_mass = 0;                                 // [1/kg]
    Vec3 unlocked = Vec3::Ones();                        // 0 along axes that are locked, else 1
    Mat3 inv_inertia = Mat3::Zero();                     // about the centre, world axes, without those that are locked

    bool is_pushed() const { return inv_mass > 0; }
    Vec3 velocity_of(const Vec3& point) const { return linear + angular.cross(point - centre); }
    // Inverse of the mass that a point has along a unit direction: 1/m + (r x n) I^-1 (r x n).
    double inv_mass_of(const Vec3& point, const Vec3& direction) const {
        const Vec3 turn = (point - centre).cross(direction);
        return linear_inv_mass(direction) + turn.dot(inv_inertia * turn);
    }
    double linear_inv_mass(const Vec3& direction) const {
        return unlocked == Vec3::Ones() ? inv_mass : inv_mass * direction.cwiseProduct(unlocked).squaredNorm();
    }
};

taut_result read_motion(taut_body body, BodyMotion& out);

}  // namespace taut
