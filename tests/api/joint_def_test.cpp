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
    def.base.body_a = p.crate;
    DefCheck check(p.world, "taut_world_add_ball_joint", taut_world_add_ball_joint);
    using Def = taut_ball_joint_def;
    check.run(def, {FIELD3(Def, base.frame_a.position, -1e4, 1e4), FIELD3(Def, base.frame_b.position, -1e7, 1e7),
                    FIELD(Def, base.compliance, 0, 1e6), FIELD(Def, base.damping, 0, 1e12),
                    FIELD(Def, base.break_force, 0, 1e24)});
    const auto refuse = [&](taut_result code, const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, code, word);
    };
    refuse(TAUT_INVALID_ARGUMENT, "collide_connected", [](Def& d) { d.base.collide_connected = 2; });
    refuse(TAUT_INVALID_ARGUMENT, "solve is 3, expected [0, 2]",
           [](Def& d) { d.base.solve = static_cast<taut_joint_solve>(3); });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [](Def& d) { d.base.body_a = {0}; });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [&](Def& d) { d.base.body_a = p.ground; });
    refuse(TAUT_INVALID_ARGUMENT, "neither", [&](Def& d) { d.base.body_a = p.lift, d.base.body_b = p.ground; });
    refuse(TAUT_INVALID_ARGUMENT, "same", [&](Def& d) { d.base.body_b = p.crate; });
    refuse(TAUT_INVALID_ARGUMENT, "base.frame_a.position", [&](Def& d) {
        d.base.body_a = p.bob, d.base.frame_a.position = {0, 0.1, 0};
    });
    refuse(TAUT_INVALID_ARGUMENT, "base.frame_b.position", [&](Def& d) {
        d.base.body_b = p.bob, d.base.frame_b.position = {0, 0.1, 0};
    });
}

