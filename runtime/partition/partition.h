// Who is solved with whom: islands, groups of islands with the same substep count, blocks, colours.
//
//   island  nodes connected by joints or touching pairs; independent of every other island during a frame, but for the
//           length of the substeps that it shares with its group
//   block   nodes connected by joints, with the bodies that touch them, or a tower: solved directly, contacts included;
//           its elimination order is kept while its graph stays
//   group   all islands that take the same number of substeps and sweeps; solved together; those that whip apart
//   colour  constraints of a group of which no two share a moving node; within, by place: so that threads that take a
//           part each of every colour meet at few nodes
#pragma once

#include <span>

#include "linear/sparse_block_ldlt.h"
#include "partition/incidence.h"
#include "partition/touch_graph.h"
#include "partition/walls.h"

namespace taut {

// Kept by the direct solve of a block while its joint graph stays.
struct BlockMemory {
    double excess_energy = 0;        // decaying sum of energy that no force explains [J]
    uint32_t solved = 0;             // substeps
    uint32_t guard_left = 0;         // substeps for which no slow velocity is spared
    uint32_t since_trip = 1u << 30;  // substeps since the guard last tripped
    bool escalated = false;          // tripped twice in a short time, of unequal masses: more substeps
    uint8_t whips_left = 0;          // frames for which its island is apart from those that need no shorter substeps
    uint8_t hit_left = 0;            // frames for which it takes in its contacts after a hit
};
template <class Visitor, Like<BlockMemory> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [excess_energy, solved, guard_left, since_trip, escalated, whips_left, hit_left] = of;
    TAUT_FIELDS(visitor, excess_energy, solved, guard_left, since_trip, escalated, whips_left, hit_left);
}

// What holds a node of a block beside contacts: nothing, elements and ties to other nodes of it that move freely as a
// whole, or such that are tied to what the block does not solve for.
enum class NodeHold : uint8_t { loose, free, anchored };

// What hangs together freely.
struct FreePart {
    double mass = 0;              // [kg]
    Vec3 impulse = Vec3::Zero();  // that its nodes miss [N s]
};

// What a row says of three freedoms of a node: its velocity or its angular velocity.
struct RowTouch {
    uint32_t at;  // in ContactSplitMemory::velocity
    Vec3 j, g;    // s J, R^-1 J^T s
};

// Scratch of solvers/contact_split.h, of the nodes that bounded rows touch.
struct ContactSplitMemory {
    explicit ContactSplitMemory(Memory& m)
        : slot(m),
          node(m),
          load(m),
          metric(m),
          inverse(m),
          velocity(m),
          stiffness(m),
          touch(m),
          begin(m),
          row(m),
          listed(m),
          free(m) {}

    Array<uint32_t> slot, node;     // of each node of the block its place among them, or kNone; and back
    Array<double> load;             // of those split what they bear by contacts, themselves included [kg]
    Array<double> metric, inverse;  // R and R^-1, 36 numbers each
    Array<double> velocity;         // z
    Array<double> stiffness;        // J R^-1 J^T + c of rows
    Array<RowTouch> touch;          // of rows, those of row i from begin[i] to begin[i + 1]
    Array<uint32_t> begin;
    Array<uint32_t> row;    // those that sweeps take, in the block's bounded rows, ascending
    Array<uint8_t> listed;  // of each row: whether it is among them
    Array<FreePart> free;   // see Block::part
    bool built = false;     // touches and stiffnesses are of the present factor
};

// What a direct solve takes together, with what it remembers over frames.
struct Block {
    explicit Block(Memory& m)
        : nodes(m),
          joints(m),
          elements(m),
          elastic(m),
          pairs(m),
          surfaces(m),
          links(m),
          identity(m),
          order(m),
          matrix(m),
          places(m),
          solution(m),
          known(m),
          force(m),
          elastic_force(m),
          gases(m),
          gas_response(m),
          split(m),
          part(m),
          hold(m) {}

