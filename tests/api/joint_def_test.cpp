// The defs of joints against what they forbid, and what they write by default.
#include "def_check.h"
#include "joint_support.h"

using namespace taut_test;

namespace {

struct JointRefusals : testing::Test {
    Populated p;
};

TEST_F(JointRefusals, BallJoint) {
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.body_a = p.crate;
    DefCheck check(p.world, "taut_world_add_ball_joint", taut_world_add_ball_joint);
    using Def = taut_ball_joint_def;
    check.run(def, {FIELD3(Def, anchor_a, -1e4, 1e4), FIELD3(Def, anchor_b, -1e7, 1e7), FIELD(Def, compliance, 0, 1e6),
                    FIELD(Def, damping, 0, 1e12), FIELD(Def, break_force, 0, 1e24)});
    const auto refuse = [&](taut_result code, const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, code, word);
    };
    refuse(TAUT_INVALID_ARGUMENT, "collide_connected", [](Def& d) { d.collide_connected = 2; });
    refuse(TAUT_INVALID_ARGUMENT, "solve is 3, expected [0, 2]",
           [](Def& d) { d.solve = static_cast<taut_joint_solve>(3); });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [](Def& d) { d.body_a = {0}; });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [&](Def& d) { d.body_a = p.ground; });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [&](Def& d) { d.body_a = p.lift, d.body_b = p.ground; });
    refuse(TAUT_INVALID_ARGUMENT, "same", [&](Def& d) { d.body_b = p.crate; });
    refuse(TAUT_INVALID_ARGUMENT, "anchor_a", [&](Def& d) { d.body_a = p.bob, d.anchor_a = {0, 0.1, 0}; });
    refuse(TAUT_INVALID_ARGUMENT, "anchor_b", [&](Def& d) { d.body_b = p.bob, d.anchor_b = {0, 0.1, 0}; });
}

TEST_F(JointRefusals, DistanceJoint) {
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    def.body_b = p.crate;
    def.anchor_a = {0, 5, 0};
    DefCheck check(p.world, "taut_world_add_distance_joint", taut_world_add_distance_joint);
    using Def = taut_distance_joint_def;
    check.run(
        def, {FIELD3(Def, anchor_a, -1e5, 1e5, Field::unchecked), FIELD3(Def, anchor_b, -1e4, 1e4),
              FIELD(Def, length, 1e-4, 1e6), FIELD(Def, compliance, 0, 1e6), FIELD(Def, damping, 0, 1e12),
              FIELD(Def, min_length, 1e-4, 1e6), FIELD(Def, max_length, 1e-4, 1e6, Field::or_infinite),
              FIELD(Def, frequency, 1e-3, 1e3, Field::unchecked), FIELD(Def, damping_ratio, 0, 1000),
              FIELD(Def, break_force, 0, 1e24), FIELD(Def, drive.target, -1e6, 1e6), FIELD(Def, drive.speed, -1e4, 1e4),
              FIELD(Def, drive.stiffness, 0, 0, Field::unchecked), FIELD(Def, drive.frequency, 0, 0, Field::unchecked),
              FIELD(Def, drive.damping_ratio, 0, 1000), FIELD(Def, drive.max_force, 0, 1e24, Field::or_infinite),
              FIELD(Def, friction, 0, 0, Field::unchecked)});
    const auto refuse = [&](const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, word);
    };
    taut_pose at;
    ASSERT_OK(taut_body_get_pose(p.crate, &at));
    refuse("distance", [&](Def& d) { d.anchor_a = {at.position.x, at.position.y, at.position.z + 9e-5}; });
    refuse("distance", [&](Def& d) { d.anchor_a = {at.position.x, at.position.y, at.position.z}, d.length = 1; });
    refuse("distance", [](Def& d) { d.anchor_a = {2e6, 0, 0}; });
    refuse("collide_connected", [](Def& d) { d.collide_connected = UINT32_MAX; });
    refuse("reserved", [](Def& d) { d.reserved = 1; });
    refuse("solve", [](Def& d) { d.solve = TAUT_JOINT_SOLVE_MAX; });
    refuse("min_length is above max_length", [](Def& d) { d.min_length = 3, d.max_length = 2; });
    refuse("frequency stands beside", [](Def& d) { d.frequency = 2, d.compliance = 1e-3f; });
    refuse("frequency stands beside", [](Def& d) { d.frequency = 2, d.damping = 1; });
    refuse("on a rod", [](Def& d) { d.friction = 1; });
    refuse("on a rod", [](Def& d) { d.drive.frequency = 1; });
    refuse("drive.frequency stands beside",
           [](Def& d) { d.max_length = 9, d.drive.frequency = 1, d.drive.damping = 1; });
    def.max_length = 9;
    check.run(def, {FIELD(Def, drive.stiffness, 0, 1e24), FIELD(Def, drive.damping, 0, 1e24, Field::or_infinite),
                    FIELD(Def, drive.frequency, 1e-3, 1e3), FIELD(Def, friction, 0, 1e24)});
}

