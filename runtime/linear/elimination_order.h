// Order in which a block matrix is factored, and which blocks each elimination touches.
#pragma once

#include <limits>
#include <span>

#include "linear/dissection.h"

namespace taut {

// One unknown of the matrix: a node (6 or 3 freedoms) or the multiplier of a joint's rows.
struct Unknown {
    uint8_t size = 6;  // 3 or 6
    bool multiplier = false;
    uint8_t rows = 6;  // of a multiplier, without padding
};

// Multiplications of the elimination of an unknown of s numbers from a matrix with r others in its column: s r^2 / 2
// for what is left of the matrix, s^2 r / 2 and s^3 / 6 for its own column and pivot.
inline double elimination_cost(double s, double r) { return s * r * (r + s) / 2 + s * s * s / 6; }

// One rule: a multiplier comes only after a node with freedoms left that no other multiplier claimed (a rigid body has
// five: two ball joints on one body fix their distance twice), or after all its nodes. Under it, nodes alone and meshes
// (more couplings of particles than multipliers) go by approximate minimum degree of nodes; trees and single loops of
// joints by greedy minimum degree, which is leaf to root without fill on a tree; nets of joints by nested dissection.
class EliminationOrder {
public:
    // links: pairs of unknowns, smaller << 32 | larger. The search for an order ends where it comes to more than so
    // many multiplications.
    EliminationOrder(Memory& memory, std::span<const Unknown> unknowns, std::span<const uint64_t> links,
                     double most = std::numeric_limits<double>::infinity());

    Array<uint32_t> order;  // unknowns, first eliminated first
    bool is_found() const { return cost_ <= most_; }

private:
    void read_links(std::span<const uint64_t> links);
    void tie_nodes();
    void take(uint32_t i);
    void eliminate(uint32_t i);
    bool ready(uint32_t i) const;
    uint32_t node_to_claim(uint32_t multiplier) const;  // or the number of unknowns
    int need(uint32_t multiplier, uint32_t node) const;
    bool linked(uint32_t i, uint32_t j) const;
    uint64_t key(uint32_t i) const;
    bool meshed() const;
    void run_by_nodes();
    void run_greedily();
    void dissect();
    void cut_at_nodes(const Dissection& halves);
    void cut_at_multipliers(const Dissection& halves);

    std::span<const Unknown> unknowns_;
    Array<Array<uint32_t>> graph_;    // as elimination leaves it
    Array<Array<uint32_t>> ends_;     // nodes of a multiplier
    Array<uint8_t> done_, freedoms_;  // freedoms of a node that no multiplier claimed yet
    Array<uint64_t> ties_;            // from << 32 | to of nodes, each in both directions, ascending
    size_t couplings_ = 0, multipliers_ = 0;
    double cost_ = 0, most_;               // of what was eliminated greedily, and its bound
    Array<uint32_t> neighbours_, merged_;  // of the last one eliminated; space
};

}  // namespace taut
