// The numbers of a block's matrix: masses, joints and stiffness into its entries, bounded rows on top of them.
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "linear/held_order.h"
#include "solvers/adaptive_damping.h"
#include "solvers/block_solve.h"

namespace taut {
namespace {

constexpr double kLoopCompliance = 1e-7;  // of a row's own effective inverse mass: makes redundant loops solvable

// Block::places: diagonals of the nodes; then of each tie its own diagonal, those of its Jacobians and of the couplings
// between its nodes, with room for the type that has most.
uint32_t places_of(const ConstraintType& type) { return static_cast<uint32_t>(1 + type.nodes * (type.nodes + 1) / 2); }
constexpr uint32_t kDiagonal = 0;
uint32_t of_jacobian(int n) { return 1 + static_cast<uint32_t>(n); }
uint32_t coupling(const ConstraintType& type, int n, int m) {  // m < n
    return static_cast<uint32_t>(1 + type.nodes + n * (n - 1) / 2 + m);
}

double unlocked(const SweepNode& node, const double* j) {
    return node.held() ? unlocked_along(node, j) : inverse_mass_along(node, j);
}

int locked_rows(const RowBlock& block) {
    int count = 0;
    for (int r = 0; r < block.type->rows; ++r) count += block.locked(r);
    return count;
}

// sum += w a^T b of the entries from First on, 6 x 6.
template <int First>
void add_product(const double* a, const double* b, double w, double* sum) {
    for (int r = First; r < kDof; ++r) {
        const double scaled = w * a[r];
        for (int c = First; c < kDof; ++c) sum[r * kDof + c] += scaled * b[c];
    }
}

bool in_matrix(const BoundedRow& row) { return row.on && row.at_limit == 0; }

// B^T B / c of rows on the same nodes: what each two of these have in common.
class RowProducts {
public:
    explicit RowProducts(std::span<const BoundedRow> rows) : nodes_(rows.front().nodes) {
        for (const BoundedRow& row : rows)
            if (in_matrix(row)) first_ = std::min<int>(first_, row.begin);
        for (int n = 0; n < nodes_; ++n)
            for (int m = 0; m <= n; ++m) std::fill_n(sum_[n][m], kDof * kDof, 0.0);
        for (const BoundedRow& row : rows)
            if (in_matrix(row)) first_ > 0 ? add<3>(row) : add<0>(row);
    }
    // Of two nodes, of so many freedoms each.
    BlockPiece of(int n, int m, int rows, int columns) const {
        return {sum_[n][m] + first_ * (kDof + 1), rows - first_, columns - first_, kDof, first_, first_};
    }

private:
    template <int First>
    void add(const BoundedRow& row) {
        for (int n = 0; n < nodes_; ++n)
            for (int m = 0; m <= n; ++m)
                if (row.place[n] != kNone && row.place[m] != kNone)
                    add_product<First>(row.jacobian + static_cast<size_t>(n) * row.stride,
                                       row.jacobian + static_cast<size_t>(m) * row.stride, 1 / row.c, sum_[n][m]);
    }

