// Snapshots as bytes: their size, what is refused, which handles live. That what was restored goes on as before is in
// determinism/snapshot_test.cpp.
#include <cstring>

#include "support.h"

using namespace taut_test;

namespace {

// One with a cable as well, which has shapes of its own and lists within lists.
struct WithCable : Populated {
    explicit WithCable(const taut_hooks& hooks = {}) : Populated(hooks) {
        cable = add_cable();
        step(3);
        saved = save(world);
    }
    taut_cable add_cable() const {
        const taut_pos points[] = {{-20, 5, 0}, {-15, 5, 0}};
        taut_cable_def def;
        taut_cable_def_init(&def);
        def.points = points;
        def.point_count = 2;
        def.segment_count = 10;
        def.bending_stiffness = 1;
        taut_cable out = {0};
        EXPECT_OK(taut_world_add_cable(world, &def, &out));
        return out;
    }
    void step(int count) const {
        for (int i = 0; i < count; ++i) EXPECT_OK(taut_world_step(world));
    }

    taut_cable cable;
};

TEST(Snapshot, SizeIsKnownBefore) {
    WithCable p;
    uint64_t size = 0, written = 0;
    ASSERT_OK(taut_world_snapshot_size(p.world, &size));
    std::vector<unsigned char> buffer(size + 8, 0xab);
    EXPECT_EQ(taut_world_save(p.world, buffer.data(), size - 1, &written), TAUT_TOO_SMALL);
    EXPECT_EQ(written, size);
    EXPECT_TRUE(contains(taut_last_error(), "expected at least")) << taut_last_error();
    EXPECT_EQ(buffer[0], 0xab);
    // At any alignment, and nothing beyond.
    ASSERT_OK(taut_world_save(p.world, buffer.data() + 1, size, &written));
    EXPECT_EQ(written, size);
    EXPECT_EQ(buffer[0], 0xab);
    EXPECT_EQ(std::vector<unsigned char>(buffer.end() - 7, buffer.end()), std::vector<unsigned char>(7, 0xab));
    EXPECT_EQ(std::memcmp(buffer.data() + 1, p.saved.data(), size), 0);
    ASSERT_OK(taut_world_restore(p.world, buffer.data() + 1, size));
}

TEST(Snapshot, NullPointersAreRefused) {
    Populated p;
    uint64_t size = 0;
    EXPECT_EQ(taut_world_snapshot_size(p.world, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_save(p.world, &size, sizeof size, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_save(p.world, nullptr, UINT64_MAX, &size), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_save(p.world, nullptr, 0, &size), TAUT_TOO_SMALL);
    EXPECT_EQ(taut_world_restore(p.world, nullptr, 100), TAUT_NULL_POINTER);
}

// Each byte changed, one bit at a time in turn, and each length that is not its own.
TEST(Snapshot, WhatIsDamagedIsRefused) {
    WithCable p;
    p.step(10);
    const Watch watch(p.world);
    std::vector<unsigned char> bytes = p.saved;
    for (size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] ^= static_cast<unsigned char>(1 << i % 8);
        const taut_result result = restore(p.world, bytes);
        ASSERT_TRUE(result == TAUT_INVALID_ARGUMENT || result == TAUT_UNSUPPORTED) << i << ": " << taut_last_error();
        ASSERT_TRUE(contains(taut_last_error(), "taut_world_restore")) << taut_last_error();
        bytes[i] = p.saved[i];
    }
    for (size_t size = 0; size < bytes.size(); size += 1 + size / 50)
        ASSERT_EQ(taut_world_restore(p.world, bytes.data(), size), TAUT_INVALID_ARGUMENT) << size;
    bytes.push_back(0);
    EXPECT_EQ(restore(p.world, bytes), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(restore(p.world, p.saved));
}

TEST(Snapshot, IsOfItsWorld) {
    Populated p, other;
    const Watch watch(other.world);
    EXPECT_EQ(restore(other.world, p.saved), TAUT_FOREIGN_HANDLE);
    EXPECT_TRUE(contains(taut_last_error(), "another world")) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
}

TEST(Snapshot, HandlesLiveAgain) {
    WithCable p;
    const uint64_t hash = hash_of(p.world);
    const taut_body late = add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 20, 1, 0));
    const taut_joint late_joint = add_ball(p.world, late, p.crate);
    const taut_cable late_cable = p.add_cable();
    p.step(5);
    ASSERT_OK(taut_body_remove(p.crate));
    ASSERT_OK(taut_joint_remove(p.rod));
    ASSERT_OK(taut_cable_remove(p.cable));
    for (int i = 0; i < 4; ++i) add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 3 * i, 3, 0));  // into their slots
    p.step(5);
    EXPECT_FALSE(taut_body_is_valid(p.crate) || taut_joint_is_valid(p.rod) || taut_cable_is_valid(p.cable));
    ASSERT_OK(restore(p.world, p.saved));
    EXPECT_TRUE(taut_body_is_valid(p.crate) && taut_collider_is_valid(p.collider));
    EXPECT_TRUE(taut_joint_is_valid(p.rod) && taut_joint_is_valid(p.ball) && taut_cable_is_valid(p.cable));
    EXPECT_FALSE(taut_body_is_valid(late) || taut_joint_is_valid(late_joint) || taut_cable_is_valid(late_cable));
    EXPECT_EQ(hash_of(p.world), hash);
    EXPECT_EQ(save(p.world), p.saved);
    taut_ray ray = {{0, 10, 0}, {0, -20, 0}, 0};
    taut_query_hit hit;
    ASSERT_OK(taut_world_cast_ray(p.world, &ray, nullptr, &hit));
    EXPECT_EQ(hit.body.bits, p.crate.bits);
    EXPECT_EQ(add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 20, 1, 0)).bits, late.bits);
}

