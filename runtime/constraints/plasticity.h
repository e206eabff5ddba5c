// Plastic flow: what remains of a strain beyond the yield once the load is gone. A model calls it after a step, for
// each Gauss point, and its element then forgets what has flowed. The excess flows at the rate of creep: while the
// shape stays, of it 1 - exp(-r t) in the time t, however that is divided. Volume is kept, and a set grows no further
// than the limit. What hardens yields at more the more has flowed: isotropic hardening, of an excess 1/(1 + hardening)
// flows and the yield takes the rest.
#pragma once

#include "base/math.h"
#include "constraints/material.h"

namespace taut {

struct Plasticity {
    double yield;          // strain without its change of volume, by the norm of its tensor [1]
    double creep;          // [1/s]; infinite: all of the excess at once
    double limit;          // of the set, by the same norm [1]
    double hardening = 0;  // yield over what has flowed, by the same norm [1]
};

// Yield of a stress in simple tension [Pa], by von Mises:  stress/(sqrt 6 mu).
double yield_of_stress(double stress, const Isotropic& of);
// Hardening of a modulus: stress over plastic strain in simple tension [Pa],  modulus/(3 mu).
double hardening_of_modulus(double modulus, const Isotropic& of);

// Multiplicative:  F = F_e F_p, det F_p = 1; F_e's principal stretches over the cube root of their product yield where
// they leave 1 (Irving et al. 2004, section 6). set: F_p, 1 at first. flowed: strain that has, in all, 0 at first;
// null: no hardening. True where it flowed. What is inverted does not.
bool flow(const Mat3& f, const Plasticity& law, double time, Mat3& set, double* flowed = nullptr);
// Elements of F_e: the gradients g_n' = F_p^-T g_n in place of g_n, at the same volume.
void apply_set(const Mat3& set, const double (*g)[3], int nodes, double (*out)[3]);

// Additive:  strain = elastic + offset, rows of Green strain (voigt.h); the elastic part without its mean yields
// (O'Brien et al. 2002). True where the offset changed.
bool flow(const double (&strain)[6], const Plasticity& law, double time, double (&offset)[6], double* flowed = nullptr);

}  // namespace taut
