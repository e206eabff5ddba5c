// Handles that name nothing, or something of another world.
#include <unordered_set>
#include <vector>

#include "calls.h"

using namespace taut_test;

namespace {

// Every call of the table refuses the handle as stale and says so by name.
template <class Handle>
void expect_stale(const std::vector<Call<Handle>>& calls, Handle handle, const char* which) {
    for (const Call<Handle>& call : calls) {
        EXPECT_EQ(call.run(handle), TAUT_STALE_HANDLE) << call.name << " with " << which << ": " << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), call.name)) << taut_last_error();
    }
}

// Bits that no world gave out.
const uint64_t kInvented[] = {
    1, 0xffff, 0x100000, 0x1000000, 0xffffffffff, uint64_t{1} << 40, uint64_t{1} << 63, UINT64_MAX, 0x123456789abcdef0};

struct Handles : testing::Test {
    Populated p;
};

TEST_F(Handles, NullIsStale) {
    expect_stale(world_calls(p), taut_world{0}, "null");
    expect_stale(body_calls(), taut_body{0}, "null");
    expect_stale(shape_calls(), taut_shape{0}, "null");
    expect_stale(collider_calls(p), taut_collider{0}, "null");
    expect_stale(joint_calls(), taut_joint{0}, "null");
    EXPECT_FALSE(taut_world_is_valid({0}));
    EXPECT_FALSE(taut_body_is_valid({0}));
    EXPECT_FALSE(taut_shape_is_valid({0}));
    EXPECT_FALSE(taut_collider_is_valid({0}));
    EXPECT_FALSE(taut_joint_is_valid({0}));
}

TEST_F(Handles, InventedBitsAreStale) {
    const Watch watch(p.world);
    for (uint64_t bits : kInvented) {
        if (bits == p.world.bits) continue;
        expect_stale(world_calls(p), taut_world{bits}, "invented bits");
        expect_stale(body_calls(), taut_body{bits}, "invented bits");
        expect_stale(shape_calls(), taut_shape{bits}, "invented bits");
        expect_stale(collider_calls(p), taut_collider{bits}, "invented bits");
        expect_stale(joint_calls(), taut_joint{bits}, "invented bits");
    }
    // One bit off a good handle.
    for (int bit = 0; bit < 64; ++bit) {
        const uint64_t flip = uint64_t{1} << bit;
        EXPECT_FALSE(taut_world_is_valid({p.world.bits ^ flip})) << bit;
        const taut_body body = {p.crate.bits ^ flip};
        if (bit < 40) expect_stale(body_calls(), body, "a flipped bit");  // above is the index: another body's slot
    }
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(Handles, RemovedIsStale) {
    ASSERT_OK(taut_joint_remove(p.rod));
    ASSERT_OK(taut_body_remove(p.crate));
    ASSERT_OK(taut_body_remove(p.lift));
    ASSERT_OK(taut_shape_remove(p.box));
    const Watch watch(p.world);
    expect_stale(joint_calls(), p.rod, "a removed joint");
    expect_stale(body_calls(), p.crate, "a removed body");
    expect_stale(shape_calls(), p.box, "a removed shape");
    expect_stale(collider_calls(p), p.collider, "a collider of a removed body");
    EXPECT_FALSE(taut_joint_is_valid(p.rod));
    EXPECT_FALSE(taut_body_is_valid(p.crate));
    EXPECT_FALSE(taut_shape_is_valid(p.box));
    // What takes their slots is not them.
    const taut_shape box = add_box(p.world);
    const taut_body crate = add_body(p.world, body_def(TAUT_BODY_DYNAMIC, box, 0, 9, 0));
    add_rod(p.world, p.bob, {0}, {}, {12, 5, 0});
    expect_stale(joint_calls(), p.rod, "a removed joint");
    expect_stale(body_calls(), p.crate, "a removed body");
    expect_stale(shape_calls(), p.box, "a removed shape");
    expect_stale(collider_calls(p), p.collider, "a collider of a removed body");
    EXPECT_TRUE(taut_body_is_valid(crate));

    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box);
    taut_body out = {0};
    EXPECT_EQ(taut_world_add_body(p.world, &def, &out), TAUT_STALE_HANDLE);
    EXPECT_TRUE(contains(taut_last_error(), "shape")) << taut_last_error();
    taut_ball_joint_def joint;
    taut_ball_joint_def_init(&joint);
    joint.base.body_a = crate;
    joint.base.body_b = p.crate;
    taut_joint joint_out = {0};
    EXPECT_EQ(taut_world_add_ball_joint(p.world, &joint, &joint_out), TAUT_STALE_HANDLE);
    EXPECT_TRUE(contains(taut_last_error(), "body_b")) << taut_last_error();
}

TEST_F(Handles, RemovingABodyRemovesItsJoints) {
    ASSERT_OK(taut_body_remove(p.bob));
    EXPECT_FALSE(taut_joint_is_valid(p.rod));
    EXPECT_TRUE(taut_joint_is_valid(p.ball));
    EXPECT_EQ(counts_of(p.world), (Counts{4, 3, 1}));
    EXPECT_OK(taut_world_step(p.world));
}

