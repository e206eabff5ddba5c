// What the direct solve of a mechanism costs, by the symbolic factor of its matrix: known before it is a block, and
// kept while its graph stays.
#include <algorithm>
#include <limits>
#include <utility>

#include "linear/sparse_block_ldlt.h"
#include "partition/movers.h"
#include "partition/partition.h"

namespace taut {
namespace {

// Times what sweeps cost, a direct solve may cost without need: it is exact. Chosen between a chain of hinges with
// stops and friction, 2.6, and a ragdoll, 3.3; a bridge on ropes, 3.6, is beyond it.
constexpr double kWorth = 3;
// Times what sweeps cost, it may cost at need or by the user's word: as much as sweeps of so many times the substeps,
// with which they give way by 1/256.
constexpr double kMostCost = 16;

// Bits that depend on all of a number's (the finaliser of splitmix64).
uint64_t mixed(uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

int locked_rows(const Joint& joint) {
    int count = 0;
    for (int r = 0; r < joint.type->rows; ++r) count += joint.plain || joint.axis[r].mode == AxisMode::locked;
    return count;
}

// Unknowns and links of a mechanism's matrix, as BlockSolve has them but for contacts.
class Mechanism {
public:
    explicit Mechanism(Memory& memory)
        : unknown_(memory), end_(memory), couple_(memory), supports_(memory), matrix_(memory) {}

    uint32_t add_node(bool turns) {
        unknown_.push_back({static_cast<uint8_t>(turns ? 6 : 3), false});
        return static_cast<uint32_t>(unknown_.size()) - 1;
    }
    // After all nodes. number: of nodes, by slot.
    void add_tie(const ConstraintType& type, std::span<const uint32_t> ends, const Array<uint32_t>& number, int held,
                 int rows, bool couples) {
        const auto tie = static_cast<uint32_t>(unknown_.size());
        unknown_.push_back({static_cast<uint8_t>(held > 3 ? 6 : 3), true, static_cast<uint8_t>(rows)});
        int moving = 0;
        for (size_t n = 0; n < ends.size(); ++n) {
            if (ends[n] == kNone) continue;
            ++moving;
            end_.push_back(pair_key(number[ends[n]], tie));
            for (size_t m = 0; m < n && couples; ++m)
                if (ends[m] != kNone && ends[m] != ends[n])
                    couple_.push_back(pair_key(number[ends[m]], number[ends[n]]));
        }
        if (moving < type.nodes) supports_.push_back(tie);
    }
    // Multiplications of a factor; infinite where they are more than so many.
    double cost(double most) {
        matrix_.begin(static_cast<uint32_t>(unknown_.size()));
        for (uint32_t i = 0; i < unknown_.size(); ++i)
            matrix_.set_unknown(i, unknown_[i].size, unknown_[i].multiplier, unknown_[i].rows);
        for (const Array<uint64_t>* links : {&end_, &couple_})
            for (const uint64_t link : *links)
                matrix_.link(static_cast<uint32_t>(link >> 32), static_cast<uint32_t>(link));
        return matrix_.cost(most);
    }
    // Ties between what it hangs by and the node furthest from there; 0 where it hangs by nothing.
    uint32_t depth() const {
        const auto neighbours = neighbours_of_all();
        Array<uint8_t> seen(unknown_.size(), 0, end_.get_allocator());
        Array<uint32_t> front(supports_), next(front.get_allocator());
        uint32_t ties = 0;
        for (; !front.empty(); front.swap(next), ties += !front.empty()) {
            next.clear();
            for (const uint32_t i : front)
                for (auto at = std::ranges::lower_bound(neighbours, uint64_t{i} << 32);
                     at != neighbours.end() && *at >> 32 == i; ++at)
                    if (const auto j = static_cast<uint32_t>(*at); !std::exchange(seen[j], uint8_t{1}))
                        next.push_back(j);
        }
        return (ties + 1) / 2;
    }

private:
    // Unknown << 32 | one that it is linked to, ascending.
    Array<uint64_t> neighbours_of_all() const {
        Array<uint64_t> out(end_);
        for (const uint64_t link : end_) out.push_back(link << 32 | link >> 32);
        std::ranges::sort(out);
        return out;
    }

    Array<Unknown> unknown_;
    Array<uint64_t> end_, couple_;  // a tie and a node of it, two nodes of a tie: smaller << 32 | larger
    Array<uint32_t> supports_;      // ties with an end that does not move
    SparseBlockLdlt matrix_;
};

}  // namespace

// Of each mechanism what tells its graph from all others: of its nodes and ties, in any order.
void Partition::mark_graphs(const Nodes& nodes, const Joints& joints, const Elements& elements) {
    for (const uint32_t node : graph_.movers)
        component_[find(node)].graph += mixed(static_cast<uint64_t>(node) << 32 | nodes.ids.generation(node));
    for (size_t j = 0; j < joints.record.size(); ++j) {
        const uint32_t end = mover(nodes, graph_.ties[j]);
        if (end != kNone && joints.record[j].solve != JointSolve::swept)
            component_[find(end)].graph += mixed(joints.record[j].mark());
    }
    for (uint32_t e = 0; e < element_.size(); ++e) {
        const ElementSet& set = elements.set[element_[e].set];
        const uint32_t end = mover(nodes, movers_of(e));
        if (end != kNone && set.solve != JointSolve::swept)
            component_[find(end)].graph += mixed(set.serial << 32 | element_[e].element);
    }
}

// Into Component::price. A direct solve with bounded rows factors anew as these come and go: in proportion to how many
// each tie has.
void Partition::find_prices(const Nodes& nodes, const Joints& joints, const Elements& elements) {
    mark_graphs(nodes, joints, elements);
    known_prices_.swap(prices_);
    prices_.clear();
    bool complete = true;
    for (const uint32_t root : graph_.movers) {
        Component& c = component_[root];
        if (parent_[root] != root || c.ties == 0) continue;
        const auto known = std::ranges::lower_bound(known_prices_, c.graph, {}, &Price::graph);
        c.priced = known != known_prices_.end() && known->graph == c.graph;
        if (c.priced)
            c.price = *known;
        else
            complete = false;
    }
    if (!complete) price_new(nodes, joints, elements);
    for (const uint32_t root : graph_.movers) {
        Component& c = component_[root];
        if (parent_[root] != root || c.ties == 0) continue;
        prices_.push_back(c.price);
        c.cost = c.price.flops / c.sweep * (c.ties + c.bounded) / c.ties;
        c.exact = c.cost <= kWorth;
        c.dear = c.price.flops > kMostCost * c.sweep;
    }
    std::ranges::sort(prices_, {}, &Price::graph);
}

// Nodes and ties of those that have no price yet, mechanism by mechanism.
void Partition::price_new(const Nodes& nodes, const Joints& joints, const Elements& elements) {
    Memory& memory = *prices_.get_allocator().memory;
    struct Piece {
        uint32_t root, kind, index;  // kind: node, joint, element
        auto operator<=>(const Piece&) const = default;
    };
    Array<Piece> pieces(memory);
    const auto add = [&](uint32_t end, uint32_t kind, uint32_t index) {
        if (end == kNone) return;
        const uint32_t root = find(end);
        if (component_[root].ties > 0 && !component_[root].priced) pieces.push_back({root, kind, index});
    };
    for (const uint32_t node : graph_.movers) add(node, 0, node);
    for (uint32_t j = 0; j < joints.record.size(); ++j)
        if (joints.record[j].solve != JointSolve::swept) add(mover(nodes, graph_.ties[j]), 1, j);
    for (uint32_t e = 0; e < element_.size(); ++e) {
        const ElementSet& set = elements.set[element_[e].set];
        if (set.solve != JointSolve::swept && multiplies(set)) add(mover(nodes, movers_of(e)), 2, e);
    }
    std::ranges::sort(pieces);
    Array<uint32_t> number(graph_.moves.size(), kNone, memory);
    for (auto piece = pieces.begin(); piece != pieces.end();) {
        const uint32_t root = piece->root;
        Mechanism mechanism(memory);
        for (; piece != pieces.end() && piece->root == root; ++piece) {
            if (piece->kind == 0) {
                number[piece->index] = mechanism.add_node(nodes.info[piece->index].kind != NodeKind::particle);
            } else if (piece->kind == 1) {
                const Joint& joint = joints.record[piece->index];
                mechanism.add_tie(*joint.type, graph_.ties[piece->index], number, joint.held(), locked_rows(joint),
                                  joint.type->couples_nodes || !joint.plain);
            } else {
                const ConstraintType& type = elements.set[element_[piece->index].set].type->row;
                mechanism.add_tie(type, movers_of(piece->index), number, type.rows, type.rows, true);
            }
        }
        Component& c = component_[root];
        c.price = {c.graph, mechanism.cost(kMostCost * c.sweep), mechanism.depth()};
    }
}

}  // namespace taut
