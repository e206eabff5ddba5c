#include "solvers/active_set.h"

#include <algorithm>
#include <cmath>

#include "system/axis_rows.h"

namespace taut {
namespace {

// c of a contact over its k, in blocks with joints. Stiffer holds heavier loads over edges (measured: 1e-3 sinks 10 mm
// at 10000:1, 3e-5 2.7 mm at 100000:1), as long as a manifold keeps its points; see collision/manifold.h, add_beside.
constexpr double kContactSoftness = 3e-5;
constexpr double kTowerSoftness = 1e-5;  // in towers, at most; a load of r times a row's own mass sinks as c r
constexpr double kAxisSoftness = 1e-6;   // of stops, rigid drives and friction
constexpr double kSpeculative = 5e-4;    // [m] wider gaps are not resting contacts
constexpr double kClosing = 1e-9;        // [m]
constexpr double kAtLimit = 1e-5;        // a box this close to its limit begins there
// Of a tower: share of all impulses that may be of the wrong sign, and what may close unseen [m]. Tighter refuses the
// substeps of an impact, and the change to sweeps is what kicks a tower (measured: of 72 hit by a heavy box 0 fall, 27
// with 0.1 and 1 mm).
constexpr double kAcceptedPull = 0.3;
constexpr double kAcceptedClosing = 5e-3;

using Kind = BoundedRow::Kind;

double length(double x, double y) { return std::sqrt(x * x + y * y); }

}  // namespace

double ActiveSet::speed(const BoundedRow& row, const Array<Velocity>& velocity) const {
    double v = 0;
    const double* j = row.jacobian;
    for (int n = 0; n < row.nodes; ++n, j += row.stride) {
        if (row.place[n] == kNone) continue;
        const Velocity& u = velocity[b_.nodes[row.place[n]] + 1];
        v += j[0] * u.v[0] + j[1] * u.v[1] + j[2] * u.v[2] + j[3] * u.w[0] + j[4] * u.w[1] + j[5] * u.w[2];
    }
    return row.sign * v + row.known;
}

BoundedRow& ActiveSet::add(Kind kind, uint32_t index, int row, double sign, double softness) {
    const RowBlock& block = sys_.rows.block[index];
    BoundedRow& r = s_.scratch.bounded.emplace_back();
    ++b_.bounded_count;
    r.kind = kind;
    r.block = index;
    r.row = static_cast<uint8_t>(row);
    r.sign = sign;
    r.nodes = static_cast<uint8_t>(block.type->nodes);
    r.jacobian = &sys_.rows.jacobian[block.jacobian + static_cast<uint32_t>(row * kDof)];
    r.stride = static_cast<uint32_t>(block.type->rows * kDof);
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t node = block.node[n];
        const double* j = r.jacobian + static_cast<size_t>(n) * r.stride;
        r.place[n] = sys_.place[node];
        r.k += inverse_mass_along(sys_.inverse_mass[node], j);
        if (r.place[n] != kNone) continue;
        const Velocity& u = sys_.exact[node];
        r.known += sign * (Vec3::Map(j).dot(u.v) + Vec3::Map(j + 3).dot(u.w));
    }
    r.least = r.c = softness * r.k;
    return r;
}

void ActiveSet::gather_axes(uint32_t index) {
    const RowBlock& block = sys_.rows.block[index];
    if (!block.axis) return;
    for (int row = 0; row < block.type->rows; ++row) {
        for_each_axis_row(
            block, row, sys_.rows.error[block.row + static_cast<uint32_t>(row)], sys_.h, [&](const AxisRow& axis) {
                BoundedRow& r = add(axis.stop ? Kind::push : Kind::box, index, row, axis.sign, kAxisSoftness);
                r.least = r.c = std::max(r.least, axis.compliance);
                r.physical = axis.physical;
                r.target = axis.target;
                r.relaxed_target = axis.relaxed_target;
                r.limit = axis.limit;
                r.force = axis.force;
                r.mu = sys_.h * *axis.force;
                if (axis.stop) {
                    r.gap = axis.gap;
                    r.speculative = axis.gap > 0;
                    r.on = axis.gap < 0 || r.mu > 0;
                    return;
                }
                r.on = true;
                if (std::abs(r.mu) >= (1 - kAtLimit) * r.limit) r.at_limit = r.mu > 0 ? 1 : -1;
            });
    }
}

