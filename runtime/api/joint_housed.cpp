// Joints with a third end, the housing: gears, racks, pulleys.
#include "api/joint_make.h"

using namespace taut;

namespace {

constexpr Range kRatio{1e-4, 1e4};

template <class Def>
void init_housed(Def& def) {
    def = {};
    def.struct_size = sizeof def;
    def.solve = TAUT_JOINT_SOLVE_BY_LOAD;
    if constexpr (kFramed<Def>)
        for (taut_frame* frame : {&def.frame_a, &def.frame_b, &def.housing_frame_a, &def.housing_frame_b})
            frame->rotation = kUnturned;
}

// What a def says of the housing, as frames.
template <class Def>
std::array<taut_frame, 2> guides_of(const Def& def) {
    if constexpr (kFramed<Def>)
        return {def.housing_frame_a, def.housing_frame_b};
    else
        return {taut_frame{def.sheave_a, kUnturned}, taut_frame{def.sheave_b, kUnturned}};
}

const EndNames* housing_names(const JointKind& kind) { return kind.framed ? kHousingNames : kSheaveNames; }

Check& check_guides(Check& check, const EndNames* names, const std::array<taut_frame, 2>& guides) {
    for (size_t side = 0; side < 2; ++side) {
        check.bounded(names[side].position, guides[side].position, kPosition);
        if (*names[side].rotation != 0) check.rotation(names[side].rotation, guides[side].rotation);
    }
    return check;
}

// Both places on a housing whose node is known.
bool place_guides(Check& check, const World& world, const JointKind& kind, const EndNames* names,
                  const std::array<taut_frame, 2>& guides, JointEnd (&out)[2]) {
    for (size_t side = 0; side < 2; ++side) {
        const uint32_t node = out[side].node;
        const bool is_point = node != kNone && world.nodes.info[node].kind == NodeKind::particle;
        if (!check.require(!is_point, "housing is a particle") ||
            !place_end(check, world, kind, names[side], guides[side], out[side]))
            return false;
    }
    return true;
}

template <class Def>
taut_result find_three_ends(Check& check, const World& world, const JointKind& kind, const Def& def,
                            JointEnd (&ends)[2], JointEnd (&guides)[2]) {
    taut_result found = place_ends(check, world, kind, def, ends);
    if (found != TAUT_OK) return found;
    if (def.housing.bits != 0) {
        found = find_body(check.call(), "housing", world, def.housing, guides[0].node);
        if (found != TAUT_OK) return found;
    }
    guides[1].node = guides[0].node;
    if (!place_guides(check, world, kind, housing_names(kind), guides_of(def), guides)) return check.result();
    const uint32_t a = ends[0].node, b = ends[1].node, housing = guides[0].node;
    check
        .require(
            moves_by_forces(world, ends[0]) || moves_by_forces(world, ends[1]) || moves_by_forces(world, guides[0]),
            "body_a, body_b and housing: none is dynamic or a particle")
        .require(a != housing && b != housing && (a != b || a == kNone),
                 "of body_a, body_b and housing two are the same");
    return check.result();
}

// set(joint): what this kind alone has.
template <class Def, class CheckOwn, class Set>
taut_result add_housed(const char* call, taut_world handle, taut_joint_kind which, const Def* given, void (*init)(Def*),
                       taut_joint* out, CheckOwn&& check_own, Set&& set) {
    Check check(call);
    Def def;
    const JointKind& kind = joint_kind(which);
    if (!check_def(check, given, init, &def, out)) return check.result();
    if (!check_guides(check, housing_names(kind), guides_of(def))) return check.result();
    check_own(check, def);
    if (!check) return check.result();
    return with_world(call, handle, Use::write, [&](World& world) {
        JointEnd ends[2], guides[2];
        const taut_result found = find_three_ends(check, world, kind, def, ends, guides);
        if (found != TAUT_OK) return found;
        Joint joint = make_joint(kind, def, ends);
        joint.node[2] = guides[0].node;
        write_housing(joint, kind, guides[0], guides[1]);
        set(check, world, def, joint);
        return check ? add_joint(check, world, joint, out) : check.result();
    });
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
    return add_housed(
        call, handle, which, given, init, out, [](Check& check, const Def& def) { check_gear_ratio(check, def.ratio); },
        [](Check&, const World& world, const Def& def, Joint& joint) { mesh(world, joint, def.ratio); });
}

// Rope or rod, with its length.
void set_pulley(Check& check, const World& world, const taut_pulley_joint_def& def, Joint& joint) {
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
        own.solve = TAUT_JOINT_SOLVE_DIRECT;
    });
}
void taut_rack_pinion_joint_def_init_sized(taut_rack_pinion_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_rack_pinion_joint_def& own) {
        init_housed(own);
        own.ratio = 1;
    });
}
void taut_pulley_joint_def_init_sized(taut_pulley_joint_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_pulley_joint_def& own) {
        init_housed(own);
        own.collide_connected = 1;
        own.ratio = 1;
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
    const auto check_own = [](Check& check, const taut_pulley_joint_def& own) {
        check.number("ratio", own.ratio, kRatio)
            .zero_or("length", own.length, kJointLength)
            .boolean("rigid", own.rigid);
    };
    return add_housed(__func__, world, TAUT_JOINT_PULLEY, def, taut_pulley_joint_def_init, out, check_own, set_pulley);
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
    const std::array<taut_frame, 2> frames = {*frame_a, *frame_b};
    if (!check_guides(check, kFrameNames, frames)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Joint& joint = world.joints.record[index];
        const JointKind& kind = kind_of(joint);
        if (!kind.housed) return refuse_unhoused(check.call(), joint);
        JointEnd guides[2];
        guides[0].node = guides[1].node = joint.node[2];
        if (!place_guides(check, world, kind, kFrameNames, frames, guides)) return check.result();
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
