// Bullet's dynamic tree of boxes under a pair list of our own: only leaves that left their fat box are moved and
// asked again, and pairs are sorted, so that nothing depends on the tree's shape. The tree's nodes are Bullet's memory.
#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "base/exchange.h"
#include "collision/collide.h"
#include "collision/descent.h"
#include "collision/probing.h"

namespace taut::collision {
namespace {

// A fat box reaches so much further than the tight one on every side [m], of what is small by this part of its shortest
// side. More, and in a heap of small bodies all are near each other; less, and they leave their boxes too often.
constexpr float kFat = 0.02f, kFatOfSide = 0.1f;

// Bodies that fall side by side would all leave their boxes in the same step: some reach less far ahead. Their places
// tell which, not their ids, which depend on what lived before them.
float reach_ahead(const Box& tight) {
    uint32_t mixed = 0;
    for (const float x : tight.lo) mixed = (mixed ^ std::bit_cast<uint32_t>(x)) * 0x9e3779b1u;
    return 0.625f + 0.125f * float(mixed >> 30);
}

btVector3 vector(const Vec3f& v) { return btVector3(v.x(), v.y(), v.z()); }

btDbvtVolume tight_volume(const Box& box) { return btDbvtVolume::FromMM(vector(box.lo), vector(box.hi)); }

btDbvtVolume fat_volume(const Box& box, const Vec3f& ahead) {
    btDbvtVolume volume = tight_volume(box);
    const float fat = std::min(kFat, kFatOfSide * (box.hi - box.lo).minCoeff());
    volume.Expand(btVector3(fat, fat, fat));
    volume.SignedExpand(vector(ahead));
    return volume;
}

uint64_t pair_key(uint32_t i, uint32_t j) { return uint64_t(std::min(i, j)) << 32 | std::max(i, j); }

struct Leaf {
    btDbvtNode* node = nullptr;  // null: no such id
    bool moves = false;
    bool stale = false;  // its pairs must be found again; listed in State::stale
    bool stray = false;  // may be outside its fat box; listed in State::strays
};

}  // namespace

struct Broadphase::State {
    explicit State(Memory& memory)
        : leaves(memory),
          stale(memory),
          partners(memory),
          found_of(memory),
          strays(memory),
          pairs(memory),
          fresh(memory),
          gone(memory),
          first_of(memory) {}

    void mark(uint32_t id) {
        if (leaves[id].stale) return;
        stale.push_back(id);
        leaves[id].stale = true;
    }
    template <class Report>
    void for_partners(std::span<const uint32_t> ids, Report&& report) const;
    void find(uint32_t begin, uint32_t end);
    void gather_fresh();
    void sort_by(const Array<uint64_t>& keys, int bit, Array<uint64_t>& sorted);
    void gather_gone();
    bool find_changes();
    template <class Asks>
    void walk(const Asks& asks, Probe& probe, Visitor& visitor) const;

