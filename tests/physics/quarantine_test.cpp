// A body whose state bursts is frozen and reported; the others go on.
#include <algorithm>

#include "physics/lab.h"

namespace {

using namespace lab;

struct Burst {
    const char* name;
    int body;  // of the pile, or a link of the chain beside it
    bool link;
};

void PrintTo(const Burst& b, std::ostream* out) { *out << b.name; }

class Quarantine : public testing::TestWithParam<Burst> {};

TEST_P(Quarantine, FreezesTheBodyAndThePileGoesOn) {
    constexpr size_t kSide = 4;
    World world;
    world.add_ground();
    std::vector<taut_body> pile, chain;
    const taut_shape cube = world.box({0.25, 0.25, 0.25});
    for (size_t i = 0; i < kSide * kSide * 2; ++i) pile.push_back(world.add({.shape = cube, .mass = 5}));
    for (size_t i = 0; i < pile.size(); ++i) {
        const size_t column = i % kSide, row = i / kSide % kSide, layer = i / (kSide * kSide);
        taut_pose pose{};
        pose.position = {0.55 * static_cast<double>(column), 0.3 + 0.55 * static_cast<double>(layer),
                         0.55 * static_cast<double>(row)};
        pose.rotation = Quat().narrow();
        ok(taut_body_set_pose(pile[i], &pose));
    }
    for (size_t i = 0; i < 6; ++i) {
        chain.push_back(world.add(
            {.position = {0.3 * static_cast<double>(i) + 5.15, 4, 0}, .mass = 1, .inertia = {0.01, 0.01, 0.01}}));
        if (i == 0)
            world.ball({}, {5, 4, 0}, chain[0], {-0.15, 0, 0});
        else
            world.ball(chain[i - 1], {0.15, 0, 0}, chain[i], {-0.15, 0, 0});
    }
    world.step(20);

    const taut_body victim = (GetParam().link ? chain : pile)[static_cast<size_t>(GetParam().body)];
    const Vec before = position(victim);
    // The interface refuses impulses beyond all speed; a force of that size it cannot judge beforehand.
    EXPECT_EQ(taut_body_apply_impulse(victim, {3e38f, 1e38f, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_LT(norm(velocity(victim)), 30);
    ok(taut_body_apply_force(victim, {1e24f, 3e23f, 0}, {0, 0, 0}));
    // What touches the body or is joined to it may be torn along in the substep before it is frozen; nothing else may.
    const auto& afar = GetParam().link ? pile : chain;
    auto is_afar = [&](taut_body body) {
        return std::any_of(afar.begin(), afar.end(), [&](taut_body b) { return b.bits == body.bits; });
    };
    std::vector<uint64_t> frozen;
    double fastest = 0;
    for (int frame = 0; frame < 240; ++frame) {
        world.step();
        taut_events events{};
        ok(taut_world_get_events(world.handle, &events));
        for (uint32_t i = 0; i < events.quarantined_count; ++i) {
            frozen.push_back(events.quarantined[i].body.bits);
            EXPECT_FALSE(is_afar(events.quarantined[i].body)) << "frozen without touching";
        }
        for (const auto* group : {&pile, &chain})
            for (taut_body body : *group) {
                ASSERT_TRUE(finite(body)) << "frame " << frame;
            }
        for (taut_body body : afar) fastest = std::max(fastest, norm(velocity(body)));
    }
    EXPECT_EQ(std::count(frozen.begin(), frozen.end(), victim.bits), 1) << "reported once";
    EXPECT_EQ(frozen.size(), 1u) << "others were dragged along";
    EXPECT_LT(norm(position(victim) - before), 0.5) << "not put back";
    taut_body_kind kind{};
    ok(taut_body_get_kind(victim, &kind));
    EXPECT_EQ(kind, TAUT_BODY_STATIC);
    EXPECT_LT(fastest, 30) << "the burst threw others about";
    double still_moving = 0;
    for (taut_body body : pile) still_moving = std::max(still_moving, norm(velocity(body)));
    EXPECT_LT(still_moving, 0.05) << "the pile should have come to rest";
    RecordProperty("frozen", std::to_string(frozen.size()));
    for (taut_body body : pile) EXPECT_GT(position(body).y, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Of, Quarantine,
                         testing::Values(Burst{"top_box", 21, false}, Burst{"bottom_box", 5, false},
                                         Burst{"link", 3, true}),
                         [](const auto& tested) { return tested.param.name; });

// Threads of a team have the motions of a large pile in a place of their own while a frame lasts; what goes too fast in
// between is found there, and all comes out as on one thread.
TEST(QuarantineOnTeams, OfWhatGoesTooFastWithinAFrame) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 2u, 3u}) {
        World world([&](taut_world_def& def) {
            def.threads = threads;
            def.gravity = {0, -1e4f, 0};
            def.solver = TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL;  // no blocks
        });
        world.add_ground();
        const taut_shape cube = world.box({0.25, 0.25, 0.25});
        for (int i = 0; i < 800; ++i)
            world.add({.shape = cube,
                       .position = {0.51 * (i % 20), 0.26 + 0.51 * (i / 400), 0.51 * (i / 20 % 20)},
                       .mass = 5,
                       .gravity_scale = 1e-4 * kG});
        const taut_body fast =
            world.add({.shape = cube, .position = {0, 1e6, 0}, .mass = 5, .gravity_scale = -970});  // 40 km/s a substep
        // A spring's end feels from the next substep on that the other is back.
        const taut_body end = world.add({.shape = cube, .position = {1, 1e6, 0}, .mass = 5, .gravity_scale = 0});
        world.rod(fast, {}, end, {}, 1, 1);
        uint32_t frozen = 0;
        for (int frame = 0; frame < 20; ++frame) {
            world.step();
            taut_events events{};
            ok(taut_world_get_events(world.handle, &events));
            frozen += events.quarantined_count;
            for (uint32_t i = 0; i < events.quarantined_count; ++i)
                EXPECT_EQ(events.quarantined[i].body.bits, fast.bits);
        }
        EXPECT_EQ(frozen, 1u);
        hashes.push_back(0);
        ok(taut_world_get_state_hash(world.handle, &hashes.back()));
        EXPECT_EQ(hashes.back(), hashes.front()) << threads << " threads";
    }
}

}  // namespace
