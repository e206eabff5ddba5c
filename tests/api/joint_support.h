// What the tests of joints share: two boxes that a joint of any kind connects, at a pose of which its coordinates are
// known, and every kind as a table.
#pragma once

#include <cmath>
#include <vector>

#include "support.h"

namespace taut_test {

// Every kind with frames: its def as bytes of one union would hide types, so each has its line here.
struct FramedKind {
    const char* name;
    taut_joint_kind kind;
    std::vector<bool> angular;  // of its axes
    // Adds one between two ends with these frames and otherwise defaults.
    taut_result (*add)(taut_world, taut_body a, taut_body b, const taut_frame& frame_a, const taut_frame& frame_b,
                       taut_joint* out);
};

template <class Def, void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*)>
taut_result add_framed(taut_world world, taut_body a, taut_body b, const taut_frame& frame_a, const taut_frame& frame_b,
                       taut_joint* out) {
    Def def;
    init(&def);
    def.base.body_a = a;
    def.base.body_b = b;
    def.base.frame_a = frame_a;
    def.base.frame_b = frame_b;
    return add(world, &def, out);
}

#define TAUT_TEST_FRAMED(name, kind, ...)                                                       \
    {                                                                                           \
#name, TAUT_JOINT_##kind,                                                               \
            {__VA_ARGS__ }, add_framed < taut_##name##_joint_def, taut_##name##_joint_def_init, \
             taut_world_add_##name##_joint>                                                     \
    }

inline const std::vector<FramedKind>& framed_kinds() {
    static const std::vector<FramedKind> kinds = {
        TAUT_TEST_FRAMED(fixed, FIXED),
        TAUT_TEST_FRAMED(hinge, HINGE, true),
        TAUT_TEST_FRAMED(slider, SLIDER, false),
        TAUT_TEST_FRAMED(universal, UNIVERSAL, true, true),
        TAUT_TEST_FRAMED(cylindrical, CYLINDRICAL, false, true),
        TAUT_TEST_FRAMED(cone_twist, CONE_TWIST, true, true),
        TAUT_TEST_FRAMED(six_dof, SIX_DOF, false, false, false, true, true, true),
        TAUT_TEST_FRAMED(wheel, WHEEL, false, true, true),
    };
    return kinds;
}

inline taut_frame frame(double x, double y, double z, taut_quat q = {0, 0, 0, 1}) { return {{x, y, z}, q}; }

// Two boxes of 1 m, one beside the other along x, in a world without gravity.
struct TwoBoxes {
    explicit TwoBoxes(double apart = 2) : world(make_world()) {
        EXPECT_EQ(taut_world_set_gravity(world, {0, 0, 0}), TAUT_OK);
        box = add_box(world);
        a = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, -0.5 * apart, 5, 0));
        b = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0.5 * apart, 5, 0));
    }
    ~TwoBoxes() { EXPECT_OK(taut_world_destroy(world)); }
    TwoBoxes(const TwoBoxes&) = delete;
    TwoBoxes& operator=(const TwoBoxes&) = delete;

    // A joint at the point between them about a world axis, with every coordinate at 0.
    taut_joint add(const FramedKind& kind, taut_vec3 axis = {1, 0, 0}) const {
        taut_frame fa, fb;
        EXPECT_EQ(taut_joint_frames_from_world(world, a, b, {0, 5, 0}, axis, &fa, &fb), TAUT_OK) << taut_last_error();
        taut_joint out = {0};
        EXPECT_EQ(kind.add(world, a, b, fa, fb, &out), TAUT_OK) << kind.name << ": " << taut_last_error();
        return out;
    }

    taut_world world;
    taut_shape box;
    taut_body a, b;
};

// A box of 1000 kg, 2 m beside the point of the world to which it is fixed.
inline taut_joint add_beam(taut_world world) {
    taut_fixed_joint_def def;
    taut_fixed_joint_def_init(&def);
    def.base.body_b = add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world), 2, 5, 0));
    EXPECT_OK(taut_joint_frames_from_world(world, {0}, def.base.body_b, {0, 5, 0}, {1, 0, 0}, &def.base.frame_a,
                                           &def.base.frame_b));
    taut_joint joint = {0};
    EXPECT_OK(taut_world_add_fixed_joint(world, &def, &joint));
    return joint;
}

inline taut_axis_def axis_def(taut_axis_mode mode) {
    taut_axis_def def;
    taut_axis_def_init(&def);
    def.mode = mode;
    return def;
}

}  // namespace taut_test
