#include "partition/partition.h"

#include <algorithm>

namespace taut {

Partition::Partition(Memory& memory)
    : groups(memory),
      blocks(memory),
      graph_(memory),
      walls_(memory),
      parent_(memory),
      island_of_(memory),
      level_(memory),
      island_(memory),
      component_(memory),
      prices_(memory),
      known_prices_(memory),
      core_(memory),
      pair_in_block_(memory),
      joint_in_block_(memory),
      element_(memory),
      element_begin_(memory),
      element_node_(memory),
      held_(memory),
      element_colour_(memory),
      element_pass_(memory),
      incidence_(memory),
      element_in_block_(memory),
      block_of_(memory),
      spare_(memory),
      pair_colour_(memory),
      joint_colour_(memory),
      grain_colour_(memory),
      surface_colour_(memory),
      surface_in_block_(memory),
      used_(memory),
      place_(memory),
      items_(memory),
      rank_(memory),
      rank_begin_(memory),
      strain_(memory),
      grain_strain_(memory),
      efforts_(memory),
      presses_(memory),
      squeezes_(memory),
      small_(memory),
      pressed_(memory),
      tied_(memory),
      queue_(memory),
      weak_(memory),
      standing_(memory),
      adjacent_(memory),
      adjacency_(memory) {}

uint32_t Partition::find(uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
}

void Partition::unite(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
}

void Partition::unite(std::span<const uint32_t> all) {
    uint32_t first = kNone;
    for (uint32_t node : all) {
        if (node == kNone) continue;
        if (first != kNone) unite(first, node);
        first = node;
    }
}

void Partition::build(Team& team, const Nodes& nodes, const Joints& joints, const Elements& elements, Pairs& pairs,
                      const PartitionRules& rules) {
    static constexpr Part kOfFrame[] = {&Partition::find_places, &Partition::weigh};
    // In this order two threads have as much to do.
    static constexpr Part kOfGraph[] = {&Partition::find_levels, &Partition::find_places, &Partition::unite_touching,
                                        &Partition::colour_touches, &Partition::weigh};
    try {
        if (graph_.update(team, nodes, joints, elements, pairs)) {
            make_room();
            list_elements(elements);
            note_ties();
            run(team, kOfGraph, nodes);
            unite_grains(pairs.grains);
            colour_grains(pairs.grains);
            unite_surfaces(pairs.surfaces);
            colour_surfaces(pairs.surfaces);
            colour_elements();
            colour_fused(elements);
            number_islands();
            list_small();
        } else {
            run(team, kOfFrame, nodes);
        }
    } catch (...) {  // out of memory: what follows from the graph may not be there
        graph_.forget();
        throw;
    }
    folds_ = rules.folds;
    lanes_ = rules.lanes;
    soften_squeezed(nodes, pairs, rules);
    find_loads(nodes);
    find_columns(nodes, pairs, rules);
    for (Island& island : island_) island.tower = false;
    if (rules.direct) {
        find_towers(rules);
        find_pressed(nodes, pairs, rules);
    }
    const bool any = std::any_of(island_.begin(), island_.end(), [](const Island& i) { return i.tower || i.jointed; });
    if (rules.direct && (any || !presses_.empty()))
        build_blocks(nodes, joints, elements, pairs, rules);
    else
        forget_blocks(joints, pairs);
    find_strains(elements);
    find_passages(nodes, pairs.surfaces, rules);
    find_grain_strains(pairs.grains);
    choose_substeps(rules);
    colour_joints();
    colour_pairs(pairs);
    distribute(pairs, rules.by_place);
}

void Partition::run(Team& team, std::span<const Part> parts, const Nodes& nodes) {
    constexpr uint32_t kFewMovers = 128;  // that are through before anybody could help
    const auto count = static_cast<uint32_t>(parts.size());
    team.for_ranges(count, graph_.movers.size() < kFewMovers ? count : 1, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) (this->*parts[i])(nodes);
    });
}

// For the parts, which run in loops that may not allocate.
void Partition::make_room() {
    const auto fit = [](auto& array, size_t size) {
        array.clear();
        reserve_more(array, size);
        array.resize(size);
    };
    const size_t touches = graph_.touches.size();
    for (auto* by_slot : {&parent_, &level_, &island_of_}) clear_movers(*by_slot);
    clear_movers(place_);
    clear_movers(tied_);
    clear_movers(used_);
    clear_movers(adjacent_);
    fit(queue_, graph_.movers.size());
    fit(adjacency_, 2 * touches);
    fit(pair_colour_, touches);
    fit(pressed_, touches);
    fit(small_, touches);
}

