// A scene that is saved, plays on, is disturbed, and is restored: from there it must go on as it did the first time.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/running_scene.h"

namespace lab {

class RestoredScene : public RunningScene {
public:
    static constexpr int kSteps = 60;

    explicit RestoredScene(scenes::Scene plan) : RunningScene(std::move(plan)) {}

    std::vector<std::byte> save() const {
        uint64_t size = 0, written = 0;
        ok(taut_world_snapshot_size(world.world, &size));
        std::vector<std::byte> bytes(size);
        ok(taut_world_save(world.world, bytes.data(), size, &written));
        EXPECT_EQ(written, size);
        return bytes;
    }

    // The same hash in every frame and the same bytes, which tell of layout and order as well, at both ends. Disturbed
    // before it is restored, the world has other values in what a list of fields forgot.
    void expect_to_go_on_as_before(bool disturbed) {
        const std::vector<std::byte> then = save();
        const std::vector<uint64_t> hashes = play();
        const std::vector<std::byte> end = save();
        if (disturbed) disturb();
        ok(taut_world_restore(world.world, then.data(), then.size()));
        EXPECT_TRUE(save() == then);
        EXPECT_EQ(play(), hashes);
        EXPECT_TRUE(save() == end);
    }

private:
    std::vector<uint64_t> play() const {
        std::vector<uint64_t> hashes(kSteps);
        for (uint64_t& hash : hashes) {
            ok(taut_world_step(world.world));
            ok(taut_world_get_state_hash(world.world, &hash));
        }
        return hashes;
    }
    // Bodies go and come, and the rest moves otherwise.
    void disturb() {
        for (size_t i = 0; i < world.bodies.size(); i += 2) ok(taut_body_remove(world.bodies[i]));
        for (const taut_cable cable : world.cables) ok(taut_cable_remove(cable));
        for (int i = 0; i < 20; ++i) {
            taut_body_def def;
            taut_body_def_init(&def);
            if (!world.shapes.empty()) def.shape = world.shapes[0];  // scenes of cables have none
            def.kind = TAUT_BODY_STATIC;
            def.position = {0.4 * i, 1, 0};
            taut_body body{};
            ok(taut_world_add_body(world.world, &def, &body));
        }
        ok(taut_world_set_gravity(world.world, {1, -3, 0}));
        ok(taut_world_set_time_step(world.world, 1.0f / 50));
        ok(taut_world_set_substeps(world.world, 3));
        for (int i = 0; i < 10; ++i) ok(taut_world_step(world.world));
    }
};

}  // namespace lab