// The fields that every def with frames has, and those of one of its axes where it has any.
template <class Def>
std::vector<Field> framed_fields() {
    return {FIELD3(Def, frame_a.position, -1e4, 1e4),
            FIELD3(Def, frame_b.position, -1e4, 1e4),
            FIELD(Def, frame_a.rotation.x, 0, 0, Field::unchecked),
            FIELD(Def, frame_a.rotation.w, 0, 0, Field::unchecked),
            FIELD(Def, frame_b.rotation.y, 0, 0, Field::unchecked),
            FIELD(Def, frame_b.rotation.z, 0, 0, Field::unchecked),
            FIELD(Def, compliance, 0, 1e6),
            FIELD(Def, damping, 0, 1e12),
            FIELD(Def, angular_compliance, 0, 1e6),
            FIELD(Def, angular_damping, 0, 1e12),
            FIELD(Def, break_force, 0, 1e24),
            FIELD(Def, break_torque, 0, 1e24)};
}

// Of one axis that is limited; far: how far its stops and target may be.
std::vector<Field> axis_fields(const char* name, size_t at, double far, bool swing) {
    static std::vector<std::string> names;  // texts name the field with its axis
    names.reserve(1000);
    const auto field = [&](const char* of, size_t offset, double lo, double hi, Field::Edges edges = Field::closed) {
        names.push_back(std::string(name) + "." + of);
        return Field{names.back().c_str(), at + offset, sizeof(float), lo, hi, edges};
    };
#define AXIS_FIELD(member, ...) field(#member, offsetof(taut_axis_def, member), __VA_ARGS__)
    std::vector<Field> fields = {AXIS_FIELD(stop_compliance, 0, 1e6),
                                 AXIS_FIELD(stop_damping, 0, 1e12),
                                 AXIS_FIELD(friction, 0, 1e24),
                                 AXIS_FIELD(drive.target, -far, far),
                                 AXIS_FIELD(drive.speed, -1e4, 1e4),
                                 AXIS_FIELD(drive.damping_ratio, 0, 1000),
                                 AXIS_FIELD(drive.max_force, 0, 1e24, Field::or_infinite),
                                 AXIS_FIELD(drive.stiffness, 0, 1e24),
                                 AXIS_FIELD(drive.damping, 0, 1e24, Field::or_infinite),
                                 AXIS_FIELD(drive.frequency, 1e-3, 1e3)};
    if (swing) return fields;
    const std::vector<Field> more = {AXIS_FIELD(lower, -far, far, Field::or_minus_infinite),
                                     AXIS_FIELD(upper, -far, far, Field::or_infinite)};
    fields.insert(fields.end(), more.begin(), more.end());
    return fields;
#undef AXIS_FIELD
}

const double kAngleFar = 6.2831855;  // 2 pi as a float has it

struct AxisPlace {
    const char* name;
    size_t offset;
    bool angular, swing = false;
};

