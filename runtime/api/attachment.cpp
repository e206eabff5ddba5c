#include <taut/attachment.h>

#include <cmath>
#include <cstdio>

#include "api/copy_out.h"
#include "api/joint_parts.h"
#include "api/sized.h"
#include "models/attachments.h"
#include "models/soft_points.h"

using namespace taut;

namespace {

constexpr Range kAnchorWeight{-8, 8};
constexpr double kAnchorSum = 1e-3;  // of weights, off 1

// "weights[2]" and the like.
struct IndexedField {
    IndexedField(const char* prefix, const char* name, uint32_t index) {
        std::snprintf(text, sizeof text, "%s%s[%u]", prefix, name, index);
    }
    char text[32];
};

bool is_particle(const World& world, uint32_t node) {
    const NodeInfo& info = world.nodes.info[node];
    return info.kind == NodeKind::particle || info.soft != kNone;
}

Check& check_sum(Check& check, const float* weights, uint32_t count, double& sum) {
    sum = 0;
    for (uint32_t n = 0; check && n < count; ++n) {
        check.number(IndexedField("", "weights", n).text, weights[n], kAnchorWeight);
        sum += static_cast<double>(weights[n]);
    }
    return check.require(!check || count == 0 || std::abs(sum - 1) <= kAnchorSum, "weights: their sum is not 1");
}

// Numbers of an anchor; scope: "a." and the like, for texts.
bool check_anchor(Check& check, const char* scope, const taut_anchor& anchor) {
    check.within(scope).count("count", anchor.count, 0, TAUT_ANCHOR_BODIES).zero("reserved", anchor.reserved);
    if (check && anchor.count == 0) check.bounded("points[0]", anchor.points[0], kPosition);
    double sum;
    if (check) check_sum(check, anchor.weights, anchor.count, sum);
    for (uint32_t n = 0; check && n < anchor.count; ++n)
        check.vector(IndexedField("", "points", n).text, anchor.points[n], kShapeCoordinate);
    check.within("");
    return static_cast<bool>(check);
}

// What checked numbers name.
taut_result find_anchor(Check& check, const World& world, const char* scope, const taut_anchor& anchor, Anchor& out) {
    out = {};
    out.count = anchor.count;
    if (anchor.count == 0) out.point[0] = to_vec(anchor.points[0]);
    double sum = 0;
    for (uint32_t n = 0; n < anchor.count; ++n) sum += static_cast<double>(anchor.weights[n]);
    for (uint32_t n = 0; n < anchor.count; ++n) {
        const IndexedField field(scope, "bodies", n);
        uint32_t node = kNone;
        const taut_result found = find_body(check.call(), field.text, world, anchor.bodies[n], node);
        if (found != TAUT_OK) return found;
        if (!world.nodes.enabled(node))
            return refuse(TAUT_INVALID_ARGUMENT, "%s: %s is disabled", check.call(), field.text);
        for (uint32_t m = 0; m < n; ++m)
            if (out.node[m] == node)
                return refuse(TAUT_INVALID_ARGUMENT, "%s: %s is there twice", check.call(), field.text);
        out.node[n] = node;
        out.weight[n] = static_cast<double>(anchor.weights[n]) / sum;
        out.point[n] = to_vec(anchor.points[n]);
        if (!is_particle(world, node)) {
            out.point[n] -= world.nodes.mass[node].centre;
        } else if (!out.point[n].isZero(0)) {
            return refuse(TAUT_INVALID_ARGUMENT, "%s: %s is not 0 on a particle", check.call(),
                          IndexedField(scope, "points", n).text);
        }
    }
    return TAUT_OK;
}

taut_anchor to_anchor(const World& world, const Anchor& from) {
    taut_anchor out{};
    out.count = from.count;
    if (from.count == 0) out.points[0] = to_pos(from.point[0]);
    for (uint32_t n = 0; n < from.count; ++n) {
        out.bodies[n] = world.body_handle(from.node[n]);
        const bool turns = !is_particle(world, from.node[n]);
        out.points[n] = to_pos(turns ? Vec3(from.point[n] + world.nodes.mass[from.node[n]].centre) : from.point[n]);
        out.weights[n] = static_cast<float>(from.weight[n]);
    }
    return out;
}

taut_anchor anchor_on(const World& world, const uint32_t* node, const double* weight, uint32_t count) {
    taut_anchor out{};
    out.count = count;
    for (uint32_t n = 0; n < count; ++n) {
        out.bodies[n] = world.body_handle(node[n]);
        out.weights[n] = static_cast<float>(weight[n]);
    }
    return out;
}

// ---------------------------------------------------------------- add

Check& check_law(Check& check, float compliance, float damping) {
    return check.number("compliance", compliance, kCompliance).number("damping", damping, kDamping);
}

Check& check_break(Check& check, bool fixed, float force, float torque) {
    check.number("break_force", force, kJointForce).number("break_torque", torque, kJointForce);
    return check.require(!check || fixed || torque == 0, "break_torque is not 0, but nothing is fixed");
}

bool check_def(Check& check, const taut_attachment_def& def) {
    check.choice("kind", def.kind, TAUT_ATTACHMENT_FIXED);
    if (!check || !check_anchor(check, "a.", def.a) || !check_anchor(check, "b.", def.b)) return false;
    check.zero_or("length", def.length, kJointLength);
    check_law(check, def.compliance, def.damping);
    check_break(check, def.kind == TAUT_ATTACHMENT_FIXED, def.break_force, def.break_torque)
        .boolean("collide_connected", def.collide_connected)
        .choice("solve", def.solve, TAUT_JOINT_SOLVE_BY_LOAD)
        .boolean("pulls", def.pulls)
        .zero_or("limit", def.limit, kJointLength)
        .number("limit_compliance", def.limit_compliance, kCompliance)
        .require(def.kind == TAUT_ATTACHMENT_DISTANCE || (def.pulls == 0 && def.limit == 0),
                 "pulls, limit: the attachment is none at a distance");
    return static_cast<bool>(check);
}

Attachment attachment_of(const taut_attachment_def& def) {
    Attachment out;
    out.kind = static_cast<AttachmentKind>(def.kind);
    out.compliance = def.compliance;
    out.damping = def.damping;
    out.solve = static_cast<JointSolve>(def.solve);
    out.collide_connected = def.collide_connected != 0;
    out.pulls = def.pulls != 0;
    out.limit = def.limit;
    out.limit_compliance = def.limit_compliance;
    out.break_force = or_never(def.break_force);
    out.break_torque = or_never(def.break_torque);
    out.user_data = def.user_data;
    return out;
}

bool all_particles(const World& world, const Anchor& anchor) {
    return anchor.count > 0 && std::ranges::all_of(anchor.nodes(), [&](uint32_t n) { return is_particle(world, n); });
}
bool is_hard(const World& world, const Anchor& anchor) {
    return anchor.count == 0 || (anchor.count == 1 && !is_particle(world, anchor.node[0]));
}

// Which end is held where, of a fixed one.
Check& place_fixed(Check& check, const World& world, Attachment& attachment) {
    const Anchor(&end)[2] = attachment.end;
    const bool b_held = all_particles(world, end[1]) && is_hard(world, end[0]);
    const bool a_held = all_particles(world, end[0]) && is_hard(world, end[1]);
    check.require(a_held || b_held, "a, b: expected particles alone in one, a rigid body or the world in the other");
    if (!check) return check;
    attachment.held_end = b_held ? 1 : 0;
    const Anchor &soft = end[attachment.held_end], &hard = end[1 - attachment.held_end];
    for (uint32_t n = 0; n < soft.count; ++n) {
        attachment.place[n] = world.nodes.motion[soft.node[n]].x;
        if (hard.count == 0) continue;
        const Pose at = pose_of(world.nodes, hard.node[0]);
        attachment.place[n] = at.R.transpose() * (attachment.place[n] - at.x);
    }
    return check;
}

// Both as single-precision numbers: a limit may be the length that is read.
Check& check_limit(Check& check, double limit, double length) {
    return check.require(limit == 0 || static_cast<float>(limit) >= static_cast<float>(length),
                         "limit is less than the length");
}

Check& place_distance(Check& check, const World& world, float length, Attachment& attachment) {
    const double now = (point_of(world.nodes, attachment.end[1]) - point_of(world.nodes, attachment.end[0])).norm();
    attachment.length = length > 0 ? static_cast<double>(length) : now;
    check.number("distance between the anchors", now, kJointLength);
    return check_limit(check, attachment.limit, attachment.length);
}

taut_result add(Check& check, World& world, const taut_attachment_def& def, taut_attachment* out) {
    Attachment attachment = attachment_of(def);
    for (int end = 0; end < 2; ++end) {
        const taut_result found =
            find_anchor(check, world, end == 0 ? "a." : "b.", end == 0 ? def.a : def.b, attachment.end[end]);
        if (found != TAUT_OK) return found;
    }
    if (attachment.kind == AttachmentKind::fixed) place_fixed(check, world, attachment);
    if (attachment.kind == AttachmentKind::distance) place_distance(check, world, def.length, attachment);
    if (!check) return check.result();
    const AttachmentReach reach = reach_of(world, attachment);
    check.require(reach.complete, "a and b are the same point of the same bodies")
        .require(reach.moves, "a and b: no body is dynamic or a particle");
    if (!check) return check.result();
    const taut_result room = room_for_attachments(check.call(), world, 1);
    if (room == TAUT_OK) *out = world.attachment_handle(add_attachment(world, attachment));
    return room;
}

// act(world, attachment)
template <class Act>
taut_result reading(const Check& check, taut_attachment handle, Act&& act) {
    if (!check) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        act(world, world.attachments.record[index]);
        return TAUT_OK;
    });
}

