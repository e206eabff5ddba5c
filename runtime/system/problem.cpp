#include "system/problem.h"

#include <Eigen/LU>
#include <algorithm>

#include "state/nodes.h"

namespace taut {
namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;
constexpr double kUnbounded = 1e300;

// J of a softened row gives way by s h of its own effective mass: c = s k; see soft_contact.h.
double softness_of(const SweepTerms& terms) { return terms.impulse_scale / terms.mass_scale; }

}  // namespace

Problem::Problem(System& system, ProblemMemory& memory, const RowSettings& settings, Phase phase, Rigid rigid)
    : s_(system),
      m_(memory),
      settings_(settings),
      phase_(phase),
      rigid_(rigid),
      contact_(contact_terms(system.scheme.h, system.stretch)),
      joint_(joint_terms(system.scheme.h, system.stretch)) {
    const Rows& rows = s_.rows;
    m_.unit.clear();
    m_.impulse = rows.impulse;
    m_.target.assign(rows.error.size(), 0.0);
    m_.compliance.clear();
    if (!settings_.linear) {
        m_.start.resize(rows.error.size());
        m_.rate.assign(rows.error.size(), 0.0);
    }
    add_units();
    for (Vector& each : m_.vector) each.assign(m_.impulse.size(), 0.0);
    m_.node.resize(s_.pose.size());
    for (NodeVectors& each : m_.node_vector) each.resize(s_.pose.size());
    find_islands();
    find_inverses(Masses::split);
    for (Vector& each : m_.island) each.assign(islands_, 0.0);
}

// ---------------------------------------------------------------- units

void Problem::add_units() {
    const Rows& rows = s_.rows;
    for (uint32_t b = 0; b < rows.block.size(); ++b) {
        const RowBlock& block = rows.block[b];
        if (block.type->bound == Bound::free && !settings_.linear) {
            Pose poses[kMaxNodes];
            for (int n = 0; n < block.type->nodes; ++n) poses[n] = s_.pose[block.node[n]];
            block.type->evaluate(block.data, poses, &m_.start[block.row], nullptr);
        }
        if (block.type->bound == Bound::cone)
            add_contact(b);
        else if (block.type->bound == Bound::load)
            add_rolling(b);
        else
            set_locked(add(b, Unit::Law::free, 0, block.type->rows));
    }
    for (uint32_t b = 0; b < rows.block.size(); ++b)
        if (rows.block[b].axis) add_axes(b);
    if (phase_ == Phase::relax && !settings_.linear) linearise();
    if (phase_ == Phase::relax && rigid_ == Rigid::soft) keep_impulses();
    if (phase_ == Phase::relax && !s_.scheme.is_one_step())  // velocities are no more those of springs' laws
        for (Unit& unit : m_.unit) unit.solved = unit.rigid;
    take_part();
}

void Problem::take_part() {
    if (settings_.part == Part::all) return;
    for (Unit& unit : m_.unit) {
        const bool link = block(unit).type->bound == Bound::free;
        unit.solved = unit.solved && link == (settings_.part == Part::links);
    }
}

// Velocities relax about the positions reached: J u of rigid rows, and of elastic ones rate_0 + J (u - u_0), so that
// what is solved stays as it is.
void Problem::linearise() {
    const bool moved_by = s_.scheme.is_one_step();  // else u is the velocity at the end, and J is as projection left it
    if (moved_by) evaluate();
    for (Unit& unit : m_.unit) {
        if (unit.linear) continue;
        const RowVector reached = miss(unit);
        unit.linear = true;
        if (!unit.rigid && moved_by) of(unit, m_.target) += reached - miss(unit);
    }
}

// Rigid rows that are springs to the solver keep what they bear while velocities relax: r = rate + c (mu - mu_0).
void Problem::keep_impulses() {
    for (const Unit& unit : m_.unit)
        if (unit.rigid) of(unit, m_.target) += matrix(m_.compliance, unit) * of(unit, m_.impulse);
}

Unit& Problem::add(uint32_t block, Unit::Law law, int row, int rows) {
    Unit unit;
    unit.law = law;
    unit.row = static_cast<uint8_t>(row);
    unit.rows = static_cast<uint8_t>(rows);
    unit.block = block;
    unit.first = s_.rows.block[block].row + static_cast<uint32_t>(row);
    unit.matrix = static_cast<uint32_t>(m_.compliance.size());
    m_.compliance.resize(m_.compliance.size() + static_cast<size_t>(rows * rows), 0.0);
    unit.linear = settings_.linear || s_.rows.block[block].type->bound != Bound::free;
    m_.unit.push_back(unit);
    return m_.unit.back();
}

