// Attachments (attachment.h).  r_n = R_n m_n,  d = sum_n (w_n x_n + r_n) + c,  D_n = dd/dx_n = (w_n I, -hat r_n).
//   on a point:     C = d;  J_n = D_n;  K_nn = lever_stiffness(lambda, r_n), of the rotation alone
//   at a distance:  C = |d| - L;  J_n = u^T D_n, u = d/|d|;
//                   K_nm = D_n^T T D_m, T = (-lambda/|d|) (I - u u^T), and lever_stiffness(lambda u, r_n) in K_nn
// lambda < 0 is tension, T is positive only then                         (Tournier et al. 2015, eq. 14, 18 and 22)
#include "constraints/attachment.h"

#include <algorithm>

#include "constraints/lever.h"
#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

using Across = Eigen::Matrix<double, 3, kDof>;

struct Way {
    Vec3 d;
    Vec3 r[kMaxNodes];
};

// node: indices of the nodes in x, or null: 0, 1, ...
Way way_of(int nodes, const double* data, const uint32_t* node, const Pose* x) {
    Way way;
    way.d = Vec3::Map(data + nodes * kAttachedNumbers);
    for (int n = 0; n < nodes; ++n) {
        const double* own = data + n * kAttachedNumbers;
        const Pose& at = x[node ? node[n] : static_cast<uint32_t>(n)];
        way.r[n] = at.R * Vec3::Map(own + 1);
        way.d += *own * at.x + way.r[n];
    }
    return way;
}

Across across(double weight, const Vec3& r) {
    Across out;
    out << weight * Mat3::Identity(), -hat(r);
    return out;
}

struct Direction {
    double length;
    Vec3 u;

    explicit Direction(const Vec3& d) : length(std::max(d.norm(), 1e-12)), u(d / length) {
        if (d.norm() <= 1e-12) u = Vec3::UnitX();  // any direction will do to part them again
    }
};

struct PointLaw {
    static constexpr int kRows = 3, kOwn = 3;  // numbers beside those of the nodes

    static void error(const Way& way, const double*, double* c) { Vec3::Map(c) = way.d; }
    // D: [3][6] of a node, from which its rows are made.
    static void rows(const Way&, const Across& d, double* j, int columns) {
        for (int r = 0; r < kRows; ++r)
            for (int k = 0; k < kDof; ++k) j[r * columns + k] = d(r, k);
    }
    static Vec3 force(const Way&, const double* lambda) { return Vec3::Map(lambda); }
    static bool stiff(const Way&, const double*, Curvature, Mat3&) { return false; }
};

struct DistanceLaw {
    static constexpr int kRows = 1, kOwn = 4;

    static void error(const Way& way, const double* own, double* c) { *c = way.d.norm() - own[3]; }
    static void rows(const Way& way, const Across& d, double* j, int) {
        Eigen::Map<Eigen::Matrix<double, 1, kDof>>{j} = Direction(way.d).u.transpose() * d;
    }
    static Vec3 force(const Way& way, const double* lambda) { return *lambda * Direction(way.d).u; }
    // T; false: it is 0.
    static bool stiff(const Way& way, const double* lambda, Curvature part, Mat3& t) {
        if (part == Curvature::positive && *lambda >= 0) return false;
        const Direction along(way.d);
        t = -*lambda / along.length * (Mat3::Identity() - along.u * along.u.transpose());
        return true;
    }
};

template <class Law>
constexpr int numbers_of(int nodes) {
    return nodes * kAttachedNumbers + Law::kOwn;
}

template <class Law>
void evaluate_one(int nodes, const double* data, const uint32_t* node, const Pose* x, double* error, double* jacobian,
                  int columns) {
    const Way way = way_of(nodes, data, node, x);
    Law::error(way, data + nodes * kAttachedNumbers, error);
    for (int n = 0; jacobian && n < nodes; ++n)
        Law::rows(way, across(data[n * kAttachedNumbers], way.r[n]), jacobian + n * Law::kRows * columns, columns);
}

// k: [6 nodes][6 nodes], overwritten.
template <class Law>
void stiffness_of_one(int nodes, const double* data, const uint32_t* node, const Pose* x, const double* lambda,
                      Curvature part, double* k) {
    const Way way = way_of(nodes, data, node, x);
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<Square> out(k, nodes * kDof, nodes * kDof);
    out.setZero();
    Mat3 t;
    if (Law::stiff(way, lambda, part, t)) {
        Across d[kMaxNodes];
        for (int n = 0; n < nodes; ++n) d[n] = across(data[n * kAttachedNumbers], way.r[n]);
        for (int n = 0; n < nodes; ++n) {
            const Eigen::Matrix<double, kDof, 3> pulled = d[n].transpose() * t;
            for (int m = 0; m < nodes; ++m) out.block<kDof, kDof>(kDof * n, kDof * m) = pulled.lazyProduct(d[m]);
        }
    }
    const Vec3 force = Law::force(way, lambda);
    for (int n = 0; n < nodes; ++n)
        if (!way.r[n].isZero(0)) out.block<3, 3>(kDof * n + 3, kDof * n + 3) += lever_stiffness(force, way.r[n], part);
}

