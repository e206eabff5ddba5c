// The system of one substep: what the solvers see. Built from the state by assemble_rows.cpp and assemble_lanes.cpp.
// Solvers reach constraints through it alone and by no type's name; they write velocities and impulses, and keep
// scratch of their own.
//
//   [ M + h^2 K   -J^T ] [v+]   [ M v + h f + h^2 K s ]      K: positive part of the geometric stiffness
//   [ J            c   ] [mu] = [ target              ]      s: low-passed velocity, mu = h lambda
//
// and so in other schemes with their times (scheme.h). Row by row, from C lambda = -error - damping C d(error)/dt at
// the end of the substep (Frâncu 2016, eq. 6.44):
//   c = C / (h (h + d)),  target = -error / (h + d),  d = C * damping [s]; a rigid row has C = d = 0.
//
// Arrays by seat: of each node System::at(node); 0 is the world, which never moves. Only what the step goes through or
// ends on has one. Seats follow the order in which threads take the nodes of groups, so that what a thread writes lies
// together.
#pragma once

#include "base/memory.h"
#include "constraints/axis.h"
#include "constraints/constraint.h"
#include "constraints/contact.h"
#include "constraints/contact_lanes.h"
#include "constraints/element.h"
#include "constraints/element_lanes.h"
#include "constraints/grain_lanes.h"
#include "constraints/joint_lanes.h"
#include "constraints/rolling.h"
#include "constraints/span_contact.h"
#include "constraints/surface_lanes.h"
#include "state/elements.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "system/scheme.h"

namespace taut {

// Velocities in double: the unknowns of direct solves, and what commit() integrates.
struct Velocity {
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};

// The rows of one joint, element or contact point. Offsets point into the arrays of Rows.
struct RowBlock {
    const ConstraintType* type;
    const void* data;
    double* force;                   // lambda of the last substep, then of this one [N]; type->rows
    Vec3* slow_turn;                 // of joints whose type has a line
    const double* drift;             // of joints and elements: what of C is still to come within the frame is left out
    uint32_t node[kMaxNodes];        // indices into arrays by seat; unused ones 0
    uint32_t row;                    // first row
    uint32_t jacobian;               // first entry of [node][row][6]
    double compliance[2];            // of each row, and of each that is an angle [m/N, rad/(N m)], 0: rigid
    const double* compliance_block;  // [rows][rows] in its place, times compliance[0]; or null
    double relaxation[2];            // time d [s]: compliance * damping, likewise
    const Axis* axis;                // of each row, or null: all are locked
    double stop_softness = 1;        // with axis: times the compliance of their stops
    AxisMemory* memory;              // of each row, with axis
    ContactForce* contact;           // what a contact point carries on; null for joints
    bool* pushed;                    // of a contact point: its pair's
    const PairRecord* surface_pair;  // of a contact point of a pair; else null
    double friction;                 // of a cone
    double drive[2];                 // of a cone: J v that friction drives the tangents to [m/s]
    double arm[2];                   // of a load: spinning, rolling [m]
    uint32_t loaded, loads;          // of a load: first row of its contact points, each of three; how many there are
    float* spin_slip;                // of a load: what spinning carries on; rolling is in contact
    double restitution;              // of a cone
    bool hits;                       // of a cone: approached faster than kHardSpeed before the frame's forces
    bool fresh;                      // lambda of the last substep means nothing yet
    bool in_lanes;                   // a swept joint or element: bias, targets and impulses are in System::joints
    bool batched;                    // an element: evaluated by its run
    uint8_t point;                   // of a cone: which point
    uint32_t pair;                   // of which pair, an index into Pairs::list; of surfaces kNone
    uint32_t surface;                // which contact of surfaces, an index into SurfaceContacts::contact

