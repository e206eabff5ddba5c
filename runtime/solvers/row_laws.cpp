#include "solvers/row_laws.h"

namespace taut {

using Kind = BoundedRow::Kind;

void bound_impulses(std::span<BoundedRow> rows) {
    for (BoundedRow& r : rows) {
        if (r.kind == Kind::push) r.mu = std::max(0.0, r.mu);
        if (r.kind == Kind::box) r.mu = std::clamp(r.mu, -r.limit, r.limit);
        if (r.kind != Kind::box && !r.physical) r.c = r.least = 0;
    }
    for (BoundedRow& lead : rows) {
        if (lead.width == 0) continue;
        double size = 0;
        for (const BoundedRow* r = &lead; r < &lead + lead.width; ++r) size += r->mu * r->mu;
        const double bound = bound_of(rows, lead), part = size > bound * bound ? bound / std::sqrt(size) : 1;
        for (BoundedRow* r = &lead; r < &lead + lead.width; ++r) r->mu *= part;
    }
}

void note_state(std::span<BoundedRow> rows) {
    for (BoundedRow& r : rows) {
        if (r.kind == Kind::push) r.on = r.mu > 0;
        if (r.kind == Kind::box) r.at_limit = std::abs(r.mu) < r.limit ? 0 : r.mu > 0 ? 1 : -1;
        if (r.width == 0) continue;
        const bool loaded = bound_of(rows, r) > 0;
        for (BoundedRow* t = &r; t < &r + r.width; ++t) t->on = loaded;
    }
}

}  // namespace taut
