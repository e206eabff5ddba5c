// The fused sweeps of elements: the same bits from their builds, and the impulses that the rows of each element ask for
// where the sweep begins, in double precision.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstring>

#include "constraints/random.h"
#include "simd/width.h"
#include "system/assemble.h"
#include "widths.h"

namespace taut::test {
namespace {

constexpr double kElementStep = 1.0 / 600;
constexpr uint32_t kElements = 40;

// Random elements of one type, no two of which share a node; some ends stay where they are.
struct Lanes {
    Lanes(const ElementType& of, uint64_t seed, bool pulls)
        : memory(taut_hooks{}), elements(memory), system(memory), group(memory), team(taut_hooks{}, 1), type(of) {
        Random random(seed);
        const auto nodes = static_cast<uint32_t>(type.row.nodes);
        const uint32_t seats = 1 + nodes * kElements;
        system.scheme.set_length(kElementStep);
        system.sweep.resize(seats);
        system.sweep_pose.resize(seats);
        system.found.resize(seats);
        system.seat.resize(seats + 1);
        for (uint32_t i = 0; i <= seats; ++i) system.seat[i] = i;  // node i sits at i + 1
        ElementSet& set = elements.set[elements.add(type)];
        set.fused = true;
        set.pulls = pulls;
        const int rows = type.row.rows;
        Eigen::MatrixXd c(rows, rows);
        for (double& each : c.reshaped()) each = random.between(-1, 1);
        c = Eigen::MatrixXd(c * c.transpose() + 0.1 * Eigen::MatrixXd::Identity(rows, rows)) * 1e-4;
        set_compliance(set, {c.data(), static_cast<size_t>(rows * rows)}, 0.003);
        reserve_elements(set, kElements);
        for (uint32_t e = 0; e < kElements; ++e) {
            double data[64];
            Pose x[kMaxNodes];
            type.row.sample(seed * 1000 + e, data, x);
            uint32_t node[kMaxNodes];
            for (uint32_t n = 0; n < nodes; ++n) {
                node[n] = e * nodes + n;
                const uint32_t at = node[n] + 1;
                system.found[at].x = x[n].x;
                for (int k = 0; k < 3; ++k) {
                    system.sweep_pose[at].dx[k] = static_cast<float>(random.between(-0.05, 0.05));
                    system.sweep[at].velocity.v[k] = static_cast<float>(random.between(-1, 1));
                    system.sweep[at].velocity.w[k] = static_cast<float>(random.between(-1, 1));
                }
                const bool stays = n == 0 && random.unit() < 0.3;
                system.sweep[at].set_inv_mass(stays ? 0 : static_cast<float>(random.between(0.5, 5)));
                system.sweep_pose[at].inv_mass = system.sweep[at].mass.inv_mass;
            }
            elements.insert(set, e, {node, nodes}, random.between(0.5, 2));
            std::copy_n(data, type.numbers, set.data_of(e));
            group.fused.push_back({0, e});
        }
        group.fused_pass.push_back({0, kElements, false});
        build_element_lanes(team, system, group, elements);
    }

    void sweep(const ElementKernels& kernels) {
        const ElementTerms terms{static_cast<float>(kElementStep), static_cast<float>(1 / system.scheme.act), true};
        for (const ElementPass& pass : system.elements.pass)
            (kernels.*pass.sweep)(system.elements.view(), pass.begin, pass.end, system.sweep.data(),
                                  system.sweep_pose.data(), terms);
    }

