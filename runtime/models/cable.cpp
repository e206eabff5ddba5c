#include "models/cable.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "constraints/ball.h"
#include "constraints/bend.h"
#include "constraints/distance.h"
#include "constraints/joint_frames.h"
#include "models/bodies.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

static_assert(offsetof(BallData, anchor_b) == sizeof(Vec3) && offsetof(DistanceData, anchor_b) == sizeof(Vec3) &&
                  offsetof(JointFrames, anchor_b) == sizeof(Vec3) && offsetof(BendData, anchor_c) == 2 * sizeof(Vec3),
              "set_anchor relies on it");

template <class Data>
void write_data(Joint& joint, const Data& data) {
    static_assert(sizeof(Data) <= Joint::kDataSize);
    std::memcpy(joint.data, static_cast<const void*>(&data), sizeof data);
}

constexpr int32_t kFirstGroup = -1000000001;  // of links that do not collide with each other

bool links(const Cable& cable) { return cable.kind == CableKind::links; }

Vec3 along(double length) { return {0, length, 0}; }

// A solid cylinder's: at m r^2/2 about its axis. Its ends count for mass, not for the shape's round caps.
NodeMass mass_of(const Cable& cable, double length, NodeKind kind) {
    NodeMass mass;
    mass.gravity_scale = cable.gravity_scale;
    mass.mass = cable.mass_per_metre * length;
    mass.inv_mass = 1 / mass.mass;
    mass.isotropic = kind == NodeKind::particle;
    if (mass.isotropic) return mass;
    const double rr = cable.radius * cable.radius;
    const double across = mass.mass * (3 * rr + length * length) / 12, about = mass.mass * rr / 2;
    mass.inertia = {across, about, across, 0, 0, 0};
    mass.inv_inertia = {1 / across, 1 / about, 1 / across, 0, 0, 0};
    return mass;
}

// Metres of cable that are the mass of node i.
double share_of(const Cable& cable, uint32_t i) {
    if (links(cable)) return cable.length[i];
    const double before = i == 0 ? 0 : cable.length[i - 1], after = i == cable.segments() ? 0 : cable.length[i];
    return 0.5 * (before + after);
}

collision::Shape shape_of(const Cable& cable, double length) {
    collision::Shape shape;
    shape.kind = collision::ShapeKind::capsule;
    shape.size = {static_cast<float>(cable.radius), static_cast<float>(0.5 * length), 0};
    return shape;
}

Joint make_end_joint(const World& world, const Cable& cable, int e, const CableTie& tie) {
    const uint32_t i = e == 0 ? 0 : static_cast<uint32_t>(cable.node.size()) - 1;
    const uint32_t node = cable.node[i];
    Vec3 anchor[2];
    Quat frame[2] = {Quat::Identity(), Quat::Identity()};
    const int outside = e == 0 ? 0 : 1, inside = 1 - outside;
    Joint joint;
    joint.node[outside] = tie.node;
    joint.node[inside] = node;
    joint.user_data = cable.user_data;
    anchor[outside] = tie.anchor;
    anchor[inside] = links(cable) ? along((e == 0 ? -0.5 : 0.5) * cable.length[i]) : Vec3::Zero();
    if (tie.clamped && links(cable)) {
        const Quat body = tie.node == kNone ? Quat::Identity() : world.nodes.motion[tie.node].q;
        frame[outside] = body.conjugate() * world.nodes.motion[node].q;
        joint.type = &kFixed;
        write_data(joint, JointFrames{anchor[0], anchor[1], frame[0], frame[1]});
    } else {
        joint.type = &kBall;
        write_data(joint, BallData{anchor[0], anchor[1]});
    }
    if (links(cable)) set_softness(cable, joint, 0.5 * cable.length[i]);
    return joint;
}