// A new contact starts out sliding, at the force that stops its approach: c = |vt| / (friction * that force).
void ActiveSet::begin_slip(BoundedRow* tangents, const BoundedRow& normal) {
    const double approach = std::max(0.0, -speed(normal, sys_.free));
    const double at_rest = 0.25 * sys_.h * std::sqrt(s_.settings.gravity_squared);
    const double push = std::max(0.0, normal.mu) + std::max(approach, at_rest) / normal.k;
    const double slide = length(speed(tangents[0], sys_.free), speed(tangents[1], sys_.free));
    *tangents[0].slip = static_cast<float>(slide / std::max(1e-30, tangents[0].limit * push));
    for (int i = 0; i < 2; ++i) tangents[i].c = std::max<double>(tangents[i].least, *tangents[i].slip);
}

void ActiveSet::gather_contact(uint32_t index) {
    const RowBlock& block = sys_.rows.block[index];
    const double softness = b_.tower ? std::min(kTowerSoftness, 1e-2 / b_.mass_ratio) : kContactSoftness;
    const size_t first = s_.scratch.bounded.size();
    for (int row = 0; row < 3; ++row) {
        BoundedRow& r = add(row == 0 ? Kind::push : Kind::tangent, index, row, 1, softness);
        r.mu = sys_.rows.impulse[block.row + static_cast<uint32_t>(row)];
    }
    BoundedRow* r = s_.scratch.bounded.data() + first;
    r[0].gap = sys_.rows.error[block.row];
    r[0].speculative = r[0].gap > kSpeculative;
    r[0].target = r[0].speculative ? -r[0].gap / sys_.h : std::min(kStopPush, -kStopRate * r[0].gap / sys_.h);
    r[0].relaxed_target = r[0].speculative ? r[0].target : 0;
    r[0].bounce = block.bounce;
    r[0].on = r[0].gap < 0 || r[0].mu > 0;
    for (int i = 1; i < 3; ++i) {
        r[i].on = r[0].on;
        r[i].limit = block.friction;
        r[i].slip = &block.contact->slip;
        if (*r[i].slip > r[i].least) r[i].c = *r[i].slip;
    }
    if (r[0].on && block.contact->slip < 0) begin_slip(r + 1, r[0]);
}

void ActiveSet::gather() {
    b_.first_bounded = static_cast<uint32_t>(s_.scratch.bounded.size());
    b_.bounded_count = 0;
    for (uint32_t j = 0; j < b_.joints.size(); ++j) gather_axes(b_.first_row_block + j);
    for (uint32_t c = 0; c < b_.contact_count; ++c) gather_contact(b_.first_contact + c);
}

void ActiveSet::aim_biased() {
    for (BoundedRow& r : rows()) r.goal = r.target;
}

// Rows that rest keep the impulse they have, mu, in spite of their softness.
void ActiveSet::aim_relaxed(bool with_reference) {
    for (BoundedRow& r : rows()) {
        r.goal = r.relaxed_target;
        if (r.bounce > 0 && r.on && r.mu > 0) r.goal = r.bounce;
        const bool slides = r.kind == Kind::tangent && r.c > r.least;
        if (with_reference && r.on && r.bounce == 0 && !r.speculative && !r.physical && !slides) r.goal += r.c * r.mu;
    }
}

void ActiveSet::take_impulses() {
    for (BoundedRow& r : rows()) {
        if (r.at_limit != 0)
            r.mu = r.at_limit * r.limit;
        else
            r.mu = r.on ? (r.goal - speed(r, sys_.exact)) / r.c : 0.0;
    }
}

void ActiveSet::turn_off(size_t i) {
    auto all = rows();
    all[i].on = false;
    all[i].mu = 0;
    for (size_t t = i + 1; t < all.size() && t <= i + 2 && all[t].kind == Kind::tangent; ++t) {
        all[t].on = false;
        all[t].mu = 0;
        *all[t].slip = -1;
    }
}

