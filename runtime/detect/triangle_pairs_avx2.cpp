// Tests of pairs of triangles, avx2 build.
#include "detect/triangle_pairs.inl"

namespace taut {

const TrianglePairKernel kTrianglePairsAvx2 = TrianglePairTest<Avx2Lanes>::table("avx2");

}  // namespace taut