// The bend at a clamped end of particles: the body that holds the end has a point a segment behind it.
Joint make_clamp(const World& world, const Cable& cable, int e, const CableTie& tie) {
    const uint32_t end = e == 0 ? 0 : cable.segments(), next = e == 0 ? 1 : end - 1;
    const Vec3 behind = world.nodes.motion[cable.node[end]].x - world.nodes.motion[cable.node[next]].x;
    Joint joint = make_bend(cable, end);
    const int outside = e == 0 ? 0 : 2;
    joint.node[outside] = tie.node;
    const Quat body = tie.node == kNone ? Quat::Identity() : world.nodes.motion[tie.node].q;
    set_anchor(joint, outside, tie.anchor + body.conjugate() * behind);
    return joint;
}

JointRef add_joint(World& world, const Joint& joint) {
    const uint32_t slot = world.joints.add(joint);
    for (uint32_t node : joint.nodes()) wake(world, node);
    return {slot, world.joints.record[slot].serial};
}

// With its shape, which is its own.
void drop_collider(World& world, uint32_t collider) {
    const uint32_t shape = world.colliders.record[collider].shape;
    remove_collider(world, collider);
    world.shapes.remove(shape);
}

void add_parts(World& world, uint32_t index, std::span<const Vec3> points, const CableTie (&tie)[2]) {
    Cable& cable = world.cables.record[index];
    const auto segments = static_cast<uint32_t>(points.size()) - 1;
    const uint32_t count = links(cable) ? segments : segments + 1;
    cable.node.reserve(count);
    cable.joint.reserve(segments);
    cable.length.reserve(segments);
    for (uint32_t i = 0; i < segments; ++i) cable.length.push_back((points[i + 1] - points[i]).norm());
    cable.nominal = cable_length(cable) / segments;

    Vec3 direction = Vec3::UnitY();
    NodeMotion motion;
    for (uint32_t i = 0; i < count; ++i) {
        motion.x = points[i];
        if (links(cable)) {
            // No twist from link to link.
            const Vec3 next = (points[i + 1] - points[i]).normalized();
            motion.q = (turn_between(direction, next) * motion.q).normalized();
            motion.x = 0.5 * (points[i] + points[i + 1]);
            direction = next;
        }
        cable.node.push_back(add_cable_node(world, index, motion, share_of(cable, i)));
    }
    for (uint32_t i = 0; i < segments && !links(cable); ++i)
        add_segment(world, cable, cable.node[i], cable.node[i + 1], cable.length[i]);
    for (uint32_t i = 0; i + 1 < count; ++i) cable.joint.push_back(add_joint(world, make_inner_joint(cable, i)));
    for (int e = 0; e < 2; ++e)
        if (tie[e].attached) cable.end[e].joint = add_joint(world, make_end_joint(world, cable, e, tie[e]));
    if (links(cable) || cable.bending_stiffness == 0) return;
    cable.bend.reserve(segments - 1);
    for (uint32_t point = 1; point < segments; ++point) cable.bend.push_back(add_joint(world, make_bend(cable, point)));
    for (int e = 0; e < 2; ++e)
        if (tie[e].clamped) cable.end[e].clamp = add_joint(world, make_clamp(world, cable, e, tie[e]));
}

}  // namespace

double span_before(const Cable& cable, uint32_t i) {
    return 0.5 * (cable.length[i] + (i == 0 ? 0 : cable.length[i - 1]));
}

double span_after(const Cable& cable, uint32_t i) {
    return 0.5 * (cable.length[i] + (i + 1 == cable.segments() ? 0 : cable.length[i + 1]));
}

void set_softness(const Cable& cable, Joint& joint, double span) {
    joint.compliance = cable.stretch_compliance * span;
    joint.damping = cable.stretch_damping / span;
    if (joint.type->angular == 0) return;
    joint.angular_compliance = span / cable.bending_stiffness;
    joint.angular_damping = cable.bending_damping / span;
}

void set_segment(const Cable& cable, Joint& joint, double length) {
    std::memcpy(joint.data + offsetof(DistanceData, length), &length, sizeof length);
    set_softness(cable, joint, length);
}

Joint make_bend(const Cable& cable, uint32_t point) {
    Joint joint;
    joint.type = &kBend;
    joint.inner = true;
    joint.collide_connected = true;  // segments are what keeps neighbours from colliding
    joint.user_data = cable.user_data;
    write_data(joint, BendData{});
    for (int n = 0; n < 3; ++n) {
        const uint32_t at = point + static_cast<uint32_t>(n) - 1;
        if (at < cable.node.size()) joint.node[n] = cable.node[at];
    }
    set_softness(cable, joint, share_of(cable, point));
    return joint;
}