    Array<uint32_t> nodes;                 // moved by forces, ascending
    Array<uint32_t> joints;                // ascending
    Array<ElementRef> elements;            // ascending, those with multipliers
    Array<ElementRef> elastic;             // ascending, all others; see solvers/block_elastic.cpp
    Array<uint32_t> pairs;                 // in Pairs::active, of this frame
    Array<uint32_t> surfaces;              // in SurfaceContacts::contact, of this frame
    Array<uint64_t> links;                 // pairs of its nodes that touch: smaller << 32 | larger
    Array<uint64_t> identity;              // of joints, nodes and links: the graph of the matrix
    Array<uint32_t> order;                 // of elimination, from the first solve on, which knows what gives; or empty
    SparseBlockLdlt matrix;                // unknowns: nodes, then joints; made by the next solve where it is gone
    Array<BlockPlace> places;              // of its nodes and ties in the matrix; see solvers/block_matrix.cpp
    uint32_t stride = 0;                   // of these, from tie to tie
    Array<double> solution, known, force;  // scratch of its solve
    Array<double> elastic_force;           // likewise
    Array<uint32_t> gases;                 // that it has nodes of, in System::gases, of this substep
    Array<double> gas_response;            // scratch of its solve; see solvers/block_gas.cpp
    ContactSplitMemory split;              // likewise
    Array<uint32_t> part;       // of each node that which hangs together freely with it, or kNone; with `places`
    Array<NodeHold> hold;       // of each node; likewise
    bool foresees = false;      // folded elements are evaluated where their nodes are going
    bool relinearised = false;  // all are, where the line search came to; see solvers/block_search.cpp
    uint32_t first_elastic_run = 0, elastic_runs = 0;  // of its elastic elements in System::rows, of this frame
    bool tower = false;                                // no ties: bodies that stand on each other or are pressed
    bool looped = false;                               // more joints than a tree
    bool passing = false;          // direct while a load lasts that sweeps hold as well: it may turn far
    bool failed = false;           // this substep's matrix could not be factored
    bool corrected = false;        // this substep's positions get a correction
    double mass_ratio = 1;         // heaviest over lightest node
    double closing = 1;            // part of its joints' gaps that this substep closes
    uint32_t first_row_block = 0;  // its ties' rows in System::rows, of this frame
    uint32_t first_contact = 0, contact_count = 0;  // its contacts' rows, of this substep
    uint32_t first_bounded = 0, bounded_count = 0;  // its bounded rows in SolverScratch, of this substep
    float turn = 0;                                 // of its joints' levers and lines in this substep, at most [rad]

    // What its direct solve keeps over substeps; see solvers/block_ldlt.cpp.
    BlockMemory memory;
};
template <class Visitor, Like<Block> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [nodes, joints, elements, elastic, pairs, surfaces, links, identity, order, matrix, places, stride, solution,
           known, force, elastic_force, gases, gas_response, split, part, hold, foresees, relinearised,
           first_elastic_run, elastic_runs, tower, looped, passing, failed, corrected, mass_ratio, closing,
           first_row_block, first_contact, contact_count, first_bounded, bounded_count, turn, memory] = of;
    TAUT_FIELDS(visitor, nodes, order, tower, looped, memory);
    TAUT_ASIDE(visitor, identity);  // all others are made by each frame, or from these by the next solve
}

// Elements of one stage and colour.
struct FusedPass {
    uint32_t begin, end;  // in Group::fused
    bool overflow;        // they share moving nodes
};

struct Group {
    explicit Group(Memory& memory)
        : nodes(memory),
          pairs(memory),
          pair_colour_begin(memory),
          pair_place(memory),
          grains(memory),
          grain_colour_begin(memory),
          surfaces(memory),
          surface_colour_begin(memory),
          joints(memory),
          joint_colour_begin(memory),
          elements(memory),
          element_colour_begin(memory),
          fused(memory),
          fused_pass(memory),
          blocks(memory),
          direct_pairs(memory),
          direct_surfaces(memory),
          span_pairs(memory) {}

    uint32_t substeps = 0;
    uint32_t sweeps = 1;    // least biased sweeps a substep
    Array<uint32_t> nodes;  // moved by forces, in the order of PartitionRules
    // Swept constraints by colour; the last colour holds what found no other and is solved one by one, in order of
    // index. The others: pairs with the most points first, then by place.
    Array<uint32_t> pairs, pair_colour_begin;        // index into Pairs::active
    Array<uint8_t> pair_place;                       // of each of pairs, below kSlices
    Array<uint32_t> grains, grain_colour_begin;      // index into Grains::contact; with colours of their own
    Array<uint32_t> surfaces, surface_colour_begin;  // index into SurfaceContacts::contact; likewise
    Array<uint32_t> joints, joint_colour_begin;
    Array<ElementRef> elements;  // with colours of their own
    Array<uint32_t> element_colour_begin;
    Array<ElementRef> fused;  // swept elements of sets with a fused sweep, by stage, colour and set
    Array<FusedPass> fused_pass;
    Array<uint32_t> blocks;           // index into Partition::blocks
    Array<uint32_t> direct_pairs;     // of its blocks, in Pairs::active
    Array<uint32_t> direct_surfaces;  // of its blocks, in SurfaceContacts::contact
    Array<uint32_t> span_pairs;       // swept ones with a side of two nodes, which lanes do not take
};

