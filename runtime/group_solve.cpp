#include "group_solve.h"

#include <algorithm>

#include "check/quarantine.h"
#include "detect/detect.h"
#include "integrate/scheme.h"
#include "models/air.h"
#include "publish/publish.h"
#include "solvers/minimisation.h"
#include "solvers/restitution.h"
#include "system/assemble.h"
#include "system/reached.h"

namespace taut {

GroupSolve::GroupSolve(World& world, uint32_t index, const Solver& solver, const SolverSettings& settings,
                       SolverReport& report, StageWatch& watch)
    : w_(world),
      system_(world.system),
      group_(world.partition.groups[index]),
      index_(index),
      solver_(solver),
      settings_(settings),
      report_(report),
      watch_(watch),
      gravity_(world.def.gravity.x, world.def.gravity.y, world.def.gravity.z),
      clock_(world.def.time_step, group_.substeps, solver.direct && world.def.fixed_substeps == 0),
      airy_(find_loaded_surfaces(world, index)),
      one_step_(system_.scheme.is_one_step()),
      lends_(one_step_ && world.team.size() > 1 && group_.blocks.empty() && world.nodes.load.empty() && !airy_ &&
             !world.observer && !world.def.report),
      loan_(world.team, system_, group_, world.nodes),
      renewed_(world.memory) {
    const auto is_surface = [&](uint32_t node) { return is_surface_vertex(world.nodes, world.softs, node); };
    if (!solver.lanes || !group_.blocks.empty() || std::ranges::none_of(group_.nodes, is_surface)) return;
    renewed_.assign(world.nodes.slots(), Renewed::unmoved);
    for (uint32_t node = 0; node < world.nodes.slots(); ++node)
        if (moves_by_forces(world.nodes.info[node].kind)) renewed_[node] = Renewed::not_own;
    for (const uint32_t node : group_.nodes) renewed_[node] = Renewed::own;
}

void GroupSolve::build() {
    watch_.begin("predict");
    system_.scheme.set_length(clock_.length());
    build_rows(system_, group_, w_.partition.blocks, w_.joints, w_.elements, w_.pairs, w_.nodes, !solver_.lanes,
               solver_.energies);
    if (solver_.lanes) {
        build_lanes(w_.team, system_, group_, w_.pairs, w_.nodes, *settings_.kernels);
        build_grain_lanes(w_.team, system_, group_, w_.pairs.grains);
        build_surface_lanes(w_.team, system_, group_, w_.pairs.surfaces, *settings_.surface_kernels);
        build_joint_lanes(w_.team, system_, group_, w_.def.time_step);
        build_element_lanes(w_.team, system_, group_, w_.elements);
    }
    watch_group(group_, system_, w_.pairs, w_.watch);
    w_.profile.predict_us += watch_.lap();
}

void GroupSolve::begin() {
    watch_.begin("predict");
    if (clock_.length() != system_.scheme.h)
        change_length(w_.team, system_, group_, w_.pairs, clock_.length(), w_.def.time_step);
    if (loaded_ || !sane_) {
        loan_.end();
        loaded_ = quarantine(w_.team, w_.nodes, group_.nodes, w_.frozen, system_.scheme.h);
    }
    renew_surfaces();
    if (lends_) loan_.begin();
    find_contacts_again(w_.nodes, w_.colliders, w_.shapes, w_.pairs, group_.direct_pairs, clock_.begin(),
                        system_.scheme.h);
    turn_kinematic(system_, w_.nodes, clock_.begin());
    predict(w_.team, system_, group_, w_.nodes, gravity_);
    system_.gases.clear();
    if (airy_) load_surfaces(w_, index_, clock_.begin());
    if (!one_step_)
        begin_scheme(system_, group_, w_.nodes, *scheme_types()[w_.def.scheme],
                     {w_.def.newmark_beta, w_.def.newmark_gamma}, solver_.energies);
    if (solver_.lanes && clock_.number() > 0) {
        turn_surface_lanes(w_.team, system_, *settings_.surface_kernels);
        turn_lanes(w_.team, system_, group_, *settings_.kernels);
    }
    shift_kinematic(system_, w_.nodes, clock_.begin());
    if (solver_.energies)
        place_obstacles(w_.nodes, w_.colliders, w_.shapes, clock_.end(), w_.scratch.minimisation.get().obstacles);
    if (w_.def.report) w_.reports.begin(measured());
    build_block_contacts(system_, group_, w_.partition.blocks, w_.pairs, w_.nodes);
    tell(Stage::predict);
    w_.profile.predict_us += watch_.lap();
}

// Forces and hits go on with the features that have them.
void GroupSolve::renew_surfaces() {
    if (renewed_.empty() || clock_.number() == 0) return;
    const double now = clock_.begin();
    const auto motion = [&](uint32_t node) -> const NodeMotion& {
        return system_.lent ? system_.motion[system_.at(node)] : w_.nodes.motion[node];
    };
    const double since = now - surfaces_found_, ahead = static_cast<double>(w_.def.time_step) - now;
    if (!have_strayed(w_.softs, renewed_, since, clock_.length(), motion)) return;
    loan_.end();
    SurfaceContacts& surfaces = w_.pairs.surfaces;
    store_surface_lanes(w_.team, system_, surfaces);
    Array<SurfaceHit> hits_before(surfaces.contact.size(), SurfaceHit{}, w_.memory);
    store_surface_hits(system_, surfaces, hits_before);
    Array<uint32_t> successor(w_.memory);
    renew_surface_contacts(w_.team,
                           {w_.nodes, w_.colliders, w_.shapes, w_.softs, w_.elements, w_.pairs, w_.broadphase, ahead,
                            now, renewed_, since, clock_.length()},
                           w_.pre_solve, successor);
    surfaces_found_ = now;
    w_.partition.renew_surfaces(index_, surfaces, successor);
    system_.reached.clear();
    add_reached(w_.nodes, surfaces, system_.reached);
    seat_reached(system_, w_.nodes);
    make_room_for_scheme(system_, w_.nodes);
    Array<SurfaceHit> hits(surfaces.contact.size(), SurfaceHit{}, w_.memory);
    for (uint32_t k = 0; k < successor.size(); ++k)
        if (successor[k] != kNone) hits[successor[k]] = hits_before[k];
    build_surface_lanes(w_.team, system_, group_, surfaces, *settings_.surface_kernels);
    load_surface_hits(system_, surfaces, hits);
}

void GroupSolve::assemble() {
    watch_.begin("assemble");
    evaluate_rows(w_.team, system_, clock_.left(), w_.def.time_step);
    if (solver_.lanes) {
        evaluate_joint_lanes(w_.team, system_);
        if (settings_.geometric_stiffness)
            stiffen_joints(w_.team, system_, w_.nodes, *settings_.joint_kernels, settings_.velocity_filter > 0);
        prepare_joint_lanes(w_.team, system_, *settings_.joint_kernels);
    }
    tell(Stage::assemble);
    w_.profile.assemble_us += watch_.lap();
}

Substep GroupSolve::next() {
    const bool even = clock_.number() % 2 == 0;
    Substep substep{w_.team,       system_, group_, w_.partition.blocks, w_.nodes, settings_, report_, w_.scratch,
                    clock_.last(), even,    !even,  clock_.most_turn()};
    substep.impacts = &w_.impacts;
    return substep;
}

void GroupSolve::solve(Substep& substep) {
    watch_.begin("solve");
    restitute(substep);
    solver_.solve(substep);
    if (substep.is_too_long()) return;
    if (substep.last) report_.residual = std::max(report_.residual, row_residual(system_, *settings_.joint_kernels));
    if (w_.def.report) w_.reports.solved(measured());
    tell(Stage::solve);
    w_.profile.sweep_us += watch_.lap();
}

void GroupSolve::shorten() {
    drop_strikes(system_, w_.impacts);
    clock_.halve();
    w_.profile.sweep_us += watch_.lap();
}

void GroupSolve::commit(Substep& substep) {
    watch_.begin("commit");
    commit_strikes(system_, w_.impacts, w_.nodes);
    taut::commit(w_.team, system_, group_, w_.nodes);
    shift_kinematic(system_, w_.nodes, clock_.end());
    if (solver_.settle) {
        solver_.settle(substep);
        correct(system_, group_, w_.partition.blocks, w_.nodes);
    }
    follow_joints(system_, w_.nodes);
    if (!one_step_) {
        if (solver_.lanes) store_joint_lanes(w_.team, system_);
        end_scheme(system_, group_, w_.nodes, solver_.energies);
    }
    tell(Stage::commit);
    w_.profile.commit_us += watch_.lap();
}

void GroupSolve::relax(Substep& substep) {
    watch_.begin("solve");
    solver_.relax(substep);
    w_.profile.sweep_us += watch_.lap();
    watch_.begin("commit");
    sane_ = store_velocity(w_.team, system_, group_, w_.nodes, settings_.velocity_filter);
    if (!one_step_) remember_scheme(system_, group_, w_.nodes);
    store_contact_rows(system_);
    if (w_.def.report) w_.reports.end(measured());
    gather_impulses(system_, w_.impacts, w_.pairs, w_.watch);
    gather_surface_impulses(w_.team, system_, w_.impacts, w_.pairs.surfaces);
    tell(Stage::relax);
    w_.profile.commit_us += watch_.lap();
}

void GroupSolve::end() {
    loan_.end();
    w_.profile.substeps = std::max(w_.profile.substeps, clock_.number());
    if (!sane_) quarantine(w_.team, w_.nodes, group_.nodes, w_.frozen);
    if (!solver_.lanes) return;
    store_lanes(w_.team, system_, w_.pairs);
    store_grain_lanes(w_.team, system_, w_.pairs.grains);
    store_surface_lanes(w_.team, system_, w_.pairs.surfaces);
    store_joint_lanes(w_.team, system_);
    store_element_lanes(w_.team, system_);
    store_element_yields(system_);
}

}  // namespace taut
