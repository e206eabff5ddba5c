#include "determinism/step_trace.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "api/access.h"
#include "snapshot/compare.h"

namespace determinism {
namespace {

using namespace taut;

bool of_substep(Stage stage) { return stage >= Stage::predict && stage <= Stage::relax; }

// Sums of what a stage wrote, by the node that it is about; of a pair that is the first that forces move.
class Sums {
public:
    explicit Sums(const World& world) : world_(world), sum_(world.nodes.slots()) {}

    Hash& of(uint32_t node) { return sum_[node]; }
    Hash& of(const PairEnds& pair) { return of_moving(pair.a, pair.b); }
    Hash& of(const RowBlock& rows) {
        const auto number = [&](int n) { return world_.system.node_at[rows.node[n]] + 1; };  // 0: the world
        return sum_[std::max(number(0), number(1)) - 1];
    }
    Hash& of(const Joint& joint) { return of_moving(joint.node[0], joint.node[1]); }

    std::vector<uint64_t> values() const {
        std::vector<uint64_t> out;
        for (const Hash& hash : sum_) out.push_back(hash.value());
        return out;
    }

private:
    Hash& of_moving(uint32_t a, uint32_t b) {
        const bool first = b == kNone || (a != kNone && moves_by_forces(world_.nodes.info[a].kind));
        return sum_[first ? a : b];
    }