// Of a unit with one law for its rows.
void Problem::set_row(const Unit& unit, double target, double compliance) {
    for (int r = 0; r < unit.rows; ++r) {
        m_.target[unit.first + static_cast<uint32_t>(r)] = target;
        m_.compliance[unit.matrix + static_cast<uint32_t>(r * unit.rows + r)] = compliance;
    }
}

// Rows that a joint locks: elastic by their compliance (eq. 6.44, 6.50), others as the solver takes rigid ones.
void Problem::set_locked(Unit& unit) {
    const RowBlock& joint = block(unit);
    const bool elastic = joint.elastic(0), soft = rigid_ == Rigid::soft;
    unit.rigid = !elastic;
    const RowMatrix own = elastic || !soft ? RowMatrix() : effective(unit);
    const RowMatrix elasticity = elastic ? compliance_of(joint, s_.scheme) : RowMatrix();
    for (int r = 0; r < unit.rows; ++r) {
        const uint32_t at = unit.first + static_cast<uint32_t>(r);
        if (!joint.locked(r)) {
            m_.impulse[at] = 0;  // that of its axes, which have their own
            continue;
        }
        const double error = s_.rows.error[at];
        if (elastic)
            m_.target[at] = -s_.scheme.row_rate(relaxation_of(joint, r)) * error;
        else if (pushes())
            m_.target[at] = soft ? -joint_.bias_rate * error : -settings_.stabilisation * joint_.inv_h * error;
        for (int c = 0; c < unit.rows; ++c) {
            if (!joint.locked(c)) continue;
            double& to = m_.compliance[unit.matrix + static_cast<uint32_t>(c * unit.rows + r)];
            if (elastic)
                to = elasticity(r, c);
            else if (soft)
                to = softness_of(joint_) * own(r, c);
        }
    }
}

// A normal that pushes, softly unless it was hit, and a pair of tangents.
void Problem::add_contact(uint32_t index) {
    const RowBlock& contact = s_.rows.block[index];
    const double gap = s_.rows.error[contact.row];
    const double share = settings_.contact_stabilisation;
    const bool soft = rigid_ == Rigid::soft;
    Unit& normal = add(index, Unit::Law::range, 0, 1);
    normal.high = kUnbounded;
    const double push =
        share > 0 ? -share * contact_.inv_h * gap : std::min<double>(-contact_.bias_rate * gap, contact_.push);
    const double target = gap > 0 ? -gap * contact_.inv_h : pushes() ? push : 0.0;
    const bool gives = pushes() && share == 0 && gap <= 0 && !contact.hits;
    const double give = gives ? softness_of(contact_) : soft ? softness_of(joint_) : 0.0;
    set_row(normal, target, give > 0 ? give * effective(normal)(0, 0) : 0.0);
    Unit& tangents = add(index, Unit::Law::disc, 1, 2);
    tangents.high = contact.friction;
    tangents.load = contact.row;
    tangents.loads = 1;
    set_row(tangents, 0, soft ? softness_of(joint_) * 0.5 * effective(tangents).trace() : 0.0);
    for (uint32_t t = 0; t < 2; ++t) m_.target[tangents.first + t] = contact.drive[t];
}

// Spinning and rolling friction, within arms times the pushes of their contact points.
void Problem::add_rolling(uint32_t index) {
    const RowBlock& rolling = s_.rows.block[index];
    const bool soft = rigid_ == Rigid::soft;
    for (int which = 0; which < 2; ++which) {
        Unit& unit = add(index, which == 0 ? Unit::Law::range : Unit::Law::disc, which, which + 1);
        unit.high = rolling.arm[which];
        unit.low = -unit.high;
        unit.load = rolling.loaded;
        unit.loads = rolling.loads;
        set_row(unit, 0, soft ? softness_of(joint_) * effective(unit).trace() / unit.rows : 0.0);
    }
}

