// Lint: each finding in a world made for it, and none in a world that is well made.
#include <algorithm>
#include <set>

#include "joint_support.h"

using namespace taut_test;

namespace {

std::vector<taut_lint_entry> lint(taut_world world) {
    const Watch watch(world);
    uint32_t count = 0;
    const taut_result sized = taut_world_lint(world, nullptr, 0, &count);
    EXPECT_EQ(sized, count == 0 ? TAUT_OK : TAUT_TOO_SMALL);
    std::vector<taut_lint_entry> out(count);
    EXPECT_OK(taut_world_lint(world, out.data(), count, &count));
    EXPECT_EQ(count, out.size());
    EXPECT_TRUE(std::is_sorted(out.begin(), out.end(), [](auto& a, auto& b) { return a.kind < b.kind; }));
    EXPECT_TRUE(watch.unchanged());
    return out;
}

// The kinds found, each once.
std::set<int> kinds(taut_world world) {
    std::set<int> out;
    for (const taut_lint_entry& entry : lint(world)) out.insert(entry.kind);
    return out;
}

struct LintWorld : testing::Test {
    explicit LintWorld(taut_solver solver = TAUT_SOLVER_BLOCK_LDLT) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.solver = solver;
        EXPECT_OK(taut_world_create(&def, &world));
        box = add_box(world);
    }
    ~LintWorld() override { taut_world_destroy(world); }

    taut_body body(float mass, double x, double y, double z = 0) const {
        taut_body_def def = body_def(TAUT_BODY_DYNAMIC, box, x, y, z);
        def.mass = mass;
        return add_body(world, def);
    }
    // A ball joint halfway between two boxes.
    taut_joint ball(taut_body a, taut_body b, taut_joint_solve solve = TAUT_JOINT_SOLVE_DIRECT) const {
        taut_frame fa, fb;
        taut_pose pa = {}, pb;
        EXPECT_OK(taut_body_get_pose(b, &pb));
        if (a.bits != 0) {
            EXPECT_OK(taut_body_get_pose(a, &pa));
        }
        if (a.bits == 0) pa = pb, pa.position.y += 2;
        const taut_pos middle = {0.5 * (pa.position.x + pb.position.x), 0.5 * (pa.position.y + pb.position.y),
                                 0.5 * (pa.position.z + pb.position.z)};
        EXPECT_OK(taut_joint_frames_from_world(world, a, b, middle, {1, 0, 0}, &fa, &fb));
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_a = a;
        def.base.body_b = b;
        def.base.frame_a.position = fa.position;
        def.base.frame_b.position = fb.position;
        def.base.solve = solve;
        taut_joint out = {0};
        EXPECT_OK(taut_world_add_ball_joint(world, &def, &out));
        return out;
    }
    void steps(int count) const {
        for (int i = 0; i < count; ++i) ASSERT_OK(taut_world_step(world));
    }
    // The only finding, of this kind, about these; null: not looked at.
    void expect_only(taut_lint_kind kind, double value, taut_body about = {0}, taut_joint joint = {0}) const {
        const std::vector<taut_lint_entry> found = lint(world);
        ASSERT_EQ(found.size(), 1u) << testing::PrintToString(kinds(world));
        EXPECT_EQ(found[0].kind, kind);
        EXPECT_NEAR(found[0].value, value, 1e-3 * value);
        EXPECT_TRUE(about.bits == 0 || found[0].body.bits == about.bits);
        EXPECT_TRUE(joint.bits == 0 || found[0].joint.bits == joint.bits);
    }

    taut_world world = {0};
    taut_shape box;
};

struct SweptWorld : LintWorld {
    SweptWorld() : LintWorld(TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL) {}
};

