// Scenes in which cloth, gas and cables carry loads: what they must weigh, how they must roll.
#include "bench/crossings.h"
#include "scenes/running_scene.h"

namespace {

using namespace lab;

// Upward, of all contacts of the last substep [N].
double borne_by_contacts(const RunningScene& run) {
    uint32_t count = 0;
    taut_world_get_contacts(run.world.world, nullptr, 0, &count);
    std::vector<taut_contact> contacts(count);
    if (count > 0) ok(taut_world_get_contacts(run.world.world, contacts.data(), count, &count));
    double sum = 0;
    for (const taut_contact& c : contacts)
        sum += std::abs(static_cast<double>(c.normal_impulse) * static_cast<double>(c.normal.y));
    return sum * run.scene.world.substeps / static_cast<double>(run.scene.world.time_step);
}

struct Heights {
    double low = INFINITY, high = -INFINITY;  // [m]
};
Heights heights_of(const std::vector<taut_body>& vertices) {
    Heights out;
    for (const taut_body v : vertices) {
        const double y = position(v).y;
        out.low = std::min(out.low, y);
        out.high = std::max(out.high, y);
    }
    return out;
}

constexpr int kTyreFrames = 60, kHub = 3;  // before it is led on; ground, bar, load, hub

// On level ground contacts bear all that the bar does not lead; the axle stands nearer to the ground than to the top.
TEST(Tyre, BearsItsLoad) {
    RunningScene run("tyre");
    double borne = 0, weight = 0;
    for (int frame = 0; frame < kTyreFrames; ++frame) {
        run.step();
        if (frame >= kTyreFrames / 2) borne += borne_by_contacts(run) / (kTyreFrames / 2);
    }
    for (const taut_body body : run.everything()) {
        taut_body_kind kind{};
        ok(taut_body_get_kind(body, &kind));
        if (kind == TAUT_BODY_DYNAMIC || kind == TAUT_BODY_PARTICLE) weight += kG * mass_of(body).mass;
    }
    EXPECT_NEAR(borne / weight, 1, 0.02) << weight << " N";
    const Heights tyre = heights_of(run.world.cloth_vertices[0]);
    const double axle = run.body(kHub).position.y;
    EXPECT_LT(axle - tyre.low, 0.99 * (tyre.high - axle));
    EXPECT_LT(run.joint_error(), 1e-3);
}

// It turns as a wheel between its free and its pressed radius.
TEST(Tyre, Rolls) {
    RunningScene run("tyre");
    double turned = 0, before = 0, way = 0, pressed = 0, free = 0;
    constexpr int kFirst = 120, kLast = 150;  // led at an even speed, before the plank
    for (int frame = 0; frame < kLast; ++frame) {
        run.step();
        const BodyState hub = run.body(kHub);
        if (frame >= kFirst) {
            const Heights tyre = heights_of(run.world.cloth_vertices[0]);
            turned -= hub.spin.z * static_cast<double>(run.scene.world.time_step);
            way += hub.position.x - before;
            pressed += (hub.position.y - tyre.low) / (kLast - kFirst);
            free += (tyre.high - hub.position.y) / (kLast - kFirst);
        }
        before = hub.position.x;
    }
    const double half = static_cast<double>(run.scene.cloths[0].def.thickness) / 2;
    EXPECT_GT(way / turned, pressed);
    EXPECT_LT(way / turned, free + half);
    RecordProperty("rolling_radius_m", std::to_string(way / turned));
}

// A sheet that both ends turn into a rope, stretched to twice its length, goes through itself in few places, never for
// long: counted in double precision by a test of its own.
TEST(SweptTwist, ComesApartWhereItCrosses) {
    scenes::Options options;
    options.swept = true;
    RunningScene run(scenes::make_scene("cloth_twist", options));
    std::vector<std::array<uint32_t, 3>> faces;
    const std::vector<uint32_t>& corner = run.scene.cloths[0].triangles;
    for (size_t i = 0; i < corner.size(); i += 3) faces.push_back({corner[i], corner[i + 1], corner[i + 2]});
    ASSERT_FALSE(faces.empty());
    size_t most = 0, last = 0;
    constexpr int kFrames = 300, kEvery = 10, kMost = 20;
    for (int frame = 1; frame <= kFrames; ++frame) {
        run.step();
        if (frame % kEvery != 0) continue;
        std::vector<taut_pos> points;
        for (const taut_body v : run.world.cloth_vertices[0]) {
            const Vec x = position(v);
            points.push_back({x.x, x.y, x.z});
        }
        const bench::Skin skin{points, faces, {}};
        last = bench::count_crossings(std::span(&skin, 1)).own[0];
        most = std::max(most, last);
    }
    EXPECT_LE(most, kMost);
    EXPECT_EQ(last, 0u);
    EXPECT_TRUE(run.sound());
}

// The cable bears bag, hook and rocks, none of which is lost.
TEST(Sack, HangsOnItsCable) {
    RunningScene run("sack");
    for (int frame = 0; frame < 360; ++frame) run.step();
    double tension = 0, weight = 0;
    constexpr int kAveraged = 60;
    for (int frame = 0; frame < kAveraged; ++frame) {
        run.step();
        uint32_t count = 0;
        taut_cable_get_tensions(run.world.cables[0], nullptr, 0, &count);
        std::vector<float> tensions(count);
        ok(taut_cable_get_tensions(run.world.cables[0], tensions.data(), count, &count));
        tension += static_cast<double>(tensions.front()) / kAveraged;  // next to the hook
    }
    for (const int i : run.scene.roles.pile) weight += kG * mass_of(run.world.bodies[static_cast<size_t>(i)]).mass;
    for (const taut_body v : run.world.cloth_vertices[0]) weight += kG * mass_of(v).mass;
    weight += kG * mass_of(run.world.bodies[1]).mass;  // the hook
    EXPECT_NEAR(tension / weight, 1, 0.02) << weight << " N";
    const Heights bag = heights_of(run.world.cloth_vertices[0]);
    EXPECT_GT(bag.low, 0.5);
    for (const int i : run.scene.roles.pile) {
        const double y = run.body(static_cast<size_t>(i)).position.y;
        EXPECT_GT(y, bag.low) << "rock " << i;
        EXPECT_LT(y, bag.high) << "rock " << i;
    }
}

}  // namespace