// Stops, drives and frictions of a joint's axes; what the row of the joint has is their sum.
void Problem::add_axes(uint32_t index) {
    const RowBlock& joint = s_.rows.block[index];
    for (int r = 0; r < joint.type->rows; ++r) {
        if (joint.locked(r)) continue;
        const double error = s_.rows.error[joint.row + static_cast<uint32_t>(r)];
        for_each_axis_row(joint, r, error, s_.scheme, [&](AxisRow axis) {
            gear(s_, joint, r, axis);
            Unit& unit = add(index, Unit::Law::range, r, 1);
            unit.first = static_cast<uint32_t>(m_.impulse.size());
            unit.sign = axis.sign;
            unit.high = axis.limit;
            unit.low = axis.stop ? 0 : -axis.limit;
            unit.force = axis.force;
            m_.impulse.push_back(s_.scheme.impulse(static_cast<double>(*axis.force)));
            double target = phase_ == Phase::project ? axis.target : axis.relaxed_target;
            if (axis.stop && !axis.physical && axis.gap <= 0 && pushes())
                target = std::min<double>(contact_.push, -contact_.bias_rate * axis.gap);
            m_.target.push_back(target);
            unit.rigid = axis.compliance == 0;
            const bool soft = rigid_ == Rigid::soft && unit.rigid;
            set_row(unit, target, soft ? softness_of(joint_) * effective(unit)(0, 0) : axis.compliance);
        });
    }
}

// ---------------------------------------------------------------- islands and diagonals

uint32_t Problem::root(uint32_t seat) {
    while (m_.parent[seat] != seat) seat = m_.parent[seat] = m_.parent[m_.parent[seat]];
    return seat;
}

// Of units, numbered in the order of their first ones; seat 0, the world, is that of rows on which nothing moves.
void Problem::find_islands() {
    const auto seats = static_cast<uint32_t>(s_.pose.size());
    m_.parent.resize(seats);
    for (uint32_t i = 0; i < seats; ++i) m_.parent[i] = i;
    m_.count.assign(seats, 0);
    const auto moves = [&](uint32_t seat) { return s_.sweep[seat].mass.inv_mass > 0; };
    const auto join = [&](uint32_t one, uint32_t other) {
        one = root(one), other = root(other);
        m_.parent[std::max(one, other)] = std::min(one, other);
    };
    const auto first_moving = [&](const Unit& unit) {
        const auto ends = nodes(unit);
        const auto at = std::find_if(ends.begin(), ends.end(), moves);
        return at == ends.end() ? 0 : *at;
    };
    for (const Unit& unit : m_.unit)
        for (const uint32_t seat : nodes(unit)) {
            if (!moves(seat)) continue;
            ++m_.count[seat];
            join(first_moving(unit), seat);
        }
    m_.island_of.assign(seats, kNone);
    islands_ = 0;
    for (Unit& unit : m_.unit) {
        uint32_t& island = m_.island_of[root(first_moving(unit))];
        if (island == kNone) island = islands_++;
        unit.island = island;
    }
    m_.seat.clear();
    for (uint32_t seat = 0; seat < seats; ++seat) {
        if (m_.count[seat] == 0) continue;
        m_.seat.push_back(seat);
        m_.island_of[seat] = m_.island_of[root(seat)];
    }
    // Sums over them go by node: seats lie as threads take them.
    std::ranges::sort(m_.seat, {}, [&](uint32_t seat) { return s_.node_at[seat]; });
}

// J W J^T.
RowMatrix Problem::effective(const Unit& unit, Masses masses) const {
    RowMatrix s = RowMatrix::Zero(unit.rows, unit.rows);
    if (masses == Masses::none) return s;
    for (int n = 0; n < block(unit).type->nodes; ++n) {
        const uint32_t seat = block(unit).node[n];
        const auto j = jacobian(unit, n);
        const double parts = masses == Masses::split ? m_.count[seat] : 1;
        for (int r = 0; r < unit.rows; ++r) s.col(r) += parts * (j * response(s_.sweep[seat], j.row(r).transpose()));
    }
    return s;
}

