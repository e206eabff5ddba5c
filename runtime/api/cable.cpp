#include <taut/cable.h>

#include <algorithm>
#include <cstdio>

#include "api/collider_def.h"
#include "api/copy_out.h"
#include "api/sized.h"
#include "models/cable.h"
#include "models/cable_path.h"

using namespace taut;

namespace {

constexpr Range kSegmentLength{kLeastSegment, 1e3};  // [m]
constexpr Range kDiameter{2e-3, 1e3};                // [m]
constexpr Range kMassPerMetre{1e-3, 1e9};            // [kg/m]
constexpr Range kStretch{0, 1e3};                    // [1/N]
constexpr Range kCableDamping{0, 1e9};               // [N s], [N m^2 s]
constexpr Range kBending{1e-9, 1e12};                // [N m^2]
constexpr Range kCableLength{0, 1e6};                // [m]
constexpr Range kAcceleration{0, 1e6};               // [m/s^2]
constexpr Range kMetres{-1e6, 1e6};                  // [m]
constexpr uint32_t kStraightSegments = 16;           // of a path of two points that says nothing else

struct CableEndNames {
    const char *attached, *clamped, *body, *anchor;
};
constexpr CableEndNames kCableEndNames[2] = {{"end[0].attached", "end[0].clamped", "end[0].body", "end[0].anchor"},
                                             {"end[1].attached", "end[1].clamped", "end[1].body", "end[1].anchor"}};

// ---------------------------------------------------------------- check

bool check_ends(Check& check, const taut_cable_def& def) {
    for (int e = 0; e < 2; ++e) {
        const taut_cable_end_def& end = def.end[e];
        check.boolean(kCableEndNames[e].attached, end.attached)
            .boolean(kCableEndNames[e].clamped, end.clamped)
            .bounded(kCableEndNames[e].anchor, end.anchor, kPosition);
        check.require(end.attached || (!end.clamped && end.body.bits == 0),
                      "an end that is not attached has a body or is clamped");
        check.require(!end.clamped || def.bending_stiffness > 0, "an end is clamped without bending_stiffness");
    }
    return static_cast<bool>(check);
}

bool check_path(Check& check, const taut_cable_def& def) {
    if (def.point_count == 0) {
        check.require(def.end[0].attached && def.end[1].attached, "point_count is 0 with an end that is not attached");
    } else {
        check.count("point_count", def.point_count, 2, TAUT_CABLE_MAX_SEGMENTS + 1).pointer("points", def.points);
    }
    for (uint32_t i = 0; check && i < def.point_count; ++i) {
        char field[32];
        std::snprintf(field, sizeof field, "points[%u]", i);
        check.bounded(field, def.points[i], kPosition);
    }
    check.count("segment_count", def.segment_count, 0, TAUT_CABLE_MAX_SEGMENTS)
        .zero_or("segment_length", def.segment_length, kSegmentLength)
        .number("length", def.length, kCableLength)
        .require(def.segment_count == 0 || def.segment_length == 0, "both segment_count and segment_length are given")
        .require(def.length == 0 || def.point_count <= 2, "length is given for a path with points in between");
    return static_cast<bool>(check);
}

bool check_def(Check& check, const taut_cable_def& def) {
    check.choice("kind", def.kind, TAUT_CABLE_LINKS)
        .number("diameter", def.diameter, kDiameter)
        .number("mass_per_metre", def.mass_per_metre, kMassPerMetre)
        .number("stretch_compliance", def.stretch_compliance, kStretch)
        .number("stretch_damping", def.stretch_damping, kCableDamping)
        .zero_or("bending_stiffness", def.bending_stiffness, kBending)
        .number("bending_damping", def.bending_damping, kCableDamping);
    check_material(check, kMaterialInDef, def.material)
        .zero("filter.reserved", def.filter.reserved)
        .boolean("self_collision", def.self_collision)
        .number("gravity_scale", def.gravity_scale, kGravityScale);
    check.require(def.self_collision || def.filter.group <= 0,
                  "filter.group is positive, which makes the links collide with each other; see self_collision");
    check.require(!def.self_collision || def.filter.group >= 0,
                  "filter.group is negative, which keeps the links from colliding with each other");
    return check && check_ends(check, def) && check_path(check, def);
}

// ---------------------------------------------------------------- find

// Where the end is, in the world.
taut_result find_end(Check& check, const World& world, const taut_cable_end_def& def, const CableEndNames& names,
                     CableTie& tie, Vec3& point) {
    tie.attached = def.attached != 0;
    tie.clamped = def.clamped != 0;
    tie.anchor = point = to_vec(def.anchor);
    if (def.body.bits == 0) return TAUT_OK;
    const taut_result found = find_body(check.call(), names.body, world, def.body, tie.node);
    if (found != TAUT_OK) return found;
    if (!world.nodes.enabled(tie.node))
        return refuse(TAUT_INVALID_ARGUMENT, "%s: %s is disabled", check.call(), names.body);
    const NodeMotion& motion = world.nodes.motion[tie.node];
    if (world.nodes.info[tie.node].kind == NodeKind::particle) {
        check.require(tie.anchor == Vec3::Zero(), "an anchor is off its particle, expected 0");
        check.require(!tie.clamped, "an end is clamped to a particle, which has no direction");
        point = motion.x;
    } else {
        check.vector(names.anchor, def.anchor, kShapeCoordinate);
        tie.anchor -= world.nodes.mass[tie.node].centre;
        point = motion.x + motion.q * tie.anchor;
    }
    return check.result();
}

uint32_t count_segments(Check& check, const taut_cable_def& def, double length, size_t path_points) {
    if (def.segment_count > 0) return def.segment_count;
    if (def.segment_length == 0) return path_points == 2 ? kStraightSegments : static_cast<uint32_t>(path_points) - 1;
    const double count = std::max(1.0, std::floor(length / def.segment_length + 0.5));
    check.require(count <= TAUT_CABLE_MAX_SEGMENTS, "more segments than TAUT_CABLE_MAX_SEGMENTS", TAUT_LIMIT);
    return check ? static_cast<uint32_t>(count) : 0;
}

// The cable's points, from a path whose ends are in place.
void lay(Check& check, const World& world, const taut_cable_def& def, const Array<Vec3>& path, Array<Vec3>& points) {
    const double distance = path_length(path);
    if (path.size() == 2 && !check.number("distance of the ends", distance, Range{kLeastSegment, 1e6})) return;
    const bool sags = def.length > distance * (1 + 1e-6);
    check.require(def.length == 0 || def.length >= distance * (1 - 1e-6), "length is less than the ends are apart");
    const uint32_t segments = count_segments(check, def, std::max<double>(distance, def.length), path.size());
    check.require(!sags || segments > 1, "one segment cannot sag: length is more than the ends are apart");
    if (!check) return;
    if (sags) {
        const taut_vec3& g = world.def.gravity;
        const Vec3 down = def.gravity_scale < 0 ? Vec3(-to_vec(g)) : to_vec(g);
        sag_path(path.front(), path.back(), down, def.length, segments, points);
    } else if (def.segment_count == 0 && def.segment_length == 0 && path.size() > 2) {
        points = path;
    } else {
        cut_path(path, segments, points);
    }
    for (size_t i = 1; i < points.size(); ++i) {
        char field[48];
        std::snprintf(field, sizeof field, "length of segment %zu", i - 1);
        check.number(field, (points[i] - points[i - 1]).norm(), kSegmentLength);
    }
}

Cable plan_of(World& world, const taut_cable_def& def) {
    Cable plan(world.memory);
    plan.kind = def.kind == TAUT_CABLE_LINKS ? CableKind::links : CableKind::particles;
    plan.mass_per_metre = def.mass_per_metre;
    plan.radius = 0.5 * def.diameter;
    plan.stretch_compliance = def.stretch_compliance;
    plan.stretch_damping = def.stretch_damping;
    plan.bending_stiffness = def.bending_stiffness;
    plan.bending_damping = def.bending_damping;
    plan.gravity_scale = def.gravity_scale;
    plan.material = def.material;
    plan.filter = def.filter;
    plan.self_collision = def.self_collision != 0;
    plan.user_data = def.user_data;
    return plan;
}

// An end that can be reeled.
bool check_reel(Check& check, const World& world, const Cable& cable, uint32_t end) {
    check.require(find(world.joints, cable.end[end].joint) != nullptr, "the end is free: there is nothing to reel on");
    return static_cast<bool>(check);
}

}  // namespace

