#include "linear/sparse_block_ldlt.h"

#include <algorithm>

namespace taut {
namespace {

constexpr uint32_t kNoParent = ~0u;

}  // namespace

SparseBlockLdlt::SparseBlockLdlt(Memory& memory)
    : unknown_(memory),
      links_(memory),
      order_(memory),
      position_(memory),
      parent_(memory),
      column_begin_(memory),
      column_(memory),
      pivot_(memory),
      panel_of_(memory),
      panel_(memory),
      update_(memory),
      run_(memory),
      row_(memory),
      sign_(memory),
      entry_(memory),
      number_(memory),
      kept_(memory),
      value_(memory),
      inverse_(memory),
      scratch_(memory),
      work_(memory) {}

void SparseBlockLdlt::begin(uint32_t unknowns) {
    analysed_ = false;
    unknown_.assign(unknowns, Unknown{});
    links_.clear();
}

void SparseBlockLdlt::set_unknown(uint32_t i, int size, bool multiplier, int rows) {
    unknown_[i] = {static_cast<uint8_t>(size), multiplier, static_cast<uint8_t>(std::min(rows, size))};
}

void SparseBlockLdlt::link(uint32_t i, uint32_t j) {
    if (i != j) links_.push_back(static_cast<uint64_t>(std::min(i, j)) << 32 | std::max(i, j));
}

void SparseBlockLdlt::analyse(std::span<const uint32_t> order) {
    if (order.empty()) {
        const EliminationOrder elimination(*unknown_.get_allocator().memory, unknown_, links_);
        order_by_tree(elimination.order);
    } else {
        order_by_tree(order);
    }
    find_columns();
    find_panels();
    find_updates();
    find_entries();
    analysed_ = true;
}

double SparseBlockLdlt::cost(double most) {
    const EliminationOrder elimination(*unknown_.get_allocator().memory, unknown_, links_, most);
    if (!elimination.is_found()) return std::numeric_limits<double>::infinity();
    order_by_tree(elimination.order);
    return find_columns(most);
}

void SparseBlockLdlt::order_by_tree(std::span<const uint32_t> order) {
    order_.assign(order.begin(), order.end());
    position_.resize(unknowns());
    for (uint32_t k = 0; k < unknowns(); ++k) position_[order_[k]] = k;
    find_parents();
    sort_by_tree();
}

// Links by the later of their two ends, and from them the elimination tree (Liu 1990).
void SparseBlockLdlt::find_parents() {
    Array<uint64_t> later(links_.get_allocator());
    for (uint64_t link : links_) {
        const uint32_t i = position_[link >> 32], j = position_[static_cast<uint32_t>(link)];
        later.push_back(static_cast<uint64_t>(std::max(i, j)) << 32 | std::min(i, j));
    }
    std::sort(later.begin(), later.end());
    parent_.assign(unknowns(), kNoParent);
    Array<uint32_t> top(parent_);  // known so far, to skip what lies between
    for (uint64_t link : later) {
        const auto end = static_cast<uint32_t>(link >> 32);
        for (auto i = static_cast<uint32_t>(link); i != end && i != kNoParent;) {
            const uint32_t next = top[i];
            top[i] = end;
            if (next == kNoParent) parent_[i] = end;
            i = next;
        }
    }
}

// Children right before their parents, which leaves L as it is and lets pivots with the same rows follow each other.
void SparseBlockLdlt::sort_by_tree() {
    const uint32_t n = unknowns();
    Array<uint32_t> size(n, 1, order_.get_allocator());  // of the tree under each
    Array<uint32_t> at(n, 0, order_.get_allocator());    // where each goes
    Array<uint32_t> room(at);                            // end of what is left for its children
    for (uint32_t k = 0; k < n; ++k)
        if (parent_[k] != kNoParent) size[parent_[k]] += size[k];
    uint32_t roots = n;
    for (uint32_t k = n; k-- > 0;) {
        uint32_t& end = parent_[k] == kNoParent ? roots : room[parent_[k]];
        at[k] = room[k] = end - 1;
        end -= size[k];
    }
    const Array<uint32_t> parent(parent_);
    for (uint32_t k = 0; k < n; ++k) {
        parent_[at[k]] = parent[k] == kNoParent ? kNoParent : at[parent[k]];
        position_[order_[k]] = at[k];
    }
    for (uint32_t i = 0; i < n; ++i) order_[position_[i]] = i;
}

// Each column: its links and the columns of its children. What a factor costs; infinite, and not all of them, where
// that is more than so much.
double SparseBlockLdlt::find_columns(double most) {
    const uint32_t n = unknowns();
    Array<uint64_t> earlier(links_.get_allocator());
    for (uint64_t link : links_) {
        const uint32_t i = position_[link >> 32], j = position_[static_cast<uint32_t>(link)];
        earlier.push_back(static_cast<uint64_t>(std::min(i, j)) << 32 | std::max(i, j));
    }
    std::sort(earlier.begin(), earlier.end());
    Array<uint32_t> child(n, kNoParent, order_.get_allocator()), sibling(child), seen(child);
    column_begin_.assign(1, 0);
    column_.clear();
    pivot_.assign(1, 0);
    auto link = earlier.begin();
    double cost = 0;
    for (uint32_t k = 0; k < n && cost <= most; ++k) {
        double below = 0;
        auto take = [&](uint32_t row) {
            if (row == k || seen[row] == k) return;
            seen[row] = k;
            below += unknown_[order_[row]].size;
            column_.push_back(row);
        };
        for (; link != earlier.end() && *link >> 32 == k; ++link) take(static_cast<uint32_t>(*link));
        for (uint32_t c = child[k]; c != kNoParent; c = sibling[c])
            for (uint32_t p = column_begin_[c]; p < column_begin_[c + 1]; ++p) take(column_[p]);
        std::sort(column_.begin() + column_begin_[k], column_.end());
        column_begin_.push_back(static_cast<uint32_t>(column_.size()));
        pivot_.push_back(pivot_.back() + triples(order_[k]));
        cost += elimination_cost(unknown_[order_[k]].size, below);
        if (parent_[k] == kNoParent) continue;
        sibling[k] = child[parent_[k]];
        child[parent_[k]] = k;
    }
    blocks_ = static_cast<uint32_t>(column_.size());
    return cost <= most ? cost : std::numeric_limits<double>::infinity();
}

// A column's rows are among its parent and the parent's rows: as many are the same ones.
void SparseBlockLdlt::find_panels() {
    const uint32_t n = unknowns();
    panel_.clear();
    panel_of_.clear();
    row_.clear();
    size_t values = 0, largest = 0;
    for (uint32_t k = 0, first = 0; k < n; ++k) {
        const uint32_t begin = column_begin_[k], end = column_begin_[k + 1];
        if (parent_[k] == k + 1 && end - begin == 1 + column_begin_[k + 2] - end) continue;
        Panel panel = {pivot_[first], pivot_[k + 1] - pivot_[first], static_cast<uint32_t>(row_.size()), 0, 0, 0,
                       values};
        for (uint32_t p = pivot_[first]; p < pivot_[k + 1]; ++p) row_.push_back(p);
        for (uint32_t p = begin; p < end; ++p)
            for (uint32_t row = pivot_[column_[p]]; row < pivot_[column_[p] + 1]; ++row) row_.push_back(row);
        panel.rows = static_cast<uint32_t>(row_.size()) - panel.row_begin;
        panel_of_.resize(pivot_[k + 1], static_cast<uint32_t>(panel_.size()));
        panel_.push_back(panel);
        const size_t size = 3 * panel.pivots * panel.ld();
        values += size;
        largest = std::max(largest, size);
        first = k + 1;
    }
    value_.assign(values + kPanelPadding, 0);
    scratch_.assign(largest + kPanelPadding, 0);
    inverse_.resize(9 * pivot_.back());
    work_.assign(4 * pivot_.back(), 0);
    sign_.clear();
    for (uint32_t i : order_) sign_.resize(sign_.size() + triples(i), unknown_[i].multiplier ? -1.0 : 1.0);
}

void SparseBlockLdlt::find_updates() {
    update_.clear();
    run_.clear();
    for (Panel& p : panel_) {
        const uint32_t* row = &row_[p.row_begin];
        p.update_begin = static_cast<uint32_t>(update_.size());
        for (uint32_t begin = p.pivots, end; begin < p.rows; begin = end) {
            const uint32_t to = panel_of_[row[begin]];
            for (end = begin; end < p.rows && panel_of_[row[end]] == to;) ++end;
            const auto first_run = static_cast<uint32_t>(run_.size());
            const uint32_t* target = &row_[panel_[to].row_begin];
            for (uint32_t i = begin, t = 0; i < p.rows; ++i, ++t) {
                const uint32_t expected = t;
                while (target[t] != row[i]) ++t;
                if (i > begin && t == expected)
                    ++run_.back().end;
                else
                    run_.push_back({i, i + 1, t});
            }
            update_.push_back({to, begin, end, first_run, static_cast<uint32_t>(run_.size())});
        }
        p.update_end = static_cast<uint32_t>(update_.size());
    }
}

void SparseBlockLdlt::find_entries() {
    Array<uint64_t> keys(links_.get_allocator());
    for (uint64_t k = 0; k < unknowns(); ++k) keys.push_back(k << 32 | k);
    for (uint64_t link : links_) {
        const uint32_t i = position_[link >> 32], j = position_[static_cast<uint32_t>(link)];
        keys.push_back(static_cast<uint64_t>(std::min(i, j)) << 32 | std::max(i, j));
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    entry_.clear();
    uint32_t numbers = 0;
    for (uint64_t key : keys) {
        const uint32_t column = pivot_[key >> 32], row = pivot_[static_cast<uint32_t>(key)];
        const Panel& p = panel_[panel_of_[column]];
        const auto begin = row_.begin() + p.row_begin;
        const auto at = static_cast<size_t>(std::lower_bound(begin, begin + p.rows, row) - begin);
        const uint8_t columns = unknown_[order_[key >> 32]].size,
                      rows = unknown_[order_[static_cast<uint32_t>(key)]].size;
        entry_.push_back({key, p.value + 3 * (column - p.first) * p.ld() + 3 * at, static_cast<uint32_t>(p.ld()),
                          numbers, rows, columns});
        numbers += static_cast<uint32_t>(rows * columns);
    }
    number_.assign(numbers, 0);
    kept_.assign(numbers, 0);  // here, so that solving allocates nothing
}

BlockPlace SparseBlockLdlt::place(uint32_t i, uint32_t j) const {
    const uint64_t from = position_[j], to = position_[i];
    const uint64_t key = std::min(from, to) << 32 | std::max(from, to);
    const auto at = std::lower_bound(entry_.begin(), entry_.end(), key,
                                     [](const Entry& e, uint64_t wanted) { return e.key < wanted; });
    return {at->begin, at->rows, to < from};
}

void SparseBlockLdlt::add(BlockPlace at, const BlockPiece& piece) {
    const size_t height = at.height;
    const auto row = static_cast<size_t>(piece.row), column = static_cast<size_t>(piece.column);
    double* to = &number_[at.begin + (at.mirrored ? row * height + column : column * height + row)];
    const size_t down = at.mirrored ? height : 1, right = at.mirrored ? 1 : height;
    auto sum = [&](size_t columns) {  // a known width is unrolled
        const double* m = piece.m;
        for (int r = 0; r < piece.rows; ++r, m += piece.ld, to += down)
            for (size_t c = 0; c < columns; ++c) to[c * right] += piece.weight * m[c];
    };
    piece.columns == 3 ? sum(3) : piece.columns == 6 ? sum(6) : sum(static_cast<size_t>(piece.columns));
}

void SparseBlockLdlt::read(uint32_t i, double* out) const {
    const BlockPlace at = place(i, i);
    const auto size = static_cast<size_t>(unknown_[i].size);
    for (size_t r = 0; r < size; ++r)
        for (size_t c = 0; c < size; ++c) out[r * size + c] = number_[at.begin + c * at.height + r];
}

// Entries to where they are eliminated, zeros to where L fills in.
void SparseBlockLdlt::load() {
    std::fill(value_.begin(), value_.end(), 0.0);
    const auto copy = [](const Entry& e, const double* from, double* to, size_t rows) {  // known rows are unrolled
        for (int c = 0; c < e.columns; ++c, from += rows, to += e.ld) std::copy_n(from, rows, to);
    };
    for (const Entry& e : entry_) {
        const double* from = &number_[e.begin];
        double* to = &value_[e.value];
        e.rows == 3 ? copy(e, from, to, 3) : copy(e, from, to, 6);
    }
}

bool SparseBlockLdlt::factor(const PanelKernels& kernels) {
    load();
    return kernels.factor(matrix());
}

PanelMatrix SparseBlockLdlt::matrix() const {
    return {panel_.data(),  panel_.data() + panel_.size(),
            update_.data(), run_.data(),
            row_.data(),    sign_.data(),
            value_.data(),  inverse_.data(),
            scratch_.data()};
}

void SparseBlockLdlt::solve(double* x, const PanelKernels& kernels) const {
    auto triples_of = [&](uint32_t i, auto visit) {  // in x and in the order of elimination
        for (uint32_t t = 0; t < triples(i); ++t) visit(x + 6 * i + 3 * t, &work_[4 * (pivot_[position_[i]] + t)]);
    };
    auto copy = [](const double* from, double* to) {
        for (int r = 0; r < 3; ++r) to[r] = from[r];
    };
    for (uint32_t i = 0; i < unknowns(); ++i)
        triples_of(i, [&](const double* outer, double* inner) { copy(outer, inner), inner[3] = 0; });
    kernels.solve(matrix(), work_.data());
    for (uint32_t i = 0; i < unknowns(); ++i) {
        std::fill_n(x + 6 * i + 3, 3, 0.0);
        triples_of(i, [&](double* outer, const double* inner) { copy(inner, outer); });
    }
}

}  // namespace taut
