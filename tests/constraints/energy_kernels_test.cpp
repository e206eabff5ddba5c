// Energies in lanes: what each element says of itself, one by one, and the same bits from every build.
#include "constraints/energy_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "continuum_lab.h"
#include "widths.h"

namespace taut::test {
namespace {

constexpr uint32_t kCells = 5;  // of a batch, which has room for more

// Some cells of one type, whose shapes are those of samples; a stretch turns them to that, in turned frames.
struct Cells {
    Cells(const ElementType& of, uint64_t seed, const Vec3* stretch) : type(of) {
        const auto nodes = static_cast<uint32_t>(type.row.nodes), rows = static_cast<uint32_t>(type.row.rows);
        for (uint32_t e = 0; e < kCells; ++e) {
            Single at(type, 10 * seed + e);
            const Mat3 u = random_rotation(seed + e), v = random_rotation(seed + e + 50);
            if (stretch) at.set_f(u * stretch->asDiagonal() * v.transpose());
            data.insert(data.end(), at.data.begin(), at.data.end());
            softness.push_back(0.5 + e);
            for (uint32_t n = 0; n < nodes; ++n) {
                node.push_back(static_cast<uint32_t>(pose.size()));
                pose.push_back(at.pose[n]);
            }
            element.push_back(kCells - 1 - e);  // in another order
        }
        std::ranges::reverse(node);
        for (auto at = node.begin(); at != node.end(); at += nodes) std::reverse(at, at + nodes);
        material.assign(rows * rows, 0.0);
        for (uint32_t r = 0; r < rows; ++r) material[r * rows + r] = r < 3 ? 2.0 : 0.7;
        if (rows == 3)  // Hooke's
            for (double& each : material) each += 0.6;
    }
    ElementBatch batch() const { return {kCells, node.data(), element.data(), data.data(), pose.data()}; }
    ElementStiffness stiffness() const { return {material.data(), softness.data()}; }
    size_t freedoms() const { return 3 * static_cast<size_t>(type.row.nodes); }