template <class Law, int Nodes>
void evaluate_batch(const ElementBatch& batch, double* error, double* jacobian, int columns) {
    for (uint32_t i = 0; i < batch.count; ++i)
        evaluate_one<Law>(
            Nodes, batch.data + size_t{batch.index(i)} * numbers_of<Law>(Nodes), batch.node + i * Nodes, batch.x,
            error + i * Law::kRows,
            jacobian ? jacobian + size_t{i} * Nodes * Law::kRows * static_cast<uint32_t>(columns) : nullptr, columns);
}

template <class Law, int Nodes>
void stiffness_of_batch(const ElementBatch& batch, const double* lambda, Curvature part, double* k) {
    constexpr size_t kSize = size_t{Nodes * kDof} * (Nodes * kDof);
    for (uint32_t i = 0; i < batch.count; ++i)
        stiffness_of_one<Law>(Nodes, batch.data + size_t{batch.index(i)} * numbers_of<Law>(Nodes),
                              batch.node + i * Nodes, batch.x, lambda + i * Law::kRows, part, k + i * kSize);
}

template <class Law, int Nodes>
void evaluate_row(const void* data, const Pose* x, double* error, double* jacobian) {
    evaluate_one<Law>(Nodes, static_cast<const double*>(data), nullptr, x, error, jacobian, kDof);
}

template <class Law, int Nodes>
void stiffness_of_row(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    stiffness_of_one<Law>(Nodes, static_cast<const double*>(data), nullptr, x, lambda, part, k);
}

// Of several nodes the weights cancel, so that C knows no place; a single one is held by the world.
template <class Law, int Nodes>
void sample_attachment(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto* to = static_cast<double*>(data);
    std::fill_n(to, numbers_of<Law>(Nodes), 0.0);
    double sum = 0;
    for (int n = 0; n < Nodes; ++n) {
        double* own = to + n * kAttachedNumbers;
        own[0] = Nodes == 1 ? 1 : n + 1 < Nodes ? random.between(-1, 1) : -sum;
        sum += own[0];
        Vec3::Map(own + 1) = random.vector();
    }
    if (Nodes == 1) Vec3::Map(to + kAttachedNumbers) = random.vector();
    if (Law::kOwn == 4) to[Nodes * kAttachedNumbers + 3] = 0.5 + random.unit();
    random.poses(x, Nodes);
}

template <class Law, int Nodes>
constexpr ElementType attachment_type(const char* name) {
    constexpr int kNumbers = numbers_of<Law>(Nodes);
    return {name,
            kDof,
            kNumbers,
            {name, Law::kRows, Nodes, kNumbers * sizeof(double), Bound::free, Law::kRows == 1, 0,
             evaluate_row<Law, Nodes>, stiffness_of_row<Law, Nodes>, nullptr, sample_attachment<Law, Nodes>},
            evaluate_batch<Law, Nodes>,
            stiffness_of_batch<Law, Nodes>};
}

constinit const ElementType kPointAttachments[kMaxNodes] = {
    attachment_type<PointLaw, 1>("point of 1 node"),  attachment_type<PointLaw, 2>("point of 2 nodes"),
    attachment_type<PointLaw, 3>("point of 3 nodes"), attachment_type<PointLaw, 4>("point of 4 nodes"),
    attachment_type<PointLaw, 5>("point of 5 nodes"), attachment_type<PointLaw, 6>("point of 6 nodes"),
    attachment_type<PointLaw, 7>("point of 7 nodes"), attachment_type<PointLaw, 8>("point of 8 nodes"),
};
constinit const ElementType kDistanceAttachments[kMaxNodes] = {
    attachment_type<DistanceLaw, 1>("distance of 1 node"),  attachment_type<DistanceLaw, 2>("distance of 2 nodes"),
    attachment_type<DistanceLaw, 3>("distance of 3 nodes"), attachment_type<DistanceLaw, 4>("distance of 4 nodes"),
    attachment_type<DistanceLaw, 5>("distance of 5 nodes"), attachment_type<DistanceLaw, 6>("distance of 6 nodes"),
    attachment_type<DistanceLaw, 7>("distance of 7 nodes"), attachment_type<DistanceLaw, 8>("distance of 8 nodes"),
};

}  // namespace

const ElementType& point_attachment(int nodes) { return kPointAttachments[nodes - 1]; }
const ElementType& distance_attachment(int nodes) { return kDistanceAttachments[nodes - 1]; }

}  // namespace taut
