// The bounded rows of one block and which of them are on: contacts, stops, drives and friction.
//
//   round     solve with the rows that are on; drop those that pull, add those that would close; at most a few times
//   box       a drive or friction whose impulse passes its limit is that limit, until it no longer lags behind. It lets
//             go in the first round alone: let go in any, frictions of one limb took turns and no round was the last
//   tangents  secant: a sliding contact aims at no slip and has c = |v| / (friction * push), which gives that impulse
//             against the slip v, implicitly; c follows in each round. From substep to substep it is at most halved.
//             Rolling and spinning friction likewise, with angular velocities and an arm in the place of friction
//   relaxed   solved again on the same factor: rows that rest want velocity 0 with the impulse they have, so that the
//             push that undoes overlaps moves positions and is not kept
// Rules and their evidence: measured on chains over edges and towers, the tests of scenes hold them.
#pragma once

#include "solvers/solver.h"
#include "system/row_algebra.h"

namespace taut {

struct AxisRow;  // axis_rows.h

class ActiveSet {
public:
    ActiveSet(Substep& s, Block& b) : s_(s), sys_(s.system), b_(b) {}

    // Bounded rows of the block from its row blocks, at the velocities in System::exact.
    void gather();
    bool empty() const { return b_.bounded_count == 0; }
    uint32_t rounds() const { return b_.tower ? 8 : 4; }

    void aim_biased();                      // goals of the solve that moves positions
    void aim_relaxed(bool with_reference);  // of the one whose velocities are kept
    // Impulses of the rows that are on, from System::exact.
    void take_impulses();
    // After a biased solve: true if a row came, went or left its box, or slides by another force than its loads give.
    // first: of the rounds.
    bool revise(bool first);
    // True if a stop that is off is passed by more than a little.
    bool passes_stop() const;
    // True if the rows that pull do so by more than a little of what all push.
    bool pulls() const;
    // Drops rows that pull; false: none did.
    bool drop_pulling();
    // Of a tower: no row pulls, slides beyond its cone or closes unseen by more than a little.
    bool acceptable() const;
    // Slips for the next substep and impulses back into their rows.
    void store();
    // Work on velocities that went from v0 to v1: mu . J (v0 + v1) / 2 [J].
    double work() const;

    std::span<BoundedRow> rows() const { return {s_.scratch.bounded.data() + b_.first_bounded, b_.bounded_count}; }
    // J v of a row, all ends.
    double speed(const BoundedRow& row, const Array<Velocity>& velocity) const;

private:
    bool nears_stops(const RowBlock& block) const;
    void gather_stop(BoundedRow& row, const AxisRow& axis, double curved);
    void gather_axes(uint32_t block);
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
    bool revise_box(BoundedRow& row, bool first) const;

    Substep& s_;
    System& sys_;
    Block& b_;
};

}  // namespace taut
