// Bullet's dynamic trees of boxes under a pair list of our own: only leaves that left their fat box are moved and asked
// again, and pairs are sorted, so that nothing depends on a tree's shape. What stands has a tree of its own, which what
// stands does not ask.
#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include "base/exchange.h"
#include "collision/collide.h"
#include "collision/descent.h"
#include "collision/leaf_tree.h"
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

// A leaf whose box changes keeps its place in the tree, which is a third of the work, this often, while the box about
// it and its sibling is no longer than the two; those above may drift apart as well.
constexpr uint8_t kMostStays = 3;
float length_of(const btDbvtVolume& volume) {
    const btVector3 sides = volume.Lengths();
    return sides.x() + sides.y() + sides.z();
}
bool may_stay(const btDbvtNode& leaf, const btDbvtVolume& volume) {
    if (!leaf.parent) return false;
    const btDbvtVolume& sibling = leaf.parent->childs[leaf.parent->childs[0] == &leaf]->volume;
    btDbvtVolume both;
    Merge(volume, sibling, both);
    return length_of(both) <= length_of(volume) + length_of(sibling);
}

Box box_of(const btDbvtVolume& volume) {
    return {{volume.Mins().x(), volume.Mins().y(), volume.Mins().z()},
            {volume.Maxs().x(), volume.Maxs().y(), volume.Maxs().z()}};
}

uint64_t pair_key(uint32_t i, uint32_t j) { return uint64_t(std::min(i, j)) << 32 | std::max(i, j); }

}  // namespace

struct Broadphase::State {
    explicit State(Memory& memory)
        : boxes(memory),
          trees{LeafTree(memory), LeafTree(memory), LeafTree(memory)},
          leaves(memory),
          stays(memory),
          in_tree(memory),
          partners(memory),
          found_of(memory),
          strays(memory),
          fresh(memory),
          gone(memory),
          first_of(memory) {}

    void mark(uint32_t id) {
        if (boxes.of[id].stale) return;
        boxes.stale.push_back(id);
        boxes.of[id].stale = true;
    }
    // Gives a leaf another box, in its place or in a new one.
    void change(uint32_t id, const btDbvtVolume& volume);
    // From one on those that go down the tree together, before an end.
    std::span<const uint32_t> some_stale(uint32_t next, uint32_t end) const {
        return std::span(boxes.stale).subspan(next, std::min(kAtOnce, end - next));
    }
    void order_stale();
    template <class Report>
    void for_partners(std::span<const uint32_t> ids, Report&& report) const;
    void find(uint32_t begin, uint32_t end);
    void gather_fresh();
    void sort_by(const Array<uint64_t>& keys, int bit, Array<uint64_t>& sorted);
    void gather_gone();
    bool find_changes();
    template <class Asks>
    void walk(const btDbvtNode* root, const Asks& asks, Probe& probe, Visitor& visitor) const;

    Boxes boxes;
    // Of what moves; of what does not, which does not pair with itself, and neither do grains.
    enum Kind : uint8_t { kMoving, kStanding, kGrains };  // number of its bit in those of visit()
    static Kind kind_of(const FatBox& box) { return box.grain ? kGrains : box.moves ? kMoving : kStanding; }
    LeafTree trees[3];
    LeafTree& tree_of(uint32_t id) { return trees[in_tree[id]]; }
    Array<btDbvtNode*> leaves;  // by id, or null; their boxes stand in boxes as well: these lie somewhere else
    Array<uint8_t> stays;       // by id: how often its box changed since it got its place in the tree
    Array<uint8_t> in_tree;     // by id: which one its leaf is in, a Kind
    static constexpr size_t kTogether = 256;     // keys
    static constexpr uint32_t kAtOnce = kLanes;  // leaves whose boxes go down the tree together
    static constexpr uint32_t kRoom = 8, kMostRoom = 64;
    static constexpr size_t kMany = 2048;  // keys: more are not kept from step to step, for fewer room stays as it is
    size_t found_before = 0;               // keys in the last step
    uint32_t room = kRoom;  // for keys of each stale leaf: where there were many, for half as many more than those
    UnsetArray<uint64_t> partners;  // keys, in the room of the stale leaves that are looked at together
    struct Found {
        uint32_t count, next, end;  // keys; the first stale leaf that there was no room for; that after the last
    };
    Array<Found> found_of;     // by the first stale leaf of those that are looked at together
    Array<uint32_t> strays;    // those that are not any more are listed until the next step
    Array<uint64_t> fresh;     // those of stale leaves now, then those of them that are new; sorted
    Array<uint64_t> gone;      // those of stale leaves before, then those of them that are no more; sorted
    Array<uint32_t> first_of;  // where in a sorted list the keys of an id begin
};

