// Every solver of the list against Newton's method on what every element type of the list makes of a small mesh:
// Newton's is dense, with the exact matrix of each element and a line search, and is written here.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string_view>

#include "constraints/material.h"
#include "constraints/shape_functions.h"
#include "rig.h"
#include "solvers/minimisation.h"

namespace taut::test::newton {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kMass = 0.1;                      // of a node [kg]
constexpr double kYoung = 2000, kPoisson = 0.3;    // of solids [Pa]
constexpr double kThickness = 0.01, kCloth = 1e4;  // of a sheet [m], its Young's modulus [Pa]

// Elements of one type and material.
struct Part {
    const ElementType* type;
    Matrix compliance;
    std::vector<uint32_t> node{};
    std::vector<double> data{}, softness{};

    size_t count() const { return softness.size(); }
    void add(std::initializer_list<uint32_t> nodes, std::initializer_list<double> numbers, double soft) {
        add(std::vector<uint32_t>(nodes), std::vector<double>(numbers), soft);
    }
    void add(const std::vector<uint32_t>& nodes, const std::vector<double>& numbers, double soft) {
        node.insert(node.end(), nodes.begin(), nodes.end());
        data.insert(data.end(), numbers.begin(), numbers.end());
        softness.push_back(soft);
    }
};

struct Mesh {
    std::vector<Vec3> rest;
    std::vector<bool> held;
    std::vector<Part> parts;
};

bool ends(const ElementType& type, std::string_view with) { return std::string_view(type.name).ends_with(with); }

// Gravity not along any side, so that there is one way to hang [m/s^2].
const Vec3 kGravity(0.6, -3.6, 1.2);

// A sheet of 3 x 3 that hangs by its upper row, or a bar of two cells from a wall.
Mesh sheet_mesh() {
    Mesh mesh;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            mesh.rest.emplace_back(0.1 * k, -0.1 * i, 0.004 * (i * k - 1));
            mesh.held.push_back(i == 0);
        }
    return mesh;
}
Mesh bar_mesh() {
    Mesh mesh;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 4; ++k) {
            mesh.rest.emplace_back(0.1 * i, 0.1 * (k & 1), 0.1 * (k >> 1));
            mesh.held.push_back(i == 0);
        }
    return mesh;
}

constexpr uint32_t kTriangles[8][3] = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4},
                                       {3, 4, 7}, {3, 7, 6}, {4, 5, 8}, {4, 8, 7}};
constexpr uint32_t kQuads[4][4] = {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}};
// Each with two nodes on either side of it: of a fold, the edge first.
constexpr uint32_t kFolds[4][4] = {{0, 4, 1, 3}, {3, 7, 4, 6}, {3, 4, 0, 7}, {4, 5, 1, 8}};

Part link_part() {
    Part part{&kLinkElement, Matrix::Constant(1, 1, 0.01)};
    const Mesh mesh = sheet_mesh();
    for (uint32_t a = 0; a < 9; ++a)
        for (uint32_t b = a + 1; b < 9; ++b) {
            const double length = (mesh.rest[b] - mesh.rest[a]).norm();
            if (length < 0.15) part.add({a, b}, {length}, 1);
        }
    return part;
}

// Gauss points of one cell.
template <int Nodes, int Dim, size_t Points>
void add_points(Part& part, const uint32_t (&node)[Nodes], const GaussPoint<Nodes, Dim> (&point)[Points],
                double thickness, double alpha) {
    for (const auto& each : point) {
        std::vector<double> data(&each.g[0][0], &each.g[0][0] + Nodes * Dim);
        data.resize(static_cast<size_t>(part.type->numbers), alpha);
        part.add({node, node + Nodes}, data, 1 / (thickness * each.weight));
    }
}

template <int Nodes>
void corners(const Mesh& mesh, const uint32_t (&node)[Nodes], Vec3 (&x)[Nodes]) {
    for (int n = 0; n < Nodes; ++n) x[n] = mesh.rest[node[n]];
}

Part sheet_part(const ElementType& type, const Mesh& mesh) {
    double compliance[9];
    EXPECT_TRUE(hooke_sheet({kCloth, kPoisson}, compliance));
    Part part{&type, Eigen::Map<RowMajor>(compliance, 3, 3)};
    if (ends(type, "tri3"))
        for (const auto& node : kTriangles) {
            Vec3 x[3];
            corners(mesh, node, x);
            GaussPoint<3, 2> point[1];
            EXPECT_TRUE(tri3_point(x, Vec3::UnitX(), point[0]));
            add_points(part, node, point, kThickness, 0);
        }
    else
        for (const auto& node : kQuads) {
            Vec3 x[4];
            corners(mesh, node, x);
            GaussPoint<4, 2> point[4];
            EXPECT_TRUE(quad4_points(x, Vec3::UnitX(), point));
            add_points(part, node, point, kThickness, 0);
        }
    return part;
}

