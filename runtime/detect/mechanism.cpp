#include "detect/mechanism.h"

#include <algorithm>
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
        if (joint.works()) act(joint.nodes());
    for_each_element(elements, [&](const ElementSet& set, uint32_t, std::span<const uint32_t> nodes) {
        if (holds(set)) act(nodes);
    });
}

// Into Mechanisms::tie, by the root that root_of(ends) says, in the order of these; kNone is left out.
template <class RootOf>
void list_ties(const Nodes& nodes, const Joints& joints, const Elements& elements, Mechanisms& of, RootOf&& root_of) {
    const auto for_refs = [&](auto&& act) {
        for (uint32_t j = 0; j < joints.record.size(); ++j) act(joints.record[j].nodes(), ConstraintRef{kNone, j});
        for (uint32_t s = 0; s < elements.set.size(); ++s)
            for (uint32_t e = 0; holds(elements.set[s]) && e < elements.set[s].size(); ++e)
                if (elements.set[s].lives(e)) act(elements.set[s].nodes_of(e), ConstraintRef{s, e});
    };
    of.ties_of.resize(nodes.slots());
    for (const uint32_t node : nodes.active) of.ties_of[node] = {};
    for_refs([&](std::span<const uint32_t> ends, ConstraintRef) {
        if (const uint32_t root = root_of(ends); root != kNone) ++of.ties_of[root].end;
    });
    uint32_t all = 0;
    for (const uint32_t node : nodes.active) {
        const uint32_t begin = std::exchange(all, all + of.ties_of[node].end);
        of.ties_of[node] = {begin, begin};
    }
    of.open.clear();
    reserve_more(of.open, all);
    of.tie.resize(all);
    for_refs([&](std::span<const uint32_t> ends, ConstraintRef ref) {
        if (const uint32_t root = root_of(ends); root != kNone) of.tie[of.ties_of[root].end++] = ref;
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

void end_mechanisms(const Nodes& nodes, Mechanisms& of) {
    if (std::exchange(of.found, false))
        for (const uint32_t node : nodes.active) of.put_back[node] = 0;
    std::erase_if(of.stays, [](const Stay& s) { return !s.now || s.frames > kMostStays; });
    for (Stay& stay : of.stays) stay.now = false;
}

void find_mechanisms(const Nodes& nodes, const Joints& joints, const Elements& elements, Mechanisms& of) {
    const auto begin = [&](auto& by_node, auto&& value_of) {
        by_node.resize(nodes.slots());
        for (const uint32_t node : nodes.active) by_node[node] = value_of(node);
    };
    const auto itself = [](uint32_t node) { return node; };
    const auto none = [](uint32_t) { return uint8_t{0}; };
    Array<uint32_t>& root = of.root;
    begin(root, itself);
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
    begin(of.next, itself);
    for (const uint32_t node : nodes.active) {
        root[node] = find(node);
        if (root[node] != node) of.next[node] = std::exchange(of.next[root[node]], node);
    }
    begin(of.drive, none);
    for (const uint32_t node : nodes.active) {
        if (!held(node)) of.drive[root[node]] += static_cast<float>(nodes.mass[node].mass);
        of.any_drives = of.any_drives || drives(nodes, node);
    }
    begin(of.ties, none);
    for_each_hold(joints, elements, [&](std::span<const uint32_t> ends) {
        const bool anchored = std::any_of(ends.begin(), ends.end(), held);
        for (const uint32_t node : ends)
            if (!held(node)) of.ties[root[node]] |= anchored ? kJointed | kAnchored : kJointed;
    });
    list_ties(nodes, joints, elements, of, [&](std::span<const uint32_t> ends) {
        const auto end = std::find_if_not(ends.begin(), ends.end(), held);
        return end == ends.end() ? kNone : root[*end];
    });
    begin(of.put_back, none);
    of.found = true;
}

}  // namespace taut