void Partition::note_ties() {
    for (const TouchGraph::Tie& tie : graph_.ties)
        for (const uint32_t node : tie)
            if (node != kNone) tied_[node] = 1;
    for (const uint32_t node : element_node_)
        if (node != kNone) tied_[node] = 1;
}

void Partition::list_elements(const Elements& elements) {
    element_.clear();
    element_node_.clear();
    element_begin_.assign(1, 0);
    held_.clear();
    for (uint32_t s = 0; s < elements.set.size(); ++s) {
        const ElementSet& set = elements.set[s];
        for (uint32_t e = 0; set.type && e < set.size(); ++e) {
            const auto nodes = set.nodes_of(e);
            const auto moves = [&](uint32_t node) { return graph_.mover(node) != kNone; };
            if (std::ranges::none_of(nodes, moves)) continue;
            element_.push_back({s, e});
            for (const uint32_t node : nodes) {
                element_node_.push_back(graph_.mover(node));
                if (node != kNone && graph_.mover(node) == kNone) held_.push_back(node);
            }
            element_begin_.push_back(static_cast<uint32_t>(element_node_.size()));
        }
    }
    incidence_.build(graph_.movers, element_begin_, element_node_);
}

// Union-find over all that ties and touches.
void Partition::unite_touching(const Nodes&) {
    for (const uint32_t node : graph_.movers) parent_[node] = node;
    for (const TouchGraph::Tie& tie : graph_.ties) unite(tie);
    for (uint32_t e = 0; e < element_.size(); ++e) unite(movers_of(e));
    for (const TouchGraph::Tie& span : graph_.spans) unite(span);
    for (const auto& [a, b] : graph_.touches)
        if (a != kNone && b != kNone) unite(a, b);
}

void Partition::unite_grains(const Grains& grains) {
    for (const GrainContact& contact : grains.contact) {
        const uint32_t a = graph_.mover(contact.a), b = graph_.mover(contact.b);
        if (a != kNone && b != kNone) unite(a, b);
    }
}

// The nodes of a contact that forces move; kNone in place of all others.
TouchGraph::Tie Partition::movers_of(const SurfaceContact& contact) const {
    TouchGraph::Tie ends;
    for (size_t n = 0; n < ends.size(); ++n) ends[n] = graph_.mover(contact.node[n]);
    return ends;
}

void Partition::unite_surfaces(const SurfaceContacts& surfaces) {
    for (const SurfaceContact& contact : surfaces.contact) unite(movers_of(contact));
}

void Partition::number_islands() {
    if (island_.capacity() > 4 * island_.size()) let_go(island_);  // of a time when fewer touched
    island_.clear();
    for (const uint32_t node : graph_.movers) {  // roots are smallest, so each is met before its members
        const uint32_t root = find(node);
        if (root == node) {
            island_of_[node] = static_cast<uint32_t>(island_.size());
            island_.emplace_back();
        }
        Island& island = island_[island_of_[node] = island_of_[root]];
        ++island.nodes;
        island.levels = std::max(island.levels, level_[node]);
    }
    islands = static_cast<uint32_t>(island_.size());
    for (const TouchGraph::Tie& tie : graph_.ties)
        for (const uint32_t node : tie)
            if (node != kNone) island_[island_of_[node]].jointed = true;
    for (const uint32_t node : element_node_)
        if (node != kNone) island_[island_of_[node]].jointed = true;
}

// The touches of islands that a block may hold.
void Partition::list_small() {
    small_.clear();
    const auto is_small = [](const Island& island) { return island.nodes > 1 && island.nodes <= kMostTower; };
    if (std::none_of(island_.begin(), island_.end(), is_small)) return;
    for (const uint32_t node : graph_.movers) {
        if (!is_small(island_[island_of_[node]])) continue;
        for (const uint32_t p : touches_of(node)) {
            const uint32_t other = graph_.touches[p].other(node);
            if (other == kNone || node < other) small_.push_back(p);
        }
    }
}

void Partition::forget_frame(uint32_t nodes) {
    graph_.forget();
    group_count = 0;
    block_of_.assign(nodes, kNone);
    mark_blocks();
}

void Partition::forget_blocks(const Joints& joints, const Pairs& pairs) {
    unmark(blocks);
    blocks.clear();
    pair_in_block_.assign(graph_.touches.size(), 0);
    joint_in_block_.assign(joints.record.size(), 0);
    element_in_block_.assign(element_.size(), 0);
    surface_in_block_.assign(pairs.surfaces.contact.size(), 0);
}

}  // namespace taut
