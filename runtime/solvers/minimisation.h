// What minimisation (minimisation.cpp) keeps: the graph of the nodes and elements of a group, island by island, and the
// numbers of one substep. A point is a node of an island's elements: one that forces move, or one that is held and
// moves as it is led, of which each island has its own.
#pragma once

#include "base/memory.h"
#include "linear/sparse_block_ldlt.h"
#include "solvers/minimise.h"
#include "system/system.h"

namespace taut {

struct Group;

// Of taut_world_relax, while it works.
struct Relaxation {
    double tolerance;       // of an island, root mean square over its masses [m/s^2]
    uint32_t most_steps;    // of an island
    uint32_t steps = 0;     // of all
    double residual = 0;    // largest of an island [m/s^2]
    bool converged = true;  // all of them
};

struct MinimisationSettings {
    double tolerance = 1e-6;           // root mean square of a way within a substep [m]
    bool line_search = true;           // else each step as it comes
    Relaxation* relaxation = nullptr;  // statics in place of a substep, and what comes of it
};

constexpr uint32_t kEnergyBatch = kDoubles;  // elements evaluated together, at most

// Of one set.
struct EnergyBatch {
    ElementSet* set;
    uint32_t run;           // in Rows::elastic
    uint32_t first, count;  // of elements, in the order of islands
    uint32_t node;          // first in point_of
    uint32_t block;         // first in block_of
    uint32_t frame;         // in units of kFrameNumbers, of sets whose energy comes in lanes
};

struct EnergyIsland {
    uint32_t first_point, points;
    uint32_t first_batch, batches;
    bool damped;
};

struct MinimisationMemory {
    explicit MinimisationMemory(Memory& m)
        : known_node(m),
          known_element(m),
          known_set(m),
          found_set(m),
          known_free(m),
          found_free(m),
          island(m),
          batch(m),
          element(m),
          point_of(m),
          block_of(m),
          seat(m),
          free(m),
          row_begin(m),
          column(m),
          scratch{Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m)},
          pose(m),
          begin(m),
          led(m),
          scale(m),
          wanted(m),
          bias(m),
          x(m),
          guess(m),
          slope(m),
          damped(m),
          hessian(m),
          damping(m),
          at(m),
          error(m),
          energy(m),
          frame(m),
          force(m),
          matrix(m),
          factor(m),
          solution(m),
          newton(m) {}

    // What the graph was made of, and what there is now.
    Array<uint32_t> known_node, known_element;
    Array<uint64_t> known_set, found_set;   // serial of each run's set, its length, whether it is damped
    Array<uint8_t> known_free, found_free;  // by seat

    Array<EnergyIsland> island;
    Array<EnergyBatch> batch;
    Array<uint32_t> element;     // in its set, in the order of islands
    Array<uint32_t> point_of;    // [element][nodes]
    Array<uint32_t> block_of;    // [element][nodes][nodes], in hessian
    Array<uint32_t> seat;        // by point
    Array<uint8_t> free;         // by point
    Array<uint32_t> row_begin;   // by point, and one past the last
    Array<uint32_t> column;      // by block: its second point
    Array<uint32_t> scratch[5];  // of find_energy_graph()

    // by point
    Array<Pose> pose;     // at which elements are evaluated
    Array<Vec3> begin;    // x_n [m]
    Array<Vec3> led;      // of a held point, what it moves in the substep [m]
    Array<double> scale;  // s = sqrt(m/a) [sqrt(J)/m]
    // by point, three each: in z = s (x - x_n) [sqrt(J)]
    Array<double> wanted;  // y
    Array<double> bias;    // gradient of damping at z = 0
    Array<double> x, guess, slope;
    Array<double> damped;  // damping z
    // by block, nine each by columns, padded
    Array<double> hessian, damping;  // of z, without inertia [1]
    Array<double> at;                // where errors and energies are those of
    // by element
    Array<double> error;   // [kMaxRows] C, one after the other within a batch
    Array<double> energy;  // [J]
    Array<double> frame;   // of batches: what energies in lanes leave for matrices
    Array<double> force;   // [nodes][3], gradient of W [N]
    Array<double> matrix;  // of a chunk, [element][3 nodes][3 nodes] [N/m]

    Array<SparseBlockLdlt> factor;  // by island
    Array<double> solution;         // [points][6], of that

    MinimiseScratch newton;
};

// What ties points together, from the group's elements: kept as long as these are.
void find_energy_graph(const System& system, const Nodes& nodes, const Group& group, MinimisationMemory& memory);

}  // namespace taut
