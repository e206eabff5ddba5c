// Elements of cables of particles: a link a segment, of softness its length, and a bend at each inner point, of
// softness the metres that bend there.
#include "models/cable_parts.h"

namespace taut {
namespace {

std::array<uint32_t, 2> ends_of(const Cable& cable, uint32_t i) { return {cable.node[i], cable.node[i + 1]}; }
std::array<uint32_t, 3> points_about(const Cable& cable, uint32_t point) {
    return {cable.node[point - 1], cable.node[point], cable.node[point + 1]};
}

}  // namespace

void add_sets(World& world, Cable& cable) {
    const bool bends = cable.bending_stiffness > 0;
    cable.stretch = world.elements.add(kLinkElement);
    ElementSet& stretch = stretch_of(world, cable);
    set_compliance(stretch, cable.stretch_compliance, cable.stretch_compliance * cable.stretch_damping);
    reserve_elements(stretch, cable.segments());
    if (!bends) return;
    cable.bending = world.elements.add(kBendElement);
    ElementSet& bending = bending_of(world, cable);
    bending.collide_connected = true;  // segments are what keeps neighbours from colliding
    set_compliance(bending, 1 / cable.bending_stiffness, cable.bending_damping / cable.bending_stiffness);
    reserve_elements(bending, cable.segments());
}

void insert_segment(World& world, const Cable& cable, uint32_t i) {
    world.elements.insert(stretch_of(world, cable), i, ends_of(cable, i), cable.length[i]);
    *stretch_of(world, cable).data_of(i) = cable.length[i];
}

void insert_bend(World& world, const Cable& cable, uint32_t point) {
    world.elements.insert(bending_of(world, cable), point - 1, points_about(cable, point), share_of(cable, point));
}

void set_segment(World& world, const Cable& cable, uint32_t i) {
    ElementSet& stretch = stretch_of(world, cable);
    if (!stretch.lives(i)) return;
    world.elements.tie(stretch, i, ends_of(cable, i));
    *stretch.data_of(i) = stretch.softness[i] = cable.length[i];
}

void tie_bend(World& world, const Cable& cable, uint32_t point) {
    const ConstraintRef ref = bend_at(world, cable, point);
    if (ref.index == kNone) return;
    if (ref.set != kNone) {
        world.elements.tie(bending_of(world, cable), ref.index, points_about(cable, point));
        bending_of(world, cable).softness[ref.index] = share_of(cable, point);
        return;
    }
    Joint& clamp = world.joints.record[ref.index];
    clamp.node[1] = cable.node[point];
    point == 0 ? clamp.node[2] = cable.node[1] : clamp.node[0] = cable.node[point - 1];
    set_softness(cable, clamp, share_of(cable, point));
}

ConstraintRef ref_of(const World& world, const JointRef& joint) {
    return {kNone, find(world.joints, joint) ? joint.slot : kNone};
}

ConstraintRef segment_ref(const World& world, const Cable& cable, uint32_t i) {
    if (links(cable)) return i < cable.joint.size() ? ref_of(world, cable.joint[i]) : ConstraintRef{};
    return {cable.stretch, world.elements.set[cable.stretch].lives(i) ? i : kNone};
}

ConstraintRef bend_at(const World& world, const Cable& cable, uint32_t point) {
    if (point == 0) return ref_of(world, cable.end[0].clamp);
    if (point == cable.segments()) return ref_of(world, cable.end[1].clamp);
    if (cable.bending == kNone || !world.elements.set[cable.bending].lives(point - 1)) return {};
    return {cable.bending, point - 1};
}

double* lambda_of(World& world, const ConstraintRef& ref) {
    return ref.set == kNone ? world.joints.record[ref.index].lambda : world.elements.set[ref.set].lambda_of(ref.index);
}
double* drift_of(World& world, const ConstraintRef& ref) {
    return ref.set == kNone ? world.joints.record[ref.index].drift : world.elements.set[ref.set].drift_of(ref.index);
}

}  // namespace taut
