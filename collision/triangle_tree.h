// A tree of boxes over the triangles of a surface, built once. Nodes lie in depth-first order, each with the place
// after its subtree, so that a search is one loop without a stack.
#pragma once

#include "collision/surface.h"

namespace taut::collision {

class TriangleTree {
public:
    explicit TriangleTree(Memory& memory) : nodes_(memory) {}

    void build(const Surface& surface, Memory& memory);
    // Hands over the triangles whose boxes meet this one.
    void find(const Box& box, TriangleSink& triangles) const;

private:
    struct Node {
        Vec3f lo, hi;
        uint32_t after;     // the node that follows this subtree
        uint32_t triangle;  // kNoTriangle: an inner node
    };
    struct Leaf {
        Vec3f lo, hi;
        uint32_t triangle;
    };
    void split(std::span<Leaf> leaves);

    Array<Node> nodes_;
};

inline bool meet(const Vec3f& lo, const Vec3f& hi, const Box& box) {
    return (lo.array() <= box.hi.array()).all() && (box.lo.array() <= hi.array()).all();
}

}  // namespace taut::collision
