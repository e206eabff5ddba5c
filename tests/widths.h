// The builds of a kernel, and their widths, that this processor runs.
#pragma once

#include <initializer_list>
#include <vector>

#include "simd/width.h"

namespace taut {

// The scalar one first. all: {TAUT_BUILDS(kernels)}
template <class Kernels>
std::vector<const Kernels*> builds_here(std::initializer_list<const Kernels*> all) {
    return {all.begin(), all.begin() + static_cast<int>(widest()) + 1};
}

inline std::vector<Width> widths_here() {
    std::vector<Width> out;
    for (const Width width : {Width::scalar, Width::base, Width::avx2, Width::avx512})
        if (width <= widest()) out.push_back(width);
    return out;
}

}  // namespace taut
