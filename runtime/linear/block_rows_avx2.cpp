// Products by rows of blocks, avx2 build.
#include "linear/block_rows.inl"

namespace taut {

const MultiplyRows kMultiplyRowsAvx2 = multiply;

}  // namespace taut
