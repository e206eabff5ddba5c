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
    const Kept segment(world_, segment_ref(world_, c_, at())), outer_bend(world_, bend_at(world_, c_, point(0))),
        bend(world_, bend_at(world_, c_, point(1)));
    length() += d;
    set_segment(world_, c_, at());
    set_points(2);
    segment.let_go();
    outer_bend.let_go();
    bend.let_go();
}

// Cuts a nominal segment off the inner end. The element of the end segment stays with what is left of it.
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
    const uint32_t node = add_parts(m, 0.5 * l, nullptr);

    const Kept segment(world_, segment_ref(world_, c_, at())), outer_bend(world_, bend_at(world_, c_, point(0))),
        inner_bend(world_, bend_at(world_, c_, point(1)));
    double moment[kMaxRows] = {};  // at the cut
    blend(bend_at(world_, c_, point(0)), part, moment);
    blend(bend_at(world_, c_, point(1)), 1 - part, moment);
    const double tension = stretch_of(world_, c_).lambda_of(at())[0];
    length() = n;
    insert(c_.node, node, 1);
    insert(c_.length, rest, 0);
    const uint32_t cut = e_ == 0 ? 1 : at() - 1;  // the segment that is new
    insert_segment(world_, c_, cut);
    ElementSet& stretch = stretch_of(world_, c_);
    stretch.lambda_of(cut)[0] = tension;
    stretch.fresh[cut] = 0;
    set_segment(world_, c_, at());
    if (c_.bending != kNone) {
        insert_bend(world_, c_, point(1));
        bending_of(world_, c_).fresh[point(1) - 1] = 0;
        load(bend_at(world_, c_, point(1)), moment);
    }
    for (uint32_t i : {at(), cut}) tie_segment(world_, c_, i);
    set_points(3);
    segment.let_go(segment_ref(world_, c_, at()));
    outer_bend.let_go(bend_at(world_, c_, point(0)));
    inner_bend.let_go(bend_at(world_, c_, point(2)));
}

// The second point goes, and with it the segment beyond it.
void Reel::join_particles() {
    const uint32_t gone = second(), i = at(), k = e_ == 0 ? 1 : i - 1;
    reserve_ended_of({outer(), gone, c_.node[point(2)]});
    const Kept segment(world_, segment_ref(world_, c_, i)), outer_bend(world_, bend_at(world_, c_, point(0))),
        inner_bend(world_, bend_at(world_, c_, point(2)));
    ElementSet& stretch = stretch_of(world_, c_);
    double error[2];
    view_of(stretch, i).read(world_.nodes, &error[0]);
    view_of(stretch, k).read(world_.nodes, &error[1]);
    const double give = c_.stretch_compliance > 0 ? error[0] + error[1] : 0;
    const double la = c_.length[i], lb = c_.length[k];
    const double chord = (motion(outer()).x - motion(c_.node[point(2)]).x).norm();
    const double joined = std::max(kLeastReeled * c_.nominal, std::min(la + lb, chord - give));
    stretch.lambda_of(i)[0] = (la * stretch.lambda_of(i)[0] + lb * stretch.lambda_of(k)[0]) / (la + lb);
    end_.lost += la + lb - joined;
    world_.elements.erase(stretch, k);
    if (c_.bending != kNone) world_.elements.erase(bending_of(world_, c_), point(1) - 1);
    c_.length[i] = joined;
    erase(c_.length, 1);
    erase(c_.node, 1);
    set_segment(world_, c_, at());
    tie_segment(world_, c_, at());
    set_points(2);
    remove_ties_of(gone);
    drop_cable_node(world_, gone);
    segment.let_go(segment_ref(world_, c_, at()));
    outer_bend.let_go(bend_at(world_, c_, point(0)));
    inner_bend.let_go(bend_at(world_, c_, point(1)));
}

}  // namespace taut
