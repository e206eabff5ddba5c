// What a world takes from its allocator for one more object, the room that arrays grow ahead included.
#include <cstdio>
#include <vector>

#include "scenes/catalogue.h"
#include "scenes/taut_world.h"
#include "support.h"

using namespace taut_test;

namespace {

constexpr int kMany = 1000;

// Until no step takes memory any more: what is noted to undo one that fails goes then.
void step_until_warm(taut_world world) {
    for (int i = 0; i < 10; ++i) EXPECT_OK(taut_world_step(world));
}

// Bytes an object that add(i) makes, once steps know them all.
template <class Add>
double bytes_of_each(const Ledger& ledger, taut_world world, Add&& add) {
    step_until_warm(world);
    const uint64_t before = ledger.bytes;
    for (int i = 0; i < kMany; ++i) add(i);
    step_until_warm(world);
    return static_cast<double>(ledger.bytes - before) / kMany;
}

class Footprint : public testing::Test {
protected:
    ~Footprint() override { taut_world_destroy(world_); }

    void expect_at_most(double bound, const char* what, double bytes) {
        std::printf("%s: %.0f bytes\n", what, bytes);
        RecordProperty(what, std::to_string(bytes));
        EXPECT_LE(bytes, bound) << what;
        EXPECT_GT(bytes, 0) << what;
    }

    Ledger ledger_;
    taut_world world_ = make_world(ledger_.hooks());
};

TEST_F(Footprint, OfABodyAlone) {
    expect_at_most(980, "body", bytes_of_each(ledger_, world_, [&](int) {
                       taut_body_def def = body_def(TAUT_BODY_DYNAMIC, {});
                       def.mass = 1;
                       def.inertia = {1, 1, 1, 0, 0, 0};
                       add_body(world_, def);
                   }));
}

TEST_F(Footprint, OfABodyWithAMassOfItsOwn) {
    expect_at_most(1140, "body unlike any other", bytes_of_each(ledger_, world_, [&](int i) {
                       taut_body_def def = body_def(TAUT_BODY_DYNAMIC, {});
                       def.mass = 1 + static_cast<float>(i);
                       def.inertia = {1, 1, 1, 0, 0, 0};
                       add_body(world_, def);
                   }));
}

TEST_F(Footprint, OfABoxShape) {
    expect_at_most(130, "shape", bytes_of_each(ledger_, world_, [&](int) { add_box(world_); }));
}

TEST_F(Footprint, OfACollider) {
    const taut_shape box = add_box(world_);
    const taut_body body = add_body(world_, body_def(TAUT_BODY_STATIC, box));
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = box;
    expect_at_most(615, "collider", bytes_of_each(ledger_, world_, [&](int i) {
                       def.position.x = 3.0f * static_cast<float>(i);
                       taut_collider out{};
                       EXPECT_OK(taut_body_add_collider(body, &def, &out));
                   }));
}

TEST_F(Footprint, OfAJoint) {
    const taut_shape box = add_box(world_);
    std::vector<taut_body> bodies;
    for (int i = 0; i < kMany; ++i) bodies.push_back(add_body(world_, body_def(TAUT_BODY_DYNAMIC, box, 3.0 * i)));
    expect_at_most(11530, "ball joint to the world", bytes_of_each(ledger_, world_, [&](int i) {
                       add_ball(world_, bodies[static_cast<size_t>(i)], {0}, {}, {3.0 * i, 0, 0});
                   }));
}

TEST_F(Footprint, OfAContact) {
    const taut_shape box = add_box(world_);
    std::vector<taut_body> bodies;
    for (int i = 0; i < kMany; ++i) {
        add_body(world_, body_def(TAUT_BODY_STATIC, box, 3.0 * i, -0.5));
        bodies.push_back(add_body(world_, body_def(TAUT_BODY_DYNAMIC, box, 3.0 * i, 100)));
    }
    expect_at_most(1540, "contact", bytes_of_each(ledger_, world_, [&](int i) {
                       EXPECT_OK(set_pose(bodies[static_cast<size_t>(i)], at(3.0 * i, 0.5, 0)));
                   }));
}

// With everything: shapes shared, colliders, pairs that are near, contacts, the solver's arrays.
TEST(FootprintOfAPile, PerBody) {
    Ledger ledger;
    scenes::Scene scene = scenes::make_scene("boxes2000");
    scene.world.hooks = ledger.hooks();
    scenes::TautWorld pile(scene);
    for (int i = 0; i < 300; ++i) pile.step();  // and reads the events, as a game does
    const taut_profile p = pile.profile();
    const double each = static_cast<double>(ledger.bytes) / p.bodies;
    std::printf("%u bodies, %u pairs, %u touching: %.0f bytes a body\n", p.bodies, p.pairs, p.touching, each);
    EXPECT_LE(each, 2850);
}

}  // namespace
