#include "integrate/gyroscopic.h"

#include <cmath>

#include <Eigen/LU>

#include "base/math.h"

namespace taut {

// One Newton step of implicit Euler, I (w - w0) + h w x I w = 0: damps, but goes astray where a substep turns the body
// by radians (measured: a plate at 1000 rad/s gained 9400 times its energy). So w.I w does not rise, and of a body that
// is to keep it |I w| does not fall further than that asks.
void gyroscopic_euler(double spin[3], const double i[6], double h, bool damped) {
    Vec3::MapType out(spin);
    const Vec3 w0 = out;
    const Mat3 inertia = Sym3{i[0], i[1], i[2], i[3], i[4], i[5]}.matrix();
    const Vec3 l0 = inertia * w0;
    const Mat3 derivative = inertia + h * (hat(w0) * inertia - hat(l0));
    const Vec3 w = w0 - derivative.inverse() * (h * w0.cross(l0)), l = inertia * w;
    const double before = w0.dot(l0), after = w.dot(l), scale = damped ? 1 : std::sqrt(l0.dot(l0) / l.dot(l));
    out = (scale * scale * after > before ? std::sqrt(before / after) : scale) * w;
}

}  // namespace taut
