#include "api/joint_make.h"

#include "models/bodies.h"

namespace taut {
namespace {

bool moves_by_forces(const World& world, const JointEnd& end) {
    return end.node != kNone && moves_by_forces(world.nodes.info[end.node].kind);
}

// A field in metres or newtons, or in radians or newton metres, of a kind that holds such a motion or not.
struct HeldField {
    const char* name;
    float taut_joint_base::*value;
    Range range;
};
constexpr HeldField kAngleFields[] = {{"angular_compliance", &taut_joint_base::angular_compliance, kCompliance},
                                      {"angular_damping", &taut_joint_base::angular_damping, kDamping},
                                      {"break_torque", &taut_joint_base::break_torque, kJointForce}};
constexpr HeldField kPointFields[] = {{"compliance", &taut_joint_base::compliance, kCompliance},
                                      {"damping", &taut_joint_base::damping, kDamping},
                                      {"break_force", &taut_joint_base::break_force, kJointForce}};

// What the joint holds nothing by would be of no effect.
void check_held(Check& check, const taut_joint_base& base, std::span<const HeldField> fields, bool holds,
                const char* why) {
    for (const HeldField& field : fields) {
        const float value = base.*field.value;
        holds ? check.number(field.name, value, field.range) : check.zero(field.name, value, why);
    }
}

// Ends a and b, whatever they are.
taut_result place_bodies(Check& check, const World& world, const JointKind& kind, const taut_joint_base& base,
                         JointEnd (&ends)[2]) {
    const struct {
        const char* name;
        taut_body body;
        const taut_frame& frame;
    } given[2] = {{"base.body_a", base.body_a, base.frame_a}, {"base.body_b", base.body_b, base.frame_b}};
    for (int i = 0; i < 2; ++i) {
        JointEnd& end = ends[i];
        if (given[i].body.bits != 0) {
            const taut_result found = find_body(check.call(), given[i].name, world, given[i].body, end.node);
            if (found != TAUT_OK) return found;
        }
        check.require(!kind.framed || !is_point(world, end.node),
                      "an end is a particle, which only ball and distance joints and pulleys take");
        place_end(check.within("base."), world, kFrameNames[i], given[i].frame, end).within("");
        if (!check) return check.result();
    }
    return TAUT_OK;
}

}  // namespace

Check& check_base(Check& check, const JointKind& kind, const taut_joint_base& base) {
    check.within("base.").boolean("collide_connected", base.collide_connected);
    check_frames(check, base.frame_a, base.frame_b);
    check_held(check, base, kAngleFields, holds_angles(kind), "of a joint that holds no angles");
    check_held(check, base, kPointFields, holds_points(kind), "of a joint that holds angles alone");
    check.choice("solve", base.solve, TAUT_JOINT_SOLVE_BY_LOAD);
    for (uint32_t reserved : base.reserved) check.zero("reserved", reserved);
    return check.within("");
}

taut_result place_ends(Check& check, const World& world, const JointKind& kind, const taut_joint_base& base,
                       JointPlaces& places) {
    const taut_result found = place_bodies(check, world, kind, base, places.end);
    if (found != TAUT_OK) return found;
    const JointEnd &a = places.end[0], &b = places.end[1];
    return check
        .require(moves_by_forces(world, a) || moves_by_forces(world, b),
                 "base.body_a and base.body_b: neither end is dynamic or a particle")
        .require(a.node != b.node, "base.body_a and base.body_b are the same")
        .result();
}

taut_result place_housed_ends(Check& check, const World& world, const JointKind& kind, const taut_joint_base& base,
                              taut_body housing, const taut_frame& frame_a, const taut_frame& frame_b,
                              JointPlaces& places) {
    taut_result found = place_bodies(check, world, kind, base, places.end);
    if (found != TAUT_OK) return found;
    uint32_t node = kNone;
    if (housing.bits != 0) {
        found = find_body(check.call(), "housing", world, housing, node);
        if (found != TAUT_OK) return found;
    }
    check.require(!is_point(world, node), "housing is a particle").within("housing_");
    place_guides(check, world, node, frame_a, frame_b, places.guide).within("");
    const JointEnd &a = places.end[0], &b = places.end[1];
    return check
        .require(moves_by_forces(world, a) || moves_by_forces(world, b) || moves_by_forces(world, places.guide[0]),
                 "base.body_a, base.body_b and housing: none is dynamic or a particle")
        .require(a.node != node && b.node != node && (a.node != b.node || a.node == kNone),
                 "of base.body_a, base.body_b and housing two are the same")
        .result();
}

Joint make_joint(const JointKind& kind, const taut_joint_base& base, const JointPlaces& places) {
    Joint joint;
    joint.type = kind.type;
    joint.node[0] = places.end[0].node;
    joint.node[1] = places.end[1].node;
    joint.compliance = base.compliance;
    joint.damping = base.damping;
    joint.break_force = or_never(base.break_force);
    joint.angular_compliance = base.angular_compliance;
    joint.angular_damping = base.angular_damping;
    joint.break_torque = or_never(base.break_torque);
    joint.solve = static_cast<JointSolve>(base.solve);
    joint.collide_connected = base.collide_connected != 0;
    joint.user_data = base.user_data;
    write_ends(joint, kind, places.end[0], places.end[1]);
    if (!kind.housed) return joint;
    joint.node[2] = places.guide[0].node;
    write_housing(joint, kind, places.guide[0], places.guide[1]);
    return joint;
}

taut_result add_joint(Check& check, World& world, const Joint& joint, taut_joint* out) {
    const taut_result room = room_for_joints(check.call(), world, 1);
    if (room != TAUT_OK) return room;
    reserve_pairs_of_ends(world, joint);
    const uint32_t index = world.joints.add(joint);
    world.joints.record[index].idle = is_idle(world.nodes, joint);
    if (!joint.collide_connected) forget_pairs_of_ends(world, joint);
    wake_ends(world, joint);
    *out = world.joint_handle(index);
    return TAUT_OK;
}

}  // namespace taut