// What the library promises to hold: a chain with a heavy weight, a stack, stops, springs, ropes and a closed loop.
TEST_F(LintWorld, FindsNothingInAWorldWellMade) {
    add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    for (int i = 0; i < 5; ++i) body(10, 0, 0.5 + i);
    taut_body last = {0};
    for (int i = 0; i < 10; ++i) {
        const taut_body next = body(i < 9 ? 1 : 1000, 10, 20 - 1.5 * i);
        ball(last, next);
        last = next;
    }
    const taut_body door = body(20, 20, 5);
    taut_hinge_joint_def hinge;
    taut_hinge_joint_def_init(&hinge);
    hinge.base.body_b = door;
    ASSERT_OK(taut_joint_frames_from_world(world, {0}, door, {19, 5, 0}, {0, 1, 0}, &hinge.base.frame_a,
                                           &hinge.base.frame_b));
    hinge.angle.mode = TAUT_AXIS_LIMITED;
    hinge.angle.lower = -1;
    hinge.angle.upper = 1;
    hinge.angle.friction = 5;
    taut_joint joint;
    ASSERT_OK(taut_world_add_hinge_joint(world, &hinge, &joint));
    taut_distance_joint_def rope;
    taut_distance_joint_def_init(&rope);
    rope.base.body_b = body(1, 30, 5);
    rope.base.frame_a.position = {30, 8, 0};
    rope.max_length = 3;
    ASSERT_OK(taut_world_add_distance_joint(world, &rope, &joint));
    taut_body ring[4];
    for (int i = 0; i < 4; ++i) ring[i] = body(1, 40 + 2 * (i == 1 || i == 2), 5, 2 * (i / 2));
    for (int i = 0; i < 4; ++i) ball(ring[i], ring[(i + 1) % 4]);
    EXPECT_TRUE(kinds(world).empty()) << testing::PrintToString(kinds(world));
    steps(60);
    EXPECT_TRUE(kinds(world).empty()) << testing::PrintToString(kinds(world));
}

TEST_F(LintWorld, BlockMassRatio) {
    const taut_body light = body(1, 0, 0);
    ball(light, body(2e4f, 0, 3));
    expect_only(TAUT_LINT_BLOCK_MASS_RATIO, 2e4, light);
}

TEST_F(LintWorld, JointMassRatio) {
    const taut_body light = body(1, 0, 0), heavy = body(20, 0, 3);
    const taut_joint joint = ball(heavy, light, TAUT_JOINT_SOLVE_SOFT);
    expect_only(TAUT_LINT_JOINT_MASS_RATIO, 20, light, joint);
    ASSERT_OK(taut_joint_set_solve(joint, TAUT_JOINT_SOLVE_DIRECT));
    EXPECT_TRUE(kinds(world).empty());
}

TEST_F(SweptWorld, JointMassRatio) {
    const taut_body light = body(1, 0, 0);
    const taut_joint joint = ball(light, body(20, 0, 3));
    expect_only(TAUT_LINT_JOINT_MASS_RATIO, 20, light, joint);
}

TEST_F(SweptWorld, ContactMassRatio) {
    add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    const taut_body light = body(1, 0, 0.5);
    body(30, 0, 1.5);
    EXPECT_TRUE(kinds(world).empty());  // they do not touch yet
    steps(5);
    expect_only(TAUT_LINT_CONTACT_MASS_RATIO, 30, light);
    // Below the heavy one it is at ease.
    ASSERT_OK(taut_world_set_gravity(world, {0, 9.81f, 0}));
    EXPECT_TRUE(kinds(world).empty());
}

TEST_F(LintWorld, LightBetweenHeavy) {
    const taut_body light = body(1, 0, 2);
    ball(body(50, 0, 5), light, TAUT_JOINT_SOLVE_SOFT);
    ball(light, body(40, 0, -1), TAUT_JOINT_SOLVE_SOFT);
    EXPECT_EQ(kinds(world), (std::set<int>{TAUT_LINT_JOINT_MASS_RATIO, TAUT_LINT_LIGHT_BETWEEN_HEAVY}));
    const taut_lint_entry last = lint(world).back();
    EXPECT_EQ(last.body.bits, light.bits);
    EXPECT_NEAR(last.value, 40, 1e-3);
}

