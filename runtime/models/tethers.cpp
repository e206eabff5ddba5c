#include "models/tethers.h"

#include <Eigen/LU>
#include <algorithm>
#include <tuple>

#include "models/softs.h"

namespace taut {
namespace {

struct Way {
    double length;            // [m]
    uint32_t vertex, source;  // from a pinned vertex

    auto key() const { return std::tuple(length, vertex, source); }
    bool operator>(const Way& other) const { return key() > other.key(); }
};

// The shortest ways from pinned vertices to each vertex, so many of different ones (Dijkstra's, with as many turns).
class Ways {
public:
    Ways(Memory& memory, const Soft& soft, uint32_t most)
        : soft_(soft), most_(most), begin_(memory), step_(memory), heap_(memory), found_(memory), count_(memory) {
        begin_.assign(soft.vertices() + 1, 0);
        for (const uint32_t vertex : soft.triangle) begin_[vertex + 1] += 2;
        for (uint32_t v = 0; v < soft.vertices(); ++v) begin_[v + 1] += begin_[v];
        step_.resize(begin_.back());
        Array<uint32_t> next(begin_);
        for (uint32_t t = 0; t < soft.triangles(); ++t) {
            double length[3];
            rest_edges(soft, t, length);
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t a = soft.triangle[3 * t + k], b = soft.triangle[3 * t + (k + 1) % 3];
                step_[next[a]++] = {length[k], b, kNone};
                step_[next[b]++] = {length[k], a, kNone};
            }
        }
        found_.resize(size_t{soft.vertices()} * most);
        count_.assign(soft.vertices(), 0);
    }
    void begin_at(uint32_t vertex) { push({0, vertex, vertex}); }
    void find() {
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, std::greater<>());
            const Way way = heap_.back();
            heap_.pop_back();
            if (!takes(way)) continue;
            found_[size_t{way.vertex} * most_ + count_[way.vertex]++] = way;
            for (uint32_t i = begin_[way.vertex]; i < begin_[way.vertex + 1]; ++i) {
                const Way on{way.length + step_[i].length, step_[i].vertex, way.source};
                if (takes(on)) push(on);
            }
        }
    }
    std::span<const Way> to(uint32_t vertex) const { return {&found_[size_t{vertex} * most_], count_[vertex]}; }

private:
    bool takes(const Way& way) const {
        return count_[way.vertex] < most_ &&
               std::ranges::none_of(to(way.vertex), [&](const Way& one) { return one.source == way.source; });
    }
    void push(const Way& way) {
        heap_.push_back(way);
        std::ranges::push_heap(heap_, std::greater<>());
    }

    const Soft& soft_;
    uint32_t most_;
    Array<uint32_t> begin_;  // of each vertex's edges in step_
    Array<Way> step_;        // along an edge
    Array<Way> heap_;
    Array<Way> found_;       // [vertices][most_]
    Array<uint32_t> count_;  // of each vertex
};

uint32_t set_of(const Soft& soft) {
    const auto at = std::ranges::find(soft.sets, SoftPart::tether, &SoftSet::part);
    return at == soft.sets.end() ? kNone : at->set;
}

// What tethers that are there carry. Both lists go by vertex.
void carry_over(const ElementSet& set, const Soft& soft, TetherPlan& plan) {
    uint32_t first = 0;
    for (uint32_t i = 0; i < plan.length.size(); ++i) {
        const uint32_t node = soft.node[plan.vertex[2 * i]], pin = soft.node[plan.vertex[2 * i + 1]];
        const auto at = [&](uint32_t e, uint32_t end) { return set.nodes_of(e)[end]; };
        uint32_t e = first;
        while (e < set.size() && at(e, 0) != node) ++e;
        if (e == set.size()) continue;
        first = e;
        while (e < set.size() && at(e, 0) == node && at(e, 1) != pin) ++e;
        if (e == set.size() || at(e, 0) != node) continue;
        plan.lambda[i] = *set.lambda_of(e);
        plan.memory[i] = set.memory[e];
    }
}

}  // namespace

// With X_n the corners in the sheet, sum_n g_n = 0 and g_n . (X_m - X_0) = delta_nm for n, m > 0.
void rest_edges(const Soft& soft, uint32_t triangle, double (&length)[3]) {
    const double* g = &soft.rest[6 * size_t{triangle}];
    Eigen::Matrix2d gradients;
    gradients << g[2], g[3], g[4], g[5];
    const Eigen::Matrix2d sides = gradients.inverse();  // X_1 - X_0, X_2 - X_0
    length[0] = sides.col(0).norm();
    length[1] = (sides.col(1) - sides.col(0)).norm();
    length[2] = sides.col(1).norm();
}

void plan_tethers(World& world, const Soft& soft, uint32_t vertex, bool pinned, TetherPlan& out) {
    const uint32_t index = set_of(soft);
    if (index == kNone) return;
    const auto holds = [&](uint32_t v) { return v == vertex ? pinned : is_pinned(world, soft, v); };
    Ways ways(world.memory, soft, soft.tethers);
    for (uint32_t v = 0; v < soft.vertices(); ++v)
        if (holds(v)) ways.begin_at(v);
    ways.find();
    for (uint32_t v = 0; v < soft.vertices(); ++v) {
        if (holds(v)) continue;
        for (const Way& way : ways.to(v)) {
            out.vertex.insert(out.vertex.end(), {v, way.source});
            out.length.push_back((1 + soft.tether_slack) * way.length);
        }
    }
    ElementSet& set = world.elements.set[index];
    const auto count = static_cast<uint32_t>(out.length.size());
    out.lambda.assign(count, 0.0);
    out.memory.assign(count, {});
    carry_over(set, soft, out);
    reserve_elements(set, count);
}

void set_tethers(World& world, const Soft& soft, const TetherPlan& plan) {
    const uint32_t index = set_of(soft);
    if (index == kNone) return;
    ElementSet& set = world.elements.set[index];
    while (set.size() > 0) world.elements.erase(set, set.size() - 1);
    for (uint32_t i = 0; i < plan.length.size(); ++i) {
        const uint32_t ends[2] = {soft.node[plan.vertex[2 * i]], soft.node[plan.vertex[2 * i + 1]]};
        world.elements.insert(set, i, ends, 1);
        *set.data_of(i) = plan.length[i];
        *set.lambda_of(i) = plan.lambda[i];
        set.memory[i] = plan.memory[i];
    }
}

}  // namespace taut