void taut_cable_def_init_sized(taut_cable_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cable_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.kind = TAUT_CABLE_LINKS;
        own.diameter = 0.02f;
        own.mass_per_metre = 1;
        own.material.friction = 0.5f;
        own.filter.category = 1;
        own.filter.mask = UINT64_MAX;
        own.gravity_scale = 1;
    });
}

taut_result taut_world_add_cable(taut_world handle, const taut_cable_def* given, taut_cable* out) {
    TAUT_RECORD(taut_world_add_cable, handle, given, out);
    Check check(__func__);
    taut_cable_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_cable_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        CableTie tie[2];
        Vec3 at[2];
        for (int e = 0; e < 2; ++e) {
            const taut_result found = find_end(check, world, def.end[e], kCableEndNames[e], tie[e], at[e]);
            if (found != TAUT_OK) return found;
        }
        Array<Vec3> path(world.memory), points(world.memory);
        path.resize(std::max(def.point_count, 2u));
        for (uint32_t i = 0; i < def.point_count; ++i) path[i] = to_vec(def.points[i]);
        if (tie[0].attached) path.front() = at[0];
        if (tie[1].attached) path.back() = at[1];
        lay(check, world, def, path, points);
        if (!check) return check.result();

        Cable plan = plan_of(world, def);
        const CableParts parts = parts_of(plan, static_cast<uint32_t>(points.size()) - 1, tie);
        taut_result room = room_for_bodies(check.call(), world, parts.nodes);
        if (room == TAUT_OK) room = room_for_colliders(check.call(), world, parts.colliders);
        if (room == TAUT_OK) room = room_for_joints(check.call(), world, parts.joints);
        if (room != TAUT_OK) return room;
        const uint32_t index = add_cable(world, plan, points, tie);
        *out = world.cable_handle(index);
        return TAUT_OK;
    });
}

