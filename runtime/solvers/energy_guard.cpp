// Each substep, with W the work of all that is not an ideal joint (forces, contacts, springs, gyroscopic torque):
//   W = sum m (free - v).(v + v+)/2,   account = max(0, 0.9 account + KE+ - KE - W)
//   trips if account > patience (0.05 KE_internal + 1e-4 (240 h)^2 (KE + |W| + M g^2 h^2 / 2))
// The total energy would be blind at high mass ratios: 1 % of a heavy weight's is 100 m/s on a light link.
#include "solvers/energy_guard.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr uint32_t kGuardSubsteps = 60;  // how long a trip lasts
constexpr uint32_t kWarmup = 3;          // substeps of a new block: its forces are still settling
constexpr double kUnequal = 100;         // mass ratio, from which on blocks gain energy easily
// Blocks of more equal masses gain a little here and there, which comes to nothing, and would be solved twice for it:
// so many times as much, of one solution and on the whole.
constexpr double kBurst = 12, kPatience = 40;

double kinetic_energy(const Substep& s, const Block& block, const Array<Velocity>& velocity) {
    double sum = 0;
    for (uint32_t node : block.nodes) {
        const uint32_t i = s.system.at(node);
        const Velocity& u = velocity[i];
        sum += 0.5 * s.nodes.mass[node].mass * u.v.squaredNorm();
        if (s.nodes.info[node].kind == NodeKind::dynamic) sum += 0.5 * u.w.dot(s.system.inertia[i] * u.w);
    }
    return sum;
}

// Kinetic energy beyond that of the rigid motion with the block's linear and angular momentum: the projection of
// its velocities on rigid motions, orthogonal in the mass metric.
double internal_energy(const Substep& s, const Block& block, double kinetic) {
    double mass = 0;
    Vec3 centre = Vec3::Zero(), momentum = Vec3::Zero();
    for (uint32_t node : block.nodes) {
        const uint32_t i = s.system.at(node);
        const double m = s.nodes.mass[node].mass;
        mass += m;
        centre += m * s.system.pose[i].x;
        momentum += m * s.system.exact[i].v;
    }
    centre /= mass;
    const Vec3 drift = momentum / mass;
    Mat3 inertia = Mat3::Zero();
    Vec3 spin = Vec3::Zero();
    for (uint32_t node : block.nodes) {
        const uint32_t i = s.system.at(node);
        const double m = s.nodes.mass[node].mass;
        const Vec3 d = s.system.pose[i].x - centre;
        const Velocity& u = s.system.exact[i];
        inertia += m * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
        spin += m * d.cross(u.v - drift);
        if (s.nodes.info[node].kind != NodeKind::dynamic) continue;
        inertia += s.system.inertia[i];
        spin += s.system.inertia[i] * u.w;
    }
    inertia.diagonal().array() += 1e-12 * inertia.trace() + 1e-300;
    const Vec3 w = inertia.inverse() * spin;
    return std::max(0.0, kinetic - 0.5 * mass * drift.squaredNorm() - 0.5 * w.dot(inertia * w));
}

}  // namespace

double may_burst(const Block& block) { return block.mass_ratio >= kUnequal ? 1 : kBurst; }

bool is_guarded(const Block& block) { return block.memory.solved >= kWarmup; }

EnergyGain energy_gain(const Substep& s, const Block& block, double row_work) {
    const double before = kinetic_energy(s, block, s.system.start), after = kinetic_energy(s, block, s.system.exact);
    double work = row_work, mass = 0;  // of everything that is not an ideal joint
    for (uint32_t node : block.nodes) {
        const double m = s.nodes.mass[node].mass;
        const uint32_t i = s.system.at(node);
        const Velocity &v0 = s.system.start[i], &free = s.system.free[i], &v1 = s.system.exact[i];
        mass += m;
        work += 0.5 * m * (free.v - v0.v).dot(v0.v + v1.v);
        if (s.nodes.info[node].kind == NodeKind::dynamic)
            work += 0.5 * (s.system.inertia[i] * (free.w - v0.w)).dot(v0.w + v1.w);
    }
    const double h = s.system.scheme.h, internal = internal_energy(s, block, after);
    const double fall = 0.5 * mass * s.settings.gravity_squared * h * h, scale = before + std::abs(work) + fall;
    return {after - before - work, 0.05 * internal + 1e-4 * (240 * h) * (240 * h) * scale, fall};
}

void guard_energy(Substep& s, Block& block, const EnergyGain& gained) {
    BlockMemory& memory = block.memory;
    if (memory.guard_left > 0) --memory.guard_left;
    if (memory.since_trip < 1u << 30) ++memory.since_trip;
    if (!is_guarded(block)) return;
    memory.excess_energy = std::max(0.0, 0.9 * memory.excess_energy + gained.gain);
    const bool unequal = block.mass_ratio >= kUnequal;
    // A body alone has no motion within, and adaptive damping takes what bursts of itself.
    if (!unequal && (block.nodes.size() == 1 || s.settings.adaptive_damping)) return;
    if (!(memory.excess_energy > (unequal ? 1 : kPatience) * gained.allowed)) return;
    ++s.report.guard_trips;
    // Not of like masses: a ragdoll's burst would double the substeps of the heap that it lies in.
    if (unequal && memory.since_trip < kGuardSubsteps) memory.escalated = true;
    memory.since_trip = 0;
    memory.guard_left = kGuardSubsteps;
}

}  // namespace taut
