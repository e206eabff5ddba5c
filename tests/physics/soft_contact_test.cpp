// Contacts of soft bodies with everything: momentum, energy, friction and weight, list by list.
#include <algorithm>
#include <set>

#include "physics/soft_contact_lab.h"

namespace lab {
namespace {

// ---------------------------------------------------------------- two in free space

class SoftMeeting : public testing::TestWithParam<Meeting> {
protected:
    SoftMeeting() : world([](taut_world_def& def) { def.gravity = {0, 0, 0}; }) {
        const bool swept = GetParam().swept;
        below = GetParam().one->make(world, {.swept = swept});
        // Off the middle and off vertices: edges and faces meet.
        above =
            GetParam().other->make(world, {.at = {0.043, 0.36, -0.057}, .velocity = {0.3, -2, 0.2}, .swept = swept});
        all = below;
        all.insert(all.end(), above.begin(), above.end());
    }
    World world;
    std::vector<taut_body> below, above, all;
};
INSTANTIATE_TEST_SUITE_P(Kinds, SoftMeeting, testing::ValuesIn(meetings()),
                         [](const auto& each) { return each.param.name(); });

TEST_P(SoftMeeting, KeepsMomentumAndGainsNoEnergy) {
    const Totals before = totals(all);
    const Vec moved = totals(above).momentum;
    double most = before.kinetic;
    for (int i = 0; i < 60; ++i) {
        world.step();
        most = std::max(most, totals(all).kinetic);
    }
    const Totals after = totals(all);
    EXPECT_LE(norm(after.momentum - before.momentum), 1e-4 * norm(before.momentum));
    EXPECT_LE(most, before.kinetic * (1 + 1e-3));
    const double one = totals(below).mass, other = totals(above).mass, reduced = one * other / (one + other);
    EXPECT_GE(norm(totals(above).momentum - moved), 0.3 * 2 * reduced) << "they did not meet";
    EXPECT_TRUE(std::ranges::all_of(all, [](taut_body body) { return finite(body); }));
}

// ---------------------------------------------------------------- on a slope

struct Slide {
    const ThingKind* kind;
    bool on_cloth, swept;
};

std::vector<Slide> slides() {
    std::vector<Slide> out;
    for (const ThingKind& kind : thing_kinds()) {
        const std::string name = kind.name;
        if (name == "ball" || name == "capsule" || name == "cylinder" || name == "cone") continue;  // these roll
        for (const bool on_cloth : {false, true})
            for (const bool swept : {false, true})
                if (kind.soft || on_cloth || !swept) out.push_back({&kind, on_cloth, swept});
    }
    return out;
}

constexpr double kSlope = 0.6, kSlide = 0.3;  // tangent of the slope, friction

// A level ground, or a cloth with all vertices held, and gravity that leans towards x.
class SoftSlope : public testing::TestWithParam<Slide> {
protected:
    SoftSlope()
        : world([](taut_world_def& def) {
              const double angle = std::atan(kSlope);
              def.gravity = Vec{kG * std::sin(angle), -kG * std::cos(angle), 0}.narrow();
          }) {
        if (!GetParam().on_cloth) {
            world.add_ground(kSlide);
            return;
        }
        Sheet sheet(2, 2, 8, 8, -0.01);
        for (taut_pos& point : sheet.points) point = (Vec(point) - Vec{1, 0, 6}).pos();
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.thickness = 0.02f;
        def.material.friction = static_cast<float>(kSlide);
        def.solve = GetParam().swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
        const taut_cloth cloth = lab::add(world, def);
        for (uint32_t v = 0; v < sheet.points.size(); ++v) ok(taut_cloth_pin(cloth, v, 1));
    }
    World world;
};
INSTANTIATE_TEST_SUITE_P(Kinds, SoftSlope, testing::ValuesIn(slides()), [](const auto& each) {
    return std::string(each.param.kind->name) + (each.param.on_cloth ? "_on_cloth" : "_on_ground") +
           (each.param.swept ? "_swept" : "");
});

TEST_P(SoftSlope, SlidesByCoulombsLaw) {
    // As it lies: half of what it is high, above what carries it.
    const std::string name = GetParam().kind->name;
    const double height = name == "solid"                         ? 0.16
                          : name == "box"                         ? 0.07
                          : name == "cloth"                       ? 0.01
                          : name == "grain" || name == "particle" ? 0.05
                                                                  : 0.02;
    const std::vector<taut_body> bodies =
        GetParam().kind->make(world, {.at = {0.013, height, 0.021}, .friction = kSlide, .swept = GetParam().swept});
    const int settling = 18, measured = 24;
    world.step(settling);
    const Vec before = 1 / totals(bodies).mass * totals(bodies).momentum;
    world.step(measured);
    const Vec after = 1 / totals(bodies).mass * totals(bodies).momentum;
    const double angle = std::atan(kSlope), time = measured * world.frame();
    const double friction =
        (kG * std::sin(angle) * time - (after - before).x) / (kG * std::cos(angle) * time + (after - before).y);
    EXPECT_NEAR(friction, kSlide, 0.01 * kSlide);
    EXPECT_GT(after.x, 0.5);
}

// ---------------------------------------------------------------- what is told

// A face with its corners held, and a grain on it: one contact, which bears the grain.
TEST(SoftContacts, TellBodiesPointAndForce) {
    World world;
    Sheet sheet(2, 2, 2, 2, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    const taut_cloth cloth = lab::add(world, def);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 1));
    const taut_body grain = make_grain(world, {.at = {0.4, 0.06, 1.3}}, true);
    world.step(30);
    const std::vector<taut_contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1u);
    const taut_contact& told = contacts[0];
    const bool grain_is_b = told.body_b.bits == grain.bits;
    const taut_body other = grain_is_b ? told.body_a : told.body_b;
    EXPECT_TRUE(grain_is_b || told.body_a.bits == grain.bits);
    EXPECT_TRUE(std::ranges::any_of(bodies_of(cloth), [&](taut_body body) { return body.bits == other.bits; }));
    EXPECT_NEAR(Vec(told.normal).y, grain_is_b ? 1 : -1, 1e-5);
    EXPECT_LE(norm(Vec(told.position) - Vec(0.4, 0.01, 1.3)), 1e-3);
    EXPECT_NEAR(told.separation, 0, 1e-3);
    const double told_for = static_cast<double>(world.def.time_step) / world.def.substeps;
    EXPECT_NEAR(static_cast<double>(told.normal_impulse) / told_for, 0.5 * kG, 0.01);
    EXPECT_GE(world.profile().touching, 1u);
    ok(taut_body_remove(grain));
    EXPECT_TRUE(world.contacts().empty());
    world.step(2);
    EXPECT_TRUE(world.contacts().empty());
}