float breaks_at(double threshold) { return std::isinf(threshold) ? 0 : static_cast<float>(threshold); }

// ---------------------------------------------------------------- anchors on soft bodies

template <class Handle>
taut_result anchor_of_triangle(Check& check, Handle handle, uint32_t triangle, const float* weights, taut_anchor* out) {
    if (!check.pointer("weights", weights).pointer("out", out)) return check.result();
    double sum;
    if (!check_sum(check, weights, 3, sum)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Soft& soft = world.softs.record[index];
        if (!check.require(soft.triangles() > 0, "solid: it has no triangles")) return check.result();
        if (!check.count("triangle", triangle, 0, soft.triangles() - 1)) return check.result();
        uint32_t node[3];
        double weight[3];
        for (uint32_t n = 0; n < 3; ++n) {
            node[n] = soft.node[soft.triangle[3 * size_t{triangle} + n]];
            weight[n] = static_cast<double>(weights[n]) / sum;
        }
        *out = anchor_on(world, node, weight, 3);
        return TAUT_OK;
    });
}

template <class Handle>
taut_result anchor_near(Check& check, Handle handle, const taut_pos& point, taut_anchor* out, uint32_t* element) {
    if (!check.pointer("out", out).bounded("point", point, kPosition)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const SoftPoint at = nearest_point(world, world.softs.record[index], to_vec(point));
        *out = anchor_on(world, at.node, at.weight, at.count);
        if (element) *element = at.element;
        return TAUT_OK;
    });
}

}  // namespace

