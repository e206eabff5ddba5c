// The sparse factorisation on random graphs of nodes and multipliers, against Eigen's dense LU.
#include "linear/sparse_block_ldlt.h"
#include "simd/width.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstring>
#include <ctime>
#include <limits>
#include <map>
#include <random>

#include "linear/held_order.h"

namespace taut::test {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

BlockPiece piece(const RowMajor& m) {
    return {m.data(), static_cast<int>(m.rows()), static_cast<int>(m.cols()), static_cast<int>(m.cols())};
}

// [H J^T; J -c I] by blocks.
struct Problem {
    struct Unknown {
        int size;
        bool multiplier;
    };
    std::vector<Unknown> unknown;
    std::map<std::pair<uint32_t, uint32_t>, RowMajor> block;  // one of each pair (i, j)
    std::mt19937_64 engine;

    explicit Problem(uint64_t seed) : engine(seed) {}

    uint32_t pick(uint32_t count) { return std::uniform_int_distribution<uint32_t>(0, count - 1)(engine); }
    RowMajor random(int rows, int columns) {
        std::uniform_real_distribution<double> number(-1, 1);
        return RowMajor::NullaryExpr(rows, columns, [&] { return number(engine); });
    }
    // Masses over three decades.
    uint32_t add_node(int size) {
        const RowMajor a = random(size, size);
        const auto i = add({size, false});
        block[{i, i}] =
            std::pow(10.0, 3 * random(1, 1)(0, 0) / 2) * (a * a.transpose() + RowMajor::Identity(size, size));
        return i;
    }
    uint32_t add_multiplier(int size, double compliance) {
        const auto i = add({size, true});
        block[{i, i}] = -compliance * RowMajor::Identity(size, size);
        return i;
    }
    // A joint between two nodes, with stiffness between them if coupled.
    void join(uint32_t a, uint32_t b, double compliance, bool coupled) {
        const bool wide = unknown[a].size == 6 && unknown[b].size == 6 && pick(2) == 0;
        const uint32_t m = add_multiplier(wide ? 6 : 3, compliance);
        link(m, a);
        if (pick(2) == 0)
            link(m, b);  // in either direction
        else
            link(b, m);
        if (!coupled) return;
        const RowMajor k =
            0.01 * random(unknown[a].size, unknown[b].size);  // stays positive: the diagonals are 1 and more
        const double scale = std::min(block[{a, a}].norm(), block[{b, b}].norm()) / 10;
        block[{a, b}] = scale * k;
    }
    // Well-conditioned, as levers are, in either direction.
    void link(uint32_t i, uint32_t j) {
        const int rows = unknown[i].size, columns = unknown[j].size;
        block[{i, j}] = RowMajor::Identity(rows, columns) + 0.3 * random(rows, columns);
    }
    void hold(uint32_t node, double compliance = 0) { link(add_multiplier(3, compliance), node); }  // on the world

    Array<double> solve(SparseBlockLdlt& matrix, const Vector& b, bool& done) {
        matrix.begin(static_cast<uint32_t>(unknown.size()));
        for (uint32_t i = 0; i < unknown.size(); ++i) matrix.set_unknown(i, unknown[i].size, unknown[i].multiplier);
        for (const auto& [at, m] : block) matrix.link(at.first, at.second);
        matrix.analyse();
        Array<double> x = by_blocks(b);
        fill(matrix);
        done = matrix.factor();
        if (done) matrix.solve(x.data());
        return x;
    }
    void fill(SparseBlockLdlt& matrix) const {
        matrix.clear();
        for (const auto& [at, m] : block) matrix.add(matrix.place(at.first, at.second), piece(m));
    }

