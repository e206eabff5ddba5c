// Minimisation: of each island of deformables the energy of the substep (island_energy.h), by Newton's method with line
// search (minimise.h), in place of rows. Contacts and joints do not come here. In statics it is the energy at rest, and
// the velocity that is found the way there over h.
#include <algorithm>
#include <cmath>

#include "solvers/island_energy.h"

namespace taut {
namespace {

constexpr uint32_t kMostNewtonSteps = 1000;
constexpr double kLongestStep = 1e3;  // of a direction, root mean square [m]: l of Gast and Schroeder 2014, section 3.1

class GroupMinimisation {
public:
    explicit GroupMinimisation(Substep& s) : s_(s), m_(s.scratch.minimisation.get()), h_(s.system.scheme.h) {}

    void run() {
        m_.hold.clear();
        m_.pair.clear();
        if (two_speeds_)
            for (const uint32_t node : s_.group.nodes) s_.system.by_springs[s_.system.at(node)] = {};
        if (asked_.relaxation) hold_still();
        if (s_.system.rows.elastic.empty()) return;
        find_energy_graph(s_.system, s_.nodes, s_.group, m_);
        make_room();
        begin();
        if (m_.obstacles.any()) find_softs();
        for (const EnergyIsland& island : m_.island) {
            IslandEnergy energy(s_, island, asked_.relaxation != nullptr);
            energy.find_damping();
            solve(island, energy);
        }
    }

private:
    // What no element takes anywhere stays. Accelerations by what is not elastic are known from here on.
    void hold_still() {
        for (const uint32_t node : s_.group.nodes) {
            Velocity& u = s_.system.exact[s_.system.at(node)];
            Velocity& start = s_.system.start[s_.system.at(node)];
            start.v = (u.v - start.v) / h_;
            u = {};
        }
    }

    void make_room() {
        const size_t points = m_.seat.size(), blocks = m_.column.size();
        m_.pose.resize(points, {Vec3::Zero(), Mat3::Identity()});
        m_.begin.resize(points);
        m_.led.resize(points);
        m_.scale.resize(points);
        m_.inverse.resize(points);
        if (two_speeds_) m_.pushed.assign(points, Vec3::Zero());
        for (Array<double>* each : {&m_.wanted, &m_.bias, &m_.x, &m_.guess, &m_.slope, &m_.damped, &m_.at})
            each->resize(3 * points);
        m_.hessian.resize(9 * blocks + kBlockPadding);
        const bool damped = std::ranges::any_of(m_.island, [](const EnergyIsland& each) { return each.damped; });
        m_.damping.resize(damped ? 9 * blocks + kBlockPadding : 0);
    }

    void find_softs() {
        const size_t points = m_.seat.size();
        m_.raw.resize(3 * points);
        m_.soft.resize(points);
        m_.touch.resize(points);
        m_.hold_of.resize(points);
        if (m_.obstacles.penalties) m_.penalty.resize(points);
        m_.point_of_node.assign(s_.nodes.slots(), kNone);
        for (uint32_t p = 0; p < points; ++p) {
            const uint32_t node = s_.system.node_at[m_.seat[p]];
            m_.soft[p] = s_.nodes.info[node].soft;
            m_.point_of_node[node] = p;
        }
    }

    // x_n, y and what held points are led by; in statics external forces in place of y.
    void begin() {
        const System& system = s_.system;
        for (uint32_t p = 0; p < m_.seat.size(); ++p) {
            const uint32_t seat = m_.seat[p];
            m_.begin[p] = system.pose[seat].x;
            m_.led[p] = Vec3::Zero();
            m_.scale[p] = 0;
            Vec3 wanted = Vec3::Zero();
            if (!m_.free[p]) {
                m_.led[p] = h_ * system.exact[seat].v;
            } else {
                const double mass = s_.nodes.mass[system.node_at[seat]].mass;
                m_.scale[p] = std::sqrt(mass / system.scheme.stiffness());
                wanted = asked_.relaxation ? Vec3(mass / m_.scale[p] * system.start[seat].v)
                                           : Vec3(m_.scale[p] * h_ * system.exact[seat].v);
            }
            Vec3::Map(&m_.wanted[3 * size_t{p}]) = wanted;
        }
    }

    // The better of two guesses: x_n + h v_n, and what forces as they are at x_n would do; or where it is, if both are
    // beyond all numbers (Gast and Schroeder 2014, section 3.1).
    void guess(const EnergyIsland& island, IslandEnergy& energy, std::span<double> x) {
        const size_t first = 3 * size_t{island.first_point};
        const std::span<double> other(&m_.guess[first], x.size()), slope(&m_.slope[first], x.size());
        const auto energy_at = [&](std::span<double> z) {
            const double value = energy.evaluate(z, {});
            return std::isfinite(value) ? value : std::numeric_limits<double>::infinity();
        };
        std::ranges::fill(x, 0.0);
        if (asked_.relaxation) return;
        const double still = energy.evaluate(x, slope);
        for (uint32_t i = 0; i < island.points; ++i) {
            const uint32_t p = island.first_point + i;
            if (m_.free[p]) Vec3::Map(&x[3 * i]) = m_.scale[p] * h_ * s_.system.start[m_.seat[p]].v;
        }
        std::ranges::transform(slope, other.begin(), [](double g) { return -g; });
        const double moving = energy_at(x), pushed = energy_at(other);
        if (pushed < moving) std::ranges::copy(other, x.begin());
        if (!std::isfinite(std::min(moving, pushed)) && std::isfinite(still)) std::ranges::fill(x, 0.0);
    }

