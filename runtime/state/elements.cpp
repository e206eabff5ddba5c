#include "state/elements.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "constraints/soft_contact.h"

namespace taut {
namespace {

// act(column, entries an element) for each column.
template <class Act>
void for_columns(ElementSet& of, Act&& act) {
    const ConstraintType& row = of.type->row;
    const auto rows = static_cast<uint32_t>(row.rows);
    act(of.node, static_cast<uint32_t>(row.nodes));
    act(of.data, static_cast<uint32_t>(of.type->numbers));
    act(of.softness, 1u);
    act(of.lambda, rows);
    act(of.drift, rows);
    act(of.slow_turn, row.line ? 1u : 0u);
    act(of.loaded, 1u);
    act(of.need, 1u);
    act(of.fresh, 1u);
    act(of.memory, of.pulls ? 1u : 0u);
}

}  // namespace

void set_compliance(ElementSet& set, std::span<const double> compliance, double relaxation) {
    const int rows = set.type->row.rows;
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMaxRows>;
    using Block = Eigen::Map<Matrix>;
    std::copy(compliance.begin(), compliance.end(), set.compliance);
    const Block c(set.compliance, rows, rows);
    set.coupled = c != c(0, 0) * Matrix::Identity(rows, rows);
    if (c(0, 0) > 0)
        Block(set.stiffness, rows, rows) = c.inverse();
    else
        std::fill(set.stiffness, set.stiffness + rows * rows, 0.0);
    set.relaxation = relaxation;
    if (!set.pulls) return;
    set.stop = {};
    set.stop.mode = AxisMode::limited;
    set.stop.lower = -std::numeric_limits<float>::infinity();
    set.stop.limit_compliance = static_cast<float>(c(0, 0));
    set.stop.limit_damping = static_cast<float>(c(0, 0) > 0 ? relaxation / c(0, 0) : 0);
}

void set_compliance(ElementSet& set, double compliance, double relaxation) {
    const int rows = set.type->row.rows;
    double block[kMaxRows * kMaxRows] = {};
    for (int r = 0; r < rows; ++r) block[r * rows + r] = compliance;
    set_compliance(set, {block, static_cast<size_t>(rows * rows)}, relaxation);
}

void reserve_elements(ElementSet& set, uint32_t more) {
    for_columns(set, [&](auto& column, uint32_t entries) { reserve_more(column, size_t{entries} * more); });
}

uint32_t Elements::add(const ElementType& type) {
    ids.reserve_one();
    if (set.capacity() == set.size()) set.reserve(2 * set.size() + 4);
    const uint32_t index = ids.create();
    if (index == set.size()) set.emplace_back(*set.get_allocator().memory);
    set[index].type = &type;
    set[index].serial = ++version;
    return index;
}

void Elements::remove(uint32_t index) {
    set[index] = ElementSet(*set.get_allocator().memory);
    ids.destroy(index);
    ++version;
}

void Elements::insert(ElementSet& of, uint32_t at, std::span<const uint32_t> nodes, double softness) {
    for_columns(of, [&](auto& column, uint32_t entries) {
        using Entry = typename std::remove_reference_t<decltype(column)>::value_type;
        Entry nothing{};
        if constexpr (std::is_same_v<Entry, Vec3>) nothing.setZero();
        column.insert(column.begin() + static_cast<ptrdiff_t>(size_t{at} * entries), entries, nothing);
    });
    of.softness[at] = softness;
    of.fresh[at] = 1;
    std::ranges::copy(nodes, &of.node[size_t{at} * nodes.size()]);
    note(of);
}

void Elements::erase(ElementSet& of, uint32_t element) {
    for_columns(of, [&](auto& column, uint32_t entries) {
        const auto first = column.begin() + static_cast<ptrdiff_t>(size_t{element} * entries);
        column.erase(first, first + entries);
    });
    note(of);
}

void Elements::tie(ElementSet& of, uint32_t element, std::span<const uint32_t> nodes) {
    if (std::ranges::equal(nodes, of.nodes_of(element))) return;  // the graph stays
    std::ranges::copy(nodes, &of.node[size_t{element} * nodes.size()]);
    note(of);
}

void Elements::kill(ElementSet& of, uint32_t element) {
    const auto count = static_cast<size_t>(of.type->row.nodes);
    std::fill_n(&of.node[element * count], count, kNone);
    std::fill_n(of.lambda_of(element), of.type->row.rows, 0.0);
    if (of.pulls) of.memory[element] = {};
    note(of);
}

uint32_t Elements::count() const {
    uint32_t sum = 0;
    for_each_element(*this, [&](const ElementSet&, uint32_t, std::span<const uint32_t>) { ++sum; });
    return sum;
}

void age_yields(Elements& elements, double time, uint32_t substeps) {
    constexpr double kGrowth = 0.03;  // time in which they grow, e-fold [s]
    for (ElementSet& set : elements.set) {
        const double least = set.tolerance * substeps * substeps / (time * time);
        set.most_yield = (1 + time / kGrowth) * std::max(least, set.yield);
        set.yield = std::max(set.least_yield, set.yield / (1 + time / kYieldMemory));
    }
}

}  // namespace taut