template <class Def>
void hold_against(Populated& p, const char* name, void (*init)(Def*),
                  taut_result (*add)(taut_world, const Def*, taut_joint*), const std::vector<AxisPlace>& axes) {
    init(nullptr);
    Def def;
    std::memset(static_cast<void*>(&def), 0xff, sizeof def);
    init(&def);
    EXPECT_EQ(def.struct_size, sizeof def);
    EXPECT_EQ(def.frame_a.rotation.w, 1);
    EXPECT_EQ(def.break_torque, 0);
    def.body_a = p.crate;
    def.body_b = p.wedge;
    DefCheck<Def, taut_joint> check(p.world, name, add);
    const auto axis_of = [](Def& d, const AxisPlace& at) -> taut_axis_def& {
        return *reinterpret_cast<taut_axis_def*>(reinterpret_cast<unsigned char*>(&d) + at.offset);
    };
    std::vector<Field> fields = framed_fields<Def>();
    for (const AxisPlace& at : axes) {
        taut_axis_def& axis = axis_of(def, at);
        EXPECT_EQ(axis.struct_size, sizeof axis);
        EXPECT_EQ(axis.upper, INFINITY);
        axis.mode = TAUT_AXIS_LIMITED;
        const std::vector<Field> more = axis_fields(at.name, at.offset, at.angular ? kAngleFar : 1e6, at.swing);
        fields.insert(fields.end(), more.begin(), more.end());
    }
    check.run(def, fields);

    const auto refuse = [&](const std::string& word, taut_result code, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, code, word.c_str());
    };
    const taut_result invalid = TAUT_INVALID_ARGUMENT;
    refuse("collide_connected", invalid, [](Def& d) { d.collide_connected = 2; });
    refuse("reserved", invalid, [](Def& d) { d.reserved = 1; });
    refuse("solve", invalid, [](Def& d) { d.solve = static_cast<taut_joint_solve>(3); });
    refuse("same", invalid, [&](Def& d) { d.body_b = p.crate; });
    refuse("neither", invalid, [&](Def& d) { d.body_a = {0}, d.body_b = p.ground; });
    refuse("particle", invalid, [&](Def& d) { d.body_b = p.bob; });
    refuse("frame_a.rotation has length", invalid, [](Def& d) { d.frame_a.rotation.w = 0; });
    refuse("frame_b.rotation has length", invalid, [](Def& d) { d.frame_b.rotation = {0.6f, 0.6f, 0.6f, 0.6f}; });
    for (const AxisPlace& at : axes) {
        const std::string axis = at.name;
        refuse(axis + ".struct_size", TAUT_STRUCT_SIZE, [&](Def& d) { axis_of(d, at).struct_size = 4; });
        refuse(axis + ".mode", invalid, [&](Def& d) { axis_of(d, at).mode = static_cast<taut_axis_mode>(3); });
        refuse(axis + ".mode is locked", invalid,
               [&](Def& d) { axis_of(d, at).mode = TAUT_AXIS_LOCKED, axis_of(d, at).friction = 1; });
        refuse(axis + ".drive.frequency stands", invalid,
               [&](Def& d) { axis_of(d, at).drive.frequency = 1, axis_of(d, at).drive.stiffness = 1; });
        refuse(axis + ".drive.damping is infinite", invalid,
               [&](Def& d) { axis_of(d, at).drive.damping = INFINITY, axis_of(d, at).drive.stiffness = 1; });
        if (at.swing) {
            refuse(axis + ".mode is locked", invalid, [&](Def& d) { axis_of(d, at).mode = TAUT_AXIS_LOCKED; });
            refuse(axis + ".drive.target is no swing", invalid,
                   [&](Def& d) { axis_of(d, at).drive.stiffness = 1, axis_of(d, at).drive.target = -0.1f; });
            refuse(axis + ".drive.target is no swing", invalid,
                   [&](Def& d) { axis_of(d, at).drive.damping = 1, axis_of(d, at).drive.target = 3.2f; });
            refuse(axis + ".upper", invalid, [&](Def& d) { axis_of(d, at).upper = 0; });
            refuse(axis + ".upper", invalid, [&](Def& d) { axis_of(d, at).upper = 3.2f; });
            refuse(axis + ".upper", invalid, [&](Def& d) { axis_of(d, at).upper = NAN; });
            continue;
        }
        refuse(axis + ".mode is locked", invalid,
               [&](Def& d) { axis_of(d, at).mode = TAUT_AXIS_LOCKED, axis_of(d, at).drive.stiffness = 1; });
        refuse(axis + ".lower is above upper", invalid,
               [&](Def& d) { axis_of(d, at).lower = 1, axis_of(d, at).upper = 0.5f; });
        refuse(axis + ".lower", invalid, [&](Def& d) { axis_of(d, at).lower = INFINITY; });
        refuse(axis + ".upper", invalid, [&](Def& d) { axis_of(d, at).upper = -INFINITY; });
        if (at.angular) {
            refuse(axis + ".lower and upper are more than 2 pi apart", invalid,
                   [&](Def& d) { axis_of(d, at).lower = -4, axis_of(d, at).upper = 4; });
        }
    }
}

#define HOLD_AGAINST(name, ...)                                                                              \
    hold_against<taut_##name##_joint_def>(p, "taut_world_add_" #name "_joint", taut_##name##_joint_def_init, \
                                          taut_world_add_##name##_joint, {__VA_ARGS__})