void taut_attachment_def_init_sized(taut_attachment_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_attachment_def& own) {
        own = {};
        own.struct_size = sizeof own;
    });
}

taut_result taut_world_get_anchor(taut_world handle, taut_body body, taut_pos point, taut_anchor* out) {
    Check check(__func__);
    if (!check.pointer("out", out).bounded("point", point, kPosition)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        taut_anchor anchor{};
        if (body.bits == 0) {
            anchor.points[0] = point;
            *out = anchor;
            return TAUT_OK;
        }
        uint32_t node = kNone;
        const taut_result found = find_body(check.call(), "body", world, body, node);
        if (found != TAUT_OK) return found;
        anchor.count = 1;
        anchor.bodies[0] = body;
        anchor.weights[0] = 1;
        if (!is_particle(world, node))
            anchor.points[0] =
                to_pos(world.nodes.motion[node].q.conjugate() * (to_vec(point) - world.nodes.origin(node)));
        if (!check.vector("point on the body", anchor.points[0], kShapeCoordinate)) return check.result();
        *out = anchor;
        return TAUT_OK;
    });
}

taut_result taut_world_get_anchor_point(taut_world handle, const taut_anchor* anchor, taut_pos* out) {
    Check check(__func__);
    if (!check.pointer("anchor", anchor).pointer("out", out)) return check.result();
    if (!check_anchor(check, "anchor.", *anchor)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        Anchor at;
        const taut_result found = find_anchor(check, world, "anchor.", *anchor, at);
        if (found == TAUT_OK) *out = to_pos(point_of(world.nodes, at));
        return found;
    });
}

