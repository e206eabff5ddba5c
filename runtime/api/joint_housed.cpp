// Joints with a third end, the housing: gears, racks, pulleys.
#include "api/joint_make.h"

using namespace taut;

namespace {

constexpr Range kRatio{1e-4, 1e4};

template <class Def>
void init_housed(Def& def) {
    def.struct_size = sizeof def;
    taut_joint_base_init(&def.base);
    def.housing_frame_a.rotation = def.housing_frame_b.rotation = kUnturned;
    def.ratio = 1;
}

Check& check_gear_ratio(Check& check, float ratio) {
    return check.number("magnitude of ratio", std::abs(ratio), kRatio);
}

// As they stand.
void mesh(const World& world, Joint& joint, float ratio) {
    GearData data = read_data<GearData>(joint);
    data.ratio = ratio;
    write_data(joint, data);
    restart(world.nodes, joint);
}

template <class Def>
taut_result add_gear(const char* call, taut_world handle, taut_joint_kind which, const Def* given, void (*init)(Def*),
                     taut_joint* out) {
    return add_by_def(
        call, handle, which, given, init, out,
        [](Check& check, const JointKind&, const Def& def) { check_gear_ratio(check, def.ratio); },
        [](Check&, const World& world, const JointKind&, const Def& def, Joint& joint) {
            mesh(world, joint, def.ratio);
        });
}

// Rope or rod, with its length.
void set_pulley(Check& check, const World& world, const JointKind&, const taut_pulley_joint_def& def, Joint& joint) {
    PulleyData data = read_data<PulleyData>(joint);
    data.ratio = def.ratio;
    write_data(joint, data);
    const double whole = read_joint(world.nodes, joint).value[0];
    if (def.length == 0) check.number("length of the rope", whole, kJointLength);
    set_length(joint, def.length > 0 ? def.length : whole);
    if (def.rigid != 0) return;
    Axis axis;
    axis.mode = AxisMode::limited;
    axis.lower = -INFINITY;
    axis.upper = 0;
    axis.limit_compliance = static_cast<float>(joint.compliance);
    axis.limit_damping = static_cast<float>(joint.damping);
    change_axis(joint, {0}, axis);
}

taut_result refuse_unhoused(const char* call, const Joint& joint) {
    return refuse(TAUT_INVALID_ARGUMENT, "%s: a %s joint has no housing", call, joint.type->name);
}

double ratio_of(const Joint& joint) {
    return joint.type == &kPulley ? read_data<PulleyData>(joint).ratio : read_data<GearData>(joint).ratio;
}

}  // namespace

void taut_gear_joint_def_init_sized(taut_gear_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_gear_joint_def& own) {
        init_housed(own);
        own.ratio = -1;
        own.base.solve = TAUT_JOINT_SOLVE_DIRECT;
    });
}
void taut_rack_pinion_joint_def_init_sized(taut_rack_pinion_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_rack_pinion_joint_def& own) { init_housed(own); });
}
void taut_pulley_joint_def_init_sized(taut_pulley_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_pulley_joint_def& own) {
        init_housed(own);
        own.base.collide_connected = 1;
    });
}

taut_result taut_world_add_gear_joint(taut_world world, const taut_gear_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_gear_joint, world, def, out);
    return add_gear(__func__, world, TAUT_JOINT_GEAR, def, taut_gear_joint_def_init, out);
}
taut_result taut_world_add_rack_pinion_joint(taut_world world, const taut_rack_pinion_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_rack_pinion_joint, world, def, out);
    return add_gear(__func__, world, TAUT_JOINT_RACK_PINION, def, taut_rack_pinion_joint_def_init, out);
}
taut_result taut_world_add_pulley_joint(taut_world world, const taut_pulley_joint_def* def, taut_joint* out) {
    TAUT_RECORD(taut_world_add_pulley_joint, world, def, out);
    const auto check_own = [](Check& check, const JointKind&, const taut_pulley_joint_def& own) {
        check.number("ratio", own.ratio, kRatio)
            .zero_or("length", own.length, kJointLength)
            .boolean("rigid", own.rigid);
    };
    return add_by_def(__func__, world, TAUT_JOINT_PULLEY, def, taut_pulley_joint_def_init, out, check_own, set_pulley);
}

taut_result taut_joint_get_housing(taut_joint handle, taut_body* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        *out = world.body_handle(kind_of(joint).housed ? joint.node[2] : kNone);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_housing_frames(taut_joint handle, taut_frame* frame_a, taut_frame* frame_b) {
    Check check(__func__);
    if (!check.pointer("frame_a", frame_a).pointer("frame_b", frame_b)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        if (!kind_of(joint).housed) return refuse_unhoused(check.call(), joint);
        *frame_a = housing_frame_of(world, joint, 0);
        *frame_b = housing_frame_of(world, joint, 1);
        return TAUT_OK;
    });
}

taut_result taut_joint_set_housing_frames(taut_joint handle, const taut_frame* frame_a, const taut_frame* frame_b) {
    TAUT_RECORD(taut_joint_set_housing_frames, handle, frame_a, frame_b);
    Check check(__func__);
    if (!check.pointer("frame_a", frame_a).pointer("frame_b", frame_b)) return check.result();
    if (!check_frames(check, *frame_a, *frame_b)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Joint& joint = world.joints.record[index];
        const JointKind& kind = kind_of(joint);
        if (!kind.housed) return refuse_unhoused(check.call(), joint);
        JointEnd guides[2];
        if (!place_guides(check, world, joint.node[2], *frame_a, *frame_b, guides)) return check.result();
        Joint moved = joint;
        write_housing(moved, kind, guides[0], guides[1]);
        restart(world.nodes, moved);
        replace_joint(world.nodes, joint, moved);
        wake_ends(world, joint);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_ratio(taut_joint handle, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        if (!kind_of(joint).housed)
            return refuse(TAUT_INVALID_ARGUMENT, "%s: a %s joint has no ratio", check.call(), joint.type->name);
        *out = to_float(ratio_of(joint));
        return TAUT_OK;
    });
}

taut_result taut_joint_set_ratio(taut_joint handle, float ratio) {
    TAUT_RECORD(taut_joint_set_ratio, handle, ratio);
    Check check(__func__);
    if (!check_gear_ratio(check, ratio)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Joint& joint = world.joints.record[index];
        if (!check.require(joint.type->restart, "joint is no gear and no rack")) return check.result();
        Joint changed = joint;
        mesh(world, changed, ratio);
        replace_joint(world.nodes, joint, changed);
        wake_ends(world, joint);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_length(taut_joint handle, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        if (!check.require(has_length(joint), "joint is no distance joint and no pulley")) return check.result();
        *out = to_float(length_of(joint));
        return TAUT_OK;
    });
}
