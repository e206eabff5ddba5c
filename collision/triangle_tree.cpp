#include "collision/triangle_tree.h"

#include <algorithm>

namespace taut::collision {

void TriangleTree::build(const Surface& surface, Memory& memory) {
    Array<Leaf> leaves(memory);
    leaves.reserve(surface.counts.triangles);
    for (uint32_t t = 0; t < surface.slots(); ++t) {
        if (!surface.has(t)) continue;
        const Corners c = surface.corners(t);
        const Vec3f p = surface.vertex(c[0]), q = surface.vertex(c[1]), r = surface.vertex(c[2]);
        leaves.push_back({p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r), t});
    }
    nodes_.clear();
    nodes_.reserve(2 * leaves.size());
    split(leaves);
}

// Halves by the boxes' middles along the longest side, the number breaking ties: the same tree from every library.
void TriangleTree::split(std::span<Leaf> leaves) {
    const size_t place = nodes_.size();
    Node node{leaves[0].lo, leaves[0].hi, 0, leaves[0].triangle};
    for (const Leaf& leaf : leaves) {
        node.lo = node.lo.cwiseMin(leaf.lo);
        node.hi = node.hi.cwiseMax(leaf.hi);
    }
    nodes_.push_back(node);
    if (leaves.size() > 1) {
        nodes_[place].triangle = kNoTriangle;
        int axis = 0;
        (node.hi - node.lo).maxCoeff(&axis);
        const size_t middle = leaves.size() / 2;
        std::ranges::nth_element(leaves, leaves.begin() + std::ptrdiff_t(middle), [axis](const Leaf& a, const Leaf& b) {
            const float p = a.lo[axis] + a.hi[axis], q = b.lo[axis] + b.hi[axis];
            return p != q ? p < q : a.triangle < b.triangle;
        });
        split(leaves.first(middle));
        split(leaves.subspan(middle));
    }
    nodes_[place].after = uint32_t(nodes_.size());
}

void TriangleTree::find(const Box& box, TriangleSink& triangles) const {
    for (uint32_t i = 0; i < nodes_.size();) {
        const Node& node = nodes_[i];
        if (!meet(node.lo, node.hi, box)) {
            i = node.after;
            continue;
        }
        if (node.triangle != kNoTriangle) triangles.take(node.triangle);
        ++i;
    }
}

}  // namespace taut::collision
