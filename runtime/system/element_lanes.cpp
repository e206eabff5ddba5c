// Elements of sets with a fused sweep, into lanes and their forces back.
#include <algorithm>

#include "system/assemble.h"

namespace taut {
namespace {

uint32_t numbers_of(const ElementType& type) {
    const auto nodes = static_cast<uint32_t>(type.row.nodes), rows = static_cast<uint32_t>(type.row.rows);
    return 3 * (nodes - 1) + static_cast<uint32_t>(type.numbers) + 1 + rows + 1;
}

uint32_t first_impulse(const ElementType& type) { return numbers_of(type) - static_cast<uint32_t>(type.row.rows) - 1; }

LaneMaterial material_of(const ElementSet& set) {
    LaneMaterial out{};
    const int rows = set.type->row.rows;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c <= r; ++c)
            out.compliance[triangle(static_cast<uint32_t>(r), static_cast<uint32_t>(c))] =
                static_cast<float>(set.compliance[r * rows + c]);
    out.relaxation = static_cast<float>(set.relaxation);
    out.pulls = set.pulls ? 1 : 0;
    return out;
}

// Places for elements of one set that share no moving node, at most kLanes; fill_lanes() fills them.
void add_lanes(ElementLanes& lanes, const ElementSet& set, std::span<const ElementRef> list) {
    ElementGroup& g = lanes.group.emplace_back();
    g.set = list[0].set;
    g.first = lanes.number.take(numbers_of(*set.type));
    std::fill_n(g.element, kLanes, kNoLanes);
    for (size_t i = 0; i < list.size(); ++i) g.element[i] = list[i].element;
}

// A pass's elements: sets follow each other; of a type that differs from the one before they are a pass of their own.
void add_passes(ElementLanes& lanes, const Elements& elements, std::span<const ElementRef> list, bool overflow) {
    const size_t width = overflow ? 1 : kLanes;
    for (size_t begin = 0, end; begin < list.size(); begin = end) {
        const ElementSet& set = elements.set[list[begin].set];
        for (end = begin + 1; end < list.size() && end < begin + width && list[end].set == list[begin].set;) ++end;
        if (lanes.pass.empty() || begin == 0 || lanes.pass.back().sweep != set.type->sweep)
            lanes.pass.push_back({set.type->sweep, size_of(lanes.group), 0, overflow});
        add_lanes(lanes, set, list.subspan(begin, end - begin));
        lanes.pass.back().end = size_of(lanes.group);
    }
}

void fill_lane(System& system, const ElementSet& set, ElementGroup& g, int lane) {
    const uint32_t e = g.element[lane];
    const auto nodes = set.nodes_of(e);
    LaneScalar* out = &system.elements.number[g.first];
    const auto put = [&](double x) { (out++)->value[lane] = static_cast<float>(x); };
    for (size_t n = 0; n < nodes.size(); ++n) g.node[n][lane] = system.at(nodes[n]);
    for (size_t n = 1; n < nodes.size(); ++n) {
        const Vec3 apart = system.found[g.node[n][lane]].x - system.found[g.node[0][lane]].x;
        for (const double x : apart) put(x);
    }
    std::for_each_n(set.data_of(e), set.type->numbers, put);
    put(set.softness[e]);
}

void fill_lanes(System& system, const Elements& elements, ElementGroup& g) {
    const ElementSet& set = elements.set[g.set];
    for (auto& node : g.node) std::fill_n(node, kLanes, 0u);
    std::fill_n(&system.elements.number[g.first], numbers_of(*set.type), LaneScalar{});
    for (int lane = 0; lane < kLanes; ++lane)
        if (g.element[lane] != kNoLanes) fill_lane(system, set, g, lane);
}

}  // namespace

void build_element_lanes(Team& team, System& system, const Group& group, Elements& elements) {
    ElementLanes& lanes = system.elements;
    lanes.group.clear();
    lanes.pass.clear();
    lanes.number.clear();
    if (group.fused.empty()) return;
    lanes.set.resize(elements.set.size());
    lanes.material.resize(elements.set.size());
    for (size_t s = 0; s < elements.set.size(); ++s) {
        lanes.set[s] = &elements.set[s];
        if (elements.set[s].type && elements.set[s].fused) lanes.material[s] = material_of(elements.set[s]);
    }
    for (const FusedPass& pass : group.fused_pass)
        add_passes(lanes, elements, std::span(group.fused).subspan(pass.begin, pass.end - pass.begin), pass.overflow);
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) fill_lanes(system, elements, lanes.group[i]);
    });
}

void store_element_lanes(Team& team, const System& system) {
    const ElementLanes& lanes = system.elements;
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const ElementGroup& g = lanes.group[i];
            ElementSet& set = *lanes.set[g.set];
            const LaneScalar* impulse = &lanes.number[g.first + first_impulse(*set.type)];
            for (int lane = 0; lane < kLanes; ++lane) {
                if (g.element[lane] == kNoLanes) continue;
                double* lambda = set.lambda_of(g.element[lane]);
                for (int r = 0; r < set.type->row.rows; ++r) lambda[r] = system.scheme.force(impulse[r].value[lane]);
                set.fresh[g.element[lane]] = 0;
            }
        }
    });
}

// Yields of the last substep, onto what is left of those before.
void store_element_yields(const System& system) {
    const ElementLanes& lanes = system.elements;
    const double per_square = 1 / (system.scheme.h * system.scheme.h);
    for (const ElementGroup& g : lanes.group) {
        ElementSet& of = *lanes.set[g.set];
        const LaneScalar& yield = lanes.number[g.first + numbers_of(*of.type) - 1];
        const float most = *std::max_element(yield.value, yield.value + kLanes);
        of.yield = std::max(of.yield, std::min(of.most_yield, per_square * static_cast<double>(most)));
    }
}

}  // namespace taut
