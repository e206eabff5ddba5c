// The bounded rows of one block and which of them are on: contacts, stops, drives and friction.
//
//   law       mu = (goal - s J v) / c, within its bounds: of a push at least 0, of a box (drive, friction) within its
//             limit. Each is the slope of a convex energy, so that the substep is the minimum of
//               (v - v*)^T A (v - v*) / 2 + sum of the rows' energies     over the v that the joints allow
//   round     solve with the rows that are on and the limits that hold at the iterate (Newton's step); the iterate goes
//             on towards that solution as far as the energy falls. Taken in full, steps run in circles: where many
//             joints rub a chain on an edge lost a contact now and then, and what hung on it was never at rest; light
//             bodies that a heavy one crushed against a wall were thrown out at kilometres a second
//   short     where rounds run out the iterate is the solution: momentum and joints hold on it, laws nearly
//   tangents  secant: a sliding contact aims at no slip and has c = |v| / (friction * push), which gives that impulse
//             against the slip v, implicitly; c follows in each round: with that of the last substep what is wedged is
//             let go as the push grows. From substep to substep it is at most halved.
//             Rolling and spinning friction likewise, with angular velocities and an arm in the place of friction
//   relaxed   solved again on the same factor: rows that rest want velocity 0 with the impulse they have, so that the
//             push that undoes overlaps moves positions and is not kept
// Rules and their evidence: measured on chains over edges and towers, the tests of scenes hold them.
#pragma once

#include "solvers/solver.h"
#include "system/operators.h"

namespace taut {

struct AxisRow;  // axis_rows.h

class ActiveSet {
public:
    ActiveSet(Substep& s, Block& b) : s_(s), sys_(s.system), b_(b) {}

    // Bounded rows of the block from its row blocks, at the velocities in System::exact.
    void gather();
    bool empty() const { return b_.bounded_count == 0; }
    bool undoes_overlaps() const;
    // At ratios of 10000 an impact with eight left one chain in eight caught on the rim by a link's end, with twelve
    // one in 48. Of heaps of 100 ragdolls that fell with four in blocks without contacts, 4 of 26 jammed for seconds.
    // Towers of many bodies take too long for more.
    uint32_t rounds() const { return b_.tower && b_.nodes.size() > kManyBodies ? 8 : 16; }

    void aim_biased();       // goals of the solve that moves positions
    void aim_unbiased();     // likewise without the push that undoes overlaps
    void ease(double part);  // leaves so much of that push, in this substep
    void aim_relaxed();      // of the one whose velocities are kept
    bool bounces() const;    // after that: whether what was hit is to leave again
    // Likewise with so much of these bounces.
    void ease_bounces(double part);
    // Impulses of the rows that are on, from System::exact.
    void take_impulses();
    void begin_rounds();
    // After a biased solve: brings the iterate on, to it in the first round. The part of the way, (0, 1].
    double advance(bool first);
    // True if the way was shorter than matters.
    bool settled() const { return settled_; }
    // Rows as the laws have them at the iterate; true if one came, went or met its limit, or slides by another force
    // than its loads give.
    bool revise();
    // The rounds are over: impulses are those of the iterate, and so will be what is solved on the same factor.
    void stop_short();
    // Slips for the next substep and impulses back into their rows.
    void store();
    // Work on velocities that went from v0 to v1: mu . J (v0 + v1) / 2 [J].
    double work() const;
    // Likewise of contacts alone, on what their ends do to each other from the velocities in System::free on.
    double contact_work() const;
    // For the mean of a solution with that and this one.
    void remember_contacts();
    double mean_contact_work() const;

    std::span<BoundedRow> rows() const { return {s_.scratch.bounded.data() + b_.first_bounded, b_.bounded_count}; }
    // J v of a row, all ends.
    double speed(const BoundedRow& row, const Array<Velocity>& velocity) const;

private:
    static constexpr size_t kManyBodies = 32;

    bool nears_stops(const RowBlock& block) const;
    void gather_stop(BoundedRow& row, const AxisRow& axis, double curved);
    void gather_axes(uint32_t block);
    double softness() const;
    double rebound_of(const BoundedRow& push, const RowBlock& block) const;
    void gather_contact(uint32_t block);
    BoundedRow& add(BoundedRow::Kind kind, uint32_t index, int row, double sign, double softness);
    void gather_rolling(uint32_t block);
    void gather_tangents(BoundedRow& first, uint32_t width, uint32_t load, uint32_t loads, double limit, float& slip);
    void follow_loads();
    bool loaded(const BoundedRow& lead) const;
    double slide(const BoundedRow& lead, const Array<Velocity>& velocity) const;
    void begin_slip(BoundedRow& lead);
    void follow_slip(BoundedRow& lead) const;
    bool revise_slip(BoundedRow& lead) const;
    double bound_of(const BoundedRow& lead) const;
    static double size_of(const BoundedRow& lead);
    static bool revise_box(BoundedRow& row);
    double slope_of_energy(double part, double& curvature) const;
    double least_energy(double start) const;
    double negligible() const;

    Substep& s_;
    System& sys_;
    Block& b_;
    bool settled_ = false;
};

}  // namespace taut
