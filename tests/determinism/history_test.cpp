// What a world went through before: what was created and destroyed in it, in any order, does not show in what is built
// afterwards.
#include <cstring>
#include <random>

#include "determinism/step_trace.h"
#include "scenes/running_scene.h"

namespace {

using namespace lab;

// Bodies, shapes, joints and cables that come and go in random order. Leaves nothing, or some static bodies far away.
class History {
public:
    History(uint32_t seed, int left_over) : random_(seed), left_over_(left_over) {}

    void operator()(taut_world world) {
        world_ = world;
        for (int i = 0; i < 400; ++i) {
            if (random_() % 3 != 0) add();
            if (random_() % 3 == 0) remove_one();
            if (i % 50 == 0) ok(taut_world_step(world));
        }
        while (!bodies_.empty() || !cables_.empty()) remove_one();
        std::shuffle(shapes_.begin(), shapes_.end(), random_);
        for (size_t i = static_cast<size_t>(left_over_); i < shapes_.size(); ++i) ok(taut_shape_remove(shapes_[i]));
        for (int i = 0; i < left_over_; ++i) add_body(TAUT_BODY_STATIC, shapes_[static_cast<size_t>(i)], -1e3 - 10 * i);
        // Steps that still know what is gone, and forget it.
        for (int i = 0; i < 2; ++i) ok(taut_world_step(world));
    }

private:
    taut_body add_body(taut_body_kind kind, taut_shape shape, double x) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.kind = kind;
        def.shape = shape;
        def.position = {x, 20.0 + 0.01 * static_cast<double>(random_() % 500), 0};
        taut_body body{};
        ok(taut_world_add_body(world_, &def, &body));
        return body;
    }
    void add() {
        taut_sphere_def sphere;
        taut_sphere_def_init(&sphere);
        ok(taut_world_add_sphere(world_, &sphere, &shapes_.emplace_back()));
        bodies_.push_back(add_body(TAUT_BODY_DYNAMIC, shapes_.back(), static_cast<double>(random_() % 20)));
        if (bodies_.size() > 1 && random_() % 2) {
            taut_ball_joint_def joint;
            taut_ball_joint_def_init(&joint);
            joint.base.body_a = bodies_[random_() % (bodies_.size() - 1)];
            joint.base.body_b = bodies_.back();
            taut_joint made{};
            ok(taut_world_add_ball_joint(world_, &joint, &made));
        }
        if (random_() % 8 == 0) add_cable();
    }
    void add_cable() {
        taut_cable_def def;
        taut_cable_def_init(&def);
        const taut_pos points[] = {{-20, 5, 0}, {-15, 5, 0}};
        def.kind = random_() % 2 ? TAUT_CABLE_LINKS : TAUT_CABLE_PARTICLES;
        def.points = points;
        def.point_count = 2;
        def.segment_count = 10;
        ok(taut_world_add_cable(world_, &def, &cables_.emplace_back()));
    }
    template <class Handle>
    Handle take(std::vector<Handle>& handles) {
        std::swap(handles[random_() % handles.size()], handles.back());
        const Handle handle = handles.back();
        handles.pop_back();
        return handle;
    }
    void remove_one() {
        if (!cables_.empty() && (bodies_.empty() || random_() % 8 == 0)) {
            ok(taut_cable_remove(take(cables_)));
        } else if (!bodies_.empty()) {
            ok(taut_body_remove(take(bodies_)));
        }
    }

    taut_world world_{};
    std::mt19937 random_;
    int left_over_;
    std::vector<taut_shape> shapes_;
    std::vector<taut_body> bodies_;
    std::vector<taut_cable> cables_;
};

uint64_t hash_of(taut_world world) {
    uint64_t hash = 0;
    ok(taut_world_get_state_hash(world, &hash));
    return hash;
}

class AfterAnyHistory : public testing::TestWithParam<const char*> {
protected:
    static constexpr int kSteps = 60;
    const scenes::Scene scene_ = scenes::make_scene(GetParam());
};

TEST_P(AfterAnyHistory, AnEmptiedWorldIsAsNew) {
    for (uint32_t seed : {1u, 2u, 3u}) {
        scenes::TautWorld fresh(scene_), used(scene_, History(seed, 0));
        for (int step = 0; step < kSteps; ++step) {
            fresh.step();
            used.step();
            ASSERT_EQ(hash_of(used.world), hash_of(fresh.world))
                << "seed " << seed << ", step " << step << ": "
                << determinism::first_difference(used.world, fresh.world);
        }
    }
}

// Other slots, hence another hash; every pose and velocity is the same bit by bit.
TEST_P(AfterAnyHistory, WhatIsFarAwayChangesNothing) {
    for (uint32_t seed : {4u, 5u, 6u}) {
        scenes::TautWorld fresh(scene_), used(scene_, History(seed, 7));
        for (int step = 0; step < kSteps; ++step) {
            fresh.step();
            used.step();
        }
        EXPECT_NE(fresh.bodies[0].bits, used.bodies[0].bits);
        for (size_t i = 0; i < fresh.bodies.size(); ++i) {
            const BodyState one = state(fresh.bodies[i]), other = state(used.bodies[i]);
            ASSERT_EQ(std::memcmp(&one, &other, sizeof one), 0) << "seed " << seed << ", body " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, AfterAnyHistory,
                         testing::Values("pyramid10", "heavy_on_light_r100", "wrecking_ball", "shapes50", "ragdolls20"),
                         [](const auto& tested) -> std::string { return tested.param; });

}  // namespace
