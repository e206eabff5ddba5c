// Symmetric tensors as rows: xx, yy, zz, yz, xz, xy, of a surface xx, yy, xy.
#pragma once

namespace taut {

template <int Dim>
inline constexpr int kVoigtRows = Dim*(Dim + 1) / 2;

// The two axes of row r.
template <int Dim>
constexpr int voigt_first(int r) {
    static_assert(Dim == 2 || Dim == 3);
    return r < Dim ? r : Dim == 3 && r == 3 ? 1 : 0;
}
template <int Dim>
constexpr int voigt_second(int r) {
    return r < Dim ? r : Dim == 3 && r < 5 ? 2 : 1;
}

}  // namespace taut
