// Minimisation and its line search on functions whose minima are known.
#include "solvers/minimise.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "solvers/line_search.h"

namespace taut::test {
namespace {

// A function with its derivatives; keeps E where it was linearised, which is where each step begins.
class Analytic final : public Objective {
public:
    using Vector = std::vector<double>;
    std::function<double(const Vector&, Vector&)> value;
    std::function<Vector(const Vector&)> hessian;  // row-major

    uint32_t size() const override { return count; }
    double evaluate(std::span<double> x, std::span<double> gradient) override {
        Vector g(count);
        const double e = last = value(Vector(x.begin(), x.end()), g);
        if (!gradient.empty()) std::ranges::copy(g, gradient.begin());
        return e;
    }
    void linearise(std::span<double> x, Hessian which) override {
        Vector g(count);
        if (which == Hessian::exact) at.push_back(value(Vector(x.begin(), x.end()), g));
        matrix = hessian(Vector(x.begin(), x.end()));
        if (which == Hessian::exact) return;
        const Eigen::Map<Eigen::MatrixXd> h(matrix.data(), count, count);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(h);
        const Eigen::VectorXd clipped = eigen.eigenvalues().cwiseMax(0);
        Eigen::Map<Eigen::MatrixXd>(matrix.data(), count, count) =
            eigen.eigenvectors() * clipped.asDiagonal() * eigen.eigenvectors().transpose();
    }
    void multiply(std::span<const double> d, std::span<double> out) override {
        for (uint32_t i = 0; i < count; ++i) {
            out[i] = 0;
            for (uint32_t k = 0; k < count; ++k) out[i] += matrix[i * count + k] * d[k];
        }
    }
    double direct_cost() const override { return direct_after; }
    bool solve(std::span<double> x) override {  // by elimination
        Vector a = matrix;
        for (uint32_t k = 0; k < count; ++k) {
            if (!(a[k * count + k] > 0)) return false;
            for (uint32_t i = k + 1; i < count; ++i) {
                const double ratio = a[i * count + k] / a[k * count + k];
                for (uint32_t j = k; j < count; ++j) a[i * count + j] -= ratio * a[k * count + j];
                x[i] -= ratio * x[k];
            }
        }
        for (uint32_t k = count; k-- > 0; x[k] /= a[k * count + k])
            for (uint32_t j = k + 1; j < count; ++j) x[k] -= a[k * count + j] * x[j];
        return true;
    }
    double size_of_terms() const override { return 1 + std::abs(last); }
    bool never_rose() const {
        return std::ranges::is_sorted(at, [](double a, double b) { return a > b + 1e-12 * std::abs(b); });
    }