TEST_F(Handles, OfAnotherWorldAreForeign) {
    Populated other;
    const Watch watch(p.world), other_watch(other.world);
    taut_body_def body = body_def(TAUT_BODY_DYNAMIC, other.box);
    taut_body body_out = {0};
    EXPECT_EQ(taut_world_add_body(p.world, &body, &body_out), TAUT_FOREIGN_HANDLE);
    EXPECT_TRUE(contains(taut_last_error(), "taut_world_add_body: shape")) << taut_last_error();
    for (int end = 0; end < 2; ++end) {
        taut_ball_joint_def ball;
        taut_ball_joint_def_init(&ball);
        ball.base.body_a = end == 0 ? other.crate : p.crate;
        ball.base.body_b = end == 1 ? other.crate : p.crate;
        taut_joint out = {0};
        EXPECT_EQ(taut_world_add_ball_joint(p.world, &ball, &out), TAUT_FOREIGN_HANDLE);
        EXPECT_TRUE(contains(taut_last_error(), end == 0 ? "body_a" : "body_b")) << taut_last_error();
        taut_distance_joint_def rod;
        taut_distance_joint_def_init(&rod);
        rod.base.body_a = ball.base.body_a;
        rod.base.body_b = ball.base.body_b;
        EXPECT_EQ(taut_world_add_distance_joint(p.world, &rod, &out), TAUT_FOREIGN_HANDLE);
    }
    EXPECT_TRUE(watch.unchanged() && other_watch.unchanged());
}

TEST_F(Handles, OfADestroyedWorldAreStale) {
    Populated gone;
    ASSERT_OK(taut_world_destroy(gone.world));
    EXPECT_FALSE(taut_world_is_valid(gone.world));
    expect_stale(world_calls(p), gone.world, "a destroyed world");
    expect_stale(body_calls(), gone.crate, "a body of a destroyed world");
    expect_stale(shape_calls(), gone.box, "a shape of a destroyed world");
    expect_stale(collider_calls(p), gone.collider, "a collider of a destroyed world");
    expect_stale(joint_calls(), gone.ball, "a joint of a destroyed world");
    EXPECT_FALSE(taut_body_is_valid(gone.crate));
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, gone.box);
    taut_body out = {0};
    EXPECT_EQ(taut_world_add_body(p.world, &def, &out), TAUT_STALE_HANDLE);
}

// More cycles than a slot has generations: the slot is given up rather than a handle reborn.
TEST_F(Handles, StayStaleWhileTheSlotIsReused) {
    std::vector<taut_body> dead;
    std::unordered_set<uint64_t> seen;
    taut_particle_def def;
    taut_particle_def_init(&def);
    for (int i = 0; i < 70000; ++i) {
        taut_body body = {0};
        ASSERT_OK(taut_world_add_particle(p.world, &def, &body));
        ASSERT_TRUE(seen.insert(body.bits).second) << i;
        ASSERT_OK(taut_body_remove(body));
        if (i % 1000 == 0) dead.push_back(body);
        if (i % 10000 == 0) {
            for (taut_body old : dead) ASSERT_FALSE(taut_body_is_valid(old)) << i;
        }
    }
    for (taut_body old : dead) EXPECT_EQ(taut_body_remove(old), TAUT_STALE_HANDLE);
    EXPECT_EQ(counts_of(p.world).bodies, 5u);
    EXPECT_TRUE(taut_body_is_valid(p.crate));
    EXPECT_OK(taut_world_step(p.world));
}

TEST(Worlds, HandlesDoNotComeBack) {
    std::unordered_set<uint64_t> seen;
    const taut_world first = make_world();
    ASSERT_OK(taut_world_destroy(first));
    for (int i = 0; i < 5000; ++i) {
        const taut_world world = make_world();
        ASSERT_TRUE(seen.insert(world.bits).second) << i;
        ASSERT_OK(taut_world_destroy(world));
    }
    EXPECT_FALSE(seen.contains(first.bits));
    EXPECT_FALSE(taut_world_is_valid(first));
}

// A thousand worlds and one through each of the 1023 slots: more than ten bits of generation tell apart.
TEST(Worlds, HandlesIntoThemDoNotComeBack) {
    taut_world_def def;
    taut_world_def_init(&def);
    taut_world first;
    ASSERT_OK(taut_world_create(&def, &first));
    taut_particle_def particle;
    taut_particle_def_init(&particle);
    taut_body old;
    ASSERT_OK(taut_world_add_particle(first, &particle, &old));
    ASSERT_OK(taut_world_destroy(first));
    for (int i = 0; i < 1023 * 1024; ++i) {
        taut_world world;
        ASSERT_OK(taut_world_create(&def, &world));
        ASSERT_NE(world.bits, first.bits) << i;
        ASSERT_OK(taut_world_destroy(world));
    }
    EXPECT_FALSE(taut_body_is_valid(old));
}

TEST(Worlds, AreLimitedTo1023) {
    taut_world_def def;
    taut_world_def_init(&def);
    std::vector<taut_world> worlds(1023);
    for (taut_world& world : worlds) ASSERT_OK(taut_world_create(&def, &world));
    taut_world out = {0x1234};
    EXPECT_EQ(taut_world_create(&def, &out), TAUT_LIMIT);
    EXPECT_TRUE(contains(taut_last_error(), "1023")) << taut_last_error();
    EXPECT_EQ(out.bits, 0x1234u);
    ASSERT_OK(taut_world_destroy(worlds[500]));
    EXPECT_OK(taut_world_create(&def, &worlds[500]));
    EXPECT_EQ(taut_world_create(&def, &out), TAUT_LIMIT);
    for (taut_world world : worlds) EXPECT_OK(taut_world_destroy(world));
}

}  // namespace