// Once a frame: which joints carry more than contacts on their bodies could stand in sweeps. A block takes its contacts
// in while one of its joints has done so for three frames, and for a second after.
void note_loads(Joints& joints, Elements& elements, const Nodes& nodes);
constexpr uint8_t kLoadedAfter = 3, kLoadedFor = 60;  // frames

constexpr uint32_t kMostElasticSubsteps = 64;  // a frame, for fused sweeps of elements
constexpr uint32_t kMaxColours = 64;           // the last is the overflow colour
constexpr float kHeavyOnLight = 10;            // load over support mass, from which on a load is heavy
constexpr uint32_t kMostTower = 60;  // bodies of an island that is solved directly, or what a heavy one of it presses
constexpr uint32_t kSlices = 64;     // along the line on which the moving nodes are spread widest

struct PartitionRules {
    uint32_t substeps;  // least
    bool fixed;         // no more than the least
    bool direct;        // joints form blocks that take in their contacts, and towers are blocks; else all is swept
    double time_step;   // of a frame [s]
    Vec3 gravity;       // [m/s^2]
    bool by_place;      // nodes of a group by place, for threads that take a stretch each; else ascending
    bool lanes = true;  // sets with a fused sweep have one
    bool folds = true;  // blocks take elements of other forms than rows as such; else all have rows
    double spring_substep = time_step / substeps;  // for which contacts are as soft as they are; World::spring_substep
};

// Why an island has rows that are solved directly, as bits; what something kinematic squeezes has none for its loads.
enum Reason : uint8_t { kByJoint = 1, kByLoad = 2, kByHit = 4, kByTower = 8, kByPress = 16, kSqueezed = 32 };

class Partition {
public:
    explicit Partition(Memory& memory);

    // Rebuilds islands, groups and colours from the joints and touching pairs of this frame; what follows from the
    // graph of touches alone is kept while that stays.
    void build(Team& team, const Nodes& nodes, const Joints& joints, const Elements& elements, Pairs& pairs,
               const PartitionRules& rules);

    // Of a node, in this frame; kNone where forces do not move it.
    uint32_t island_of(uint32_t node) const { return graph_.mover(node) == kNone ? kNone : island_of_[node]; }
    // Likewise of the last frame, whatever came to the world or left it since.
    uint32_t last_island_of(uint32_t node) const {
        return node < graph_.moves.size() && node < island_of_.size() ? island_of(node) : kNone;
    }
    // Within a frame, after the contacts of surfaces of a group without blocks were found anew: successor: of each
    // before its index now.
    void renew_surfaces(uint32_t group, const SurfaceContacts& surfaces, std::span<const uint32_t> successor);
    uint32_t group_of(uint32_t node) const { return island_[island_of_[node]].group; }  // of one that forces move
    // Elements on something that moves, in the order of incidence(); valid after build().
    std::span<const ElementRef> elements() const { return element_; }
    // Nodes of these that do not move, some of them more than once; likewise.
    std::span<const uint32_t> held() const { return held_; }
    const Incidence& incidence() const { return incidence_; }
    // By island, after build().
    void find_reasons(const Joints& joints, const Elements& elements, Array<uint8_t>& out) const;

    Array<Group> groups;  // in ascending order of effort; the first group_count are used
    uint32_t group_count = 0;
    Array<Block> blocks;
    uint32_t islands = 0;
    uint32_t colours = 0;  // most of any group

