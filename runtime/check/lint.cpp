#include "check/lint.h"

#include <algorithm>

#include "check/lint_context.h"

namespace taut {

Array<taut_lint_entry> lint(World& world) {
    Array<taut_lint_entry> found(world.memory);
    const LintContext context(world, found);
    lint_masses(context);
    lint_thin(context);
    lint_softness(context);
    lint_loops(context);
    lint_poses(context);
    lint_cables(context);
    lint_softs(context);
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
    return found;
}

}  // namespace taut
