// When segments are cut and joined, and what the files of links and particles share.
#include "models/cable_reel.h"

#include "models/attachments.h"
#include "sleep/wake.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

// Of the nominal segment. Apart enough that a segment just cut or joined is far from the other threshold.
constexpr double kDivide = 1.6, kJoin = 0.4;
constexpr double kMostPaid = 0.5;   // in a step; the speed that asks for it may have been set for shorter ones
constexpr double kRounding = 1e-6;  // by which a speed in the world's range may be above that
constexpr double kMakeGood = 0.1;   // of what passes an end, towards what was lost

template <class T>
void make_room(Array<T>& list) {
    if (list.size() == list.capacity()) list.reserve(list.size() + list.size() / 2 + 8);
}

}  // namespace

Kept::Kept(World& world, const ConstraintRef& ref) : world_(world), ref_(ref) {
    const ConstraintView view = view_of(world, ref);
    if (!view) return;
    view.read(world.nodes, error_);
    for (int r = 0; r < view.type->rows; ++r) error_[r] -= view.drift[r];
    std::copy_n(view.compliance, 2, compliance_);
}

void Kept::let_go(const ConstraintRef& now) const {
    const ConstraintView view = view_of(world_, now);
    if (!view) return;
    double value[kMaxRows];
    view.read(world_.nodes, value);
    double* const drift = drift_of(world_, now);
    for (int r = 0; r < view.type->rows; ++r) {
        const double before = compliance_[view.is_angle(r)];
        const double growth = before > 0 ? view.compliance_of(r) / before : 1;
        drift[r] = value[r] - growth * error_[r];
    }
}

bool Reel::tied() const {
    return find(world_.joints, end_.joint) && moves(outer()) && (links() || (moves(second()) && is_whole()));
}

bool Reel::can_join() const {
    if (c_.segments() < 2 || !moves(second()) || !is_whole()) return false;
    if (links()) return true;
    const uint32_t third = e_ == 0 ? c_.node[2] : c_.node[c_.node.size() - 3];
    return moves(third) && taut::is_whole(world_, c_, e_ == 0 ? 1 : at() - 1);
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

uint32_t Reel::add_parts(const NodeMotion& m, double share, JointRef* joint) {
    make_room(c_.node);
    make_room(c_.joint);
    make_room(c_.length);
    for (const uint32_t set : {c_.stretch, c_.bending})
        if (set != kNone) reserve_elements(world_.elements.set[set], 1);
    const uint32_t node = add_cable_node(world_, index_, m, share);
    try {
        if (!links()) add_segment(world_, c_, node, e_ == 0 ? second() : outer(), c_.nominal);
        if (joint) {
            joint->slot = world_.joints.add(Joint{});
            joint->serial = world_.joints.record[joint->slot].serial;
        }
    } catch (...) {
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

void Reel::blend(const ConstraintRef& ref, double weight, double* force) const {
    const ConstraintView view = view_of(world_, ref);
    for (int r = 0; view && r < view.type->rows; ++r) force[r] += weight * view.lambda[r];
}

void Reel::load(const ConstraintRef& ref, const double* force) {
    const ConstraintView view = view_of(world_, ref);
    for (int r = 0; r < view.type->rows; ++r) {
        lambda_of(world_, ref)[r] = force[r];
        drift_of(world_, ref)[r] = view.compliance_of(r) * force[r];
    }
}

void Reel::remove_ties_of(uint32_t node) {
    for (uint32_t j = 0; j < world_.joints.ids.slots(); ++j)
        if (ends_on(world_.joints.record[j], node)) world_.joints.remove(j);
    drop_attachments(world_, [&](uint32_t end) { return end == node; });
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
