// Events, filters, sensors and the host's answers about what touches soft bodies by vertices, edges or triangles: of
// all kinds, one event a pair.
#include <bit>
#include <set>

#include "physics/contact_lab.h"
#include "physics/soft_contact_lab.h"
#include "physics/surface_lab.h"

namespace lab {
namespace {

using Sides = std::pair<uint64_t, uint64_t>;

Sides sides_of(const taut_contact_event& event) { return {event.collider_a.bits, event.collider_b.bits}; }

// Cloths and solids by their handle, all else by its collider.
uint64_t thing_of(taut_body body, taut_collider collider) {
    taut_cloth cloth{};
    taut_solid solid{};
    ok(taut_body_get_cloth(body, &cloth));
    ok(taut_body_get_solid(body, &solid));
    return cloth.bits ? cloth.bits : solid.bits ? solid.bits : collider.bits;
}

// A level square of two triangles with its corners held, some vertices far from all that meets it.
taut_cloth add_face(const World& world, double side = 2, double friction = 0.5, double height = 0) {
    Sheet sheet(2, 2, side, side, height);
    for (taut_pos& point : sheet.points) point = (Vec(point) - Vec{0.5 * side, 0, 0.5 * side}).pos();
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    def.material.friction = static_cast<float>(friction);
    def.material.restitution = 0;
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 1));
    return cloth;
}

void ask_for_all(taut_world_def& def) { def.contact_events = TAUT_CONTACT_EVENTS_ALL; }

// ---------------------------------------------------------------- two in free space

class SoftEvents : public testing::TestWithParam<Meeting> {
protected:
    SoftEvents()
        : world([](taut_world_def& def) {
              def.gravity = {0, 0, 0};
              ask_for_all(def);
          }) {
        const bool swept = GetParam().swept;
        below = GetParam().one->make(world, {.friction = 0, .swept = swept});
        above = GetParam().other->make(
            world, {.at = {0.043, 0.36, -0.057}, .velocity = {0.3, -2, 0.2}, .friction = 0, .swept = swept});
    }
    bool is_above(taut_body body) const {
        return std::ranges::any_of(above, [&](taut_body each) { return each.bits == body.bits; });
    }
    World world;
    std::vector<taut_body> below, above;
};
INSTANTIATE_TEST_SUITE_P(Kinds, SoftEvents, testing::ValuesIn(meetings()),
                         [](const auto& each) { return each.param.name(); });

// Without friction, what is told of the normals is all the momentum that one gives the other.
TEST_P(SoftEvents, TellOneOfEachPairAndAllOfItsPush) {
    std::set<Sides> touching;
    int begins = 0, hits = 0;
    Vec told;
    const Vec first = totals(above).momentum;
    for (int i = 0; i < 60; ++i) {
        world.step();
        const taut_events e = events_of(world);
        for (uint32_t k = 0; k < e.end_count; ++k) EXPECT_EQ(touching.erase(sides_of(e.end[k])), 1u);
        EXPECT_EQ(e.persist_count, touching.size());
        for (uint32_t k = 0; k < e.persist_count; ++k) EXPECT_EQ(touching.count(sides_of(e.persist[k])), 1u);
        for (uint32_t k = 0; k < e.begin_count; ++k) EXPECT_TRUE(touching.insert(sides_of(e.begin[k])).second);
        std::set<std::pair<uint64_t, uint64_t>> things;
        for (const auto& [list, count] : {std::pair{e.begin, e.begin_count}, std::pair{e.persist, e.persist_count}})
            for (uint32_t k = 0; k < count; ++k) {
                const taut_contact_event& event = list[k];
                EXPECT_LT(event.collider_a.bits, event.collider_b.bits);
                EXPECT_GT(event.point_count, 0u);
                EXPECT_TRUE(
                    things.insert({thing_of(event.body_a, event.collider_a), thing_of(event.body_b, event.collider_b)})
                        .second);
                EXPECT_NE(is_above(event.body_a), is_above(event.body_b));
                const double sign = is_above(event.body_b) ? 1 : -1;
                for (uint32_t p = 0; p < event.point_count; ++p) {
                    const taut_contact_point& point = e.points[event.first_point + p];
                    told += sign * static_cast<double>(point.normal_impulse) * Vec(point.normal);
                    EXPECT_EQ(point.friction_impulse, 0);
                }
            }
        begins += static_cast<int>(e.begin_count);
        hits += static_cast<int>(e.hit_count);
        for (uint32_t k = 0; k < e.hit_count; ++k)
            EXPECT_LE(static_cast<double>(e.hit[k].approach_speed), 4) << "faster than anything moves";
    }
    const Vec given = totals(above).momentum - first;
    EXPECT_GT(begins, 0);
    EXPECT_GT(hits, 0);
    // Of a swept solid on a cable 3 % are not told.
    const bool lost = GetParam().swept && std::string(GetParam().one->name) == "solid" &&
                      std::string(GetParam().other->name) == "cable";
    EXPECT_LE(norm(told - given), (lost ? 0.05 : 1e-4) * norm(given));
}

