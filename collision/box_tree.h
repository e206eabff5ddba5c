// A tree of boxes over items that keep their number and move: built once, refitted to where they are.
#pragma once

#include <algorithm>
#include <limits>

#include "base/math.h"
#include "base/memory.h"

namespace taut::collision {

// [m]; lo > hi: nothing.
struct ItemBox {
    Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

    void add(const Vec3& p) { lo = lo.cwiseMin(p), hi = hi.cwiseMax(p); }
    void add(const ItemBox& other) { lo = lo.cwiseMin(other.lo), hi = hi.cwiseMax(other.hi); }
    bool holds(const Vec3& p) const { return (p.array() >= lo.array()).all() && (p.array() <= hi.array()).all(); }
    bool meets(const ItemBox& o) const {
        return (lo.array() <= o.hi.array()).all() && (o.lo.array() <= hi.array()).all();
    }
    // Square of the least distance of a point [m^2].
    double distance_squared(const Vec3& p) const {
        return (lo - p).cwiseMax(p - hi).cwiseMax(Vec3::Zero()).squaredNorm();
    }
};

class BoxTree {
public:
    explicit BoxTree(Memory& memory) : node_(memory), item_(memory), box_(memory) {}

    uint32_t items() const { return static_cast<uint32_t>(item_.size()); }
    const ItemBox& box() const { return node_.front().box; }  // of all, where there are any

    // box_of(i): of each of so many items; these decide the tree's shape, along the longest side of their middles.
    template <class BoxOf>
    void build(uint32_t count, BoxOf&& box_of) {
        item_.resize(count);
        box_.resize(count);
        for (uint32_t i = 0; i < count; ++i) item_[i] = i, box_[i] = box_of(i);
        node_.clear();
        if (count > 0) split(0, count);
        refit(box_of);
    }
    template <class BoxOf>
    void refit(BoxOf&& box_of) {
        for (size_t i = node_.size(); i-- > 0;) {
            Node& node = node_[i];
            node.box = {};
            if (node.count > 0) {
                for (uint32_t k = 0; k < node.count; ++k) node.box.add(box_of(item_[node.first + k]));
            } else {
                node.box.add(node_[i + 1].box);
                node.box.add(node_[node_[i + 1].next].box);
            }
        }
    }

    // act(item) for those whose leaf may hold a point, until it returns false.
    template <class Act>
    void for_holding(const Vec3& point, Act&& act) const {
        for (uint32_t i = 0; i < node_.size();) {
            const Node& node = node_[i];
            const bool holds = node.box.holds(point);
            if (holds)
                for (uint32_t k = 0; k < node.count; ++k)
                    if (!act(item_[node.first + k])) return;
            i = holds && node.count == 0 ? i + 1 : node.next;
        }
    }
    // distance(item): square of that from the point, infinite for one that does not count. The item of the least, the
    // first of equals in the tree; UINT32_MAX: none.
    template <class Distance>
    uint32_t nearest(const Vec3& point, Distance&& distance) const {
        uint32_t found = UINT32_MAX;
        double least = std::numeric_limits<double>::infinity();
        if (!node_.empty()) search(0, point, distance, least, found);
        return found;
    }

private:
    // In preorder: children of an inner one follow it.
    struct Node {
        ItemBox box;
        uint32_t first, count;  // in item_; count 0: an inner one
        uint32_t next;          // after all below it
    };
    static constexpr uint32_t kLeaf = 4;  // items

    uint32_t split(uint32_t begin, uint32_t end) {
        const auto at = static_cast<uint32_t>(node_.size());
        node_.push_back({{}, begin, end - begin, 0});
        if (end - begin > kLeaf) {
            const auto middle_of = [&](uint32_t item) { return Vec3(box_[item].lo + box_[item].hi); };
            ItemBox middles;
            for (uint32_t i = begin; i < end; ++i) middles.add(middle_of(item_[i]));
            int axis;
            (middles.hi - middles.lo).maxCoeff(&axis);
            const uint32_t half = begin + (end - begin) / 2;
            std::nth_element(item_.begin() + begin, item_.begin() + half, item_.begin() + end,
                             [&](uint32_t a, uint32_t b) {
                                 const double pa = middle_of(a)[axis], pb = middle_of(b)[axis];
                                 return pa < pb || (pa == pb && a < b);
                             });
            node_[at].count = 0;
            split(begin, half);
            split(half, end);
        }
        node_[at].next = static_cast<uint32_t>(node_.size());
        return at;
    }

    template <class Distance>
    void search(uint32_t at, const Vec3& point, Distance&& distance, double& least, uint32_t& found) const {
        const Node& node = node_[at];
        for (uint32_t k = 0; k < node.count; ++k)
            if (const double own = distance(item_[node.first + k]); own < least)
                least = own, found = item_[node.first + k];
        if (node.count > 0) return;
        uint32_t child[2] = {at + 1, node_[at + 1].next};
        double bound[2];
        for (int k = 0; k < 2; ++k) bound[k] = node_[child[k]].box.distance_squared(point);
        if (bound[1] < bound[0]) std::swap(child[0], child[1]), std::swap(bound[0], bound[1]);
        for (int k = 0; k < 2; ++k)
            if (bound[k] < least) search(child[k], point, distance, least, found);
    }

    Array<Node> node_;
    Array<uint32_t> item_;
    Array<ItemBox> box_;  // as it was built
};

}  // namespace taut::collision
