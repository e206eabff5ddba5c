// Time integration of one substep, as rows see it. Every scheme (integrate/scheme.h) moves nodes by
//
//   x' = x_n + h u,   u = u* + t W f,   v' = v~ + s W f,   mu = t lambda
//
// where f = J^T lambda are the forces of springs, at the end of the substep, and t, s the times for which they act.
// Rigid rows and contacts give impulses to u, and the same ones to v'. A row is, with its compliance C, damping time d
// and rate J u (Frâncu 2016, eq. 6.44 and 6.50),
//   J u + c mu = -error / (h + d),   c = C / (t (h + d))
// and geometric stiffness enters the nodes as t h K. This is the only place that knows h^2 and 1/h of rows.
//
// Contacts by penalty are no springs of the scheme: a force p of theirs, at the end of the substep, acts as if it were
// constant (Kane, Repetto, Ortiz and Marsden 1999), u gains c W p and v' h W p, with c = h in one step and h/2 in
// others. What lies still then does so at p of its weight, and with u of Newmark's (v_n + v')/2 the work of p is -p
// times the way, which is no more than what a convex penalty loses.
#pragma once

namespace taut {

struct Scheme {
    double act_share = 1, velocity_share = 1;  // t / h, s / h
    bool one_step = true;                      // v' = u: velocities are those that moved the positions
    double h = 0;                              // substep [s]
    double act = 0;                            // t [s]
    double velocity_act = 0;                   // s [s]

    void set_length(double substep) {
        h = substep;
        act = act_share * h;
        velocity_act = velocity_share * h;
    }
    bool is_one_step() const { return one_step; }

    double impulse(double force) const { return act * force; }
    double force(double impulse) const { return impulse / act; }
    double stiffness() const { return h * act; }                           // of K in the nodes [s^2]
    double contact_act() const { return one_step ? h : 0.5 * h; }          // c [s]
    double row_compliance(double d) const { return 1 / (act * (h + d)); }  // c / C
    double row_rate(double d) const { return 1 / (h + d); }                // -target / error
};

}  // namespace taut
