// Tests of pairs of triangles, scalar build.
#include "detect/triangle_pairs.inl"

namespace taut {

const TrianglePairKernel kTrianglePairsScalar = TrianglePairTest<ScalarLanes>::table("scalar");

}  // namespace taut