TEST(Snapshot, ShapesMustStillBeThere) {
    Populated p;
    const taut_shape later = add_box(p.world, 0.3f);
    add_body(p.world, body_def(TAUT_BODY_DYNAMIC, later, 30, 1, 0));
    ASSERT_OK(restore(p.world, p.saved));
    EXPECT_TRUE(taut_shape_is_valid(later));  // stays, and is in use no more
    EXPECT_OK(taut_shape_remove(later));
    ASSERT_OK(taut_body_remove(p.wedge));
    ASSERT_OK(taut_shape_remove(p.hull));
    const Watch watch(p.world);
    EXPECT_EQ(restore(p.world, p.saved), TAUT_STALE_HANDLE);
    EXPECT_TRUE(contains(taut_last_error(), "is gone")) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
    // One in its slot is not it.
    EXPECT_EQ(add_hull(p.world).bits >> 40, p.hull.bits >> 40);
    EXPECT_EQ(restore(p.world, p.saved), TAUT_STALE_HANDLE);
}

// Slots of shapes inside cables are theirs: a shape that is added after a cable is gone is not in their way.
TEST(Snapshot, ShapesOfCablesAreInIt) {
    WithCable p;
    ASSERT_OK(taut_cable_remove(p.cable));
    for (int i = 0; i < 12; ++i) add_box(p.world, 0.1f);
    const Counts before = counts_of(p.world);
    ASSERT_OK(restore(p.world, p.saved));
    EXPECT_EQ(counts_of(p.world).shapes, before.shapes + 10);
    p.step(3);
    ASSERT_OK(taut_cable_remove(p.cable));
    EXPECT_EQ(counts_of(p.world).shapes, before.shapes);
}

