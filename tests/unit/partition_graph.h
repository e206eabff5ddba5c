// A world's state as far as the partition looks at it, for tests.
#pragma once

#include <algorithm>
#include <vector>

#include "constraints/constraint.h"
#include "partition/partition.h"

namespace taut::test {

struct Graph {
    Memory memory{taut_hooks{}};
    Team team{taut_hooks{}, 1};
    Nodes nodes{memory};
    Joints joints{memory};
    Elements elements{memory};
    std::vector<Pair> touching;  // find_active() brings them to pairs
    Pairs pairs{memory};
    Partition partition{memory};
    PartitionRules rules{4, false, true, 1.0 / 60, Vec3::Zero(), false};

    uint32_t add(NodeKind kind, double mass = 1) {
        const uint32_t node = nodes.add();
        nodes.info[node].kind = kind;
        nodes.list_active();
        if (!moves_by_forces(kind)) mass = 0;
        set_mass(node, mass);
        return node;
    }
    void set_mass(uint32_t node, double mass) {
        NodeMass of = nodes.mass[node];
        of.mass = mass;
        of.inv_mass = mass > 0 ? 1 / mass : 0;
        nodes.mass.reserve_values(1);
        nodes.mass.set(node, of);
    }
    uint32_t add_cube(double mass, double side) {
        const uint32_t node = add(NodeKind::dynamic, mass);
        NodeMass of = nodes.mass[node];
        of.inertia.xx = of.inertia.yy = of.inertia.zz = mass * side * side / 6;
        nodes.mass.set(node, of);
        return node;
    }
    uint32_t join(uint32_t a, uint32_t b, const ConstraintType& type = kBall) {
        Joint joint;
        joint.type = &type;
        joint.node[0] = a;
        joint.node[1] = b;
        joint.loaded = kLoadedAfter;
        return joints.add(joint);
    }
    void touch(uint32_t a, uint32_t b) { touch(std::min(a, b), std::max(a, b), Vec3f::UnitY()); }
    // normal: from a to b.
    void touch(uint32_t a, uint32_t b, const Vec3f& normal) {
        Pair& pair = touching.emplace_back();
        pair.key = pair_key(a, b);
        pair.a = std::min(a, b);
        pair.b = std::max(a, b);
        pair.manifold.normal = a < b ? normal : Vec3f(-normal);
        pair.manifold.count = 1;
    }
    void find_active() {
        std::ranges::sort(touching, {}, &Pair::key);
        pairs.active.clear();
        for (uint32_t i = 0; i < touching.size(); ++i) {
            if (i == pairs.list.size()) pairs.list.emplace_back();
            pairs.list[i] = touching[i];
            const auto points = static_cast<uint8_t>(touching[i].manifold.count);
            ActivePair& active = pairs.active.emplace_back(ActivePair{touching[i].a, touching[i].b, i, points});
            active.loaded = touching[i].loaded;
            active.in_block = touching[i].in_block;
            active.borne = touching[i].force[0].normal;
        }
    }
    void build() {
        find_active();
        partition.build(team, nodes, joints, elements, pairs, rules);
        for (uint32_t i = 0; i < touching.size(); ++i) touching[i].loaded = pairs.list[i].loaded;
    }
    // As if the blocks had been solved.
    void hold_blocks() {
        for (Pair& pair : touching) pair.in_block = false;
        for (const Block& block : partition.blocks)
            for (const uint32_t p : block.pairs) touching[pairs.active[p].pair].in_block = true;
    }
    bool moving(uint32_t node) const { return node != kNone && moves_by_forces(nodes.info[node].kind); }
    uint32_t substeps_of(uint32_t node) const {
        for (uint32_t g = 0; g < partition.group_count; ++g)
            for (uint32_t member : partition.groups[g].nodes)
                if (member == node) return partition.groups[g].substeps;
        return 0;
    }
    // A column of boxes on the ground.
    std::vector<uint32_t> tower(uint32_t count, double mass = 1) {
        uint32_t below = add(NodeKind::fixed);
        std::vector<uint32_t> boxes;
        for (uint32_t i = 0; i < count; ++i) {
            boxes.push_back(add(NodeKind::dynamic, mass));
            touch(below, boxes.back());
            below = boxes.back();
        }
        return boxes;
    }
};

}  // namespace taut::test
