// Run-time choice of the build of tests of pairs of triangles.
#include "detect/triangle_pairs.h"

namespace taut {

const TrianglePairKernel& triangle_pair_kernel() {
    static const TrianglePairKernel* const kBuilds[] = {&kTrianglePairsScalar, &kTrianglePairsSse2, &kTrianglePairsAvx2,
                                                        &kTrianglePairsAvx512};
    return *kBuilds[static_cast<size_t>(kernel_width())];
}

}  // namespace taut