    uint32_t count = 1;
    double last = 0;
    double direct_after = std::numeric_limits<double>::infinity();  // products
    Vector matrix, at;
};

Analytic chained_rosenbrock(uint32_t count) {
    Analytic f;
    f.count = count;
    f.value = [count](const std::vector<double>& x, std::vector<double>& g) {
        double e = 0;
        std::ranges::fill(g, 0.0);
        for (uint32_t i = 0; i + 1 < count; ++i) {
            const double a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
            e += 100 * a * a + b * b;
            g[i] += -400 * a * x[i] - 2 * b;
            g[i + 1] += 200 * a;
        }
        return e;
    };
    f.hessian = [count](const std::vector<double>& x) {
        std::vector<double> h(count * count);
        for (uint32_t i = 0; i + 1 < count; ++i) {
            h[i * count + i] += 1200 * x[i] * x[i] - 400 * x[i + 1] + 2;
            h[i * count + i + 1] -= 400 * x[i];
            h[(i + 1) * count + i] -= 400 * x[i];
            h[(i + 1) * count + i + 1] += 200;
        }
        return h;
    };
    return f;
}

Analytic of_one(std::function<double(double)> value, std::function<double(double)> slope,
                std::function<double(double)> second) {
    Analytic f;
    f.value = [=](const std::vector<double>& x, std::vector<double>& g) {
        g[0] = slope(x[0]);
        return value(x[0]);
    };
    f.hessian = [=](const std::vector<double>& x) { return std::vector<double>{second(x[0])}; };
    return f;
}

MinimiseReport run(Objective& of, std::vector<double>& x, const MinimiseSettings& settings = {}) {
    Memory memory{{}};
    MinimiseScratch scratch(memory);
    return minimise(of, x, settings, scratch);
}

TEST(Minimise, FollowsRosenbrocksValley) {
    Analytic f = chained_rosenbrock(2);
    std::vector<double> x{-1.2, 1};
    const MinimiseReport report = run(f, x);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(x[0], 1, 1e-8);
    EXPECT_NEAR(x[1], 1, 1e-8);
    EXPECT_LT(report.steps, 100u);
    EXPECT_TRUE(f.never_rose());
}

// From random starts, most of which have an indefinite Hessian: to a point without slope, and E never rises.
TEST(Minimise, EndsInAMinimumFromAnywhere) {
    std::mt19937_64 random(7);
    uint32_t indefinite = 0;
    for (int start = 0; start < 100; ++start) {
        Analytic f = chained_rosenbrock(10);
        std::vector<double> x(10);
        for (double& each : x) each = std::ldexp(static_cast<double>(random() >> 11), -53) * 8 - 4;
        const MinimiseReport report = run(f, x);
        EXPECT_TRUE(report.converged) << start;
        EXPECT_LT(report.gradient, 1e-8);
        EXPECT_TRUE(f.never_rose());
        indefinite += report.indefinite > 0;
    }
    EXPECT_GT(indefinite, 20u);
}

TEST(Minimise, SolvesAQuadraticByOneExactStep) {
    Analytic f;
    f.count = 3;
    const std::vector<double> h{4, 1, 0, 1, 3, -1, 0, -1, 5};
    f.value = [&](const std::vector<double>& x, std::vector<double>& g) {
        double e = 0;
        for (uint32_t i = 0; i < 3; ++i) {
            g[i] = -1.0 - i;
            for (uint32_t k = 0; k < 3; ++k) g[i] += h[3 * i + k] * x[k];
            e += 0.5 * x[i] * (g[i] - 1.0 - i);
        }
        return e;
    };
    f.hessian = [&](const std::vector<double>&) { return h; };
    std::vector<double> x(3);
    MinimiseSettings settings;
    settings.sigma = 0;
    const MinimiseReport report = run(f, x, settings);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.steps, 1u);
    EXPECT_EQ(report.evaluations, 2u);  // the whole step is tried first, and taken
    EXPECT_LE(report.iterations, 4u);
}

// From where conjugate gradients cost as much on: the same minimum with fewer of their iterations.
TEST(Minimise, SolvesDirectlyWhereThatIsCheaper) {
    uint32_t iterations[2] = {}, direct = 0, indefinite = 0;
    for (const bool solves : {false, true}) {
        Analytic f = chained_rosenbrock(40);
        if (solves) f.direct_after = 5;
        std::vector<double> x(40, -1.5);
        const MinimiseReport report = run(f, x);
        EXPECT_TRUE(report.converged);
        EXPECT_TRUE(f.never_rose());
        iterations[solves] = report.iterations;
        direct += report.direct;
        if (solves) indefinite = report.indefinite;
        for (const double each : x) EXPECT_NEAR(each, 1, 1e-8) << solves;
    }
    EXPECT_GT(direct, 0u);
    EXPECT_GT(indefinite, 0u);
    EXPECT_LT(iterations[1], iterations[0]);
}

// Two wells: at the ridge between them the curvature is negative, and the positive matrix gives the way down.
TEST(Minimise, LeavesARidge) {
    for (const double start : {1e-6, -1e-6, 0.3, -0.5}) {
        Analytic f = of_one([](double x) { return x * x * x * x - 2 * x * x; },
                            [](double x) { return 4 * x * x * x - 4 * x; }, [](double x) { return 12 * x * x - 4; });
        std::vector<double> x{start};
        const MinimiseReport report = run(f, x);
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(x[0], start > 0 ? 1 : -1, 1e-8);
        EXPECT_GT(report.indefinite, 0u);
    }
}

// Beyond the wall E is not a number, or infinite, or its slope is not: none of it gets into x.
TEST(Minimise, TakesWhatIsNotFiniteForAWall) {
    const double kNan = std::numeric_limits<double>::quiet_NaN(), kFar = std::numeric_limits<double>::infinity();
    for (const auto& [beyond, slope] : {std::pair(kNan, kNan), {kFar, 0.0}, {-kFar, 0.0}, {0.0, kNan}}) {
        Analytic f = of_one([=](double x) { return x < 1 ? -10 * x - std::log(1 - x) : beyond; },
                            [=](double x) { return x < 1 ? -10 + 1 / (1 - x) : slope; },
                            [](double x) { return 1 / ((1 - x) * (1 - x)); });
        std::vector<double> x{-3};  // from where Newton's step leads to 142
        const MinimiseReport report = run(f, x);
        EXPECT_TRUE(report.converged);
        EXPECT_NEAR(x[0], 0.9, 1e-9);
        EXPECT_TRUE(f.never_rose());
    }
}

// sqrt(1 + x^2): Newton's steps grow from everywhere beyond 1.
TEST(Minimise, WithoutTheSearchNewtonsStepsRunAway) {
    for (const bool search : {true, false}) {
        Analytic f =
            of_one([](double x) { return std::sqrt(1 + x * x); }, [](double x) { return x / std::sqrt(1 + x * x); },
                   [](double x) { return 1 / ((1 + x * x) * std::sqrt(1 + x * x)); });
        std::vector<double> x{2};
        MinimiseSettings settings;
        settings.line_search = search;
        settings.most_steps = 50;
        const MinimiseReport report = run(f, x, settings);
        EXPECT_EQ(report.converged, search);
        EXPECT_EQ(std::abs(x[0]) < 1e-8, search);
    }
}

TEST(Minimise, KeepsItsStartWhereThatHasNoSlope) {
    Analytic f = chained_rosenbrock(4);
    std::vector<double> x(4, 1.0);
    const MinimiseReport report = run(f, x);
    EXPECT_TRUE(report.converged);
    EXPECT_EQ(report.steps, 0u);
    EXPECT_EQ(report.evaluations, 1u);
}

// ---------------------------------------------------------------- line search

class Line final : public LineFunction {
public:
    std::function<double(double)> value, slope;
    std::vector<double> parts;