taut_result taut_cloth_get_anchor(taut_cloth cloth, uint32_t triangle, const float weights[3], taut_anchor* out) {
    Check check(__func__);
    return anchor_of_triangle(check, cloth, triangle, weights, out);
}
taut_result taut_solid_get_anchor(taut_solid solid, uint32_t triangle, const float weights[3], taut_anchor* out) {
    Check check(__func__);
    return anchor_of_triangle(check, solid, triangle, weights, out);
}
taut_result taut_cloth_find_anchor(taut_cloth cloth, taut_pos point, taut_anchor* out, uint32_t* triangle) {
    Check check(__func__);
    return anchor_near(check, cloth, point, out, triangle);
}
taut_result taut_solid_find_anchor(taut_solid solid, taut_pos point, taut_anchor* out, uint32_t* cell) {
    Check check(__func__);
    return anchor_near(check, solid, point, out, cell);
}

taut_result taut_world_add_attachment(taut_world handle, const taut_attachment_def* given, taut_attachment* out) {
    TAUT_RECORD(taut_world_add_attachment, handle, given, out);
    Check check(__func__);
    taut_attachment_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_attachment_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) { return add(check, world, def, out); });
}

taut_result taut_attachment_remove(taut_attachment handle) {
    TAUT_RECORD(taut_attachment_remove, handle);
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        remove_attachment(world, index);
        return TAUT_OK;
    });
}

int32_t taut_attachment_is_valid(taut_attachment handle) { return is_valid(handle); }

taut_result taut_attachment_get_def_sized(taut_attachment handle, taut_attachment_def* first, uint32_t size) {
    const RecordOut<taut_attachment_def> out(first, size);
    Check check("taut_attachment_get_def");
    check.pointer("out", out);
    return reading(check, handle, [&](const World& world, const Attachment& of) {
        taut_attachment_def def;
        taut_attachment_def_init(&def);
        def.kind = static_cast<taut_attachment_kind>(of.kind);
        def.a = to_anchor(world, of.end[0]);
        def.b = to_anchor(world, of.end[1]);
        def.length = to_float(of.length);
        def.compliance = static_cast<float>(of.compliance);
        def.damping = static_cast<float>(of.damping);
        def.break_force = breaks_at(of.break_force);
        def.break_torque = breaks_at(of.break_torque);
        def.collide_connected = of.collide_connected ? 1 : 0;
        def.solve = static_cast<taut_joint_solve>(of.solve);
        def.pulls = of.pulls ? 1 : 0;
        def.limit = static_cast<float>(of.limit);
        def.limit_compliance = static_cast<float>(of.limit_compliance);
        def.user_data = of.user_data;
        *out = def;
    });
}