Part solid_part(const ElementType& type, const Mesh& mesh) {
    const Isotropic material{kYoung, kPoisson};
    double six[36], three[9], four[16], two[4], alpha = 0;
    const int rows = type.row.rows;
    EXPECT_TRUE(hooke_solid(material, six) && hooke_stretches(material, three) && fixed_corotated(material, four) &&
                neo_hookean(material, two, alpha));
    const double* compliance = rows == 6 ? six : rows == 3 ? three : rows == 4 ? four : two;
    Part part{&type, Eigen::Map<const RowMajor>(compliance, rows, rows)};
    for (uint32_t cell = 0; cell < 2; ++cell) {
        const uint32_t o = 4 * cell, corner[8] = {o, o + 4, o + 5, o + 1, o + 2, o + 6, o + 7, o + 3};
        if (ends(type, "hex8")) {
            Vec3 x[8];
            corners(mesh, corner, x);
            GaussPoint<8, 3> point[8];
            EXPECT_TRUE(hex8_points(x, point));
            add_points(part, corner, point, 1, alpha);
            continue;
        }
        constexpr uint32_t kRing[7] = {1, 2, 3, 7, 4, 5, 1};  // about the diagonal from corner 0 to 6
        for (int t = 0; t < 6; ++t) {
            const uint32_t node[4] = {corner[0], corner[kRing[t]], corner[kRing[t + 1]], corner[6]};
            Vec3 x[4];
            corners(mesh, node, x);
            GaussPoint<4, 3> point[1];
            EXPECT_TRUE(tet4_point(x, point[0]));
            add_points(part, node, point, 1, alpha);
        }
    }
    return part;
}

// What a type makes; those that bend lie over a sheet of links.
Mesh mesh_of(const ElementType& type) {
    if (ends(type, "tet4") || ends(type, "hex8")) {
        Mesh mesh = bar_mesh();
        mesh.parts = {solid_part(type, mesh)};
        return mesh;
    }
    Mesh mesh = sheet_mesh();
    if (ends(type, "tri3") || ends(type, "quad4")) {
        mesh.parts = {sheet_part(type, mesh)};
        return mesh;
    }
    mesh.parts = {link_part()};
    if (&type == &kLinkElement) return mesh;
    Part part{&type, Matrix::Identity(type.row.rows, type.row.rows) * 50};
    if (&type == &kBendElement)
        for (const uint32_t first : {0u, 1u, 2u}) part.add({first, first + 3, first + 6}, {}, 1);
    for (const auto& node : kFolds) {
        Vec3 x[4];
        corners(mesh, node, x);
        double weight[4], area;
        if (&type == &kDihedralElement) part.add({node, node + 4}, {0.3}, 1);
        if (&type == &kQuadraticBendElement && quadratic_bend_weights(x, weight, area))
            part.add({node, node + 4}, {weight, weight + 4}, 0.01);
    }
    mesh.parts.push_back(part);
    return mesh;
}

// ---------------------------------------------------------------- Newton's method

// V = sum of W - f . x over the nodes that are not held; with a substep |x - start|^2 M / (2 h^2) on top.
class Reference {
public:
    Reference(const Mesh& mesh, const std::vector<Pose>& start, double substep = 0)
        : mesh_(mesh), start_(start), pose_(start), inertia_(substep > 0 ? kMass / (substep * substep) : 0) {}