    Array<double> by_blocks(const Vector& v) {
        Array<double> x(6 * unknown.size(), 0.0, memory);
        for (size_t i = 0, row = 0; i < unknown.size(); ++i)
            for (int k = 0; k < unknown[i].size; ++k) x[6 * i + static_cast<size_t>(k)] = v[static_cast<long>(row++)];
        return x;
    }
    void expect_solution(const SparseBlockLdlt& matrix, const Vector& b, const Array<double>& expected) {
        Array<double> x = by_blocks(b);
        matrix.solve(x.data());
        for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], expected[i], 1e-12 * (1 + std::abs(expected[i])));
    }

    std::vector<long> offsets() const {
        std::vector<long> begin{0};
        for (const Unknown& u : unknown) begin.push_back(begin.back() + u.size);
        return begin;
    }
    Matrix dense() const {
        const std::vector<long> begin = offsets();
        Matrix a = Matrix::Zero(begin.back(), begin.back());
        for (const auto& [at, m] : block) {
            a.block(begin[at.first], begin[at.second], m.rows(), m.cols()) = m;
            a.block(begin[at.second], begin[at.first], m.cols(), m.rows()) = m.transpose();
        }
        return a;
    }
    uint32_t links() const {
        uint32_t count = 0;
        for (const auto& [at, m] : block) count += at.first != at.second;
        return count;
    }

    Memory memory{taut_hooks{}};

private:
    uint32_t add(Unknown u) {
        unknown.push_back(u);
        return static_cast<uint32_t>(unknown.size() - 1);
    }
};

// Solves with a random right-hand side and compares with LU.
void expect_like_dense(Problem& p, double tolerance) {
    const Matrix a = p.dense();
    const Vector b = p.random(static_cast<int>(a.rows()), 1);
    SparseBlockLdlt matrix(p.memory);
    bool done = false;
    const Array<double> blocks = p.solve(matrix, b, done);
    ASSERT_TRUE(done);
    Vector x(a.rows());
    const std::vector<long> begin = p.offsets();
    for (size_t i = 0; i < p.unknown.size(); ++i) {
        for (int k = 0; k < p.unknown[i].size; ++k) x[begin[i] + k] = blocks[6 * i + static_cast<size_t>(k)];
        for (int k = p.unknown[i].size; k < 6; ++k) EXPECT_EQ(blocks[6 * i + static_cast<size_t>(k)], 0);
    }
    const Vector exact = a.partialPivLu().solve(b);
    EXPECT_LE((a * x - b).norm(), tolerance * (b.norm() + a.norm() * x.norm()));
    EXPECT_LE((x - exact).norm(), 1e3 * tolerance * exact.norm());
}

int random_size(Problem& p) { return p.pick(2) ? 6 : 3; }

TEST(SparseBlockLdlt, SolvesTreesWithoutFill) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Problem p(seed);
        std::vector<uint32_t> nodes{p.add_node(random_size(p))};
        const uint32_t count = 2 + p.pick(40);
        for (uint32_t i = 1; i < count; ++i) {
            const uint32_t parent = nodes[p.pick(i)];
            nodes.push_back(p.add_node(random_size(p)));
            p.join(parent, nodes.back(), 0, p.pick(3) == 0);
        }
        if (p.pick(2)) p.hold(nodes[p.pick(count)]);
        expect_like_dense(p, 1e-10);
        SparseBlockLdlt matrix(p.memory);
        bool done = false;
        p.solve(matrix, Vector::Zero(p.dense().rows()), done);
        EXPECT_EQ(matrix.blocks(), p.links());
        if (HasFailure()) break;
    }
}

TEST(SparseBlockLdlt, SolvesForests) {
    Problem p(11);
    for (int tree = 0; tree < 5; ++tree) {
        uint32_t last = p.add_node(6);
        for (int i = 0; i < tree; ++i) {
            const uint32_t next = p.add_node(3);
            p.join(last, next, 0, false);
            last = next;
        }
    }
    expect_like_dense(p, 1e-10);
}

// Rows of a loop may be redundant, which is what their compliance is for.
TEST(SparseBlockLdlt, SolvesLoops) {
    for (uint64_t seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        Problem p(seed);
        const uint32_t count = 3 + p.pick(30);
        std::vector<uint32_t> nodes;
        for (uint32_t i = 0; i < count; ++i) nodes.push_back(p.add_node(random_size(p)));
        for (uint32_t i = 0; i < count; ++i) p.join(nodes[i], nodes[(i + 1) % count], 1e-3, p.pick(2) == 0);
        for (uint32_t chord = p.pick(4); chord > 0; --chord) {
            const uint32_t a = p.pick(count), b = p.pick(count);
            if (a != b && !p.block.count({nodes[a], nodes[b]}) && !p.block.count({nodes[b], nodes[a]}))
                p.join(nodes[a], nodes[b], 1e-3, false);
        }
        expect_like_dense(p, 1e-10);
        if (HasFailure()) break;
    }
}