    const ElementType& type;
    std::vector<double> data, softness, material;
    std::vector<uint32_t> node, element;
    std::vector<Pose> pose;
};

struct Found {
    std::vector<double> energy, force, matrix;
};

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

Found by_lanes(const Cells& cells, const EnergyKernels& kernels, bool positive = false) {
    const EnergyKernel& kernel = kernels.*cells.type.energy;
    const EnergyLanes lanes{kCells,
                            cells.node.data(),
                            cells.element.data(),
                            cells.data.data(),
                            cells.pose[0].x.data(),
                            sizeof(Pose) / sizeof(double),
                            cells.material.data(),
                            cells.softness.data()};
    const size_t width = cells.freedoms();
    Found out{std::vector<double>(kCells), std::vector<double>(kCells * width),
              std::vector<double>(kCells * width * width)};
    std::vector<double> frame(kFrameNumbers), alone(kCells);
    kernel.evaluate(lanes, frame.data(), alone.data(), nullptr);
    kernel.evaluate(lanes, frame.data(), out.energy.data(), out.force.data());
    EXPECT_TRUE(same_bits(alone, out.energy));
    kernel.hessian(lanes, frame.data(), positive, out.matrix.data());
    return out;
}

Found one_by_one(const Cells& cells) {
    const auto rows = static_cast<size_t>(cells.type.row.rows), width = cells.freedoms();
    Found out{std::vector<double>(kCells), std::vector<double>(kCells * width),
              std::vector<double>(kCells * width * width)};
    std::vector<double> error(kCells * rows), jacobian(kCells * rows * width), lambda(kCells * rows);
    element_energy(cells.type, cells.batch(), cells.stiffness(), out.energy.data());
    cells.type.evaluate(cells.batch(), error.data(), jacobian.data(), 3);
    for (size_t i = 0; i < kCells; ++i)
        for (size_t r = 0; r < rows; ++r) {
            double stress = 0;
            for (size_t k = 0; k < rows; ++k) stress += cells.material[r * rows + k] * error[i * rows + k];
            lambda[i * rows + r] = -stress / cells.softness[cells.element[i]];
            for (size_t k = 0; k < width; ++k)
                out.force[i * width + k] -=
                    lambda[i * rows + r] * jacobian[((i * width / 3 + k / 3) * rows + r) * 3 + k % 3];
        }
    element_hessian(cells.type, cells.batch(), cells.stiffness(), lambda.data(), Curvature::raw, out.matrix.data());
    return out;
}

template <class Act>
void for_cells(Act&& act) {
    const Vec3 stretches[] = {
        {1, 1, 1},   {1.3, 1.3, 0.7}, {1.3, 1.3 - 1e-5, 0.7}, {1.2, 0.9, 1e-12}, {1.1, 1.1, -0.5}, {3.0, 2.5, -1.5},
        {1, 0.5, 0}, {1, 0, 0},       {1e-20, 1e-20, 0},      {1e2, 10, 1}};
    for (const ElementType* type : element_types()) {
        if (!type->energy) continue;
        for (uint64_t seed = 1; seed <= 20; ++seed) act(Cells(*type, seed, nullptr), seed, true);
        for (const Vec3& stretch : stretches)
            for (uint64_t seed = 1; seed <= 4; ++seed)
                act(Cells(*type, seed, &stretch), seed, stretch[1] + stretch[2] > 0.1);
    }
}

// Where stretches cancel, the side of the ridge is chosen: there energies alone are the same.
TEST(EnergyKernels, SayWhatElementsSay) {
    int cases = 0;
    for_cells([&](const Cells& cells, uint64_t seed, bool decided) {
        const Found found = by_lanes(cells, kEnergyKernelsScalar), expected = one_by_one(cells);
        const auto expect_near = [&](const std::vector<double>& a, const std::vector<double>& b, double within) {
            double size = 0, most = 0;
            for (size_t i = 0; i < a.size(); ++i) {
                size = std::max(size, std::abs(b[i]));
                most = std::max(most, std::abs(a[i] - b[i]));
            }
            EXPECT_LE(most, within * (1 + size)) << cells.type.name << " " << seed;
        };
        expect_near(found.energy, expected.energy, 1e-12);
        if (!decided) return;
        expect_near(found.force, expected.force, 1e-12);
        expect_near(found.matrix, expected.matrix, 1e-8);
        ++cases;
    });
    EXPECT_GT(cases, 100);
}

TEST(EnergyKernels, HaveTheSameBitsInEachBuild) {
    const std::vector<const EnergyKernels*> builds = builds_here({TAUT_BUILDS(kEnergyKernels)});
    for_cells([&](const Cells& cells, uint64_t seed, bool) {
        const Found expected = by_lanes(cells, kEnergyKernelsScalar);
        for (const EnergyKernels* build : builds) {
            const Found found = by_lanes(cells, *build);
            EXPECT_TRUE(same_bits(found.energy, expected.energy))
                << build->name << " " << cells.type.name << " " << seed;
            EXPECT_TRUE(same_bits(found.force, expected.force)) << build->name << " " << cells.type.name << " " << seed;
            EXPECT_TRUE(same_bits(found.matrix, expected.matrix))
                << build->name << " " << cells.type.name << " " << seed;
            EXPECT_TRUE(
                same_bits(by_lanes(cells, *build, true).matrix, by_lanes(cells, kEnergyKernelsScalar, true).matrix))
                << build->name << " " << cells.type.name << " " << seed;
        }
    });
}

// The positive part of the matrix, and the matrix itself where that is positive.
TEST(EnergyKernels, TakeThePositivePart) {
    int positive = 0, indefinite = 0;
    for_cells([&](const Cells& cells, uint64_t seed, bool decided) {
        if (!decided) return;
        const auto width = static_cast<Eigen::Index>(cells.freedoms());
        const Found raw = by_lanes(cells, kEnergyKernelsScalar), found = by_lanes(cells, kEnergyKernelsScalar, true);
        for (uint32_t i = 0; i < kCells; ++i) {
            const auto matrix_of = [&](const Found& of) {
                return Eigen::Map<const Eigen::MatrixXd>(&of.matrix[i * static_cast<size_t>(width * width)], width,
                                                         width);
            };
            const Eigen::MatrixXd exact = matrix_of(raw), taken = matrix_of(found), removed = taken - exact;
            const double rounding = 1e-9 * (1 + exact.norm());
            const auto least_of = [](const Eigen::MatrixXd& m) {
                return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
            };
            EXPECT_GE(least_of(taken), -rounding) << cells.type.name << " " << seed;
            EXPECT_GE(least_of(removed), -rounding) << cells.type.name << " " << seed;
            if (least_of(exact) > -1e-6 * rounding) {
                EXPECT_LE(removed.norm(), rounding) << cells.type.name << " " << seed;
                ++positive;
            } else {
                ++indefinite;
            }
        }
    });
    EXPECT_GT(positive, 50);
    EXPECT_GT(indefinite, 50);
}

// What is not finite stays with its element.
TEST(EnergyKernels, KeepWhatIsNotFiniteInItsLane) {
    for_cells([&](const Cells& cells, uint64_t, bool decided) {
        if (!decided) return;
        Cells broken = cells;
        broken.pose[0].x[1] = std::nan("");  // of one cell alone
        const Found found = by_lanes(broken, kEnergyKernelsScalar), expected = by_lanes(cells, kEnergyKernelsScalar);
        int same = 0;
        for (uint32_t i = 0; i < kCells; ++i) same += found.energy[i] == expected.energy[i];
        EXPECT_EQ(same, kCells - 1);
        EXPECT_TRUE(std::isnan(found.energy.back()));
    });
}

}  // namespace
}  // namespace taut::test
