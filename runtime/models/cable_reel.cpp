// When segments are cut and joined, and what the files of links and particles share.
#include "models/cable_reel.h"

#include "sleep/wake.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

// Of the nominal segment. Apart enough that a segment just cut or joined is far from the other threshold.
constexpr double kDivide = 1.6, kJoin = 0.4;
constexpr double kMostPaid = 0.5;  // in a step; the speed that asks for it may have been set for shorter ones
constexpr double kRounding = 1e-6;  // by which a speed in the world's range may be above that
constexpr double kMakeGood = 0.1;  // of what passes an end, towards what was lost

template <class T>
void make_room(Array<T>& list) {
    if (list.size() == list.capacity()) list.reserve(list.size() + list.size() / 2 + 8);
}

}  // namespace

Kept::Kept(World& world, const JointRef& ref) : world_(world), ref_(ref) {
    const Joint* joint = find(world.joints, ref);
    if (!joint) return;
    const JointReading now = read_joint(world.nodes, *joint);
    for (int r = 0; r < joint->type->rows; ++r) error_[r] = now.value[r] - joint->drift[r];
    compliance_[0] = joint->compliance;
    compliance_[1] = joint->angular_compliance;
}

void Kept::let_go() const {
    Joint* joint = find(world_.joints, ref_);
    if (!joint) return;
    const JointReading reading = read_joint(world_.nodes, *joint);
    const double now[2] = {joint->compliance, joint->angular_compliance};
    for (int r = 0; r < joint->type->rows; ++r) {
        const int angle = is_angle(*joint, r);
        const double growth = compliance_[angle] > 0 ? now[angle] / compliance_[angle] : 1;
        joint->drift[r] = reading.value[r] - growth * error_[r];
    }
}

bool Reel::tied() const {
    return find(world_.joints, end_.joint) && moves(outer()) && (links() || (moves(second()) && segment_joint()));
}

bool Reel::can_join() const {
    if (c_.segments() < 2 || !moves(second()) || !segment_joint()) return false;
    if (links()) return true;
    const uint32_t third = e_ == 0 ? c_.node[2] : c_.node[c_.node.size() - 3];
    return moves(third) && find(world_.joints, e_ == 0 ? c_.joint[1] : c_.joint[c_.joint.size() - 2]);
}

void Reel::fit() {
    const double n = c_.nominal, d = plan().paid;
    while (true) {
        const double l = length();
        // What is left of a cut is not joined again: or the two would take turns for ever.
        const auto short_for_step = [&](double left) { return left < kJoin * n || left + d < kLeastReeled * n; };
        if (l > kDivide * n && !short_for_step(l - n) && c_.segments() < TAUT_CABLE_MAX_SEGMENTS)
            links() ? divide_link() : divide_particles();
        else if (short_for_step(l) && can_join())
            links() ? join_links() : join_particles();
        else
            return;
    }
}

Reel::Plan Reel::plan() const {
    const double most = kMostPaid * c_.nominal, change = end_.acceleration * step();
    Plan p{};
    p.speed = change > 0 ? std::clamp(end_.wanted_speed, end_.reel_speed - change, end_.reel_speed + change)
                         : end_.wanted_speed;
    const double fastest = (1 + kRounding) * most / step();
    p.speed = std::clamp(p.speed, -fastest, fastest);
    const double by_speed = p.speed * step();
    p.owed = std::clamp(end_.owed, std::min(0.0, -most - by_speed), std::max(0.0, most - by_speed));
    p.paid = by_speed + p.owed;
    p.paid += std::min(end_.lost, kMakeGood * std::abs(p.paid));
    return p;
}

void Reel::wake_up() { wake(world_, outer()); }

void Reel::advance() {
    const Plan p = plan();
    const double made_good = p.paid - p.speed * step() - p.owed;
    double d = std::max(p.paid, std::min(0.0, kLeastReeled * c_.nominal - length()));
    if (c_.segments() == TAUT_CABLE_MAX_SEGMENTS) d = std::min(d, std::max(0.0, kDivide * c_.nominal - length()));
    end_.reel_speed = p.speed;
    end_.owed -= p.owed;
    end_.lost -= made_good;
    end_.paid = d;
    if (d == 0) return;
    links() ? grow_link(d) : grow_particles(d);
}

void Reel::rest() {
    end_.paid = 0;
    if (!tied()) end_.reel_speed = end_.wanted_speed = end_.owed = end_.lost = 0;
}

void Reel::reserve_ended_of(std::initializer_list<uint32_t> nodes) {
    reserve_ended(world_.pairs, [&](const PairEnds& pair) {
        return std::any_of(nodes.begin(), nodes.end(), [&](uint32_t node) { return ends_on(node)(pair); });
    });
}

uint32_t Reel::add_parts(const NodeMotion& m, double share, std::span<JointRef> joints) {
    make_room(c_.node);
    make_room(c_.joint);
    make_room(c_.bend);
    make_room(c_.length);
    const uint32_t node = add_cable_node(world_, index_, m, share);
    size_t made = 0;
    try {
        if (!links()) add_segment(world_, c_, node, e_ == 0 ? second() : outer(), c_.nominal);
        for (; made < joints.size(); ++made) {
            joints[made].slot = world_.joints.add(Joint{});
            joints[made].serial = world_.joints.record[joints[made].slot].serial;
        }
    } catch (...) {
        while (made > 0) world_.joints.remove(joints[--made].slot);
        drop_cable_node(world_, node);  // no pairs yet: does not throw
        throw;
    }
    return node;
}

Joint& Reel::place_joint(const JointRef& ref, Joint joint) {
    joint.serial = ref.serial;
    joint.fresh = false;
    return world_.joints.record[ref.slot] = joint;
}

void Reel::blend(const JointRef& ref, double weight, double* force) const {
    const Joint* joint = find(world_.joints, ref);
    for (int r = 0; joint && r < joint->type->rows; ++r) force[r] += weight * joint->lambda[r];
}

void Reel::load(Joint& joint, const double* force) {
    for (int r = 0; r < joint.type->rows; ++r) {
        joint.lambda[r] = force[r];
        joint.drift[r] = row_compliance(joint, r) * force[r];
    }
}

void Reel::remove_joints_of(uint32_t node) {
    for (uint32_t j = 0; j < world_.joints.ids.slots(); ++j)
        if (ends_on(world_.joints.record[j], node)) world_.joints.remove(j);
}

namespace {

template <class Act>
void for_each_reel(World& world, Act act) {
    for (uint32_t index = 0; index < world.cables.ids.slots(); ++index) {
        if (!world.cables.ids.live(index)) continue;
        for (int end = 0; end < 2; ++end) act(Reel(world, index, end));
    }
}

}  // namespace

void reel_cables(World& world) {
    drop_loose_parts(world);
    for_each_reel(world, [&](Reel reel) {
        if (!reel.works()) return;
        reel.wake_up();
        reel.fit();
    });
    for_each_reel(world, [](Reel reel) { reel.works() ? reel.advance() : reel.rest(); });
}

}  // namespace taut
