// Softness of contacts and of rigid rows that are swept: a spring of frequency f = 0.25/h or 1/h and damping ratio
// z = 10 on each row's own effective mass k (Frâncu 2016, section 6.8 gives the regularisation; the closed form is the
// implicit spring):  om = 2 pi f,  a1 = 2 z + h om,  a2 = h om a1:
//   dp = -mass_scale/k (J v + bias_rate C) - impulse_scale p
// with mass_scale = a2/(1 + a2), impulse_scale = 1/(1 + a2), bias_rate = om/a1.
#pragma once

#include "constraints/contact_lanes.h"

namespace taut {

constexpr float kHardSpeed = 1.0f;  // slower approaches are stopped softly [m/s]

// cycles: f h.
inline SweepTerms soft_terms(double h, double cycles) {
    constexpr double kPi = 3.14159265358979323846;
    constexpr double kDampingRatio = 10, kPush = 3;  // [1], [m/s]
    const double om_h = 2 * kPi * cycles, a1 = 2 * kDampingRatio + om_h, a2 = om_h * a1;
    SweepTerms t;
    t.inv_h = static_cast<float>(1 / h);
    t.bias_rate = static_cast<float>(om_h / (h * a1));
    t.push = static_cast<float>(kPush);
    t.mass_scale = static_cast<float>(a2 / (1 + a2));
    t.impulse_scale = static_cast<float>(1 / (1 + a2));
    t.hit = kHardSpeed;
    return t;
}
// By which a contact yields to a force that stays, in parts of h^2 w |f|: 1 / (om h)^2.
constexpr float kContactYield = 0.405f;
// By which a swept joint does; see joint_terms().
constexpr double kJointYield = 0.0253;
// Time in which it is forgotten by how much swept rows were found to yield, e-fold [s]: where substeps follow at once,
// they swing with what swings by them.
constexpr double kYieldMemory = 0.5;
// stretch: h over the substep for which f is meant. Where the host changes the time step f stays what it was: what
// rests yields by .4 / f^2 of gravity, a length that does not depend on h, and so stays where it is.
inline SweepTerms contact_terms(double h, double stretch = 1) { return soft_terms(h, 0.25 * stretch); }
// A joint yields by .025 h^2 of the acceleration that its force gives its ends, a sixteenth of what a contact does.
inline SweepTerms joint_terms(double h, double stretch = 1) { return soft_terms(h, stretch); }

}  // namespace taut