    Memory memory;
    Elements elements;
    System system;
    Group group;
    Team team;
    const ElementType& type;
};

Vec3 velocity(const SweepNode& node) { return {node.velocity.v[0], node.velocity.v[1], node.velocity.v[2]}; }

class FusedElements : public testing::TestWithParam<const ElementType*> {};
std::vector<const ElementType*> fused_types() {
    std::vector<const ElementType*> out;
    for (const ElementType* type : element_types())
        if (type->sweep) out.push_back(type);
    return out;
}
INSTANTIATE_TEST_SUITE_P(Of, FusedElements, testing::ValuesIn(fused_types()), [](const auto& each) {
    std::string name = each.param->name;
    std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
    return name;
});

TEST_P(FusedElements, GivesTheImpulsesThatItsRowsAskFor) {
    const ElementType& type = *GetParam();
    const int rows = type.row.rows, nodes = type.row.nodes;
    for (const bool pulls : {false, true}) {
        if (pulls && rows > 1) continue;
        Lanes lanes(type, 7, pulls);
        const Lanes first(type, 7, pulls);
        const System& before = first.system;
        lanes.sweep(kElementKernelsScalar);
        store_element_lanes(lanes.team, lanes.system);
        const ElementSet& set = lanes.elements.set[0];
        for (uint32_t e = 0; e < kElements; ++e) {
            Pose x[kMaxNodes];
            Eigen::VectorXd u(3 * nodes), w(3 * nodes);
            for (int n = 0; n < nodes; ++n) {
                const uint32_t at = set.nodes_of(e)[static_cast<size_t>(n)] + 1;
                const float* dx = before.sweep_pose[at].dx;
                u.segment<3>(3 * n) = velocity(before.sweep[at]);
                w.segment<3>(3 * n).setConstant(static_cast<double>(before.sweep[at].mass.inv_mass));
                x[n].x = before.found[at].x + Vec3(dx[0], dx[1], dx[2]) + kElementStep * u.segment<3>(3 * n);
            }
            double c[kMaxRows], j[kMaxNodes * kMaxRows * kDof];
            type.row.evaluate(set.data_of(e), x, c, j);
            Eigen::MatrixXd J(rows, 3 * nodes);
            for (int n = 0; n < nodes; ++n)
                for (int r = 0; r < rows; ++r)
                    J.block<1, 3>(r, 3 * n) = Vec3::Map(j + (n * rows + r) * kDof).transpose();
            const double d = set.relaxation;
            const Eigen::MatrixXd S = J * w.asDiagonal() * J.transpose();
            const Eigen::MatrixXd soft =
                set.softness[e] / kElementStep * Eigen::Map<const Eigen::MatrixXd>(set.compliance, rows, rows);
            Eigen::VectorXd mu =
                -((kElementStep + d) * S + soft).ldlt().solve(Eigen::Map<Eigen::VectorXd>(c, rows) + d * J * u);
            if (pulls) mu[0] = std::min(mu[0], 0.0);
            const Eigen::VectorXd wanted = u + w.asDiagonal() * J.transpose() * mu;
            const double size = 1e-4 * (1 + wanted.norm());
            for (int n = 0; n < nodes; ++n) {
                const uint32_t at = set.nodes_of(e)[static_cast<size_t>(n)] + 1;
                EXPECT_LT((velocity(lanes.system.sweep[at]) - wanted.segment<3>(3 * n)).norm(), size) << e;
                for (int k = 0; k < 3; ++k)
                    EXPECT_EQ(lanes.system.sweep[at].velocity.w[k], before.sweep[at].velocity.w[k]) << "spins stay";
            }
            for (int r = 0; r < rows; ++r)
                EXPECT_NEAR(kElementStep * set.lambda_of(e)[r], mu[r], 2e-4 * (1 + mu.norm())) << e;
        }
    }
}

TEST_P(FusedElements, HasTheSameBitsInEachBuild) {
    Lanes scalar(*GetParam(), 11, false);
    scalar.sweep(kElementKernelsScalar);
    for (const ElementKernels* build : builds_here({TAUT_BUILDS(kElementKernels)})) {
        Lanes other(*GetParam(), 11, false);
        other.sweep(*build);
        ASSERT_EQ(scalar.system.sweep.size(), other.system.sweep.size());
        EXPECT_EQ(std::memcmp(scalar.system.sweep.data(), other.system.sweep.data(),
                              scalar.system.sweep.size() * sizeof(SweepNode)),
                  0)
            << build->name;
    }
}

}  // namespace
}  // namespace taut::test
