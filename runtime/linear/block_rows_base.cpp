// Products by rows of blocks, build for any processor.
#include "linear/block_rows.inl"

namespace taut {

const MultiplyRows kMultiplyRowsBase = multiply;

}  // namespace taut
