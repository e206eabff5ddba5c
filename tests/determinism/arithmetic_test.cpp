// Whatever the host's threads do to their arithmetic, the library does its own, and leaves theirs as it was.
#include <cfenv>
#include <memory>
#include <thread>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "scenes/running_scene.h"

namespace {

using namespace lab;

struct Arithmetic {
    const char* name;
    void (*set)();
};

void PrintTo(const Arithmetic& arithmetic, std::ostream* out) { *out << arithmetic.name; }

constexpr Arithmetic kOdd[] = {
    {"RoundsUp", [] { std::fesetround(FE_UPWARD); }},
    {"RoundsToZero", [] { std::fesetround(FE_TOWARDZERO); }},
#if defined(__SSE2__)
    {"FlushesDenormals", [] { _mm_setcsr(_mm_getcsr() | 0x8040); }},
#endif
#if defined(__GLIBC__)
    {"Traps", [] { feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW); }},
#endif
};

// A thread's, for a while.
class Within {
public:
    explicit Within(const Arithmetic& arithmetic) {
        std::fegetenv(&before_);
        arithmetic.set();
    }
    ~Within() { std::fesetenv(&before_); }

private:
    std::fenv_t before_;
};

class OddArithmetic : public testing::TestWithParam<Arithmetic> {
protected:
    // Of the host's work only the steps are within.
    uint64_t hash_after(const RunningScene& run, int steps) const {
        for (int i = 0; i < steps; ++i) {
            const Within odd(GetParam());
            ok(taut_world_step(run.world.world));
        }
        return hash_of(run);
    }
    static uint64_t plain_hash_after(const RunningScene& run, int steps) {
        for (int i = 0; i < steps; ++i) ok(taut_world_step(run.world.world));
        return hash_of(run);
    }
    static uint64_t hash_of(const RunningScene& run) {
        uint64_t hash = 0;
        ok(taut_world_get_state_hash(run.world.world, &hash));
        return hash;
    }
};

TEST_P(OddArithmetic, OfWhoSteps) {
    for (const char* scene : {"stack10", "chain10_r1000", "wrecking_ball", "shapes50"})
        EXPECT_EQ(hash_after(RunningScene(scene), 60), plain_hash_after(RunningScene(scene), 60)) << scene;
}

// Threads have the arithmetic of the one that started them.
TEST_P(OddArithmetic, OfTheWorldsThreads) {
    constexpr int kSteps = 20;
    scenes::Scene scene = scenes::make_scene("pyramid30");
    const auto built_within = [&](uint32_t threads) {
        scene.world.threads = threads;
        const Within odd(GetParam());
        return std::make_unique<RunningScene>(scene);
    };
    EXPECT_EQ(plain_hash_after(*built_within(3), kSteps), plain_hash_after(*built_within(1), kSteps));
}

TEST_P(OddArithmetic, OfTheHostsWorkers) {
    constexpr int kSteps = 20;
    struct Host {
        const Arithmetic& arithmetic;
        std::vector<std::thread> workers;
    } host{GetParam(), {}};
    scenes::Scene scene = scenes::make_scene("pyramid30");
    const uint64_t alone = plain_hash_after(RunningScene(scene), kSteps);
    scene.world.hooks.task_user_data = &host;
    scene.world.hooks.worker_count = 2;
    scene.world.hooks.enqueue_task = [](taut_task_fn task, uint32_t count, uint32_t, void* data, void* self) -> void* {
        Host& of = *static_cast<Host*>(self);
        for (uint32_t i = 0; i < count; ++i)
            of.workers.emplace_back([task, i, data, &of] {
                const Within odd(of.arithmetic);
                task(i, i + 1, i, data);
            });
        return self;
    };
    scene.world.hooks.finish_task = [](void* token, void*) {
        for (std::thread& worker : static_cast<Host*>(token)->workers) worker.join();
        static_cast<Host*>(token)->workers.clear();
    };
    EXPECT_EQ(plain_hash_after(RunningScene(scene), kSteps), alone);
}

// What a hull weighs, and where rays meet it.
TEST_P(OddArithmetic, OfWhoBuildsAndAsks) {
    const std::vector<taut_vec3> points = {{0, 0, 0},          {0.3f, 0.1f, 0},     {0.1f, 0.37f, 0.1f},
                                           {0.2f, 0.2f, 0.4f}, {0.33f, 0.3f, 0.3f}, {0.05f, 0.1f, 0.3f}};
    taut_hull_def hull;
    taut_hull_def_init(&hull);
    hull.points = points.data();
    hull.point_count = static_cast<uint32_t>(points.size());
    taut_body_def body;
    taut_body_def_init(&body);
    std::vector<taut_ray> rays(16, taut_ray{});
    for (size_t i = 0; i < rays.size(); ++i) {
        rays[i].origin = {0.1 + 0.011 * static_cast<double>(i), 0.2, 3.1};
        rays[i].translation = {0.03f, -0.02f, -4};
    }
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    struct Answer {
        float mass = 0;
        taut_vec3 centre{};
        taut_sym3 inertia{};
        std::vector<taut_query_hit> hits;
    };
    const auto ask = [&](const World& world) {
        Answer out;
        taut_body made{};
        out.hits.resize(rays.size());
        ok(taut_world_add_hull(world.handle, &hull, &body.shape));
        ok(taut_world_add_body(world.handle, &body, &made));
        ok(taut_body_get_mass(made, &out.mass, &out.centre, &out.inertia));
        ok(taut_world_cast_rays(world.handle, rays.data(), static_cast<uint32_t>(rays.size()), &filter,
                                out.hits.data()));
        return out;
    };
    const Answer plain = ask(World());
    const World world;
    const Answer odd = [&] {
        const Within arithmetic(GetParam());
        return ask(world);
    }();
    EXPECT_EQ(odd.mass, plain.mass);
    EXPECT_EQ(odd.centre.x, plain.centre.x);
    EXPECT_EQ(odd.inertia.xx, plain.inertia.xx);
    EXPECT_EQ(odd.inertia.yz, plain.inertia.yz);
    int met = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        met += plain.hits[i].body.bits != 0;
        EXPECT_EQ(odd.hits[i].fraction, plain.hits[i].fraction) << i;
        EXPECT_EQ(odd.hits[i].normal.x, plain.hits[i].normal.x) << i;
    }
    EXPECT_GT(met, 4);
}

// Callers go on with the arithmetic that they came with.
TEST_P(OddArithmetic, ComesBack) {
    const RunningScene run("stack10");
    const Within odd(GetParam());
    const int rounding = std::fegetround();
    std::feclearexcept(FE_ALL_EXCEPT);
#if defined(__SSE2__)
    const unsigned word = _mm_getcsr();
#endif
    ok(taut_world_step(run.world.world));
    EXPECT_EQ(std::fegetround(), rounding);
#if defined(__SSE2__)
    EXPECT_EQ(_mm_getcsr(), word);
#endif
}

INSTANTIATE_TEST_SUITE_P(Of, OddArithmetic, testing::ValuesIn(kOdd),
                         [](const auto& tested) -> std::string { return tested.param.name; });

}  // namespace
