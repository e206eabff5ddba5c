// A restored world goes on as it did after the saving, on any number of threads. More frames: soak/snapshot_test.cpp.
#include <random>

#include "scenes/restored_scene.h"

namespace {

using namespace lab;

struct Case {
    const char* scene;
    uint32_t threads;
    bool sleeping = false;
    int first = 100;     // frames before a saving, at most
    bool swept = false;  // of cloths and solids
};

void PrintTo(const Case& tested, std::ostream* out) {
    *out << tested.scene << "_on_" << tested.threads << (tested.sleeping ? "_sleeping" : "")
         << (tested.swept ? "_swept" : "");
}

class Restored : public testing::TestWithParam<Case> {};

TEST_P(Restored, GoesOnAsBefore) {
    const Case& tested = GetParam();
    scenes::Scene plan = scenes::make_scene(tested.scene, {0, {}, tested.swept});
    plan.world.threads = tested.threads;
    plan.world.sleeping = tested.sleeping;
    RestoredScene run(std::move(plan));
    std::mt19937 random(tested.threads);
    for (const bool disturbed : {false, true}) {
        for (auto frames = 10 + random() % static_cast<uint32_t>(tested.first); frames > 0; --frames) run.step();
        run.expect_to_go_on_as_before(disturbed);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Restored,
                         testing::Values(Case{"pyramid10", 1}, Case{"pyramid10", 5, true}, Case{"wrecking_ball", 2},
                                         Case{"crane", 1}, Case{"cable_drum", 2}, Case{"ragdolls6", 2, true},
                                         Case{"ragdoll_liana", 1}, Case{"ferris_wheel10", 2}, Case{"tensegrity", 1},
                                         Case{"shapes50", 5}, Case{"terrain", 2, true}, Case{"bridge_breaking", 1},
                                         Case{"hinges50", 1}, Case{"heavy_on_light_r100", 1, true},
                                         Case{"stack20", 2, true, 300}, Case{"cloth_hang12", 2},
                                         Case{"solids2_e1e5", 1, true}, Case{"cloth_hang20", 2, false, 100, true},
                                         Case{"solids2_e1e5", 2, true, 100, true}, Case{"knee", 1},
                                         Case{"grains_box300", 2}, Case{"meshless1_e1e5", 1, true},
                                         Case{"quads", 2, false, 30}, Case{"plastic_bar7", 2}, Case{"tearing_flag", 1}),
                         testing::PrintToStringParamName());

// What a host's calls leave to later steps: forces, paths of kinematic bodies, time left over; and sensors, continuous
// collision, one-way colliders.
class Playground {
public:
    Playground() {
        taut_world_def def;
        taut_world_def_init(&def);
        ok(taut_world_create(&def, &world));
        taut_box_def box;
        taut_box_def_init(&box);
        ok(taut_world_add_box(world, &box, &shape_));
        add(TAUT_BODY_STATIC, 0, -0.5, 20);
        lift_ = add(TAUT_BODY_KINEMATIC, 3, 0.5);
        for (int i = 0; i < 6; ++i) bodies_.push_back(add(TAUT_BODY_DYNAMIC, -3 + 1.3 * i, 1.6 + 0.3 * i));
        taut_collider_def sensor;
        taut_collider_def_init(&sensor);
        sensor.shape = shape_;
        sensor.flags = TAUT_COLLIDER_SENSOR;
        sensor.position = {0, 1, 0};
        taut_collider made{};
        ok(taut_body_add_collider(bodies_[0], &sensor, &made));
    }
    ~Playground() { taut_world_destroy(world); }

    // A frame of the host's that is no step: 1/144 s.
    void play(int frame) {
        if (frame % 40 == 7) ok(taut_body_set_velocity(bodies_[static_cast<size_t>(frame / 40 % 6)], {0, 3, 150}, {}));
        ok(taut_body_apply_force(bodies_[static_cast<size_t>(frame % 6)], {0, 20, 0}, {0, 0, 3}));
        const taut_pose at = {{3 - 0.01 * frame, 0.5 + 0.004 * frame, 0}, {0, 0, 0, 1}, {0, 0}};
        ok(taut_body_move_kinematic(lift_, &at));
        ok(taut_world_advance(world, 1.0 / 144, nullptr));
    }
    // Hash and what events told of who is in the sensor.
    std::pair<uint64_t, uint32_t> told() const {
        uint64_t hash = 0;
        taut_events events;
        ok(taut_world_get_state_hash(world, &hash));
        ok(taut_world_get_events(world, &events));
        return {hash, events.sensor_enter_count << 16 | events.sensor_leave_count};
    }

    taut_world world{};

private:
    taut_body add(taut_body_kind kind, double x, double y, float size = 0) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.kind = kind;
        def.shape = shape_;
        def.position = {x, y, 0};
        if (size > 0) {
            taut_box_def box;
            taut_box_def_init(&box);
            box.half_extents = {size, 0.5f, size};
            ok(taut_world_add_box(world, &box, &def.shape));
        }
        taut_body body{};
        ok(taut_world_add_body(world, &def, &body));
        return body;
    }

    taut_shape shape_{};
    taut_body lift_{};
    std::vector<taut_body> bodies_;
};

TEST(RestoredHost, GoesOnInTheMiddleOfAStep) {
    Playground run;
    int frame = 0;
    for (int start = 0; start < 8; ++start) {
        for (int i = 0; i < 13; ++i) run.play(frame++);
        run.told();
        uint64_t size = 0;
        ok(taut_world_snapshot_size(run.world, &size));
        std::vector<std::byte> then(size);
        ok(taut_world_save(run.world, then.data(), size, &size));
        std::vector<std::pair<uint64_t, uint32_t>> told[2];
        for (auto& once : told) {
            for (int i = 0; i < 60; ++i) {
                run.play(frame + i);
                once.push_back(run.told());
            }
            ok(taut_world_restore(run.world, then.data(), then.size()));
        }
        EXPECT_EQ(told[0], told[1]) << "start " << start;
    }
}

}  // namespace
