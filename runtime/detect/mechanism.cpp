#include "detect/mechanism.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace taut {

namespace {

constexpr uint32_t kMostStays = 10;  // frames; in the next it goes on

// A kinematic body on its way.
bool drives(const Nodes& nodes, uint32_t node) {
    const NodeMotion& m = nodes.motion[node];
    return nodes.info[node].kind == NodeKind::kinematic && (m.v != Vec3::Zero() || m.w != Vec3::Zero());
}

// Elements that keep their nodes as they are against each other: what is elastic gives, as its nodes are put back one
// by one.
bool holds(const ElementSet& set) { return set.type && set.form == ElementForm::rows; }

// act(nodes) for what ties them so.
template <class Act>
void for_each_hold(const Joints& joints, const Elements& elements, Act&& act) {
    for (const Joint& joint : joints.record)
        if (joint.type) act(joint.nodes());
    for_each_element(elements, [&](const ElementSet& set, uint32_t, std::span<const uint32_t> nodes) {
        if (holds(set)) act(nodes);
    });
}

// Into Mechanisms::tie, by the root that root_of(ends) says, in the order of these; kNone is left out.
template <class RootOf>
void list_ties(const Joints& joints, const Elements& elements, Mechanisms& of, RootOf&& root_of) {
    const auto for_refs = [&](auto&& act) {
        for (uint32_t j = 0; j < joints.record.size(); ++j) act(joints.record[j].nodes(), ConstraintRef{kNone, j});
        for (uint32_t s = 0; s < elements.set.size(); ++s)
            for (uint32_t e = 0; holds(elements.set[s]) && e < elements.set[s].size(); ++e)
                if (elements.set[s].lives(e)) act(elements.set[s].nodes_of(e), ConstraintRef{s, e});
    };
    // Counts two places on, so that what is filled below ends as where each begins.
    of.first_tie.assign(of.root.size() + 2, 0);
    for_refs([&](std::span<const uint32_t> ends, ConstraintRef) {
        if (const uint32_t root = root_of(ends); root != kNone) ++of.first_tie[root + 2];
    });
    std::partial_sum(of.first_tie.begin(), of.first_tie.end(), of.first_tie.begin());
    of.open.clear();
    reserve_more(of.open, of.first_tie.back());
    of.tie.resize(of.first_tie.back());
    for_refs([&](std::span<const uint32_t> ends, ConstraintRef ref) {
        if (const uint32_t root = root_of(ends); root != kNone) of.tie[of.first_tie[root + 1]++] = ref;
    });
}

}  // namespace

bool Mechanism::may_stay() {
    if (!moves_) return true;
    auto stay = std::find_if(all_.stays.begin(), all_.stays.end(), [&](const Stay& s) { return s.root == root_; });
    if (stay == all_.stays.end()) stay = all_.stays.insert(stay, {root_, 0, false});
    if (!stay->now) ++stay->frames;
    stay->now = true;
    return stay->frames <= kMostStays;
}

void end_stays(Mechanisms& of) {
    std::erase_if(of.stays, [](const Stay& s) { return !s.now || s.frames > kMostStays; });
    for (Stay& stay : of.stays) stay.now = false;
}

void find_mechanisms(const Nodes& nodes, const Joints& joints, const Elements& elements, Mechanisms& of) {
    const uint32_t slots = nodes.slots();
    Array<uint32_t>& root = of.root;
    root.resize(slots);
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t node) {
        while (root[node] != node) node = root[node] = root[root[node]];
        return node;
    };
    const auto held = [&](uint32_t node) { return node == kNone || !nodes.solved(node); };
    for_each_hold(joints, elements, [&](std::span<const uint32_t> ends) {
        uint32_t last = kNone;
        for (const uint32_t node : ends) {
            if (held(node)) continue;
            const uint32_t one = find(node), other = last == kNone ? one : find(last);
            root[std::max(one, other)] = std::min(one, other);
            last = node;
        }
    });
    of.next.resize(slots);
    std::iota(of.next.begin(), of.next.end(), 0u);
    for (uint32_t node = 0; node < slots; ++node) {
        root[node] = find(node);
        if (root[node] != node) of.next[node] = std::exchange(of.next[root[node]], node);
    }
    of.drive.assign(slots, 0);
    for (uint32_t node = 0; node < slots; ++node) {
        if (!held(node)) of.drive[root[node]] += static_cast<float>(nodes.mass[node].mass);
        of.any_drives = of.any_drives || drives(nodes, node);
    }
    of.ties.assign(slots, 0);
    for_each_hold(joints, elements, [&](std::span<const uint32_t> ends) {
        const bool anchored = std::any_of(ends.begin(), ends.end(), held);
        for (const uint32_t node : ends)
            if (!held(node)) of.ties[root[node]] |= anchored ? kJointed | kAnchored : kJointed;
    });
    list_ties(joints, elements, of, [&](std::span<const uint32_t> ends) {
        const auto end = std::find_if_not(ends.begin(), ends.end(), held);
        return end == ends.end() ? kNone : root[*end];
    });
    of.put_back.assign(slots, 0);
}

}  // namespace taut