TEST(Snapshot, WhatIsSetOfTheWorldIsInIt) {
    Populated p;
    ASSERT_OK(taut_world_set_gravity(p.world, {0, -1, 0}));
    ASSERT_OK(taut_world_set_time_step(p.world, 0.01f));
    ASSERT_OK(taut_world_set_substeps(p.world, 9));
    ASSERT_OK(taut_world_set_hit_speed(p.world, 5));
    ASSERT_OK(taut_world_set_contact_events(p.world, TAUT_CONTACT_EVENTS_ALL));
    ASSERT_OK(taut_world_set_restitution_threshold(p.world, 0.25f));
    ASSERT_OK(taut_world_advance(p.world, 0.004, nullptr));
    taut_world_def then, now;
    ASSERT_OK(taut_world_get_def(p.world, &then));
    const std::vector<unsigned char> saved = save(p.world);
    ASSERT_OK(restore(p.world, p.saved));
    ASSERT_OK(taut_world_get_def(p.world, &now));
    EXPECT_EQ(now.substeps, 4u);
    ASSERT_OK(restore(p.world, saved));
    ASSERT_OK(taut_world_get_def(p.world, &now));
    EXPECT_EQ(std::memcmp(&now, &then, sizeof now), 0);
    taut_advance done;
    ASSERT_OK(taut_world_advance(p.world, 0.0061, &done));
    EXPECT_EQ(done.steps, 1u);
}

// Those that wait are forgotten; later ones tell what they told the first time.
TEST(Snapshot, EventsGoOnFromIt) {
    Populated p;
    add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 0, 1.7, 0));
    events_of(p.world);
    const std::vector<unsigned char> saved = save(p.world);
    const auto begun = [&] {
        std::vector<std::pair<uint64_t, uint32_t>> all;
        for (uint32_t i = 0; i < 20; ++i) {
            EXPECT_OK(taut_world_step(p.world));
            const taut_events events = events_of(p.world);
            EXPECT_EQ(events.steps, 1u);
            for (uint32_t k = 0; k < events.begin_count; ++k) all.push_back({events.begin[k].body_b.bits, i});
        }
        return all;
    };
    const auto first = begun();
    EXPECT_FALSE(first.empty());
    EXPECT_OK(taut_world_step(p.world));
    ASSERT_OK(restore(p.world, saved));
    EXPECT_EQ(events_of(p.world).steps, 0u);
    EXPECT_EQ(events_of(p.world).moved_count, 0u);
    EXPECT_EQ(begun(), first);
}

TEST(Snapshot, AFailedAllocationChangesNothing) {
    uint64_t refused = 0;
    for (uint64_t n = 1; n < 200; ++n) {
        Ledger ledger;
        {
            WithCable p(ledger.hooks());
            ASSERT_OK(taut_cable_remove(p.cable));
            for (int i = 0; i < 4; ++i) p.add_cable();  // where the memory of the one was
            p.step(5);
            const Watch watch(p.world);
            ledger.fail_from = ledger.calls + n;
            const taut_result result = restore(p.world, p.saved);
            ledger.fail_from = UINT64_MAX;
            if (result != TAUT_OK) {
                ++refused;
                ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
                ASSERT_TRUE(watch.unchanged());
                ASSERT_OK(restore(p.world, p.saved));
            }
            ASSERT_EQ(save(p.world), p.saved);
            if (result == TAUT_OK) n = 200;
        }
        ASSERT_TRUE(ledger.empty()) << ledger.bytes;
        ASSERT_EQ(ledger.errors, 0u);
    }
    EXPECT_GT(refused, 0u);  // most of its memory the world has still
}

// A world that had as much in it before takes nothing, nor do the steps after it.
TEST(Snapshot, RestoresWithoutMemoryWhereNothingGrew) {
    Ledger ledger;
    {
        Populated p(ledger.hooks());
        uint64_t calls = 0;
        for (int round = 0; round < 5; ++round) {
            ASSERT_OK(restore(p.world, p.saved));
            for (int i = 0; i < 3; ++i) ASSERT_OK(taut_world_step(p.world));
            if (round == 1) calls = ledger.calls;
        }
        EXPECT_EQ(ledger.calls, calls);
    }
    EXPECT_TRUE(ledger.empty());
}

}  // namespace
