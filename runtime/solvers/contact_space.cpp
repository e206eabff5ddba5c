#include "solvers/contact_space.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr double kMiss = 1e-5;  // [m/s]: a micron in a tenth of a second
constexpr uint32_t kMostLawSweeps = 200;

using Kind = BoundedRow::Kind;

}  // namespace

void ContactSpace::make_room() {
    const auto rows = set_.rows();
    of_.built = false;
    of_.row.clear();
    of_.row.reserve(rows.size());
    of_.place_of_row.assign(rows.size(), kNone);
    of_.slot.assign(b_.nodes.size(), kNone);
    of_.pivot.clear();
    for (const BoundedRow& r : rows)
        for (int n = 0; n < r.nodes; ++n)
            if (r.place[n] != kNone) of_.slot[r.place[n]] = 0;
    list_touched();
    const size_t side = SparseBlockLdlt::side_of(of_.pivot.size()), width = (rows.size() + 3) / 4 * 4;
    grow_to(of_.matrix, width * width);
    grow_to(of_.response, side * side);
    grow_to(of_.room, std::max(b_.matrix.cost_of_inverse(of_.pivot).room, side));
    grow_to(of_.rate, width);
    bound_impulses();
}

// Those of the last substep, within what bounds them now.
void ContactSpace::bound_impulses() {
    for (BoundedRow& r : set_.rows()) {
        if (r.kind == Kind::push) r.mu = std::max(0.0, r.mu);
        if (r.kind == Kind::box) r.mu = std::clamp(r.mu, -r.limit, r.limit);
        if (r.kind != Kind::box && !r.physical) r.c = r.least = 0;
    }
    for (BoundedRow& lead : set_.rows()) {
        if (lead.width == 0) continue;
        double size = 0;
        for (const BoundedRow* r = &lead; r < &lead + lead.width; ++r) size += r->mu * r->mu;
        const double bound = bound_of(lead), part = size > bound * bound ? bound / std::sqrt(size) : 1;
        for (BoundedRow* r = &lead; r < &lead + lead.width; ++r) r->mu *= part;
    }
}

// Pivots of the nodes that have a slot.
void ContactSpace::list_touched() {
    of_.pivot.clear();
    for (uint32_t i = 0; i < b_.nodes.size(); ++i)
        for (int t = 0; of_.slot[i] != kNone && t < b_.matrix.size(i) / 3; ++t)
            of_.pivot.push_back(b_.matrix.pivot(i) + static_cast<uint32_t>(t));
    std::sort(of_.pivot.begin(), of_.pivot.end());
    for (uint32_t i = 0; i < b_.nodes.size(); ++i)
        if (of_.slot[i] != kNone)
            of_.slot[i] = static_cast<uint32_t>(
                std::lower_bound(of_.pivot.begin(), of_.pivot.end(), b_.matrix.pivot(i)) - of_.pivot.begin());
}

// act(place among the touched nodes' freedoms, s J of it).
template <class Act>
void ContactSpace::for_entries(const BoundedRow& row, Act&& act) const {
    const double* j = row.jacobian;
    for (int n = 0; n < row.nodes; ++n, j += row.stride) {
        if (row.place[n] == kNone) continue;
        const size_t first = 3 * static_cast<size_t>(of_.slot[row.place[n]]);
        for (int k = row.begin; k < b_.matrix.size(row.place[n]); ++k)
            act(first + static_cast<size_t>(k), row.sign * j[k]);
    }
}

// Whether a row has an impulse, or would have one.
bool ContactSpace::takes(const BoundedRow& row) const {
    if (row.kind == Kind::push) return row.mu != 0 || row.rate < row.goal - kMiss;
    return row.kind == Kind::box;
}

// More rows, where more have a part; false if there are none.
bool ContactSpace::take_in() {
    const auto rows = set_.rows();
    bool any = false;
    const auto mark = [&](uint32_t r) {
        any = any || of_.place_of_row[r] == kNone;
        of_.place_of_row[r] = 0;
    };
    for (uint32_t r = 0; r < rows.size(); ++r)
        if (rows[r].kind != Kind::tangent && takes(rows[r])) mark(r);
    for (uint32_t r = 0; r < rows.size(); ++r) {
        const BoundedRow& lead = rows[r];
        if (lead.width == 0 || !(lead.limit > 0)) continue;
        bool loaded = false;
        for (uint32_t k = 0; k < lead.loads; ++k)
            loaded = loaded || of_.place_of_row[lead.load + kContactRows * k] != kNone;
        for (uint32_t k = 0; loaded && k < lead.width; ++k) mark(r + k);
    }
    if (!any) return false;
    of_.row.clear();
    for (uint32_t r = 0; r < rows.size(); ++r) {
        if (of_.place_of_row[r] == kNone) continue;
        of_.place_of_row[r] = static_cast<uint32_t>(of_.row.size());
        of_.row.push_back(r);
    }
    return true;
}

// Of gases, whose part in A is no entry of it; see block_gas.cpp.
void ContactSpace::yield_to_gas(size_t side) {
    const size_t stride = size_t{b_.matrix.unknowns()} * kDof + 1;
    double* z = of_.room.data();
    for (size_t g = 0; g < b_.gases.size(); ++g) {
        const double* response = &b_.gas_response[g * stride];
        std::fill_n(z, side, 0.0);
        for (uint32_t i = 0; i < b_.nodes.size(); ++i)
            for (int k = 0; of_.slot[i] != kNone && k < b_.matrix.size(i); ++k)
                z[3 * size_t{of_.slot[i]} + static_cast<size_t>(k)] =
                    response[size_t{i} * kDof + static_cast<size_t>(k)];
        for (size_t r = 0; r < 3 * of_.pivot.size(); ++r) {
            const double by = -response[stride - 1] * z[r];
            const double* line = z;
            panel_kernels().add_rows(&of_.response[r * side], side, &line, &by, 1);
        }
    }
}