TEST(SparseBlockLdlt, SolvesChainsHeldAtBothEnds) {
    for (int count : {1, 2, 3, 10, 50}) {
        Problem p(static_cast<uint64_t>(count));
        std::vector<uint32_t> nodes;
        for (int i = 0; i < count; ++i) {
            nodes.push_back(p.add_node(6));
            if (i > 0) p.join(nodes[static_cast<size_t>(i - 1)], nodes.back(), 1e-3, false);
        }
        p.hold(nodes.front(), 1e-3);
        if (count > 1) p.hold(nodes.back(), 1e-3);
        expect_like_dense(p, 1e-10);
    }
}

// A square net; a part of its joints couples their nodes.
void weave(Problem& p, int side, int size, double coupled) {
    std::vector<uint32_t> nodes;
    for (int i = 0; i < side * side; ++i) nodes.push_back(p.add_node(size));
    auto join = [&](int a, int b) {
        p.join(nodes[static_cast<size_t>(a)], nodes[static_cast<size_t>(b)], 1e-3,
               std::abs(p.random(1, 1)(0, 0)) < coupled);
    };
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const int here = i * side + k;
            if (k + 1 < side) join(here, here + 1);
            if (i + 1 < side) join(here, here + side);
        }
    p.hold(nodes[0]);
}

TEST(SparseBlockLdlt, SolvesNets) {
    for (int side : {2, 4, 9})
        for (int size : {3, 6})
            for (double coupled : {0.0, 0.02, 0.5, 1.0}) {
                SCOPED_TRACE(testing::Message() << "side " << side << ", size " << size << ", coupled " << coupled);
                Problem p(static_cast<uint64_t>(side));
                weave(p, side, size, coupled);
                expect_like_dense(p, 1e-10);
            }
}

// A rim of bodies on spokes from one hub: what fills in grows with the rim, not with its square.
TEST(SparseBlockLdlt, SolvesWheelsWithLittleFill) {
    for (int count : {10, 60, 150}) {
        SCOPED_TRACE(count);
        Problem p(static_cast<uint64_t>(count));
        const uint32_t hub = p.add_node(6);
        std::vector<uint32_t> rim;
        for (int i = 0; i < count; ++i) {
            rim.push_back(p.add_node(6));
            p.join(hub, rim.back(), 1e-3, false);
            if (i > 0) p.join(rim[static_cast<size_t>(i - 1)], rim.back(), 1e-3, false);
        }
        p.join(rim.back(), rim.front(), 1e-3, false);
        p.hold(hub);
        expect_like_dense(p, 1e-10);
        SparseBlockLdlt matrix(p.memory);
        bool done = false;
        p.solve(matrix, p.random(static_cast<int>(p.dense().rows()), 1), done);
        EXPECT_LE(matrix.blocks(), 8 * matrix.unknowns());
    }
}

#if defined(__x86_64__)
TEST(SparseBlockLdlt, Avx2HasTheBitsOfTheBaseBuild) {
    if (widest() < Width::avx2) GTEST_SKIP() << "this processor has no AVX2";
    EXPECT_STREQ(panel_kernels().name, "avx2");
    for (int size : {3, 6})
        for (double coupled : {0.0, 0.5}) {
            Problem p(8);
            weave(p, 8, size, coupled);
            SparseBlockLdlt matrix(p.memory);
            bool done = false;
            const Array<double> x = p.solve(matrix, p.random(static_cast<int>(p.dense().rows()), 1), done);
            ASSERT_TRUE(done);
            std::vector<double> solution[2];
            for (const PanelKernels* kernels : {&kPanelKernelsBase, &kPanelKernelsAvx2}) {
                std::vector<double>& y = solution[kernels == &kPanelKernelsAvx2];
                y.assign(x.begin(), x.end());
                p.fill(matrix);
                ASSERT_TRUE(matrix.factor(*kernels));
                matrix.solve(y.data(), *kernels);
            }
            EXPECT_EQ(std::memcmp(solution[0].data(), solution[1].data(), 8 * x.size()), 0);
        }
}
#endif