    // All others are found by each frame.
    template <class Visitor, Like<Partition> Of>
    friend void describe(Visitor& visitor, Of& of) {
        TAUT_FIELDS(visitor, of.blocks, of.softened_);
    }
    // After a restoration: what was found before does not hold. Throws std::bad_alloc before anything changes where
    // there is no room for so many nodes.
    void reserve_nodes(size_t nodes) { block_of_.reserve(nodes); }
    void forget_frame(uint32_t nodes);

private:
    struct Island {
        // Of the graph.
        uint32_t nodes = 0, levels = 0;
        bool jointed = false;
        // Of the frame.
        uint32_t substeps = 0, sweeps = 1, group = 0;
        float ratio = 1;      // heaviest load over its support, where any is kHeavyOnLight
        float stiffness = 1;  // that contacts need to hold its columns, in parts of what the world's substeps give
        bool rises = false;   // high enough for some body in the world to buckle
        bool may_be_column = false;  // one as a whole, which a block may hold
        bool weak = false;           // has bodies in weak_
        bool squeezed = false;       // by something kinematic, harder than sweeps hold
        bool tower = false, whips = false;

        uint32_t effort() const { return substeps << 8 | (whips ? 128u : 0u) | sweeps; }
    };

    struct Price {           // of a direct solve of a mechanism, and what sweeps would make of it
        uint64_t graph = 0;  // Component::graph
        double flops = 0;    // multiplications of its factor; infinite where they are more than matters
        uint32_t depth = 0;  // ties between the node furthest from there and what it hangs by
    };

    struct Component {  // of the graph of blocks, by root
        uint32_t nodes = 1, ties = 0, grown = 0, block = UINT32_MAX;
        uint32_t set = UINT32_MAX;       // of elements, the last that its block was marked with
        uint32_t lightest = UINT32_MAX;  // of its nodes
        double least = 1e300, most = 0;  // mass of its nodes [kg]
        uint64_t graph = 0;              // of its nodes and ties; see price.cpp
        bool loaded = false;             // takes in its contacts
        bool direct = false;             // its ties make a block
        bool always = false;             // whatever they carry
        bool sags = false;               // in sweeps, by its weights alone
        bool bears = false;              // more than contacts in sweeps could stand
        uint32_t bounded = 0;            // rows of stops, drives and friction
        double sweep = 0;                // what a sweep of its ties takes, in multiplications of a factor
        Price price;
        double cost = 0;       // of a direct solve, in parts of what sweeps cost
        bool priced = false;   // this is known from the last frame
        bool exact = false;    // a direct solve costs little more than sweeps
        bool dear = false;     // it costs more than it may
        bool hit = false;      // in this frame
        bool elastic = false;  // has elements without multipliers: its matrix sees no contact
    };

    // A block takes in what touches it, as long as the smaller side of each contact and what came by contacts before
    // stay below this: the cost of a direct solve grows with what loops through it. The rest of the contacts is swept.
    static constexpr uint32_t kMostGrown = 64;
    // Of nodes in blocks: with a joint that is solved directly, or in a tower; or taken in with a contact.
    static constexpr uint8_t kHeld = 1, kTaken = 2;

    // By a heavy body, by a load, or by what these press.
    struct Press {
        uint32_t light, by, pair;  // slots of the two that touch; index in Pairs::active
        Vec3f along;               // unit, from the heavy body to the first light one
        bool holds = false;        // carries a load, or that way the light one touches something; of what others
                                   // press, what does not yield
    };

    // Of what something kinematic drives before it: a body, and the contacts on the way to it.
    struct Squeeze {
        uint32_t by;          // slot of the kinematic one
        uint32_t node, pair;  // slot; index in Pairs::active, of the last contact
        uint32_t before;      // index in squeezes_ of the body before it, or kNone
        uint32_t contacts;    // on the way
        Vec3f along;          // unit, from the kinematic one to the first
        double lack;          // by how much they overlap at the end of the frame, if nothing else moves [m]
    };

    // Parts that write nothing which another one reads.
    using Part = void (Partition::*)(const Nodes& nodes);
    void run(Team& team, std::span<const Part> parts, const Nodes& nodes);
    void unite_touching(const Nodes& nodes);
    void find_levels(const Nodes& nodes);
    void colour_touches(const Nodes& nodes);
    void find_places(const Nodes& nodes);
    void weigh(const Nodes& nodes);

