// The problem of one substep as row solvers see it: impulses mu of rows and velocities u of nodes with
//
//   u = u* + W J^T mu,   r = rate(u) - target + c mu   [m/s],   mu in P,   r = 0 where P does not bind
//
// (Frâncu 2016, eq. 6.24 and 7.34 in velocities: x = x_n + h u). rate(u) is J u in velocity time stepping (eq. 6.21)
// and (C(x_n + h u) - C(x_n)) / h, with J at x_n + h u, in position projection (eq. 6.26). Contacts are linear in both,
// for their normals and points are of one frame: with levers of the end of a substep, spinning bodies that bounced
// gained up to half of their energy (the thesis mixes the two likewise, section 8.3). P is all of R for locked rows, an
// interval for stops, drives and frictions of axes, a half line for the normals of contacts, and what project.h gives
// for friction. c is compliance as scheme.h states it, or the softness of contacts.
//
// Impulses lie in one array: those of System::rows first, in their places, then those of axes.
#pragma once

#include "constraints/soft_contact.h"
#include "system/axis_rows.h"
#include "system/operators.h"
#include "system/project.h"

namespace taut {

// project: positions reach their targets at the end of the substep. relax: velocities without what that pushed.
enum class Phase : uint8_t { project, relax };

// What rigid rows are to a solver.
enum class Rigid : uint8_t {
    exact,  // c = 0
    soft,   // joint_terms(): for solvers of the energy form, where 1/c is a stiffness
};

// Rows that are solved; the others keep their impulses.
enum class Part : uint8_t { all, links, contacts };

struct RowSettings {
    FrictionModel friction = FrictionModel::cylinder;
    bool linear = false;               // velocity time stepping
    double stabilisation = 0.2;        // gamma: share of an error that rigid rows undo in a substep; eq. 6.19
    double contact_stabilisation = 0;  // the same of overlaps; 0: softly, as soft_contact.h states it
    Part part = Part::all;
    bool pushes = true;  // else errors are left as they are
};

// Rows of one block that are projected together.
struct Unit {
    enum class Law : uint8_t {
        free,   // any impulse; one to six rows
        range,  // low to high, times the loads if there are any; one row
        disc,   // two tangents, within high times the loads
    };

    Law law = Law::free;
    uint8_t row = 0, rows = 1;  // of the block: the first, and how many
    bool rigid = true;          // c is not the row's own
    bool solved = true;         // else it keeps its impulse
    bool linear = true;         // rate(u) is J u
    uint32_t turning = kNone;   // in ProblemMemory::turning, of a unit whose impulses follow J
    uint32_t applied = 0;       // of such a unit: its first in ProblemMemory::applied
    uint32_t block = 0;         // in Rows::block
    uint32_t first = 0;         // impulse
    uint32_t matrix = 0;        // of c and of the inverse diagonal: rows x rows, column by column
    uint32_t island = 0;        // units that share moving nodes have one
    double sign = 1;            // of J
    double low = 0, high = 0;
    uint32_t load = 0, loads = 0;  // normals whose impulses bound it: the first, and how many, kContactRows apart
    float* force = nullptr;        // of an axis: carried [N]
};

// Geometric stiffness K of a unit whose impulses follow J: see turning.cpp.
struct Turning {
    double elastic = 0;               // share of an evaluation that its compliance alone makes stable
    double direction[kMaxRows] = {};  // of the impulse that pull and push are of, or zero
    double pull = 0, push = 0;        // h t tr(W K) of K's positive and negative part, per impulse [1/(N s)]
};

struct ProblemMemory {
    explicit ProblemMemory(Memory& m)
        : unit(m),
          impulse(m),
          target(m),
          compliance(m),
          inverse(m),
          start(m),
          rate(m),
          count(m),
          parent(m),
          island_of(m),
          seat(m),
          turning(m),
          applied(m),
          node(m),
          node_vector{Array<NodeVector>(m), Array<NodeVector>(m), Array<NodeVector>(m), Array<NodeVector>(m),
                      Array<NodeVector>(m)},
          vector{Array<double>(m), Array<double>(m), Array<double>(m), Array<double>(m)},
          island{Array<double>(m), Array<double>(m), Array<double>(m), Array<double>(m)} {}

    Array<Unit> unit;
    Array<double> impulse, target;      // rows
    Array<double> compliance, inverse;  // Unit::matrix
    Array<double> start, rate;          // C(x_n) and rate(u), rows of System::rows; of position projection
    Array<uint32_t> count, parent;      // by seat: units on it, and scratch of find_islands()
    Array<uint32_t> island_of;          // by seat
    Array<uint32_t> seat;               // of moving nodes that a unit is on, in the order of nodes
    Array<Turning> turning;             // of units that turn
    Array<NodeVector> applied;          // what impulses of units that turn gave to their nodes, J^T mu as it was then
    Array<NodeVector> node, node_vector[5];  // by seat; for a solver
    Array<double> vector[4];                 // rows, for a solver
    Array<double> island[4];                 // islands, for a solver
};

class Problem {
public:
    using Vector = Array<double>;

    Problem(System& system, ProblemMemory& memory, const RowSettings& settings, Phase phase, Rigid rigid);

    std::span<const Unit> units() const { return m_.unit; }
    size_t rows() const { return m_.impulse.size(); }
    uint32_t islands() const { return islands_; }
    Vector& impulse() { return m_.impulse; }
    Vector& scratch(int i) { return m_.vector[i]; }
    Vector& island_scratch(int i) { return m_.island[i]; }

