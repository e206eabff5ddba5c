#include "collision/triangle_tree.h"

#include <algorithm>

namespace taut::collision {

void TriangleTree::build(const Surface& surface) {
    std::vector<Leaf> leaves;
    for (uint32_t t = 0; t < surface.slots(); ++t) {
        if (!surface.has(t)) continue;
        const Corners c = surface.corners(t);
        const Vec3f p = surface.vertex(c[0]), q = surface.vertex(c[1]), r = surface.vertex(c[2]);
        leaves.push_back({p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r), t});
    }
    nodes_.clear();
    nodes_.reserve(2 * leaves.size());
    split(leaves, 0, leaves.size());
}

// Halves by the boxes' middles along the longest side, the number breaking ties: the same tree from every library.
void TriangleTree::split(std::vector<Leaf>& leaves, size_t begin, size_t end) {
    const size_t place = nodes_.size();
    Node node{leaves[begin].lo, leaves[begin].hi, 0, leaves[begin].triangle};
    for (size_t i = begin; i < end; ++i) {
        node.lo = node.lo.cwiseMin(leaves[i].lo);
        node.hi = node.hi.cwiseMax(leaves[i].hi);
    }
    nodes_.push_back(node);
    if (end - begin > 1) {
        nodes_[place].triangle = kNoTriangle;
        int axis = 0;
        (node.hi - node.lo).maxCoeff(&axis);
        const size_t middle = begin + (end - begin) / 2;
        std::nth_element(leaves.begin() + long(begin), leaves.begin() + long(middle), leaves.begin() + long(end),
                         [axis](const Leaf& a, const Leaf& b) {
                             const float p = a.lo[axis] + a.hi[axis], q = b.lo[axis] + b.hi[axis];
                             return p != q ? p < q : a.triangle < b.triangle;
                         });
        split(leaves, begin, middle);
        split(leaves, middle, end);
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