    void make_room();
    template <class T>
    void clear_movers(Array<T>& by_slot, const T& value = {}) {
        by_slot.resize(graph_.moves.size());
        for (const uint32_t node : graph_.movers) by_slot[node] = value;
    }
    void note_ties();
    void list_elements(const Elements& elements);
    void colour_elements();
    void colour_fused(const Elements& elements);
    void unite_grains(const Grains& grains);
    void colour_grains(const Grains& grains);
    TouchGraph::Tie movers_of(const SurfaceContact& contact) const;
    void unite_surfaces(const SurfaceContacts& surfaces);
    void colour_surfaces(const SurfaceContacts& surfaces);
    void take_surfaces(const SurfaceContacts& surfaces);
    void number_islands();
    void find_loads(const Nodes& nodes);
    void find_columns(const Nodes& nodes, const Pairs& pairs, const PartitionRules& rules);
    void find_walls(const Nodes& nodes, const Pairs& pairs, double sag, const Vec3f& up);
    void find_towers(const PartitionRules& rules);
    void build_blocks(const Nodes& nodes, const Joints& joints, const Elements& elements, const Pairs& pairs,
                      const PartitionRules& rules);
    Vec3f normal_from(const Pairs& pairs, uint32_t node, uint32_t pair) const;
    void add_press(const Press& press);
    void list_small();
    void note_held(const Nodes& nodes, const Pairs& pairs);
    void find_squeezed(const Nodes& nodes, Pairs& pairs, double weight);
    void soften_squeezed(const Nodes& nodes, Pairs& pairs, const PartitionRules& rules);
    void begin_squeezes(const Nodes& nodes, const Pairs& pairs, double time_step);
    void soften(const Nodes& nodes, const Squeeze& last, double most, double furthest, Pairs& pairs);
    void find_pressed(const Nodes& nodes, Pairs& pairs, const PartitionRules& rules);
    void push_on(const Nodes& nodes, const Pairs& pairs);
    void weigh_ties(const Nodes& nodes, const Joints& joints, const Elements& elements);
    void weigh_bodies(const Nodes& nodes, const PartitionRules& rules);
    void choose_direct(const Nodes& nodes, const Joints& joints, const Elements& elements, const PartitionRules& rules);
    void mark_graphs(const Nodes& nodes, const Joints& joints, const Elements& elements);
    void find_prices(const Nodes& nodes, const Joints& joints, const Elements& elements);
    void price_new(const Nodes& nodes, const Joints& joints, const Elements& elements);
    void take_pressed();
    void take_between(const Nodes& nodes, const Pairs& pairs);
    void find_hit(const Nodes& nodes, const Pairs& pairs, const PartitionRules& rules);
    bool join_contact(uint32_t a, uint32_t b);
    Block& block_at(uint32_t node);
    bool multiplies(const ElementSet& set) const { return set.form == ElementForm::rows || !folds_; }
    void fill_elements(const Elements& elements);
    void fill_blocks(const Nodes& nodes, const Joints& joints, const Elements& elements, const Pairs& pairs);
    void recall_blocks(const Nodes& nodes, const Joints& joints);
    void mark_blocks();
    void unmark(const Array<Block>& of_last);
    void forget_blocks(const Joints& joints, const Pairs& pairs);
    void choose_substeps(const PartitionRules& rules);
    void find_strains(const Elements& elements);
    void find_passages(const Nodes& nodes, const SurfaceContacts& surfaces, const PartitionRules& rules);
    void find_grain_strains(const Grains& grains);
    void make_groups();
    void colour_pairs(const Pairs& pairs);
    void colour_joints();
    void distribute(const Pairs& pairs, bool by_place);
    void list_nodes(bool by_place);
    void list_joints(uint32_t group);
    void list_swept_elements(uint32_t group);
    void list_fused_elements(uint32_t group);
    void list_pairs(uint32_t group, const Pairs& pairs);
    void list_spans(const Pairs& pairs);
    void list_grains(uint32_t group, const Grains& grains);
    void list_surfaces(uint32_t group, const SurfaceContacts& surfaces);
    template <class IsOwn>
    void list_by_colour(const Array<uint8_t>& colour, IsOwn&& is_own, Array<uint32_t>& out, Array<uint32_t>& begin);
    template <class RankOf, class Take>
    uint32_t sort_by_rank(Array<uint32_t>& begin, RankOf&& rank_of, Take&& take);
    uint32_t swept_substeps(size_t island, const PartitionRules& rules) const;
    uint8_t take_colour(std::span<const uint32_t> nodes);
    uint32_t rank(uint8_t colour, uint32_t kind, std::span<const uint32_t> nodes) const;
    bool is_in(uint32_t group, std::span<const uint32_t> nodes) const;

