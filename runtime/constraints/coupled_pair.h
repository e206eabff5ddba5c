// One row that couples how two bodies, a and b, stand to a third, the housing h that guides both: nodes a, b, h.
//   C = w_a q(h, a) + w_b q(h, b) - rest
// Each q is a coordinate of one body in the frame of the housing. A struct T of one file,
//
//   Data: plain doubles, first an anchor for each node
//   weight(data, side), rest(data)                 of side 0, which is a, and 1, b
//   evaluate(data, side, x, j) -> q                x: h, then the body; where j is not null J: [2][6]
//   stiffness(data, side, x, lambda, part, k)      K of that: [12][12], overwritten
//
// gives the constraint type. K is the sum of both sides' with lambda times their weights; so is its positive part,
// which is no less than that of the sum.
#pragma once

#include <algorithm>

#include "constraints/constraint.h"

namespace taut {

template <class T>
void evaluate_coupled(const void* data, const Pose* x, double* error, double* jacobian) {
    const auto& own = *static_cast<const typename T::Data*>(data);
    *error = -T::rest(own);
    if (jacobian) std::fill_n(jacobian + 2 * kDof, kDof, 0.0);
    for (int side = 0; side < 2; ++side) {
        const Pose pair[2] = {x[2], x[side]};
        const double weight = T::weight(own, side);
        double j[2 * kDof];
        *error += weight * T::evaluate(own, side, pair, jacobian ? j : nullptr);
        if (!jacobian) continue;
        for (int k = 0; k < kDof; ++k) {
            jacobian[2 * kDof + k] += weight * j[k];
            jacobian[side * kDof + k] = weight * j[kDof + k];
        }
    }
}

template <class T>
void stiffness_of_coupled(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    constexpr int kWidth = 3 * kDof, kPair = 2 * kDof;
    const auto& own = *static_cast<const typename T::Data*>(data);
    std::fill_n(k, kWidth * kWidth, 0.0);
    for (int side = 0; side < 2; ++side) {
        const Pose pair[2] = {x[2], x[side]};
        const int first[2] = {2 * kDof, side * kDof};
        double of_pair[kPair * kPair];
        T::stiffness(own, side, pair, T::weight(own, side) * *lambda, part, of_pair);
        for (int r = 0; r < kPair; ++r)
            for (int c = 0; c < kPair; ++c)
                k[(first[r / kDof] + r % kDof) * kWidth + first[c / kDof] + c % kDof] += of_pair[r * kPair + c];
    }
}

template <class T>
constexpr ConstraintType coupled_type(const char* name, uint8_t angular,
                                      void (*sample)(uint64_t seed, void* data, Pose* x)) {
    return {name,
            1,
            3,
            sizeof(typename T::Data),
            Bound::free,
            true,
            angular,
            evaluate_coupled<T>,
            stiffness_of_coupled<T>,
            nullptr,
            sample};
}

}  // namespace taut