    bool angular(int r) const { return (type->angular >> r & 1) != 0; }
    bool elastic(int r) const { return compliance[angular(r)] > 0 || compliance_block; }
    // Its C and J too.
    bool evaluated_in_lanes() const { return in_lanes && type->evaluate_lanes; }
    int held() const {  // rows up to the last locked one
        int rows = type->rows;
        while (rows > 0 && !locked(rows - 1)) --rows;
        return rows;
    }
    bool locked(int r) const { return !axis || axis[r].mode == AxisMode::locked; }
    bool stops_angle(int r) const { return axis && axis[r].mode == AxisMode::limited && angular(r); }
};

// Elements of one set whose rows follow each other.
struct ElementRun {
    const ElementType* type;
    const double* data;     // of the set
    uint32_t first, count;  // in Rows::block
    uint32_t element;       // first in Rows::element, of as many
    uint32_t node;          // first in Rows::element_node
};

// Elements of one set without rows: those that a block folds into its nodes, or all of a group.
struct ElasticRun {
    ElementSet* set;
    uint32_t count;
    uint32_t element;  // first in Rows::element, of as many
    uint32_t node;     // first in Rows::element_node
};

// A joint whose type follows the turns of its nodes.
struct FollowedJoint {
    uint32_t block;  // in Rows::block
    void* data;
};

struct Rows {
    explicit Rows(Memory& memory)
        : block(memory),
          followed(memory),
          run(memory),
          elastic(memory),
          sorted(memory),
          element(memory),
          element_node(memory),
          error(memory),
          jacobian(memory),
          impulse(memory),
          data(memory),
          span_data(memory),
          rolling_data(memory) {}

    // First the rows that stay for the frame: those of joints and elements, of blocks before swept ones, then those of
    // swept contacts that come as rows. After them the contacts of blocks, new in each substep.
    uint32_t direct = 0, joints = 0, lasting = 0;  // in block: where each of these ends
    uint32_t lasting_spans = 0;                    // in span_data
    Array<RowBlock> block;
    Array<FollowedJoint> followed;
    Array<ElementRun> run;
    Array<ElasticRun> elastic;              // of blocks, or of a group whose solver takes energies
    Array<ElementRef> sorted;               // scratch of build_rows()
    Array<uint32_t> element, element_node;  // of runs: index in the set; seats
    Array<double> error;                    // C(x) [m or rad]           rows; assemble()
    Array<double> jacobian;                 // dC/dx                     assemble()
    Array<double> impulse;             // mu = h lambda [N s]       rows; solvers; before a solve: of the last substep
    Array<ContactData> data;           // of contact rows: where a solver takes all as rows, and those of blocks
    Array<SpanContactData> span_data;  // of contacts with a side of two nodes
    Array<RollingData> rolling_data;   // of contacts with rolling or spinning friction, after their points
};

// Gas that nodes enclose in a volume V: its pressure, which acts as a force within `exact` already, falls by
// `stiffness` for each m^3 that the substep adds to V. In the nodes it is t h stiffness g g^T, g = dV/dx.
struct GasLoad {
    uint32_t first, count;  // in Gases::seat
    double stiffness;       // -dp/dV [Pa/m^3]
};
struct Gases {
    explicit Gases(Memory& memory) : list(memory), seat(memory), gradient(memory), pushed(memory) {}

    void clear() {
        list.clear();
        seat.clear();
        gradient.clear();
        pushed.clear();
    }
    Vec3 push_of(uint32_t at) const { return pushed.empty() ? Vec3(Vec3::Zero()) : pushed[at]; }

    Array<GasLoad> list;
    Array<uint32_t> seat;  // of nodes that forces move
    Array<Vec3> gradient;  // g of each [m^2]
    Array<Vec3> pushed;    // by seat, or empty: velocity that pressure within surfaces gives in this substep [m/s]
};

// For sweeps, which want no -0.
inline void set_sweep_velocity(SweepVelocity& out, const Velocity& u) {
    for (int i = 0; i < 3; ++i) {
        out.v[i] = static_cast<float>(u.v[i]) + 0.0f;
        out.w[i] = static_cast<float>(u.w[i]) + 0.0f;
    }
}

// Of a node that is held within a frame, and about a locked axis [kg, kg m^2]: above any mass, and far within what
// squares of double hold.
constexpr double kHeldMass = 1e30;

struct System {
    struct Found {  // place at which contacts were found, rotation that their levers belong to
        Vec3 x = Vec3::Zero();
        Quat q = Quat::Identity();
    };