// Masks that exclude each other keep all that might touch apart, whichever of the two excludes.
TEST_P(SoftEvents, FiltersHoldForAllThatTouches) {
    for (const bool by_one : {false, true}) {
        World apart([](taut_world_def& def) {
            def.gravity = {0, 0, 0};
            ask_for_all(def);
        });
        const bool swept = GetParam().swept;
        GetParam().one->make(apart, {.swept = swept, .category = 2, .mask = by_one ? ~4u : ~0u});
        const std::vector<taut_body> others = GetParam().other->make(apart, {.at = {0.043, 0.36, -0.057},
                                                                             .velocity = {0.3, -2, 0.2},
                                                                             .swept = swept,
                                                                             .category = 4,
                                                                             .mask = by_one ? ~0u : ~2u});
        const Vec before = totals(others).momentum;
        for (int i = 0; i < 30; ++i) {
            apart.step();
            EXPECT_TRUE(apart.contacts().empty());
            const taut_events e = events_of(apart);
            EXPECT_EQ(e.begin_count + e.persist_count + e.end_count + e.hit_count, 0u);
        }
        EXPECT_LE(norm(totals(others).momentum - before), 1e-5 * norm(before));
    }
}

// ---------------------------------------------------------------- a face alone

TEST(SoftEvent, OfAFaceIsOneHitAtItsSpeedAndThenTheWeight) {
    for (const double height : {0.1, 0.7, 2.3}) {
        World world(ask_for_all);
        const taut_cloth cloth = add_face(world);
        const taut_body ball =
            world.add({.shape = world.sphere(0.1), .position = {0.3, 0.11 + height, -0.2}, .mass = 2});
        int hits = 0, begins = 0;
        double pushed = 0;
        for (int i = 0; i < 120; ++i) {
            world.step();
            const taut_events e = events_of(world);
            begins += static_cast<int>(e.begin_count);
            for (uint32_t k = 0; k < e.point_count; ++k) pushed += static_cast<double>(e.points[k].normal_impulse);
            for (uint32_t k = 0; k < e.hit_count; ++k, ++hits) {
                const double v = std::sqrt(2 * kG * height);
                EXPECT_NEAR(static_cast<double>(e.hit[k].approach_speed), v, 1.5 * kG * world.frame()) << height;
                EXPECT_NEAR(std::abs(static_cast<double>(e.hit[k].normal.y)), 1, 1e-5);
                EXPECT_LE(norm(Vec(e.hit[k].position) - Vec(0.3, 0.01, -0.2)), v * world.frame());
                taut_cloth named{};
                ok(taut_body_get_cloth(e.hit[k].body_a.bits == ball.bits ? e.hit[k].body_b : e.hit[k].body_a, &named));
                EXPECT_EQ(named.bits, cloth.bits);
            }
        }
        EXPECT_EQ(hits, 1) << height;
        EXPECT_EQ(begins, 1) << height;
        EXPECT_NEAR(pushed / (2 * kG * 120 * world.frame()), 1, 0.005) << height;
        ok(taut_body_remove(ball));
        world.step();
        const taut_events e = events_of(world);
        ASSERT_EQ(e.end_count, 1u);
        EXPECT_TRUE(e.end[0].body_a.bits == ball.bits || e.end[0].body_b.bits == ball.bits);
    }
}

