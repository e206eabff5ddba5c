// One frame, from poses to poses.
#include <algorithm>

#include "base/log.h"
#include "check/quarantine.h"
#include "check/validate.h"
#include "detect/contact_limit.h"
#include "detect/crowds.h"
#include "detect/detect.h"
#include "detect/grains.h"
#include "detect/impact.h"
#include "detect/internal_faces.h"
#include "detect/sensors.h"
#include "detect/surface_contacts.h"
#include "group_solve.h"
#include "integrate/integrate.h"
#include "integrate/scheme.h"
#include "models/cable.h"
#include "models/cloth_tearing.h"
#include "models/plastic.h"
#include "partition/needs.h"
#include "publish/publish.h"
#include "sleep/sleep.h"
#include "solvers/minimisation.h"
#include "state/sane.h"
#include "system/reached.h"
#include "world.h"

namespace taut {

void tell(World& w, const StageEnd& end) {
    if constexpr (kValidates) validate(w, end);
    if (w.observer) w.observer->after(w, end);
}

namespace {

constexpr uint32_t kGrain = 128;  // nodes that a thread takes at a time

void remember_poses(Team& team, Nodes& nodes) {
    const std::span<const uint32_t> active = nodes.active;
    team.for_ranges(static_cast<uint32_t>(active.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t node : active.subspan(begin, end - begin))
            if (nodes.rest[node] != Rest::asleep) nodes.before[node] = {nodes.origin(node), nodes.motion[node].q};
    });
}

// What the step goes through.
void list_active(World& w) {
    w.nodes.list_active();
    w.colliders.list_active(w.nodes);
}

// How old contacts, found once a frame, are on average over the substeps that they serve [s].
double mean_age(const World& w) { return 0.5 * (1 - 1.0 / w.least_substeps()) * static_cast<double>(w.def.time_step); }

// After those of pairs, for vertices leave to edges and faces what these are nearer to.
void find_touches(World& w, double lead) {
    find_contacts(w.team, w.nodes, w.colliders, w.shapes, w.pairs, w.def.time_step, lead);
    find_surface_contacts(
        w.team, {w.nodes, w.colliders, w.shapes, w.softs, w.elements, w.pairs, w.broadphase, w.def.time_step});
}

// Of solvers that take ways out in place of contacts.
void detect_obstacles(World& w, StageWatch& watch) {
    update_bounds(w.team, w.nodes, w.colliders, w.shapes, w.pairs, w.broadphase, w.def.time_step);
    tell(w, {Stage::bounds});
    w.profile.broadphase_us = watch.lap();
    watch.begin("narrowphase");
    w.pairs.surfaces.contact.clear();
    ++w.pairs.surfaces.version;
    const taut_vec3 g = w.def.gravity;
    Obstacles& obstacles = w.scratch.minimisation.get().obstacles;
    find_obstacles({w.nodes, w.colliders, w.shapes, w.softs, w.elements, w.def.time_step, Vec3(g.x, g.y, g.z)},
                   obstacles);
    wake_met(w, w.def.time_step, obstacles);
    list_active(w);
    tell(w, {Stage::contacts});
    w.profile.narrowphase_us = watch.lap();
}

void detect(World& w, StageWatch& watch) {
    if (solvers()[w.def.solver]->energies) return detect_obstacles(w, watch);
    const double lead = mean_age(w);
    recall_pairs(w);
    update_bounds(w.team, w.nodes, w.colliders, w.shapes, w.pairs, w.broadphase, w.def.time_step);
    tell(w, {Stage::bounds});
    update_pairs(w.team, w.nodes, w.colliders, w.joints, w.elements, w.broadphase, w.pairs);
    retire_pairs(w);
    tell(w, {Stage::pairs});
    w.profile.broadphase_us = watch.lap();
    watch.begin("narrowphase");
    find_grain_contacts(w.nodes, w.colliders, w.shapes, w.pairs, w.def.time_step);
    w.profile.dropped_contacts = thin_crowds(w.nodes, w.colliders, w.shapes, w.pairs);
    find_touches(w, lead);
    if (wake_touched(w)) {
        list_active(w);
        recall_pairs(w);
        find_touches(w, lead);
    }
    SurfaceContacts& surfaces = w.pairs.surfaces;
    const size_t found = surfaces.contact.size();
    const uint32_t refused = filter_contacts(w.nodes, w.colliders, w.pre_solve, w.pairs) +
                             filter_surfaces(w.nodes, w.colliders, w.shapes, w.pre_solve, w.pairs, surfaces.contact);
    if (surfaces.contact.size() < found) ++surfaces.version;
    if (refused > 0)
        log_line(w.def.hooks, TAUT_LOG_WARNING, "%u answers of the pre-solve function refused: out of range, or thrown",
                 refused);
    open_internal_faces({w.nodes, w.colliders, w.shapes, w.pairs, w.def.time_step, lead});
    const uint32_t dropped = limit_contacts(w.nodes, w.colliders, w.def.max_contacts, w.pairs);
    w.profile.dropped_contacts += dropped;
    if (dropped > 0)
        log_line(w.def.hooks, TAUT_LOG_WARNING, "%u contacts dropped: max_contacts is %u", dropped, w.def.max_contacts);
    tell(w, {Stage::contacts});
    w.profile.narrowphase_us = watch.lap();
}

void tell_quarantine(World& w) {
    std::ranges::sort(w.frozen);
    const auto fast = std::ranges::count_if(
        w.frozen, [&](uint32_t node) { return w.nodes.find_frozen(node)->why == Divergence::too_fast; });
    log_line(w.def.hooks, TAUT_LOG_WARNING,
             "%zu bodies quarantined: the motion of %zu was not finite, of %zu beyond %g m/s or rad/s", w.frozen.size(),
             w.frozen.size() - static_cast<size_t>(fast), static_cast<size_t>(fast), kMaxSpeed);
    for (const uint32_t node : w.frozen)
        if (const char* const name = w.nodes.name_of(node))
            log_line(w.def.hooks, TAUT_LOG_WARNING, "body '%s' quarantined", name);
}

void solve(World& w, StageWatch& watch) {
    const Solver& solver = *solvers()[w.def.solver];
    const taut_vec3 g = w.def.gravity;
    const MinimisationSettings minimisation{w.def.minimise_tolerance, w.def.line_search != 0, w.relaxation};
    const SolverSettings settings{
        w.def.sweeps,
        w.def.geometric_stiffness != 0,
        w.def.velocity_filter,
        double(g.x) * g.x + double(g.y) * g.y + double(g.z) * g.z,
        &contact_kernels(),
        &joint_kernels(),
        &element_kernels(),
        &grain_kernels(),
        &surface_kernels(),
        w.def.adaptive_damping != 0,
        w.def.restitution_threshold,
        {static_cast<FrictionModel>(w.def.friction_model), false, w.def.stabilisation, w.def.contact_stabilisation},
        {0, w.def.relaxation, static_cast<MomentumRule>(w.def.momentum), w.def.fixed_step != 0},
        &minimisation,
        static_cast<Stepping>(w.def.stepping),
        w.def.velocity_gain};
    SolverReport report;
    const double least = static_cast<double>(w.def.time_step) / w.least_substeps();
    w.system.stretch = static_cast<float>(std::min(1.0, least / w.spring_substep));
    const SchemeType& scheme = w.relaxation ? kImplicitEuler : *scheme_types()[w.def.scheme];
    w.system.scheme = scheme.times({w.def.newmark_beta, w.def.newmark_gamma});
    age_yields(w.elements, w.def.time_step, w.least_substeps());
    list_reached(w.nodes, w.joints, w.pairs, w.partition.held(), w.system.reached);
    begin_frame(w.team, w.system, w.partition, w.nodes, w.joints.ids.count() > 0 || w.elements.ids.count() > 0);
    make_room_for_scheme(w.system, w.nodes);
    w.profile.predict_us += watch.lap();
    for (uint32_t i = 0; i < w.partition.group_count; ++i) GroupSolve(w, i, solver, settings, report, watch).run();
    if (solver.energies)
        tell_pushes(w.system.scheme.h, w.softs, w.nodes, w.scratch.minimisation.get().obstacles, w.pairs.surfaces);
    if (const uint32_t failures = report.failures; failures > 0)
        log_line(w.def.hooks, TAUT_LOG_WARNING, "%u block solves failed: their nodes moved freely", failures);
    if (report.unfinished > 0)
        log_line(w.def.hooks, TAUT_LOG_WARNING, "%u minimisations ended before their tolerance", report.unfinished);
    if (!w.frozen.empty()) {
        tell_quarantine(w);
        drop_bad_impulses(w.pairs, w.joints, w.elements);
        ++w.joints.version;  // blocks lose the frozen nodes
    }
    for (Joint& joint : w.joints.record) std::fill(joint.drift, joint.drift + kMaxRows, 0.0);
    for (ElementSet& set : w.elements.set) std::ranges::fill(set.drift, 0.0);
    commit_kinematic(w.system, w.nodes, w.def.time_step);
    w.profile.factor_us = report.direct_us;
    w.profile.sweep_us -= report.direct_us;
    w.profile.solves = report.solves;
    w.profile.resolves = report.resolves;
    w.profile.guard_trips = report.guard_trips;
    w.profile.residual = static_cast<float>(report.residual);
}

// By node: 1 for vertices whose contacts are found anew within the step (GroupSolve::renew_surfaces).
Array<uint8_t> followed_vertices(World& w) {
    Array<uint8_t> followed(w.memory);
    if (w.softs.ids.count() == 0 || !solvers()[w.def.solver]->lanes) return followed;
    followed.resize(w.nodes.slots(), 0);
    for (uint32_t i = 0; i < w.partition.group_count; ++i) {
        const Group& group = w.partition.groups[i];
        for (const uint32_t node : group.nodes)
            followed[node] = group.blocks.empty() && is_surface_vertex(w.nodes, w.softs, node) ? 1 : 0;
    }
    return followed;
}

// Of what a crowded moment took, all that was not needed again.
void give_back(World& w) {
    if (!w.memory.takes_stock()) return;
    trim(w.pairs);
    w.broadphase.trim();
    w.system.contacts.trim();
    for (Array<taut_contact_event>* events : {&w.contact_begin, &w.contact_persist, &w.contact_end}) trim(*events);
    trim(w.contact_points);
}

}  // namespace