void tie_segment(World& world, const Cable& cable, uint32_t segment) {
    const uint32_t index = world.nodes.info[cable.node[segment]].collider, next = cable.node[segment + 1];
    if (index == kNone || world.colliders.record[index].node_b == next) return;
    forget_pairs(world.pairs, world.nodes, world.colliders, ends_on_collider(index));
    world.colliders.record[index].node_b = next;
}

void tie_bend(World& world, const Cable& cable, uint32_t point) {
    Joint* joint = find(world.joints, bend_at(cable, point));
    if (!joint) return;
    const Joint now = make_bend(cable, point);
    for (int n = 0; n < 3; ++n)
        if (now.node[n] != kNone) joint->node[n] = now.node[n];
    set_softness(cable, *joint, share_of(cable, point));
}

Joint make_inner_joint(const Cable& cable, uint32_t i) {
    Joint joint;
    joint.node[0] = cable.node[i];
    joint.node[1] = cable.node[i + 1];
    joint.user_data = cable.user_data;
    if (!links(cable)) {
        joint.type = &kDistance;
        write_data(joint, DistanceData{Vec3::Zero(), Vec3::Zero(), cable.length[i]});
        set_softness(cable, joint, cable.length[i]);
        return joint;
    }
    const Vec3 a = along(0.5 * cable.length[i]), b = along(-0.5 * cable.length[i + 1]);
    if (cable.bending_stiffness > 0) {
        joint.type = &kFixed;
        write_data(joint, JointFrames{a, b, Quat::Identity(), Quat::Identity()});
    } else {
        joint.type = &kBall;
        write_data(joint, BallData{a, b});
    }
    set_softness(cable, joint, span_after(cable, i));
    return joint;
}

void add_segment(World& world, const Cable& cable, uint32_t node, uint32_t next, double length) {
    ColliderPlan collider;
    collider.node = node;
    collider.node_b = next;
    collider.shape = world.shapes.add(shape_of(cable, length));
    collider.traits.material = cable.material;
    collider.traits.filter = cable.filter;
    try {
        add_collider(world, collider);
    } catch (...) {
        world.shapes.remove(collider.shape);
        throw;
    }
}

uint32_t add_cable_node(World& world, uint32_t index, const NodeMotion& motion, double length) {
    const Cable& cable = world.cables.record[index];
    NodeInfo info;
    info.kind = links(cable) ? NodeKind::dynamic : NodeKind::particle;
    info.cable = index;
    info.continuous = world.def.continuous != 0;
    info.user_data = cable.user_data;
    const NodeMass mass = mass_of(cable, length, info.kind);
    if (!links(cable)) return add_node(world, info, motion, mass);
    ColliderPlan collider;
    collider.shape = world.shapes.add(shape_of(cable, length));
    collider.traits.material = cable.material;
    collider.traits.filter = cable.filter;
    try {
        return add_node(world, info, motion, mass, {&collider, 1});
    } catch (...) {
        world.shapes.remove(collider.shape);
        throw;
    }
}

void set_cable_mass(World& world, const Cable& cable, uint32_t i) {
    const uint32_t node = cable.node[i];
    const NodeInfo& info = world.nodes.info[node];
    const double length = share_of(cable, i);
    if (moves_by_forces(info.kind)) {
        world.nodes.mass.reserve_values(1);
        world.nodes.mass.set(node, mass_of(cable, length, info.kind));
    }
    if (!links(cable)) return;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        world.shapes.record[world.colliders.record[c].shape].shape = shape_of(cable, length);
    });
}

void drop_cable_node(World& world, uint32_t node) {
    wake(world, node);
    forget_pairs(world.pairs, world.nodes, world.colliders, ends_on(node));
    while (world.nodes.info[node].collider != kNone) {
        drop_collider(world, world.nodes.info[node].collider);
    }
    world.nodes.remove(node);
}