    Adjacency adjacent() const { return {adjacent_, adjacency_}; }
    std::span<const uint32_t> touches_of(uint32_t node) const { return adjacent().of(node); }
    uint32_t find(uint32_t node);
    void unite(uint32_t a, uint32_t b);
    void unite(std::span<const uint32_t> all);  // those that are not kNone
    std::span<const uint32_t> movers_of(uint32_t element) const {
        const uint32_t begin = element_begin_[element];
        return {&element_node_[begin], element_begin_[element + 1] - begin};
    }

    TouchGraph graph_;
    Walls walls_;
    // By slot, of what moves alone: of others entries mean nothing; clear_movers().
    Array<uint32_t> parent_;     // union-find over slots; roots are the smallest slot
    Array<uint32_t> island_of_;  // by slot of what moves
    Array<uint32_t> level_;      // by slot: bodies between it and a support
    Array<Island> island_;
    Array<Component> component_;     // by slot of a root
    Array<Price> prices_;            // of mechanisms in this frame, by graph
    Array<Price> known_prices_;      // and in the last
    Array<uint8_t> core_;            // by slot: whether and how it is in a block
    Array<uint8_t> pair_in_block_;   // by index in Pairs::active
    Array<uint8_t> joint_in_block_;  // by slot
    // Elements on something that moves, set by set; made where the graph changes.
    Array<ElementRef> element_;
    Array<uint32_t> element_begin_, element_node_;  // of each its nodes, kNone in place of those that do not move
    Array<uint32_t> held_;
    Array<uint8_t> element_colour_;
    Array<uint32_t> element_pass_;  // of sets with a fused sweep: stage * kMaxColours + colour within it; else kNone
    Incidence incidence_;
    Array<uint8_t> element_in_block_;   // of this frame
    bool folds_ = true, lanes_ = true;  // likewise
    Array<uint32_t> block_of_;          // by slot: its block in the last frame, or kNone
    Array<Block> spare_;
    uint32_t filled_ = 0;                        // of spare_
    Array<uint8_t> pair_colour_, joint_colour_;  // by index in Pairs::active, by slot
    Array<uint8_t> grain_colour_;                // by index in Grains::contact
    Array<uint8_t> surface_colour_;              // by index in SurfaceContacts::contact
    Array<uint8_t> surface_in_block_;            // likewise
    bool all_coloured_ = false;                  // no pair was left out in pair_colour_
    double lightest_ = 0;                        // of the nodes [kg]
    double least_footing_ = 0;                   // of those without joints [m]; see buckling.cpp
    bool heavy_on_light_ = false;                // some node is kHeavyOnLight times as heavy as another
    Array<uint64_t> used_;                       // by slot: colours taken
    Array<uint8_t> place_;                       // by slot, of what moves
    Array<uint32_t> items_;                      // scratch: what is put in order
    Array<uint32_t> rank_;                       // scratch: of an item, its colour, kind and place
    Array<uint32_t> rank_begin_;                 // scratch: where items of a rank go
    // Of each island, by which fused sweeps would yield in substeps of one second, over what they may, or the square of
    // how often in a second features of surfaces pass their own size; or empty.
    Array<double> strain_;
    Array<double> grain_strain_;        // likewise, of contacts between grains
    Array<uint32_t> efforts_;           // scratch: that occur
    Array<Press> presses_;              // scratch: what presses others before those
    Array<Squeeze> squeezes_;           // scratch: in the order of reach
    bool softened_ = false;             // in the last frame: some pairs have less stiffness
    Array<uint32_t> small_;             // scratch: touches of small islands, by index in Pairs::active
    Array<uint8_t> pressed_;            // scratch: by index in Pairs::active
    Array<uint8_t> tied_;               // by slot: has a joint
    Array<uint32_t> queue_;             // scratch: nodes in the order of their levels
    Array<uint32_t> weak_, standing_;   // scratch: nodes that may buckle, and all of their islands
    Array<Adjacency::Range> adjacent_;  // by slot: in adjacency_
    Array<uint32_t> adjacency_;         // touches of nodes, by index in Pairs::active
};

}  // namespace taut