    explicit System(Memory& memory)
        : seat(memory),
          node_at(memory),
          reached(memory),
          motion(memory),
          pose(memory),
          foreseen(memory),
          exact(memory),
          free(memory),
          kept(memory),
          correction(memory),
          start(memory),
          ahead(memory),
          coast(memory),
          began(memory),
          by_springs(memory),
          inertia(memory),
          found(memory),
          turned(memory),
          kinematic(memory),
          in_block(memory),
          filtered(memory),
          place(memory),
          sweep(memory),
          shift(memory),
          sweep_pose(memory),
          joint_share(memory),
          gases(memory),
          rows(memory),
          joints(memory),
          elements(memory),
          grains(memory),
          surfaces(memory),
          contacts(memory) {}

    // In what begin_frame() fills, for so many slots of nodes and so many nodes with a seat: as they come, not in the
    // step that sees them first.
    void make_room(size_t slots, size_t seated) {
        grow_to(seat, slots + 1);
        const size_t size = seated + 1;
        node_at.reserve(size);
        grow_to(pose, size), grow_to(exact, size), grow_to(found, size), grow_to(turned, size);
        grow_to(in_block, size), grow_to(filtered, size), grow_to(place, size);
        grow_to(sweep, size), grow_to(shift, size);
    }

    uint32_t at(uint32_t node) const { return seat[node + 1]; }  // of kNone, and without a seat: that of the world

    Scheme scheme;          // of this substep
    double frame_left = 0;  // share of the frame after this substep; evaluate_rows()
    double frame = 0;       // length of the frame [s]; likewise

    Array<uint32_t> seat;     // by node + 1; begin_frame()
    Array<uint32_t> node_at;  // by seat
    Array<uint32_t> reached;  // nodes that are seated because something ends on them; list_reached()
    uint32_t movers = 0;      // nodes of groups, in seats 1 to this
    // By seat, of a group while its motions are lent: as nodes lie in the order in which a host made them, threads that
    // move some each would write to the same cache lines.
    Array<NodeMotion> motion;
    bool lent = false;
    float stretch = 1;  // length of substeps over the one that soft rows keep the frequency of; soft_contact.h

    // by seat; of those for nodes in blocks all or, where no block ever was, none
    Array<Pose> pose;       // at the start of the substep; predict()
    Array<Pose> foreseen;   // at its end, as velocities were before the solve, of nodes of elastic elements; block_ldlt
    Array<Velocity> exact;  // predict(): v* = v + h a; solvers: v+
    Array<Velocity> free;   // v* with contact impulses, of nodes in blocks; block_ldlt
    Array<Velocity> kept;   // v+ without the push of overlaps, of nodes in blocks with bounded rows
    Array<Velocity> correction;  // displacement and rotation [m, rad] of nodes in corrected blocks; solver.settle
    Array<Velocity> start;       // v before forces, w after the gyroscopic torque, for energy balances; predict()
    // Of schemes of more than one step, see scheme.h: u*, v~, v_n and accelerations by springs [m/s^2, rad/s^2].
    Array<Velocity> ahead, coast, began, by_springs;
    Array<Mat3> inertia;          // world axes [kg m^2], kHeldMass about locked ones, of nodes in blocks; predict()
    Array<Found> found;           // begin_frame(), predict()
    Array<uint8_t> turned;        // 1: so far that levers turn in this substep; predict(), turn_kinematic()
    Array<uint32_t> kinematic;    // nodes; begin_frame()
    Array<uint8_t> in_block;      // 1: a direct solve owns its exact velocity; build_rows()
    Array<uint8_t> filtered;      // 1: swept joints spare its slow velocity; build_joint_lanes()
    Array<uint32_t> place;        // in the nodes of its block, or kNone; build_rows()
    Array<SweepNode> sweep;       // velocities in floats and inverse masses, world axes
    Array<SweepShift> shift;      // motion since contacts were found; commit()
    Array<SweepPose> sweep_pose;  // pose in floats, where there are joints; begin_frame(), predict()
    Array<float> joint_share;     // likewise, within inv_inertia: what stiffen_joints() left of it

    Gases gases;            // of the group being solved
    Rows rows;              // likewise
    JointLanes joints;      // swept ones of the group being solved
    ElementLanes elements;  // likewise, of sets with a fused sweep
    GrainLanes grains;      // of the group being solved
    SurfaceLanes surfaces;  // likewise
    ContactLanes contacts;  // likewise
};

// Damping time d of a row [s].
inline double relaxation_of(const RowBlock& block, int r) {
    return block.relaxation[block.compliance_block ? 0 : block.angular(r)];
}

}  // namespace taut
