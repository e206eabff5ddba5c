// Ties that close a loop through what is soft: a loop by elements is none of the ties', and hinders no direct solve.
#include "physics/attachment_lab.h"
#include "physics/joint_lab.h"

namespace {

using namespace lab;

struct LoopCase {
    bool cloth, swept;
    double hz;
};

class SoftLoop : public testing::TestWithParam<LoopCase> {
public:
    static std::vector<LoopCase> cases() {
        std::vector<LoopCase> out;
        for (const bool cloth : {false, true})
            for (const bool swept : {false, true})
                for (const double hz : {30.0, 60.0, 120.0, 240.0}) out.push_back({cloth, swept, hz});
        return out;
    }

protected:
    // A beam along x, or a taut sheet in its place, held at both ends; vertices along its middle.
    struct Held {
        std::vector<taut_body> bodies;
        std::vector<Vec> places;
        uint32_t one = 0, two = 0, middle = 0;  // on a line along x
    };
    static Held add_held(const World& world) {
        const auto solve = GetParam().swept ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
        Held out;
        if (GetParam().cloth) {
            const Sheet sheet(9, 3, 0.8, 0.2, 1);
            taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
            def.area_density = 5;
            def.filter.mask = 0;
            def.solve = solve;
            def.damping = 0.01f;
            const taut_cloth cloth = add(world, def);
            for (int k = 0; k < 3; ++k)
                for (const int i : {0, 8}) ok(taut_cloth_pin(cloth, sheet.at(i, k), 1));
            out = {bodies_of(cloth), points_of(cloth), sheet.at(2, 1), sheet.at(6, 1), sheet.at(4, 1)};
        } else {
            const Beam beam({0.8, 0.1, 0.1}, 9, 3, 3, false);
            taut_solid_def def = beam.def(TAUT_SOLID_NEO_HOOKEAN, 1e6, 0.3);
            def.filter.mask = 0;
            def.solve = solve;
            def.damping = 0.02f;
            const taut_solid solid = add(world, def);
            beam.hold(solid);
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) ok(taut_solid_pin(solid, beam.at(8, j, k), 1));
            out = {bodies_of(solid), points_of(solid), beam.at(2, 1, 1), beam.at(6, 1, 1), beam.at(4, 1, 1)};
        }
        return out;
    }
    static World world_of() {
        return World([](taut_world_def& def) { def.time_step = static_cast<float>(1 / GetParam().hz); });
    }
    static void settle(const World& world, double time) {
        for (int i = 0; i < static_cast<int>(time * GetParam().hz); ++i) world.step();
    }
    // The lowest that a vertex is below its place.
    static double sink(const Held& held) {
        double most = 0;
        for (size_t v = 0; v < held.bodies.size(); ++v)
            most = std::max(most, held.places[v].y - position(held.bodies[v]).y);
        return most;
    }
    // How far it sinks by its weight, with nothing on it.
    static double sink_alone() {
        const World world = world_of();
        const Held held = add_held(world);
        settle(world, 1);
        return sink(held);
    }
};
INSTANTIATE_TEST_SUITE_P(Of, SoftLoop, testing::ValuesIn(SoftLoop::cases()), [](const auto& each) {
    return std::string(each.param.cloth ? "Cloth" : "Solid") + (each.param.swept ? "Swept" : "Direct") + "At" +
           std::to_string(static_cast<int>(each.param.hz)) + "Hz";
});

// A light body hangs on two vertices by rods in a line, or by balls: rows that are alike on it alone are told apart by
// what gives way at their other ends.
TEST_P(SoftLoop, OfRodsInALineThroughOneBodyIsHeld) {
    const double alone = sink_alone();
    for (const bool balls : {false, true}) {
        const World world = world_of();
        const Held held = add_held(world);
        const Vec between = 0.5 * (held.places[held.one] + held.places[held.two]);
        std::vector<taut_joint> joints;
        if (balls) {
            const taut_body bar = world.add({.position = between, .mass = 0.02, .inertia = {1e-5, 1e-3, 1e-3}});
            for (const uint32_t end : {held.one, held.two})
                joints.push_back(world.ball(bar, held.places[end] - between, held.bodies[end], {}));
        } else {
            const taut_body knot = world.particle(0.001, between);
            for (const uint32_t end : {held.one, held.two})
                joints.push_back(world.rod(held.bodies[end], {}, knot, {}, 0.2));
        }
        settle(world, 1);
        EXPECT_LE(sink(held), 1.3 * alone + 2e-4) << (balls ? "bar" : "rods");
        for (const taut_joint joint : joints) EXPECT_LE(error(joint), 1e-4) << (balls ? "bar" : "rods");
    }
}