void Problem::find_inverses(Masses masses) {
    m_.inverse.resize(m_.compliance.size());
    for (const Unit& unit : m_.unit) {
        RowMatrix d = effective(unit, masses);
        d.diagonal().array() += 1e-12 * d.trace();
        const bool held = masses != Masses::none && has_locks(unit);
        if (held) soften_locked(unit, d);
        d += matrix(m_.compliance, unit);
        const auto is_idle = [&](int r) {  // it moves nothing
            return held && inverse_mass(unit, r) == 0 && matrix(m_.compliance, unit)(r, r) == 0;
        };
        if (unit.law == Unit::Law::disc) {  // the same along both, so that friction stays opposed to the slip
            const double half = 0.5 * (d(0, 0) + d(1, 1));
            d = (half + hypotenuse(0.5 * (d(0, 0) - d(1, 1)), d(0, 1))) * RowMatrix::Identity(2, 2);
        }
        for (int r = 0; r < unit.rows; ++r) {
            if (is_solved(unit, r) && d(r, r) > 0 && !is_idle(r)) continue;
            d.row(r).setZero();
            d.col(r).setZero();
            d(r, r) = 1;
        }
        Eigen::Map<Eigen::MatrixXd> inverse(&m_.inverse[unit.matrix], unit.rows, unit.rows);
        inverse = d.inverse();
        for (int r = 0; r < unit.rows; ++r)
            if (is_idle(r)) inverse(r, r) = 0;
    }
}

bool Problem::has_locks(const Unit& unit) const {
    return std::ranges::any_of(nodes(unit), [&](uint32_t seat) { return s_.sweep[seat].held(); });
}

double Problem::inverse_mass(const Unit& unit, int r) const {
    double sum = 0;
    for (int n = 0; n < block(unit).type->nodes; ++n)
        sum += inverse_mass_along(s_.sweep[block(unit).node[n]], row_of(s_, block(unit), n, unit.row + r));
    return sum;
}

// Locked axes may leave rows nothing to do, or several the same: their diagonal has a share of what it would be
// without.
void Problem::soften_locked(const Unit& unit, RowMatrix& d) const {
    for (int r = 0; r < unit.rows; ++r) {
        double whole = 0;
        for (int n = 0; n < block(unit).type->nodes; ++n)
            whole += unlocked_along(s_.sweep[block(unit).node[n]], row_of(s_, block(unit), n, unit.row + r));
        d(r, r) += static_cast<double>(kLeastFree) * whole;
    }
}

// ---------------------------------------------------------------- rates and operators

void Problem::evaluate(const Unit& unit) {
    if (unit.linear) return;
    const RowBlock& rows = block(unit);
    Pose poses[kMaxNodes];
    for (int n = 0; n < rows.type->nodes; ++n) {
        const Velocity& u = s_.exact[rows.node[n]];
        const Pose& x = s_.pose[rows.node[n]];
        poses[n] = {x.x + s_.scheme.h * u.v, u.w.isZero(0) ? x.R : Mat3(rotation_from_vector(s_.scheme.h * u.w) * x.R)};
    }
    double c[kMaxRows];
    rows.type->evaluate(rows.data, poses, c, &s_.rows.jacobian[rows.jacobian]);
    for (int r = 0; r < rows.type->rows; ++r) {
        const size_t at = rows.row + static_cast<size_t>(r);
        double moved = c[r] - m_.start[at];
        if (rows.angular(r)) moved -= kTurn * std::round(moved / kTurn);
        m_.rate[at] = moved / s_.scheme.h;
    }
    turn(unit, poses);
}

void Problem::evaluate() {
    uint32_t last = kNone;
    for (const Unit& unit : m_.unit)
        if (std::exchange(last, unit.block) != unit.block && !unit.force) evaluate(unit);
}

RowVector Problem::masked(const Unit& unit, RowVector values) const {
    for (int r = 0; r < unit.rows; ++r)
        if (!is_solved(unit, r)) values[r] = 0;
    return values;
}

RowVector Problem::miss(const Unit& unit) const {
    const RowBlock& rows = block(unit);
    RowVector out = of(unit, m_.target);
    for (int r = 0; r < unit.rows; ++r) {
        const int row = unit.row + r;
        out[r] -=
            unit.sign * (unit.linear ? rate(s_, rows, row, s_.exact) : m_.rate[rows.row + static_cast<size_t>(row)]);
    }
    return masked(unit, out);
}

RowVector Problem::residual(const Unit& unit) const {
    if (!unit.solved) return RowVector::Zero(unit.rows);
    return matrix(m_.compliance, unit) * of(unit, m_.impulse) - miss(unit);
}

void Problem::residual(Vector& r) const {
    for (const Unit& unit : m_.unit) of(unit, r) = residual(unit);
}

void Problem::direction(const Vector& r, Vector& z) const {
    for (const Unit& unit : m_.unit) of(unit, z) = of(unit, m_.impulse) - inverse(unit, of(unit, r));
    project(z);
    for (const Unit& unit : m_.unit) of(unit, z) = of(unit, m_.impulse) - of(unit, z);
}

