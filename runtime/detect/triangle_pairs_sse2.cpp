// Tests of pairs of triangles, sse2 build.
#include "detect/triangle_pairs.inl"

namespace taut {

const TrianglePairKernel kTrianglePairsSse2 = TrianglePairTest<Sse2Lanes>::table("sse2");

}  // namespace taut