#define AXIS(def, member, ...) \
    { #member, offsetof(taut_##def##_joint_def, member), __VA_ARGS__ }

TEST_F(JointRefusals, Fixed) { HOLD_AGAINST(fixed); }
TEST_F(JointRefusals, Hinge) { HOLD_AGAINST(hinge, AXIS(hinge, angle, true)); }
TEST_F(JointRefusals, Slider) { HOLD_AGAINST(slider, AXIS(slider, slide, false)); }
TEST_F(JointRefusals, Cylindrical) {
    HOLD_AGAINST(cylindrical, AXIS(cylindrical, slide, false), AXIS(cylindrical, angle, true));
}
TEST_F(JointRefusals, Universal) {
    HOLD_AGAINST(universal, AXIS(universal, angle_a, true), AXIS(universal, angle_b, true));
}
TEST_F(JointRefusals, ConeTwist) {
    HOLD_AGAINST(cone_twist, AXIS(cone_twist, swing, true, true), AXIS(cone_twist, twist, true));
}
TEST_F(JointRefusals, SixDof) {
    HOLD_AGAINST(six_dof, AXIS(six_dof, axes[0], false), AXIS(six_dof, axes[1], false), AXIS(six_dof, axes[2], false),
                 AXIS(six_dof, axes[3], true), AXIS(six_dof, axes[4], true), AXIS(six_dof, axes[5], true));
}

TEST_F(JointRefusals, Wheel) {
    HOLD_AGAINST(wheel, AXIS(wheel, suspension, false), AXIS(wheel, steering, true), AXIS(wheel, spin, true));
}

// What defs with a housing forbid of their ends and frames.
template <class Def>
void refuse_housed(Populated& p, const Def& def, DefCheck<Def, taut_joint>& check) {
    const auto refuse = [&](const char* word, auto change, taut_result code = TAUT_INVALID_ARGUMENT) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, code, word);
    };
    refuse("collide_connected", [](Def& d) { d.collide_connected = 2; });
    refuse("reserved", [](Def& d) { d.reserved = 1; });
    refuse("solve", [](Def& d) { d.solve = static_cast<taut_joint_solve>(3); });
    refuse("two are the same", [](Def& d) { d.body_b = d.body_a; });
    refuse("two are the same", [](Def& d) { d.housing = d.body_a; });
    refuse("two are the same", [](Def& d) { d.housing = d.body_b; });
    refuse("two are the same", [](Def& d) { d.body_a = d.housing = {0}; });
    refuse("none is dynamic", [&](Def& d) { d.body_a = p.ground, d.body_b = p.lift, d.housing = {0}; });
    refuse("housing is a particle", [&](Def& d) { d.housing = p.bob; });
    refuse(
        "housing", [](Def& d) { d.housing = {0x1234}; }, TAUT_STALE_HANDLE);
}

template <class Def>
std::vector<Field> geared_fields() {
    return {FIELD3(Def, frame_a.position, -1e4, 1e4),
            FIELD3(Def, frame_b.position, -1e4, 1e4),
            FIELD3(Def, housing_frame_a.position, -1e7, 1e7),
            FIELD3(Def, housing_frame_b.position, -1e7, 1e7),
            FIELD(Def, frame_a.rotation.x, 0, 0, Field::unchecked),
            FIELD(Def, frame_b.rotation.w, 0, 0, Field::unchecked),
            FIELD(Def, housing_frame_a.rotation.y, 0, 0, Field::unchecked),
            FIELD(Def, housing_frame_b.rotation.z, 0, 0, Field::unchecked),
            FIELD(Def, ratio, 1e-4, 1e4, Field::unchecked)};
}

taut_result add_any(taut_world world, const taut_gear_joint_def* def, taut_joint* out) {
    return taut_world_add_gear_joint(world, def, out);
}
taut_result add_any(taut_world world, const taut_rack_pinion_joint_def* def, taut_joint* out) {
    return taut_world_add_rack_pinion_joint(world, def, out);
}

template <class Def>
void refuse_geared(Populated& p, const Def& def, DefCheck<Def, taut_joint>& check) {
    refuse_housed(p, def, check);
    const auto refuse = [&](const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, word);
    };
    refuse("particle", [&](Def& d) { d.body_b = p.bob; });
    refuse("housing_frame_a.rotation has length", [](Def& d) { d.housing_frame_a.rotation.w = 0; });
    refuse("housing_frame_b.position", [&](Def& d) { d.housing = p.lift, d.housing_frame_b.position.y = 2e4; });
    for (const float ratio : {0.0f, 9e-5f, -9e-5f, 1.1e4f, -1.1e4f, NAN, INFINITY})
        refuse("ratio", [&](Def& d) { d.ratio = ratio; });
    for (const float ratio : {1e-4f, -1e-4f, 1e4f, -1e4f}) {
        Def good = def;
        good.ratio = ratio;
        taut_joint out;
        EXPECT_OK(add_any(p.world, &good, &out));
    }
}

