#include "partition/touch_graph.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "threads/gather.h"

namespace taut {
namespace {

constexpr uint32_t kGrain = 512;  // elements that a thread takes at a time

// Brings a list up to date with now(index) below count. True: it changed.
template <class T, class Now>
bool renew(Team& team, Array<T>& list, size_t count, Now&& now) {
    std::atomic<bool> changed{list.size() != count};
    reserve_more(list, std::max(count, list.size()) - list.size());
    list.resize(count);
    team.for_ranges(static_cast<uint32_t>(count), kGrain, [&](uint32_t begin, uint32_t end) {
        bool differs = false;
        for (uint32_t i = begin; i < end; ++i) {
            const T is = now(i);
            if (is == list[i]) continue;
            list[i] = is;
            differs = true;
        }
        if (differs) changed.store(true, std::memory_order_relaxed);
    });
    return changed.load(std::memory_order_relaxed);
}

}  // namespace

bool TouchGraph::update_moves(Team& team, const Nodes& nodes) {
    gather(team, std::span<const uint32_t>(nodes.active), now_, [&](uint32_t node) { return nodes.solved(node); });
    const bool same = !moves.empty() && std::ranges::equal(movers, now_);
    moves.resize(nodes.slots());
    if (same) return false;
    for (const uint32_t node : movers) moves[node] = 0;
    std::swap(movers, now_);
    for (const uint32_t node : movers) moves[node] = 1;
    return true;
}

bool TouchGraph::update_touches(Team& team, const Pairs& pairs) {
    std::atomic<bool> spanning{false};
    const bool changed = renew(team, touches, pairs.active.size(), [&](uint32_t p) {
        const ActivePair& pair = pairs.active[p];
        if (pair.spans()) spanning.store(true, std::memory_order_relaxed);
        return Touch{mover(pair.a), mover(pair.b)};
    });
    const bool had_spans = !spans.empty();
    spans.clear();
    if (!spanning.load(std::memory_order_relaxed)) return changed || had_spans;
    for (const ActivePair& pair : pairs.active)
        if (pair.spans()) spans.push_back({mover(pair.a), mover(pair.b), mover(pair.a2), mover(pair.b2)});
    return true;
}

bool TouchGraph::update_ties(Team& team, const Joints& joints) {
    return renew(team, ties, joints.record.size(), [&](uint32_t j) {
        Tie tie;
        tie.fill(kNone);
        std::ranges::transform(joints.record[j].nodes(), tie.begin(), [&](uint32_t node) { return mover(node); });
        return tie;
    });
}

void TouchGraph::forget() {
    moves.clear();
    movers.clear();
}

bool TouchGraph::update(Team& team, const Nodes& nodes, const Joints& joints, const Elements& elements,
                        const Pairs& pairs) {
    const bool moves_changed = update_moves(team, nodes), touches_changed = update_touches(team, pairs);
    const bool elements_changed = std::exchange(elements_version_, elements.version) != elements.version;
    const bool grains_changed = std::exchange(grains_version_, pairs.grains.version) != pairs.grains.version;
    const bool surfaces_changed = std::exchange(surfaces_version_, pairs.surfaces.version) != pairs.surfaces.version;
    return update_ties(team, joints) || moves_changed || touches_changed || elements_changed || grains_changed ||
           surfaces_changed;
}

}  // namespace taut