    int nodes_, first_ = 3;
    double sum_[kMaxNodes][kMaxNodes][kDof * kDof];
};

}  // namespace

void BlockSolve::analyse() {
    SparseBlockLdlt& matrix = b_.matrix;
    if (matrix.analysed()) return;
    const auto memory = b_.order.get_allocator();
    Array<Unknown> unknown(memory);
    Array<uint64_t> links(memory), slight(memory);
    list_unknowns(unknown);
    list_links(links, slight);
    matrix.begin(nodes_ + ties());
    for (uint32_t i = 0; i < unknown.size(); ++i)
        matrix.set_unknown(i, unknown[i].size, unknown[i].multiplier, unknown[i].rows);
    for (const uint64_t link : links) matrix.link(static_cast<uint32_t>(link >> 32), static_cast<uint32_t>(link));
    b_.solution.resize(2 * unknowns() + nodes_ * kDof);
    b_.known.resize((nodes_ + ties()) * kDof);
    b_.force.resize(ties() * kMaxRows);
    if (b_.order.empty()) {  // else it was restored
        b_.looped = looped();
        if (!b_.elastic.empty() && !b_.looped) b_.order = HeldOrder(*memory.memory, unknown, links, slight).order;
    }
    matrix.analyse(b_.order);
    find_places();
    b_.order.assign(matrix.order().begin(), matrix.order().end());
}

void BlockSolve::list_unknowns(Array<Unknown>& out) const {
    for (uint32_t i = 0; i < nodes_; ++i)
        out.push_back({static_cast<uint8_t>(s_.nodes.info[b_.nodes[i]].kind == NodeKind::particle ? 3 : 6), false});
    for (uint32_t j = 0; j < ties(); ++j)
        out.push_back({static_cast<uint8_t>(row(j).held() > 3 ? 6 : 3), true,
                       static_cast<uint8_t>(gives(row(j)) ? 0 : locked_rows(row(j)))});
}

// Pairs of unknowns, smaller << 32 | larger; of these slight: a tie and a node that hardly holds it.
void BlockSolve::list_links(Array<uint64_t>& out, Array<uint64_t>& slight) const {
    for (uint32_t j = 0; j < ties(); ++j) {
        const ConstraintType& type = *row(j).type;
        for (int n = 0; n < type.nodes; ++n) {
            const uint32_t i = local(row(j).node[n]);
            if (i == kNone) continue;
            out.push_back(pair_key(i, nodes_ + j));
            if (!holds(row(j), n)) slight.push_back(out.back());
            for (int m = 0; m < n && (type.couples_nodes || row(j).axis); ++m) {
                const uint32_t k = local(row(j).node[m]);
                if (k != kNone) out.push_back(pair_key(i, k));
            }
        }
    }
    link_elastic(out);
    for (const uint64_t link : b_.links)
        out.push_back(
            pair_key(local(sys_.at(static_cast<uint32_t>(link >> 32))), local(sys_.at(static_cast<uint32_t>(link)))));
}

// Whether a node has a part of each row's effective inverse mass that a pivot may rest on.
bool BlockSolve::holds(const RowBlock& block, int n) const {
    const double* j = jacobian_of(sys_, block, n).data();
    for (int r = 0; r < block.type->rows; ++r, j += kDof)
        if (block.locked(r) && !(inverse_mass_along(sys_.sweep[block.node[n]], j) > loop_compliance(block, r)))
            return false;
    return true;
}

// Whether each row of a joint gives way so far that the matrix needs no freedom of a node for it.
bool BlockSolve::gives(const RowBlock& block) const {
    const RowMatrix c = compliance_of(block, sys_.scheme);
    for (int r = 0; r < block.type->rows; ++r)
        if (block.locked(r) && !(c(r, r) > loop_compliance(block, r))) return false;
    return true;
}

// More joints than a tree on the nodes (and the ground, where something is held) can have, soft ones included; or a
// loop by contacts. Then nodes are not eliminated from leaf to root, and two joints may come right after the body
// between them, which cannot part them: it has no freedom for all their rows. Elastic elements give way to what ties
// ask for, so that with these no more than the ties themselves make loops, whatever hangs together by elements.
bool BlockSolve::looped() const {
    if (!b_.elastic.empty()) return ties_make_loops();
    if (!b_.links.empty() && ties() > 1) return true;
    bool held = false;
    for (uint32_t j = 0; j < ties(); ++j)
        for (int n = 0; n < row(j).type->nodes; ++n) held = held || local(row(j).node[n]) == kNone;
    return ties() + 1 > nodes_ + (held ? 1u : 0u);
}

// Whether a tie that does not give way is between nodes that others tie already, the ground being one.
bool BlockSolve::ties_make_loops() const {
    Array<uint32_t> parent(b_.order.get_allocator());
    parent.resize(nodes_ + 1);
    for (uint32_t i = 0; i <= nodes_; ++i) parent[i] = i;
    const auto root = [&](uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (uint32_t j = 0; j < ties(); ++j) {
        if (gives(row(j))) continue;
        bool held = false;
        uint32_t first = kNone;
        for (int n = 0; n < row(j).type->nodes; ++n) {
            const uint32_t at = local(row(j).node[n]), i = root(at == kNone ? nodes_ : at);
            if (at == kNone && std::exchange(held, true)) continue;
            if (i == first) return true;
            if (first == kNone) first = i;
            parent[i] = first;
        }
    }
    return false;
}

BlockPlace& BlockSolve::place(uint32_t j, uint32_t which) { return b_.places[nodes_ + j * b_.stride + which]; }

void BlockSolve::find_places() {
    b_.stride = 0;
    for (uint32_t j = 0; j < ties(); ++j) b_.stride = std::max(b_.stride, places_of(*row(j).type));
    b_.places.assign(nodes_ + ties() * b_.stride, {});
    for (uint32_t i = 0; i < nodes_; ++i) b_.places[i] = b_.matrix.place(i, i);
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        place(j, kDiagonal) = b_.matrix.place(nodes_ + j, nodes_ + j);
        for (int n = 0; n < block.type->nodes; ++n) {
            const uint32_t i = local(block.node[n]);
            if (i == kNone) continue;
            place(j, of_jacobian(n)) = b_.matrix.place(nodes_ + j, i);
            for (int m = 0; m < n && (block.type->couples_nodes || block.axis); ++m) {
                const uint32_t k = local(block.node[m]);
                if (k != kNone) place(j, coupling(*block.type, n, m)) = b_.matrix.place(i, k);
            }
        }
    }
    find_elastic_places();
    find_parts();
}

void BlockSolve::add_mass(uint32_t i) {
    const uint32_t node = b_.nodes[i];
    const bool held = !moves_by_forces(s_.nodes.info[node].kind);  // in this frame: it keeps its place in the matrix
    const double mass = held ? kHeldMass : s_.nodes.mass[node].mass;
    const double diagonal[9] = {mass, 0, 0, 0, mass, 0, 0, 0, mass};
    b_.matrix.add(b_.places[i], {diagonal, 3, 3, 3});
    if (const Locks locks = s_.nodes.locks_of(node); locks.any()) {
        double locked[9] = {};
        for (int k = 0; k < 3; ++k) locked[4 * k] = locks.linear(k) ? kHeldMass : 0;
        b_.matrix.add(b_.places[i], {locked, 3, 3, 3});
    }
    if (size_of(i) == 6 && held)
        b_.matrix.add(b_.places[i], {diagonal, 3, 3, 3, 3, 3});
    else if (size_of(i) == 6)
        b_.matrix.add(b_.places[i], {sys_.inertia[sys_.at(node)].data(), 3, 3, 3, 3, 3});
}

// K, or |K|, of a joint's force at this substep's poses: (6 nodes) x (6 nodes).
void BlockSolve::stiffness_of(const RowBlock& block, const double* force, double* k) const {
    Pose poses[kMaxNodes];
    for (int n = 0; n < block.type->nodes; ++n) poses[n] = sys_.pose[block.node[n]];
    if (s_.settings.adaptive_damping)
        stiffness_magnitude(*block.type, block.data, poses, force, k);
    else
        block.type->stiffness(block.data, poses, force, Curvature::positive, k);
}

// h^2 K into the matrix and h^2 K s onto the known side. A translation of all nodes changes no force, so K of a type
// that does not couple them is of their rotations only.
void BlockSolve::add_stiffness(uint32_t j, const double* force) {
    const RowBlock& block = row(j);
    const ConstraintType& type = *block.type;
    const int width = kDof * type.nodes, first = type.couples_nodes ? 0 : 3;
    const double hh = sys_.scheme.stiffness();
    double k[kDof * kMaxNodes * kDof * kMaxNodes], slow[kDof * kMaxNodes] = {};
    stiffness_of(block, force, k);
    const bool spare = s_.settings.velocity_filter > 0 && b_.memory.guard_left == 0;
    if (spare) slow_velocities(block, slow);
    for (int n = 0; n < type.nodes; ++n) {
        const uint32_t to = local(block.node[n]);
        if (to == kNone) continue;
        for (int m = 0; m < type.nodes; ++m) {
            const uint32_t from = local(block.node[m]);
            if (from == kNone || (m != n && !type.couples_nodes)) continue;
            const double* part = k + (kDof * n + first) * width + kDof * m + first;
            const int rows = size_of(to) - first, columns = size_of(from) - first;
            for (int r = 0; spare && r < rows; ++r) {
                double sum = 0;
                for (int c = 0; c < columns; ++c) sum += part[r * width + c] * slow[kDof * m + first + c];
                known(to)[first + r] += hh * sum;
            }
            if (m <= n && rows > 0 && columns > 0)  // particles do not turn
                b_.matrix.add(m == n ? b_.places[to] : place(j, coupling(type, n, m)),
                              {part, rows, columns, width, first, first, hh});
        }
    }
}

double BlockSolve::loop_compliance(const RowBlock& block, int r) const {
    double k = 0;
    const double* j = &sys_.rows.jacobian[block.jacobian] + r * kDof;
    for (int n = 0; n < block.type->nodes; ++n, j += block.type->rows * kDof)
        if (local(block.node[n]) != kNone) k += unlocked(sys_.sweep[block.node[n]], j);
    return kLoopCompliance * k;
}

// Whether an end has locked axes, which may leave rows nothing to do, or several the same.
bool BlockSolve::has_locks(const RowBlock& block) const {
    return std::any_of(block.node, block.node + block.type->nodes, [&](uint32_t at) { return sys_.sweep[at].held(); });
}

// Whether a tie ends on nothing that moves, as one on held nodes does: it asks for nothing.
bool BlockSolve::stands(const RowBlock& block) const {
    return std::all_of(block.node, block.node + block.type->nodes,
                       [&](uint32_t at) { return !(sys_.sweep[at].mass.inv_mass > 0); });
}

// The locked rows; the place of a row that is not, but comes before one that is, is taken by mu = 0.
void BlockSolve::add_rows(uint32_t j) {
    const RowBlock& block = row(j);
    const int rows = block.held(), padded = size_of(nodes_ + j);
    const bool idle = stands(block), locks = has_locks(block);
    for (int n = 0; n < block.type->nodes && !idle; ++n) {
        const uint32_t i = local(block.node[n]);
        if (i == kNone) continue;
        const double* jacobian = jacobian_of(sys_, block, n).data();
        for (int begin = 0, end; begin < rows; begin = end + 1) {  // locked rows that follow each other
            for (end = begin; end < rows && block.locked(end);) ++end;
            if (end == begin) continue;
            b_.matrix.add(place(j, of_jacobian(n)),
                          {jacobian + begin * kDof, end - begin, size_of(i), kDof, begin, 0, -1});
        }
    }
    const RowMatrix c = compliance_of(block, sys_.scheme);
    double diagonal[kMaxRows * kMaxRows] = {};
    for (int r = 0; r < padded; ++r) diagonal[r * padded + r] = -1;
    for (int r = 0; r < rows; ++r) {
        if (!block.locked(r) || idle) continue;
        for (int k = 0; k < rows; ++k) diagonal[r * padded + k] = -c(r, k);
        if (b_.looped || locks) diagonal[r * padded + r] = -std::max(c(r, r), loop_compliance(block, r));
    }
    b_.matrix.add(place(j, kDiagonal), {diagonal, padded, padded, padded});
}

// Of two nodes of a bounded row. Contacts come and go, places of ties are known.
BlockPlace BlockSolve::place(const BoundedRow& row, int n, int m) {
    if (n == m) return b_.places[row.place[n]];
    const uint32_t j = row.block - b_.first_row_block;
    return j < ties() ? place(j, coupling(*sys_.rows.block[row.block].type, n, m))
                      : b_.matrix.place(row.place[n], row.place[m]);
}

// B^T B / c of the rows that are on; rows on the same nodes follow each other and go into the matrix together.
void BlockSolve::add_bounded() {
    const auto rows = set.rows();
    for (size_t i = 0, end; i < rows.size(); i = end) {
        const BoundedRow& first = rows[i];
        const auto beside = [&](const BoundedRow& row) {
            return std::equal(first.place, first.place + kMaxNodes, row.place);
        };
        for (end = i + 1; end < rows.size() && beside(rows[end]);) ++end;
        const auto some = rows.subspan(i, end - i);
        if (std::none_of(some.begin(), some.end(), in_matrix)) continue;
        const RowProducts products(some);
        for (int n = 0; n < first.nodes; ++n)
            for (int m = 0; m <= n; ++m)
                if (first.place[n] != kNone && first.place[m] != kNone)
                    b_.matrix.add(place(first, n, m),
                                  products.of(n, m, size_of(first.place[n]), size_of(first.place[m])));
    }
}

// All but the bounded rows; K of the last substep's forces if with_old.
void BlockSolve::assemble(bool with_old) {
    b_.matrix.clear();
    std::fill(b_.known.begin(), b_.known.end(), 0.0);
    for (uint32_t i = 0; i < nodes_; ++i) add_mass(i);
    for (uint32_t j = 0; j < ties(); ++j) {
        const bool meant = !row(j).fresh || b_.memory.solved > 0;
        if (with_old && meant) add_stiffness(j, row(j).force);
        add_rows(j);
        for (int r = 0; r < row(j).type->rows; ++r)
            if (row(j).locked(r)) known(nodes_ + j)[r] = sys_.scheme.row_rate(relaxation_of(row(j), r));
    }
    assemble_elastic();
    if (splits()) split.add_metric();
}

void BlockSolve::add_new_stiffness() {
    for (uint32_t j = 0; j < ties(); ++j) add_stiffness(j, tie_force(j));
}

}  // namespace taut
