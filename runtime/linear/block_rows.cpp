// Run-time choice of the build of products by rows of blocks.
#include "linear/block_rows.h"
#include "simd/width.h"

namespace taut {

MultiplyRows multiply_rows() { return kernel_width() >= Width::avx2 ? kMultiplyRowsAvx2 : kMultiplyRowsBase; }

}  // namespace taut