    // u += W J^T mu, of what the last substep left and so many evaluations can turn.
    void warm_start(uint32_t evaluations);
    // The same where u has all of them already, from another pass.
    void go_on();
    // Rates and, in position projection, J at x_n + h u: of all units, or of one.
    void evaluate();
    void evaluate(const Unit& unit);
    // r; of rows that are not locked 0.
    RowVector residual(const Unit& unit) const;
    void residual(Vector& r) const;
    // r without what pushes impulses out of P, times the inverse diagonal: (mu - proj(mu - D^-1 r)), 0 at the solution.
    void direction(const Vector& r, Vector& z) const;
    // Of one node [6] in each of seats(): J^T mu, J u of rows (of rows that are not locked 0), and W p.
    using NodeVectors = Array<NodeVector>;
    void apply_transpose(const Vector& mu, NodeVectors& out) const;
    void apply(const NodeVectors& u, Vector& out) const;
    NodeVector response_of(uint32_t seat, const NodeVector& p) const { return response(s_.sweep[seat], p); }
    NodeVectors& node_scratch(int i) { return m_.node_vector[i]; }
    // A d = (J W J^T + c) d.
    void apply_system(const Vector& d, Vector& out);
    std::span<const uint32_t> seats() const { return m_.seat; }  // of nodes that move and that a unit is on
    uint32_t island_of(uint32_t seat) const { return m_.island_of[seat]; }
    void move(uint32_t seat, const NodeVector& change);  // of u
    // D^-1 d; D: diagonal blocks of J W J^T + c, with as many parts of each node's mass as units share it (or whole).
    RowVector inverse(const Unit& unit, const RowVector& d) const { return matrix(m_.inverse, unit) * d; }
    void use_whole_masses() { find_inverses(Masses::whole); }
    // From now on inverse() is 1/c, which Rigid::soft has in every row: the stiffness of the energy form.
    void use_stiffness() { find_inverses(Masses::none); }
    // Onto P, in the order of units: what bounds others comes first.
    void project(Vector& mu) const;
    void project(const Unit& unit, Vector& mu) const;
    // Takes impulses, and u with them: of all units, or of one and of those that bound it.
    void move_to(const Vector& mu);
    void move_to(const Unit& unit, const Vector& mu);
    // mu = proj((target - rate) / c): the law of rows in the energy form, after use_stiffness().
    void find_forces(Vector& mu) const;

    // Impulses into System::rows; forces of axes and, of the projection, of joints [N].
    void store();

    RowVector of(const Unit& unit, const Vector& v) const {
        return Eigen::Map<const RowVector>(&v[unit.first], unit.rows);
    }
    static Eigen::Map<RowVector> of(const Unit& unit, Vector& v) { return {&v[unit.first], unit.rows}; }

private:
    const RowBlock& block(const Unit& unit) const { return s_.rows.block[unit.block]; }
    std::span<const uint32_t> nodes(const Unit& unit) const {
        return {block(unit).node, static_cast<size_t>(block(unit).type->nodes)};
    }
    Eigen::Map<const Eigen::MatrixXd> matrix(const Vector& of, const Unit& unit) const {
        return {&of[unit.matrix], unit.rows, unit.rows};
    }
    // Geometric stiffness of a unit's impulse: h t tr(W |K|), and the share of K's positive part in it.
    struct Stiffness {
        double size = 0, positive = 1;
        double stable_share() const { return 1 / (1 + size); }
    };
    bool pushes() const { return phase_ == Phase::project && settings_.pushes; }
    bool is_solved(const Unit& unit, int r) const {
        return unit.solved && (unit.law != Unit::Law::free || block(unit).locked(r));
    }

    void add_units();
    Unit& add(uint32_t block, Unit::Law law, int row, int rows);
    void add_contact(uint32_t block);
    void add_rolling(uint32_t block);
    void add_axes(uint32_t block);
    void set_row(const Unit& unit, double target, double compliance);
    void set_locked(Unit& unit);
    void linearise();
    void keep_impulses();
    void take_part();
    void find_islands();
    uint32_t root(uint32_t seat);
    enum class Masses : uint8_t { none, whole, split };  // in the diagonal
    void find_inverses(Masses masses);
    RowMatrix effective(const Unit& unit, Masses masses = Masses::whole) const;
    bool has_locks(const Unit& unit) const;
    double inverse_mass(const Unit& unit, int r) const;
    void soften_locked(const Unit& unit, RowMatrix& d) const;
    RowVector masked(const Unit& unit, RowVector values) const;
    RowVector miss(const Unit& unit) const;  // target - rate
    // J_n of a unit's rows.
    auto jacobian(const Unit& unit, int n) const {
        return jacobian_of(s_, block(unit), n).middleRows(unit.row, unit.rows);
    }
    void push(const Unit& unit, const RowVector& change);
    void find_turning();
    Stiffness stiffness(const Unit& unit, const Pose* poses);
    double trace_of_stiffness(const Unit& unit, const Pose* poses, const RowVector& force) const;
    void turn(const Unit& unit, const Pose* poses);

    System& s_;
    ProblemMemory& m_;
    RowSettings settings_;
    Phase phase_;
    Rigid rigid_;
    SweepTerms contact_, joint_;
    uint32_t islands_ = 0;
};

}  // namespace taut