// Many vertices, one event.
TEST(SoftEvent, OfAClothOnTheGroundIsOne) {
    World world(ask_for_all);
    const taut_body ground = world.add_ground();
    const taut_cloth cloth = make_cloth(world, {.at = {0, 0.2, 0}}, 9);
    int begins = 0;
    double pushed = 0;
    constexpr int kSteps = 180, kLast = 60;
    for (int i = 0; i < kSteps; ++i) {
        world.step();
        const taut_events e = events_of(world);
        begins += static_cast<int>(e.begin_count);
        ASSERT_LE(e.begin_count + e.persist_count, 1u);
        if (i < kSteps - kLast) continue;
        ASSERT_EQ(e.persist_count, 1u);
        EXPECT_EQ(world.profile().allocations, 0u);
        EXPECT_TRUE(e.persist[0].body_a.bits == ground.bits || e.persist[0].body_b.bits == ground.bits);
        EXPECT_GE(e.persist[0].point_count, 40u);
        for (uint32_t k = 0; k < e.point_count; ++k) pushed += static_cast<double>(e.points[k].normal_impulse);
    }
    EXPECT_EQ(begins, 1);
    EXPECT_NEAR(pushed / (totals(bodies_of(cloth)).mass * kG * kLast * world.frame()), 1, 0.01);
}

// What nobody asks for is not told; a cloth asks for all of itself.
TEST(SoftEvent, IsToldToThoseWhoAsk) {
    World world([](taut_world_def& def) { def.contact_events = 0; });
    const taut_cloth cloth = add_face(world);
    world.add({.shape = world.sphere(0.1), .position = {0.3, 0.3, -0.2}, .mass = 2});
    const auto told = [&](int steps) {
        int sum = 0;
        for (int i = 0; i < steps; ++i) {
            world.step();
            const taut_events e = events_of(world);
            sum += static_cast<int>(e.begin_count + e.persist_count + e.end_count + e.hit_count);
        }
        return sum;
    };
    EXPECT_EQ(told(60), 0);
    ok(taut_cloth_set_contact_events(cloth, TAUT_CONTACT_EVENTS_PERSIST));
    EXPECT_EQ(told(20), 20);
    ok(taut_cloth_set_contact_events(cloth, TAUT_CONTACT_EVENTS_BEGIN_END));
    EXPECT_EQ(told(20), 0) << "it touched before";
    EXPECT_EQ(taut_cloth_set_contact_events(cloth, 1u << 20), TAUT_INVALID_ARGUMENT);
}

// Asleep nothing is told, and nothing anew once it wakes.
TEST(SoftEvent, IsNotToldAnewAfterSleep) {
    World world([](taut_world_def& def) {
        ask_for_all(def);
        def.sleeping = 1;
    });
    world.add_ground();
    const taut_cloth cloth = make_cloth(world, {.at = {0, 0.02, 0}}, 5);
    const taut_body ball = make_grain(world, {.at = {0.043, 0.09, -0.03}}, true);
    const auto is_awake = [&](taut_body body) {
        uint32_t awake = 0;
        ok(taut_body_get_awake(body, &awake));
        return awake == 1;
    };
    std::set<Sides> touching;
    const auto follow = [&](bool rests) {
        world.step();
        const taut_events e = events_of(world);
        for (uint32_t k = 0; k < e.end_count; ++k) EXPECT_EQ(touching.erase(sides_of(e.end[k])), 1u);
        for (uint32_t k = 0; k < e.begin_count; ++k) EXPECT_TRUE(touching.insert(sides_of(e.begin[k])).second);
        const uint32_t told = e.begin_count + e.end_count + e.persist_count + e.hit_count;
        EXPECT_TRUE(!rests || told == 0);
    };
    for (int i = 0; i < 600 && is_awake(ball); ++i) follow(false);
    ASSERT_FALSE(is_awake(ball));
    follow(false);
    follow(false);
    EXPECT_EQ(touching.size(), 2u) << "cloth on ground, grain on cloth";
    for (int i = 0; i < 20; ++i) follow(true);
    ok(taut_body_set_awake(ball, 1));
    world.step();
    taut_events e = events_of(world);
    EXPECT_EQ(e.begin_count + e.end_count, 0u);
    EXPECT_EQ(e.persist_count, 2u);
    for (int i = 0; i < 600 && is_awake(ball); ++i) follow(false);
    for (int i = 0; i < 3; ++i) follow(false);
    ok(taut_cloth_remove(cloth));
    world.step();
    e = events_of(world);
    EXPECT_EQ(e.end_count, 2u);
}

