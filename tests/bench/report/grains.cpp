// Frâncu 2016, figures 8.8 and 8.10: particles in a box by velocity time stepping and by Sequential Positions.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "csv.h"
#include "engine.h"
#include "methods.h"
#include "scenes/catalogue.h"
#include "thesis.h"
#include "vector.h"

namespace bench {

namespace {

constexpr double kHalf = 0.5;  // gamma of velocity time stepping
constexpr Method kVelocity{
    "gauss_seidel", TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, 0, TAUT_MOMENTUM_NESTEROV, TAUT_STEPPING_VELOCITY, kHalf, 0};
constexpr Method kImproved{
    "improved_jacobi", TAUT_SOLVER_ACCELERATED_JACOBI, 0, TAUT_MOMENTUM_POWER, TAUT_STEPPING_VELOCITY, kHalf, 0};
constexpr Method kSequential{"sequential_positions",
                             TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL,
                             0,
                             TAUT_MOMENTUM_NESTEROV,
                             TAUT_STEPPING_PROJECTION,
                             1,
                             0.1};

// A box of grains on a floor at y = 0.
class GrainRun {
public:
    GrainRun(int count, const Method& method, uint32_t iterations, float friction)
        : scene_(scenes::make_scene("grains_box" + std::to_string(count))) {
        for (scenes::Body& body : scene_.bodies) body.friction = friction;
        as_in_thesis(scene_, method, iterations, kLong);
        engine_ = make_taut_engine(scene_);
        const scenes::Body& first = scene_.bodies[static_cast<size_t>(scene_.roles.pile.front())];
        radius_ = scene_.shapes[static_cast<size_t>(first.shape)].radius;
    }
    void step() { engine_->step(); }
    // Of all overlaps [m].
    double overlap() {
        double sum = 0;
        for_contacts([&](double gap, double) { sum += std::max(0.0, -gap); });
        return sum;
    }
    // Mean of |J v| over contacts that touch [m/s].
    double rate() {
        double sum = 0;
        size_t count = 0;
        for_contacts([&](double, double rate) { sum += std::fabs(rate), ++count; });
        return sum / static_cast<double>(std::max<size_t>(1, count));
    }

private:
    // Of grains within a hundredth of their radius of each other and of the floor: gap [m], its rate [m/s].
    template <class Act>
    void for_contacts(Act&& act) {
        const double near = 0.01 * radius_;
        motion_.clear();
        for (const int body : scene_.roles.pile) motion_.push_back(engine_->motion(static_cast<size_t>(body)));
        std::sort(motion_.begin(), motion_.end(),
                  [](const Motion& a, const Motion& b) { return a.position.x < b.position.x; });
        for (size_t i = 0; i < motion_.size(); ++i) {
            const Vec at = of(motion_[i].position), v = of(motion_[i].linear_velocity);
            if (at.y - radius_ < near) act(at.y - radius_, v.y);
            for (size_t k = i + 1; k < motion_.size(); ++k) {
                const Vec apart = of(motion_[k].position) - at;
                if (apart.x > 2 * radius_ + near) break;
                const double distance = length(apart);
                if (distance > 2 * radius_ + near) continue;
                act(distance - 2 * radius_, dot(apart, of(motion_[k].linear_velocity) - v) / distance);
            }
        }
    }

    scenes::Scene scene_;
    std::unique_ptr<Engine> engine_;
    double radius_ = 0;
    std::vector<Motion> motion_;
};

}  // namespace

void grains_error(const fs::path& folder) {
    constexpr uint32_t kIterations = 15;
    constexpr int kFrames = 190;
    Csv csv(folder / "grains_error.csv", "method,frame,overlap_m");
    for (const Method& method : {kVelocity, kImproved, kSequential}) {
        GrainRun run(3000, method, kIterations, 0);
        double overlap = 0, most = 0;
        for (int frame = 1; frame <= kFrames; ++frame) {
            run.step();
            overlap = run.overlap();
            most = std::max(most, overlap);
            csv.row(method.name, frame, overlap);
        }
        say("3000 grains without friction, %s: overlaps of %.3g m at most, %.3g m at the end\n", method.name, most,
            overlap);
    }
}

void grains_velocity(const fs::path& folder) {
    constexpr int kFrames = 100;
    Csv csv(folder / "grains_velocity.csv", "method,iterations,rate_m_s");
    for (const Method& method : {kVelocity, kImproved, kSequential})
        for (const uint32_t iterations : {5u, 10u, 15u, 20u, 30u, 40u, 60u, 90u}) {
            GrainRun run(1000, method, iterations, 0.5f);
            double rate = 0;
            for (int frame = 0; frame < kFrames; ++frame) {
                run.step();
                rate += run.rate() / kFrames;
            }
            csv.row(method.name, iterations, rate);
            say("1000 grains, %s, %u iterations: %.3g m/s along contacts\n", method.name, iterations, rate);
        }
}

}  // namespace bench