// At a limit the row lags behind its goal in the direction of its impulse; once it does not, it holds again.
bool ActiveSet::revise_box(BoundedRow& r) const {
    const int8_t before = r.at_limit;
    if (before == 0 && std::abs(r.mu) > r.limit) r.at_limit = r.mu > 0 ? 1 : -1;
    if (before != 0 && before * (r.goal - r.c * r.mu - speed(r, sys_.exact)) < 0) r.at_limit = 0;
    return r.at_limit != before;
}

bool ActiveSet::revise() {
    bool changed = false;
    auto all = rows();
    for (size_t i = 0; i < all.size(); ++i) {
        BoundedRow& r = all[i];
        if (r.kind == Kind::box) changed = revise_box(r) || changed;
        if (r.kind != Kind::push) continue;
        if (r.on && r.mu < 0) {
            turn_off(i);
            changed = true;
        } else if (!r.on && r.gap + sys_.h * speed(r, sys_.exact) < -kClosing) {
            r.on = true;
            const bool contact = i + 2 < all.size() && all[i + 1].kind == Kind::tangent;
            if (contact) {
                all[i + 1].on = all[i + 2].on = true;
                begin_slip(&all[i + 1], r);
            }
            changed = true;
        }
    }
    return changed;
}

bool ActiveSet::drop_pulling() {
    bool changed = false;
    auto all = rows();
    for (size_t i = 0; i < all.size(); ++i) {
        if (all[i].kind != Kind::push || !all[i].on || all[i].mu >= 0) continue;
        turn_off(i);
        changed = true;
    }
    return changed;
}

bool ActiveSet::acceptable() const {
    double pull = 0, excess = 0, total = 0, closing = 0;
    auto all = rows();
    for (size_t i = 0; i < all.size(); ++i) {
        const BoundedRow& r = all[i];
        if (r.kind != Kind::push) continue;
        if (!r.on) {
            closing = std::max(closing, -(r.gap + sys_.h * speed(r, sys_.exact)));
            continue;
        }
        total += std::abs(r.mu);
        pull += std::max(0.0, -r.mu);
        if (i + 2 < all.size() && all[i + 1].kind == Kind::tangent)
            excess += std::max(0.0, length(all[i + 1].mu, all[i + 2].mu) - all[i + 1].limit * std::max(0.0, r.mu));
    }
    return pull <= kAcceptedPull * total && excess <= kAcceptedPull * total && closing <= kAcceptedClosing;
}

// c of a contact's friction in the next substep, and its impulse within the cone.
void ActiveSet::follow_slip(BoundedRow* tangents, double bound) const {
    const double slide = length(speed(tangents[0], sys_.kept), speed(tangents[1], sys_.kept));
    const double size = length(tangents[0].mu, tangents[1].mu), excess = std::max(0.0, size - bound);
    const bool slid = tangents[0].c > tangents[0].least;
    double next = 0;
    if (slid || excess > 1e-6 * bound) {
        next = std::max(slid ? 0.5 * tangents[0].c : 0, (slide + excess * tangents[0].k) / std::max(1e-30, bound));
        if (next <= tangents[0].least) next = 0;
    }
    *tangents[0].slip = static_cast<float>(std::min(next, 1e30));
    for (int i = 0; i < 2 && excess > 0; ++i) tangents[i].mu *= bound / size;
}

void ActiveSet::store() {
    auto all = rows();
    for (size_t i = 0; i < all.size(); ++i) {
        BoundedRow& r = all[i];
        if (r.kind == Kind::box) r.mu = std::clamp(r.mu, -r.limit, r.limit);
        if (r.kind == Kind::push) r.mu = std::max(0.0, r.mu);
        if (r.kind != Kind::tangent || r.row != 1) continue;
        if (r.on)
            follow_slip(&r, r.limit * all[i - 1].mu);
        else
            *r.slip = -1;
    }
    for (BoundedRow& r : all) {
        if (r.force)
            *r.force = static_cast<float>(r.mu / sys_.h);
        else
            sys_.rows.impulse[sys_.rows.block[r.block].row + r.row] = r.mu;
    }
}

double ActiveSet::work() const {
    double sum = 0;
    for (const BoundedRow& r : rows()) sum += r.on ? 0.5 * r.mu * (speed(r, sys_.start) + speed(r, sys_.exact)) : 0.0;
    return sum;
}

}  // namespace taut
