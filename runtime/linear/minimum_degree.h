// Approximate minimum degree order of a graph's elimination (Amestoy, Davis, Duff 1996): a quotient graph, whose size
// never grows, in place of the filled one.
#pragma once

#include <span>

#include "base/memory.h"

namespace taut {

class MinimumDegree {
public:
    // weight: rows of each variable in any unit, 0 of one that takes no part; edges: from << 32 | to, each in both
    // directions, ascending and each once.
    MinimumDegree(Memory& memory, std::span<const uint8_t> weight, std::span<const uint64_t> edges);

    Array<uint32_t> order;  // variables that take part, first eliminated first

private:
    // Neighbours in pool_: of a variable first elements (eliminated variables, each the clique of what it was next to),
    // then variables that no element holds; of an element its variables.
    struct Adjacency {
        size_t begin = 0;
        uint32_t elements = 0, variables = 0;
        size_t end() const { return begin + elements + variables; }
    };

    void read(std::span<const uint64_t> edges);
    uint32_t take_least();
    void eliminate(uint32_t pivot);
    void form_element(uint32_t pivot);
    void add_to_element(uint32_t pivot, uint32_t i);
    void measure_elements(const Adjacency& element);
    void update(uint32_t pivot, uint32_t i);
    void merge_alike();
    bool alike(uint32_t i, uint32_t j) const;
    void absorb(uint32_t into, uint32_t i);
    void close_element(uint32_t pivot);
    void insert(uint32_t i);
    void remove(uint32_t i);

    bool live(uint32_t i) const { return weight_[i] > 0; }

    Array<uint32_t> pool_;
    Array<Adjacency> adjacency_;
    Array<uint32_t> weight_;                      // of a variable and all that it absorbed; 0: absorbed or eliminated
    Array<uint32_t> degree_;                      // bound on the weight next to a variable; weight of an element
    Array<uint8_t> element_;                      // whether it is an element that no other has absorbed
    Array<uint32_t> first_;                       // variable of each degree, in lists
    Array<uint32_t> next_, previous_;             // in the list of its degree
    Array<uint32_t> absorbed_, last_;             // what follows a variable in the order with it, and the last of those
    Array<uint32_t> seen_;                        // pivot that last met this variable
    Array<uint64_t> outside_;                     // stamp << 32 | weight of an element outside of the newest
    Array<uint64_t> mark_;                        // by stamp
    Array<std::pair<uint64_t, uint32_t>> alike_;  // sum over neighbours, variable
    uint64_t stamp_ = 0;
    uint32_t left_ = 0, least_ = 0;  // weight not eliminated yet; no variable has a lower degree
};

}  // namespace taut
