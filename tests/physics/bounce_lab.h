// Energy and heights of what flies, free of what the reading of a velocity costs: an engine's velocity v is that of the
// end of a substep h, and a body's places lie on the parabola of v + h a / 2 through them.
#pragma once

#include <algorithm>

#include "physics/lab.h"

namespace lab {

inline double gravity_of(const World& world) { return -static_cast<double>(world.def.gravity.y); }

// Of mass, in the body's frame.
inline Vec centre_of(taut_body body) {
    float mass = 0;
    taut_vec3 centre{};
    taut_sym3 inertia{};
    ok(taut_body_get_mass(body, &mass, &centre, &inertia));
    return centre;
}

inline Vec flight_velocity(const World& world, taut_body body) {
    return velocity(body) -
           0.5 * static_cast<double>(world.def.time_step) / world.def.substeps * Vec(0, gravity_of(world), 0);
}

// Kinetic and potential energy of bodies, in flight at that velocity [J].
inline double energy(const World& world, const std::vector<taut_body>& bodies) {
    double sum = 0;
    for (const taut_body body : bodies) {
        const BodyState s = state(body);
        const Mass m = mass_of(body);
        const Vec v = flight_velocity(world, body), centre = s.position + s.rotation.rotate(centre_of(body));
        sum += 0.5 * m.mass * dot(v, v) + 0.5 * dot(s.spin, spin_momentum(s, m.inertia)) +
               m.mass * gravity_of(world) * centre.y;
    }
    return sum;
}

// Highest points of a ball's flights, over what it is on, one after the other, at most so many.
inline std::vector<double> peaks(const World& world, taut_body ball, double ground, size_t most, double seconds) {
    std::vector<double> out;
    const double g = gravity_of(world);
    double rising = 0, top = 0;
    for (double t = 0; t < seconds && out.size() < most; t += world.frame()) {
        world.step();
        const double v = flight_velocity(world, ball).y;
        if (rising > 0 && v <= 0) out.push_back(top);
        top = position(ball).y - ground + v * v / (2 * g);
        rising = v;
    }
    return out;
}

}  // namespace lab