// The order is found once; numbers may change under it, and may come in pieces and in either triangle.
TEST(SparseBlockLdlt, FactorsAgainAfterTheNumbersChanged) {
    Problem p(21);
    const uint32_t a = p.add_node(6), b = p.add_node(3), c = p.add_node(6);
    p.join(a, b, 0, true);
    p.join(b, c, 0, false);
    SparseBlockLdlt matrix(p.memory);
    bool done = false;
    Vector rhs = p.random(static_cast<int>(p.dense().rows()), 1);
    const Array<double> once = p.solve(matrix, rhs, done);
    ASSERT_TRUE(done);

    matrix.clear();
    for (const auto& [at, m] : p.block) {
        const RowMajor mirrored = 2 * m.transpose();  // twice the matrix, by the other triangle
        for (int r = 0; r < m.cols(); r += 3)
            for (int k = 0; k < m.rows(); k += 3)
                matrix.add(matrix.place(at.second, at.first),
                           {mirrored.data() + r * m.rows() + k, 3, 3, static_cast<int>(m.rows()), r, k});
    }
    ASSERT_TRUE(matrix.factor());
    p.expect_solution(matrix, 2 * rhs, once);

    matrix.keep();
    const RowMajor heavier = RowMajor::Identity(6, 6);
    matrix.add(matrix.place(a, a), {heavier.data(), 6, 6, 6, 0, 0, 1e3});
    ASSERT_TRUE(matrix.factor());
    matrix.restore();
    ASSERT_TRUE(matrix.factor());
    p.expect_solution(matrix, 2 * rhs, once);
}

TEST(SparseBlockLdlt, RefusesPivotsOfTheWrongSign) {
    struct Case {
        const char* what;
        bool node;
        double value;
    };
    for (const Case& c : {Case{"an indefinite node", true, -5}, Case{"a node without mass", true, 0},
                          Case{"a node that is not a number", true, std::numeric_limits<double>::quiet_NaN()},
                          Case{"an infinite node", true, std::numeric_limits<double>::infinity()},
                          Case{"a multiplier that pushes back", false, 1e6}}) {
        SCOPED_TRACE(c.what);
        Problem p(31);
        const uint32_t a = p.add_node(6), b = p.add_node(6);
        p.join(a, b, 0, false);
        const uint32_t bad = c.node ? b : 2;
        const RowMajor good = p.block[{bad, bad}];
        p.block[{bad, bad}](1, 1) = c.value;
        SparseBlockLdlt matrix(p.memory);
        bool done = true;
        p.solve(matrix, Vector::Zero(p.dense().rows()), done);
        EXPECT_FALSE(done);
        p.block[{bad, bad}] = good;  // and is as good as new
        p.fill(matrix);
        EXPECT_TRUE(matrix.factor());
    }
}

// Rods along x from sheet to sheet of particles that couplings hold, over knots that have nothing else: those of a knot
// have the same rows there, and are told apart by what sheets give at their other ends, whatever comes first.
TEST(SparseBlockLdlt, HoldsRodsInALineByWhatTheirEndsGive) {
    constexpr uint32_t kSide = 4;
    for (uint64_t seed = 0; seed < 50; ++seed) {
        Problem p(seed);
        std::vector<uint32_t> sheet[2];
        for (auto& nodes : sheet)
            for (uint32_t i = 0; i < kSide * kSide; ++i) {
                nodes.push_back(p.add_node(3));
                for (const uint32_t step : {1u, kSide})
                    if (i >= step && (step > 1 || i % kSide > 0))
                        p.block[{nodes[i], nodes[i - step]}] = 0.001 * p.random(3, 3);
            }
        const auto rod = [&](uint32_t a, uint32_t b) {
            const uint32_t m = p.add_multiplier(3, 0);
            RowMajor row = RowMajor::Zero(3, 3);
            row(0, 0) = 1;
            p.block[{m, m}] = RowMajor(Vector{{0, -1, -1}}.asDiagonal());
            p.block[{m, a}] = -row;
            p.block[{m, b}] = row;
        };
        for (uint32_t chain = 0; chain < 1 + p.pick(3); ++chain) {
            uint32_t last = sheet[0][chain * kSide + p.pick(kSide)];
            for (uint32_t knots = 1 + p.pick(4); knots > 0; --knots) {
                const uint32_t knot = p.add_node(3);
                rod(last, knot);
                last = knot;
            }
            rod(last, sheet[p.pick(2)][chain * kSide + p.pick(kSide)]);
        }
        const Matrix a = p.dense();
        if (Eigen::FullPivLU<Matrix>(a).rank() < a.rows()) continue;  // a rod from a vertex to itself
        const Vector b = p.random(static_cast<int>(a.rows()), 1);
        SparseBlockLdlt matrix(p.memory);
        matrix.begin(static_cast<uint32_t>(p.unknown.size()));
        std::vector<Unknown> unknown;
        std::vector<uint64_t> links;
        for (uint32_t i = 0; i < p.unknown.size(); ++i) {
            unknown.push_back({3, p.unknown[i].multiplier, 1});
            matrix.set_unknown(i, 3, p.unknown[i].multiplier, 1);
        }
        for (const auto& [at, m] : p.block) {
            if (at.first == at.second) continue;
            matrix.link(at.first, at.second);
            links.push_back(static_cast<uint64_t>(std::min(at.first, at.second)) << 32 | std::max(at.first, at.second));
        }
        matrix.analyse(HeldOrder(p.memory, unknown, links, {}).order);
        Array<double> x = p.by_blocks(b);
        p.fill(matrix);
        ASSERT_TRUE(matrix.factor()) << seed;
        matrix.solve(x.data());
        const Vector exact = a.fullPivLu().solve(b);
        for (long i = 0; i < exact.size(); ++i)
            EXPECT_NEAR(x[static_cast<size_t>(6 * (i / 3) + i % 3)], exact[i], 1e-8 * exact.norm()) << seed;
    }
}

