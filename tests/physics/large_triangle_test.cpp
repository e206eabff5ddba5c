// Thin bodies on triangles from a centimetre to kilometres: what is above stays above, what lies has contacts.
#include <algorithm>
#include <optional>
#include <ostream>

#include "physics/surface_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

enum class Body { plate, rod, sliver, shard };
enum class Ground { mesh, field };

struct Case {
    Body body;
    Ground ground;
    double cell;  // side of a square of two triangles [m]
    double rate;  // [Hz]
    uint32_t substeps;

    friend std::ostream& operator<<(std::ostream& out, const Case& c) {
        constexpr const char* kBodies[] = {"plate", "rod", "sliver", "shard"};
        return out << kBodies[static_cast<int>(c.body)] << " on " << (c.ground == Ground::mesh ? "mesh" : "field")
                   << " of " << c.cell << " m, " << c.rate << " Hz, " << c.substeps << " substeps";
    }
};

// Half sizes; of a shard, a flat hull of six corners, those of its box.
Vec half_of(Body body) {
    constexpr double kHalves[][3] = {{0.45, 0.015, 0.6}, {0.02, 0.02, 0.9}, {0.3, 0.006, 0.05}, {0.5, 0.02, 0.4}};
    const auto& half = kHalves[static_cast<int>(body)];
    return {half[0], half[1], half[2]};
}

taut_shape shape_of(const World& world, Body body) {
    const Vec half = half_of(body);
    if (body != Body::shard) return world.box(half);
    std::vector<taut_vec3> points;
    for (const double y : {-half.y, half.y})
        for (int i = 0; i < 3; ++i)
            points.push_back(Vec(half.x * std::cos(2.1 * i), y, half.z * std::sin(2.1 * i)).narrow());
    return hull(world, points);
}

// As few cells as hold a square of 3 m about the origin, which lies off the middle of a cell.
void add_ground(const World& world, Ground ground, double cell) {
    const int cells = std::max(1, static_cast<int>(std::ceil(3 / cell)));
    const double corner = -0.47 * cells * cell;
    BodyPlan plan{.kind = TAUT_BODY_STATIC, .position = {corner, 0, corner}};
    plan.shape = ground == Ground::mesh
                     ? mesh(world, grid(cells * cell, cells * cell, cell))
                     : height_field(world, static_cast<uint32_t>(cells + 1), static_cast<uint32_t>(cells + 1), cell,
                                    [](double, double) { return 0; });
    world.add(plan);
}

class OnTriangles : public testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        const Case& c = GetParam();
        world_.emplace([&](taut_world_def& def) {
            def.time_step = static_cast<float>(1 / c.rate);
            def.substeps = c.substeps;
        });
        add_ground(*world_, c.ground, c.cell);
        shape_ = shape_of(*world_, c.body);
    }
    taut_body drop(std::mt19937& random, double height, const Quat& turn, const Vec& spin) {
        const double within = GetParam().cell < 4 ? 0.3 : 0.02 * GetParam().cell;
        const Vec at(between(random, -within, within), height, between(random, -within, within));
        return world_->add({.shape = shape_, .position = at, .rotation = turn, .spin = spin});
    }
    int frames(double seconds) const { return static_cast<int>(seconds * GetParam().rate); }

    std::optional<World> world_;
    taut_shape shape_{};
};

TEST_P(OnTriangles, WhatLiesIsNeverWithoutAContact) {
    std::mt19937 random(7);
    for (int i = 0; i < 4; ++i) {
        const Quat turn = Quat::turn({0, 1, 0}, between(random, 0, 6)) *
                          Quat::turn(random_direction(random), between(random, 0.001, 0.012));
        const taut_body body = drop(random, half_of(GetParam().body).y + 0.004, turn, {});
        world_->step(frames(0.2));
        for (int frame = 0; frame < frames(0.4); ++frame) {
            world_->step();
            ASSERT_FALSE(world_->contacts().empty()) << i << " frame " << frame;
        }
        // As on a plane: of what a substep lets it fall.
        const double substep = 1 / (GetParam().rate * GetParam().substeps), give = 1.2 * kG * substep * substep + 1e-3;
        EXPECT_NEAR(position(body).y, half_of(GetParam().body).y, give) << i;
        ok(taut_body_remove(body));
    }
}

TEST_P(OnTriangles, WhatFallsStaysAbove) {
    std::mt19937 random(11);
    for (int i = 0; i < 5; ++i) {
        const taut_body body = drop(random, 1.5, Quat::turn(random_direction(random), between(random, 0, 6)),
                                    between(random, 0, 6) * random_direction(random));
        for (int frame = 0; frame < frames(1.1); ++frame) world_->step();
        EXPECT_GT(position(body).y, 0) << i;
        ok(taut_body_remove(body));
    }
}

std::vector<Case> cases() {
    std::vector<Case> out;
    constexpr double kRates[] = {60, 30, 120};
    constexpr uint32_t kSubsteps[] = {4, 1, 8, 2};
    size_t i = 0;
    for (const Body body : {Body::plate, Body::rod, Body::sliver, Body::shard})
        for (const double cell : {0.05, 1.7, 70.0, 350.0, 1900.0}) {
            out.push_back({body, i % 2 ? Ground::field : Ground::mesh, cell, kRates[i % 3], kSubsteps[i % 4]});
            ++i;
        }
    return out;
}

INSTANTIATE_TEST_SUITE_P(Flat, OnTriangles, testing::ValuesIn(cases()));

}  // namespace