void Problem::apply_transpose(const Vector& mu, NodeVectors& out) const {
    for (const Unit& unit : m_.unit)
        for (const uint32_t seat : nodes(unit)) out[seat].setZero();
    for (const Unit& unit : m_.unit)
        for (int n = 0; n < block(unit).type->nodes; ++n)
            out[block(unit).node[n]] += unit.sign * (jacobian(unit, n).transpose() * of(unit, mu));
}

void Problem::apply(const NodeVectors& u, Vector& out) const {
    for (const Unit& unit : m_.unit) {
        RowVector sum = RowVector::Zero(unit.rows);
        for (int n = 0; n < block(unit).type->nodes; ++n) {
            const uint32_t seat = block(unit).node[n];
            if (m_.count[seat] > 0) sum += unit.sign * (jacobian(unit, n) * u[seat]);
        }
        of(unit, out) = masked(unit, sum);
    }
}

void Problem::apply_system(const Vector& d, Vector& out) {
    apply_transpose(d, m_.node);
    for (const uint32_t seat : m_.seat) m_.node[seat] = response_of(seat, m_.node[seat]);
    apply(m_.node, out);
    for (const Unit& unit : m_.unit) of(unit, out) += matrix(m_.compliance, unit) * of(unit, d);
}

void Problem::move(uint32_t seat, const NodeVector& change) {
    s_.exact[seat].v += change.head<3>();
    s_.exact[seat].w += change.tail<3>();
}

void Problem::push(const Unit& unit, const RowVector& change) {
    for (int n = 0; n < block(unit).type->nodes; ++n) {
        const uint32_t seat = block(unit).node[n];
        const NodeVector p = unit.sign * (jacobian(unit, n).transpose() * change);
        if (unit.turning != kNone) m_.applied[unit.applied + static_cast<uint32_t>(n)] += p;
        if (m_.count[seat] > 0) move(seat, response_of(seat, p));
    }
}

void Problem::move_to(const Unit& unit, const Vector& mu) {
    push(unit, of(unit, mu) - of(unit, m_.impulse));
    of(unit, m_.impulse) = of(unit, mu);
}

void Problem::move_to(const Vector& mu) {
    for (const Unit& unit : m_.unit) move_to(unit, mu);
}

// ---------------------------------------------------------------- projection

void Problem::project(const Unit& unit, Vector& mu) const {
    if (unit.law == Unit::Law::free) return;
    double load = unit.loads == 0 ? 1 : 0;
    for (uint32_t k = 0; k < unit.loads; ++k) load += mu[unit.load + kContactRows * k];
    if (unit.law == Unit::Law::range) {
        double& at = mu[unit.first];
        at = std::clamp(at, unit.low * load, unit.high * load);
        return;
    }
    double t[2] = {mu[unit.first], mu[unit.first + 1]};
    if (settings_.friction == FrictionModel::box)
        project_box(t, unit.high * load);
    else if (settings_.friction == FrictionModel::cone && unit.loads == 1)
        project_cone(mu[unit.load], t, unit.high);
    else
        project_disc(t, unit.high * load);
    std::copy(t, t + 2, &mu[unit.first]);
}

void Problem::project(Vector& mu) const {
    for (const Unit& unit : m_.unit) project(unit, mu);
}

void Problem::find_forces(Vector& mu) const {
    for (const Unit& unit : m_.unit) of(unit, mu) = unit.solved ? inverse(unit, miss(unit)) : of(unit, m_.impulse);
    project(mu);
}

void Problem::store() {
    Rows& rows = s_.rows;
    std::copy_n(m_.impulse.begin(), rows.impulse.size(), rows.impulse.begin());
    for (const RowBlock& joint : rows.block)
        for (int r = 0; joint.axis && r < joint.type->rows; ++r)
            if (!joint.locked(r)) rows.impulse[joint.row + static_cast<uint32_t>(r)] = 0;
    for (const Unit& unit : m_.unit) {
        if (!unit.force) continue;
        const double impulse = m_.impulse[unit.first];
        *unit.force = static_cast<float>(s_.scheme.force(impulse));
        rows.impulse[block(unit).row + unit.row] += unit.sign * impulse;
    }
    if (phase_ == Phase::relax) return;
    for (const RowBlock& joint : rows.block)
        for (int r = 0; joint.force && r < joint.type->rows; ++r)
            joint.force[r] = s_.scheme.force(rows.impulse[joint.row + static_cast<uint32_t>(r)]);
}

}  // namespace taut