TEST_F(JointRefusals, DistanceJoint) {
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    def.base.body_b = p.crate;
    def.base.frame_a.position = {0, 5, 0};
    DefCheck check(p.world, "taut_world_add_distance_joint", taut_world_add_distance_joint);
    using Def = taut_distance_joint_def;
    check.run(
        def,
        {FIELD3(Def, base.frame_a.position, -1e5, 1e5, Field::unchecked), FIELD3(Def, base.frame_b.position, -1e4, 1e4),
         FIELD(Def, length, 1e-4, 1e6), FIELD(Def, base.compliance, 0, 1e6), FIELD(Def, base.damping, 0, 1e12),
         FIELD(Def, min_length, 1e-4, 1e6), FIELD(Def, max_length, 1e-4, 1e6, Field::or_infinite),
         FIELD(Def, frequency, 1e-3, 1e3, Field::unchecked), FIELD(Def, damping_ratio, 0, 1000),
         FIELD(Def, base.break_force, 0, 1e24), FIELD(Def, drive.target, -1e6, 1e6), FIELD(Def, drive.speed, -1e4, 1e4),
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
    refuse("distance", [&](Def& d) { d.base.frame_a.position = {at.position.x, at.position.y, at.position.z + 9e-5}; });
    refuse("distance", [&](Def& d) {
        d.base.frame_a.position = {at.position.x, at.position.y, at.position.z}, d.length = 1;
    });
    refuse("distance", [](Def& d) { d.base.frame_a.position = {2e6, 0, 0}; });
    refuse("collide_connected", [](Def& d) { d.base.collide_connected = UINT32_MAX; });
    refuse("base.reserved", [](Def& d) { d.base.reserved[3] = 1; });
    refuse("solve", [](Def& d) { d.base.solve = TAUT_JOINT_SOLVE_MAX; });
    refuse("min_length is above max_length", [](Def& d) { d.min_length = 3, d.max_length = 2; });
    refuse("frequency stands beside", [](Def& d) { d.frequency = 2, d.base.compliance = 1e-3f; });
    refuse("frequency stands beside", [](Def& d) { d.frequency = 2, d.base.damping = 1; });
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
    return {FIELD3(Def, base.frame_a.position, -1e4, 1e4),
            FIELD3(Def, base.frame_b.position, -1e4, 1e4),
            FIELD(Def, base.frame_a.rotation.x, 0, 0, Field::unchecked),
            FIELD(Def, base.frame_a.rotation.w, 0, 0, Field::unchecked),
            FIELD(Def, base.frame_b.rotation.y, 0, 0, Field::unchecked),
            FIELD(Def, base.frame_b.rotation.z, 0, 0, Field::unchecked),
            FIELD(Def, base.compliance, 0, 1e6),
            FIELD(Def, base.damping, 0, 1e12),
            FIELD(Def, base.angular_compliance, 0, 1e6),
            FIELD(Def, base.angular_damping, 0, 1e12),
            FIELD(Def, base.break_force, 0, 1e24),
            FIELD(Def, base.break_torque, 0, 1e24)};
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
    EXPECT_EQ(def.base.frame_a.rotation.w, 1);
    EXPECT_EQ(def.base.break_torque, 0);
    def.base.body_a = p.crate;
    def.base.body_b = p.wedge;
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
    refuse("collide_connected", invalid, [](Def& d) { d.base.collide_connected = 2; });
    refuse("reserved", invalid, [](Def& d) { d.reserved = 1; });
    refuse("solve", invalid, [](Def& d) { d.base.solve = static_cast<taut_joint_solve>(3); });
    refuse("same", invalid, [&](Def& d) { d.base.body_b = p.crate; });
    refuse("neither", invalid, [&](Def& d) { d.base.body_a = {0}, d.base.body_b = p.ground; });
    refuse("particle", invalid, [&](Def& d) { d.base.body_b = p.bob; });
    refuse("frame_a.rotation has length", invalid, [](Def& d) { d.base.frame_a.rotation.w = 0; });
    refuse("frame_b.rotation has length", invalid, [](Def& d) { d.base.frame_b.rotation = {0.6f, 0.6f, 0.6f, 0.6f}; });
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
    refuse("collide_connected", [](Def& d) { d.base.collide_connected = 2; });
    refuse("base.reserved", [](Def& d) { d.base.reserved[0] = 1; });
    refuse("solve", [](Def& d) { d.base.solve = static_cast<taut_joint_solve>(3); });
    refuse("two are the same", [](Def& d) { d.base.body_b = d.base.body_a; });
    refuse("two are the same", [](Def& d) { d.housing = d.base.body_a; });
    refuse("two are the same", [](Def& d) { d.housing = d.base.body_b; });
    refuse("two are the same", [](Def& d) { d.base.body_a = d.housing = {0}; });
    refuse("none is dynamic", [&](Def& d) { d.base.body_a = p.ground, d.base.body_b = p.lift, d.housing = {0}; });
    refuse("housing is a particle", [&](Def& d) { d.housing = p.bob; });
    refuse(
        "housing", [](Def& d) { d.housing = {0x1234}; }, TAUT_STALE_HANDLE);
}

template <class Def>
std::vector<Field> geared_fields() {
    return {FIELD3(Def, base.frame_a.position, -1e4, 1e4),
            FIELD3(Def, base.frame_b.position, -1e4, 1e4),
            FIELD3(Def, housing_frame_a.position, -1e7, 1e7),
            FIELD3(Def, housing_frame_b.position, -1e7, 1e7),
            FIELD(Def, base.frame_a.rotation.x, 0, 0, Field::unchecked),
            FIELD(Def, base.frame_b.rotation.w, 0, 0, Field::unchecked),
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
    refuse("particle", [&](Def& d) { d.base.body_b = p.bob; });
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
    EXPECT_EQ(def.base.solve, TAUT_JOINT_SOLVE_DIRECT);
    EXPECT_EQ(def.housing_frame_b.rotation.w, 1);
    def.base.body_a = p.crate, def.base.body_b = p.wedge;
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_gear_joint", taut_world_add_gear_joint);
    std::vector<Field> fields = geared_fields<Def>();
    fields.push_back(FIELD(Def, base.angular_compliance, 0, 1e6));
    fields.push_back(FIELD(Def, base.angular_damping, 0, 1e12));
    fields.push_back(FIELD(Def, base.break_torque, 0, 1e24));
    check.run(def, fields);
    refuse_geared(p, def, check);
}

TEST_F(JointRefusals, RackPinion) {
    using Def = taut_rack_pinion_joint_def;
    taut_rack_pinion_joint_def_init(nullptr);
    Def def;
    taut_rack_pinion_joint_def_init(&def);
    EXPECT_EQ(def.ratio, 1);
    def.base.body_a = p.crate, def.base.body_b = p.wedge;
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_rack_pinion_joint", taut_world_add_rack_pinion_joint);
    std::vector<Field> fields = geared_fields<Def>();
    fields.push_back(FIELD(Def, base.compliance, 0, 1e6));
    fields.push_back(FIELD(Def, base.damping, 0, 1e12));
    fields.push_back(FIELD(Def, base.break_force, 0, 1e24));
    check.run(def, fields);
    refuse_geared(p, def, check);
}

TEST_F(JointRefusals, Pulley) {
    using Def = taut_pulley_joint_def;
    taut_pulley_joint_def_init(nullptr);
    Def def;
    taut_pulley_joint_def_init(&def);
    EXPECT_EQ(def.base.collide_connected, 1u);
    def.base.body_a = p.crate, def.base.body_b = p.wedge;
    def.housing_frame_a.position = {0, 9, 0}, def.housing_frame_b.position = {1, 9, 0};
    DefCheck<Def, taut_joint> check(p.world, "taut_world_add_pulley_joint", taut_world_add_pulley_joint);
    check.run(def, {FIELD3(Def, base.frame_a.position, -1e4, 1e4), FIELD3(Def, base.frame_b.position, -1e4, 1e4),
                    FIELD3(Def, housing_frame_a.position, -1e5, 1e5, Field::unchecked),
                    FIELD3(Def, housing_frame_b.position, -1e5, 1e5, Field::unchecked), FIELD(Def, ratio, 1e-4, 1e4),
                    FIELD(Def, length, 1e-4, 1e6), FIELD(Def, base.compliance, 0, 1e6),
                    FIELD(Def, base.damping, 0, 1e12), FIELD(Def, base.break_force, 0, 1e24)});
    refuse_housed(p, def, check);
    const auto refuse = [&](const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, word);
    };
    refuse("rigid", [](Def& d) { d.rigid = 2; });
    refuse("ratio", [](Def& d) { d.ratio = -1; });
    refuse("base.frame_a.position", [&](Def& d) { d.base.body_a = p.bob, d.base.frame_a.position = {0, 0.1, 0}; });
    refuse("length of the rope", [](Def& d) { d.housing_frame_a.position = {2e6, 0, 0}; });
    refuse("housing_frame_b.position", [&](Def& d) { d.housing = p.lift, d.housing_frame_b.position = {0, 2e4, 0}; });
}

// Every kind, added with a base as the host filled it.
struct KindWithBase {
    const char* name;
    taut_joint_kind kind;
    bool points, angles;  // what it holds
    taut_joint_base (*defaults)();
    taut_result (*add)(taut_world, const taut_joint_base&, taut_joint*);
};

template <class Def, void (*init)(Def*)>
taut_joint_base base_of() {
    Def def;
    std::memset(static_cast<void*>(&def), 0xff, sizeof def);
    init(&def);
    return def.base;
}

template <class Def, void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*)>
taut_result add_of_base(taut_world world, const taut_joint_base& base, taut_joint* out) {
    Def def;
    init(&def);
    def.base = base;
    return add(world, &def, out);
}

#define WITH_BASE(name, kind, points, angles)                                                                       \
    KindWithBase {                                                                                                  \
#name, TAUT_JOINT_##kind, points, angles, base_of < taut_##name##_joint_def, taut_##name##_joint_def_init>, \
            add_of_base < taut_##name##_joint_def, taut_##name##_joint_def_init, taut_world_add_##name##_joint>     \
    }

const KindWithBase kKindsWithBase[] = {
    WITH_BASE(ball, BALL, true, false),
    WITH_BASE(distance, DISTANCE, true, false),
    WITH_BASE(fixed, FIXED, true, true),
    WITH_BASE(hinge, HINGE, true, true),
    WITH_BASE(slider, SLIDER, true, true),
    WITH_BASE(universal, UNIVERSAL, true, true),
    WITH_BASE(cylindrical, CYLINDRICAL, true, true),
    WITH_BASE(cone_twist, CONE_TWIST, true, true),
    WITH_BASE(six_dof, SIX_DOF, true, true),
    WITH_BASE(wheel, WHEEL, true, true),
    WITH_BASE(gear, GEAR, false, true),
    WITH_BASE(rack_pinion, RACK_PINION, true, false),
    WITH_BASE(pulley, PULLEY, true, false),
};

struct JointBase : testing::Test {
    JointBase() {
        taut_joint_base_init(&base);
        base.body_a = p.crate, base.body_b = p.wedge;
    }
    Populated p;
    taut_joint_base base;
};

TEST_F(JointBase, HasOneSetOfDefaults) {
    taut_joint_base_init(nullptr);
    std::memset(static_cast<void*>(&base), 0xff, sizeof base);
    taut_joint_base_init(&base);
    EXPECT_EQ(base.frame_b.rotation.w, 1);
    EXPECT_EQ(base.solve, TAUT_JOINT_SOLVE_BY_LOAD);
    for (const KindWithBase& each : kKindsWithBase) {
        taut_joint_base own = each.defaults();
        if (each.kind == TAUT_JOINT_GEAR) {
            EXPECT_EQ(own.solve, TAUT_JOINT_SOLVE_DIRECT);
            own.solve = base.solve;
        }
        if (each.kind == TAUT_JOINT_PULLEY) {
            EXPECT_EQ(own.collide_connected, 1u);
            own.collide_connected = base.collide_connected;
        }
        EXPECT_EQ(std::memcmp(&own, &base, sizeof base), 0) << each.name;
    }
}

TEST_F(JointBase, MakesEveryKind) {
    base.frame_a.position = {0.25, 0.5, 0};
    base.frame_b.position = {0, -0.125, 0.25};
    base.user_data = 0x123456789abcdef0u;
    base.solve = TAUT_JOINT_SOLVE_SOFT;
    for (const KindWithBase& each : kKindsWithBase) {
        taut_joint joint;
        ASSERT_EQ(each.add(p.world, base, &joint), TAUT_OK) << each.name << ": " << taut_last_error();
        taut_joint_kind kind;
        ASSERT_OK(taut_joint_get_kind(joint, &kind));
        EXPECT_EQ(kind, each.kind);
        taut_body a, b;
        ASSERT_OK(taut_joint_get_bodies(joint, &a, &b));
        EXPECT_EQ(a.bits, base.body_a.bits) << each.name;
        EXPECT_EQ(b.bits, base.body_b.bits) << each.name;
        uint64_t user_data;
        ASSERT_OK(taut_joint_get_user_data(joint, &user_data));
        EXPECT_EQ(user_data, base.user_data) << each.name;
        taut_frame frame_a, frame_b;
        ASSERT_OK(taut_joint_get_frames(joint, &frame_a, &frame_b));
        EXPECT_NEAR(frame_a.position.y, 0.5, 1e-12) << each.name;
        EXPECT_NEAR(frame_b.position.z, 0.25, 1e-12) << each.name;
    }
}

// What would be of no effect is refused with its name, what is of one is taken.
TEST_F(JointBase, RefusesWhatAKindHasNoUseFor) {
    const struct {
        const char* name;
        float taut_joint_base::*field;
        bool of_angles;
    } fields[] = {{"compliance", &taut_joint_base::compliance, false},
                  {"damping", &taut_joint_base::damping, false},
                  {"break_force", &taut_joint_base::break_force, false},
                  {"angular_compliance", &taut_joint_base::angular_compliance, true},
                  {"angular_damping", &taut_joint_base::angular_damping, true},
                  {"break_torque", &taut_joint_base::break_torque, true}};
    int refused = 0;
    for (const KindWithBase& each : kKindsWithBase) {
        for (const auto& field : fields) {
            const bool holds = field.of_angles ? each.angles : each.points;
            const std::string text = "taut_world_add_" + std::string(each.name) + "_joint: base." + field.name + " is ";
            for (const float value : {0.25f, 1e-30f, -0.25f, INFINITY, NAN}) {
                taut_joint_base given = base;
                given.*field.field = value;
                const Watch watch(p.world);
                taut_joint out = {0x1234};
                if (holds && value > 0 && value < 1) {
                    EXPECT_EQ(each.add(p.world, given, &out), TAUT_OK) << text << value << ": " << taut_last_error();
                    continue;
                }
                EXPECT_EQ(each.add(p.world, given, &out), TAUT_INVALID_ARGUMENT) << text << value;
                EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
                const bool said = contains(taut_last_error(), "expected 0 of a joint that holds");
                EXPECT_EQ(said, !holds) << taut_last_error();
                EXPECT_EQ(out.bits, 0x1234u);
                EXPECT_TRUE(watch.unchanged()) << text << value;
                refused += !holds;
            }
        }
    }
    EXPECT_EQ(refused, 5 * 3 * 5);  // values, fields, kinds
}

TEST(JointInit, TakesNullAndWritesDefaults) {
    taut_axis_def_init(nullptr);
    taut_ball_joint_def_init(nullptr);
    taut_distance_joint_def_init(nullptr);
    taut_hinge_joint_def hinge;
    taut_hinge_joint_def_init(&hinge);
    EXPECT_EQ(hinge.angle.mode, TAUT_AXIS_FREE);
    EXPECT_EQ(hinge.base.solve, TAUT_JOINT_SOLVE_BY_LOAD);
    taut_six_dof_joint_def six;
    taut_six_dof_joint_def_init(&six);
    EXPECT_EQ(six.axes[5].mode, TAUT_AXIS_LOCKED);
    taut_distance_joint_def rod;
    taut_distance_joint_def_init(&rod);
    EXPECT_EQ(rod.drive.max_force, INFINITY);
    EXPECT_EQ(rod.max_length, 0);
}

}  // namespace
