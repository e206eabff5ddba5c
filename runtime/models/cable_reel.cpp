// Reeling without kicks. Whatever changes at an end, a joint goes on as it was: it keeps lambda, and its error at the
// start of the step counts as what it was before, or as that times the growth of its compliance, by which the same
// force holds. Joint::drift lets the difference come bit by bit over the substeps of the frame.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "constraints/distance.h"
#include "models/bodies.h"
#include "models/cable.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

// Of the nominal segment. Apart enough that a segment just cut or joined is far from the other threshold.
constexpr double kDivide = 1.6, kJoin = 0.4, kLeast = 0.2;
constexpr double kMostPaid = 0.5;  // in a step
constexpr double kMakeGood = 0.1;  // of what passes an end, towards what was lost

void evaluate(const World& world, const Joint& joint, double* error) {
    Pose poses[kMaxNodes];
    for (int i = 0; i < 2; ++i) {
        if (joint.node[i] == kNone) continue;
        const NodeMotion& m = world.nodes.motion[joint.node[i]];
        poses[i] = {m.x, m.q.toRotationMatrix()};
    }
    joint.type->evaluate(joint.data, poses, error, nullptr);
}

// A joint before a change, to be let go after it.
class Kept {
public:
    Kept(World& world, const JointRef& ref) : world_(world), ref_(ref) {
        const Joint* joint = find(world.joints, ref);
        if (!joint) return;
        evaluate(world, *joint, error_);
        for (int r = 0; r < joint->type->rows; ++r) error_[r] -= joint->drift[r];
        compliance_[0] = joint->compliance;
        compliance_[1] = joint->angular_compliance;
    }
    void let_go() const {
        Joint* joint = find(world_.joints, ref_);
        if (!joint) return;
        double error[kMaxRows];
        evaluate(world_, *joint, error);
        const double now[2] = {joint->compliance, joint->angular_compliance};
        for (int r = 0; r < joint->type->rows; ++r) {
            const int angle = joint->type->angular >> r & 1;
            const double growth = compliance_[angle] > 0 ? now[angle] / compliance_[angle] : 1;
            joint->drift[r] = error[r] - growth * error_[r];
        }
    }

private:
    World& world_;
    JointRef ref_;
    double error_[kMaxRows] = {}, compliance_[2] = {};
};

// Of one end of one cable.
class Reel {
public:
    Reel(World& world, uint32_t index, int end)
        : world_(world), index_(index), e_(end), c_(world.cables.record[index]), end_(c_.end[end]) {}

    bool tied() const {
        return find(world_.joints, end_.joint) && moves(outer()) && (links() || (moves(second()) && segment_joint()));
    }
    bool works() const { return tied() && (end_.reel_speed != 0 || end_.wanted_speed != 0 || end_.owed != 0); }

    // Cuts and joins segments until the end segment can change by what is planned.
    void fit() {
        const double n = c_.nominal, d = plan().paid;
        while (true) {
            const double l = length();
            if (l > kDivide * n && c_.segments() < TAUT_CABLE_MAX_SEGMENTS)
                links() ? divide_link() : divide_particles();
            else if ((l < kJoin * n || l + d < kLeast * n) && can_join())
                links() ? join_links() : join_particles();
            else
                return;
        }
    }

    void advance() {
        const Plan p = plan();
        const double made_good = p.paid - p.speed * step() - p.owed;
        double d = std::max(p.paid, std::min(0.0, kLeast * c_.nominal - length()));
        if (c_.segments() == TAUT_CABLE_MAX_SEGMENTS) d = std::min(d, std::max(0.0, kDivide * c_.nominal - length()));
        end_.reel_speed = p.speed;
        end_.owed -= p.owed;
        end_.lost -= made_good;
        end_.paid = d;
        if (d == 0) return;
        links() ? grow_link(d) : grow_particles(d);
    }

    void rest() {
        end_.paid = 0;
        if (!tied()) end_.reel_speed = end_.wanted_speed = end_.owed = end_.lost = 0;
    }

private:
    struct Plan {
        double speed, owed, paid;  // [m/s], of what is owed [m], in all [m]
    };