    const World& world_;
    std::vector<Hash> sum_;
};

void add_floats(Hash& hash, const Vec3f& v) {
    for (int i = 0; i < 3; ++i) hash.add(v[i]);
}

void add_force(Hash& hash, const ContactForce& force) {
    for (float x : {force.normal, force.tangent1, force.tangent2, force.slip}) hash.add(x);
}

void add_motion(const World& world, uint32_t node, Sums& sums) {
    const NodeMotion& m = world.nodes.motion[node];
    Hash& hash = sums.of(node);
    for (const Vec3* v : {&m.x, &m.v, &m.w, &m.slow_v, &m.slow_w}) hash.add(*v);
    hash.add(m.q);
}

void add_bounds(const World& world, Sums& sums) {
    for (uint32_t c = 0; c < world.colliders.record.size(); ++c) {
        const uint32_t node = world.colliders.record[c].node;
        if (node == kNone || !world.nodes.solved(node)) continue;
        const Reach& reach = world.pairs.reach[c];
        for (const Vec3f* v : {&reach.box.lo, &reach.box.hi, &reach.ahead}) add_floats(sums.of(node), *v);
    }
}

void add_pairs(const World& world, Sums& sums) {
    for_near(world.pairs, [&](const NearPair& near) {
        Hash& hash = sums.of(near.ends(world.colliders));
        hash.add(near.key);
        hash.add(uint64_t{near.filtered} << 1 | uint64_t{near.touching});
        for_parts(world.pairs, near,
                  [&](const Pair& pair) { hash.add(uint64_t{pair.part} << 1 | uint64_t{pair.touching}); });
    });
}

void add_contacts(const World& world, Sums& sums) {
    for (const ActivePair& active : world.pairs.active) {
        const Pair& pair = world.pairs.list[active.pair];
        Hash& hash = sums.of(pair);
        hash.add(uint64_t{active.pair} << 32 | active.points);
        add_floats(hash, pair.manifold.normal);
        for (float x : {pair.friction, pair.restitution, pair.spinning, pair.rolling, pair.patch}) hash.add(x);
        for (int k = 0; k < pair.manifold.count; ++k) {
            add_floats(hash, pair.manifold.points[k].position);
            hash.add(pair.manifold.points[k].separation);
            hash.add(uint64_t{pair.manifold.points[k].feature});
            add_force(hash, pair.force[k]);
        }
    }
}

// Who is solved with whom, and in which order.
void add_partition(const World& world, Sums& sums) {
    const auto pair_of = [&](uint32_t active) -> const Pair& {
        return world.pairs.list[world.pairs.active[active].pair];
    };
    for (uint64_t g = 0; g < world.partition.group_count; ++g) {
        const Group& group = world.partition.groups[g];
        for (uint32_t node : group.nodes) sums.of(node).add(g << 32 | group.substeps << 16 | group.sweeps);
        for (uint64_t i = 0; i < group.pairs.size(); ++i) sums.of(pair_of(group.pairs[i])).add(i);
        for (uint64_t i = 0; i < group.joints.size(); ++i) sums.of(world.joints.record[group.joints[i]]).add(i);
        for (uint64_t b : group.blocks) {
            const Block& block = world.partition.blocks[b];
            for (uint32_t node : block.nodes) sums.of(node).add(b);
            for (uint64_t i = 0; i < block.joints.size(); ++i) sums.of(world.joints.record[block.joints[i]]).add(i);
            for (uint64_t i = 0; i < block.pairs.size(); ++i) sums.of(pair_of(block.pairs[i])).add(i);
        }
    }
}

void add_lanes(const World& world, Sums& sums) {
    const ContactLanes& lanes = world.system.contacts;
    for (const LaneGroup& group : lanes.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (group.pair[lane] == UINT32_MAX) continue;
            const Pair& pair = world.pairs.list[group.pair[lane]];
            Hash& hash = sums.of(pair);
            // Who stands beside a pair decides how many points its lane group has and what sign zeros have, till they
            // are stored.
            for (int p = 0; p < pair.manifold.count; ++p)
                for (const auto& impulse : group.point[p].impulse) hash.add(impulse[lane] + 0.0f);
        }
}

void add_joint_lanes(const World& world, Sums& sums) {
    const JointLanes& lanes = world.system.joints;
    for (const JointGroup& group : lanes.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (group.block[lane] == kNoLanes) continue;
            Hash& hash = sums.of(world.system.rows.block[group.block[lane]]);
            for (uint32_t r = 0; r < group.rows; ++r) {
                hash.add(lanes.row[group.first_row + r].impulse[lane]);
                hash.add(lanes.coordinate[group.first_row + r].value[lane]);
            }
        }
}

// The system of the group that is being solved.
void add_system(const World& world, const StageEnd& end, Sums& sums) {
    const System& system = world.system;
    for (uint32_t node : world.partition.groups[end.group].nodes) {
        Hash& hash = sums.of(node);
        add_motion(world, node, sums);
        const uint32_t at = system.at(node);
        hash.add(system.exact[at].v);
        hash.add(system.exact[at].w);
        const SweepVelocity& u = system.sweep[at].velocity;
        const SweepShift& shift = system.shift[at];
        for (int i = 0; i < 3; ++i)
            for (float x : {u.v[i], u.w[i], shift.dx[i], shift.dq[i]}) hash.add(x);
    }
    for (const RowBlock& rows : system.rows.block) {
        Hash& hash = sums.of(rows);
        for (int r = 0; r < rows.type->rows; ++r) {
            const uint32_t row = rows.row + static_cast<uint32_t>(r);
            hash.add(system.rows.impulse[row]);
            if (end.stage != Stage::predict) hash.add(system.rows.error[row]);
        }
    }
    add_lanes(world, sums);
    add_joint_lanes(world, sums);
}

void add_results(const World& world, Sums& sums) {
    for (uint32_t node = 0; node < world.nodes.slots(); ++node) {
        const NodeInfo& info = world.nodes.info[node];
        if (info.kind == NodeKind::dead) continue;
        add_motion(world, node, sums);
        const NodeSleep& sleep = world.nodes.sleep[node];
        Hash& hash = sums.of(node);
        hash.add(static_cast<uint64_t>(info.kind) << 8 | static_cast<uint64_t>(world.nodes.rest[node]));
        hash.add(sleep.quiet);
        hash.add(static_cast<uint64_t>(sleep.next));
    }
    for (const Joint& joint : world.joints.record)
        for (int r = 0; joint.type && r < joint.type->rows; ++r) sums.of(joint).add(joint.lambda[r]);
    for_pairs(world.pairs, [&](const Pair& pair) {
        for (int k = 0; k < pair.manifold.count; ++k) add_force(sums.of(pair), pair.force[k]);
    });
}

std::vector<uint64_t> sums_after(const World& world, const StageEnd& end) {
    Sums sums(world);
    if (of_substep(end.stage)) {
        add_system(world, end, sums);
        return sums.values();
    }
    add_results(world, sums);
    if (end.stage == Stage::bounds) add_bounds(world, sums);
    if (end.stage == Stage::pairs) add_pairs(world, sums);
    if (end.stage == Stage::contacts) add_contacts(world, sums);
    if (end.stage == Stage::partition) add_partition(world, sums);
    return sums.values();
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Difference& difference) {
    const StageEnd& end = difference.end;
    out << "stage " << name_of(end.stage);
    if (of_substep(end.stage)) out << " of substep " << end.substep << ", group " << end.group;
    if (difference.island == kNone) return out << ", all of the world";
    return out << ", island of node " << difference.island;
}

void StepTrace::after(World& world, const StageEnd& end) {
    if (end.stage == Stage::partition) find_islands(world);
    records_.push_back({end, sums_after(world, end)});
}

uint32_t StepTrace::root_of(uint32_t node) const {
    while (parent_[node] != node) node = parent_[node];
    return node;
}

void StepTrace::find_islands(const World& world) {
    parent_.resize(world.nodes.slots());
    std::iota(parent_.begin(), parent_.end(), 0u);
    const auto unite = [&](const auto& nodes) {
        uint32_t first = kNone;
        for (uint32_t node : nodes) {
            if (node == kNone || !world.nodes.solved(node)) continue;
            const uint32_t one = first == kNone ? root_of(node) : root_of(first), other = root_of(node);
            parent_[std::max(one, other)] = first = std::min(one, other);
        }
    };
    for (const ActivePair& active : world.pairs.active) unite(active.nodes());
    for (const Joint& joint : world.joints.record)
        if (joint.type) unite(joint.nodes());
}

std::optional<Difference> StepTrace::first_difference(const StepTrace& a, const StepTrace& b) {
    for (size_t i = 0; i < std::max(a.records_.size(), b.records_.size()); ++i) {
        if (i >= std::min(a.records_.size(), b.records_.size()))
            return Difference{(i < a.records_.size() ? a : b).records_[i].end, kNone};
        const Record &one = a.records_[i], &other = b.records_[i];
        const bool same_place = one.end.stage == other.end.stage && one.end.group == other.end.group &&
                                one.end.substep == other.end.substep;
        if (!same_place || one.by_node.size() != other.by_node.size()) return Difference{one.end, kNone};
        const auto [at, unused] = std::mismatch(one.by_node.begin(), one.by_node.end(), other.by_node.begin());
        if (at == one.by_node.end()) continue;
        return Difference{one.end, a.root_of(static_cast<uint32_t>(at - one.by_node.begin()))};
    }
    return std::nullopt;
}

void observe(taut_world handle, StageObserver* observer) {
    const Hold hold(world_of(handle), Use::write);
    ASSERT_NE(hold.world(), nullptr);
    hold.world()->observer = observer;
}

std::string first_difference(taut_world one, taut_world other) {
    const Hold hold_one(world_of(one), Use::read), hold_other(world_of(other), Use::read);
    return taut::first_difference(*hold_one.world(), *hold_other.world());
}

TracedScene::TracedScene(scenes::Scene plan, StageObserver* instead) : RunningScene(std::move(plan)) {
    observe(world.world, instead ? instead : &trace);
}

uint64_t TracedScene::hash() const {
    uint64_t hash = 0;
    lab::ok(taut_world_get_state_hash(world.world, &hash));
    return hash;
}

}  // namespace determinism
