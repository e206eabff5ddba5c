// Tests of pairs of triangles, avx512 build.
#include "detect/triangle_pairs.inl"

namespace taut {

const TrianglePairKernel kTrianglePairsAvx512 = TrianglePairTest<Avx512Lanes>::table("avx512");

}  // namespace taut
