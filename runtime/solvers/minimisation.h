// What minimisation (minimisation.cpp) keeps: the graph of the nodes and elements of a group, island by island, and the
// numbers of one substep. A point is a node of an island's elements: one that forces move, or one that is held and
// moves as it is led, of which each island has its own.
#pragma once

#include "base/memory.h"
#include "constraints/point_penalty.h"
#include "detect/obstacles.h"
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
    uint32_t first_piece, pieces;  // in MinimisationMemory::turn
    bool damped;
};

// Of points that elements tie together and nothing holds, along a search (turning_path.h).
struct PieceTurn {
    double mass = 0;                                                              // over a [kg/s^2]
    Vec3 centre = Vec3::Zero(), velocity = Vec3::Zero(), angular = Vec3::Zero();  // of a part of 1 of the path
    Mat3 inertia = Mat3::Zero(), turned = Mat3::Identity();
};

constexpr uint32_t kMostWays = 3;  // surfaces that a point is on: as many hold it still

// Of a point: the surfaces that the last projection took it to, and how that depends on where it was.
struct PointTouch {
    Mat3 pull;                // dP/dx
    uint32_t way[kMostWays];  // in the meetings of its soft body
    uint32_t count = 0;

    bool has(uint32_t other) const { return std::find(way, way + count, other) != way + count; }
};

// Of a point within obstacles with a penalty, by where it is.
struct PointPenalty {
    double energy = 0;             // [J]
    Vec3 gradient = Vec3::Zero();  // [N]
    Mat3 matrix = Mat3::Zero();    // [N/m]
};

// A vertex of a surface, and whether it is within another soft body.
struct VertexWithin {
    uint32_t vertex, meeting;  // its node; in Obstacles::between
    uint32_t triangle;         // nearest, of the other's surface; kNone: it is outside
};

// A vertex and the triangle that it is pushed to.
struct PenaltyPair {
    uint32_t meeting;  // in Obstacles::between
    uint32_t node[4], point[4];
    PenaltyTerms terms;
};

// Of a point that surfaces hold in a Newton step.
struct PointHold {
    uint32_t point, count;
    uint32_t way[kMostWays];  // as in PointTouch
    Vec3 normal[kMostWays];   // out of each
    double push[kMostWays];   // mu >= 0 of each, in z [sqrt(J)]
    Mat3 along;               // 1 - N N^T
    Mat3 curve;               // sum mu d2phi/dx2, in z [1]
};

struct MinimisationMemory {
    explicit MinimisationMemory(Memory& m)
        : obstacles(m),
          known_node(m),
          known_element(m),
          known_tie(m),
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
          tied(m),
          piece(m),
          turn(m),
          row_begin(m),
          diagonal(m),
          column(m),
          scratch{Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m), Array<uint32_t>(m)},
          pose(m),
          begin(m),
          led(m),
          scale(m),
          pushed(m),
          wanted(m),
          bias(m),
          x(m),
          guess(m),
          slope(m),
          damped(m),
          hessian(m),
          damping(m),
          inverse(m),
          at(m),
          error(m),
          energy(m),
          frame(m),
          force(m),
          matrix(m),
          raw(m),
          soft(m),
          touch(m),
          hold_of(m),
          hold(m),
          penalty(m),
          point_of_node(m),
          within(m),
          pair(m),
          pair_matrix(m),
          factor(m),
          solution(m),
          newton(m) {}

    Obstacles obstacles;  // of the frame

    // What the graph was made of, and what there is now.
    Array<uint32_t> known_node, known_element, known_tie;
    Array<uint64_t> known_set, found_set;   // serial of each run's set, its length, whether it is damped
    Array<uint8_t> known_free, found_free;  // by seat

    Array<EnergyIsland> island;
    Array<EnergyBatch> batch;
    Array<uint32_t> element;     // in its set, in the order of islands
    Array<uint32_t> point_of;    // [element][nodes]
    Array<uint32_t> block_of;    // [element][nodes][nodes], in hessian
    Array<uint32_t> seat;        // by point
    Array<uint8_t> free;         // by point
    Array<uint32_t> tied;        // by seat: the same of all that elements tie together
    Array<uint32_t> piece;       // by point: in turn, or kNone where that is held
    Array<PieceTurn> turn;       // by piece
    Array<uint32_t> row_begin;   // by point, and one past the last
    Array<uint32_t> diagonal;    // by point: its own block
    Array<uint32_t> column;      // by block: its second point
    Array<uint32_t> scratch[5];  // of find_energy_graph()

    // by point
    Array<Pose> pose;     // at which elements are evaluated
    Array<Vec3> begin;    // x_n [m]
    Array<Vec3> led;      // of a held point, what it moves in the substep [m]
    Array<double> scale;  // s = sqrt(m/a) [sqrt(J)/m]
    Array<Vec3> pushed;   // (h - c) W p: what contacts by penalty give v' and not u [m/s]; of schemes with two
    // by point, three each: in z = s (x - x_n) [sqrt(J)]
    Array<double> wanted;  // y
    Array<double> bias;    // gradient of damping at z = 0
    Array<double> x, guess, slope;
    Array<double> damped;  // damping z
    // by block, nine each by columns, padded
    Array<double> hessian, damping;  // of z, without inertia [1]
    Array<Mat3> inverse;             // by point: of its own block with inertia, or 1 where that is not positive
    Array<double> at;                // where errors and energies are those of
    // by element
    Array<double> error;   // [kMaxRows] C, one after the other within a batch
    Array<double> energy;  // [J]
    Array<double> frame;   // of batches: what energies in lanes leave for matrices
    Array<double> force;   // [nodes][3], gradient of W [N]
    Array<double> matrix;  // of a chunk, [element][3 nodes][3 nodes] [N/m]

    // by point, where there are obstacles
    Array<double> raw;            // [3] gradient as it is before points are held back
    Array<uint32_t> soft;         // body that it is a vertex of, or kNone
    Array<PointTouch> touch;      // of the last projection
    Array<uint32_t> hold_of;      // in hold, or kNone
    Array<PointHold> hold;        // in the last Newton step
    Array<PointPenalty> penalty;  // of the last evaluation, where some obstacles have one
    // Where soft bodies meet.
    Array<uint32_t> point_of_node;  // by node, or kNone
    Array<VertexWithin> within;     // of the island that is worked on
    Array<PenaltyPair> pair;        // of the last evaluation
    Array<double> pair_matrix;      // of each, [12][12] in z [1]
    Array<SparseBlockLdlt> factor;  // by island
    Array<double> solution;         // [points][6], of that

    MinimiseScratch newton;
};

// What ties points together, from the group's elements: kept as long as these are.
void find_energy_graph(const System& system, const Nodes& nodes, const Group& group, MinimisationMemory& memory);

}  // namespace taut
