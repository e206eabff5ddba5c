// Meshes of cloths and solids: shapes that are stiff and slow, cells turned inside out, stiffness beyond what sweeps
// may take substeps for, seams and edges by which a mesh hangs together less than it seems to. Of each kind the worst
// of a soft body.
#include <Eigen/LU>
#include <cmath>

#include "check/lint_context.h"
#include "models/neighbours.h"
#include "models/soft_reading.h"

namespace taut {
namespace {

// Height over edge: the stiffness across a sliver is the square of it above that of an element of its edges.
constexpr double kSliver = 0.1;
constexpr double kOnePlace = 1e-6;  // of a soft body's size

class SoftLint {
public:
    SoftLint(const LintContext& context, const Soft& soft)
        : context_(context), soft_(soft), set_(context.world.elements.set[soft.sets[0].set]) {}

    void run() const {
        find_slivers();
        if (soft_.kind == SoftKind::solid) find_inverted();
        find_stiff();
        find_seams();
        if (soft_.kind == SoftKind::solid) find_open_edges();
    }

private:
    struct Worst {
        double value;
        uint32_t node = kNone;
        void least(double other, uint32_t at) {
            if (other < value) value = other, node = at;
        }
        void most(double other, uint32_t at) {
            if (other > value) value = other, node = at;
        }
    };
    void add(taut_lint_kind kind, const Worst& worst, double limit) const {
        if (worst.node != kNone) context_.add(kind, worst.node, kNone, worst.value, limit);
    }

    // Least height over longest edge, by the gradients of corners 1 to Dim, which edges from corner 0 are the inverse
    // of.
    template <int Dim>
    static double shape_of(const double* g) {
        using Square = Eigen::Matrix<double, Dim, Dim>;
        using Column = Eigen::Matrix<double, Dim, 1>;
        Square slopes;
        double steepest = 0, longest = 0;
        for (int n = 0; n <= Dim; ++n) {
            const Column slope = Column::Map(g + Dim * n);
            if (n > 0) slopes.row(n - 1) = slope.transpose();
            steepest = std::max(steepest, slope.norm());
        }
        const Square edges = slopes.inverse();
        for (int n = 0; n < Dim; ++n) {
            longest = std::max(longest, edges.col(n).norm());
            for (int m = 0; m < n; ++m) longest = std::max(longest, (edges.col(n) - edges.col(m)).norm());
        }
        return 1 / (steepest * longest);
    }

    void find_slivers() const {
        Worst worst{kSliver};
        if (soft_.kind == SoftKind::cloth) {
            for (uint32_t t = 0; t < soft_.triangles(); ++t)
                worst.least(shape_of<2>(&soft_.rest[6 * size_t{t}]), soft_.node[soft_.triangle[3 * size_t{t}]]);
        } else if (set_.type->row.nodes == 4) {
            for (uint32_t e = 0; e < set_.size(); ++e) worst.least(shape_of<3>(set_.data_of(e)), set_.nodes_of(e)[0]);
        } else if (soft_.cell_points > 1) {
            for (uint32_t e = 0; e < set_.size(); e += soft_.cell_points) {
                double sum = 0, most = 0;
                for (uint32_t k = 0; k < soft_.cell_points; ++k) {
                    sum += 1 / set_.softness[e + k];
                    most = std::max(most, set_.softness[e + k]);
                }
                worst.least(soft_.cell_points / (most * sum), set_.nodes_of(e)[0]);
            }
        }
        add(TAUT_LINT_SOFT_SLIVER, worst, kSliver);
    }

    void find_inverted() const {
        Worst worst{0};
        for (uint32_t c = 0; c < cells_of(context_.world, soft_); ++c)
            worst.least(cell_state(context_.world, soft_, c).volume, set_.nodes_of(c * soft_.cell_points)[0]);
        add(TAUT_LINT_SOFT_INVERTED, worst, 0);
    }

