// The end of a cable of links: how its link grows, is cut, and is joined with the next.
#include <algorithm>

#include "models/cable_reel.h"

namespace taut {
namespace {

constexpr double kFolded = 1e-9;  // chord of two links against what they are joined to

NodeMotion moved(const NodeMotion& m, const Vec3& offset) {
    NodeMotion out = m;
    out.x += offset;
    out.v += m.w.cross(offset);
    out.slow_v += m.slow_w.cross(offset);
    return out;
}

}  // namespace

// Anchors and softness of the joints of link i after changes of length.
void Reel::retie(uint32_t i) {
    if (Joint* joint = find(world_.joints, joint_before(c_, i))) {
        joint->node[1] = c_.node[i];
        set_anchor(*joint, 1, {0, -0.5 * c_.length[i], 0});
        set_softness(c_, *joint, span_before(c_, i));
    }
    if (Joint* joint = find(world_.joints, joint_after(c_, i))) {
        joint->node[0] = c_.node[i];
        set_anchor(*joint, 0, {0, 0.5 * c_.length[i], 0});
        set_softness(c_, *joint, span_after(c_, i));
    }
}

void Reel::grow_link(double d) {
    const uint32_t i = at();
    const Kept outer_joint(world_, end_.joint), inner_joint(world_, inner(i));
    // The inner end stays on the next link; what is new comes out of where the cable is tied.
    shift_centre(world_, outer(), 0.5 * d * outward(motion(outer())));
    c_.length[i] += d;
    set_cable_mass(world_, c_, i);
    retie(i);
    outer_joint.let_go();
    inner_joint.let_go();
}

// Cuts a nominal link off the inner end, which stays the node that it is.
void Reel::divide_link() {
    const uint32_t old = outer();
    const double l = length(), n = c_.nominal, rest = l - n;
    const Vec3 out = outward(motion(old));
    reserve_ended_of({old});
    JointRef ref;
    const uint32_t node = add_parts(moved(motion(old), 0.5 * n * out), rest, &ref);

    const Kept outer_joint(world_, end_.joint), inner_joint(world_, inner(at()));
    double force[kMaxRows] = {};  // at the cut
    blend(ref_of(world_, inner(at())), rest / l, force);
    blend(ref_of(world_, end_.joint), n / l, force);
    shift_centre(world_, old, -0.5 * rest * out);
    length() = n;
    insert(c_.node, node, 0);
    insert(c_.length, rest, 0);
    insert(c_.joint, ref, 0);
    const uint32_t outer_link = at(), inner_link = e_ == 0 ? 1 : outer_link - 1;
    place_joint(ref, make_inner_joint(c_, std::min(outer_link, inner_link)));
    load(ref_of(world_, ref), force);
    set_cable_mass(world_, c_, inner_link);
    retie(inner_link);
    retie(outer_link);
    outer_joint.let_go();
    inner_joint.let_go();
    // The old link may touch from now on what the new one hangs on.
    const uint32_t tie = find(world_.joints, end_.joint)->node[e_ == 0 ? 0 : 1];
    if (tie != kNone) forget_pairs(world_.pairs, world_.nodes, world_.colliders, between_nodes(old, tie));
}

// The end link goes, the next one reaches to its outer end.
void Reel::join_links() {
    const uint32_t gone = outer(), kept = second(), i = at(), k = e_ == 0 ? 1 : i - 1;
    reserve_ended_of({gone, kept});
    const Kept outer_joint(world_, end_.joint), inner_joint(world_, inner(k));
    const JointRef between = e_ == 0 ? c_.joint.front() : c_.joint.back();
    const Joint& lost = *find(world_.joints, between);
    const JointReading gap = read_joint(world_.nodes, lost);
    const double stretch = lost.compliance > 0 ? Vec3::Map(gap.value).norm() : 0;

    const NodeMotion& a = motion(gone);
    NodeMotion& b = motion(kept);
    const NodeMotion far = moved(a, 0.5 * c_.length[i] * outward(a));
    const NodeMotion near = moved(b, -0.5 * c_.length[k] * outward(b));
    const Vec3 chord = far.x - near.x;
    const double total = c_.length[i] + c_.length[k], size = chord.norm();
    const double joined = std::max(kLeastReeled * c_.nominal, std::min(total, size - stretch));
    const double reach = std::max(joined, size);
    // Folded on one another they have no direction between them: that of the link that stays.
    const Vec3 out = size > kFolded * joined ? Vec3(chord / size) : outward(b);
    NodeMotion now = b;
    now.x = 0.5 * (far.x + near.x);
    now.q = (turn_between(outward(b), out) * b.q).normalized();
    // Ends move as they did; the spin about the axis is that of the link that stays.
    const auto spin = [&](const Vec3& v, const Vec3& w) {
        return Vec3(chord.cross(v) / (reach * reach) + out.dot(w) * out);
    };
    now.v = 0.5 * (far.v + near.v);
    now.w = spin(far.v - near.v, b.w);
    now.slow_v = 0.5 * (far.slow_v + near.slow_v);
    now.slow_w = spin(far.slow_v - near.slow_v, b.slow_w);
    shift_centre(world_, kept, now.x - b.x);
    b = now;

    end_.lost += total - joined;
    c_.length[k] = joined;
    erase(c_.node, 0);
    erase(c_.joint, 0);
    erase(c_.length, 0);
    const uint32_t tie = find(world_.joints, end_.joint)->node[e_ == 0 ? 0 : 1];
    world_.joints.remove(between.slot);
    set_cable_mass(world_, c_, at());
    retie(at());
    outer_joint.let_go();
    inner_joint.let_go();
    remove_ties_of(gone);
    drop_cable_node(world_, gone);
    if (tie != kNone) forget_pairs(world_.pairs, world_.nodes, world_.colliders, between_nodes(kept, tie));
}

}  // namespace taut