TEST_F(LintWorld, ThinInertia) {
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, {0}, 0, 0, 0);
    def.mass = 1;
    def.inertia = {1, 1, 0.004f, 0, 0, 0};
    // The same about turned axes: R (1, 1, 0.004) R^T for 45 degrees about x.
    taut_body_def turned = def;
    turned.position.x = 5;
    turned.inertia = {1, 0.502f, 0.502f, 0, 0, 0.498f};
    const taut_body thin = add_body(world, def);
    EXPECT_TRUE(kinds(world).empty());  // without a joint nothing turns it
    ball({0}, thin);
    expect_only(TAUT_LINT_THIN_INERTIA, 250, thin);
    ball({0}, add_body(world, turned));
    ASSERT_EQ(lint(world).size(), 2u);
    EXPECT_NEAR(lint(world)[1].value, 250, 1);
}

TEST_F(SweptWorld, SoftLoad) {
    taut_body last = {0};
    taut_joint first = {0};
    for (int i = 0; i < 16; ++i) {
        const taut_body next = body(1, 0, 30 - 1.5 * i);
        const taut_joint joint = ball(last, next);
        if (i == 0) first = joint;
        last = next;
    }
    EXPECT_TRUE(kinds(world).empty());  // nothing is carried yet
    steps(120);
    const std::vector<taut_lint_entry> found = lint(world);
    ASSERT_FALSE(found.empty());
    EXPECT_EQ(found[0].kind, TAUT_LINT_SOFT_LOAD);
    EXPECT_EQ(found[0].joint.bits, first.bits);
    EXPECT_GT(found[0].value, 10);
}

TEST_F(LintWorld, SoftCompliance) {
    const taut_joint joint = ball({0}, body(1, 0, 0), TAUT_JOINT_SOLVE_SOFT);
    ASSERT_OK(taut_joint_set_compliance(joint, 1e-3f, 0));
    EXPECT_TRUE(kinds(world).empty());
    ASSERT_OK(taut_joint_set_compliance(joint, 1e-9f, 0));
    EXPECT_EQ(kinds(world), std::set<int>{TAUT_LINT_SOFT_COMPLIANCE});
    EXPECT_EQ(lint(world)[0].joint.bits, joint.bits);
}

// Welded twice, the second weld holds nothing that the first does not; a flat ring of four hinges has three rows too
// many; welds with compliance share the load.
TEST_F(LintWorld, RedundantRows) {
    const FramedKind &fixed = framed_kinds()[0], &hinge = framed_kinds()[1];
    const auto add = [&](const FramedKind& kind, taut_body a, taut_body b, taut_pos pivot) {
        taut_frame fa, fb;
        EXPECT_OK(taut_joint_frames_from_world(world, a, b, pivot, {0, 0, 1}, &fa, &fb));
        taut_joint out = {0};
        EXPECT_OK(kind.add(world, a, b, fa, fb, &out));
        return out;
    };
    const taut_body welded = body(1, 0, 0);
    add(fixed, {0}, welded, {0, 1, 0});
    const taut_joint second = add(fixed, {0}, welded, {0, -1, 0});
    expect_only(TAUT_LINT_REDUNDANT_ROWS, 6, welded, second);
    ASSERT_OK(taut_joint_set_compliance(second, 1e-6f, 0));
    ASSERT_OK(taut_joint_set_angular_compliance(second, 1e-6f, 0));
    EXPECT_TRUE(kinds(world).empty());

    // A four-bar on the world: three bars, four parallel hinges.
    const taut_body left = body(1, 10, 1), top = body(1, 11, 2), right = body(1, 12, 1);
    add(hinge, {0}, left, {10, 0, 0});
    add(hinge, left, top, {10, 2, 0});
    add(hinge, top, right, {12, 2, 0});
    EXPECT_TRUE(kinds(world).empty());
    const taut_joint closing = add(hinge, right, {0}, {12, 0, 0});
    expect_only(TAUT_LINT_REDUNDANT_ROWS, 3, right, closing);
}