    // Squares of the frequency of a row against its nodes, J W J^T D [1/s^2], the most.
    double rate_of(const ElementSet& set, uint32_t e) const {
        const ConstraintType& row = set.type->row;
        const auto nodes = set.nodes_of(e);
        Pose x[kMaxNodes];
        for (size_t n = 0; n < nodes.size(); ++n) x[n].x = context_.nodes.motion[nodes[n]].x;
        double c[kMaxRows], j[kMaxNodes * kMaxRows * kDof] = {}, most = 0;
        row.evaluate(set.data_of(e), x, c, j);
        for (int r = 0; r < row.rows; ++r) {
            double moves = 0;
            for (size_t n = 0; n < nodes.size(); ++n)
                moves += context_.nodes.mass[nodes[n]].inv_mass *
                         Vec3::Map(j + (static_cast<int>(n) * row.rows + r) * kDof).squaredNorm();
            most = std::max(most, moves * set.stiffness[r * (row.rows + 1)] / set.softness[e]);
        }
        return most;
    }
    // Rigid ones count as such, which they are asked to be.
    void find_stiff() const {
        Worst worst{1};
        const auto most = static_cast<double>(kMostElasticSubsteps);
        for (const SoftSet& each : soft_.sets) {
            const ElementSet& set = context_.world.elements.set[each.set];
            const bool along = each.part == SoftPart::stretch || each.part == SoftPart::shear;
            if (set.solve != JointSolve::swept || !along) continue;
            for (uint32_t e = 0; e < set.size(); ++e) {
                if (!set.lives(e)) continue;
                const double substeps = std::sqrt(rate_of(set, e)) * static_cast<double>(context_.world.def.time_step);
                worst.most(substeps / most, set.nodes_of(e)[0]);
            }
        }
        add(TAUT_LINT_SOFT_TOO_STIFF, worst, 1);
    }

    void find_seams() const {
        Array<Vec3> at(context_.memory);
        at.reserve(soft_.vertices());
        for (uint32_t v = 0; v < soft_.vertices(); ++v) at.push_back(vertex_of(context_.world, soft_, v));
        Vec3 low = at[0], high = at[0];
        for (const Vec3& x : at) low = low.cwiseMin(x), high = high.cwiseMax(x);
        const double size = (high - low).norm();
        const Neighbours neighbours(at, context_.memory);
        for (uint32_t v = 0; v < soft_.vertices(); ++v) {
            Neighbour near[2];
            if (neighbours.nearest(at[v], 2, kOnePlace * size, near) < 2) continue;
            context_.add(TAUT_LINT_SOFT_SEAM, soft_.node[v], kNone, std::sqrt(near[1].squared) / size, kOnePlace);
            return;
        }
    }

    void find_open_edges() const {
        struct Edge {
            uint32_t a, b;
            auto operator<=>(const Edge&) const = default;
        };
        Array<Edge> edges(context_.memory);
        edges.reserve(3 * size_t{soft_.triangles()});
        for (uint32_t i = 0; i < 3 * soft_.triangles(); ++i) {
            const uint32_t a = soft_.triangle[i], b = soft_.triangle[i % 3 == 2 ? i - 2 : i + 1];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
        std::ranges::sort(edges);
        for (size_t begin = 0, end; begin < edges.size(); begin = end) {
            for (end = begin + 1; end < edges.size() && edges[end] == edges[begin];) ++end;
            if (end - begin == 2) continue;
            context_.add(TAUT_LINT_SOFT_NOT_MANIFOLD, soft_.node[edges[begin].a], kNone,
                         static_cast<double>(end - begin), 2);
            return;
        }
    }

    const LintContext& context_;
    const Soft& soft_;
    const ElementSet& set_;  // its cells, triangles or first links
};

}  // namespace

void lint_softs(const LintContext& context) {
    const Softs& softs = context.world.softs;
    for (uint32_t index = 0; index < softs.ids.slots(); ++index)
        if (softs.ids.live(index) && !softs.record[index].sets.empty()) SoftLint(context, softs.record[index]).run();
}

}  // namespace taut