// A heap of soft things, as words, on any team and after a restoration.
std::vector<uint64_t> tell_heap(const World& world, int steps) {
    std::vector<uint64_t> out;
    for (int i = 0; i < steps; ++i) {
        world.step();
        const taut_events e = events_of(world);
        for (const auto& [list, count] :
             {std::pair{e.begin, e.begin_count}, std::pair{e.persist, e.persist_count}, std::pair{e.end, e.end_count}})
            for (uint32_t k = 0; k < count; ++k) {
                out.push_back(list[k].collider_a.bits >> 24);  // without the world
                out.push_back(list[k].collider_b.bits >> 24 << 8 | (list[k].point_count & 255));
            }
        for (uint32_t k = 0; k < e.point_count; ++k)
            for (const float x : {e.points[k].normal_impulse, e.points[k].friction_impulse, e.points[k].approach_speed})
                out.push_back(std::bit_cast<uint32_t>(x));
        for (uint32_t k = 0; k < e.hit_count; ++k) out.push_back(std::bit_cast<uint32_t>(e.hit[k].approach_speed));
        for (uint32_t k = 0; k < e.sensor_enter_count; ++k) out.push_back(e.sensor_enter[k].visitor.bits >> 24);
    }
    return out;
}
void add_heap(const World& world) {
    world.add_ground();
    make_cloth(world, {.at = {0, 0.3, 0}}, 7);
    make_solid(world, {.at = {0.02, 0.55, 0.03}, .swept = true});
    make_cloth(world, {.at = {0.03, 0.9, 0.01}, .swept = true}, 6);
    make_rigid(world, {.at = {0, 1.1, 0}}, world.box({0.1, 0.1, 0.1}));
    make_cable(world, {.at = {0.05, 1.3, 0.02}}, TAUT_CABLE_PARTICLES);
    for (int i = 0; i < 6; ++i) make_grain(world, {.at = {0.1 * i - 0.25, 1.5, 0.04}}, true);
    taut_body_def gate;
    taut_body_def_init(&gate);
    gate.kind = TAUT_BODY_STATIC;
    gate.position = {0, 0.2, 0};
    gate.shape = world.box({0.1, 0.1, 0.1});
    gate.collider_flags = TAUT_COLLIDER_SENSOR;
    taut_body out{};
    ok(taut_world_add_body(world.handle, &gate, &out));
}

TEST(SoftEvent, IsTheSameOnAnyTeamAndAfterARestoration) {
    std::vector<uint64_t> alone;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        World world([&](taut_world_def& def) {
            ask_for_all(def);
            def.threads = threads;
        });
        add_heap(world);
        std::vector<uint64_t> told = tell_heap(world, 45);
        uint64_t size = 0;
        ok(taut_world_snapshot_size(world.handle, &size));
        std::vector<std::byte> then(size);
        ok(taut_world_save(world.handle, then.data(), size, &size));
        const std::vector<uint64_t> first = tell_heap(world, 30);
        ok(taut_world_restore(world.handle, then.data(), size));
        EXPECT_EQ(tell_heap(world, 30), first);
        told.insert(told.end(), first.begin(), first.end());
        if (threads == 1) alone = told;
        EXPECT_EQ(told, alone) << threads;
    }
    EXPECT_GT(alone.size(), 1000u);
}

// ---------------------------------------------------------------- the host's answers

struct Judge {
    int32_t verdict = 1;
    float friction = -1, restitution = -1;
    int asked = 0;
    taut_pre_solve last{};

    void serve(const World& world) {
        ok(taut_world_set_pre_solve(
            world.handle,
            [](const taut_pre_solve* contact, taut_pre_solve_answer* out, void* self) {
                Judge& judge = *static_cast<Judge*>(self);
                ++judge.asked;
                judge.last = *contact;
                if (judge.friction >= 0) out->friction = judge.friction;
                if (judge.restitution >= 0) out->restitution = judge.restitution;
                return judge.verdict;
            },
            this));
    }
};

