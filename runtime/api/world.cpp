#include <taut/world.h>

#include <algorithm>
#include <cmath>

#include "advance.h"
#include "api/replay.h"
#include "api/sized.h"
#include "check/minimised.h"
#include "integrate/scheme.h"
#include "record/recorder.h"
#include "sleep/wake.h"
#include "solvers/minimisation.h"

using namespace taut;

namespace {

constexpr uint32_t kMaxThreads = 64;
constexpr Range kSleepSpeed{0, 10};             // [m/s]
constexpr Range kSleepTime{0, 1e3};             // [s]
constexpr Range kRestitutionThreshold{0, 1e4};  // [m/s]
constexpr Range kRelaxation{1e-3, 1.999};
constexpr Range kAirDensity{0, 1e4};           // [kg/m^3]
constexpr Range kAirPressure{0, 1e7};          // [Pa]
constexpr Range kWind{-1e3, 1e3};              // [m/s]
constexpr Range kMinimiseTolerance{1e-12, 1};  // [m]
constexpr Range kRestTolerance{1e-9, 1e3};     // [m/s^2]
constexpr uint32_t kMostRestSteps = 100000;
constexpr Range kNewmarkBeta{0.25, 0.5}, kNewmarkGamma{0.5, 1};

Check& check_hooks(Check& check, const taut_hooks& hooks) {
    check.require(!hooks.allocate == !hooks.free,
                  "hooks.allocate and hooks.free: one is null, expected both or neither");
    check.require(!hooks.enqueue_task == !hooks.finish_task,
                  "hooks.enqueue_task and hooks.finish_task: one is null, expected both or neither");
    if (!hooks.enqueue_task) check.zero("hooks.worker_count", hooks.worker_count);
    return check.count("hooks.worker_count", hooks.worker_count, 0, kMaxThreads - 1)
        .zero("hooks.reserved", hooks.reserved);
}

// What solvers other than those that iterate over rows have no part of.
Check& check_passes(Check& check, const taut_world_def& def) {
    const bool rows = def.solver >= TAUT_SOLVER_ACCELERATED_JACOBI && def.solver <= TAUT_SOLVER_CONJUGATE_GRADIENTS;
    const bool kept = def.stepping == TAUT_STEPPING_POST_STABILISED;
    return check
        .require(rows || def.stepping <= TAUT_STEPPING_VELOCITY,
                 "stepping: its passes are of solvers that iterate over rows", TAUT_UNSUPPORTED)
        .require(rows || def.contact_stabilisation == 0,
                 "contact_stabilisation: it is of solvers that iterate over rows", TAUT_UNSUPPORTED)
        .require(rows || def.velocity_gain == 1, "velocity_gain: it is of solvers that iterate over rows",
                 TAUT_UNSUPPORTED)
        .require(!kept || def.scheme == TAUT_SCHEME_IMPLICIT_EULER,
                 "scheme: velocities of TAUT_STEPPING_POST_STABILISED are those of TAUT_SCHEME_IMPLICIT_EULER alone",
                 TAUT_UNSUPPORTED)
        .require(!kept || def.solver != TAUT_SOLVER_CONJUGATE_GRADIENTS,
                 "stepping: rigid rows of TAUT_SOLVER_CONJUGATE_GRADIENTS are springs, whose velocities are those of "
                 "their errors",
                 TAUT_UNSUPPORTED)
        .require(!kept || def.velocity_gain == 1,
                 "velocity_gain: TAUT_STEPPING_POST_STABILISED leaves velocities as they are", TAUT_UNSUPPORTED);
}

Check& check_def(Check& check, const taut_world_def& def) {
    check.choice("solver", def.solver, static_cast<uint32_t>(solvers().size()) - 1)
        .vector("gravity", def.gravity, kGravity)
        .number("time_step", def.time_step, kTimeStep)
        .count("substeps", def.substeps, 1, kMaxSubsteps)
        .boolean("fixed_substeps", def.fixed_substeps)
        .count("sweeps", def.sweeps, 0, 1000)
        .boolean("geometric_stiffness", def.geometric_stiffness)
        .number("velocity_filter", def.velocity_filter, kUnitInterval)
        .count("max_catch_up", def.max_catch_up, 1, 1000)
        .count("threads", def.threads, 1, def.hooks.enqueue_task ? 1 : kMaxThreads)
        .boolean("sleeping", def.sleeping)
        .number("sleep_speed", def.sleep_speed, kSleepSpeed)
        .number("sleep_time", def.sleep_time, kSleepTime)
        .count("contact_events", def.contact_events, 0, TAUT_CONTACT_EVENTS_ALL)
        .number("hit_speed", def.hit_speed, kHitSpeed)
        .boolean("continuous", def.continuous)
        .boolean("adaptive_damping", def.adaptive_damping)
        .number("restitution_threshold", def.restitution_threshold, kRestitutionThreshold)
        .boolean("report", def.report)
        .number("air_density", def.air_density, kAirDensity)
        .number("air_pressure", def.air_pressure, kAirPressure)
        .vector("wind", def.wind, kWind)
        .number("minimise_tolerance", def.minimise_tolerance, kMinimiseTolerance)
        .boolean("line_search", def.line_search)
        .choice("stepping", def.stepping, TAUT_STEPPING_POST_STABILISED)
        .number("stabilisation", def.stabilisation, kUnitInterval)
        .number("contact_stabilisation", def.contact_stabilisation, kUnitInterval)
        .number("velocity_gain", def.velocity_gain, kUnitInterval)
        .number("relaxation", def.relaxation, kRelaxation)
        .choice("friction_model", def.friction_model, TAUT_FRICTION_BOX)
        .choice("momentum", def.momentum, TAUT_MOMENTUM_POWER)
        .boolean("fixed_step", def.fixed_step)
        .choice("scheme", def.scheme, static_cast<uint32_t>(scheme_types().size()) - 1)
        .number("newmark_beta", def.newmark_beta, kNewmarkBeta)
        .number("newmark_gamma", def.newmark_gamma, kNewmarkGamma)
        .require(def.newmark_gamma <= 2 * def.newmark_beta,
                 "newmark_gamma: more than 2 newmark_beta, with which steps are not stable");
    check_passes(check, def);
    return check_hooks(check, def.hooks);
}

}  // namespace

