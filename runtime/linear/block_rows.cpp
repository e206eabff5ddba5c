// Run-time choice of the build of products by rows of blocks.
#include "linear/block_rows.h"
#include "simd/width.h"

namespace taut {

MultiplyRows multiply_rows() {
    if constexpr (kHasAvx)
        if (kernel_width() >= Width::avx2) return kMultiplyRowsAvx2;
    return kMultiplyRowsBase;
}

}  // namespace taut
