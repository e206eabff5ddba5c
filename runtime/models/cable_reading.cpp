// Where a cable is and what it carries.
#include "models/cable_parts.h"

namespace taut {

Vec3 cable_point(const World& world, const Cable& cable, uint32_t point) {
    if (!links(cable)) return world.nodes.motion[cable.node[point]].x;
    const bool last = point == cable.segments();
    const uint32_t link = last ? point - 1 : point;
    const NodeMotion& m = world.nodes.motion[cable.node[link]];
    return m.x + m.q * along((last ? 0.5 : -0.5) * cable.length[link]);
}

double cable_tension(const World& world, const Cable& cable, uint32_t segment) {
    if (!links(cable)) {
        return -world.elements.set[cable.stretch].lambda_of(segment)[0];
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
