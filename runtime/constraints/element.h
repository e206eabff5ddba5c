// Elements: constraints by the thousand, of which cables, cloth and solids are made. An element type answers for a
// whole batch of instances, at any positions that a solver asks about,
//   C(x) [m, rad or 1],   J = dC/dx,   K = -dJ^T/dx lambda
// as constraint types do for one (constraint.h), and W = 1/2 C^T D C [J] with D the inverse of its compliance. Its row
// form is a constraint type: any solver takes an element as rows of that. Adding one is its file and a line in
// list.cpp.
#pragma once

#include <span>

#include "constraints/constraint.h"
#include "constraints/element_kernels.h"
#include "constraints/energy_kernels.h"

namespace taut {

// Some elements of one type, at poses that x holds.
struct ElementBatch {
    uint32_t count = 0;
    const uint32_t* node = nullptr;     // [count][nodes], indices into x
    const uint32_t* element = nullptr;  // [count], index of each in data; null: 0, 1, ...
    const double* data = nullptr;       // [elements][numbers]
    const Pose* x = nullptr;

    uint32_t index(uint32_t i) const { return element ? element[i] : i; }
};

// D of some elements: [rows][rows] of the material, over the softness of each.
struct ElementStiffness {
    const double* material;
    const double* softness;  // [elements]
};

struct ElementType {
    const char* name;
    int freedoms;        // of each node: 3, of whose pose x alone is read, or 6
    int numbers;         // of data of an element, all doubles
    ConstraintType row;  // the same element as one constraint, with its numbers as data

    // error: [count][rows]. jacobian: [count][nodes][rows][columns], may be null; columns are the freedoms or more, and
    // those beyond stay as they are.
    void (*evaluate)(const ElementBatch& batch, double* error, double* jacobian, int columns);
    // lambda: [count][rows]. k: [count][nodes freedoms][nodes freedoms], row-major, overwritten.
    void (*stiffness)(const ElementBatch& batch, const double* lambda, Curvature part, double* k);
    // What element_hessian() below is to give, where a type has a way of its own; else null.
    void (*hessian)(const ElementBatch& batch, const ElementStiffness& d, const double* lambda, Curvature part,
                    double* k) = nullptr;
    // Its fused sweep in lanes, where it has one; else null.
    ElementSweep ElementKernels::*sweep = nullptr;
    // Its energy in lanes, likewise.
    EnergyKernel EnergyKernels::*energy = nullptr;
};

// Every type there is; tests, hash and snapshots loop over it.
std::span<const ElementType* const> element_types();

extern const ElementType kLinkElement;  // distance between two points
extern const ElementType kBendElement;  // bend of a line through three points

// Strains of continua (continuum.h) over the gradients of shape functions (shape_functions.h): an element a Gauss
// point. Their rows times a D of material.h are a density of energy, one over the softness is the volume of the point
// [m^3], or its area times the thickness.
extern const ElementType kGreenTri3, kGreenQuad4, kGreenTet4, kGreenHex8;
extern const ElementType kCorotatedTri3, kCorotatedQuad4, kCorotatedTet4, kCorotatedHex8;
extern const ElementType kStretchTet4, kStretchHex8;              // principal stretches
extern const ElementType kStretchVolumeTet4, kStretchVolumeHex8;  // those and the volume: fixed corotated
extern const ElementType kNeoHookeanTet4, kNeoHookeanHex8;

extern const ElementType kDragElement;           // of air about a point
extern const ElementType kDihedralElement;       // angle between two triangles of cloth
extern const ElementType kQuadraticBendElement;  // bend of cloth whose rest shape is flat

// W = 1/2 C^T D C of each [J].
void element_energy(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d, double* energy);

// The sum J^T D J + K, the matrix of a Newton step on W where lambda = -D C, symmetric; raw it is d2W/dx2. Its positive
// part is positive semi-definite and, in any direction, no less than the sum. k as of ElementType::stiffness.
void element_hessian(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d,
                     const double* lambda, Curvature part, double* k);
void positive_sum(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d, const double* lambda,
                  double* k);

}  // namespace taut
