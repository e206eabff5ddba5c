// What a block's solution gains of energy, and a solution that gains none where wide gaps are to be closed, or whips
// none where overlaps are to be undone.
#include <algorithm>
#include <cmath>

#include "solvers/block_solve.h"

namespace taut {
namespace {

// Gaps close so fast whatever energy that takes [m/s], [rad/s]; wide ones by so much of themselves [1/s].
constexpr double kClosingSpeed = 0.5, kClosingRate = 5;
// A gap is wide where this would be so little of what the substep asks for: as joints are made open, or a body of a
// mechanism is put elsewhere. Closed within a substep it leaves bodies at gap / h: 1 m is 240 m/s.
constexpr double kWide = 0.1;

// What undoes overlaps moves nothing faster than this, a little more than kStopPush [m/s]. With twice as much, of 200
// chains through which a plate was put 12 still went at more than 15 m/s.
constexpr double kWhip = 3.5;

}  // namespace

// A locked row that works by nothing but closing its gap: no spring, not reeled, not led by a kinematic end.
bool BlockSolve::ideal(const RowBlock& block, int r) const {
    return !block.elastic(r) && block.drift[r] == 0 && known_rate(block, r) == 0;
}

// Work of the locked rows that are not ideal, at the mean of the velocities before and after [J].
double BlockSolve::tie_work() const {
    double sum = 0;
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        for (int r = 0; r < block.type->rows; ++r) {
            if (!block.locked(r) || ideal(block, r)) continue;
            double rate = 0;
            for (int n = 0; n < block.type->nodes; ++n) {
                if (local(block.node[n]) == kNone) continue;
                const Velocity &v0 = sys_.start[block.node[n]], &v1 = sys_.exact[block.node[n]];
                rate += 0.5 * along(row_of(sys_, block, n, r), {v0.v + v1.v, v0.w + v1.w});
            }
            sum += b_.solution[(nodes_ + j) * kDof + static_cast<uint32_t>(r)] * rate;
        }
    }
    return sum;
}

// Kinetic energy of the difference of two sets of velocities.
double BlockSolve::energy_between(const Array<Velocity>& a, const Array<Velocity>& b) const {
    double sum = 0;
    for (uint32_t node : b_.nodes) {
        const uint32_t i = sys_.at(node);
        const Vec3 v = a[i].v - b[i].v, w = a[i].w - b[i].w;
        sum += 0.5 * s_.nodes.mass[node].mass * v.squaredNorm();
        if (s_.nodes.info[node].kind == NodeKind::dynamic) sum += 0.5 * w.dot(sys_.inertia[i] * w);
    }
    return sum;
}

// The largest part of the joints' gaps, 0 to 1, that closes slowly.
double BlockSolve::slow_closing() const {
    double part = 1;
    for (uint32_t j = 0; j < ties(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r) {
            if (!row(j).locked(r) || !ideal(row(j), r)) continue;
            const double gap = std::abs(error_of(row(j), r)), slow = std::max(kClosingSpeed, kClosingRate * gap);
            const double speed = sys_.scheme.row_rate(relaxation_of(row(j), r)) * gap;
            if (speed > slow) part = std::min(part, slow / speed);
        }
    return part;
}

void BlockSolve::solve_closing(double part) {
    b_.closing = part;
    solve_known();
    gained_ = energy_gain(s_, b_, set.work() + tie_work() + elastic_work());
}

// Where a solution that closes wide gaps gains energy, solves on the same factor for one that does not: first without
// the slow velocity, then closing only as much of the gaps as makes none, though not more slowly than slow_closing().
// Where a slack chain snaps taut, light links turn by radians in a substep and their straight steps open the joints; a
// heavy weight that is pulled in by as much within the next substep comes back faster than it went. Velocities are
// linear in the part a of the gaps that is closed, and with q the energy of their difference between a = 0 and a = 1
//   gain(a) = gain(0) + (gain(1) - gain(0) - q) a + q a^2
void BlockSolve::limit_gain() {
    if (ties() == 0) return;
    const double slow = slow_closing();
    const bool wide = slow < kWide * b_.closing;
    if (!is_guarded(b_) && !wide) return;
    gained_ = energy_gain(s_, b_, set.work() + tie_work() + elastic_work());
    const double most = wide ? 1 : may_burst(b_);
    if (!gained_.excessive(most) || slow >= b_.closing) return;
    const EnergyGain first = gained_;  // what the guard hears of
    relaxed_ = false;
    std::fill_n(b_.known.begin(), nodes_ * kDof, 0.0);  // of nodes
    solve_closing(b_.closing);
    if (gained_.excessive(most)) {
        const double tried = b_.closing, whole = gained_.gain;
        copy_velocities(sys_, b_, sys_.exact, sys_.kept);
        solve_closing(0);
        const double none = std::min(0.0, gained_.gain), q = energy_between(sys_.kept, sys_.exact);
        const double slope = whole - none - q, root = std::sqrt(slope * slope - 4 * q * none);
        solve_closing(std::clamp(q > 0 ? tried * (root - slope) / (2 * q) : tried, slow, tried));
    }
    gained_ = first;
    take_forces();
}

// The most that a node's velocities differ by [m/s].
double BlockSolve::fastest_between(const Array<Velocity>& a, const Array<Velocity>& b) const {
    double most = 0;
    for (uint32_t node : b_.nodes) {
        const uint32_t i = sys_.at(node);
        most = std::max(most, (a[i].v - b[i].v).squaredNorm());
    }
    return std::sqrt(most);
}

// Where joints nearly set the pushes of overlaps against each other, as of a ragdoll that a plate was put into, what
// obeys them all whips the bodies between: at 20 to 250 m/s for pushes of 3. Solutions on the same factor are linear in
// the part of the push that they are asked for, and one without it tells how much of it is too much.
void BlockSolve::limit_push() {
    if (!set.undoes_overlaps() || fastest_between(sys_.exact, sys_.free) <= kWhip) return;
    copy_velocities(sys_, b_, sys_.exact, sys_.kept);
    set.aim_unbiased();
    solve_known();
    const double whip = fastest_between(sys_.kept, sys_.exact);
    if (whip > kWhip) set.ease(kWhip / whip);
    set.aim_biased();
    solve_known();
}

// Restitution says how fast each contact parts, whatever its neighbours, joints and friction make of that: together
// they may leave with more energy than they met with. Velocities and impulses are linear in the part t of the bounces,
// and the contacts' work is w(t) = w(0) + b t + a t^2 [J]: the largest part that makes it none.
void BlockSolve::limit_bounce() {
    if (!set.bounces()) return;
    const double whole = set.contact_work();
    if (!(whole > 0)) return;
    set.remember_contacts();
    set.ease_bounces(0);
    solve_known();
    const double none = set.contact_work(), a = 2 * (whole + none - 2 * set.mean_contact_work()), b = whole - none - a;
    double low = 0, high = 1;
    for (int i = 0; i < 50 && none < 0; ++i) {
        const double t = 0.5 * (low + high);
        (none + t * (b + t * a) > 0 ? high : low) = t;
    }
    set.ease_bounces(low);
    solve_known();
}

}  // namespace taut