    void solve(const EnergyIsland& island, IslandEnergy& energy) {
        const std::span<double> x(&m_.x[3 * size_t{island.first_point}], energy.size());
        const std::span<double> before(&m_.guess[3 * size_t{island.first_point}], energy.size());
        guess(island, energy, x);
        std::ranges::copy(x, before.begin());
        const double a = s_.system.scheme.stiffness(), unit = std::sqrt(energy.mass() / a);  // of z, over a way [1/m]
        MinimiseSettings settings;
        settings.tolerance = asked_.tolerance * unit;
        settings.longest_step = kLongestStep * unit;
        settings.most_steps = s_.settings.sweeps ? s_.settings.sweeps : kMostNewtonSteps;
        settings.line_search = asked_.line_search;
        if (asked_.relaxation) {
            settings.tolerance = asked_.relaxation->tolerance * a * unit;
            settings.most_steps = asked_.relaxation->most_steps;
        }
        const MinimiseReport done = minimise(energy, x, settings, m_.newton);
        tell(done, unit);
        if (!std::isfinite(done.value)) {
            std::ranges::copy(before, x.begin());
            energy.release();
        }
        const std::span<double> slope(&m_.slope[3 * size_t{island.first_point}], energy.size());
        energy.settle_at(x, slope);
        energy.store_forces();
        if (two_speeds_) find_accelerations(island, energy, slope);
        for (uint32_t i = 0; i < island.points; ++i) {
            const uint32_t p = island.first_point + i, seat = m_.seat[p];
            if (!m_.free[p]) continue;
            s_.system.exact[seat].v = Vec3::Map(&x[3 * i]) / (m_.scale[p] * h_);
            set_sweep_velocity(s_.system.sweep[seat].velocity, s_.system.exact[seat]);
        }
    }

    // What springs and penalties do where the points are now, for v'.
    void find_accelerations(const EnergyIsland& island, const IslandEnergy& energy, std::span<double> slope) {
        const Scheme& scheme = s_.system.scheme;
        const double c = scheme.contact_act(), rest = (h_ - c) * scheme.act / c;
        const auto for_free = [&](auto&& act) {
            for (uint32_t i = 0; i < island.points; ++i) {
                const uint32_t p = island.first_point + i;
                if (m_.free[p]) act(p, -Vec3::Map(&slope[3 * i]) / (m_.scale[p] * scheme.stiffness()));
            }
        };
        std::ranges::fill(slope, 0.0);
        energy.add_springs(slope);
        for_free([&](uint32_t p, const Vec3& a) { s_.system.by_springs[m_.seat[p]].v = a; });
        std::ranges::fill(slope, 0.0);
        energy.add_penalties(slope);
        for_free([&](uint32_t p, const Vec3& a) { m_.pushed[p] = rest * a; });
    }

    void tell(const MinimiseReport& done, double unit) {
        s_.report.solves += done.steps;
        s_.report.rounds += done.iterations;
        if (Relaxation* of = asked_.relaxation) {
            of->steps += done.steps;
            of->residual = std::max(of->residual, done.gradient / (s_.system.scheme.stiffness() * unit));
            of->converged = of->converged && done.converged;
            return;
        }
        if (!done.converged) ++s_.report.unfinished;
        s_.report.residual = std::max(s_.report.residual, done.gradient / (unit * h_));
    }

    Substep& s_;
    MinimisationMemory& m_;
    const double h_;  // [s]
    const bool two_speeds_ = !s_.system.scheme.is_one_step();
    const MinimisationSettings asked_ = s_.settings.minimisation ? *s_.settings.minimisation : MinimisationSettings{};
};

// v' of contacts, and friction, but for statics.
void rub(Substep& s) {
    if (s.settings.minimisation && s.settings.minimisation->relaxation) return;
    if (s.system.rows.elastic.empty()) return;
    MinimisationMemory& m = s.scratch.minimisation.get();
    if (!s.system.scheme.is_one_step())
        for (uint32_t p = 0; p < m.seat.size(); ++p) s.system.exact[m.seat[p]].v += m.pushed[p];
    rub_points(s.system, m);
    rub_penalties(s.system, m);
    rub_solids(s.system, m);
}

}  // namespace

MinimisationMemory& MinimisationHolder::get() {
    if (!made_) made_ = ::new (HostAllocator<MinimisationMemory>(memory_).allocate(1)) MinimisationMemory(memory_);
    return *made_;
}

MinimisationHolder::~MinimisationHolder() {
    if (!made_) return;
    made_->~MinimisationMemory();
    HostAllocator<MinimisationMemory>(memory_).deallocate(made_, 1);
}

const Solver kMinimisation{"minimisation",
                           false,
                           false,
                           [](Substep& s) { GroupMinimisation(s).run(); },
                           nullptr,
                           [](Substep& s) { rub(s); },
                           true};

}  // namespace taut