TEST(SoftContacts, OfGrainsThatWereRemovedAreNotTold) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const taut_body one = make_grain(world, {}, true);
    make_grain(world, {.at = {0.098, 0, 0}}, true);
    world.step();
    EXPECT_EQ(world.contacts().size(), 1u);
    ok(taut_body_remove(one));
    EXPECT_TRUE(world.contacts().empty());
}

// A grain asleep on a cloth that is held wakes as the cloth is let go.
TEST(SoftContacts, WakeWhatTheyCarry) {
    World world([](taut_world_def& def) { def.sleeping = 1; });
    Sheet sheet(2, 2, 2, 2, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.thickness = 0.02f;
    const taut_cloth cloth = lab::add(world, def);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 1));
    const taut_body grain = make_grain(world, {.at = {0.4, 0.06, 1.3}}, true);
    const auto sleeps = [&] {
        uint32_t awake = 0;
        ok(taut_body_get_awake(grain, &awake));
        return awake == 0;
    };
    world.step(120);
    ASSERT_TRUE(sleeps());
    const double height = position(grain).y;
    world.step(60);
    EXPECT_EQ(position(grain).y, height);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_cloth_pin(cloth, v, 0));
    world.step(30);
    EXPECT_FALSE(sleeps());
    EXPECT_LT(position(grain).y, height - 0.5);
}

// ---------------------------------------------------------------- weight

class SoftStack : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Solve, SoftStack, testing::Bool(),
                         [](const auto& each) { return each.param ? "swept" : "direct"; });

TEST_P(SoftStack, CarriesTheWeightAboveAtEveryInterface) {
    constexpr int kCubes = 3;
    constexpr double kSide = 0.3, kThick = 0.02;
    World world;
    world.add_ground();
    std::vector<std::vector<taut_body>> cubes;
    for (int i = 0; i < kCubes; ++i)
        cubes.push_back(bodies_of(make_solid(
            world, {.at = {0.02 * i, 0.5 * kThick + (0.5 + i) * kSide + i * kThick, 0.013 * i}, .swept = GetParam()}, 3,
            kSide, 3e5)));
    const auto cube_of = [&](taut_body body) {
        for (int i = 0; i < kCubes; ++i)
            for (const taut_body each : cubes[static_cast<size_t>(i)])
                if (each.bits == body.bits) return i;
        return -1;
    };
    world.step(240);
    double force[kCubes] = {};  // upward, on each cube from what is below it
    const int measured = 30;
    for (int step = 0; step < measured; ++step) {
        world.step();
        const double told = static_cast<double>(world.def.time_step) / world.def.substeps;
        for (const taut_contact& contact : world.contacts()) {
            const int a = cube_of(contact.body_a), b = cube_of(contact.body_b);
            if (a == b) continue;
            const double up = static_cast<double>(contact.normal_impulse) * Vec(contact.normal).y / told / measured;
            force[std::max(a, b)] += a < b ? up : -up;
        }
    }
    double weight = 0;
    for (int i = kCubes; i-- > 0;) {
        weight += totals(cubes[static_cast<size_t>(i)]).mass * kG;
        EXPECT_NEAR(force[i], weight, 0.02 * weight) << "below cube " << i;
    }
}

}  // namespace
}  // namespace lab