void step(World& w) {
    Stopwatch whole;
    const ProfileScope scope(w.scopes, "step", 0);
    const RestAfter rest(w.team);
    StageWatch watch(w.scopes);
    watch.begin("broadphase");
    const Memory::Keeping keeping(w.memory);
    const uint64_t calls = w.memory.calls();
    w.profile = {};
    w.profile.struct_size = sizeof(taut_profile);
    w.frozen.clear();
    begin_events(w);
    reel_cables(w);
    list_active(w);
    remember_poses(w.team, w.nodes);
    w.last_step = w.def.time_step;
    detect(w, watch);
    watch.begin("partition");
    watch_contacts(w.nodes, w.pairs, w.watch);
    watch_surfaces(w.team, w.nodes, w.colliders, w.pairs);
    const Solver& solver = *solvers()[w.def.solver];
    note_loads(w.joints, w.elements, w.nodes);
    note_needs(w.joints, w.elements, w.nodes, w.def.time_step / w.least_substeps(), w.def.time_step);
    const taut_vec3 g = w.def.gravity;
    const bool one_step = !scheme_types()[w.def.scheme]->start;
    w.partition.build(w.team, w.nodes, w.joints, w.elements, w.pairs,
                      {w.least_substeps(), w.def.fixed_substeps != 0, solver.direct, w.def.time_step,
                       Vec3(g.x, g.y, g.z), w.team.size() > 1, solver.lanes && one_step, one_step, w.spring_substep});
    if (w.def.report) w.reports.begin_step(w.partition, w.joints, w.elements);
    tell(w, {Stage::partition});
    w.profile.partition_us = watch.lap();
    watch.begin("predict");
    solve(w, watch);
    watch.begin("publish");
    if (!solver.energies)  // which leaves nodes where they are out of obstacles
        hold_back(w.team, w.colliders, w.shapes, w.joints, w.elements, followed_vertices(w), w.pairs, w.broadphase,
                  w.nodes);
    flow_solids(w);
    note_strays(w.team, w.nodes, w.colliders, w.shapes, w.frozen, w.pairs, w.broadphase);
    sense(w.team, w.nodes, w.colliders, w.shapes, w.softs, w.broadphase, w.id, w.window.steps, w.sensors);
    w.nodes.load.clear();
    publish_contacts(w);
    publish_motion(w, w.frozen);
    publish_profile(w);
    break_joints(w);
    tear_cloths(w);
    tell(w, {Stage::publish});
    update_sleep(w);
    end_events(w);
    tell(w, {Stage::sleep});
    give_back(w);
    w.profile.publish_us = watch.lap();
    w.profile.allocations = w.memory.calls() - calls;
    w.profile.step_us = whole.lap();
}

}  // namespace taut
