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

void find_mechanisms(const Nodes& nodes, const Joints& joints, Mechanisms& of) {
    const uint32_t slots = nodes.slots();
    Array<uint32_t>& root = of.root;
    root.resize(slots);
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](uint32_t node) {
        while (root[node] != node) node = root[node] = root[root[node]];
        return node;
    };
    const auto held = [&](uint32_t node) { return node == kNone || !nodes.solved(node); };
    for (const Joint& joint : joints.record) {
        uint32_t last = kNone;
        for (const uint32_t node : joint.nodes()) {
            if (held(node)) continue;
            const uint32_t one = find(node), other = last == kNone ? one : find(last);
            root[std::max(one, other)] = std::min(one, other);
            last = node;
        }
    }
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
    for (const Joint& joint : joints.record) {
        const auto ends = joint.nodes();
        const bool anchored = std::any_of(ends.begin(), ends.end(), held);
        for (const uint32_t node : ends)
            if (!held(node)) of.ties[root[node]] |= anchored ? kJointed | kAnchored : kJointed;
    }
    of.first_joint.assign(slots, kNone);
    of.next_joint.assign(joints.record.size(), kNone);
    of.open.clear();
    reserve_more(of.open, joints.record.size());
    for (uint32_t j = static_cast<uint32_t>(joints.record.size()); j-- > 0;) {
        const auto ends = joints.record[j].nodes();
        const auto end = std::find_if_not(ends.begin(), ends.end(), held);
        if (end != ends.end()) of.next_joint[j] = std::exchange(of.first_joint[root[*end]], j);
    }
    of.put_back.assign(slots, 0);
}

}  // namespace taut
