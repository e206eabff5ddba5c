#include "sheet_system.h"

#include <array>
#include <cmath>
#include <stdexcept>

#include "constraints/material.h"
#include "constraints/shape_functions.h"
#include "scenes/soft_meshes.h"
#include "soft_metrics.h"

namespace bench {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

Sparse made(long rows, long columns, const Triplets& from) {
    Sparse out(rows, columns);
    out.setFromTriplets(from.begin(), from.end());
    return out;
}

// Entries of a matrix within a larger one, times s.
void append(Triplets& to, const Sparse& from, long row, long column, double s) {
    for (int k = 0; k < from.outerSize(); ++k)
        for (Sparse::InnerIterator it(from, k); it; ++it)
            to.emplace_back(row + it.row(), column + it.col(), s * it.value());
}

template <class Scalar>
double condition_in(const Sparse& a) {
    using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    const Eigen::SelfAdjointEigenSolver<Dense> solver(Dense(Matrix(a).cast<Scalar>()), Eigen::EigenvaluesOnly);
    const auto size = solver.eigenvalues().cwiseAbs().eval();
    return static_cast<double>(size.maxCoeff() / size.minCoeff());
}

}  // namespace

SheetSystem::SheetSystem(const SheetPlan& plan)
    : plan_(plan), type_(plan.links ? &taut::kLinkElement : &taut::kGreenTri3) {
    const scenes::Cloth cloth = scenes::grid_cloth(plan.side, plan.side, plan.size, plan.size, 0);
    for (const taut_pos& p : cloth.points) pose_.push_back({{p.x, p.y, p.z}, taut::Mat3::Identity()});
    first_.resize(pose_.size());
    for (size_t i = 0; i < pose_.size(); ++i) {
        const bool fixed = i == 0 || i + 1 == pose_.size();
        first_[i] = fixed ? -1 : freedoms_;
        freedoms_ += fixed ? 0 : 3;
    }
    velocity_ = Vector::Zero(freedoms_);
    plan.links ? add_links() : add_triangles();
    lambda_.resize(compliance_.size() * static_cast<size_t>(type_->row.rows));
}

void SheetSystem::add_links() {
    const SoftShape shape(scenes::grid_cloth(plan_.side, plan_.side, plan_.size, plan_.size, 0));
    for (const SoftShape::Edge& edge : shape.edges) {
        node_.insert(node_.end(), {edge.a, edge.b});
        data_.push_back(edge.rest);
        compliance_.push_back(Matrix::Constant(1, 1, plan_.compliance));
    }
}

void SheetSystem::add_triangles() {
    double unit[9];
    if (!taut::hooke_sheet({plan_.young, plan_.nu}, unit)) throw std::runtime_error("no stable material");
    const scenes::Cloth cloth = scenes::grid_cloth(plan_.side, plan_.side, plan_.size, plan_.size, 0);
    for (size_t t = 0; t < cloth.triangles.size(); t += 3) {
        const uint32_t* corner = &cloth.triangles[t];
        const taut::Vec3 x[3] = {pose_[corner[0]].x, pose_[corner[1]].x, pose_[corner[2]].x};
        taut::GaussPoint<3, 2> point;
        if (!taut::tri3_point(x, taut::Vec3::UnitX(), point)) throw std::runtime_error("a triangle without area");
        node_.insert(node_.end(), corner, corner + 3);
        data_.insert(data_.end(), &point.g[0][0], &point.g[0][0] + 6);
        compliance_.push_back(Eigen::Map<Eigen::Matrix3d>(unit) / (plan_.thickness * point.weight));
    }
}