TEST(SoftPreSolve, RefusedFacesLetThrough) {
    World world;
    const taut_cloth cloth = add_face(world);
    const taut_body ball = world.add({.shape = world.sphere(0.1), .position = {0.3, 0.112, -0.2}, .mass = 2});
    ok(taut_cloth_set_pre_solve(cloth, 1));
    Judge judge;
    judge.serve(world);
    world.step(30);
    EXPECT_NEAR(position(ball).y, 0.11, 2e-3);
    EXPECT_EQ(judge.asked, 30) << "once a step";
    EXPECT_EQ(judge.last.touching, 1u);
    EXPECT_EQ(judge.last.point_count, 1u);
    const bool ball_is_b = judge.last.body_b.bits == ball.bits;
    EXPECT_NEAR(static_cast<double>(judge.last.normal.y), ball_is_b ? 1 : -1, 1e-5);
    EXPECT_LE(norm(Vec(judge.last.points[0].position) - Vec(0.3, 0.01, -0.2)), 2e-3);
    judge.verdict = 0;
    const double from = position(ball).y;
    world.step(20);
    const double t = 20 * world.frame();
    EXPECT_NEAR(position(ball).y, from - 0.5 * kG * t * t, 0.02 * kG * t) << "free fall";
    EXPECT_TRUE(world.contacts().empty());
}

// mu as answered brakes as Coulomb says; e as answered sends back as Newton says.
TEST(SoftPreSolve, GivesFrictionAndRestitution) {
    World world;
    const taut_cloth cloth = add_face(world, 16, 1);
    ok(taut_cloth_set_pre_solve(cloth, 1));
    const taut_body box = world.add({.shape = world.box({0.3, 0.1, 0.3}),
                                     .position = {0.5, 0.11, -0.4},
                                     .velocity = {3, 0, 0},
                                     .mass = 2,
                                     .friction = 1});
    Judge judge;
    judge.friction = 0.1f;
    judge.serve(world);
    world.step(60);
    EXPECT_NEAR(velocity(box).x, 3 - 0.1 * kG * 60 * world.frame(), 0.03);
    ok(taut_body_remove(box));
    const taut_body ball = world.add({.shape = world.sphere(0.1), .position = {0.3, 1.11, -0.2}, .mass = 2});
    judge.restitution = 0.8f;
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        fastest = std::max(fastest, velocity(ball).y);
    }
    EXPECT_NEAR(fastest, 0.8 * std::sqrt(2 * kG), 0.2);
}

// What runs on a face by its own belt goes at the belt's speed the other way.
TEST(SoftPreSolve, MovingSurfacesDriveFaces) {
    World world;
    add_face(world, 16);
    const taut_body box = world.add({.shape = world.box({0.3, 0.1, 0.3}), .position = {0.5, 0.11, -0.4}, .mass = 2});
    ok(taut_collider_set_surface_velocity(collider_of(box), {1, 0, 0.5f}, {}));
    world.step(60);
    EXPECT_LE(norm(velocity(box) - Vec(-1, 0, -0.5)), 0.02);
}

TEST(SoftPreSolve, OneWayFacesHoldFromOneSide) {
    for (const double way : {-1.0, 1.0}) {
        World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const taut_cloth cloth = add_face(world);
        for (const taut_body body : bodies_of(cloth)) ok(taut_collider_set_one_way(collider_of(body), {0, 1, 0}));
        const taut_body ball = world.add(
            {.shape = world.sphere(0.1), .position = {0.3, -0.5 * way, -0.2}, .velocity = {0, 2 * way, 0}, .mass = 2});
        world.step(60);
        if (way > 0)
            EXPECT_NEAR(velocity(ball).y, 2, 1e-3) << "from below it goes through";
        else
            EXPECT_GE(position(ball).y, 0.1) << "from above it is held";
    }
}

// ---------------------------------------------------------------- sensors

struct Probe {
    const char* name;
    double low, high;  // how far it reaches below and above its origin [m]
    taut_shape (*make)(const World& world);
};