// Those that lie near each other one after the other, so that those that go down the tree together meet the same nodes:
// by cells of a grid about them all, in Morton order.
void Broadphase::State::order_stale() {
    constexpr uint32_t kCells = 8;                                      // along each axis
    constexpr uint32_t kSpread[kCells] = {0, 1, 8, 9, 64, 65, 72, 73};  // a number's bits, two zeros between them
    const auto middle = [&](uint32_t id) {
        const btDbvtNode* const leaf = leaves[id];
        return leaf ? btVector3(0.5f * (leaf->volume.Mins() + leaf->volume.Maxs())) : btVector3(0, 0, 0);
    };
    btVector3 lo = middle(boxes.stale.front()), hi = lo;
    for (const uint32_t id : boxes.stale) lo.setMin(middle(id)), hi.setMax(middle(id));
    first_of.assign(kCells * kCells * kCells + 1, 0);
    for (size_t k = 0; k < boxes.stale.size(); ++k) {
        uint32_t cell = 0;
        for (int i = 0; i < 3; ++i) {
            const float along = float(kCells) * (middle(boxes.stale[k])[i] - lo[i]) / (hi[i] - lo[i]);
            cell |= kSpread[along > 0 ? uint32_t(std::min(along, float(kCells - 1))) : 0] << i;  // not-a-number: 0
        }
        partners[k] = uint64_t(cell) << 32 | boxes.stale[k];
        ++first_of[cell + 1];
    }
    std::partial_sum(first_of.begin(), first_of.end(), first_of.begin());
    for (size_t k = 0, count = boxes.stale.size(); k < count; ++k)
        boxes.stale[first_of[partners[k] >> 32]++] = uint32_t(partners[k]);
}

// Calls report(key) for each leaf whose fat box meets that of one of some stale leaves, at most kAtOnce, and which
// pairs with it; of two stale leaves the smaller id reports.
template <class Report>
void Broadphase::State::for_partners(std::span<const uint32_t> ids, Report&& report) const {
    BoxLanes lanes;
    unsigned asking = 0, of_kind[3] = {};
    for (size_t k = 0; k < kAtOnce; ++k) {
        const btDbvtNode* const leaf = k < ids.size() ? leaves[ids[k]] : nullptr;
        asking |= unsigned(leaf != nullptr) << k;
        if (leaf) of_kind[in_tree[ids[k]]] |= 1u << k;
        for (int i = 0; i < 3; ++i) {
            lanes.lo[i][k] = leaf ? leaf->volume.Mins()[i] : std::numeric_limits<float>::infinity();
            lanes.hi[i][k] = leaf ? leaf->volume.Maxs()[i] : -std::numeric_limits<float>::infinity();
        }
    }
    const auto found = [&](unsigned met, uint32_t other) {
        for (; met != 0; met &= met - 1) {
            const uint32_t id = ids[size_t(std::countr_zero(met))];
            const bool reports = other != id && !(boxes.of[other].stale && other < id);
            if (reports && (boxes.of[other].moves || boxes.of[id].moves)) report(pair_key(id, other));
        }
    };
    Descent descent(lanes, found);
    for (const Kind kind : {kMoving, kStanding, kGrains}) {
        const unsigned others = kind == kMoving ? asking : asking & ~of_kind[kind];
        if (others != 0 && trees[kind].root()) descent.begin_at(trees[kind].root(), others);
    }
    descent.run();
}

