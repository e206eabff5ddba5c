// Scopes told to the host's profiler: named, nested, paired, each on its thread, and without a trace in results.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

// What a profiler keeps, by thread: no two threads share a list.
struct Scopes {
    struct Told {
        std::string name;
        bool end;
        std::thread::id from;
    };
    std::array<std::vector<Told>, 8> told;
    std::atomic<bool> in_call{false};
    std::atomic<int> late{0};  // told while no step was being taken
    bool throws = false;

    static void tell(const char* name, uint32_t thread, uint32_t end, void* self) {
        auto& scopes = *static_cast<Scopes*>(self);
        if (!scopes.in_call) ++scopes.late;
        if (thread < scopes.told.size()) scopes.told[thread].push_back({name, end != 0, std::this_thread::get_id()});
        if (scopes.throws) throw std::runtime_error("a profiler that fails");
    }
    // Names of each thread's scopes; paired and nested, or the test fails.
    std::map<std::string, int> names(size_t thread) const {
        std::map<std::string, int> out;
        std::vector<std::string> open;
        for (const Told& each : told[thread]) {
            EXPECT_EQ(each.from, told[thread].front().from);
            if (!each.end) {
                open.push_back(each.name);
                ++out[each.name];
                continue;
            }
            EXPECT_FALSE(open.empty()) << each.name;
            if (open.empty()) return out;
            EXPECT_EQ(open.back(), each.name);
            open.pop_back();
        }
        EXPECT_TRUE(open.empty());
        return out;
    }
};

// A pile that moves, of enough bodies that loops are shared.
taut_world make_pile(uint32_t threads) {
    taut_world_def def;
    taut_world_def_init(&def);
    def.threads = threads;
    taut_world world;
    EXPECT_OK(taut_world_create(&def, &world));
    const taut_shape box = add_box(world), plane = add_plane(world);
    taut_body_def body;
    taut_body_def_init(&body);
    body.kind = TAUT_BODY_STATIC;
    body.shape = plane;
    add_body(world, body);
    taut_body_def_init(&body);
    body.shape = box;
    for (int i = 0; i < 600; ++i) {
        body.position = {(i % 10) * 1.2, 0.6 + (i / 100) * 1.1, (i / 10 % 10) * 1.2};
        add_body(world, body);
    }
    return world;
}
uint64_t hash_of(taut_world world) {
    uint64_t out = 0;
    EXPECT_OK(taut_world_get_state_hash(world, &out));
    return out;
}
void step(taut_world world, Scopes& scopes, int steps) {
    for (int i = 0; i < steps; ++i) {
        scopes.in_call = true;
        ASSERT_OK(taut_world_step(world));
        scopes.in_call = false;
    }
}

TEST(ProfileScopes, NameTheStagesOfAStepInOrder) {
    Scopes scopes;
    const taut_world world = make_pile(1);
    ASSERT_OK(taut_world_set_profile_scopes(world, Scopes::tell, &scopes));
    step(world, scopes, 3);
    const std::map<std::string, int> names = scopes.names(0);
    const std::set<std::string> known = {"step",     "broadphase", "narrowphase", "partition", "predict",
                                         "assemble", "solve",      "commit",      "publish"};
    for (const auto& [name, count] : names) EXPECT_TRUE(known.contains(name)) << name;
    EXPECT_EQ(names.size(), known.size());
    for (const char* once : {"step", "broadphase", "narrowphase", "partition", "publish"})
        EXPECT_EQ(names.at(once), 3) << once;
    EXPECT_GE(names.at("solve"), 3);
    EXPECT_EQ(scopes.told[0].front().name, "step");
    EXPECT_EQ(scopes.told[0].back().name, "step");
    EXPECT_EQ(scopes.told[0][1].name, "broadphase");
    for (size_t thread = 1; thread < scopes.told.size(); ++thread) EXPECT_TRUE(scopes.told[thread].empty());
    // None any more.
    const size_t before = scopes.told[0].size();
    ASSERT_OK(taut_world_set_profile_scopes(world, nullptr, nullptr));
    step(world, scopes, 1);
    EXPECT_EQ(scopes.told[0].size(), before);
    ASSERT_OK(taut_world_destroy(world));
}

TEST(ProfileScopes, HelpersTellOfTheirPartsWithinTheStep) {
    Scopes scopes;
    const taut_world world = make_pile(4);
    ASSERT_OK(taut_world_set_profile_scopes(world, Scopes::tell, &scopes));
    step(world, scopes, 60);
    EXPECT_EQ(scopes.late, 0);
    std::set<std::thread::id> threads;
    size_t helpers = 0;
    for (size_t thread = 1; thread < scopes.told.size(); ++thread) {
        const std::map<std::string, int> names = scopes.names(thread);
        if (names.empty()) continue;
        ++helpers;
        EXPECT_EQ(names.size(), 1u);
        EXPECT_TRUE(names.contains("work"));
        EXPECT_NE(scopes.told[thread].front().from, std::this_thread::get_id());
        EXPECT_TRUE(threads.insert(scopes.told[thread].front().from).second);
    }
    // On one core no helper is woken.
    EXPECT_GE(helpers, std::thread::hardware_concurrency() > 1 ? 1u : 0u);
    EXPECT_EQ(scopes.names(0).at("step"), 60);
    ASSERT_OK(taut_world_destroy(world));
}

TEST(ProfileScopes, ChangeNoResult) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 4u})
        for (const int how : {0, 1, 2}) {  // without, with, and one that throws
            Scopes scopes;
            scopes.throws = how == 2;
            const taut_world world = make_pile(threads);
            ASSERT_OK(taut_world_set_profile_scopes(world, how > 0 ? Scopes::tell : nullptr, &scopes));
            step(world, scopes, 20);
            EXPECT_EQ(scopes.names(0)["step"], how > 0 ? 20 : 0);
            hashes.push_back(hash_of(world));
            ASSERT_OK(taut_world_destroy(world));
        }
    for (const uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(ProfileScopes, CallsFromInsideAreLocked) {
    struct Inside {
        taut_world world;
        int locked = 0, other = 0;
    } inside{make_pile(1)};
    ASSERT_OK(taut_world_set_profile_scopes(
        inside.world,
        [](const char*, uint32_t, uint32_t, void* self) {
            auto& in = *static_cast<Inside*>(self);
            ++(taut_world_set_profile_scopes(in.world, nullptr, nullptr) == TAUT_LOCKED ? in.locked : in.other);
        },
        &inside));
    ASSERT_OK(taut_world_step(inside.world));
    EXPECT_GT(inside.locked, 10);
    EXPECT_EQ(inside.other, 0);
    ASSERT_OK(taut_world_destroy(inside.world));
    EXPECT_EQ(taut_world_set_profile_scopes(inside.world, nullptr, nullptr), TAUT_STALE_HANDLE);
}

}  // namespace