void taut_world_def_init_sized(taut_world_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_world_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.solver = TAUT_SOLVER_BLOCK_LDLT;
        own.gravity = {0, -9.81f, 0};
        own.time_step = 1.0f / 60;
        own.substeps = 4;
        own.sweeps = 0;
        own.geometric_stiffness = 1;
        own.velocity_filter = 0.25f;
        own.max_catch_up = 4;
        own.threads = 1;
        own.sleep_speed = 0.03f;
        own.sleep_time = 0.5f;
        own.contact_events = TAUT_CONTACT_EVENTS_BEGIN_END;
        own.hit_speed = 1;
        own.continuous = 1;
        own.stabilisation = 0.2f;
        own.relaxation = 1;
        own.newmark_beta = 0.25f;
        own.newmark_gamma = 0.5f;
        own.air_density = 1.2f;
        own.air_pressure = 101325;
        own.minimise_tolerance = 1e-6f;
        own.line_search = 1;
        own.velocity_gain = 1;
    });
}

const char* taut_solver_name(taut_solver solver) {
    const auto index = static_cast<size_t>(solver);
    return index < solvers().size() ? solvers()[index]->name : nullptr;
}

taut_result taut_world_create(const taut_world_def* given, taut_world* out) {
    Check check(__func__);
    taut_world_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_world_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return contain(check.call(), [&] {
        if (!collision::precision_matches()) {
            return refuse(TAUT_UNSUPPORTED, "%s: the Bullet collision library linked is not of single precision",
                          check.call());
        }
        const uint32_t id = create_world(def);
        if (id == 0)
            return refuse(TAUT_LIMIT, "%s: 1023 worlds live already, or all 16.7 million handles of worlds were used",
                          check.call());
        *out = {id};
        return TAUT_OK;
    });
}

taut_result taut_world_destroy(taut_world handle) {
    const char* call = __func__;
    return contain(call, [&] {
        if (is_within_recording(world_of(handle))) return refuse_hold(call, "world", TAUT_LOCKED);
        Hold hold(world_of(handle), Use::write);
        if (!hold.world()) return refuse_hold(call, "world", hold.refusal());
        destroy_world(hold);
        end_recording(world_of(handle));
        close_replay(world_of(handle));
        return TAUT_OK;
    });
}

int32_t taut_world_is_valid(taut_world handle) { return world_lives(world_of(handle)) ? 1 : 0; }

taut_result taut_world_step(taut_world handle) {
    TAUT_RECORD(taut_world_step, handle);
    const char* call = __func__;
    return with_world(call, handle, Use::write, [&](World& world) {
        if (const char* why = why_not_minimised(world)) return refuse(TAUT_UNSUPPORTED, "%s: %s", call, why);
        take_step(world);
        return TAUT_OK;
    });
}

taut_result taut_world_advance_sized(taut_world handle, double seconds, taut_advance* first, uint32_t size) {
    TAUT_RECORD(taut_world_advance_sized, handle, seconds, first, size);
    const RecordOut<taut_advance> out(first, size);
    Check check("taut_world_advance");
    if (!check.number("seconds", seconds, kAdvance)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        if (const char* why = why_not_minimised(world)) return refuse(TAUT_UNSUPPORTED, "%s: %s", check.call(), why);
        const Advance done = advance(world, seconds);
        if (out) {
            const float weight = static_cast<float>(render_weight(world));
            *out = {done.steps, std::min(weight, std::nextafter(1.0f, 0.0f)), done.dropped};
        }
        return TAUT_OK;
    });
}