void SheetSystem::assemble() {
    const auto count = static_cast<uint32_t>(compliance_.size());
    const long nodes = type_->row.nodes, rows = type_->row.rows, width = 3 * nodes;
    const auto total = static_cast<size_t>(count);
    const taut::ElementBatch batch{count, node_.data(), nullptr, data_.data(), pose_.data()};
    std::vector<double> error(total * static_cast<size_t>(rows)), j(total * static_cast<size_t>(nodes * rows * 3)),
        k(total * static_cast<size_t>(width * width));
    type_->evaluate(batch, error.data(), j.data(), 3);
    type_->stiffness(batch, lambda_.data(), taut::Curvature::positive, k.data());
    phi_ = stacked(error);
    Triplets in_j, in_k, in_c, in_d;
    const auto each = [](long n, auto&& act) {
        for (long i = 0; i < n; ++i) act(i);
    };
    for (long e = 0; e < static_cast<long>(total); ++e) {
        const auto at = [&](long n) { return first_[node_[static_cast<size_t>(e * nodes + n)]]; };
        const Matrix& c = compliance_[static_cast<size_t>(e)];
        const Matrix d = plan_.links ? Matrix(c * 0) : Matrix(c.inverse());
        each(rows, [&](long r) {
            each(rows, [&](long s) {
                in_c.emplace_back(e * rows + r, e * rows + s, c(r, s));
                in_d.emplace_back(e * rows + r, e * rows + s, d(r, s));
            });
        });
        each(nodes, [&](long n) {
            if (at(n) < 0) return;
            each(rows, [&](long r) {
                each(3, [&](long i) {
                    in_j.emplace_back(e * rows + r, at(n) + i,
                                      j[static_cast<size_t>(((e * nodes + n) * rows + r) * 3 + i)]);
                });
            });
            each(nodes, [&](long m) {
                if (at(m) < 0) return;
                each(9, [&](long i) {
                    in_k.emplace_back(
                        at(n) + i / 3, at(m) + i % 3,
                        k[static_cast<size_t>(e * width * width + (3 * n + i / 3) * width + 3 * m + i % 3)]);
                });
            });
        });
    }
    jacobian_ = made(phi_.size(), freedoms_, in_j);
    curvature_ = made(freedoms_, freedoms_, in_k);
    give_ = made(phi_.size(), phi_.size(), in_c);
    stiff_ = made(phi_.size(), phi_.size(), in_d);
}

Sparse SheetSystem::compliance_form() const {
    Triplets all;
    for (long i = 0; i < freedoms_; ++i) all.emplace_back(i, i, plan_.mass);
    append(all, curvature_, 0, 0, plan_.h * plan_.h);
    append(all, jacobian_, freedoms_, 0, -1);
    append(all, Sparse(jacobian_.transpose()), 0, freedoms_, -1);
    append(all, give_, freedoms_, freedoms_, -1 / (plan_.h * plan_.h));
    return made(freedoms_ + phi_.size(), freedoms_ + phi_.size(), all);
}

Sparse SheetSystem::stiffness_form(double link_stiffness) const {
    Triplets all;
    for (long i = 0; i < freedoms_; ++i) all.emplace_back(i, i, plan_.mass);
    const double hh = plan_.h * plan_.h;
    append(all, curvature_, 0, 0, hh);
    if (plan_.links) {
        const double k = link_stiffness > 0 ? link_stiffness : 1 / plan_.compliance;
        append(all, jacobian_.transpose() * jacobian_, 0, 0, hh * k);
    } else {
        append(all, jacobian_.transpose() * stiff_ * jacobian_, 0, 0, hh);
    }
    return made(freedoms_, freedoms_, all);
}

Vector SheetSystem::compliance_side() const {
    Vector b(freedoms_ + phi_.size());
    b.head(freedoms_) = plan_.mass * velocity_;
    for (long i = 1; i < freedoms_; i += 3) b[i] -= plan_.mass * plan_.h * plan_.gravity;
    b.tail(phi_.size()) = phi_ / plan_.h;
    return b;
}

Vector SheetSystem::stiffness_side() const {
    return compliance_side().head(freedoms_) - plan_.h * (jacobian_.transpose() * (stiff_ * phi_));
}

void SheetSystem::step() {
    assemble();
    Eigen::SparseLU<Sparse> solver(compliance_form());
    if (solver.info() != Eigen::Success) throw std::runtime_error("a sheet's step has no single solution");
    const Vector x = solver.solve(compliance_side());
    velocity_ = x.head(freedoms_);
    Vector::Map(lambda_.data(), phi_.size()) = x.tail(phi_.size()) / plan_.h;
    for (size_t i = 0; i < pose_.size(); ++i)
        if (first_[i] >= 0) pose_[i].x += plan_.h * velocity_.segment<3>(first_[i]);
}

double condition(const Sparse& a, bool precise) {
    return precise ? condition_in<long double>(a) : condition_in<double>(a);
}

Vector equilibration(const Sparse& a) {
    constexpr int kPasses = 30;  // Ruiz 2001: each takes the root of how far a row is off
    Vector scale = Vector::Ones(a.rows());
    for (int pass = 0; pass < kPasses; ++pass) {
        Vector largest = Vector::Zero(a.rows());
        for (int k = 0; k < a.outerSize(); ++k)
            for (Sparse::InnerIterator it(a, k); it; ++it)
                largest[it.row()] =
                    std::max(largest[it.row()], std::abs(scale[it.row()] * it.value() * scale[it.col()]));
        scale = scale.cwiseQuotient(largest.cwiseSqrt());
    }
    return scale;
}

Sparse equilibrated(const Sparse& a) {
    const Vector scale = equilibration(a);
    return scale.asDiagonal() * a * scale.asDiagonal();
}

}  // namespace bench