TEST_F(JointRefusals, Gear) {
    using Def = taut_gear_joint_def;
    taut_gear_joint_def_init(nullptr);
    Def def;
    taut_gear_joint_def_init(&def);
    EXPECT_EQ(def.ratio, -1);
    EXPECT_EQ(def.solve, TAUT_JOINT_SOLVE_DIRECT);
    EXPECT_EQ(def.housing_frame_b.rotation.w, 1);
    def.body_a = p.crate, def.body_b = p.wedge;
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_gear_joint", taut_world_add_gear_joint);
    std::vector<Field> fields = geared_fields<Def>();
    fields.push_back(FIELD(Def, angular_compliance, 0, 1e6));
    fields.push_back(FIELD(Def, angular_damping, 0, 1e12));
    fields.push_back(FIELD(Def, break_torque, 0, 1e24));
    check.run(def, fields);
    refuse_geared(p, def, check);
}

TEST_F(JointRefusals, RackPinion) {
    using Def = taut_rack_pinion_joint_def;
    taut_rack_pinion_joint_def_init(nullptr);
    Def def;
    taut_rack_pinion_joint_def_init(&def);
    EXPECT_EQ(def.ratio, 1);
    def.body_a = p.crate, def.body_b = p.wedge;
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_rack_pinion_joint", taut_world_add_rack_pinion_joint);
    std::vector<Field> fields = geared_fields<Def>();
    fields.push_back(FIELD(Def, compliance, 0, 1e6));
    fields.push_back(FIELD(Def, damping, 0, 1e12));
    fields.push_back(FIELD(Def, break_force, 0, 1e24));
    check.run(def, fields);
    refuse_geared(p, def, check);
}

TEST_F(JointRefusals, Pulley) {
    using Def = taut_pulley_joint_def;
    taut_pulley_joint_def_init(nullptr);
    Def def;
    taut_pulley_joint_def_init(&def);
    EXPECT_EQ(def.collide_connected, 1u);
    def.body_a = p.crate, def.body_b = p.wedge;
    def.sheave_a = {0, 9, 0}, def.sheave_b = {1, 9, 0};
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_pulley_joint", taut_world_add_pulley_joint);
    check.run(def,
              {FIELD3(Def, anchor_a, -1e4, 1e4), FIELD3(Def, anchor_b, -1e4, 1e4),
               FIELD3(Def, sheave_a, -1e5, 1e5, Field::unchecked), FIELD3(Def, sheave_b, -1e5, 1e5, Field::unchecked),
               FIELD(Def, ratio, 1e-4, 1e4), FIELD(Def, length, 1e-4, 1e6), FIELD(Def, compliance, 0, 1e6),
               FIELD(Def, damping, 0, 1e12), FIELD(Def, break_force, 0, 1e24)});
    refuse_housed(p, def, check);
    const auto refuse = [&](const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, word);
    };
    refuse("rigid", [](Def& d) { d.rigid = 2; });
    refuse("ratio", [](Def& d) { d.ratio = -1; });
    refuse("anchor_a", [&](Def& d) { d.body_a = p.bob, d.anchor_a = {0, 0.1, 0}; });
    refuse("length of the rope", [](Def& d) { d.sheave_a = {2e6, 0, 0}; });
    refuse("sheave_b", [&](Def& d) { d.housing = p.lift, d.sheave_b = {0, 2e4, 0}; });
}

TEST(JointInit, TakesNullAndWritesDefaults) {
    taut_axis_def_init(nullptr);
    taut_ball_joint_def_init(nullptr);
    taut_distance_joint_def_init(nullptr);
    taut_hinge_joint_def hinge;
    taut_hinge_joint_def_init(&hinge);
    EXPECT_EQ(hinge.angle.mode, TAUT_AXIS_FREE);
    EXPECT_EQ(hinge.solve, TAUT_JOINT_SOLVE_BY_LOAD);
    taut_six_dof_joint_def six;
    taut_six_dof_joint_def_init(&six);
    EXPECT_EQ(six.axes[5].mode, TAUT_AXIS_LOCKED);
    taut_distance_joint_def rod;
    taut_distance_joint_def_init(&rod);
    EXPECT_EQ(rod.drive.max_force, INFINITY);
    EXPECT_EQ(rod.max_length, 0);
}

}  // namespace
