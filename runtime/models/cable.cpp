#include "models/cable.h"

#include <algorithm>

#include "models/attachments.h"
#include "models/cable_parts.h"
#include "sleep/wake.h"

namespace taut {
namespace {

constexpr int32_t kFirstGroup = -1000000001;  // of links that do not collide with each other

JointRef add_joint(World& world, const Joint& joint) {
    const uint32_t slot = world.joints.add(joint);
    for (uint32_t node : joint.nodes()) wake(world, node);
    return {slot, world.joints.record[slot].serial};
}

void add_parts(World& world, uint32_t index, std::span<const Vec3> points, const CableTie (&tie)[2]) {
    Cable& cable = world.cables.record[index];
    const auto segments = static_cast<uint32_t>(points.size()) - 1;
    const uint32_t count = links(cable) ? segments : segments + 1;
    cable.node.reserve(count);
    cable.length.reserve(segments);
    links(cable) ? cable.joint.reserve(segments) : add_sets(world, cable);
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
    for (uint32_t i = 0; i + 1 < count; ++i)
        if (links(cable))
            cable.joint.push_back(add_joint(world, make_inner_joint(cable, i)));
        else
            insert_segment(world, cable, i);
    for (int e = 0; e < 2; ++e)
        if (tie[e].attached) cable.end[e].joint = add_joint(world, make_end_joint(world, cable, e, tie[e]));
    if (links(cable) || cable.bending_stiffness == 0) return;
    for (uint32_t point = 1; point < segments; ++point) insert_bend(world, cable, point);
    for (int e = 0; e < 2; ++e)
        if (tie[e].clamped) cable.end[e].clamp = add_joint(world, make_clamp(world, cable, e, tie[e]));
}

}  // namespace

CableParts parts_of(const Cable& plan, uint32_t segments, const CableTie (&tie)[2]) {
    const size_t held = size_t{tie[0].attached} + size_t{tie[1].attached};
    if (links(plan)) return {segments, segments, segments - 1 + held};
    const size_t clamps = plan.bending_stiffness > 0 ? size_t{tie[0].clamped} + size_t{tie[1].clamped} : 0;
    return {segments + 1, segments, held + clamps};
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
        const auto nodes = world.joints.record[joint].ends();
        if (std::any_of(nodes.begin(), nodes.end(), own)) world.joints.remove(joint);
    }
    drop_attachments(world, own);
    for (const uint32_t set : {world.cables.record[index].stretch, world.cables.record[index].bending})
        if (set != kNone) world.elements.remove(set);
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
        auto cut = [&](uint32_t segment) { return !is_whole(world, cable, segment); };
        for (uint32_t i = 0; cable.bending != kNone && i + 1 < cable.segments(); ++i)
            if (bending_of(world, cable).lives(i) && (cut(i) || cut(i + 1)))
                world.elements.kill(bending_of(world, cable), i);
        for (uint32_t i = 0; i < cable.segments(); ++i) {
            const uint32_t collider = world.nodes.info[cable.node[i]].collider;
            if (cut(i) && collider != kNone) drop_capsule(world, collider);
        }
        for (int e = 0; e < 2; ++e) {
            CableEnd& end = cable.end[e];
            drop(end.clamp, !find(world.joints, end.joint) || cut(e == 0 ? 0 : cable.segments() - 1));
        }
    }
}

bool is_whole(const World& world, const Cable& cable, uint32_t segment) {
    return segment_ref(world, cable, segment).index != kNone;
}

void cut_cable(World& world, uint32_t index, uint32_t segment) {
    const Cable& cable = world.cables.record[index];
    const ConstraintRef ref = segment_ref(world, cable, segment);
    if (ref.index == kNone) return;
    const auto ends = view_of(world, ref).nodes;
    // What may fail comes first: the two may collide from now on.
    forget_pairs(world.pairs, world.nodes, world.colliders, between_nodes(ends[0], ends[1]));
    for (const uint32_t node : ends) wake(world, node);
    ref.set == kNone ? world.joints.remove(ref.index) : world.elements.kill(world.elements.set[ref.set], ref.index);
}

}  // namespace taut
