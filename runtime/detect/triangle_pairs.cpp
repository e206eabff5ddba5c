// Run-time choice of the build of tests of pairs of triangles.
#include "detect/triangle_pairs.h"

namespace taut {

const TrianglePairKernel& triangle_pair_kernel() {
    static const TrianglePairKernel* const kBuilds[] = {TAUT_BUILDS(kTrianglePairs)};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
