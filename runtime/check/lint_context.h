// What lint's checks share. A check is one file: it looks at the world and adds what it finds, each kind by slot.
#pragma once

#include <algorithm>
#include <numeric>

#include <taut/lint.h>

#include "world.h"

namespace taut {

class LintContext {
public:
    LintContext(World& of, Array<taut_lint_entry>& found)
        : world(of), nodes(of.nodes), joints(of.joints), memory(of.memory), found_(found) {}

    const World& world;
    const Nodes& nodes;
    const Joints& joints;
    Memory& memory;

    bool moves(uint32_t node) const { return node != kNone && moves_by_forces(nodes.info[node].kind); }
    double mass(uint32_t node) const { return nodes.mass[node].mass; }
    Vec3 gravity() const { return {world.def.gravity.x, world.def.gravity.y, world.def.gravity.z}; }
    // Solved within a block, not swept.
    template <class Tie>  // a joint or an attachment
    bool direct(const Tie& tie) const {
        return solvers()[world.def.solver]->direct && tie.solve != JointSolve::swept;
    }

    // Joints of which at least one end moves.
    template <class Act>
    void for_joints(Act act) const {
        for (uint32_t j = 0; j < joints.record.size(); ++j) {
            const Joint& joint = joints.record[j];
            if (lightest_of(joint) != kNone) act(j, joint);
        }
    }

    // act(index, attachment)
    template <class Act>
    void for_attachments(Act act) const {
        for (uint32_t index = 0; index < world.attachments.ids.slots(); ++index)
            if (world.attachments.ids.live(index)) act(index, world.attachments.record[index]);
    }

    // The lightest of a joint's nodes that move, the first of such; kNone: none moves.
    uint32_t lightest_of(const Joint& joint) const {
        uint32_t light = kNone;
        for (uint32_t node : joint.nodes())
            if (moves(node) && (light == kNone || mass(node) < mass(light))) light = node;
        return light;
    }

    // Node and joint may be kNone.
    void add(taut_lint_kind kind, uint32_t node, uint32_t joint, double value, double limit) const {
        taut_lint_entry entry{};
        entry.kind = kind;
        entry.body = world.body_handle(node);
        entry.joint = world.joint_handle(joint);
        entry.value = static_cast<float>(value);
        entry.limit = static_cast<float>(limit);
        if (const char* const name = nodes.name_of(node)) std::copy_n(name, sizeof entry.body_name, entry.body_name);
        found_.push_back(entry);
    }
    void add(taut_lint_kind kind, taut_attachment attachment, double value, double limit) const {
        taut_lint_entry entry{};
        entry.kind = kind;
        entry.value = static_cast<float>(value);
        entry.limit = static_cast<float>(limit);
        entry.attachment = attachment;
        found_.push_back(entry);
    }
    void add_above(taut_lint_kind kind, uint32_t node, uint32_t joint, double value, double limit) const {
        if (value > limit) add(kind, node, joint, value, limit);
    }

private:
    Array<taut_lint_entry>& found_;
};

// Which nodes some joints connect: union-find over slots, roots are the smallest slot.
class Connected {
public:
    explicit Connected(const LintContext& context)
        : context_(context), parent_(context.nodes.slots(), 0u, context.memory) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    void unite(const Joint& joint) {
        uint32_t first = kNone;
        for (uint32_t node : joint.nodes()) unite(first, node);
    }
    void unite(const Attachment& attachment) {
        uint32_t first = kNone;
        for_ends(attachment, [&](uint32_t node) { unite(first, node); });
    }
    // With the first of some nodes that moves.
    void unite(uint32_t& first, uint32_t node) {
        if (!context_.moves(node)) return;
        if (first == kNone) first = node;
        const uint32_t a = root_of(first), b = root_of(node);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }
    uint32_t root_of(uint32_t node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    }

private:
    const LintContext& context_;
    Array<uint32_t> parent_;
};

void lint_masses(const LintContext& context);    // of blocks, joints and contacts, and what is light between heavy
void lint_thin(const LintContext& context);      // bodies in joints
void lint_softness(const LintContext& context);  // of swept joints
void lint_loops(const LintContext& context);     // rows that other rows hold already
void lint_poses(const LintContext& context);   // joints apart or beyond their stops, and stops too close to each other
void lint_cables(const LintContext& context);  // at most one finding of a kind for each cable
void lint_softs(const LintContext& context);   // likewise of each cloth and solid

}  // namespace taut