CableParts parts_of(const Cable& plan, uint32_t segments, const CableTie (&tie)[2]) {
    const size_t held = size_t{tie[0].attached} + size_t{tie[1].attached};
    if (links(plan)) return {segments, segments, segments - 1 + held};
    const size_t clamps = size_t{tie[0].clamped} + size_t{tie[1].clamped};
    const size_t bends = plan.bending_stiffness > 0 ? segments - 1 + clamps : 0;
    return {segments + 1, segments, segments + held + bends};
}

uint32_t add_cable(World& world, const Cable& plan, std::span<const Vec3> points, const CableTie (&tie)[2]) {
    world.cables.reserve_one();
    const uint32_t index = world.cables.add(Cable(plan));
    taut_filter& filter = world.cables.record[index].filter;
    if (!plan.self_collision && filter.group == 0) filter.group = kFirstGroup - static_cast<int32_t>(index);
    try {
        add_parts(world, index, points, tie);
    } catch (...) {
        remove_cable(world, index);  // no pairs yet: does not throw
        throw;
    }
    return index;
}

void remove_cable(World& world, uint32_t index) {
    const auto own = [&](uint32_t node) { return node != kNone && world.nodes.info[node].cable == index; };
    // What may fail comes first.
    reserve_ended(world.pairs, [&](const PairEnds& pair) { return own(pair.a) || own(pair.b); });
    for (uint32_t node : world.cables.record[index].node) wake(world, node);  // and what it is tied to
    for (uint32_t joint = 0; joint < world.joints.ids.slots(); ++joint) {
        if (!world.joints.ids.live(joint)) continue;
        const auto nodes = world.joints.record[joint].nodes();
        if (std::any_of(nodes.begin(), nodes.end(), own)) world.joints.remove(joint);
    }
    for (uint32_t node : world.cables.record[index].node) drop_cable_node(world, node);
    world.cables.remove(index);
}

void drop_loose_parts(World& world) {
    auto drop = [&](JointRef& ref, bool loose) {
        if (ref.slot == kNone || !loose) return;
        if (find(world.joints, ref)) world.joints.remove(ref.slot);
        ref = {};
    };
    for (Cable& cable : world.cables.record) {
        if (links(cable) || cable.segments() == 0) continue;
        auto cut = [&](uint32_t segment) { return !find(world.joints, cable.joint[segment]); };
        for (uint32_t i = 0; i < cable.bend.size(); ++i) drop(cable.bend[i], cut(i) || cut(i + 1));
        for (uint32_t i = 0; i < cable.segments(); ++i) {
            const uint32_t collider = world.nodes.info[cable.node[i]].collider;
            if (cut(i) && collider != kNone) drop_collider(world, collider);
        }
        for (int e = 0; e < 2; ++e) {
            CableEnd& end = cable.end[e];
            drop(end.clamp, !find(world.joints, end.joint) || cut(e == 0 ? 0 : cable.segments() - 1));
        }
    }
}

Vec3 cable_point(const World& world, const Cable& cable, uint32_t point) {
    if (!links(cable)) return world.nodes.motion[cable.node[point]].x;
    const bool last = point == cable.segments();
    const uint32_t link = last ? point - 1 : point;
    const NodeMotion& m = world.nodes.motion[cable.node[link]];
    return m.x + m.q * along((last ? 0.5 : -0.5) * cable.length[link]);
}

double cable_tension(const World& world, const Cable& cable, uint32_t segment) {
    if (!links(cable)) {
        const Joint* joint = find(world.joints, cable.joint[segment]);
        return joint ? -joint->lambda[0] : 0;
    }
    // lambda is the force on the node towards end 1; the middle has the mean of both ends.
    Vec3 pull = Vec3::Zero();
    for (const JointRef& ref : {joint_before(cable, segment), joint_after(cable, segment)})
        if (const Joint* joint = find(world.joints, ref)) pull -= 0.5 * Vec3::Map(joint->lambda);
    return pull.dot(world.nodes.motion[cable.node[segment]].q * Vec3::UnitY());
}

double cable_length(const Cable& cable) {
    double sum = 0;
    for (double length : cable.length) sum += length;
    return sum;
}

}  // namespace taut
