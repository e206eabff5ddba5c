// Newton's method with line search on blocks with elements in the form of energy, of which a first step is all that
// most substeps need. With u from u_a to u_b, the solution, and what ties and contacts bear as it is in that,
//   E(u) = 1/2 |u - free|_M^2 + t/h W(x_n + h u) + damping + 1/2 (u - s)^T t h K (u - s) - mu . J u
// the step is taken where E falls by as much as Armijo (1966) asks for. Else elements are linearised anew at the part
// of the way where it does, and all is solved again: ties and contacts hold on solutions, not in between. The first u_a
// is the velocity without elements, which moves as the body does.
#include <algorithm>
#include <cmath>

#include "solvers/block_solve.h"

namespace taut {
namespace {

constexpr double kArmijo = 1e-4;     // share of the first slope by which the energy is to fall
constexpr double kSteep = 0.9;       // of the first slope, that the last one may have
constexpr double kRounding = 1e-12;  // of sums of energy
constexpr uint32_t kMostSteps = 16, kMostHalves = 6;
// Of the extent of a folded element, by which what it was linearised to may miss it. One solve of a sheet that a box
// hits errs by its own length at 10 times the sheet's mass (measured: 16 % stretch, 180 % at 100 times).
constexpr double kMissed = 5e-3;
constexpr uint32_t kMostAgain = 3;

}  // namespace

// E at a part p of the way but for W, less that at 0: linear p + square p^2 [J].
struct BlockSolve::Way {
    double linear = 0, square = 0;
    double at(double part) const { return part * (linear + part * square); }
};

BlockSolve::Way BlockSolve::way_of_step(bool with_old) const {
    Way way;
    for (uint32_t i = 0; i < nodes_; ++i) {
        const uint32_t node = b_.nodes[i], seat = sys_.at(node);
        const Vec3 begin = Vec3::Map(way_begin(i)), v = sys_.exact[seat].v - begin;
        way.linear += s_.nodes.mass[node].mass * (begin - sys_.free[seat].v).dot(v);
        way.square += 0.5 * s_.nodes.mass[node].mass * v.squaredNorm();
        if (size_of(i) < 6) continue;
        const Vec3 turn = Vec3::Map(way_begin(i) + 3), w = sys_.exact[seat].w - turn;
        way.linear += (turn - sys_.free[seat].w).dot(sys_.inertia[seat] * w);
        way.square += 0.5 * w.dot(sys_.inertia[seat] * w);
    }
    const auto rate = [&](uint32_t seat, const double* j) {
        const double* begin = way_begin(local(seat));
        const Velocity& u = sys_.exact[seat];
        return Vec3::Map(j).dot(u.v - Vec3::Map(begin)) + Vec3::Map(j + 3).dot(u.w - Vec3::Map(begin + 3));
    };
    for (uint32_t j = 0; j < ties(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r)
            for (int n = 0; row(j).locked(r) && n < row(j).type->nodes; ++n)
                if (local(row(j).node[n]) != kNone)
                    way.linear -= b_.solution[(nodes_ + j) * kDof + static_cast<uint32_t>(r)] *
                                  rate(row(j).node[n], jacobian_of(sys_, row(j), n).row(r).data());
    for (const BoundedRow& bounded : set.rows()) {
        const double* j = bounded.jacobian;
        for (int n = 0; n < bounded.nodes; ++n, j += bounded.stride)
            if (bounded.on && bounded.place[n] != kNone)
                way.linear -= bounded.sign * bounded.mu * rate(sys_.at(b_.nodes[bounded.place[n]]), j);
    }
    if (with_old) add_stiffness_along(way);
    elastic_damping(way.linear, way.square);
    return way;
}

// The matrix has K of the forces before; that of new ones, where they grew, is left out.
void BlockSolve::add_stiffness_along(Way& way) const {
    const bool spare = s_.settings.velocity_filter > 0 && b_.memory.guard_left == 0;
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        if (block.fresh && b_.memory.solved == 0) continue;
        const int width = kDof * block.type->nodes;
        double k[kDof * kMaxNodes * kDof * kMaxNodes], begin[kDof * kMaxNodes] = {}, v[kDof * kMaxNodes] = {};
        stiffness_of(block, block.force, k);
        if (spare) slow_velocities(block, begin);
        for (double& slow : begin) slow = -slow;
        for (int n = 0; n < block.type->nodes; ++n) {
            const uint32_t i = local(block.node[n]);
            if (i == kNone) {
                std::fill_n(begin + kDof * n, kDof, 0.0);
                continue;
            }
            const Velocity& u = sys_.exact[block.node[n]];
            for (int c = 0; c < size_of(i); ++c) {
                const double at = c < 3 ? u.v[c] : u.w[c - 3];
                v[kDof * n + c] = at - way_begin(i)[c];
                begin[kDof * n + c] += way_begin(i)[c];
            }
        }
        for (int a = 0; a < width; ++a)
            for (int b = 0; b < width; ++b) {
                const double kv = sys_.scheme.stiffness() * k[a * width + b] * v[b];
                way.linear += begin[a] * kv;
                way.square += 0.5 * v[a] * kv;
            }
    }
}

// The first of 1, 1/2, 1/4, ... at which the energy has fallen far enough, or the last of them. done: that is the whole
// way, and at its end the energy neither falls nor rises as steeply as at its begin.
double BlockSolve::part_of_step(const Way& way, bool& done) const {
    double slope, last_slope;
    const double begin = elastic_energy(0, &slope), end = elastic_energy(1, &last_slope);
    slope = std::min(0.0, slope + way.linear);
    last_slope += way.linear + 2 * way.square;
    const auto falls = [&](double part, double energy) {
        return way.at(part) + energy - begin <= kArmijo * part * slope + kRounding * (begin + energy);
    };
    const bool whole = falls(1, end);
    done = whole && std::abs(last_slope) <= kSteep * -slope + kRounding * (begin + end);
    if (whole) return 1;
    double part = 0.5;
    for (uint32_t halves = 1; halves < kMostHalves && !falls(part, elastic_energy(part, nullptr)); ++halves)
        part *= 0.5;
    return part;
}

void BlockSolve::begin_way(const Array<Velocity>& at) {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const Velocity& u = at[sys_.at(b_.nodes[i])];
        Vec3::Map(way_begin(i)) = u.v;
        Vec3::Map(way_begin(i) + 3) = u.w;
    }
}

