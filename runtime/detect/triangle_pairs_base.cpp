// Tests of pairs of triangles, base build.
#include "detect/triangle_pairs.inl"

namespace taut {

const TrianglePairKernel kTrianglePairsBase = TrianglePairTest<BaseLanes>::table("base");

}  // namespace taut