TEST_F(LintWorld, JointApart) {
    const taut_body one = body(1, 0, 0);
    const taut_joint joint = ball({0}, one);
    ASSERT_OK(set_pose(one, at(0.03, 0, 0)));
    expect_only(TAUT_LINT_JOINT_APART, 0.03, {0}, joint);
    ASSERT_OK(taut_joint_set_compliance(joint, 1e-3f, 0));  // a spring may be stretched
    EXPECT_TRUE(kinds(world).empty());
}

TEST_F(LintWorld, JointLocked) {
    const taut_body one = body(1, 0, 0);
    const taut_joint joint = ball({0}, one);
    ASSERT_OK(taut_body_set_locked_axes(one, TAUT_LOCK_X | TAUT_LOCK_ROTATION));
    EXPECT_TRUE(kinds(world).empty());
    ASSERT_OK(set_pose(one, at(0, 0.03, 0)));  // closes
    EXPECT_EQ(kinds(world), std::set<int>{TAUT_LINT_JOINT_APART});
    ASSERT_OK(set_pose(one, at(0.03, 0, 0)));
    EXPECT_EQ(kinds(world), (std::set<int>{TAUT_LINT_JOINT_APART, TAUT_LINT_JOINT_LOCKED}));
    ASSERT_OK(taut_joint_set_compliance(joint, 1e-3f, 0));  // a spring may be stretched
    EXPECT_TRUE(kinds(world).empty());
}

TEST(Lint, JointsAndStopsThatJump) {
    TwoBoxes boxes;
    const taut_quat turned = {0.14943813f, 0, 0, 0.98877108f};  // 0.3 rad about x
    const taut_joint fixed = boxes.add(framed_kinds()[0]);
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0, turned)));
    EXPECT_EQ(kinds(boxes.world), std::set<int>{TAUT_LINT_JOINT_MISALIGNED});
    ASSERT_OK(taut_joint_remove(fixed));
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0)));

    taut_axis_def def = axis_def(TAUT_AXIS_LIMITED);
    def.lower = -0.1f;
    def.upper = 0.1f;
    const taut_joint hinge = boxes.add(framed_kinds()[1]);
    ASSERT_OK(taut_joint_set_axis(hinge, 0, &def));
    EXPECT_TRUE(kinds(boxes.world).empty());
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0, turned)));
    std::vector<taut_lint_entry> found = lint(boxes.world);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, TAUT_LINT_STOP_OVERRUN_ANGLE);
    EXPECT_NEAR(found[0].value, 0.2, 1e-5);
    def.lower = 0.3f;
    def.upper = 0.302f;
    ASSERT_OK(taut_joint_set_axis(hinge, 0, &def));
    EXPECT_EQ(kinds(boxes.world), std::set<int>{TAUT_LINT_NARROW_STOPS_ANGLE});
    ASSERT_OK(taut_joint_remove(hinge));

    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0)));
    const taut_joint slider = boxes.add(framed_kinds()[2]);
    ASSERT_OK(set_pose(boxes.b, at(1.5, 5, 0)));
    def.lower = -0.2f;
    def.upper = 0.2f;
    ASSERT_OK(taut_joint_set_axis(slider, 0, &def));
    found = lint(boxes.world);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, TAUT_LINT_STOP_OVERRUN);
    EXPECT_NEAR(found[0].value, 0.3, 1e-5);
    def.stop_compliance = 1e-3f;  // pushes back gently
    ASSERT_OK(taut_joint_set_axis(slider, 0, &def));
    EXPECT_TRUE(kinds(boxes.world).empty());
    def.lower = 0.5f;
    def.upper = 0.5005f;
    ASSERT_OK(taut_joint_set_axis(slider, 0, &def));
    EXPECT_EQ(kinds(boxes.world), std::set<int>{TAUT_LINT_NARROW_STOPS});
}