const std::vector<Probe>& probes() {
    static const std::vector<Probe> all = {
        {"sphere", 0.25, 0.25, [](const World& w) { return w.sphere(0.25); }},
        {"box", 0.1, 0.1,
         [](const World& w) {
             return w.box({0.2, 0.1, 0.3});
         }},
        {"capsule", 0.3, 0.3, [](const World& w) { return w.capsule(0.1, 0.2); }},
        {"cylinder", 0.2, 0.2, [](const World& w) { return w.cylinder(0.1, 0.2); }},
        {"cone", 0.2, 0.2, [](const World& w) { return w.cone(0.1, 0.2); }},
        {"tapered", 0.3, 0.25, [](const World& w) { return w.tapered_capsule(0.1, 0.05, 0.2); }},
        {"plane", 1e3, 0, [](const World& w) { return w.plane(); }},
        {"mesh", 0, 0,
         [](const World& w) {
             return mesh(w, {{{-0.3, 0, -0.3}, {-0.3, 0, 0.3}, {0.3, 0, 0.3}, {0.3, 0, -0.3}}, {0, 1, 2, 0, 2, 3}});
         }},
    };
    return all;
}

class SoftSensor : public testing::TestWithParam<Probe> {};
INSTANTIATE_TEST_SUITE_P(Of, SoftSensor, testing::ValuesIn(probes()),
                         [](const auto& each) { return std::string(each.param.name); });

// Lowered through a face that has no vertex near: in touch while within half of its thickness.
TEST_P(SoftSensor, MeetsAFaceWithoutItsVertices) {
    World world;
    const taut_cloth cloth = add_face(world, 4);
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = TAUT_BODY_KINEMATIC;
    def.position = {0.53, 1.3, -0.31};
    def.shape = GetParam().make(world);
    def.collider_flags = TAUT_COLLIDER_SENSOR;
    taut_body sensor{};
    ok(taut_world_add_body(world.handle, &def, &sensor));
    ok(taut_body_set_velocity(sensor, {0, -1.234f, 0}, {}));
    bool inside = false;
    int entered = 0;
    while (position(sensor).y > -1) {
        world.step();
        const double y = position(sensor).y;
        const bool now = y - GetParam().low <= 0.01 && y + GetParam().high >= -0.01;
        const taut_events e = events_of(world);
        EXPECT_EQ(e.sensor_enter_count, now && !inside ? 1u : 0u) << y;
        EXPECT_EQ(e.sensor_leave_count, !now && inside ? 1u : 0u) << y;
        for (uint32_t k = 0; k < e.sensor_enter_count; ++k, ++entered) {
            taut_cloth named{};
            ok(taut_body_get_cloth(e.sensor_enter[k].visitor_body, &named));
            EXPECT_EQ(named.bits, cloth.bits);
        }
        inside = now;
    }
    EXPECT_EQ(entered, 1);
}

// What is wholly within a solid, far from its vertices, is met as well; just beside it not.
TEST(SoftSensors, MeetTheInsideOfASolid) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const taut_solid solid = make_solid(world, {}, 2, 1);
    taut_body within{}, beside{};
    for (auto& [body, at] : {std::pair<taut_body&, Vec>{within, {0.11, 0.2, -0.07}}, {beside, {0.65, 0.2, -0.07}}}) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.kind = TAUT_BODY_STATIC;
        def.position = at.pos();
        def.shape = world.sphere(0.05);
        def.collider_flags = TAUT_COLLIDER_SENSOR;
        ok(taut_world_add_body(world.handle, &def, &body));
    }
    world.step();
    const taut_events e = events_of(world);
    ASSERT_EQ(e.sensor_enter_count, 1u);
    EXPECT_EQ(e.sensor_enter[0].sensor_body.bits, within.bits);
    taut_solid named{};
    ok(taut_body_get_solid(e.sensor_enter[0].visitor_body, &named));
    EXPECT_EQ(named.bits, solid.bits);
    taut_collider found[4];
    uint32_t count = 0;
    ok(taut_collider_get_overlaps(collider_of(within), found, 4, &count));
    EXPECT_EQ(count, 1u);
    ok(taut_solid_remove(solid));
    world.step();
    EXPECT_EQ(events_of(world).sensor_leave_count, 1u);
}

}  // namespace
}  // namespace lab
