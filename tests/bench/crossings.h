// Triangles of soft bodies that run through each other, in double precision, independent of the library's contacts.
#pragma once

#include <taut/math.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bench {

// The surface of a cloth or solid. ids: one a point, of all skins or of none; points of the same id are one, as at
// seams.
struct Skin {
    std::span<const taut_pos> points;
    std::span<const std::array<uint32_t, 3>> faces;
    std::span<const uint32_t> ids;
};

struct Crossings {
    std::vector<size_t> own;  // pairs of each skin's triangles
    size_t between = 0;       // of different skins'
};

// Whether an edge of one triangle passes through the inside of the other: what only touches, or lies in the same plane,
// does not cross. Any pair that intersects otherwise has such an edge (Moeller 1997).
bool cross_each_other(const std::array<taut_pos, 3>& a, const std::array<taut_pos, 3>& b);

// Pairs that cross and share no point; found by a tree of boxes.
Crossings count_crossings(std::span<const Skin> skins);

// Boxes about triangles, in a tree of which each node's half is split along the longest side.
class FaceTree {
public:
    struct Box {
        double low[3], high[3];
    };
    static Box box_about(const taut_pos& a, const taut_pos& b, const taut_pos& c);

    explicit FaceTree(std::vector<Box> boxes);

    // Calls visit(i) of each box that meets the given one.
    template <class Visit>
    void each_near(const Box& box, Visit&& visit) const {
        if (!nodes_.empty()) descend(0, box, visit);
    }

private:
    struct Node {
        Box box;
        uint32_t first, count;  // of order_; of leaves
        uint32_t child;         // the second; the first follows its parent. 0: a leaf
    };
    uint32_t build(uint32_t first, uint32_t count);
    static bool meet(const Box& a, const Box& b);
    template <class Visit>
    void descend(uint32_t at, const Box& box, Visit& visit) const {
        const Node& node = nodes_[at];
        if (!meet(node.box, box)) return;
        if (node.child != 0) {
            descend(at + 1, box, visit);
            descend(node.child, box, visit);
            return;
        }
        for (uint32_t i = node.first; i < node.first + node.count; ++i)
            if (meet(boxes_[order_[i]], box)) visit(order_[i]);
    }

    std::vector<Box> boxes_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace bench
