#include <taut/joint.h>

#include "api/access.h"
#include "constraints/ball.h"
#include "constraints/distance.h"

using namespace taut;

namespace {

// What every joint's data begins with.
struct JointAnchors {
    Vec3 a, b;
};
static_assert(sizeof(BallData) >= sizeof(JointAnchors) && sizeof(DistanceData) >= sizeof(JointAnchors));

// A joint's data, or what it begins with. Eigen's vectors are plain numbers, though not trivially copyable by the
// letter.
template <class Data>
Data read_data(const Joint& joint) {
    static_assert(sizeof(Data) <= Joint::kDataSize && std::is_trivially_destructible_v<Data>);
    Data data;
    std::memcpy(static_cast<void*>(&data), joint.data, sizeof data);
    return data;
}

template <class Data>
void write_data(Joint& joint, const Data& data) {
    static_assert(sizeof(Data) <= Joint::kDataSize && std::is_trivially_destructible_v<Data>);
    std::memcpy(joint.data, static_cast<const void*>(&data), sizeof data);
}

struct JointKind {
    const ConstraintType* type;
    taut_joint_kind kind;
};
const JointKind kJointKinds[] = {{&kBall, TAUT_JOINT_BALL}, {&kDistance, TAUT_JOINT_DISTANCE}};

struct End {
    uint32_t node = kNone;
    Vec3 anchor = Vec3::Zero();  // as the joint's data wants it: relative to the centre of mass, or in the world
};

Pose pose_of(const World& world, uint32_t node) {
    if (node == kNone) return {};
    const NodeMotion& motion = world.nodes.motion[node];
    if (world.nodes.info[node].kind == NodeKind::particle) return {motion.x, Mat3::Identity()};
    return {motion.x, motion.q.toRotationMatrix()};
}

Vec3 world_anchor(const World& world, const End& end) {
    const Pose pose = pose_of(world, end.node);
    return pose.x + pose.R * end.anchor;
}

bool moves(const World& world, const End& end) {
    return end.node != kNone && moves_by_forces(world.nodes.info[end.node].kind);
}

template <class Def>
bool check_def(Check& check, const Def* def, taut_joint* out) {
    if (!check.pointer("def", def).pointer("out", out)) return false;
    check.struct_size(def->struct_size, sizeof *def)
        .boolean("collide_connected", def->collide_connected)
        .bounded("anchor_a", def->anchor_a, kPosition)
        .bounded("anchor_b", def->anchor_b, kPosition)
        .number("compliance", def->compliance, kCompliance)
        .number("damping", def->damping, kDamping);
    return static_cast<bool>(check);
}

taut_result find_end(Check& check, const World& world, const char* body_field, taut_body body, const char* anchor_field,
                     const taut_pos& anchor, End& out) {
    out.anchor = to_vec(anchor);
    if (body.bits == 0) return TAUT_OK;
    const taut_result found = find_body(check.call(), body_field, world, body, out.node);
    if (found != TAUT_OK) return found;
    if (world.nodes.info[out.node].kind == NodeKind::particle) {
        if (out.anchor != Vec3::Zero()) {
            return refuse(TAUT_INVALID_ARGUMENT, "%s: %s is off its particle, expected 0", check.call(), anchor_field);
        }
    } else {
        out.anchor -= world.nodes.mass[out.node].centre;
        check.vector(anchor_field, anchor, kShapeCoordinate);
    }
    return check.result();
}

template <class Def>
taut_result find_ends(Check& check, const World& world, const Def& def, End& a, End& b) {
    taut_result found = find_end(check, world, "body_a", def.body_a, "anchor_a", def.anchor_a, a);
    if (found == TAUT_OK) found = find_end(check, world, "body_b", def.body_b, "anchor_b", def.anchor_b, b);
    if (found != TAUT_OK) return found;
    check.require(moves(world, a) || moves(world, b), "body_a and body_b: neither end is dynamic or a particle");
    check.require(a.node != b.node, "body_a and body_b are the same");
    return check.result();
}

void forget_pair_of_ends(World& world, const Joint& joint) {
    if (joint.collide_connected || joint.node[0] == kNone || joint.node[1] == kNone) return;
    forget_pair(world.pairs, world.nodes, joint.node[0], joint.node[1]);
}

template <class Def, class Data>
taut_result add_joint(Check& check, World& world, const ConstraintType& type, const Def& def, const End& a,
                      const End& b, const Data& data, taut_joint* out) {
    if (!check.require(world.joints.ids.slots() < kMaxSlots, "too many joints", TAUT_LIMIT)) return check.result();
    Joint joint;
    joint.type = &type;
    joint.node[0] = a.node;
    joint.node[1] = b.node;
    joint.compliance = def.compliance;
    joint.damping = def.damping;
    joint.collide_connected = def.collide_connected != 0;
    joint.user_data = def.user_data;
    write_data(joint, data);
    if (a.node != kNone) reserve_ended(world.pairs, a.node);
    const uint32_t index = world.joints.add(joint);
    forget_pair_of_ends(world, joint);
    *out = world.joint_handle(index);
    return TAUT_OK;
}

End end_of(const Joint& joint, int end) {
    const JointAnchors anchors = read_data<JointAnchors>(joint);
    return {joint.node[end], end == 0 ? anchors.a : anchors.b};
}

// Error and Jacobian at the present poses.
struct Evaluation {
    double error[kMaxRows] = {};
    double jacobian[kMaxNodes * kMaxRows * kDof] = {};  // [node][row][6]
};

void evaluate(const World& world, const Joint& joint, Evaluation& out) {
    Pose poses[kMaxNodes];
    for (int i = 0; i < 2; ++i) poses[i] = pose_of(world, joint.node[i]);
    joint.type->evaluate(joint.data, poses, out.error, out.jacobian);
}

}  // namespace

