#include "collision/leaf_tree.h"

#include <algorithm>
#include <bit>
#include <new>
#include <utility>

namespace taut::collision {
namespace {

// Nothing below a node of so many leaves may be deeper.
uint32_t depth_of(uint32_t leaves) { return 2 * static_cast<uint32_t>(std::bit_width(leaves)); }

uint32_t count(const btDbvtNode* node) { return node->isleaf() ? 1 : count(node->childs[0]) + count(node->childs[1]); }

const btDbvtNode* top_of(const btDbvtNode* node) {
    while (node->parent) node = node->parent;
    return node;
}

void refit(btDbvtNode* node) {
    for (; node; node = node->parent) {
        const btDbvtVolume before = node->volume;
        Merge(node->childs[0]->volume, node->childs[1]->volume, node->volume);
        if (!NotEqual(before, node->volume)) return;
    }
}

btDbvtNode*& slot_of(btDbvtNode* child) { return child->parent->childs[child->parent->childs[1] == child]; }

}  // namespace

// ---------------------------------------------------------------- nodes

btDbvtNode* LeafTree::take() {
    btDbvtNode* const node = std::exchange(free_, free_->parent);
    node->parent = nullptr;
    node->childs[0] = node->childs[1] = nullptr;
    return node;
}

void LeafTree::give(btDbvtNode* node) {
    node->parent = free_;
    free_ = node;
}

btDbvtNode* LeafTree::join(btDbvtNode* one, btDbvtNode* other) {
    btDbvtNode* const both = take();
    both->childs[0] = one;
    both->childs[1] = other;
    one->parent = other->parent = both;
    Merge(one->volume, other->volume, both->volume);
    return both;
}

// Where a root is kept.
btDbvtNode*& LeafTree::root_slot(btDbvtNode* root) {
    const auto at = std::ranges::find(waiting_, root);
    return at == waiting_.end() ? tree_.m_root : *at;
}

bool LeafTree::waits(const btDbvtNode* leaf) const { return settled_ < leaves_ && top_of(leaf) != tree_.m_root; }

// Out of its tree; its sibling comes in their parent's place.
void LeafTree::splice(btDbvtNode* leaf) {
    btDbvtNode* const parent = leaf->parent;
    if (!parent) {
        root_slot(leaf) = nullptr;
        return;
    }
    btDbvtNode* const sibling = parent->childs[parent->childs[0] == leaf];
    btDbvtNode* const above = parent->parent;
    (above ? slot_of(parent) : root_slot(parent)) = sibling;
    sibling->parent = above;
    give(parent);
    refit(above);
}

// ---------------------------------------------------------------- leaves

btDbvtNode* LeafTree::add(const btDbvtVolume& volume, uint32_t id) {
    for (size_t wanted = 2 * (size_t{leaves_} + 1); pool_.size() < wanted;) give(&pool_.emplace_back());
    btDbvtNode* const leaf = take();
    leaf->volume = volume;
    leaf->dataAsInt = static_cast<int>(id);
    ++leaves_;
    btDbvtNode* tree = leaf;
    for (btDbvtNode*& level : waiting_) {
        if (!level) {
            level = tree;
            break;
        }
        tree = join(std::exchange(level, nullptr), tree);
    }
    return leaf;
}

void LeafTree::remove(btDbvtNode* leaf) {
    settled_ -= waits(leaf) ? 0 : 1;
    --leaves_;
    splice(leaf);
    give(leaf);
}

void LeafTree::change(btDbvtNode* leaf, const btDbvtVolume& volume) {
    if (waits(leaf)) return change_in_place(*leaf, volume);
    btDbvtVolume place = volume;
    tree_.update(leaf, place);
    bound_depth(leaf);
}

void LeafTree::change_in_place(btDbvtNode& leaf, const btDbvtVolume& volume) {
    leaf.volume = volume;
    refit(leaf.parent);
}

// Bullet takes a leaf out and puts it in anew, and of its own takes no node then.
void LeafTree::put(btDbvtNode* leaf) {
    leaf->parent = nullptr;
    tree_.m_root = tree_.m_root ? join(tree_.m_root, leaf) : leaf;
    btDbvtVolume place = leaf->volume;
    tree_.update(leaf, place);
    bound_depth(leaf);
}

// As many as there are already, or more, with these: each leaf is built anew no more often than their number doubles.
void LeafTree::settle() {
    const uint32_t waiting = leaves_ - settled_;
    if (waiting == 0) return;
    const bool together = waiting >= settled_;
    put_.clear();
    put_.reserve(together ? leaves_ : waiting);
    for (btDbvtNode*& root : waiting_)
        if (root) list(std::exchange(root, nullptr), put_);
    settled_ = leaves_;
    if (together) {
        if (tree_.m_root) list(tree_.m_root, put_);
        tree_.m_root = build(put_);
        tree_.m_root->parent = nullptr;
    } else {
        for (const Middle& each : put_) put(each.leaf);
    }
    let_go(put_);
}

// ---------------------------------------------------------------- balance

// The leaves below a node, which goes with all inner ones.
void LeafTree::list(btDbvtNode* node, Array<Middle>& to) {
    if (node->isleaf()) {
        const btVector3 middle = node->volume.Mins() + node->volume.Maxs();
        to.push_back({{middle.x(), middle.y(), middle.z()}, node});
        return;
    }
    list(node->childs[0], to);
    list(node->childs[1], to);
    give(node);
}

// Halves across the axis along which their middles spread most.
btDbvtNode* LeafTree::build(std::span<Middle> leaves) {
    if (leaves.size() == 1) return leaves[0].leaf;
    float lo[3], hi[3];
    std::copy_n(leaves[0].of, 3, lo);
    std::copy_n(leaves[0].of, 3, hi);
    for (const Middle& each : leaves)
        for (int i = 0; i < 3; ++i) lo[i] = std::min(lo[i], each.of[i]), hi[i] = std::max(hi[i], each.of[i]);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (hi[i] - lo[i] > hi[axis] - lo[axis]) axis = i;
    const size_t half = leaves.size() / 2;
    std::ranges::nth_element(leaves, leaves.begin() + static_cast<std::ptrdiff_t>(half),
                             [&](const Middle& a, const Middle& b) { return a.of[axis] < b.of[axis]; });
    btDbvtNode* const one = build(leaves.first(half));
    return join(one, build(leaves.subspan(half)));
}

void LeafTree::rebuild(btDbvtNode* below) {
    btDbvtNode* const above = below->parent;
    btDbvtNode*& slot = above ? slot_of(below) : tree_.m_root;
    built_.clear();
    list(below, built_);
    btDbvtNode* const anew = build(built_);
    anew->parent = above;
    slot = anew;
    let_go(built_);
}

// After a leaf went in: the lowest that has one too deep below it is built anew; without memory for that, with a later
// one.
void LeafTree::bound_depth(btDbvtNode* leaf) {
    uint32_t depth = 0;
    for (const btDbvtNode* node = leaf; node->parent; node = node->parent) ++depth;
    if (depth <= depth_of(settled_)) return;
    uint32_t leaves = 1;
    depth = 0;
    for (btDbvtNode* node = leaf; node->parent; node = node->parent) {
        leaves += count(node->parent->childs[node->parent->childs[0] == node]);
        if (++depth <= depth_of(leaves)) continue;
        try {
            built_.reserve(leaves);
        } catch (const std::bad_alloc&) {
            return;
        }
        return rebuild(node->parent);
    }
}

}  // namespace taut::collision