// Hung from the world over a drum to a load; a point of it lies on the drum's top.
struct LintCable : LintWorld, testing::WithParamInterface<taut_cable_kind> {
    LintCable() {
        taut_cylinder_def round;
        taut_cylinder_def_init(&round);
        round.radius = 0.3f;
        taut_shape drum = {0};
        EXPECT_OK(taut_world_add_cylinder(world, &round, &drum));
        taut_body_def def = body_def(TAUT_BODY_STATIC, drum);
        def.rotation = {0.70710678f, 0, 0, 0.70710678f};
        add_body(world, def);
        taut_cable_def_init(&plan);
        plan.kind = GetParam();
        plan.point_count = 3;
        plan.points = path;
        plan.segment_count = 24;
        plan.end[0].attached = 1;
        plan.end[0].anchor = path[0];
    }
    taut_cable add() const {
        taut_cable out = {0};
        EXPECT_OK(taut_world_add_cable(world, &plan, &out));
        return out;
    }
    // The only finding is of this kind, about this cable.
    void expect_of(taut_cable cable, taut_lint_kind kind, double least, double most) const {
        const std::vector<taut_lint_entry> found = lint(world);
        ASSERT_EQ(found.size(), 1u) << testing::PrintToString(kinds(world));
        EXPECT_EQ(found[0].kind, kind);
        EXPECT_GE(found[0].value, least);
        EXPECT_LE(found[0].value, most);
        taut_cable about = {0};
        EXPECT_OK(taut_body_get_cable(found[0].body, &about));
        EXPECT_EQ(about.bits, cable.bits);
    }

    taut_pos path[3] = {{-1, 0, 0}, {0, 0.31, 0}, {1, 0, 0}};
    taut_cable_def plan;
};

INSTANTIATE_TEST_SUITE_P(Of, LintCable, testing::Values(TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS),
                         [](const auto& tested) { return tested.param == TAUT_CABLE_LINKS ? "links" : "particles"; });

TEST_P(LintCable, FindsNothingInOneWellMade) {
    add();
    steps(120);
    EXPECT_TRUE(kinds(world).empty()) << testing::PrintToString(kinds(world));
}

TEST_P(LintCable, TooFewSegmentsForTheDrum) {
    plan.segment_count = 4;
    plan.diameter = 0.1f;  // long links of 2 cm would be thin bodies
    path[1].y = 0.36;
    const taut_cable cable = add();
    EXPECT_TRUE(kinds(world).empty());  // it does not touch yet
    steps(120);
    expect_of(cable, TAUT_LINT_CABLE_COARSE, 0.5236, 2);
}

TEST_P(LintCable, SegmentsShorterThanThick) {
    plan.diameter = 0.2f;
    path[0].y = path[1].y = path[2].y = 5;  // in the air
    plan.end[0].anchor = path[0];
    const taut_cable cable = add();
    expect_of(cable, TAUT_LINT_CABLE_SHORT_SEGMENTS, 2.0 / 24 / 0.2 - 1e-4, 2.0 / 24 / 0.2 + 1e-4);
}

TEST_P(LintCable, StretchesUnderItsLoad) {
    const taut_body load = body(100, 3, 2);
    plan.point_count = 0;
    plan.end[0].anchor = {3, 6, 0};
    plan.end[1] = {1, 0, load, {0, 0.5, 0}};
    plan.stretch_compliance = 2e-4f;
    plan.stretch_damping = 2000;
    const taut_cable cable = add();
    EXPECT_TRUE(kinds(world).empty());  // nothing is carried yet
    steps(300);
    // The first segment carries the load and nearly all of the cable, 1 kg/m.
    expect_of(cable, TAUT_LINT_CABLE_STRAIN, 2e-4 * 9.81 * 103.2, 2e-4 * 9.81 * 103.6);
}