    Plan plan() const {
        const double most = kMostPaid * c_.nominal, change = end_.acceleration * step();
        Plan p{};
        p.speed = change > 0 ? std::clamp(end_.wanted_speed, end_.reel_speed - change, end_.reel_speed + change)
                             : end_.wanted_speed;
        const double by_speed = p.speed * step();
        p.owed = std::clamp(end_.owed, std::min(0.0, -most - by_speed), std::max(0.0, most - by_speed));
        p.paid = by_speed + p.owed;
        p.paid += std::min(end_.lost, kMakeGood * std::abs(p.paid));
        return p;
    }

    double step() const { return world_.def.time_step; }
    bool links() const { return c_.kind == CableKind::links; }
    uint32_t at() const { return e_ == 0 ? 0 : c_.segments() - 1; }  // the end segment
    double& length() const { return c_.length[at()]; }
    uint32_t outer() const { return e_ == 0 ? c_.node.front() : c_.node.back(); }
    uint32_t second() const { return e_ == 0 ? c_.node[1] : c_.node[c_.node.size() - 2]; }
    NodeMotion& motion(uint32_t node) const { return world_.nodes.motion[node]; }
    bool moves(uint32_t node) const { return moves_by_forces(world_.nodes.info[node].kind); }
    bool segment_joint() const { return find(world_.joints, e_ == 0 ? c_.joint.front() : c_.joint.back()); }
    // The joint of a link on the side away from this end.
    const JointRef& inner(uint32_t i) const { return e_ == 0 ? joint_after(c_, i) : joint_before(c_, i); }

    bool can_join() const {
        if (c_.segments() < 2 || !moves(second()) || !segment_joint()) return false;
        if (links()) return true;
        const uint32_t third = e_ == 0 ? c_.node[2] : c_.node[c_.node.size() - 3];
        return moves(third) && find(world_.joints, e_ == 0 ? c_.joint[1] : c_.joint[c_.joint.size() - 2]);
    }

    template <class T>
    void insert(Array<T>& list, const T& value, uint32_t from_end) {
        list.insert(e_ == 0 ? list.begin() + from_end : list.end() - from_end, value);
    }
    template <class T>
    void erase(Array<T>& list, uint32_t from_end) {
        list.erase(e_ == 0 ? list.begin() + from_end : list.end() - 1 - from_end);
    }
    template <class T>
    static void make_room(Array<T>& list) {
        if (list.size() == list.capacity()) list.reserve(list.size() + list.size() / 2 + 8);
    }

    // A node and the slot of a joint; all that may fail when a segment is cut.
    uint32_t add_parts(const NodeMotion& m, double share, JointRef& joint) {
        make_room(c_.node);
        make_room(c_.joint);
        make_room(c_.length);
        const uint32_t node = add_cable_node(world_, index_, m, share);
        try {
            joint.slot = world_.joints.add(Joint{});
        } catch (...) {
            drop_cable_node(world_, node);  // no pairs yet: does not throw
            throw;
        }
        joint.serial = world_.joints.record[joint.slot].serial;
        return node;
    }
    Joint& place_joint(const JointRef& ref, Joint joint) {
        joint.serial = ref.serial;
        joint.fresh = false;
        return world_.joints.record[ref.slot] = joint;
    }

    // A joint of someone else on a node that goes away with it; forgotten pairs have their room.
    void remove_joints_of(uint32_t node) {
        for (uint32_t j = 0; j < world_.joints.ids.slots(); ++j) {
            if (!world_.joints.ids.live(j)) continue;
            const Joint& joint = world_.joints.record[j];
            if (joint.node[0] == node || joint.node[1] == node) world_.joints.remove(j);
        }
    }

    // ------------------------------------------------------------ links

    Vec3 outward(const NodeMotion& m) const { return m.q * Vec3(0, e_ == 0 ? -1 : 1, 0); }

    static NodeMotion moved(const NodeMotion& m, const Vec3& offset) {
        NodeMotion out = m;
        out.x += offset;
        out.v += m.w.cross(offset);
        out.slow_v += m.slow_w.cross(offset);
        return out;
    }

