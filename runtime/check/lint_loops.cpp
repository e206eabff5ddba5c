// Rows of a mechanism that hold what rows of earlier slots hold already. Trees have none.
#include <span>

#include "check/lint_context.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

constexpr double kRedundant = 1e-6;  // share of a row that earlier rows do not hold
// Mechanisms with more rows are not looked at: the work grows with the square.
constexpr size_t kMostRows = 1200;

// Rows made square to each other (Gram and Schmidt, twice for rounding).
class Basis {
public:
    Basis(size_t rows, size_t width, Memory& memory) : width_(width), units_(memory) {
        units_.reserve(std::min(rows, width) * width);
    }

    // Adds what is left of a row beside the earlier ones, as a unit vector; false if that is next to nothing.
    bool extend(Array<double>& row) {
        const auto length = static_cast<Eigen::Index>(width_);
        Eigen::Map<Eigen::VectorXd> left(row.data(), length);
        const double whole = left.norm();
        if (!(whole > 0)) return true;
        for (int pass = 0; pass < 2; ++pass) {
            for (size_t at = 0; at < units_.size(); at += width_) {
                const Eigen::Map<const Eigen::VectorXd> unit(units_.data() + at, length);
                left -= unit.dot(left) * unit;
            }
        }
        const double rest = left.norm();
        if (!(rest > kRedundant * whole)) return false;
        left /= rest;
        units_.insert(units_.end(), row.begin(), row.end());
        return true;
    }

private:
    size_t width_;
    Array<double> units_;
};

// Joints that hang together, with the nodes that they move.
class Mechanism {
public:
    Mechanism(const LintContext& context, std::span<const uint32_t> joints)
        : context_(context), joints_(joints), nodes_(context.memory) {
        for (uint32_t j : joints_) {
            const Joint& joint = context_.joints.record[j];
            for (uint32_t node : joint.nodes())
                if (context_.moves(node))
                    nodes_.push_back(node);
                else
                    grounded_ = true;
            for (int row = 0; row < joint.type->rows; ++row) rows_ += is_rigid(joint, row);
        }
        std::sort(nodes_.begin(), nodes_.end());
        nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    }

    // The ground is a node of a tree.
    bool is_tree() const { return joints_.size() <= nodes_.size() - !grounded_; }
    size_t rows() const { return rows_; }

    void find_redundant_rows() const {
        const size_t width = nodes_.size() * kDof;
        Basis basis(rows_, width, context_.memory);
        Array<double> row_of_all(width, 0.0, context_.memory);
        for (uint32_t j : joints_) {
            const Joint& joint = context_.joints.record[j];
            const JointReading reading = read_joint(context_.nodes, joint);
            uint32_t held = 0;
            for (int row = 0; row < joint.type->rows; ++row) {
                if (!is_rigid(joint, row)) continue;
                spread(joint, reading, row, row_of_all);
                held += !basis.extend(row_of_all);
            }
            if (held == 0) continue;
            const uint32_t node = context_.moves(joint.node[1]) ? joint.node[1] : joint.node[0];
            context_.add(TAUT_LINT_REDUNDANT_ROWS, node, j, held, 0);
        }
    }

private:
    // A row's Jacobian over all of the mechanism's nodes.
    void spread(const Joint& joint, const JointReading& reading, int row, Array<double>& out) const {
        std::fill(out.begin(), out.end(), 0.0);
        for (int end = 0; end < joint.type->nodes; ++end) {
            const uint32_t node = joint.node[end];
            if (!context_.moves(node)) continue;
            const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
            const double* from = reading.jacobian + (end * joint.type->rows + row) * kDof;
            const int columns = context_.nodes.info[node].kind == NodeKind::particle ? 3 : kDof;
            std::copy(from, from + columns, out.begin() + at * kDof);
        }
    }

    const LintContext& context_;
    std::span<const uint32_t> joints_;
    Array<uint32_t> nodes_;  // each once, sorted
    size_t rows_ = 0;        // rigid ones
    bool grounded_ = false;
};

}  // namespace

void lint_loops(const LintContext& context) {
    Connected mechanism(context);  // soft joints count as well
    context.for_joints([&](uint32_t, const Joint& joint) { mechanism.unite(joint); });
    Array<uint32_t> root(context.joints.record.size(), kNone, context.memory), order(context.memory);
    context.for_joints([&](uint32_t j, const Joint& joint) {
        root[j] = mechanism.root_of(context.lightest_of(joint));
        order.push_back(j);
    });
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return root[a] < root[b]; });
    for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
        while (end < order.size() && root[order[end]] == root[order[begin]]) ++end;
        const Mechanism whole(context, {order.data() + begin, end - begin});
        if (!whole.is_tree() && whole.rows() <= kMostRows) whole.find_redundant_rows();
    }
}

}  // namespace taut