void taut_ball_joint_def_init(taut_ball_joint_def* def) {
    if (!def) return;
    *def = {};
    def->struct_size = sizeof *def;
}

void taut_distance_joint_def_init(taut_distance_joint_def* def) {
    if (!def) return;
    *def = {};
    def->struct_size = sizeof *def;
}

taut_result taut_world_add_ball_joint(taut_world handle, const taut_ball_joint_def* def, taut_joint* out) {
    Check check(__func__);
    if (!check_def(check, def, out)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        End a, b;
        const taut_result found = find_ends(check, world, *def, a, b);
        if (found != TAUT_OK) return found;
        return add_joint(check, world, kBall, *def, a, b, BallData{a.anchor, b.anchor}, out);
    });
}

taut_result taut_world_add_distance_joint(taut_world handle, const taut_distance_joint_def* def, taut_joint* out) {
    Check check(__func__);
    if (!check_def(check, def, out)) return check.result();
    if (!check.zero_or("length", def->length, kJointLength).zero("reserved", def->reserved)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        End a, b;
        const taut_result found = find_ends(check, world, *def, a, b);
        if (found != TAUT_OK) return found;
        // Between closer points a distance has no direction.
        const double distance = (world_anchor(world, b) - world_anchor(world, a)).norm();
        check.number("distance between the anchors", distance, kJointLength);
        if (!check) return check.result();
        const double length = def->length == 0 ? distance : def->length;
        return add_joint(check, world, kDistance, *def, a, b, DistanceData{a.anchor, b.anchor, length}, out);
    });
}

taut_result taut_joint_remove(taut_joint handle) {
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        if (joint.node[0] != kNone) reserve_ended(world.pairs, joint.node[0]);
        forget_pair_of_ends(world, joint);
        world.joints.remove(index);
        return TAUT_OK;
    });
}

int32_t taut_joint_is_valid(taut_joint handle) { return is_valid(handle); }

taut_result taut_joint_get_kind(taut_joint handle, taut_joint_kind* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        for (const JointKind& known : kJointKinds) {
            if (known.type == world.joints.record[index].type) *out = known.kind;
        }
        return TAUT_OK;
    });
}

taut_result taut_joint_get_user_data(taut_joint handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = world.joints.record[index].user_data;
        return TAUT_OK;
    });
}

taut_result taut_joint_get_bodies(taut_joint handle, taut_body* body_a, taut_body* body_b) {
    Check check(__func__);
    if (!check.pointer("body_a", body_a).pointer("body_b", body_b)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        *body_a = world.body_handle(joint.node[0]);
        *body_b = world.body_handle(joint.node[1]);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_anchors(taut_joint handle, taut_pos* anchor_a, taut_pos* anchor_b) {
    Check check(__func__);
    if (!check.pointer("anchor_a", anchor_a).pointer("anchor_b", anchor_b)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        *anchor_a = to_pos(world_anchor(world, end_of(joint, 0)));
        *anchor_b = to_pos(world_anchor(world, end_of(joint, 1)));
        return TAUT_OK;
    });
}

taut_result taut_joint_get_force(taut_joint handle, taut_vec3* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        Vec3 force = Vec3::Zero();
        if (!joint.fresh) {
            // J_b^T lambda, translations only.
            Evaluation now;
            evaluate(world, joint, now);
            const int rows = joint.type->rows;
            for (int row = 0; row < rows; ++row) {
                const double* columns = now.jacobian + (rows + row) * kDof;
                force += joint.lambda[row] * Vec3(columns[0], columns[1], columns[2]);
            }
        }
        *out = to_vec3(force);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_error(taut_joint handle, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        Evaluation now;
        evaluate(world, world.joints.record[index], now);
        *out = static_cast<float>(Eigen::Map<const Eigen::Matrix<double, kMaxRows, 1>>(now.error).norm());
        return TAUT_OK;
    });
}

taut_result taut_joint_set_compliance(taut_joint handle, float compliance, float damping) {
    Check check(__func__);
    check.number("compliance", compliance, kCompliance).number("damping", damping, kDamping);
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        world.joints.record[index].compliance = compliance;
        world.joints.record[index].damping = damping;
        return TAUT_OK;
    });
}

taut_result taut_joint_set_length(taut_joint handle, float length) {
    Check check(__func__);
    if (!check.number("length", length, kJointLength)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Joint& joint = world.joints.record[index];
        if (!check.require(joint.type == &kDistance, "joint is not a distance joint")) return check.result();
        DistanceData data = read_data<DistanceData>(joint);
        data.length = length;
        write_data(joint, data);
        return TAUT_OK;
    });
}