taut_result taut_cable_remove(taut_cable handle) {
    TAUT_RECORD(taut_cable_remove, handle);
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        remove_cable(world, index);
        return TAUT_OK;
    });
}

taut_result taut_cable_cut(taut_cable handle, uint32_t segment) {
    TAUT_RECORD(taut_cable_cut, handle, segment);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        const Cable& cable = world.cables.record[index];
        const uint32_t last = cable.segments() - (cable.kind == CableKind::links ? 1 : 0);
        if (!check.require(segment < last, "segment is beyond the last that can be cut")) return check.result();
        cut_cable(world, index, segment);
        return TAUT_OK;
    });
}

int32_t taut_cable_is_valid(taut_cable handle) { return is_valid(handle); }

taut_result taut_cable_get_user_data(taut_cable handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = world.cables.record[index].user_data;
        return TAUT_OK;
    });
}

taut_result taut_body_get_cable(taut_body handle, taut_cable* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.cable_handle(world.nodes.info[node].cable);
        return TAUT_OK;
    });
}

taut_result taut_cable_get_length(taut_cable handle, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = to_float(cable_length(world.cables.record[index]));
        return TAUT_OK;
    });
}

taut_result taut_cable_get_points(taut_cable handle, taut_pos* points, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Cable& cable = world.cables.record[index];
        return copy_out(cable.segments() + 1, points, capacity, count, check.call(), "points",
                        [&](uint32_t i) { return to_pos(cable_point(world, cable, i)); });
    });
}

taut_result taut_cable_get_tensions(taut_cable handle, float* tensions, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Cable& cable = world.cables.record[index];
        return copy_out(cable.segments(), tensions, capacity, count, check.call(), "tensions",
                        [&](uint32_t i) { return to_float(cable_tension(world, cable, i)); });
    });
}

taut_result taut_cable_get_bodies(taut_cable handle, taut_body* bodies, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Cable& cable = world.cables.record[index];
        return copy_out(static_cast<uint32_t>(cable.node.size()), bodies, capacity, count, check.call(), "bodies",
                        [&](uint32_t i) { return world.body_handle(cable.node[i]); });
    });
}

taut_result taut_cable_get_end_joint(taut_cable handle, uint32_t end, taut_joint* out) {
    Check check(__func__);
    if (!check.pointer("out", out).count("end", end, 0, 1)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const JointRef& ref = world.cables.record[index].end[end].joint;
        *out = find(world.joints, ref) ? world.joint_handle(ref.slot) : taut_joint{0};
        return TAUT_OK;
    });
}

taut_result taut_cable_set_reel_speed(taut_cable handle, uint32_t end, float speed, float acceleration) {
    TAUT_RECORD(taut_cable_set_reel_speed, handle, end, speed, acceleration);
    Check check(__func__);
    check.count("end", end, 0, 1).number("speed", speed, kSpeed).number("acceleration", acceleration, kAcceleration);
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Cable& cable = world.cables.record[index];
        if (!check_reel(check, world, cable, end)) return check.result();
        const double most = 0.5 * (1 + 1e-6) * cable.nominal / world.def.time_step;  // rounding is no offence
        if (!check.number("speed", speed, Range{-most, most})) return check.result();
        cable.end[end].wanted_speed = speed;
        cable.end[end].acceleration = acceleration;
        return TAUT_OK;
    });
}

taut_result taut_cable_get_reel_speed(taut_cable handle, uint32_t end, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out).count("end", end, 0, 1)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const CableEnd& state = world.cables.record[index].end[end];
        *out = find(world.joints, state.joint) ? static_cast<float>(state.reel_speed) : 0.0f;
        return TAUT_OK;
    });
}

taut_result taut_cable_reel(taut_cable handle, uint32_t end, float metres) {
    TAUT_RECORD(taut_cable_reel, handle, end, metres);
    Check check(__func__);
    if (!check.count("end", end, 0, 1).number("metres", metres, kMetres)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Cable& cable = world.cables.record[index];
        if (!check_reel(check, world, cable, end)) return check.result();
        cable.end[end].owed += metres;
        return TAUT_OK;
    });
}
