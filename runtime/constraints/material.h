// Materials: compliance [rows][rows] of a unit of volume [1/Pa], of the rows of a strain (element.h), from constants in
// SI units. Over the weight of its Gauss point, times the thickness of a sheet, it is that of an element. False, with
// nothing written, where a constant is not finite or the material would not resist every strain.
#pragma once

namespace taut {

// Young's modulus [Pa] > 0 and Poisson's ratio in (-1, 1/2), of a sheet under plane stress in (-1, 1).
struct Isotropic {
    double young, poisson;
};

// Along warp (1) and weft (2) of a sheet: Young's moduli and shear modulus [Pa] > 0; poisson_12: contraction along 2
// over stretch along 1, with poisson_12^2 < young_1/young_2.
struct OrthotropicSheet {
    double young[2], poisson_12, shear_12;
};

// Young's and shear moduli [Pa] and Poisson's ratios nu_ij, contraction along j over stretch along i, in the order 23,
// 13, 12 of the rows of shear.
struct OrthotropicSolid {
    double young[3], poisson[3], shear[3];
};

// Of Green and corotated strain.
bool hooke_solid(const Isotropic& of, double (&compliance)[36]);
bool hooke_sheet(const Isotropic& of, double (&compliance)[9]);
bool orthotropic_solid(const OrthotropicSolid& of, double (&compliance)[36]);
bool orthotropic_sheet(const OrthotropicSheet& of, double (&compliance)[9]);

// Hooke of principal stretches.
bool hooke_stretches(const Isotropic& of, double (&compliance)[9]);
// Of stretches and volume, diag(1/2mu, 1/2mu, 1/2mu, 1/lambda); Poisson's ratio > 0, as the volume resists by lambda.
bool fixed_corotated(const Isotropic& of, double (&compliance)[16]);
// Of the neo-Hookean rows, diag(1/mu, 1/(lambda + mu)), and their alpha: small strains are Hooke's.
bool neo_hookean(const Isotropic& of, double (&compliance)[4], double& alpha);

// Bending stiffness of a plate, E t^3/(12 (1 - nu^2)) [N m]; 0 where the constants are refused.
double plate_stiffness(const Isotropic& of, double thickness);

}  // namespace taut