// D of the rows that are in it.
void ContactSpace::build() {
    std::fill(of_.slot.begin(), of_.slot.end(), kNone);
    for (uint32_t i = 0; i < of_.row.size(); ++i)
        for (int n = 0; n < row(i).nodes; ++n)
            if (row(i).place[n] != kNone) of_.slot[row(i).place[n]] = 0;
    list_touched();
    b_.matrix.inverse(of_.pivot, of_.room.data(), of_.response.data());
    const size_t side = SparseBlockLdlt::side_of(of_.pivot.size());
    yield_to_gas(side);
    double* along = of_.room.data();  // A^-1 J^T of a row
    for (uint32_t j = 0; j < of_.row.size(); ++j) {
        std::fill_n(along, side, 0.0);
        const double* line[kMaxNodes * kDof];
        double weight[kMaxNodes * kDof];
        size_t count = 0;
        for_entries(row(j), [&](size_t at, double jacobian) {
            line[count] = &of_.response[at * side];
            weight[count++] = jacobian;
        });
        panel_kernels().add_rows(along, side, line, weight, count);
        double* out = &of_.matrix[j * ld()];
        for (uint32_t i = 0; i < of_.row.size(); ++i) {
            double sum = 0;
            for_entries(row(i), [&](size_t at, double jacobian) { sum += jacobian * along[at]; });
            out[i] = sum;
        }
        std::fill(out + of_.row.size(), out + ld(), 0.0);
        out[j] += row(j).c;
    }
    of_.built = true;
}

double ContactSpace::bound_of(const BoundedRow& lead) const {
    double push = 0;
    for (uint32_t k = 0; k < lead.loads; ++k) push += set_.rows()[lead.load + kContactRows * k].mu;
    return lead.limit * push;
}

// Impulses of rows that follow each other, and what that does to all.
void ContactSpace::change(uint32_t first, uint32_t count, const double* to) {
    const double* line[kContactRows];
    double by[kContactRows];
    bool any = false;
    for (uint32_t k = 0; k < count; ++k) {
        BoundedRow& r = row(first + k);
        line[k] = &of_.matrix[(first + k) * ld()];
        by[k] = to[k] - r.mu;
        any = any || by[k] != 0;
        r.mu = to[k];
    }
    if (any) panel_kernels().add_rows(of_.rate.data(), ld(), line, by, count);
}

// The most that a row missed its law by [m/s].
double ContactSpace::sweep() {
    double most = 0;
    const auto count = static_cast<uint32_t>(of_.row.size());
    for (uint32_t i = 0, width; i < count; i += width) {
        const BoundedRow& lead = row(i);
        width = std::max<uint32_t>(1, lead.width);
        double stiff = 0, to[kContactRows], size = 0;
        for (uint32_t k = 0; k < width; ++k) stiff = std::max(stiff, diagonal(i + k));
        if (!(stiff > 0)) continue;
        for (uint32_t k = 0; k < width; ++k) to[k] = row(i + k).mu - of_.rate[i + k] / stiff;
        if (lead.kind == Kind::push) to[0] = std::max(0.0, to[0]);
        if (lead.kind == Kind::box) to[0] = std::clamp(to[0], -lead.limit, lead.limit);
        if (lead.kind == Kind::tangent) {
            const double bound = bound_of(lead);
            for (uint32_t k = 0; k < width; ++k) size += to[k] * to[k];
            size = std::sqrt(size);
            for (uint32_t k = 0; k < width && size > bound; ++k) to[k] *= bound / size;
        }
        for (uint32_t k = 0; k < width; ++k) most = std::max(most, stiff * std::abs(to[k] - row(i + k).mu));
        change(i, width, to);
    }
    return most;
}

bool ContactSpace::improve() {
    for (BoundedRow& r : set_.rows()) r.rate = set_.speed(r, sys_.exact);
    if (take_in() || !of_.built) {
        if (of_.row.empty()) return false;
        build();
    }
    for (uint32_t i = 0; i < of_.row.size(); ++i) of_.rate[i] = row(i).rate + row(i).c * row(i).mu - row(i).goal;
    std::fill(of_.rate.begin() + static_cast<ptrdiff_t>(of_.row.size()),
              of_.rate.begin() + static_cast<ptrdiff_t>(ld()), 0.0);
    for (uint32_t sweeps = 0; sweeps < kMostLawSweeps; ++sweeps) {
        ++s_.report.rounds;
        const double miss = sweep();
        if (miss <= kMiss) return sweeps > 0;
    }
    return true;
}

void ContactSpace::note_state() {
    for (BoundedRow& r : set_.rows()) {
        if (r.kind == Kind::push) r.on = r.mu > 0;
        if (r.kind == Kind::box) r.at_limit = std::abs(r.mu) < r.limit ? 0 : r.mu > 0 ? 1 : -1;
        if (r.width == 0) continue;
        const bool loaded = bound_of(r) > 0;
        for (BoundedRow* t = &r; t < &r + r.width; ++t) t->on = loaded;
    }
}

}  // namespace taut
