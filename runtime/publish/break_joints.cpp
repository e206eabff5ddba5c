// Of the joints and attachments of a mechanism that carry more than they bear, the one that does so most breaks: those
// that carry the same force are relieved by it, and what the others carry is known after the next step. Mechanisms,
// bodies that joints and elements tie together, break each on its own.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "models/attachments.h"
#include "models/bodies.h"
#include "publish/publish.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"
#include "threads/gather.h"

namespace taut {
namespace {

taut_vec3 public_vector(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

// Joints and, behind them, attachments by one index.
class Ties {
public:
    explicit Ties(const World& world) : w_(world), joints_(static_cast<uint32_t>(world.joints.record.size())) {}

    uint32_t count() const { return joints_ + static_cast<uint32_t>(w_.attachments.record.size()); }
    bool is_joint(uint32_t tie) const { return tie < joints_; }
    uint32_t attachment(uint32_t tie) const { return tie - joints_; }

    // What it carries in parts of what it bears.
    double load_ratio(uint32_t tie) const {
        if (is_joint(tie)) {
            const Joint& joint = w_.joints.record[tie];
            const Wrench load = wrench_of(joint, read_joint(w_.nodes, joint));
            return std::max(load.force.norm() / joint.break_force, load.torque.norm() / joint.break_torque);
        }
        const Attachment& of = w_.attachments.record[attachment(tie)];
        const AttachmentLoad load = load_of(w_.nodes, w_.elements, of);
        return std::max(load.force.norm() / of.break_force, load.torque.norm() / of.break_torque);
    }
    bool overloaded(uint32_t tie) const {
        if (is_joint(tie)) {
            const Joint& joint = w_.joints.record[tie];
            if (!joint.works() || (std::isinf(joint.break_force) && std::isinf(joint.break_torque))) return false;
            return !asleep(w_.nodes, joint) && load_ratio(tie) > 1;
        }
        const Attachment& of = w_.attachments.record[attachment(tie)];
        if (!w_.attachments.ids.live(attachment(tie)) || !of.breakable()) return false;
        return !any_end(of, [&](uint32_t node) { return w_.nodes.sleeps(node); }) && load_ratio(tie) > 1;
    }
    // One of its nodes that moves; kNone: none does.
    uint32_t mover(uint32_t tie) const {
        uint32_t found = kNone;
        const auto look = [&](uint32_t node) {
            if (found == kNone && node != kNone && moves_by_forces(w_.nodes.info[node].kind)) found = node;
        };
        if (is_joint(tie))
            std::ranges::for_each(w_.joints.record[tie].nodes(), look);
        else
            for_ends(w_.attachments.record[attachment(tie)], look);
        return found;
    }
    uint64_t serial(uint32_t tie) const {
        return is_joint(tie) ? w_.joints.record[tie].serial : w_.attachments.record[attachment(tie)].serial;
    }

private:
    const World& w_;
    uint32_t joints_;
};

// Bodies tied by joints, by slot of a node: what static and kinematic bodies hold on either side moves apart.
class Assemblies {
public:
    Assemblies(Memory& memory, const Nodes& nodes, const Joints& joints, const Elements& elements)
        : nodes_(nodes), parent_(nodes.slots(), 0, memory) {
        for (uint32_t node = 0; node < nodes.slots(); ++node) parent_[node] = node;
        for_each_tie(joints, elements, [&](std::span<const uint32_t> ends) {
            const uint32_t first = mover(ends);
            for (const uint32_t node : ends)
                if (moves(node)) unite(first, node);
        });
    }
    uint32_t of(uint32_t node) { return node == kNone ? kNone : find(node); }

private:
    bool moves(uint32_t node) const { return node != kNone && moves_by_forces(nodes_.info[node].kind); }
    uint32_t mover(std::span<const uint32_t> ends) const {
        const auto at = std::find_if(ends.begin(), ends.end(), [&](uint32_t node) { return moves(node); });
        return at == ends.end() ? kNone : *at;
    }
    uint32_t find(uint32_t node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    }
    void unite(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

    const Nodes& nodes_;
    Array<uint32_t> parent_;
};

struct Overload {
    uint32_t mechanism, tie;
    double ratio;
};

// Leaves of overloaded ties, in ascending order, the worst of each mechanism; of like ones the oldest, joints first.
void keep_worst(World& world, const Ties& ties, Array<uint32_t>& overloaded) {
    constexpr double kAlike = 1e-6;  // rounding of a solve
    if (overloaded.size() < 2) return;
    Assemblies assemblies(world.memory, world.nodes, world.joints, world.elements);
    Array<Overload> all(world.memory);
    for (const uint32_t tie : overloaded) all.push_back({assemblies.of(ties.mover(tie)), tie, ties.load_ratio(tie)});
    std::sort(all.begin(), all.end(), [&](const Overload& a, const Overload& b) {
        const auto key = [&](const Overload& of) {
            return std::tuple(of.mechanism, !ties.is_joint(of.tie), ties.serial(of.tie));
        };
        return key(a) < key(b);
    });
    overloaded.clear();
    for (size_t begin = 0, end; begin < all.size(); begin = end) {
        size_t worst = begin;
        for (end = begin + 1; end < all.size() && all[end].mechanism == all[begin].mechanism; ++end)
            if (all[end].ratio > (1 + kAlike) * all[worst].ratio) worst = end;
        overloaded.push_back(all[worst].tie);
    }
    std::sort(overloaded.begin(), overloaded.end());
}

void break_joint(World& world, uint32_t index) {
    const Joint& joint = world.joints.record[index];
    const Wrench load = wrench_of(joint, read_joint(world.nodes, joint));
    // What may fail comes first.
    world.broken.push_back({world.joint_handle(index), joint.user_data, public_vector(load.force),
                            public_vector(load.torque), world.window.steps, 0});
    // The two bodies may collide from the next step on: a pair that was filtered is found anew, and touched nobody.
    if (!joint.collide_connected) forget_pairs_of_ends(world, joint);
    for (uint32_t node : joint.nodes()) wake(world, node);
    world.joints.remove(index);
}

void break_attachment(World& world, uint32_t index) {
    const Attachment& of = world.attachments.record[index];
    const AttachmentLoad load = load_of(world.nodes, world.elements, of);
    world.detached.push_back({world.attachment_handle(index), of.user_data, public_vector(load.force),
                              public_vector(load.torque), world.window.steps, 0});
    remove_attachment(world, index);
}

}  // namespace

// In ascending slot order, which also orders the events. What a break wakes may break in the next step.
void break_joints(World& world) {
    const Ties ties(world);
    gather(world.team, ties.count(), world.pairs.picked, [&](uint32_t tie) { return ties.overloaded(tie); });
    keep_worst(world, ties, world.pairs.picked);
    for (const uint32_t tie : world.pairs.picked)
        ties.is_joint(tie) ? break_joint(world, tie) : break_attachment(world, ties.attachment(tie));
}

}  // namespace taut
