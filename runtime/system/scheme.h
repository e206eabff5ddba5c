// Time integration of one substep, and the only place that knows h^2 and 1/h. Every scheme moves nodes by
//
//   x' = x_n + h u,   u = u* + t W f,   v' = v~ + s W f,   mu = t lambda
//
// where f = J^T lambda are the forces of springs, at the end of the substep, and t, s the times for which they act.
// Rigid rows and contacts give impulses to u, and the same ones to v':
//   implicit Euler     t = h,         s = h            u* = v~ = v_n + h a
//   Newmark            t = beta h,    s = gamma h      u* = v_n + h ((1/2 - beta) f_n/m + a/2),
//                                                      v~ = v_n + h ((1 - gamma) f_n/m + a)
//   BDF2               t = 4/9 h,     s = 2/3 h        u* = u_{n-1}/3 + 2/3 v~,  v~ = 4/3 v_n - v_{n-1}/3 + 2/3 h a
// (Frâncu 2016, eq. 6.28 to 6.32; a: external accelerations, u_{n-1} h the last displacement). A row is, with its
// compliance C, damping time d and rate J u (eq. 6.44 and 6.50),
//   J u + c mu = -error / (h + d),   c = C / (t (h + d))
// and geometric stiffness enters the nodes as t h K.
#pragma once

#include <cstdint>

namespace taut {

enum class SchemeKind : uint8_t { implicit_euler, newmark, bdf2 };

struct Scheme {
    SchemeKind kind = SchemeKind::implicit_euler;
    double beta = 0.25, gamma = 0.5;  // of Newmark
    double h = 0;                     // substep [s]
    double act = 0;                   // t [s]
    double velocity_act = 0;          // s [s]

    void set_length(double substep) {
        h = act = velocity_act = substep;
        if (kind == SchemeKind::newmark) act = beta * h, velocity_act = gamma * h;
        if (kind == SchemeKind::bdf2) act = 4.0 / 9 * h, velocity_act = 2.0 / 3 * h;
    }
    // Velocities at the end of a substep are those that moved the positions.
    bool is_one_step() const { return kind == SchemeKind::implicit_euler; }

    double impulse(double force) const { return act * force; }
    double force(double impulse) const { return impulse / act; }
    double stiffness() const { return h * act; }                           // of K in the nodes [s^2]
    double row_compliance(double d) const { return 1 / (act * (h + d)); }  // c / C
    double row_rate(double d) const { return 1 / (h + d); }                // -target / error
};

}  // namespace taut