taut_result taut_attachment_get_user_data(taut_attachment handle, uint64_t* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Attachment& of) { *out = of.user_data; });
}

taut_result taut_attachment_set_user_data(taut_attachment handle, uint64_t value) {
    TAUT_RECORD(taut_attachment_set_user_data, handle, value);
    return with(__func__, handle, Use::write, [&](World& world, uint32_t index) {
        world.attachments.record[index].user_data = value;
        return TAUT_OK;
    });
}

taut_result taut_attachment_get_points(taut_attachment handle, taut_pos* point_a, taut_pos* point_b) {
    Check check(__func__);
    check.pointer("point_a", point_a).pointer("point_b", point_b);
    return reading(check, handle, [&](const World& world, const Attachment& of) {
        *point_a = to_pos(point_of(world.nodes, of.end[0]));
        *point_b = to_pos(point_of(world.nodes, of.end[1]));
    });
}

taut_result taut_attachment_get_force(taut_attachment handle, taut_vec3* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World& world, const Attachment& of) {
        *out = to_vec3(load_of(world.nodes, world.elements, of).force);
    });
}

taut_result taut_attachment_get_torque(taut_attachment handle, taut_vec3* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World& world, const Attachment& of) {
        *out = to_vec3(load_of(world.nodes, world.elements, of).torque);
    });
}

taut_result taut_attachment_get_error(taut_attachment handle, float* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World& world, const Attachment& of) {
        *out = to_float(gap_of(world.nodes, world.elements, of));
    });
}

taut_result taut_world_get_attachments_sized(taut_world handle, taut_attachment_state* first, uint32_t capacity,
                                             uint32_t* count, uint32_t size) {
    const RecordOut<taut_attachment_state> states(first, size);
    Check check("taut_world_get_attachments");
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        uint32_t next = 0;
        return copy_out(world.attachments.ids.count(), states, capacity, count, check.call(), "states", [&](uint32_t) {
            while (!world.attachments.ids.live(next)) ++next;
            const uint32_t index = next++;
            const Attachment& of = world.attachments.record[index];
            return taut_attachment_state{world.attachment_handle(index),
                                         of.user_data,
                                         to_pos(point_of(world.nodes, of.end[0])),
                                         to_pos(point_of(world.nodes, of.end[1])),
                                         to_vec3(load_of(world.nodes, world.elements, of).force),
                                         to_float(gap_of(world.nodes, world.elements, of))};
        });
    });
}

taut_result taut_attachment_set_compliance(taut_attachment handle, float compliance, float damping) {
    TAUT_RECORD(taut_attachment_set_compliance, handle, compliance, damping);
    Check check(__func__);
    if (!check_law(check, compliance, damping)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        change_compliance(world, index, compliance, damping);
        return TAUT_OK;
    });
}

taut_result taut_attachment_set_length(taut_attachment handle, float length) {
    TAUT_RECORD(taut_attachment_set_length, handle, length);
    Check check(__func__);
    if (!check.number("length", length, kJointLength)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        const Attachment& of = world.attachments.record[index];
        check.require(of.kind == AttachmentKind::distance, "the attachment is none at a distance");
        if (!check_limit(check, of.limit, length)) return check.result();
        change_length(world, index, length);
        return TAUT_OK;
    });
}

taut_result taut_attachment_set_break(taut_attachment handle, float force, float torque) {
    TAUT_RECORD(taut_attachment_set_break, handle, force, torque);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Attachment& of = world.attachments.record[index];
        if (!check_break(check, of.kind == AttachmentKind::fixed, force, torque)) return check.result();
        of.break_force = or_never(force);
        of.break_torque = or_never(torque);
        return TAUT_OK;
    });
}
