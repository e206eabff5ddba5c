// Which energies of elements come in lanes: W, its forces and its raw matrices of some elements side by side, as
// minimisation asks for them (element.h has them one by one). Only plain types: an inline function of Eigen must not
// come from a build for one processor alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "constraints/sizes.h"
#include "simd/width.h"

namespace taut {

// At most kDoubles elements of one type, as of ElementBatch and ElementStiffness.
struct EnergyLanes {
    uint32_t count;           // of them, at least 1
    const uint32_t* node;     // [count][nodes]
    const uint32_t* element;  // [count]
    const double* data;       // [elements][numbers]
    const double* place;      // x of node 0 [m], those of the others at
    size_t stride;            // doubles each
    const double* material;   // D of a unit of it, [rows][rows]
    const double* softness;   // [elements]
};

// What evaluate() leaves for hessian(), of kDoubles elements: a frame, that is U, V by columns and sigma of F.
constexpr uint32_t kFrameNumbers = 21 * kDoubles;

struct EnergyKernel {
    // energy: [count] [J]; force: [count][nodes][3], dW/dx [N], may be null.
    void (*evaluate)(const EnergyLanes& of, double* frame, double* energy, double* force);
    // d2W/dx2 where it was evaluated last, or its positive part: [count][3 nodes][3 nodes] [N/m].
    void (*hessian)(const EnergyLanes& of, const double* frame, bool positive, double* k);
};

// Four builds of one source give the same bits: scalar, SSE2, AVX2, AVX-512.
struct EnergyKernels {
    const char* name;
    EnergyKernel stretch_tet4, stretch_hex8, stretch_volume_tet4, stretch_volume_hex8;
};

extern const EnergyKernels kEnergyKernelsScalar, kEnergyKernelsBase, kEnergyKernelsAvx2, kEnergyKernelsAvx512;
// The widest that this machine runs.
const EnergyKernels& energy_kernels();

}  // namespace taut
