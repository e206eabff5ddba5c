// Schemes of time integration, and what those of more than one step need between the velocities of the state and those
// that are solved for (system/scheme.h). A new one is its file, a line in list.cpp and a name in world.h.
#pragma once

#include <span>

#include "partition/partition.h"
#include "system/system.h"

namespace taut {

// Of taut_world_def.
struct SchemeSettings {
    double beta = 0.25, gamma = 0.5;  // of Newmark
};

// Of one node, as a substep begins.
struct SchemeStart {
    Speed v;       // v_n
    Speed gained;  // h a, a: external accelerations
    const NodeHistory& history;
    double h;
    const SchemeSettings& settings;
};

struct SchemeType {
    const char* name;
    // t / h, s / h and whether it has one step.
    Scheme (*times)(const SchemeSettings& settings);
    // u* and v~; null for one step, where both are v_n + h a.
    void (*start)(const SchemeStart& from, Speed& ahead, Speed& coast);
    // What takes its place in a substep of minimisation with nodes that have no past. Others begin that from forces as
    // they are at x_n, which of a tangle are as far from those within the substep as can be. Null: none.
    const SchemeType* first = nullptr;
};

// In the order of taut_scheme.
std::span<const SchemeType* const> scheme_types();

extern const SchemeType kImplicitEuler, kNewmark, kBdf2;

// a + share b
inline Speed sum(const Speed& a, double share, const Speed& b) { return {a.v + share * b.v, a.w + share * b.w}; }

// Once a frame: room for what a scheme remembers.
void make_room_for_scheme(System& system, Nodes& nodes);
// After predict(), from v_n + h a in System::exact: u* in its place. minimised: see SchemeType::first.
void begin_scheme(System& system, const Group& group, Nodes& nodes, const SchemeType& type,
                  const SchemeSettings& settings, bool minimised);
// After positions moved by h u, from u in System::exact, and in kept of nodes in blocks: v' in its place, with springs'
// forces at the positions reached. springs_known: the solver left what these do in System::by_springs.
void end_scheme(System& system, const Group& group, const Nodes& nodes, bool springs_known);
// After store_velocity(): what the next substep has to know.
void remember_scheme(const System& system, const Group& group, Nodes& nodes);

}  // namespace taut