    // To where the force that is left is rounding alone.
    void solve() {
        for (int i = 0; i < 200; ++i) {
            const auto [gradient, exact] = derivatives(false);
            if (gradient.norm() < 1e-13 * kMass * kGravity.norm() * static_cast<double>(pose_.size())) return;
            Matrix hessian = exact;
            Eigen::LLT<Matrix> factor(hessian);
            if (factor.info() != Eigen::Success) factor.compute(derivatives(true).second);
            const Vector step = factor.solve(-gradient);
            const double before = energy();
            double share = 1;
            const std::vector<Pose> start = pose_;
            for (;; share /= 2) {
                pose_ = start;
                move(share * step);
                if (energy() <= before + 1e-4 * share * gradient.dot(step) || share * step.norm() < 1e-12) break;
            }
        }
        ADD_FAILURE() << "Newton's method did not converge: " << derivatives(false).first.norm() << " N left";
    }
    const std::vector<Pose>& pose() const { return pose_; }
    double least_eigenvalue() const {
        return Eigen::SelfAdjointEigenSolver<Matrix>(derivatives(false).second).eigenvalues()[0];
    }

private:
    double energy() const {
        double sum = 0;
        for (const Part& part : mesh_.parts) {
            std::vector<double> each(part.count());
            const RowMajor d = part.compliance.inverse();
            element_energy(*part.type, batch(part), {d.data(), part.softness.data()}, each.data());
            for (const double w : each) sum += w;
        }
        for (size_t n = 0; n < pose_.size(); ++n)
            if (!mesh_.held[n])
                sum += 0.5 * inertia_ * (pose_[n].x - start_[n].x).squaredNorm() - kMass * kGravity.dot(pose_[n].x);
        return sum;
    }
    // Gradient and matrix of the second derivatives, or a positive one.
    std::pair<Vector, Matrix> derivatives(bool positive) const {
        const auto size = static_cast<long>(3 * pose_.size());
        Vector g = Vector::Zero(size);
        Matrix h = inertia_ * Matrix::Identity(size, size);
        for (size_t n = 0; n < pose_.size(); ++n)
            g.segment<3>(static_cast<long>(3 * n)) = inertia_ * (pose_[n].x - start_[n].x) - kMass * kGravity;
        for (const Part& part : mesh_.parts) add(part, positive, g, h);
        for (size_t n = 0; n < pose_.size(); ++n) {
            if (!mesh_.held[n]) continue;
            const auto at = static_cast<long>(3 * n);
            g.segment<3>(at).setZero();
            h.middleRows<3>(at).setZero();
            h.middleCols<3>(at).setZero();
            h.block<3, 3>(at, at).setIdentity();
        }
        return {g, h};
    }
    void add(const Part& part, bool positive, Vector& g, Matrix& h) const {
        const ElementType& type = *part.type;
        const int rows = type.row.rows, nodes = type.row.nodes, width = 3 * nodes;
        const Matrix d = part.compliance.inverse();
        for (uint32_t e = 0; e < part.count(); ++e) {
            const ElementBatch one{1, &part.node[e * static_cast<uint32_t>(nodes)], &e, part.data.data(), pose_.data()};
            Vector c(rows);
            std::vector<double> raw(static_cast<size_t>(rows * width));
            type.evaluate(one, c.data(), raw.data(), 3);
            Matrix j(rows, width);
            for (int n = 0; n < nodes; ++n)
                j.middleCols(3 * n, 3) = Eigen::Map<RowMajor>(raw.data() + n * rows * 3, rows, 3);
            const Matrix stiff = d / part.softness[e];
            const Vector lambda = -stiff * c;
            RowMajor k(width, width);
            const RowMajor material = d;
            if (positive)
                positive_sum(type, one, {material.data(), part.softness.data()}, lambda.data(), k.data());
            else
                type.stiffness(one, lambda.data(), Curvature::raw, k.data());
            const Matrix all = positive ? Matrix(k) : Matrix(j.transpose() * stiff * j + 0.5 * (k + k.transpose()));
            const Vector force = j.transpose() * lambda;
            for (int n = 0; n < nodes; ++n) {
                const auto at = [&](int m) { return 3 * static_cast<long>(one.node[m]); };
                g.segment<3>(at(n)) -= force.segment<3>(3 * n);
                for (int m = 0; m < nodes; ++m) h.block<3, 3>(at(n), at(m)) += all.block<3, 3>(3 * n, 3 * m);
            }
        }
    }
    ElementBatch batch(const Part& part) const {
        return {static_cast<uint32_t>(part.count()), part.node.data(), nullptr, part.data.data(), pose_.data()};
    }
    void move(const Vector& by) {
        for (size_t n = 0; n < pose_.size(); ++n) pose_[n].x += by.segment<3>(static_cast<long>(3 * n));
    }

    const Mesh& mesh_;
    std::vector<Pose> start_, pose_;
    double inertia_;  // [N/m]
};

std::vector<Pose> poses_of(const Mesh& mesh) {
    std::vector<Pose> out;
    for (const Vec3& x : mesh.rest) out.push_back({x, Mat3::Identity()});
    return out;
}

// ---------------------------------------------------------------- the solvers

