#include "solvers/active_set.h"

#include <algorithm>
#include <cmath>

#include "solvers/restitution.h"
#include "system/axis_rows.h"

namespace taut {
namespace {

// c of a contact over its k, at most, and times the block's mass ratio: a load of r times a row's own mass sinks in as
// c r. Stiffer holds heavier loads over edges (measured: 1e-3 sinks 10 mm at 10000:1), as long as a manifold keeps its
// points; see collision/manifold.h, add_beside. Under a press of 10 MN one light body in three sank in with 3e-5.
constexpr double kSoftness = 1e-5, kSoftnessByRatio = 1e-2;
constexpr double kSpeculative = 5e-4;  // [m] wider gaps, and any that did not push, are not resting contacts
constexpr double kClosing = 1e-9;      // [m]
// Share by which a sliding contact's c may miss |v| / (friction * push) after a round. The push on a light link of a
// loaded cable changes tenfold from substep to substep; with c of the last one, cables slide at a third of
// Coulomb's force.
constexpr double kSlipMiss = 0.1;

using Kind = BoundedRow::Kind;

}  // namespace

double ActiveSet::speed(const BoundedRow& row, const Array<Velocity>& velocity) const {
    double v = 0;
    const double* j = row.jacobian;
    for (int n = 0; n < row.nodes; ++n, j += row.stride) {
        if (row.place[n] == kNone) continue;
        const Velocity& u = velocity[sys_.at(b_.nodes[row.place[n]])];
        const double linear = row.begin > 0 ? 0.0 : j[0] * u.v[0] + j[1] * u.v[1] + j[2] * u.v[2];
        v += linear + j[3] * u.w[0] + j[4] * u.w[1] + j[5] * u.w[2];
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
    r.begin = 3;
    double whole = 0;
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t node = block.node[n];
        const double* j = r.jacobian + static_cast<size_t>(n) * r.stride;
        r.place[n] = sys_.place[node];
        if (j[0] != 0 || j[1] != 0 || j[2] != 0) r.begin = 0;
        r.k += inverse_mass_along(sys_.sweep[node], j);
        whole += unlocked_along(sys_.sweep[node], j);
        if (r.place[n] != kNone) continue;
        r.known += sign * along(j, sys_.exact[node]);
    }
    if (!(r.k > 0)) r.k = whole;  // of one that locks leave nothing: it pushes against what does not yield
    r.least = r.c = softness * r.k;
    return r;
}

// Whether a friction may hold at all: without a coefficient it has no bound to hold within, however little it slips.
bool ActiveSet::loaded(const BoundedRow& lead) const {
    bool any = false;
    for (uint32_t k = 0; k < lead.loads; ++k) any = any || rows()[lead.load + kContactRows * k].on;
    return any && lead.limit > 0;
}

// How fast the tangents of a lead miss what friction drives them to.
double ActiveSet::slide(const BoundedRow& lead, const Array<Velocity>& velocity) const {
    double squared = 0;
    for (const BoundedRow* r = &lead; r < &lead + lead.width; ++r) {
        const double miss = speed(*r, velocity) - r->target;
        squared += miss * miss;
    }
    return std::sqrt(squared);
}

// A new contact starts out sliding, at the force that stops its approach: c = |vt| / (friction * that force).
void ActiveSet::begin_slip(BoundedRow& lead) {
    const double at_rest = 0.25 * sys_.scheme.h * std::sqrt(s_.settings.gravity_squared);
    double push = 0;
    for (uint32_t k = 0; k < lead.loads; ++k) {
        const BoundedRow& normal = rows()[lead.load + kContactRows * k];
        const double approach = std::max(0.0, -speed(normal, sys_.free));
        if (normal.on) push += std::max(0.0, normal.mu) + std::max(approach, at_rest) / normal.k;
    }
    *lead.slip = static_cast<float>(slide(lead, sys_.free) / std::max(1e-30, lead.limit * push));
    for (BoundedRow* r = &lead; r < &lead + lead.width; ++r) r->c = std::max<double>(r->least, *lead.slip);
}

// Makes a row and those after it the tangents of one friction.
void ActiveSet::gather_tangents(BoundedRow& first, uint32_t width, uint32_t load, uint32_t loads, double limit,
                                float& slip) {
    first.width = width;
    first.load = load;
    first.loads = loads;
    first.limit = limit;
    const bool on = loaded(first);
    for (BoundedRow* r = &first; r < &first + width; ++r) {
        r->on = on;
        r->limit = limit;
        r->slip = &slip;
        if (slip > r->least) r->c = slip;
    }
    if (on && slip < 0) begin_slip(first);
}

double ActiveSet::softness() const { return std::min(kSoftness, kSoftnessByRatio / b_.mass_ratio); }

double ActiveSet::rebound_of(const BoundedRow& push, const RowBlock& block) const {
    if (!(block.restitution > 0)) return 0;
    double gained = 0;
    for (int n = 0; n < push.nodes; ++n) {
        const float(&of)[3] = s_.impacts->flight[block.node[n]].gained;
        gained += Vec3::Map(push.jacobian + static_cast<size_t>(n) * push.stride).dot(Vec3(of[0], of[1], of[2]));
    }
    return rebound(s_, block.restitution, push.gap, speed(push, sys_.exact), gained);
}

void ActiveSet::gather_contact(uint32_t index) {
    const RowBlock& block = sys_.rows.block[index];
    const uint32_t first = b_.bounded_count;
    for (int row = 0; row < 3; ++row) {
        BoundedRow& r = add(row == 0 ? Kind::push : Kind::tangent, index, row, 1, softness());
        r.mu = sys_.rows.impulse[block.row + static_cast<uint32_t>(row)];
        if (row > 0) r.target = r.relaxed_target = block.drive[row - 1];
    }
    BoundedRow* r = &rows()[first];
    r[0].gap = sys_.rows.error[block.row];
    r[0].speculative = r[0].gap > (r[0].mu > 0 ? kSpeculative : 0);
    r[0].target =
        r[0].speculative ? -r[0].gap / sys_.scheme.h : std::min(kStopPush, -kStopRate * r[0].gap / sys_.scheme.h);
    r[0].relaxed_target = r[0].speculative ? r[0].target : 0;
    r[0].bounce = rebound_of(r[0], block);
    r[0].on = r[0].gap < 0 || r[0].mu > 0;
    gather_tangents(r[1], 2, first, 1, block.friction, block.contact->slip);
}

// After the points that load it.
void ActiveSet::gather_rolling(uint32_t index) {
    const RowBlock& block = sys_.rows.block[index];
    const uint32_t first = b_.bounded_count, load = first - kContactRows * block.loads;
    for (int row = 0; row < 3; ++row) {
        if (block.arm[row > 0] == 0) continue;
        BoundedRow& r = add(Kind::tangent, index, row, 1, softness());
        r.mu = sys_.rows.impulse[block.row + static_cast<uint32_t>(row)];
    }
    BoundedRow* r = &rows()[first];
    if (block.arm[0] > 0) gather_tangents(*r++, 1, load, block.loads, block.arm[0], *block.spin_slip);
    if (block.arm[1] > 0) gather_tangents(*r, 2, load, block.loads, block.arm[1], block.contact->slip);
}

void ActiveSet::gather() {
    b_.first_bounded = static_cast<uint32_t>(s_.scratch.bounded.size());
    b_.bounded_count = 0;
    for (uint32_t j = 0; j < b_.joints.size() + b_.elements.size(); ++j) gather_axes(b_.first_row_block + j);
    for (uint32_t c = b_.first_contact; c < b_.first_contact + b_.contact_count; ++c) {
        if (sys_.rows.block[c].type->bound == Bound::load)
            gather_rolling(c);
        else
            gather_contact(c);
    }
}

bool ActiveSet::undoes_overlaps() const {
    const auto all = rows();
    return std::any_of(all.begin(), all.end(), [](const BoundedRow& r) { return r.on && r.target > r.relaxed_target; });
}

void ActiveSet::ease(double part) {
    for (BoundedRow& r : rows()) r.target = r.relaxed_target + part * (r.target - r.relaxed_target);
}

void ActiveSet::aim_biased() {
    for (BoundedRow& r : rows()) r.goal = r.target;
}

void ActiveSet::aim_unbiased() {
    for (BoundedRow& r : rows()) r.goal = r.relaxed_target;
}

// Rows that rest keep the impulse they have, mu, in spite of their softness.
void ActiveSet::aim_relaxed() {
    for (BoundedRow& r : rows()) {
        r.goal = r.relaxed_target;
        if (!r.on || !(r.mu > 0)) r.bounce = 0;
        if (r.bounce > 0) r.goal = r.bounce;
        const bool slides = r.kind == Kind::tangent && r.c > r.least;
        if (r.on && r.bounce == 0 && !r.speculative && !r.physical && !slides) r.goal += r.c * r.mu;
    }
}

bool ActiveSet::bounces() const {
    const auto all = rows();
    return std::any_of(all.begin(), all.end(), [](const BoundedRow& r) { return r.bounce > 0; });
}

void ActiveSet::ease_bounces(double part) {
    for (BoundedRow& r : rows())
        if (r.bounce > 0) r.goal = r.relaxed_target + part * (r.bounce - r.relaxed_target);
}

void ActiveSet::take_impulses() {
    for (BoundedRow& r : rows()) {
        if (r.at_limit != 0)
            r.mu = r.at_limit * r.limit;
        else
            r.mu = r.on ? (r.goal - (speed(r, sys_.exact) - r.short_rate)) / r.c : 0.0;
        r.mu += r.short_mu;
    }
}

// Tangents come and go with what loads them.
void ActiveSet::follow_loads() {
    for (BoundedRow& first : rows()) {
        if (first.width == 0 || first.on == loaded(first)) continue;
        for (BoundedRow* r = &first; r < &first + first.width; ++r) {
            r->on = !r->on;
            r->mu = 0;
        }
        if (first.on)
            begin_slip(first);
        else
            *first.slip = -1;
    }
}

bool ActiveSet::revise() {
    bool changed = false;
    for (BoundedRow& r : rows()) {
        if (r.kind == Kind::box) changed = revise_box(r) || changed;
        if (r.kind != Kind::push) continue;
        const bool before = r.on;
        r.on = r.goal - r.rate > (before ? 0.0 : kClosing / sys_.scheme.h);
        r.mu = r.on ? std::max(0.0, r.held) : 0.0;
        changed = changed || r.on != before;
    }
    follow_loads();
    for (BoundedRow& r : rows())
        if (r.width > 0 && r.on) changed = revise_slip(r) || changed;
    return changed;
}

// The impulse that a friction is bound by, and the one that it has.
double ActiveSet::bound_of(const BoundedRow& lead) const {
    double push = 0;
    for (uint32_t k = 0; k < lead.loads; ++k) push += rows()[lead.load + kContactRows * k].mu;
    return lead.limit * push;
}

double ActiveSet::size_of(const BoundedRow& lead) {
    double squared = 0;
    for (const BoundedRow* r = &lead; r < &lead + lead.width; ++r) squared += r->mu * r->mu;
    return std::sqrt(squared);
}

// c of a friction that slides, or begins to, at the push of this round. True if it was far from that. Half of the way
// a round, on a logarithmic scale: push and friction of a light link depend on each other (measured: without, two
// crossing cables of links burst).
bool ActiveSet::revise_slip(BoundedRow& lead) const {
    const double bound = bound_of(lead), excess = std::max(0.0, size_of(lead) - bound);
    const bool slides = lead.c > lead.least;
    if (!(bound > 0) || (!slides && excess < kSlipMiss * bound)) return false;
    const double slip = slide(lead, sys_.exact) + (slides ? 0 : excess * lead.k);
    const double next = std::sqrt(lead.c * std::max(lead.least, slip / bound));
    if (std::abs(next - lead.c) < kSlipMiss * lead.c) return false;
    for (BoundedRow* r = &lead; r < &lead + lead.width; ++r) r->c = std::max(r->least, next);
    return true;
}

// c of a friction in the next substep, and its impulse within its bound.
void ActiveSet::follow_slip(BoundedRow& lead) const {
    const double bound = bound_of(lead), size = size_of(lead), excess = std::max(0.0, size - bound);
    for (BoundedRow* r = &lead; r < &lead + lead.width && excess > 0; ++r) r->mu *= bound / size;
    if (!(bound > 0)) return;  // with c of no push the next push would be without friction
    const bool slid = lead.c > lead.least;
    double next = 0;
    if (slid || excess > 1e-6 * bound) {
        next = std::max(slid ? 0.5 * lead.c : 0, (slide(lead, sys_.kept) + excess * lead.k) / bound);
        if (next <= lead.least) next = 0;
    }
    *lead.slip = static_cast<float>(std::min(next, 1e30));
}

void ActiveSet::store() {
    for (BoundedRow& r : rows()) {
        if (r.kind == Kind::box) r.mu = std::clamp(r.mu, -r.limit, r.limit);
        if (r.kind == Kind::push) r.mu = std::max(0.0, r.mu);
        if (r.width == 0) continue;
        if (r.on && b_.elastic_runs == 0)
            follow_slip(r);
        else
            *r.slip = -1;
    }
    for (BoundedRow& r : rows()) {
        if (r.force)
            *r.force = static_cast<float>(sys_.scheme.force(r.mu));
        else
            sys_.rows.impulse[sys_.rows.block[r.block].row + r.row] = r.mu;
    }
}

double ActiveSet::work() const {
    double sum = 0;
    for (const BoundedRow& r : rows()) sum += r.on ? 0.5 * r.mu * (speed(r, sys_.start) + speed(r, sys_.exact)) : 0.0;
    return sum;
}

double ActiveSet::contact_work() const {
    double sum = 0;
    for (const BoundedRow& r : rows())
        if (r.on && !r.force) sum += 0.5 * r.mu * (speed(r, sys_.free) + speed(r, sys_.exact));
    return sum;
}

void ActiveSet::remember_contacts() {
    for (BoundedRow& r : rows()) {
        r.rate = speed(r, sys_.exact);
        r.held = r.mu;
    }
}

double ActiveSet::mean_contact_work() const {
    double sum = 0;
    for (const BoundedRow& r : rows()) {
        if (!r.on || r.force) continue;
        sum += 0.25 * (r.mu + r.held) * (speed(r, sys_.free) + 0.5 * (speed(r, sys_.exact) + r.rate));
    }
    return sum;
}

}  // namespace taut
