#include <taut/lint.h>

#include <algorithm>

#include "api/sized.h"
#include "check/lint.h"

using namespace taut;

namespace {

// In the order of taut_lint_kind.
constexpr const char* kText[] = {
    "the heaviest body of a block of joints is too heavy for the lightest: bring their masses closer",
    "a swept joint ties a heavy body to a light one and will stretch: solve it directly",
    "a heavy body rests on a light one and will sink in: bring their masses closer or take more substeps",
    "a light body stands between two heavy ones, which will meet through it: make it heavier",
    "a body in a joint is so thin that it spins up about its long axis: raise its smallest inertia",
    "a swept joint carries far more than its lighter end weighs and will yield: solve it directly",
    "a swept joint has so little compliance that it acts as a rigid one: make it 0, or solve the joint directly",
    "a joint holds what other joints hold already: its force is arbitrary; free an axis or give it compliance",
    "the two points of a joint or attachment are apart and will jump together: place the bodies or the joint anew",
    "the two frames of a joint are turned apart and will jump together: place the bodies or the joint anew",
    "a joint is far beyond a stop and will be pushed back: place it within, or give the stop compliance",
    "a joint is turned far beyond a stop and will be pushed back: place it within, or give the stop compliance",
    "two stops leave so little room that the joint trembles between them: lock the axis",
    "two stops leave so little angle that the joint trembles between them: lock the axis",
    "a cable turns a corner at each segment on something round: cut it into more segments",
    "a cable's segments are shorter than it is thick and act as balls: cut it into fewer",
    "a cable is pulled so hard that it stretches visibly: lower its compliance or the load",
    "a triangle or cell is so thin that it is stiff and slow to solve: mesh it more evenly",
    "a cell is turned inside out: its material will push it back; look at what crushed it",
    "a swept cloth or solid is stiffer than its substeps hold and will act softer: solve it directly",
    "two vertices in one place are not joined, and the mesh comes apart there: weld them",
    "a solid hangs together by an edge alone, about which it turns: join its cells by faces",
    "a joint is off along what locked axes hold, and stays off: place the bodies, free an axis, or give it compliance",
};

}  // namespace

taut_result taut_world_lint_sized(taut_world handle, taut_lint_entry* first, uint32_t capacity, uint32_t* count,
                                  uint32_t size) {
    const RecordOut<taut_lint_entry> entries(first, size);
    Check check("taut_world_lint");
    if (!check.pointer("count", count)) return check.result();
    if (capacity > 0 && !check.pointer("entries", entries)) return check.result();
    return with_world(check.call(), handle, Use::alone, [&](World& world) {
        const Array<taut_lint_entry> found = lint(world);
        *count = static_cast<uint32_t>(found.size());
        if (found.size() > capacity) {
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, *count);
        }
        for (uint32_t i = 0; i < *count; ++i) entries[i] = found[i];
        return TAUT_OK;
    });
}

const char* taut_lint_text(taut_lint_kind kind) {
    const auto index = static_cast<uint32_t>(kind);
    return index < std::size(kText) ? kText[index] : "unknown";
}