// What its joints do not hold is found as of any joints.
TEST_P(LintCable, HeavierLoadThanABlockHolds) {
    plan.point_count = 0;
    plan.end[0].anchor = {3, 6, 0};
    plan.end[1] = {1, 0, body(3000, 3, 2), {0, 0.5, 0}};
    const taut_cable cable = add();
    expect_of(cable, TAUT_LINT_BLOCK_MASS_RATIO, 1e4, 1e5);
}

// ---------------------------------------------------------------- cloths and solids

struct LintSoft : LintWorld {
    static taut_solid_def solid_def(const std::vector<taut_pos>& points, const std::vector<uint32_t>& cells) {
        taut_solid_def def;
        taut_solid_def_init(&def);
        def.points = points.data();
        def.point_count = static_cast<uint32_t>(points.size());
        def.cells = cells.data();
        def.cell_count = static_cast<uint32_t>(cells.size() / 4);
        return def;
    }
    taut_solid add(const taut_solid_def& def) const {
        taut_solid out{};
        EXPECT_OK(taut_world_add_solid(world, &def, &out));
        return out;
    }
    taut_cloth add(const std::vector<taut_pos>& points, const std::vector<uint32_t>& triangles, float stiffness = 5000,
                   taut_deformable_solve solve = TAUT_DEFORMABLE_DIRECT) const {
        taut_cloth_def def;
        taut_cloth_def_init(&def);
        def.points = points.data();
        def.point_count = static_cast<uint32_t>(points.size());
        def.triangles = triangles.data();
        def.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
        def.stretch_stiffness[0] = def.stretch_stiffness[1] = stiffness;
        def.solve = solve;
        taut_cloth out{};
        EXPECT_OK(taut_world_add_cloth(world, &def, &out));
        return out;
    }
    // The one finding, of a vertex of a cloth or solid.
    taut_lint_entry only(taut_lint_kind kind) const {
        const std::vector<taut_lint_entry> found = lint(world);
        EXPECT_EQ(found.size(), 1u);
        if (found.empty()) return {};
        EXPECT_EQ(found[0].kind, kind);
        taut_cloth cloth{};
        taut_solid solid{};
        EXPECT_OK(taut_body_get_cloth(found[0].body, &cloth));
        EXPECT_OK(taut_body_get_solid(found[0].body, &solid));
        EXPECT_NE(cloth.bits | solid.bits, 0u);
        return found[0];
    }
    const std::vector<taut_pos> square = {{0, 5, 0}, {0, 5, 1}, {1, 5, 0}, {1, 5, 1}};
    const std::vector<uint32_t> halves = {0, 1, 3, 0, 3, 2};
    const std::vector<taut_pos> corner = {{0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {0, 5, 1}};
    const std::vector<uint32_t> cell = {0, 1, 2, 3};
};

TEST_F(LintSoft, FindsNothingInThoseWellMade) {
    add(square, halves);
    add(solid_def(corner, cell));
    taut_solid_def cloud = solid_def(corner, cell);
    const std::vector<taut_pos> cube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
    cloud.corners = TAUT_SOLID_MESHLESS;
    cloud.cells = nullptr, cloud.cell_count = 0;
    cloud.points = cube.data(), cloud.point_count = 8;
    add(cloud);
    EXPECT_TRUE(kinds(world).empty());
}

TEST_F(LintSoft, Slivers) {
    std::vector<taut_pos> thin = square;
    thin[1].z = thin[3].z = 0.05;  // height over hypotenuse
    add(thin, halves);
    EXPECT_NEAR(only(TAUT_LINT_SOFT_SLIVER).value, 0.05 / std::sqrt(1.0025) / std::sqrt(1.0025), 1e-6);
}
TEST_F(LintSoft, SliversOfSolids) {
    std::vector<taut_pos> flat = corner;
    flat[2].y = 5.05;
    add(solid_def(flat, cell));
    // Volume times 3 over the largest face, that of three corners across, over its longest edge.
    const double area = 0.5 * std::sqrt(1 + 2 * 0.05 * 0.05);
    EXPECT_NEAR(only(TAUT_LINT_SOFT_SLIVER).value, 3 * (0.05 / 6) / area / std::sqrt(2.0), 1e-5);
}

TEST_F(LintSoft, CellsTurnedInsideOut) {
    std::vector<taut_pos> mirrored = corner;
    mirrored[1].x = -0.5;
    taut_solid_def def = solid_def(mirrored, cell);
    def.rest = corner.data();
    add(def);
    EXPECT_NEAR(only(TAUT_LINT_SOFT_INVERTED).value, -0.5, 1e-6);
}

// w^2 of a triangle's row, over that of 64 substeps a step.
TEST_F(LintSoft, StiffnessBeyondSubsteps) {
    add(square, halves, 1e9f, TAUT_DEFORMABLE_SWEPT);
    const float value = only(TAUT_LINT_SOFT_TOO_STIFF).value;
    // Along the warp: E t/(1 - nu^2) over half a square metre pulls on masses of a third and two thirds of 0.1 kg.
    const double stiffness = 1e9 / (1 - 0.09) * 0.5, moves = 1 / (0.2 / 3) + 1 / (0.1 / 3);
    EXPECT_NEAR(value, std::sqrt(stiffness * moves) / 60 / 64, 0.01 * value);
}

TEST_F(LintSoft, Seams) {
    std::vector<taut_pos> two = square;
    two.push_back(square[1]);
    two.push_back(square[3]);
    two.push_back({0, 5, 2});
    two.push_back({1, 5, 2});
    std::vector<uint32_t> sewn = halves;
    sewn.insert(sewn.end(), {4, 6, 7, 4, 7, 5});
    add(two, sewn);
    EXPECT_EQ(only(TAUT_LINT_SOFT_SEAM).value, 0);
}

TEST_F(LintSoft, SolidsThatHangByAnEdge) {
    std::vector<taut_pos> two = corner;
    two.push_back({-1, 5, 0});
    two.push_back({0, 5, -1});
    std::vector<uint32_t> cells = cell;
    cells.insert(cells.end(), {0, 4, 2, 5});
    add(solid_def(two, cells));
    EXPECT_EQ(only(TAUT_LINT_SOFT_NOT_MANIFOLD).value, 4);
}

TEST_F(LintWorld, ArgumentsAndTexts) {
    ball(body(1, 0, 0), body(2e4f, 0, 3));
    uint32_t count = 7;
    taut_lint_entry entry;
    EXPECT_EQ(taut_world_lint(world, &entry, 1, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_lint(world, nullptr, 1, &count), TAUT_NULL_POINTER);
    EXPECT_EQ(count, 7u);
    EXPECT_EQ(taut_world_lint(world, nullptr, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 1u);
    std::set<std::string> texts;
    for (int kind = 0; kind <= TAUT_LINT_JOINT_LOCKED; ++kind)
        texts.insert(taut_lint_text(static_cast<taut_lint_kind>(kind)));
    EXPECT_EQ(texts.size(), static_cast<size_t>(TAUT_LINT_JOINT_LOCKED) + 1);
    EXPECT_FALSE(texts.contains("unknown"));
    EXPECT_STREQ(taut_lint_text(TAUT_LINT_KIND_MAX), "unknown");
}

// Out of memory at any of its allocations: a result.
TEST(Lint, RunsShortOfMemory) {
    Ledger ledger;
    Populated p(ledger.hooks());
    uint32_t count = 0;
    std::vector<taut_lint_entry> entries(64);
    for (int attempt = 0; attempt < 50; ++attempt) {
        ledger.fail_from = ledger.calls + 1 + static_cast<uint64_t>(attempt);
        ledger.fail_until = ledger.fail_from + 1;
        const taut_result result = taut_world_lint(p.world, entries.data(), 64, &count);
        if (result == TAUT_OK) return;
        ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
    }
    FAIL() << "more allocations than that are too many";
}

}  // namespace