    btDbvt tree;
    Array<Leaf> leaves;  // by id
    Array<uint32_t> stale;
    bool all_stale = false;                   // as in the first step
    static constexpr size_t kTogether = 256;  // keys
    static constexpr uint32_t kAtOnce = 8;    // leaves whose boxes go down the tree together
    static constexpr uint32_t kRoom = 8, kMostRoom = 64;
    static constexpr size_t kMany = 2048;  // keys: more are not kept from step to step, for fewer room stays as it is
    size_t found_before = 0;               // keys in the last step
    uint32_t room = kRoom;     // for keys of each stale leaf: where there were many, for half as many more than those
    Array<uint64_t> partners;  // keys, in the room of the stale leaves that are looked at together
    struct Found {
        uint32_t count, next, end;  // keys; the first stale leaf that there was no room for; that after the last
    };
    Array<Found> found_of;     // by the first stale leaf of those that are looked at together
    Array<uint32_t> strays;    // those that are not any more are listed until the next step
    Array<uint64_t> pairs;     // sorted
    Array<uint64_t> fresh;     // those of stale leaves now, then those of them that are new; sorted
    Array<uint64_t> gone;      // those of stale leaves before, then those of them that are no more; sorted
    Array<uint32_t> first_of;  // where in a sorted list the keys of an id begin
};

// Calls report(key) for each leaf whose fat box meets that of one of some stale leaves, and which pairs with it; of two
// stale leaves the smaller id reports. If all are stale, each only looks to its right in the tree and reports whom it
// meets there.
template <class Report>
void Broadphase::State::for_partners(std::span<const uint32_t> ids, Report&& report) const {
    const auto found = [&](uint32_t id, uint32_t other) {
        const bool reports = all_stale || !(leaves[other].stale && other < id);
        if (reports && (leaves[other].moves || leaves[id].moves)) report(pair_key(id, other));
    };
    Descent descent(found);
    for (const uint32_t id : ids) {
        const btDbvtNode* const leaf = leaves[id].node;
        for (const btDbvtNode* node = leaf; node && node->parent; node = node->parent) {
            const bool is_right = node == node->parent->childs[1];
            if (!is_right || !all_stale) descent.begin_at(node->parent->childs[!is_right], leaf);
        }
    }
    descent.run();
}

// Stops where there is no more room for what some find.
void Broadphase::State::find(uint32_t begin, uint32_t end) {
    Found& found = found_of[begin] = {0, begin, end};
    uint64_t* const to = partners.data() + size_t(begin) * room;
    const uint32_t most = (end - begin) * room;
    while (found.next < end) {
        const auto some = std::span(stale).subspan(found.next, std::min(kAtOnce, end - found.next));
        uint32_t count = found.count;
        for_partners(some, [&](uint64_t key) {
            if (count < most) to[count] = key;
            ++count;
        });
        if (count > most) return;
        found.count = count;
        found.next += uint32_t(some.size());
    }
}

// What find() found, and that for which there was no room; sorted.
void Broadphase::State::gather_fresh() {
    const auto number = uint32_t(stale.size());
    size_t keys = 0;
    for (uint32_t i = 0; i < number; i = found_of[i].end) keys += found_of[i].count;
    fresh.clear();
    reserve_more(fresh, keys);
    for (uint32_t i = 0; i < number; i = found_of[i].end) {
        const Found& found = found_of[i];
        const uint64_t* const first = partners.data() + size_t(i) * room;
        fresh.insert(fresh.end(), first, first + found.count);
        for_partners(std::span(stale).subspan(found.next, found.end - found.next),
                     [&](uint64_t key) { fresh.push_back(key); });
    }
    found_before = fresh.size();
    constexpr size_t kFew = 32;  // to as many leaves a key: less than what counting takes
    if (fresh.size() < leaves.size() / kFew) return std::sort(fresh.begin(), fresh.end());
    Array<uint64_t>& by_larger = gone;  // has no other use yet
    sort_by(fresh, 0, by_larger);
    sort_by(by_larger, 32, fresh);
}

// Counting, by one of the two ids, which begins at this bit of a key; those of one id stay in their order.
void Broadphase::State::sort_by(const Array<uint64_t>& keys, int bit, Array<uint64_t>& sorted) {
    first_of.assign(leaves.size() + 1, 0);
    for (const uint64_t key : keys) ++first_of[size_t(uint32_t(key >> bit)) + 1];
    std::partial_sum(first_of.begin(), first_of.end(), first_of.begin());
    sorted.clear();
    reserve_more(sorted, keys.size());
    sorted.resize(keys.size());
    for (const uint64_t key : keys) sorted[first_of[uint32_t(key >> bit)]++] = key;
}

// The pairs of stale leaves before. Each key is written, and counted if it is one: which are would be mispredicted.
void Broadphase::State::gather_gone() {
    gone.clear();
    for (size_t begin = 0; begin < pairs.size(); begin += kTogether) {
        uint64_t found[kTogether];
        size_t count = 0;
        for (const uint64_t key : std::span(pairs).subspan(begin, std::min(kTogether, pairs.size() - begin))) {
            found[count] = key;
            count += size_t(leaves[uint32_t(key >> 32)].stale) | size_t(leaves[uint32_t(key)].stale);
        }
        gone.insert(gone.end(), found, found + count);
    }
}

// Pairs of two leaves that stayed are kept; all others are in fresh if they overlap. True: the list changes, by what
// is left in fresh and gone.
bool Broadphase::State::find_changes() {
    gather_gone();
    auto kept_fresh = fresh.begin(), kept_gone = gone.begin();
    auto was = gone.begin();
    for (const uint64_t is : fresh) {
        while (was != gone.end() && *was < is) *kept_gone++ = *was++;
        if (was != gone.end() && *was == is)
            ++was;
        else
            *kept_fresh++ = is;
    }
    kept_gone = std::copy(was, gone.end(), kept_gone);
    fresh.erase(kept_fresh, fresh.end());
    gone.erase(kept_gone, gone.end());
    return !fresh.empty() || !gone.empty();
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
    s.strays.reserve(s.leaves.capacity());  // a step takes no memory for them
    s.stale.reserve(s.leaves.capacity());
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
    s.leaves[id].stray = false;
}

void Broadphase::update(uint32_t id, const Box& tight, const Vec3f& displacement) {
    State& s = *state_;
    s.leaves[id].stray = false;
    if (holds(id, tight)) return;
    s.mark(id);
    btDbvtVolume volume = fat_volume(tight, displacement * reach_ahead(tight));
    s.tree.update(s.leaves[id].node, volume);
}

bool Broadphase::holds(uint32_t id, const Box& tight) const {
    return contains(state_->leaves[id].node->volume, tight_volume(tight));
}

void Broadphase::set_moves(uint32_t id, bool moves) {
    State& s = *state_;
    if (s.leaves[id].moves == moves) return;
    s.mark(id);
    s.leaves[id].moves = moves;
}

uint32_t Broadphase::start_refresh() {
    State& s = *state_;
    const size_t wanted = s.found_before < State::kMany ? 0 : 3 * s.found_before / (2 * s.stale.size() + 1);
    s.room = uint32_t(std::clamp(wanted, size_t(State::kRoom), size_t(State::kMostRoom)));
    s.partners.resize(s.stale.size() * s.room);
    s.found_of.resize(s.stale.size());
    const auto in_tree = [&](uint32_t id) { return s.leaves[id].node != nullptr; };
    s.all_stale = std::ranges::count_if(s.stale, in_tree) == s.tree.m_leaves;
    return uint32_t(s.stale.size());
}

void Broadphase::find_pairs(uint32_t begin, uint32_t end) {
    if (begin < end) state_->find(begin, end);
}

bool Broadphase::finish_refresh() {
    State& s = *state_;
    if (s.stale.empty()) {
        s.fresh.clear();
        s.gone.clear();
        return false;
    }
    s.gather_fresh();
    const bool changed = s.find_changes();
    if (changed) {
        reserve_more(s.pairs, s.fresh.size());
        const auto itself = [](uint64_t key) { return key; };
        Exchange(s.pairs, {s.gone, s.fresh}, itself, itself).run();
    }
    for (const uint32_t id : s.stale) s.leaves[id].stale = false;
    s.stale.clear();
    return changed;
}

bool Broadphase::refresh_pairs() {
    find_pairs(0, start_refresh());
    return finish_refresh();
}

void Broadphase::let_go() {
    State& s = *state_;
    for (Array<uint64_t>* each : {&s.fresh, &s.gone, &s.partners}) taut::let_go(*each);
    taut::let_go(s.first_of);
    taut::let_go(s.found_of);
}

std::span<const uint64_t> Broadphase::pairs() const { return state_->pairs; }
std::span<const uint64_t> Broadphase::arrived() const { return state_->fresh; }
std::span<const uint64_t> Broadphase::departed() const { return state_->gone; }

// ---------------------------------------------------------------- probes

void Broadphase::clear_strays() {
    for (const uint32_t id : state_->strays) state_->leaves[id].stray = false;
    state_->strays.clear();
}

void Broadphase::note_stray(uint32_t id) {
    state_->leaves[id].stray = true;
    state_->strays.push_back(id);
}

// Down the tree and up again by the parents: it may be of any depth, and a query has no memory of its own.
template <class Asks>
void Broadphase::State::walk(const Asks& asks, Probe& probe, Visitor& visitor) const {
    const btDbvtNode* root = tree.m_root;
    const btDbvtNode* node = root;
    while (node) {
        if (asks.meets(probe, node->volume)) {
            if (node->isinternal()) {
                node = node->childs[asks.first(probe, node)];
                continue;
            }
            const uint32_t id = uint32_t(node->dataAsInt);
            if (!leaves[id].stray) visitor.visit(id, probe);
        }
        const auto second = [&](const btDbvtNode* parent) { return parent->childs[1 - asks.first(probe, parent)]; };
        while (node != root && node == second(node->parent)) node = node->parent;
        node = node == root ? nullptr : second(node->parent);
    }
}

void Broadphase::visit(Probe probe, Visitor& visitor) const {
    const State& s = *state_;
    for (const uint32_t id : s.strays)
        if (s.leaves[id].stray) visitor.visit(id, probe);
    if (probe.along == Vec3::Zero() && probe.reach == 0)
        s.walk(Overlap(probe), probe, visitor);
    else
        s.walk(Slabs(probe), probe, visitor);
}

}  // namespace taut::collision
