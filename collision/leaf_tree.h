// Bullet's dynamic tree of boxes with its nodes in the world's memory and its depth bounded, however leaves come.
//
// Where Bullet puts a leaf next to what is nearest, leaves that come in a row make a chain. So what a leaf goes too
// deep by is built anew, as in a scapegoat tree (Galperin and Rivest 1993): below a node of n leaves nothing is deeper
// than 2 log2 n, and a leaf costs O(log^2 n). Many at once wait in a forest of their own, which any walk sees as well,
// and are built together.
#pragma once

#include <array>
#include <span>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "base/segmented_array.h"

namespace taut::collision {

class LeafTree {
public:
    explicit LeafTree(Memory& memory) : pool_(memory), put_(memory), built_(memory) {}
    ~LeafTree() { tree_.m_root = nullptr; }  // its nodes are not Bullet's
    LeafTree(const LeafTree&) = delete;
    LeafTree& operator=(const LeafTree&) = delete;

    // A leaf that waits, and room for all that the tree may make of it. Throws std::bad_alloc with nothing changed.
    btDbvtNode* add(const btDbvtVolume& volume, uint32_t id);
    void remove(btDbvtNode* leaf);
    // Gives a leaf another box, in its place or in a new one.
    void change(btDbvtNode* leaf, const btDbvtVolume& volume);
    void change_in_place(btDbvtNode& leaf, const btDbvtVolume& volume);
    // What waits gets its place. Throws std::bad_alloc with nothing changed.
    void settle();

    // After settle(); null: there is none.
    const btDbvtNode* root() const { return tree_.m_root; }
    // act(root) of the tree and of what waits.
    template <class Act>
    void for_roots(Act&& act) const {
        if (tree_.m_root) act(static_cast<const btDbvtNode*>(tree_.m_root));
        for (const btDbvtNode* root : waiting_)
            if (root) act(root);
    }
    uint32_t leaves() const { return leaves_; }

private:
    struct Middle {
        float of[3];  // of a leaf's box, times 2 [m]
        btDbvtNode* leaf;
    };

    btDbvtNode* take();
    void give(btDbvtNode* node);
    btDbvtNode* join(btDbvtNode* one, btDbvtNode* other);
    void splice(btDbvtNode* leaf);
    btDbvtNode*& root_slot(btDbvtNode* root);
    bool waits(const btDbvtNode* leaf) const;
    void put(btDbvtNode* leaf);
    void rebuild(btDbvtNode* below);
    void list(btDbvtNode* node, Array<Middle>& to);
    btDbvtNode* build(std::span<Middle> leaves);
    void bound_depth(btDbvtNode* leaf);

    static constexpr uint32_t kLevels = 32;

    btDbvt tree_;
    std::array<btDbvtNode*, kLevels> waiting_{};  // by level: null, or a tree of what came as 2^level leaves
    SegmentedArray<btDbvtNode> pool_;             // two for each leaf
    btDbvtNode* free_ = nullptr;                  // a list by parent
    uint32_t leaves_ = 0, settled_ = 0;           // in all, and in the tree
    Array<Middle> put_, built_;                   // scratch: leaves that get a place one by one; that are built anew
};

}  // namespace taut::collision