// Cables of rods and attachments from vertex to vertex, straight at the start.
TEST_P(SoftLoop, OfACableThatIsStraightIsHeld) {
    const double alone = sink_alone();
    for (const bool attached : {false, true}) {
        const World world = world_of();
        const Held held = add_held(world);
        taut_cable_def def;
        taut_cable_def_init(&def);
        def.kind = TAUT_CABLE_PARTICLES;
        const taut_pos path[2] = {held.places[held.one].pos(), held.places[held.two].pos()};
        def.points = path;
        def.point_count = 2;
        def.segment_count = 6;
        def.mass_per_metre = 0.02f;
        def.diameter = 0.006f;
        def.filter.mask = 0;
        taut_cable cable{};
        if (!attached) {
            for (int end = 0; end < 2; ++end) {
                def.end[end].attached = 1;
                def.end[end].body = held.bodies[end == 0 ? held.one : held.two];
            }
            ok(taut_world_add_cable(world.handle, &def, &cable));
        } else {
            ok(taut_world_add_cable(world.handle, &def, &cable));
            uint32_t count = 0;
            taut_cable_get_bodies(cable, nullptr, 0, &count);
            std::vector<taut_body> knots(count);
            ok(taut_cable_get_bodies(cable, knots.data(), count, &count));
            const uint32_t vertex[2] = {held.one, held.two};
            for (size_t end = 0; end < 2; ++end)
                attach(world, anchor_of({knots[end == 0 ? 0 : count - 1]}, {1}),
                       anchor_of({held.bodies[vertex[end]]}, {1}));
        }
        settle(world, 1);
        EXPECT_LE(sink(held), 1.3 * alone + 2e-3) << (attached ? "attached" : "tied");
        EXPECT_LE(world.profile().joint_error, 1e-3f);
    }
}

// A body welded by attachments whose weights are next to nothing on all vertices but one.
TEST_P(SoftLoop, OfAttachmentsWithSlightWeightsIsHeld) {
    const double alone = sink_alone();
    const World world = world_of();
    const Held held = add_held(world);
    const Vec between = 0.5 * (held.places[held.one] + held.places[held.two]);
    const taut_body bar = world.add({.position = between, .mass = 0.02, .inertia = {1e-5, 1e-3, 1e-3}});
    for (const uint32_t end : {held.one, held.two})
        attach(world, anchor_of({held.bodies[held.middle], held.bodies[end]}, {1e-7, 1 - 1e-7}),
               anchor_on(world, bar, held.places[end]));
    settle(world, 1);
    EXPECT_LE(sink(held), 1.3 * alone + 2e-4);
    EXPECT_LE(world.profile().joint_error, 1e-4f);
}

// Strain is no error of a joint: what elements stretch by is not counted, what a rod is off by is.
TEST(JointError, KnowsNoStrain) {
    const World world;
    const Beam beam({0.4, 0.1, 0.1}, 5, 2, 2, false);
    taut_solid_def def = beam.def(TAUT_SOLID_NEO_HOOKEAN, 2e4, 0.3);
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    const Sheet sheet(5, 5, 1, 1, 3);
    taut_cloth_def soft = sheet.def(TAUT_CLOTH_LINKS);
    soft.stretch_compliance[0] = soft.stretch_compliance[1] = 0.01f;
    soft.filter.mask = 0;
    ok(taut_cloth_pin(add(world, soft), 0, 1));
    const taut_body bob = world.particle(1, {0.4, -1, 0});
    const taut_joint rod = world.rod(bodies_of(solid)[beam.at(4, 0, 0)], {}, bob, {}, 1);
    for (int i = 0; i < 30; ++i) {
        world.step();
        EXPECT_LE(world.profile().joint_error, 2e-3f) << i;
        EXPECT_NEAR(static_cast<double>(world.profile().joint_error), error(rod), 1e-6);
    }
}

}  // namespace
