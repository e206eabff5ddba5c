// Gas within a block's nodes: s g g^T of each, s = t h stiffness, in their matrix but not among its entries, which it
// would all fill. By Sherman and Morrison, one gas after the other,
//   (A + s g g^T)^-1 b = y - z (g.y)/(1/s + g.z),   y = A^-1 b,   z = A^-1 g.
// Of nodes that the block does not have the velocity counts for the next substep.
#include <algorithm>

#include "solvers/block_solve.h"

namespace taut {

// act(place among the unknowns, g) for the nodes of a gas that the block has.
template <class Act>
void BlockSolve::for_gas(const GasLoad& gas, Act&& act) const {
    for (uint32_t k = gas.first; k < gas.first + gas.count; ++k) {
        const uint32_t seat = sys_.gases.seat[k], i = local(seat);
        if (i < nodes_ && sys_.at(b_.nodes[i]) == seat) act(size_t{i} * kDof, sys_.gases.gradient[k]);
    }
}

void BlockSolve::find_gases() {
    b_.gases.clear();
    for (uint32_t i = 0; i < sys_.gases.list.size(); ++i) {
        bool any = false;
        for_gas(sys_.gases.list[i], [&](size_t, const Vec3&) { any = true; });
        if (any) b_.gases.push_back(i);
    }
    b_.gas_response.resize(b_.gases.size() * (unknowns() + 1));
}

// Of each its z, and after that 1/(1/s + g.z).
void BlockSolve::find_gas_responses() {
    for (size_t i = 0; i < b_.gases.size(); ++i) {
        const GasLoad& gas = sys_.gases.list[b_.gases[i]];
        double* z = gas_response(i);
        std::fill_n(z, unknowns(), 0.0);
        for_gas(gas, [&](size_t at, const Vec3& g) { Vec3::Map(z + at) = g; });
        b_.matrix.solve(z);
        yield_to_gas(z, i);
        double along = 0;
        for_gas(gas, [&](size_t at, const Vec3& g) { along += g.dot(Vec3::Map(z + at)); });
        const double s = sys_.scheme.stiffness() * gas.stiffness;
        z[unknowns()] = s / (1 + s * along);
    }
}

// x of A^-1 b: of the same with the first of its gases.
void BlockSolve::yield_to_gas(double* x, size_t gases) {
    for (size_t i = 0; i < gases; ++i) {
        const double* z = gas_response(i);
        double along = 0;
        for_gas(sys_.gases.list[b_.gases[i]], [&](size_t at, const Vec3& g) { along += g.dot(Vec3::Map(x + at)); });
        const double by = z[unknowns()] * along;
        for (size_t k = 0; k < unknowns(); ++k) x[k] -= by * z[k];
    }
}

}  // namespace taut