// Two rows for one freedom, with no compliance to share them out.
TEST(SparseBlockLdlt, RefusesRedundantRows) {
    Problem p(41);
    const uint32_t particle = p.add_node(3);
    p.hold(particle);
    p.hold(particle);
    SparseBlockLdlt matrix(p.memory);
    bool done = true;
    const Array<double> x = p.solve(matrix, Vector::Ones(9), done);
    if (done) {  // rounding may leave a pivot of either sign: then nothing promises more than finite numbers
        for (double value : x) EXPECT_TRUE(std::isfinite(value));
    }
}

// Chains to factor and solve, or to analyse as well.
struct TimedChain {
    explicit TimedChain(uint32_t links) : count(links), problem(links), matrix(problem.memory) {
        uint32_t last = problem.add_node(6);
        for (uint32_t i = 1; i < count; ++i) {
            const uint32_t next = problem.add_node(6);
            problem.join(last, next, 0, false);
            last = next;
        }
        long rows = 0;
        for (const auto& u : problem.unknown) rows += u.size;
        bool done = false;
        x = problem.solve(matrix, Vector::Ones(rows), done);
        EXPECT_TRUE(done);
    }
    // Of processor time for one pass over the chain; the least so far is kept.
    void measure(bool symbolic) {
        const uint32_t repeats = std::max(1u, 3200 / count);
        const std::clock_t start = std::clock();
        for (uint32_t i = 0; i < repeats; ++i) {
            if (symbolic) {
                matrix.analyse();
            } else {
                problem.fill(matrix);
                matrix.factor();
                matrix.solve(x.data());
            }
        }
        seconds = std::min(seconds, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / repeats);
    }

    uint32_t count;
    Problem problem;
    SparseBlockLdlt matrix;
    Array<double> x{problem.memory};
    double seconds = 1e300;
};

// 32 times the links take 32 times the time; three times that leaves room for caches. Neighbours on the machine slow
// single passes down: each length has its quietest one, taken in turn until they agree, from 5 up to 100.
TEST(SparseBlockLdlt, TimeGrowsLinearlyAlongChains) {
    for (bool symbolic : {false, true}) {
        TimedChain small(100), medium(800), large(3200);
        const auto linear = [&] {
            return large.seconds <= 3 * 32 * small.seconds && large.seconds <= 3 * 4 * medium.seconds;
        };
        for (int pass = 0; pass < 100 && (pass < 5 || !linear()); ++pass)
            for (TimedChain* chain : {&small, &medium, &large}) chain->measure(symbolic);
        RecordProperty(symbolic ? "analysis_us_per_link" : "solve_us_per_link",
                       std::to_string(1e6 * large.seconds / 3200));
        EXPECT_TRUE(linear()) << (symbolic ? "analysis: " : "solve: ") << small.seconds << ", " << medium.seconds
                              << " and " << large.seconds << " s";
    }
}

}  // namespace
}  // namespace taut::test
