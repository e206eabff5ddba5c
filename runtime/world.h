// A world owns the rooms' data and no algorithms. What happens to it in a frame is step.cpp.
#pragma once

#include <taut/taut.h>

#include "base/profile_scopes.h"
#include "collision/collide.h"
#include "detect/pre_solve.h"
#include "partition/partition.h"
#include "publish/contact_watch.h"
#include "publish/event_window.h"
#include "snapshot/undo.h"
#include "solvers/report.h"
#include "solvers/solver.h"
#include "stages.h"
#include "state/attachments.h"
#include "state/cables.h"
#include "state/colliders.h"
#include "state/handle.h"
#include "state/joints.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/sensors.h"
#include "state/shapes.h"
#include "state/sleep.h"
#include "state/softs.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

constexpr uint32_t kMaxSubsteps = 64;  // of a step, by its def

struct Relaxation;

struct World {
    explicit World(const taut_world_def& checked_def, uint32_t world_id = 0);

    Memory memory;       // first: everything below allocates from it
    taut_world_def def;  // as checked at creation; gravity may change
    Team team;           // that works on its steps
    uint32_t id = 0;     // slot and generation of the handle, 24 bits; the table in api/access.cpp holds its lock

    // state: lives across frames
    Nodes nodes;
    Shapes shapes;
    Colliders colliders;
    Joints joints;
    Elements elements;
    Cables cables;
    Softs softs;
    Attachments attachments;
    collision::Broadphase broadphase;
    Pairs pairs;
    Sleep sleep;
    Sensors sensors;
    PreSolve pre_solve;
    double accumulator = 0;  // frame time not yet stepped [s]
    double last_step = 0;    // length of the last step, or of the first one to come [s]

    // derived: rebuilt by each step from the state, kept for its memory and for what blocks remember
    Partition partition;
    System system;
    SolverScratch scratch;
    ContactWatch watch;

    // results of the steps since the host read them: events
    EventWindow window;
    Array<taut_contact_event> contact_begin, contact_persist, contact_end;
    Array<taut_contact_point> contact_points;
    Array<taut_hit_event> hits;
    Array<taut_moved_event> moved;
    Array<taut_quarantine_event> quarantined;
    Array<taut_joint_break_event> broken;
    Array<taut_attachment_break_event> detached;
    Array<taut_tear_event> torn;
    Array<taut_yield_event> yielded;
    Array<taut_sleep_event> fell_asleep, woke;
    Array<uint32_t> moved_before;  // nodes, scratch; publish_motion()

    // results of the last step
    Array<uint32_t> frozen;  // nodes quarantined by the last step
    taut_profile profile{};

    SolveReports reports;  // of the last step, where def.report asks for them

    StageObserver* observer = nullptr;  // of tests; null: nobody looks on
    Relaxation* relaxation = nullptr;   // of taut_world_relax while it works, else null: a step of no time

    // State too: the substep that soft rows keep the frequency of, whatever becomes of the time step [s]. None is
    // longer.
    double spring_substep = 0;
    double first_substep = 0;  // that of the def at creation
    uint32_t least_substeps() const;
    Impacts impacts;  // derived
    Undo undo;        // of the step that is being taken

    ProfileScopes scopes;  // the host's

    taut_body body_handle(uint32_t node) const;
    taut_joint joint_handle(uint32_t joint) const;
    taut_shape shape_handle(uint32_t shape) const;
    taut_collider collider_handle(uint32_t collider) const;
    taut_cable cable_handle(uint32_t cable) const;
    taut_cloth cloth_handle(uint32_t soft) const;
    taut_solid solid_handle(uint32_t soft) const;
    taut_attachment attachment_handle(uint32_t attachment) const;
};

// What changes of it after the world's creation.
template <class Visitor, Like<taut_world_def> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [struct_size, solver, gravity, time_step, substeps, fixed_substeps, sweeps, geometric_stiffness,
           velocity_filter, max_catch_up, threads, hooks, sleeping, sleep_speed, sleep_time, contact_events, hit_speed,
           continuous, max_bodies, max_colliders, max_joints, max_contacts, adaptive_damping, restitution_threshold,
           stepping, stabilisation, relaxation, friction_model, momentum, fixed_step, scheme, newmark_beta,
           newmark_gamma, report, air_density, air_pressure, wind, minimise_tolerance, line_search,
           contact_stabilisation, velocity_gain] = of;
    TAUT_FIELDS(visitor, gravity.x, gravity.y, gravity.z, time_step, substeps, restitution_threshold, wind.x, wind.y,
                wind.z);
    TAUT_ASIDE(visitor, contact_events, hit_speed);
}

template <class Visitor, Like<World> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [memory, def, team, id, nodes, shapes, colliders, joints, elements, cables, softs, attachments, broadphase,
           pairs, sleep, sensors, pre_solve, accumulator, last_step, partition, system, scratch, watch, window,
           contact_begin, contact_persist, contact_end, contact_points, hits, moved, quarantined, broken, detached,
           torn, yielded, fell_asleep, woke, moved_before, frozen, profile, reports, observer, relaxation,
           spring_substep, first_substep, impacts, undo, scopes] = of;
    TAUT_FIELDS(visitor, def, nodes, shapes, colliders, joints, elements, cables, softs, attachments,
                broadphase.boxes());
    TAUT_ROWS(visitor, colliders.ids, broadphase.boxes().of, pairs.reach, pairs.placement, pairs.stance, pairs.travel);
    TAUT_FIELDS(visitor, pairs, sleep, accumulator, spring_substep, partition);
    TAUT_ASIDE(visitor, sensors, last_step);
    // Not state: the host's own (memory, team, id, pre_solve, observer, relaxation, first_substep, scopes); what a step
    // works with (system, scratch, watch, impacts, undo, moved_before); what steps told (all others), which a
    // restoration forgets.
}

// One fixed time step. Throws std::bad_alloc only before the state changes or with the state still consistent.
void step(World& world);

// Hash of everything that the future depends on.
uint64_t state_hash(const World& world);

}  // namespace taut
