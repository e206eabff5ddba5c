// Bullet's dynamic tree of boxes under a pair list of our own: only leaves that left their fat box are moved and
// asked again, and pairs are sorted, so that nothing depends on the tree's shape. The tree's nodes are Bullet's memory.
#include <algorithm>
#include <utility>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "collision/collide.h"

namespace taut::collision {
namespace {

// A fat box reaches this much further than the tight one on every side [m].
constexpr float kFat = 0.05f;

// Bodies that fall side by side would all leave their boxes in the same step: some reach less far ahead.
float reach_ahead(uint32_t id) { return 0.625f + 0.125f * float(id & 3); }

btVector3 vector(const Vec3f& v) { return btVector3(v.x(), v.y(), v.z()); }

btDbvtVolume tight_volume(const Box& box) { return btDbvtVolume::FromMM(vector(box.lo), vector(box.hi)); }

btDbvtVolume fat_volume(const Box& box, const Vec3f& ahead) {
    btDbvtVolume volume = tight_volume(box);
    volume.Expand(btVector3(kFat, kFat, kFat));
    volume.SignedExpand(vector(ahead));
    return volume;
}

uint64_t pair_key(uint32_t i, uint32_t j) { return uint64_t(std::min(i, j)) << 32 | std::max(i, j); }

struct Leaf {
    btDbvtNode* node = nullptr;  // null: no such id
    bool moves = false;
    bool stale = false;  // its pairs must be found again; listed in State::stale
};

}  // namespace

struct Broadphase::State {
    explicit State(Memory& memory) : leaves(memory), stale(memory), pairs(memory), fresh(memory), merged(memory) {}

    void mark(uint32_t id) {
        if (leaves[id].stale) return;
        stale.push_back(id);
        leaves[id].stale = true;
    }
    void find_fresh();
    void merge();

    btDbvt tree;
    btNodeStack stack;
    Array<Leaf> leaves;  // by id
    Array<uint32_t> stale;
    Array<uint64_t> pairs;   // sorted
    Array<uint64_t> fresh;   // found by this refresh, then sorted
    Array<uint64_t> merged;  // the next pairs
};

// Pairs of every stale leaf; of two stale leaves the smaller id reports.
void Broadphase::State::find_fresh() {
    struct Collect : btDbvt::ICollide {
        using btDbvt::ICollide::Process;
        State* state = nullptr;
        uint32_t self = 0;
        void Process(const btDbvtNode* node) override {
            const uint32_t other = uint32_t(node->dataAsInt);
            const Leaf& leaf = state->leaves[other];
            if (other == self || (leaf.stale && other < self)) return;
            if (leaf.moves || state->leaves[self].moves) state->fresh.push_back(pair_key(self, other));
        }
    };
    Collect collect;
    collect.state = this;
    fresh.clear();
    for (const uint32_t id : stale) {
        const Leaf& leaf = leaves[id];
        if (!leaf.node) continue;
        collect.self = id;
        tree.collideTVNoStackAlloc(tree.m_root, leaf.node->volume, stack, collect);
    }
    std::sort(fresh.begin(), fresh.end());
}

// Pairs of two leaves that stayed are kept; all others are in fresh if they overlap.
void Broadphase::State::merge() {
    merged.clear();
    auto next = fresh.begin();
    for (const uint64_t key : pairs) {
        if (leaves[uint32_t(key >> 32)].stale || leaves[uint32_t(key)].stale) continue;
        while (next != fresh.end() && *next < key) merged.push_back(*next++);
        merged.push_back(key);
    }
    merged.insert(merged.end(), next, fresh.end());
}

Broadphase::Broadphase(Memory& memory) : state_(nullptr), memory_(memory) {
    state_ = new (memory.allocate(sizeof(State), HostAllocator<State>::alignment())) State(memory);
}

Broadphase::~Broadphase() {
    state_->~State();
    memory_.release(state_, sizeof(State), HostAllocator<State>::alignment());
}

void Broadphase::add(uint32_t id, const Box& tight, bool moves) {
    State& s = *state_;
    if (s.leaves.size() <= id) s.leaves.resize(size_t(id) + 1);
    s.mark(id);
    s.leaves[id].node = s.tree.insert(fat_volume(tight, Vec3f::Zero()), nullptr);
    s.leaves[id].node->dataAsInt = int(id);
    s.leaves[id].moves = moves;
}

void Broadphase::remove(uint32_t id) {
    State& s = *state_;
    s.mark(id);
    s.tree.remove(s.leaves[id].node);
    s.leaves[id].node = nullptr;
}

void Broadphase::update(uint32_t id, const Box& tight, const Vec3f& displacement) {
    State& s = *state_;
    btDbvtNode* node = s.leaves[id].node;
    if (node->volume.Contain(tight_volume(tight))) return;
    s.mark(id);
    btDbvtVolume volume = fat_volume(tight, displacement * reach_ahead(id));
    s.tree.update(node, volume);
}

void Broadphase::set_moves(uint32_t id, bool moves) {
    State& s = *state_;
    if (s.leaves[id].moves == moves) return;
    s.mark(id);
    s.leaves[id].moves = moves;
}

bool Broadphase::refresh_pairs() {
    State& s = *state_;
    if (s.stale.empty()) return false;
    s.find_fresh();
    s.merge();
    for (const uint32_t id : s.stale) s.leaves[id].stale = false;
    s.stale.clear();
    const bool changed = s.merged != s.pairs;
    s.pairs.swap(s.merged);
    return changed;
}

std::span<const uint64_t> Broadphase::pairs() const { return state_->pairs; }

}  // namespace taut::collision