    // Anchors and softness of the joints of link i after changes of length.
    void retie(uint32_t i) {
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

    void grow_link(double d) {
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
    void divide_link() {
        const uint32_t old = outer();
        const double l = length(), n = c_.nominal, rest = l - n;
        const Vec3 out = outward(motion(old));
        reserve_ended(world_.pairs, ends_on(old));
        JointRef ref;
        const uint32_t node = add_parts(moved(motion(old), 0.5 * n * out), rest, ref);

        const Kept outer_joint(world_, end_.joint), inner_joint(world_, inner(at()));
        double force[kMaxRows] = {};  // at the cut
        blend(inner(at()), rest / l, force);
        blend(end_.joint, n / l, force);
        shift_centre(world_, old, -0.5 * rest * out);
        length() = n;
        insert(c_.node, node, 0);
        insert(c_.length, rest, 0);
        insert(c_.joint, ref, 0);
        const uint32_t outer_link = at(), inner_link = e_ == 0 ? 1 : outer_link - 1;
        Joint& joint = place_joint(ref, make_inner_joint(c_, std::min(outer_link, inner_link)));
        for (int r = 0; r < joint.type->rows; ++r) {
            // Straight, and soon bent and stretched as this force asks.
            const bool angle = joint.type->angular >> r & 1;
            joint.lambda[r] = force[r];
            joint.drift[r] = (angle ? joint.angular_compliance : joint.compliance) * force[r];
        }
        set_cable_mass(world_, c_, inner_link);
        retie(inner_link);
        retie(outer_link);
        outer_joint.let_go();
        inner_joint.let_go();
        // The old link may touch from now on what the new one hangs on.
        const uint32_t tie = find(world_.joints, end_.joint)->node[e_ == 0 ? 0 : 1];
        if (tie != kNone) forget_pairs(world_.pairs, world_.nodes, world_.colliders, between_nodes(old, tie));
    }

    void blend(const JointRef& ref, double weight, double* force) const {
        const Joint* joint = find(world_.joints, ref);
        for (int r = 0; joint && r < joint->type->rows; ++r) force[r] += weight * joint->lambda[r];
    }

    // The end link goes, the next one reaches to its outer end.
    void join_links() {
        const uint32_t gone = outer(), kept = second(), i = at(), k = e_ == 0 ? 1 : i - 1;
        reserve_ended_of(gone, kept);
        const Kept outer_joint(world_, end_.joint), inner_joint(world_, inner(k));
        double gap[kMaxRows];
        const JointRef between = e_ == 0 ? c_.joint.front() : c_.joint.back();
        const Joint& lost = *find(world_.joints, between);
        evaluate(world_, lost, gap);
        const double stretch = lost.compliance > 0 ? Vec3::Map(gap).norm() : 0;

        const NodeMotion& a = motion(gone);
        NodeMotion& b = motion(kept);
        const NodeMotion far = moved(a, 0.5 * c_.length[i] * outward(a));
        const NodeMotion near = moved(b, -0.5 * c_.length[k] * outward(b));
        const Vec3 chord = far.x - near.x;
        const double total = c_.length[i] + c_.length[k], size = chord.norm();
        const double joined = std::min(total, size - stretch);
        const Vec3 out = chord / size;
        NodeMotion now = b;
        now.x = 0.5 * (far.x + near.x);
        now.q = (turn_between(outward(b), out) * b.q).normalized();
        // Ends move as they did; the spin about the axis is that of the link that stays.
        const auto spin = [&](const Vec3& v, const Vec3& w) {
            return Vec3(chord.cross(v) / (size * size) + out.dot(w) * out);
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
        remove_joints_of(gone);
        drop_cable_node(world_, gone);
        if (tie != kNone) forget_pairs(world_.pairs, world_.nodes, world_.colliders, between_nodes(kept, tie));
    }

    void reserve_ended_of(uint32_t a, uint32_t b) {
        reserve_ended(world_.pairs, [&](const Pair& pair) { return ends_on(a)(pair) || ends_on(b)(pair); });
    }

    // ------------------------------------------------------------ particles

    static void set_length(const Cable& cable, Joint& joint, double length) {
        std::memcpy(joint.data + offsetof(DistanceData, length), &length, sizeof length);
        set_softness(cable, joint, length);
    }

    void set_masses(uint32_t count) {
        for (uint32_t k = 0; k < count; ++k)
            set_cable_mass(world_, c_, e_ == 0 ? k : static_cast<uint32_t>(c_.node.size()) - 1 - k);
    }

    void grow_particles(double d) {
        const JointRef ref = c_.joint[at()];
        const Kept segment(world_, ref);
        length() += d;
        set_length(c_, *find(world_.joints, ref), length());
        set_masses(2);
        segment.let_go();
    }

    // Cuts a nominal segment off the inner end.
    void divide_particles() {
        const double l = length(), n = c_.nominal, part = n / l, rest = l - n;
        const NodeMotion &far = motion(outer()), &near = motion(second());
        const Vec3 span = far.x - near.x, out = span / std::max(span.norm(), 1e-12);
        NodeMotion m;
        m.x = near.x + part * span;
        // Between the two, but for the speed at which the outer part alone grows.
        m.v = near.v + part * (far.v - near.v - end_.paid / step() * out);
        m.slow_v = near.slow_v + part * (far.slow_v - near.slow_v - end_.paid / step() * out);
        JointRef ref;
        const uint32_t node = add_parts(m, 0.5 * l, ref);

        const JointRef outer_ref = c_.joint[at()];
        const Kept segment(world_, outer_ref);
        length() = n;
        insert(c_.node, node, 1);
        insert(c_.length, rest, 0);
        insert(c_.joint, ref, 1);
        Joint& outer_joint = *find(world_.joints, outer_ref);
        Joint& joint = place_joint(ref, make_inner_joint(c_, e_ == 0 ? 1 : at() - 1));
        joint.lambda[0] = outer_joint.lambda[0];
        outer_joint.node[e_ == 0 ? 1 : 0] = node;
        set_length(c_, outer_joint, rest);
        set_masses(3);
        segment.let_go();
    }

    // The second point goes.
    void join_particles() {
        const uint32_t gone = second(), i = at(), k = e_ == 0 ? 1 : i - 1;
        const JointRef outer_ref = c_.joint[i], inner_ref = c_.joint[k];
        const Kept segment(world_, outer_ref);
        Joint &a = *find(world_.joints, outer_ref), &b = *find(world_.joints, inner_ref);
        double stretch[2] = {};
        if (a.compliance > 0) evaluate(world_, a, &stretch[0]), evaluate(world_, b, &stretch[1]);
        const uint32_t third = b.node[e_ == 0 ? 1 : 0];
        const double la = c_.length[i], lb = c_.length[k];
        const double chord = (motion(outer()).x - motion(third).x).norm();
        const double joined = std::max(kLeast * c_.nominal, std::min(la + lb, chord - stretch[0] - stretch[1]));
        a.node[e_ == 0 ? 1 : 0] = third;
        a.lambda[0] = (la * a.lambda[0] + lb * b.lambda[0]) / (la + lb);
        set_length(c_, a, joined);
        end_.lost += la + lb - joined;
        c_.length[k] = joined;
        erase(c_.length, 0);
        erase(c_.node, 1);
        erase(c_.joint, 1);
        remove_joints_of(gone);
        drop_cable_node(world_, gone);
        set_masses(2);
        segment.let_go();
    }

    World& world_;
    uint32_t index_;
    int e_;
    Cable& c_;
    CableEnd& end_;
};

template <class Act>
void for_each_reel(World& world, Act act) {
    for (uint32_t index = 0; index < world.cables.ids.slots(); ++index) {
        if (!world.cables.ids.live(index)) continue;
        for (int end = 0; end < 2; ++end) act(Reel(world, index, end));
    }
}

}  // namespace

void reel_cables(World& world) {
    for_each_reel(world, [](Reel reel) {
        if (reel.works()) reel.fit();
    });
    for_each_reel(world, [](Reel reel) { reel.works() ? reel.advance() : reel.rest(); });
}

}  // namespace taut
