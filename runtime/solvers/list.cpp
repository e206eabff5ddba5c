// The list of solvers, in the order of taut_solver: a new one is its file, a line here and a name in world.h.
#include "solvers/solver.h"

namespace taut {

std::span<const Solver* const> solvers() {
    static const Solver* const list[] = {
        &kBlockLdlt,       &kProjectedGaussSeidel, &kAcceleratedJacobi,  &kJacobi,      &kNonlinearGaussSeidel,
        &kMinimumResidual, &kConjugateResiduals,   &kConjugateGradients, &kMinimisation};
    return list;
}

}  // namespace taut
