#include "detect/contact_limit.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "detect/drop_contacts.h"

namespace taut {
namespace {

// [m], least of its points.
float separation_of(const collision::Manifold& manifold) {
    float least = manifold.points[0].separation;
    for (int k = 1; k < manifold.count; ++k) least = std::min(least, manifold.points[k].separation);
    return least;
}

}  // namespace

uint32_t limit_contacts(const Nodes& nodes, const Colliders& colliders, uint32_t limit, Pairs& pairs) {
    const size_t found = pairs.active.size();
    if (limit == 0 || found <= limit) return 0;
    Array<uint32_t>& order = pairs.by_depth;
    order.resize(found);
    std::iota(order.begin(), order.end(), 0u);
    const auto key_of = [&](uint32_t i) {
        return std::tuple(separation_of(pairs.list[pairs.active[i].pair].manifold), i);
    };
    const auto dropped = order.begin() + limit;
    std::nth_element(order.begin(), dropped, order.end(),
                     [&](uint32_t a, uint32_t b) { return key_of(a) < key_of(b); });
    std::sort(dropped, order.end());

    uint32_t index = 0;
    auto next = dropped;
    drop_contacts(nodes, colliders, pairs, [&](const ActivePair&, const NearPair&) {
        const bool drop = next != order.end() && *next == index++;
        next += drop;
        return drop;
    });
    return static_cast<uint32_t>(found - limit);
}

}  // namespace taut