void BlockSolve::begin_still() { std::fill_n(way_begin(0), nodes_ * kDof, 0.0); }

// Back from the solution, which what is solved on the same factor is as far from from now on.
void BlockSolve::go_part(double part) {
    for (size_t i = 0; i < nodes_ * kDof; ++i) {
        const double back = (1 - part) * (way_begin(0)[i] - b_.solution[i]);
        iterate()[i] += back;
        b_.solution[i] += back;
    }
    take_solution();
}

// At the velocity without elements or at none, of which E is lower: by the former nodes may meet what holds them far
// worse than where they are.
void BlockSolve::begin_search(bool with_old) {
    begin_still();
    const double still = elastic_energy(0, nullptr) - way_of_step(with_old).at(1);  // E but for W at the end
    begin_way(sys_.free);
    const double moving = elastic_energy(0, nullptr) - way_of_step(with_old).at(1);
    if (still < moving) begin_still();
}

// At the velocities and elastic forces of the solution; as often as something hits folded elements so hard that they
// are elsewhere than foreseen. What moves freely is foreseen well.
bool BlockSolve::linearise_again(bool with_old) {
    if (!splits() || !b_.gases.empty()) return true;
    for (uint32_t again = 0; again < kMostAgain && linearisation_error() > kMissed; ++again) {
        ++s_.report.resolves;
        take_elastic_forces();
        begin_still();
        relinearise(1);
        assemble(with_old && !(renewed_ && b_.memory.guard_left > 0));
        if (renewed_) add_new_stiffness();
        if (!factor_rounds()) return false;
        take_forces();
    }
    return true;
}

bool BlockSolve::search(bool with_old) {
    if (!has_energy_forms() || !b_.gases.empty()) return true;
    begin_search(with_old);
    for (uint32_t step = 1;; ++step) {
        bool done;
        const double part = part_of_step(way_of_step(with_old), done);
        if (done) return true;
        if (step == kMostSteps) {
            go_part(part);
            return true;
        }
        ++s_.report.resolves;
        relinearise(part);
        go_part(part);
        begin_way(sys_.exact);
        assemble(with_old && !(renewed_ && b_.memory.guard_left > 0));
        if (renewed_) add_new_stiffness();
        if (!factor_rounds()) return false;
        take_forces();
    }
}

}  // namespace taut
