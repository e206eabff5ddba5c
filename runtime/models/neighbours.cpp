#include "models/neighbours.h"

#include <algorithm>
#include <numeric>

namespace taut {

// What was found so far, sorted.
struct Neighbours::Search {
    const Vec3& to;
    uint32_t most;
    double squared;  // none is further
    Neighbour* out;
    uint32_t count = 0;

    void offer(const Neighbour& found) {
        if (!(found.squared <= squared)) return;
        const auto nearer = [](const Neighbour& a, const Neighbour& b) {
            return a.squared < b.squared || (a.squared == b.squared && a.point < b.point);
        };
        if (count == most && !nearer(found, out[count - 1])) return;
        Neighbour* const end = out + count - (count == most ? 1 : 0);
        Neighbour* const at = std::lower_bound(out, end, found, nearer);
        std::move_backward(at, end, end + 1);
        *at = found;
        if (count < most) ++count;
        if (count == most) squared = out[count - 1].squared;
    }
};

Neighbours::Neighbours(std::span<const Vec3> points, Memory& memory)
    : points_(points), order_(points.size(), 0u, memory), axis_(points.size(), uint8_t{0}, memory) {
    std::iota(order_.begin(), order_.end(), 0u);
    split(0, static_cast<uint32_t>(points.size()));
}

void Neighbours::split(uint32_t begin, uint32_t end) {
    if (end - begin < 2) return;
    Vec3 low = points_[order_[begin]], high = low;
    for (uint32_t i = begin; i < end; ++i) {
        low = low.cwiseMin(points_[order_[i]]);
        high = high.cwiseMax(points_[order_[i]]);
    }
    int axis = 0;
    (high - low).maxCoeff(&axis);
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](uint32_t a, uint32_t b) {
                         const double at_a = points_[a][axis], at_b = points_[b][axis];
                         return at_a < at_b || (at_a == at_b && a < b);
                     });
    axis_[middle] = static_cast<uint8_t>(axis);
    split(begin, middle);
    split(middle + 1, end);
}

void Neighbours::visit(Search& search, uint32_t begin, uint32_t end) const {
    if (begin == end) return;
    const uint32_t middle = begin + (end - begin) / 2, point = order_[middle];
    search.offer({(points_[point] - search.to).squaredNorm(), point});
    const double beyond = search.to[axis_[middle]] - points_[point][axis_[middle]];
    if (beyond < 0) {
        visit(search, begin, middle);
        if (beyond * beyond <= search.squared) visit(search, middle + 1, end);
    } else {
        visit(search, middle + 1, end);
        if (beyond * beyond <= search.squared) visit(search, begin, middle);
    }
}

uint32_t Neighbours::nearest(const Vec3& to, uint32_t count, double reach, Neighbour* out) const {
    if (count == 0) return 0;
    Search search{to, count, reach * reach, out};
    visit(search, 0, static_cast<uint32_t>(order_.size()));
    return search.count;
}

}  // namespace taut