// Substeps from standstill.
class Resting : public Rig {
public:
    Resting(const Mesh& mesh, const std::vector<Pose>& start, const Solver& with, ElementForm form, double substep,
            uint32_t sweeps)
        : Rig(substep) {
        for (size_t n = 0; n < mesh.rest.size(); ++n)
            node_.push_back(mesh.held[n] ? fixed(mesh.rest[n]) : particle(kMass, start[n].x));
        gravity = kGravity;
        settings.sweeps = sweeps;
        settings.minimisation = &minimisation;
        for (const Part& part : mesh.parts) {
            Elements& all = w.elements;
            ElementSet& set = all.set[all.add(*part.type)];
            const RowMajor compliance = part.compliance;
            set_compliance(set, {compliance.data(), static_cast<size_t>(compliance.size())}, 0);
            set.form = form;
            const auto nodes = static_cast<size_t>(part.type->row.nodes);
            const auto numbers = static_cast<size_t>(part.type->numbers);
            for (uint32_t e = 0; e < part.count(); ++e) {
                std::vector<uint32_t> of;
                for (size_t n = 0; n < nodes; ++n) of.push_back(node_[part.node[e * nodes + n]]);
                all.insert(set, e, of, part.softness[e]);
                std::copy_n(part.data.begin() + static_cast<long>(e * numbers), numbers, set.data_of(e));
            }
        }
        solver_ = &with;
    }
    void step() {
        begin(*solver_);
        predict();
        solve();
        move();
        relax();
        for (const uint32_t n : node_) {
            NodeMotion& motion = w.nodes.motion[n];
            motion.v.setZero();
            motion.slow_v.setZero();
        }
    }
    // Largest distance of a node from there [m].
    double apart(const std::vector<Pose>& there) const {
        double most = 0;
        for (size_t n = 0; n < node_.size(); ++n)
            most = std::max(most, (w.nodes.motion[node_[n]].x - there[n].x).norm());
        return most;
    }

private:
    const MinimisationSettings minimisation{1e-13};
    std::vector<uint32_t> node_;
    const Solver* solver_;
};

// ---------------------------------------------------------------- tests

std::vector<const ElementType*> elastic_types() {
    std::vector<const ElementType*> out;
    for (const ElementType* type : element_types())
        // Not those of air, nor of attachments, whose two sides are of no mesh: attachment_test.cpp of physics.
        if (type != &kDragElement && std::string_view(type->name).find(" node") == std::string_view::npos)
            out.push_back(type);
    return out;
}

struct Tested {
    const ElementType* type;
    size_t solver;
};
std::vector<Tested> all_of() {
    std::vector<Tested> out;
    for (const ElementType* type : elastic_types())
        for (size_t solver = 0; solver < solvers().size(); ++solver) out.push_back({type, solver});
    return out;
}
std::string name_of(const testing::TestParamInfo<Tested>& tested) {
    std::string name = std::string(tested.param.type->name) + "_" + solvers()[tested.param.solver]->name;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

class AgreesWithNewton : public testing::TestWithParam<Tested> {};
INSTANTIATE_TEST_SUITE_P(Of, AgreesWithNewton, testing::ValuesIn(all_of()), name_of);

// How a solver is brought to what it is compared with.
struct Way {
    ElementForm form;
    double substep;  // [s]
    uint32_t sweeps;
    int most;     // substeps; 1: to its end, else to rest
    double near;  // in parts of the sag
};
std::vector<Way> ways_of(const Solver& solver) {
    if (solver.direct) return {{ElementForm::energy, 1, 0, 300, 1e-8}, {ElementForm::rows, 0.1, 0, 300, 1e-3}};
    // Sweeps go by where a substep begins, and keep velocities in float.
    if (solver.lanes) return {{ElementForm::rows, 1.0 / 50, 10, 1500, 3e-3}};
    if (solver.energies) return {{ElementForm::energy, 0.05, 0, 1, 1e-7}};
    return {{ElementForm::rows, 0.05, 300, 1, 2e-5}};
}

TEST_P(AgreesWithNewton, OnEveryElement) {
    const Mesh mesh = mesh_of(*GetParam().type);
    Reference rest(mesh, poses_of(mesh));
    rest.solve();
    ASSERT_GT(rest.least_eigenvalue(), 0) << "it hangs on an edge";
    double sag = 0;
    std::vector<Pose> start = rest.pose();
    for (size_t n = 0; n < start.size(); ++n) {
        const Vec3 off = mesh.rest[n] - start[n].x;
        sag = std::max(sag, off.norm());
        start[n].x += 0.1 * off;
    }
    ASSERT_GT(sag, 5e-3);
    const Solver& solver = *solvers()[GetParam().solver];
    for (const Way& way : ways_of(solver)) {
        Reference substep(mesh, start, way.substep);
        if (way.most == 1) substep.solve();
        const std::vector<Pose>& there = way.most == 1 ? substep.pose() : rest.pose();
        Resting rig(mesh, start, solver, way.form, way.substep, way.sweeps);
        ASSERT_GT(rig.apart(there), 0.01 * sag);
        double apart = 1;
        int steps = 0;
        for (; steps < way.most && apart > way.near; ++steps) {
            rig.step();
            apart = rig.apart(there) / sag;
        }
        EXPECT_LE(apart, way.near) << "form " << static_cast<int>(way.form) << " after " << steps << " substeps";
    }
}

}  // namespace
}  // namespace taut::test::newton