// Stops where there is no more room for what some find.
void Broadphase::State::find(uint32_t begin, uint32_t end) {
    Found& found = found_of[begin] = {0, begin, end};
    uint64_t* const to = partners.data() + size_t(begin) * room;
    const uint32_t most = (end - begin) * room;
    while (found.next < end) {
        const auto some = some_stale(found.next, end);
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
    const auto number = uint32_t(boxes.stale.size());
    size_t keys = 0;
    for (uint32_t i = 0; i < number; i = found_of[i].end) keys += found_of[i].count;
    fresh.clear();
    reserve_more(fresh, keys);
    for (uint32_t i = 0; i < number; i = found_of[i].end) {
        const Found& found = found_of[i];
        const uint64_t* const first = partners.data() + size_t(i) * room;
        fresh.insert(fresh.end(), first, first + found.count);
        for (uint32_t next = found.next; next < found.end; next += kAtOnce)
            for_partners(some_stale(next, found.end), [&](uint64_t key) { fresh.push_back(key); });
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
    const Array<uint64_t>& all = boxes.pairs;
    gone.clear();
    for (size_t begin = 0; begin < all.size(); begin += kTogether) {
        uint64_t found[kTogether];
        size_t count = 0;
        for (const uint64_t key : std::span(all).subspan(begin, std::min(kTogether, all.size() - begin))) {
            found[count] = key;
            count += size_t(boxes.of[uint32_t(key >> 32)].stale) | size_t(boxes.of[uint32_t(key)].stale);
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

void Broadphase::add(uint32_t id, const Box& tight, bool moves, bool grain) {
    State& s = *state_;
    if (id >= s.boxes.of.size()) reserve_more(s.boxes.of, id + 1 - s.boxes.of.size());
    reserve_tree();
    if (s.stays.size() <= id) s.stays.resize(size_t(id) + 1);
    if (s.in_tree.size() <= id) s.in_tree.resize(size_t(id) + 1);
    if (s.leaves.size() <= id) s.leaves.resize(size_t(id) + 1);
    if (s.boxes.of.size() <= id) s.boxes.of.resize(size_t(id) + 1);
    s.mark(id);
    const btDbvtVolume volume = fat_volume(tight, Vec3f::Zero());
    s.boxes.of[id].box = box_of(volume);
    s.boxes.of[id].moves = moves;
    s.boxes.of[id].grain = grain;
    s.boxes.of[id].stray = false;
    set_leaf(id, true);
}

void Broadphase::remove(uint32_t id) {
    state_->mark(id);
    state_->boxes.of[id].stray = false;
    set_leaf(id, false);
}

void Broadphase::State::change(uint32_t id, const btDbvtVolume& volume) {
    if (stays[id] < kMostStays && may_stay(*leaves[id], volume)) {
        ++stays[id];
        return tree_of(id).change_in_place(*leaves[id], volume);
    }
    stays[id] = 0;
    tree_of(id).change(leaves[id], volume);
}

void Broadphase::update(uint32_t id, const Box& tight, const Vec3f& displacement) {
    State& s = *state_;
    s.boxes.of[id].stray = false;
    if (holds(id, tight)) return;
    s.mark(id);
    const btDbvtVolume volume = fat_volume(tight, displacement * reach_ahead(tight));
    s.boxes.of[id].box = box_of(volume);
    s.change(id, volume);
}

bool Broadphase::holds(uint32_t id, const Box& tight) const {
    const Box& fat = state_->boxes.of[id].box;
    int inside = 1;  // without branches: of what moves fast every other one is not
    for (int i = 0; i < 3; ++i) inside &= int(fat.lo[i] <= tight.lo[i]) & int(tight.hi[i] <= fat.hi[i]);
    return inside != 0;
}

// ---------------------------------------------------------------- state

Broadphase::Boxes& Broadphase::boxes() { return state_->boxes; }
const Broadphase::Boxes& Broadphase::boxes() const { return state_->boxes; }

// A step takes no memory for strays and stale ones.
void Broadphase::reserve_tree() {
    State& s = *state_;
    const size_t ids = s.boxes.of.capacity();
    s.leaves.reserve(ids);
    s.stays.reserve(ids);
    s.in_tree.reserve(ids);
    s.strays.reserve(ids);
    s.boxes.stale.reserve(ids);
}

void Broadphase::start_rebuild() {
    State& s = *state_;
    for (size_t id = s.boxes.of.size(); id < s.leaves.size(); ++id) set_leaf(uint32_t(id), false);
    s.leaves.resize(s.boxes.of.size());
    s.stays.resize(s.boxes.of.size());
    s.in_tree.resize(s.boxes.of.size());
    for (FatBox& box : s.boxes.of) box.stale = false;
    for (const uint32_t id : s.boxes.stale) s.boxes.of[id].stale = true;
    s.strays.clear();
    s.fresh.clear();
    s.gone.clear();
}

// Most leaves have their boxes already, or others nearby.
void Broadphase::set_leaf(uint32_t id, bool lives) {
    State& s = *state_;
    btDbvtNode*& leaf = s.leaves[id];
    if (!lives || !leaf) s.stays[id] = 0;
    if (!lives) {
        if (leaf) s.tree_of(id).remove(leaf);
        leaf = nullptr;
        return;
    }
    const FatBox& fat = s.boxes.of[id];
    const btDbvtVolume volume = tight_volume(fat.box);
    if (!leaf || s.in_tree[id] != State::kind_of(fat)) {
        btDbvtNode* const grown = s.trees[size_t(State::kind_of(fat))].add(volume, id);  // what may fail comes first
        if (leaf) s.tree_of(id).remove(leaf);
        s.in_tree[id] = State::kind_of(fat);
        leaf = grown;
    } else if (NotEqual(leaf->volume, volume)) {
        s.change(id, volume);
    }
    if (fat.stray) s.strays.push_back(id);
}

// ---------------------------------------------------------------- pairs

uint32_t Broadphase::start_refresh() {
    State& s = *state_;
    for (LeafTree& tree : s.trees) tree.settle();
    const size_t wanted = s.found_before < State::kMany ? 0 : 3 * s.found_before / (2 * s.boxes.stale.size() + 1);
    s.room = uint32_t(std::clamp(wanted, size_t(State::kRoom), size_t(State::kMostRoom)));
    s.partners.resize(s.boxes.stale.size() * s.room);
    s.found_of.resize(s.boxes.stale.size());
    if (s.boxes.stale.size() > State::kAtOnce) s.order_stale();
    return uint32_t(s.boxes.stale.size());
}

void Broadphase::find_pairs(uint32_t begin, uint32_t end) {
    if (begin < end) state_->find(begin, end);
}

bool Broadphase::finish_refresh() {
    State& s = *state_;
    if (s.boxes.stale.empty()) {
        s.fresh.clear();
        s.gone.clear();
        return false;
    }
    s.gather_fresh();
    const bool changed = s.find_changes();
    if (changed) {
        reserve_more(s.boxes.pairs, s.fresh.size());
        const auto itself = [](uint64_t key) { return key; };
        Exchange(s.boxes.pairs, {s.gone, s.fresh}, itself, itself).run();
    }
    for (const uint32_t id : s.boxes.stale) s.boxes.of[id].stale = false;
    s.boxes.stale.clear();
    return changed;
}

bool Broadphase::refresh_pairs() {
    find_pairs(0, start_refresh());
    return finish_refresh();
}

void Broadphase::let_go() {
    State& s = *state_;
    for (Array<uint64_t>* each : {&s.fresh, &s.gone}) taut::let_go(*each);
    taut::let_go(s.partners);
    taut::let_go(s.first_of);
    taut::let_go(s.found_of);
}

void Broadphase::trim() noexcept { taut::trim(state_->boxes.pairs); }

std::span<const uint64_t> Broadphase::pairs() const { return state_->boxes.pairs; }
std::span<const uint64_t> Broadphase::arrived() const { return state_->fresh; }
std::span<const uint64_t> Broadphase::departed() const { return state_->gone; }

// ---------------------------------------------------------------- probes

void Broadphase::clear_strays() {
    for (const uint32_t id : state_->strays) state_->boxes.of[id].stray = false;
    state_->strays.clear();
}

void Broadphase::note_stray(uint32_t id) {
    state_->boxes.of[id].stray = true;
    state_->strays.push_back(id);
}

// Down a tree and up again by the parents: a query has no memory of its own.
template <class Asks>
void Broadphase::State::walk(const btDbvtNode* root, const Asks& asks, Probe& probe, Visitor& visitor) const {
    const btDbvtNode* node = root;
    while (node) {
        if (asks.meets(probe, node->volume)) {
            if (node->isinternal()) {
                node = node->childs[asks.first(probe, node)];
                continue;
            }
            const uint32_t id = uint32_t(node->dataAsInt);
            if (!boxes.of[id].stray) visitor.visit(id, probe);
        }
        const auto second = [&](const btDbvtNode* parent) { return parent->childs[1 - asks.first(probe, parent)]; };
        while (node != root && node == second(node->parent)) node = node->parent;
        node = node == root ? nullptr : second(node->parent);
    }
}

void Broadphase::visit(Probe probe, Visitor& visitor, uint8_t kinds) const {
    const State& s = *state_;
    const auto asked = [&](State::Kind kind) { return (kinds >> kind & 1) != 0; };
    for (const uint32_t id : s.strays)
        if (s.boxes.of[id].stray && asked(State::kind_of(s.boxes.of[id]))) visitor.visit(id, probe);
    for (const State::Kind kind : {State::kMoving, State::kStanding, State::kGrains}) {
        if (!asked(kind)) continue;
        s.trees[kind].for_roots([&](const btDbvtNode* root) {
            if (probe.along == Vec3::Zero() && probe.reach == 0)
                s.walk(root, Overlap(probe), probe, visitor);
            else
                s.walk(root, Slabs(probe), probe, visitor);
        });
    }
}

}  // namespace taut::collision