    LinePoint at(double part) override {
        parts.push_back(part);
        return {part, value(part), slope(part)};
    }
    LinePoint search(const LineSettings& settings) {
        const LinePoint begin{0, value(0), slope(0)};
        uint32_t trials = 0;
        const LinePoint found = search_line(*this, begin, settings, trials);
        EXPECT_EQ(trials, parts.size());
        EXPECT_EQ(parts.front(), 1);
        EXPECT_LE(found.value, begin.value + settings.decrease * found.part * begin.slope);
        EXPECT_LE(std::abs(found.slope), settings.curvature * std::abs(begin.slope));
        return found;
    }
};

TEST(LineSearch, FindsStepsThatAreStronglyWolfe) {
    for (const double least : {1e-6, 1e-3, 0.1, 0.9, 1.0, 1.1, 3.0, 50.0, 700.0})
        for (const double curvature : {0.9, 0.1, 1e-3}) {
            Line line;  // a valley that is no parabola
            line.value = [=](double p) { return std::cosh(2 * (p - least) / (1 + least)) + 0.1 * (p - least); };
            line.slope = [=](double p) { return 2 / (1 + least) * std::sinh(2 * (p - least) / (1 + least)) + 0.1; };
            if (line.slope(0) >= 0) continue;
            LineSettings settings;
            settings.curvature = curvature;
            settings.longest = 1e3;
            line.search(settings);
        }
}

TEST(LineSearch, StopsBeforeAWall) {
    for (const double wall : {0.5, 1e-2, 1e-6}) {
        Line line;
        line.value = [=](double p) { return p < wall ? -p / wall - std::log(1 - p / wall) * 0.1 : std::nan(""); };
        line.slope = [=](double p) { return p < wall ? -1 / wall + 0.1 / (wall - p) : std::nan(""); };
        EXPECT_LT(line.search({}).part, wall);
    }
}

TEST(LineSearch, TakesTheWholeStepWhereItWillDo) {
    Line line;
    line.value = [](double p) { return (p - 1.2) * (p - 1.2); };
    line.slope = [](double p) { return 2 * (p - 1.2); };
    EXPECT_EQ(line.search({}).part, 1);
    EXPECT_EQ(line.parts.size(), 1u);
}

// No value below the first one: it says so, and ends.
TEST(LineSearch, FindsNothingUphill) {
    Line line;
    line.value = [](double p) { return p > 0 ? std::nan("") : 0.0; };
    line.slope = [](double) { return -1.0; };
    uint32_t trials = 0;
    EXPECT_EQ(search_line(line, {0, 0, -1}, {}, trials).part, 0);
    EXPECT_EQ(trials, LineSettings{}.most_trials);
}

}  // namespace
}  // namespace taut::test
