// What is stated over the positions of points alone. A struct E of one file,
//
//   kRows, kPoints, kAngular;  Data: plain doubles
//   evaluate(data, p, c, j)              C, and where j is not null J: [point][row][3]
//   stiffness(data, p, lambda, part, k)  K: [3 points][3 points], onto zeros
//   line(data, p)                        where C has one: the span from point 0 to point 1
//   hessian(data, p, lambda, d, softness, part, k)
//                                        where it has a way of its own to that; d: [row][row], overwrites k
//
// gives the element type between particles, in batches and as rows, and the constraint type between points held by
// bodies, of which the data begin with an anchor for each point. With p_n = x_n + R_n s_n and r_n = R_n s_n,
//   J_n = j_n B_n,   K_nm = B_n^T k_nm B_m,   B = (I, -hat r),
// and the force j_n^T lambda at lever r_n adds its part to K_nn (Tournier et al. 2015, eq. 22).
#pragma once

#include <algorithm>
#include <type_traits>

#include "constraints/element.h"
#include "constraints/lever.h"

namespace taut {

template <class E>
inline constexpr int kNumbers = std::is_empty_v<typename E::Data> ? 0 : sizeof(typename E::Data) / sizeof(double);

template <class E>
using PointStiffness = Eigen::Matrix<double, 3 * E::kPoints, 3 * E::kPoints, Eigen::RowMajor>;

// ---------------------------------------------------------------- between particles

template <class E>
typename E::Data point_data(const double* numbers) {
    if constexpr (kNumbers<E> == 0)
        return {};
    else
        return *reinterpret_cast<const typename E::Data*>(numbers);
}

template <class E>
void evaluate_points(const ElementBatch& batch, double* error, double* jacobian, int columns) {
    for (uint32_t i = 0; i < batch.count; ++i) {
        Vec3 p[E::kPoints];
        for (uint32_t n = 0; n < E::kPoints; ++n) p[n] = batch.x[batch.node[i * E::kPoints + n]].x;
        const auto data = point_data<E>(batch.data + size_t{batch.index(i)} * kNumbers<E>);
        constexpr int kEntries = E::kPoints * E::kRows;
        double j[kEntries * 3];
        E::evaluate(data, p, error + i * E::kRows, jacobian ? j : nullptr);
        if (!jacobian) continue;
        double* const to = jacobian + size_t{i} * kEntries * static_cast<uint32_t>(columns);
        for (int e = 0; e < kEntries; ++e) std::copy_n(j + 3 * e, 3, to + e * columns);
    }
}

template <class E>
void stiffness_of_points(const ElementBatch& batch, const double* lambda, Curvature part, double* k) {
    constexpr size_t kSize = size_t{9} * E::kPoints * E::kPoints;
    std::fill_n(k, batch.count * kSize, 0.0);
    for (uint32_t i = 0; i < batch.count; ++i) {
        Vec3 p[E::kPoints];
        for (uint32_t n = 0; n < E::kPoints; ++n) p[n] = batch.x[batch.node[i * E::kPoints + n]].x;
        const auto data = point_data<E>(batch.data + size_t{batch.index(i)} * kNumbers<E>);
        E::stiffness(data, p, lambda + i * E::kRows, part, k + i * kSize);
    }
}

template <class E>
void hessian_of_points(const ElementBatch& batch, const ElementStiffness& d, const double* lambda, Curvature part,
                       double* k) {
    constexpr size_t kSize = size_t{9} * E::kPoints * E::kPoints;
    for (uint32_t i = 0; i < batch.count; ++i) {
        Vec3 p[E::kPoints];
        for (uint32_t n = 0; n < E::kPoints; ++n) p[n] = batch.x[batch.node[i * E::kPoints + n]].x;
        const auto data = point_data<E>(batch.data + size_t{batch.index(i)} * kNumbers<E>);
        E::hessian(data, p, lambda + i * E::kRows, d.material, d.softness[batch.index(i)], part, k + i * kSize);
    }
}

template <class E>
constexpr auto hessian_of() -> decltype(ElementType::hessian) {
    if constexpr (requires { &E::hessian; })
        return hessian_of_points<E>;
    else
        return nullptr;
}

inline constexpr uint32_t kInOrder[kMaxNodes] = {0, 1, 2, 3, 4, 5, 6, 7};

template <class E>
void evaluate_particles(const void* data, const Pose* x, double* error, double* jacobian) {
    if (jacobian) std::fill_n(jacobian, E::kPoints * E::kRows * kDof, 0.0);
    evaluate_points<E>({1, kInOrder, nullptr, static_cast<const double*>(data), x}, error, jacobian, kDof);
}

template <class E>
void stiffness_of_particles(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    PointStiffness<E> own;
    stiffness_of_points<E>({1, kInOrder, nullptr, static_cast<const double*>(data), x}, lambda, part, own.data());
    constexpr int kWidth = E::kPoints * kDof;
    Eigen::Map<Eigen::Matrix<double, kWidth, kWidth, Eigen::RowMajor>> out(k);
    out.setZero();
    for (int n = 0; n < E::kPoints; ++n)
        for (int m = 0; m < E::kPoints; ++m)
            out.template block<3, 3>(kDof * n, kDof * m) = own.template block<3, 3>(3 * n, 3 * m);
}

template <class E>
constexpr auto line_of_particles() -> Line (*)(const void*, const Pose*) {
    if constexpr (requires { &E::line; })
        return [](const void* data, const Pose* x) {
            const Vec3 p[2] = {x[0].x, x[1].x};
            return Line{E::line(point_data<E>(static_cast<const double*>(data)), p), Vec3::Zero(), Vec3::Zero()};
        };
    else
        return nullptr;
}

template <class E>
constexpr ElementType point_element(const char* name, void (*sample)(uint64_t seed, void* data, Pose* x),
                                    ElementSweep ElementKernels::*sweep = nullptr) {
    return {name,
            3,
            kNumbers<E>,
            {name, E::kRows, E::kPoints, kNumbers<E> * sizeof(double), Bound::free, true, E::kAngular,
             evaluate_particles<E>, stiffness_of_particles<E>, nullptr, sample, line_of_particles<E>()},
            evaluate_points<E>,
            stiffness_of_points<E>,
            hessian_of<E>(),
            sweep};
}

// ---------------------------------------------------------------- between points of bodies

template <class E>
struct Anchored {
    Vec3 anchor[E::kPoints];
    [[no_unique_address]] typename E::Data own;
};

// Points and their levers.
template <class E>
struct AnchoredPoints {
    AnchoredPoints(const void* data, const Pose* x) {
        const auto& from = *static_cast<const Anchored<E>*>(data);
        for (int n = 0; n < E::kPoints; ++n) {
            r[n] = x[n].R * from.anchor[n];
            p[n] = (x[n].x - x[0].x) + r[n];  // from x_0: C knows no place
        }
    }
    Vec3 r[E::kPoints], p[E::kPoints];
};

template <class E>
void evaluate_anchored(const void* data, const Pose* x, double* error, double* jacobian) {
    const AnchoredPoints<E> at(data, x);
    double j[E::kPoints * E::kRows * 3];
    E::evaluate(static_cast<const Anchored<E>*>(data)->own, at.p, error, jacobian ? j : nullptr);
    if (!jacobian) return;
    for (int e = 0; e < E::kPoints * E::kRows; ++e) {
        const Vec3 along = Vec3::Map(j + 3 * e);
        Vec3::Map(jacobian + kDof * e) = along;
        Vec3::Map(jacobian + kDof * e + 3) = at.r[e / E::kRows].cross(along);
    }
}

template <class E>
void stiffness_of_anchored(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    using Lambda = Eigen::Map<const Eigen::Matrix<double, E::kRows, 1>>;
    using PointJacobian = Eigen::Map<const Eigen::Matrix<double, E::kRows, 3, Eigen::RowMajor>>;
    const AnchoredPoints<E> at(data, x);
    const auto& own = static_cast<const Anchored<E>*>(data)->own;
    double c[E::kRows], j[E::kPoints * E::kRows * 3];
    E::evaluate(own, at.p, c, j);
    PointStiffness<E> t = PointStiffness<E>::Zero();
    E::stiffness(own, at.p, lambda, part, t.data());
    constexpr int kWidth = E::kPoints * kDof;
    Eigen::Map<Eigen::Matrix<double, kWidth, kWidth, Eigen::RowMajor>> out(k);
    const bool turns = !std::all_of(at.r, at.r + E::kPoints, [](const Vec3& r) { return r.isZero(0); });
    if (!turns) out.setZero();
    for (int n = 0; n < E::kPoints; ++n) {
        const Mat3 hat_n = hat(at.r[n]);
        for (int m = 0; m < E::kPoints; ++m) {
            const Mat3 own_part = t.template block<3, 3>(3 * n, 3 * m);
            out.template block<3, 3>(kDof * n, kDof * m) = own_part;
            if (!turns) continue;
            const Mat3 hat_m = hat(at.r[m]);
            out.template block<3, 3>(kDof * n, kDof * m + 3) = -own_part * hat_m;
            out.template block<3, 3>(kDof * n + 3, kDof * m) = hat_n * own_part;
            out.template block<3, 3>(kDof * n + 3, kDof * m + 3) = -hat_n * own_part * hat_m;
        }
        if (!turns) continue;
        const Vec3 force = PointJacobian(j + n * E::kRows * 3).transpose() * Lambda(lambda);
        out.template block<3, 3>(kDof * n + 3, kDof * n + 3) += lever_stiffness(force, at.r[n], part);
    }
}

template <class E>
constexpr auto line_of_anchored() -> Line (*)(const void*, const Pose*) {
    if constexpr (requires { &E::line; })
        return [](const void* data, const Pose* x) {
            const AnchoredPoints<E> at(data, x);
            return Line{E::line(static_cast<const Anchored<E>*>(data)->own, at.p), at.r[0], at.r[1]};
        };
    else
        return nullptr;
}

template <class E>
constexpr ConstraintType anchored_type(const char* name, void (*sample)(uint64_t seed, void* data, Pose* x)) {
    return {name,
            E::kRows,
            E::kPoints,
            sizeof(Anchored<E>),
            Bound::free,
            true,
            E::kAngular,
            evaluate_anchored<E>,
            stiffness_of_anchored<E>,
            nullptr,
            sample,
            line_of_anchored<E>()};
}

}  // namespace taut