taut_result taut_world_relax_sized(taut_world handle, float tolerance, uint32_t max_steps, taut_relaxation* first,
                                   uint32_t size) {
    TAUT_RECORD(taut_world_relax_sized, handle, tolerance, max_steps, first, size);
    const RecordOut<taut_relaxation> out(first, size);
    Check check("taut_world_relax");
    if (!check.number("tolerance", tolerance, kRestTolerance).count("max_steps", max_steps, 1, kMostRestSteps))
        return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        if (const char* why = why_not_relaxed(world)) return refuse(TAUT_UNSUPPORTED, "%s: %s", check.call(), why);
        Relaxation relaxation{tolerance, max_steps};
        take_rest(world, relaxation);
        if (out) *out = {relaxation.steps, relaxation.converged ? 1u : 0u, to_float(relaxation.residual)};
        return TAUT_OK;
    });
}

taut_result taut_world_get_def_sized(taut_world handle, taut_world_def* first, uint32_t size) {
    const RecordOut<taut_world_def> out(first, size);
    Check check("taut_world_get_def");
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = world.def;
        return TAUT_OK;
    });
}

taut_result taut_world_set_time_step(taut_world handle, float time_step) {
    TAUT_RECORD(taut_world_set_time_step, handle, time_step);
    Check check(__func__);
    if (!check.number("time_step", time_step, kTimeStep)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        change_time_step(world, time_step);
        return TAUT_OK;
    });
}

taut_result taut_world_set_substeps(taut_world handle, uint32_t substeps) {
    TAUT_RECORD(taut_world_set_substeps, handle, substeps);
    Check check(__func__);
    if (!check.count("substeps", substeps, 1, kMaxSubsteps)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        world.def.substeps = substeps;
        world.spring_substep = std::max(world.first_substep, static_cast<double>(world.def.time_step) / substeps);
        return TAUT_OK;
    });
}

taut_result taut_world_get_gravity(taut_world handle, taut_vec3* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = world.def.gravity;
        return TAUT_OK;
    });
}

taut_result taut_world_set_gravity(taut_world handle, taut_vec3 gravity) {
    TAUT_RECORD(taut_world_set_gravity, handle, gravity);
    Check check(__func__);
    if (!check.vector("gravity", gravity, kGravity)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const taut_vec3 old = world.def.gravity;
        if (gravity.x != old.x || gravity.y != old.y || gravity.z != old.z) wake_all(world);
        world.def.gravity = gravity;
        return TAUT_OK;
    });
}

taut_result taut_world_get_wind(taut_world handle, taut_vec3* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = world.def.wind;
        return TAUT_OK;
    });
}

taut_result taut_world_set_wind(taut_world handle, taut_vec3 wind) {
    TAUT_RECORD(taut_world_set_wind, handle, wind);
    Check check(__func__);
    if (!check.vector("wind", wind, kWind)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const taut_vec3 old = world.def.wind;
        if (wind.x != old.x || wind.y != old.y || wind.z != old.z) wake_all(world);
        world.def.wind = wind;
        return TAUT_OK;
    });
}

taut_result taut_world_set_contact_events(taut_world handle, uint32_t contact_events) {
    TAUT_RECORD(taut_world_set_contact_events, handle, contact_events);
    Check check(__func__);
    if (!check.count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        world.def.contact_events = contact_events;
        world.pairs.asks = static_cast<uint8_t>(contact_events);
        ++world.colliders.version;
        return TAUT_OK;
    });
}

taut_result taut_world_set_hit_speed(taut_world handle, float hit_speed) {
    TAUT_RECORD(taut_world_set_hit_speed, handle, hit_speed);
    Check check(__func__);
    if (!check.number("hit_speed", hit_speed, kHitSpeed)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        world.def.hit_speed = hit_speed;
        return TAUT_OK;
    });
}

taut_result taut_world_set_restitution_threshold(taut_world handle, float restitution_threshold) {
    TAUT_RECORD(taut_world_set_restitution_threshold, handle, restitution_threshold);
    Check check(__func__);
    if (!check.number("restitution_threshold", restitution_threshold, kRestitutionThreshold)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        world.def.restitution_threshold = restitution_threshold;
        return TAUT_OK;
    });
}

taut_result taut_world_set_pre_solve(taut_world handle, taut_pre_solve_fn pre_solve, void* user_data) {
    TAUT_RECORD(taut_world_set_pre_solve, handle, pre_solve, user_data);
    return with_world(__func__, handle, Use::write, [&](World& world) {
        world.pre_solve = recorded_pre_solve(world, {pre_solve, user_data});
        for (const Collider& collider : world.colliders.record)
            if (collider.node != kNone && (collider.asks & kAsksPreSolve) != 0) wake_about(world, collider.node);
        return TAUT_OK;
    });
}

taut_result taut_world_get_counts(taut_world handle, uint32_t* bodies, uint32_t* shapes, uint32_t* joints) {
    return with_world(__func__, handle, Use::read, [&](const World& world) {
        if (bodies) *bodies = world.nodes.ids.count();
        if (shapes) *shapes = world.shapes.count();
        if (joints) *joints = world.joints.ids.count();
        return TAUT_OK;
    });
}

taut_result taut_world_get_bytes(taut_world handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = held_bytes(world);
        return TAUT_OK;
    });
}

taut_result taut_world_get_state_hash(taut_world handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = state_hash(world);
        return TAUT_OK;
    });
}
