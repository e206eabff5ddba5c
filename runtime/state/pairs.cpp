#include "state/pairs.h"

#include <algorithm>

#include "state/handle.h"

namespace taut {
namespace {

bool ends_on(const Pair& pair, uint32_t node) { return pair.a() == node || pair.b() == node; }

}  // namespace

void report_end(Pairs& pairs, const Nodes& nodes, const Pair& pair) {
    const auto handle = [&](uint32_t node) {
        return taut_body{pack_handle({node, nodes.ids.generation(node), pairs.world})};
    };
    pairs.ended.push_back({handle(pair.a()), handle(pair.b())});
}

void forget_pair(Pairs& pairs, const Nodes& nodes, uint32_t a, uint32_t b) {
    const uint64_t key = static_cast<uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
    const auto at = std::lower_bound(pairs.list.begin(), pairs.list.end(), key,
                                     [](const Pair& pair, uint64_t wanted) { return pair.key < wanted; });
    if (at == pairs.list.end() || at->key != key) return;
    if (at->touching) report_end(pairs, nodes, *at);
    pairs.list.erase(at);
}

void forget_pairs_of(Pairs& pairs, const Nodes& nodes, uint32_t node) {
    reserve_ended(pairs, node);
    for (const Pair& pair : pairs.list) {
        if (pair.touching && ends_on(pair, node)) report_end(pairs, nodes, pair);
    }
    std::erase_if(pairs.list, [&](const Pair& pair) { return ends_on(pair, node); });
}

void reserve_ended(Pairs& pairs, uint32_t node) {
    const auto touching = std::count_if(pairs.list.begin(), pairs.list.end(),
                                        [&](const Pair& pair) { return pair.touching && ends_on(pair, node); });
    const size_t needed = pairs.ended.size() + static_cast<size_t>(touching);
    if (needed > pairs.ended.capacity()) pairs.ended.reserve(std::max(needed, 2 * pairs.ended.capacity()));
}

}  // namespace taut
