// The end of a cable of particles: how its segment grows, is cut, and is joined with the next.
#include <algorithm>

#include "models/cable_reel.h"

namespace taut {

// Masses of so many points from the end, and what bends at them.
void Reel::set_points(uint32_t count) {
    for (uint32_t k = 0; k < count; ++k) {
        set_cable_mass(world_, c_, point(k));
        tie_bend(world_, c_, point(k));
    }
}

void Reel::grow_particles(double d) {
    const JointRef ref = c_.joint[at()];
    const Kept segment(world_, ref), outer_bend(world_, bend_at(c_, point(0))), bend(world_, bend_at(c_, point(1)));
    length() += d;
    set_segment(c_, *find(world_.joints, ref), length());
    set_points(2);
    segment.let_go();
    outer_bend.let_go();
    bend.let_go();
}

// Cuts a nominal segment off the inner end.
void Reel::divide_particles() {
    const double l = length(), n = c_.nominal, part = n / l, rest = l - n;
    const NodeMotion &far = motion(outer()), &near = motion(second());
    const Vec3 span = far.x - near.x, out = span / std::max(span.norm(), 1e-12);
    NodeMotion m;
    m.x = near.x + part * span;
    // Between the two, but for the speed at which the outer part alone grows.
    m.v = near.v + part * (far.v - near.v - end_.paid / step() * out);
    m.slow_v = near.slow_v + part * (far.slow_v - near.slow_v - end_.paid / step() * out);
    reserve_ended_of({outer(), second()});
    const bool bends = c_.bending_stiffness > 0;
    JointRef made[2];
    const uint32_t node = add_parts(m, 0.5 * l, {made, bends ? 2u : 1u});

    const JointRef outer_ref = c_.joint[at()];
    const Kept segment(world_, outer_ref), outer_bend(world_, bend_at(c_, point(0))),
        inner_bend(world_, bend_at(c_, point(1)));
    double moment[kMaxRows] = {};  // at the cut
    blend(bend_at(c_, point(0)), part, moment);
    blend(bend_at(c_, point(1)), 1 - part, moment);
    length() = n;
    insert(c_.node, node, 1);
    insert(c_.length, rest, 0);
    insert(c_.joint, made[0], 1);
    Joint& outer_joint = *find(world_.joints, outer_ref);
    Joint& joint = place_joint(made[0], make_inner_joint(c_, e_ == 0 ? 1 : at() - 1));
    joint.lambda[0] = outer_joint.lambda[0];
    outer_joint.node[e_ == 0 ? 1 : 0] = node;
    set_segment(c_, outer_joint, rest);
    if (bends) {
        insert(c_.bend, made[1], 0);
        load(place_joint(made[1], make_bend(c_, point(1))), moment);
    }
    for (uint32_t i : {at(), e_ == 0 ? 1 : at() - 1}) tie_segment(world_, c_, i);
    set_points(3);
    segment.let_go();
    outer_bend.let_go();
    inner_bend.let_go();
}

// The second point goes.
void Reel::join_particles() {
    const uint32_t gone = second(), i = at(), k = e_ == 0 ? 1 : i - 1;
    reserve_ended_of({outer(), gone, c_.node[point(2)]});
    const JointRef outer_ref = c_.joint[i], inner_ref = c_.joint[k];
    const Kept segment(world_, outer_ref), outer_bend(world_, bend_at(c_, point(0))),
        inner_bend(world_, bend_at(c_, point(2)));
    Joint &a = *find(world_.joints, outer_ref), &b = *find(world_.joints, inner_ref);
    const double stretch =
        a.compliance > 0 ? read_joint(world_.nodes, a).value[0] + read_joint(world_.nodes, b).value[0] : 0;
    const uint32_t third = b.node[e_ == 0 ? 1 : 0];
    const double la = c_.length[i], lb = c_.length[k];
    const double chord = (motion(outer()).x - motion(third).x).norm();
    const double joined = std::max(kLeastReeled * c_.nominal, std::min(la + lb, chord - stretch));
    a.node[e_ == 0 ? 1 : 0] = third;
    a.lambda[0] = (la * a.lambda[0] + lb * b.lambda[0]) / (la + lb);
    set_segment(c_, a, joined);
    end_.lost += la + lb - joined;
    c_.length[k] = joined;
    erase(c_.length, 0);
    erase(c_.node, 1);
    erase(c_.joint, 1);
    if (c_.bending_stiffness > 0) erase(c_.bend, 0);
    tie_segment(world_, c_, at());
    set_points(2);
    remove_joints_of(gone);
    drop_cable_node(world_, gone);
    segment.let_go();
    outer_bend.let_go();
    inner_bend.let_go();
}

}  // namespace taut
