// Elastic elements within a block's nodes, evaluated in batches and without multipliers. With u the velocity that moves
// the positions, x' = x_n + h u, and elements evaluated at x_n + h u_0,
//   t J^T D J (h + d) + t h K   into the matrix,
//   t h (J^T D J + K) u_0 - t J^T D C   onto the known side,
// and t b (J^T D J + K) into the matrix for Rayleigh's damping of time b, of which d is the time beside it,
// t and d as in scheme.h. Folded: K is that of the force lambda carried over, its positive part, and lambda becomes
// -D (C + h J (u - u_0) + d J u), as if it were an unknown (Tournier et al. 2015, eq. 21). Energy: lambda = -D C and
// the positive part is that of the sum, a step of Newton's method on W = 1/2 C^T D C.
//
// u_0 of energy is 0; of folded elements it is the velocity before the solve, which foresees how they turn. Both are
// what block_search.cpp found where that solution gained energy.
//
// Elements that only pull act or do not, one semismooth step of Newton's method: act those that the velocity of the
// last substep makes long, and of those that pulled in it the ones that without forces would be long. By the latter
// alone, what hangs on others just short of their ends would be drawn to these.
#include <algorithm>
#include <cmath>

#include "solvers/block_solve.h"

namespace taut {
namespace {

constexpr uint32_t kBatch = 8;  // elements evaluated together
constexpr int kMostFreedoms = kMaxNodes * kDof;
// Way h u of two nodes of an element against each other over their distance, from which on a block's elements are not
// foreseen: evaluated where they would be, one may pull the wrong way. From six hanging cloths of a prototype.
constexpr double kForeseen = 1.5;

uint32_t couplings_of(const ElementType& type) {
    return static_cast<uint32_t>(type.row.nodes * (type.row.nodes - 1) / 2);
}

// Elements of one set that are evaluated together.
struct ElasticBatch {
    ElementSet& set;
    ElementBatch at;
    uint32_t place;  // of its first element's couplings in Block::places

    const ElementType& type() const { return *set.type; }
    int rows() const { return set.type->row.rows; }
    int nodes() const { return set.type->row.nodes; }
    int width() const { return nodes() * set.type->freedoms; }
    double* lambda(uint32_t i) const { return set.lambda_of(at.element[i]); }
    const uint32_t* seats(uint32_t i) const { return at.node + i * static_cast<uint32_t>(nodes()); }
    // Of nodes n and m < n of an element.
    uint32_t place_of(uint32_t i, int n, int m) const {
        return place + i * couplings_of(type()) + static_cast<uint32_t>(n * (n - 1) / 2 + m);
    }
};

// y = D x over the softness of an element.
void stress(const ElasticBatch& batch, uint32_t i, const double* x, double* y) {
    const int rows = batch.rows();
    const double scale = 1 / batch.set.softness[batch.at.element[i]];
    for (int r = 0; r < rows; ++r) {
        double sum = 0;
        for (int k = 0; k < rows; ++k) sum += batch.set.stiffness[r * rows + k] * x[k];
        y[r] = scale * sum;
    }
}

// Bit i: element i of a set that pulls does not act. error: where they are evaluated.
uint32_t find_slack(const ElasticBatch& batch, const System& system, const double* error) {
    const auto nodes = static_cast<uint32_t>(batch.nodes());
    uint32_t local[kBatch * kMaxNodes], slack = 0;
    Pose moved[kBatch * kMaxNodes];
    for (uint32_t i = 0; i < batch.at.count * nodes; ++i) {
        const uint32_t seat = batch.at.node[i];
        local[i] = i;
        const Velocity& u = system.place[seat] == kNone ? system.exact[seat] : system.start[seat];
        moved[i] = {system.pose[seat].x + system.scheme.h * u.v, system.pose[seat].R};
    }
    ElementBatch at = batch.at;
    at.node = local;
    at.x = moved;
    double ahead[kBatch];
    batch.type().evaluate(at, ahead, nullptr, 0);
    for (uint32_t i = 0; i < batch.at.count; ++i)
        if (!(ahead[i] > 0 || (error[i] > 0 && *batch.lambda(i) < 0))) slack |= 1u << i;
    return slack;
}

// What a batch puts into the system of a substep.
class ElasticSystem {
public:
    ElasticSystem(const ElasticBatch& batch, const System& system) : batch_(batch), scheme_(system.scheme) {
        const Scheme& scheme = system.scheme;
        batch.type().evaluate(batch.at, error_, jacobian_, batch.type().freedoms);
        const uint32_t slack = batch.set.pulls ? find_slack(batch, system, error_) : 0;
        double lambda[kBatch * kMaxRows];
        for (uint32_t i = 0; i < batch.at.count; ++i) find_force(i, lambda + i * rows());
        if (folded())
            batch.type().stiffness(batch.at, lambda, Curvature::positive, matrix_);
        else
            positive_sum(batch.type(), batch.at, {batch.set.stiffness, batch.set.softness.data()}, lambda, matrix_);
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            for (uint32_t k = 0; k < width() * width(); ++k) matrix(i)[k] *= scheme.stiffness();
            if (folded()) add_material(i, scheme.stiffness());
            if (slack >> i & 1) leave_out(i);
        }
    }

    uint32_t rows() const { return static_cast<uint32_t>(batch_.rows()); }
    uint32_t width() const { return static_cast<uint32_t>(batch_.width()); }
    const double* error(uint32_t i) const { return error_ + i * rows(); }
    const double* jacobian(uint32_t i) const { return jacobian_ + i * rows() * width(); }
    double* matrix(uint32_t i) { return matrix_ + i * width() * width(); }  // [width][width]

    // -t J^T D C + t h (J^T D J + K) u_0 of an element; then damping joins its matrix.
    void known_side(uint32_t i, const double* u_0, double* out) {
        double f[kMaxRows];
        stress(batch_, i, error(i), f);
        const auto freedoms = static_cast<uint32_t>(batch_.type().freedoms);
        std::fill_n(out, width(), 0.0);
        for (uint32_t n = 0; n < static_cast<uint32_t>(batch_.nodes()); ++n)
            for (uint32_t r = 0; r < rows(); ++r)
                for (uint32_t c = 0; c < freedoms; ++c)
                    out[n * freedoms + c] -= scheme_.act * f[r] * jacobian(i)[(n * rows() + r) * freedoms + c];
        add_times(i, u_0, 1, out);
        const double along = batch_.set.relaxation - batch_.set.rayleigh;
        if (batch_.set.rayleigh > 0)
            for (uint32_t k = 0; k < width() * width(); ++k) matrix(i)[k] *= 1 + batch_.set.rayleigh / scheme_.h;
        if (along > 0) add_material(i, scheme_.act * along);
    }
    // out += weight matrix u.
    void add_times(uint32_t i, const double* u, double weight, double* out) {
        for (uint32_t a = 0; a < width(); ++a) {
            double sum = 0;
            for (uint32_t b = 0; b < width(); ++b) sum += matrix(i)[a * width() + b] * u[b];
            out[a] += weight * sum;
        }
    }

private:
    bool folded() const { return batch_.set.form == ElementForm::folded; }
    void leave_out(uint32_t i) {
        std::fill_n(error_ + i * rows(), rows(), 0.0);
        std::fill_n(jacobian_ + i * rows() * width(), rows() * width(), 0.0);
        std::fill_n(matrix(i), width() * width(), 0.0);
    }

    void find_force(uint32_t i, double* lambda) const {
        const uint32_t e = batch_.at.element[i];
        if (folded() && !batch_.set.fresh[e]) {
            std::copy_n(batch_.lambda(i), rows(), lambda);
            return;
        }
        stress(batch_, i, error(i), lambda);
        for (uint32_t r = 0; r < rows(); ++r) lambda[r] = -lambda[r];
    }

    // weight J^T D J onto the matrix of an element.
    void add_material(uint32_t i, double weight) {
        const auto freedoms = static_cast<uint32_t>(batch_.type().freedoms);
        double force[kMaxRows];
        for (uint32_t n = 0; n < static_cast<uint32_t>(batch_.nodes()); ++n)
            for (uint32_t c = 0; c < freedoms; ++c) {
                double column[kMaxRows];
                for (uint32_t r = 0; r < rows(); ++r) column[r] = jacobian(i)[(n * rows() + r) * freedoms + c];
                stress(batch_, i, column, force);
                double* line = matrix(i) + (n * freedoms + c) * width();
                for (uint32_t m = 0; m < static_cast<uint32_t>(batch_.nodes()); ++m)
                    for (uint32_t r = 0; r < rows(); ++r) {
                        const double f = weight * force[r];
                        const double* j = jacobian(i) + (m * rows() + r) * freedoms;
                        for (uint32_t k = 0; k < freedoms; ++k) line[m * freedoms + k] += f * j[k];
                    }
            }
    }

    const ElasticBatch& batch_;
    const Scheme& scheme_;
    double error_[kBatch * kMaxRows];
    double jacobian_[kBatch * kMaxRows * kMostFreedoms];  // [count][nodes][rows][freedoms]
    double matrix_[kBatch * kMostFreedoms * kMostFreedoms];
};

// Velocities of an element's nodes, its freedoms alone.
void gather_velocities(const ElasticBatch& batch, uint32_t i, const Array<Velocity>& from, double* out) {
    const int freedoms = batch.type().freedoms;
    for (int n = 0; n < batch.nodes(); ++n) {
        const Velocity& u = from[batch.seats(i)[n]];
        Vec3::Map(out + n * freedoms) = u.v;
        if (freedoms == 6) Vec3::Map(out + n * freedoms + 3) = u.w;
    }
}

}  // namespace

// act(batch) for the block's elastic elements, in order.
template <class Act>
void BlockSolve::for_elastic(Act&& act) const {
    const Rows& rows = sys_.rows;
    uint32_t place = nodes_ + ties() * b_.stride;
    for (uint32_t r = b_.first_elastic_run; r < b_.first_elastic_run + b_.elastic_runs; ++r) {
        const ElasticRun& run = rows.elastic[r];
        const auto nodes = static_cast<uint32_t>(run.set->type->row.nodes);
        const Array<Pose>& x = foresees(*run.set) ? sys_.foreseen : sys_.pose;
        for (uint32_t begin = 0; begin < run.count; begin += kBatch) {
            const uint32_t count = std::min(kBatch, run.count - begin);
            const ElementBatch at{count, &rows.element_node[run.node + begin * nodes],
                                  &rows.element[run.element + begin], run.set->data.data(), x.data()};
            act(ElasticBatch{*run.set, at, place});
            place += count * couplings_of(*run.set->type);
        }
    }
}

bool BlockSolve::foresees(const ElementSet& of) const {
    return b_.relinearised || (b_.foresees && of.form == ElementForm::folded);
}

// act(local node, local node, place) for the pairs of nodes that an element couples.
template <class Act>
void BlockSolve::for_couplings(Act&& act) const {
    for_elastic([&](const auto& batch) {
        for (uint32_t i = 0; i < batch.at.count; ++i)
            for (int n = 0; n < batch.nodes(); ++n)
                for (int m = 0; m < n; ++m) {
                    const uint32_t a = local(batch.seats(i)[n]), b = local(batch.seats(i)[m]);
                    if (a != kNone && b != kNone) act(a, b, batch.place_of(i, n, m));
                }
    });
}

void BlockSolve::link_elastic(Array<uint64_t>& out) const {
    for_couplings([&](uint32_t a, uint32_t b, uint32_t) { out.push_back(pair_key(a, b)); });
}

void BlockSolve::find_elastic_places() {
    uint32_t end = static_cast<uint32_t>(b_.places.size());
    for_elastic([&](const auto& batch) { end = batch.place_of(batch.at.count, 0, 0); });
    b_.places.resize(end);
    for_couplings([&](uint32_t a, uint32_t b, uint32_t place) { b_.places[place] = b_.matrix.place(a, b); });
}

// Which nodes hang together by elements and ties, and whether something that the block does not solve for holds them.
void BlockSolve::find_parts() {
    b_.part.resize(nodes_);
    b_.hold.assign(nodes_, NodeHold::loose);
    for (uint32_t i = 0; i < nodes_; ++i) b_.part[i] = i;
    const auto first_of = [&](uint32_t i) {
        while (b_.part[i] != i) i = b_.part[i] = b_.part[b_.part[i]];
        return i;
    };
    const auto take = [&](const uint32_t* seats, int count) {
        uint32_t first = kNone;
        bool is_anchored = false;
        for (int n = 0; n < count; ++n) {
            const uint32_t i = local(seats[n]);
            if (i == kNone) {
                is_anchored = true;
                continue;
            }
            const uint32_t one = first_of(i), both = first == kNone ? one : std::min(first, one);
            const NodeHold hold = std::max({NodeHold::free, b_.hold[one], b_.hold[both]});
            if (first != kNone) b_.part[first] = both;
            b_.part[one] = both;
            b_.hold[both] = std::max(hold, first == kNone ? hold : b_.hold[first]);
            first = both;
        }
        if (is_anchored && first != kNone) b_.hold[first] = NodeHold::anchored;
    };
    for_elastic([&](const auto& batch) {
        for (uint32_t i = 0; i < batch.at.count; ++i) take(batch.seats(i), batch.nodes());
    });
    for (uint32_t j = 0; j < ties(); ++j) take(row(j).node, row(j).type->nodes);
    for (uint32_t i = 0; i < nodes_; ++i)
        if (s_.nodes.locks_of(b_.nodes[i]).any()) b_.hold[first_of(i)] = NodeHold::anchored;
    for (uint32_t i = 0; i < nodes_; ++i) b_.hold[i] = b_.hold[first_of(i)];
    uint32_t parts = 0;
    for (uint32_t i = 0; i < nodes_; ++i) {  // the first of each comes before the others
        const uint32_t first = b_.part[i];
        b_.part[i] = b_.hold[i] != NodeHold::free ? kNone : first == i ? parts++ : b_.part[first];
    }
}

// Where nodes of elastic elements would be at the end of the substep, but for pressure within surfaces: that is held by
// the elements themselves, which would bear another one in the end where they are evaluated beside where they are
// (measured: balloons of a fifth more stretch in some steps); memory for the solve, which may take none.
void BlockSolve::foresee() {
    b_.foresees = false;
    b_.relinearised = false;
    b_.elastic_force.resize(b_.elastic_runs > 0 ? nodes_ * kDof : 0);
    if (b_.elastic_runs == 0) return;
    const double h = sys_.scheme.h;
    sys_.foreseen.resize(sys_.pose.size());
    bool slow = true;
    for_elastic([&](const auto& batch) {
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            const uint32_t* seat = batch.seats(i);
            for (int n = 0; n < batch.nodes(); ++n) {
                const Pose& x = sys_.pose[seat[n]];
                const Velocity& u = local(seat[n]) == kNone ? sys_.exact[seat[n]] : sys_.free[seat[n]];
                sys_.foreseen[seat[n]] = {x.x + h * (u.v - sys_.gases.push_of(seat[n])), x.R};
            }
            if (batch.set.form != ElementForm::folded) continue;
            for (int n = 1; n < batch.nodes(); ++n) {
                const Vec3 span = sys_.pose[seat[n]].x - sys_.pose[seat[0]].x;
                const Vec3 ahead = sys_.foreseen[seat[n]].x - sys_.foreseen[seat[0]].x;
                slow = slow && (ahead - span).squaredNorm() <= kForeseen * kForeseen * span.squaredNorm();
            }
        }
    });
    b_.foresees = slow;
}

// u_0, as it moved the places at which elements are evaluated; rotations stay.
template <class Batch>
void BlockSolve::gather_before(const Batch& batch, uint32_t i, double* out) const {
    const int freedoms = batch.type().freedoms;
    std::fill_n(out, batch.width(), 0.0);
    if (!foresees(batch.set)) return;
    for (int n = 0; n < batch.nodes(); ++n) {
        const uint32_t seat = batch.seats(i)[n];
        Vec3::Map(out + n * freedoms) = (sys_.foreseen[seat].x - sys_.pose[seat].x) / sys_.scheme.h;
    }
}

void BlockSolve::assemble_elastic() {
    std::fill(b_.elastic_force.begin(), b_.elastic_force.end(), 0.0);
    for_elastic([&](const auto& batch) {
        ElasticSystem system(batch, sys_);
        const int freedoms = batch.type().freedoms, width = batch.width();
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            double u[kMostFreedoms], side[kMostFreedoms];
            gather_before(batch, i, u);
            system.known_side(i, u, side);
            gather_velocities(batch, i, sys_.exact, u);
            // Ends that the block does not solve for go to the known side.
            bool meets_known = false;
            for (int n = 0; n < batch.nodes(); ++n) {
                if (local(batch.seats(i)[n]) != kNone)
                    std::fill_n(u + n * freedoms, freedoms, 0.0);
                else
                    meets_known = true;
            }
            if (meets_known) system.add_times(i, u, -1, side);
            for (int n = 0; n < batch.nodes(); ++n) {
                const uint32_t a = local(batch.seats(i)[n]);
                if (a == kNone) continue;
                for (int c = 0; c < std::min(freedoms, size_of(a)); ++c)
                    b_.elastic_force[a * kDof + static_cast<uint32_t>(c)] += side[n * freedoms + c];
                for (int m = 0; m <= n; ++m) {
                    const uint32_t b = local(batch.seats(i)[m]);
                    if (b == kNone) continue;
                    b_.matrix.add(m == n ? b_.places[a] : b_.places[batch.place_of(i, n, m)],
                                  {system.matrix(i) + n * freedoms * width + m * freedoms,
                                   std::min(freedoms, size_of(a)), std::min(freedoms, size_of(b)), width});
                }
            }
        }
    });
}

// Folded, and of all that pull: lambda = -D (C + h J (u - u_0) + d J u).
void BlockSolve::take_elastic_forces() {
    for_elastic([&](const auto& batch) {
        if (batch.set.form != ElementForm::folded && !batch.set.pulls) return;
        double error[kBatch * kMaxRows], jacobian[kBatch * kMaxRows * kMostFreedoms];
        const int rows = batch.rows(), freedoms = batch.type().freedoms;
        batch.type().evaluate(batch.at, error, jacobian, freedoms);
        const uint32_t slack = batch.set.pulls ? find_slack(batch, sys_, error) : 0;
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            double u[kMostFreedoms], u_0[kMostFreedoms];
            gather_velocities(batch, i, sys_.exact, u);
            gather_before(batch, i, u_0);
            double* c = error + i * static_cast<uint32_t>(rows);
            batch.set.fresh[batch.at.element[i]] = 0;
            if (slack >> i & 1) {
                batch.lambda(i)[0] = 0;
                continue;
            }
            for (int n = 0; n < batch.nodes(); ++n)
                for (int r = 0; r < rows; ++r) {
                    const double* j =
                        jacobian + ((i * static_cast<uint32_t>(batch.nodes()) + static_cast<uint32_t>(n)) *
                                        static_cast<uint32_t>(rows) +
                                    static_cast<uint32_t>(r)) *
                                       static_cast<uint32_t>(freedoms);
                    for (int k = 0; k < freedoms; ++k) {
                        const double now = u[n * freedoms + k], then = u_0[n * freedoms + k];
                        c[r] += j[k] * (sys_.scheme.h * (now - then) + batch.set.relaxation * now);
                    }
                }
            stress(batch, i, c, batch.lambda(i));
            for (int r = 0; r < rows; ++r) batch.lambda(i)[r] = -batch.lambda(i)[r];
            if (batch.set.pulls) batch.lambda(i)[0] = std::min(0.0, batch.lambda(i)[0]);
        }
    });
}

bool BlockSolve::has_energy_forms() const {
    const auto* run = sys_.rows.elastic.data() + b_.first_elastic_run;
    return std::any_of(run, run + b_.elastic_runs,
                       [](const ElasticRun& each) { return each.set->form == ElementForm::energy; });
}

// Of an element's node: u at a part of the way, and the way.
void BlockSolve::along_way(uint32_t seat, double part, Vec3& u, Vec3& way) const {
    const uint32_t i = local(seat);
    u = sys_.exact[seat].v;
    way.setZero();
    if (i == kNone) return;
    way = u - Vec3::Map(way_begin(i));
    u -= (1 - part) * way;
}

double BlockSolve::elastic_energy(double part, double* slope) const {
    double sum = 0;
    if (slope) *slope = 0;
    for_elastic([&](const auto& batch) {
        const auto nodes = static_cast<uint32_t>(batch.nodes()), rows = static_cast<uint32_t>(batch.rows());
        const auto freedoms = static_cast<uint32_t>(batch.type().freedoms);
        uint32_t in_order[kBatch * kMaxNodes];
        Pose moved[kBatch * kMaxNodes];
        Vec3 way[kBatch * kMaxNodes], u;
        for (uint32_t k = 0; k < batch.at.count * nodes; ++k) {
            const uint32_t seat = batch.at.node[k];
            in_order[k] = k;
            along_way(seat, part, u, way[k]);
            moved[k] = {sys_.pose[seat].x + sys_.scheme.h * u, sys_.pose[seat].R};
        }
        ElementBatch at = batch.at;
        at.node = in_order;
        at.x = moved;
        double error[kBatch * kMaxRows], jacobian[kBatch * kMaxRows * kMostFreedoms], f[kMaxRows];
        batch.type().evaluate(at, error, slope ? jacobian : nullptr, batch.type().freedoms);
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            const double* c = error + i * rows;
            if (batch.set.pulls && c[0] <= 0) continue;
            stress(batch, i, c, f);
            for (uint32_t r = 0; r < rows; ++r) sum += 0.5 * c[r] * f[r];
            for (uint32_t n = 0; slope && n < nodes; ++n)
                for (uint32_t r = 0; r < rows; ++r)
                    *slope +=
                        f[r] * Vec3::Map(jacobian + ((i * nodes + n) * rows + r) * freedoms).dot(way[i * nodes + n]);
        }
    });
    if (slope) *slope *= sys_.scheme.act;
    return sys_.scheme.act / sys_.scheme.h * sum;
}

// t d/2 (J u)^T D (J u), where they are linearised: what it adds for a part of the way, and for its square.
void BlockSolve::elastic_damping(double& linear, double& square) const {
    for_elastic([&](const auto& batch) {
        if (batch.set.relaxation == 0) return;
        const auto nodes = static_cast<uint32_t>(batch.nodes()), rows = static_cast<uint32_t>(batch.rows());
        const auto freedoms = static_cast<uint32_t>(batch.type().freedoms);
        double error[kBatch * kMaxRows], jacobian[kBatch * kMaxRows * kMostFreedoms], f[kMaxRows];
        batch.type().evaluate(batch.at, error, jacobian, batch.type().freedoms);
        const double weight = sys_.scheme.act * batch.set.relaxation;
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            double begin[kMaxRows] = {}, along[kMaxRows] = {};
            for (uint32_t n = 0; n < nodes; ++n) {
                Vec3 u, way;
                along_way(batch.seats(i)[n], 0, u, way);
                for (uint32_t r = 0; r < rows; ++r) {
                    const Vec3 j = Vec3::Map(jacobian + ((i * nodes + n) * rows + r) * freedoms);
                    begin[r] += j.dot(u);
                    along[r] += j.dot(way);
                }
            }
            stress(batch, i, along, f);
            for (uint32_t r = 0; r < rows; ++r) {
                linear += weight * begin[r] * f[r];
                square += 0.5 * weight * along[r] * f[r];
            }
        }
    });
}

// By how much folded elements are not as long as was foreseen of them, at most: the distance by which nodes would have
// to move for that, over that between the element's nodes.
double BlockSolve::linearisation_error() const {
    double most = 0;
    for_elastic([&](const auto& batch) {
        if (batch.set.form != ElementForm::folded) return;
        const auto nodes = static_cast<uint32_t>(batch.nodes()), rows = static_cast<uint32_t>(batch.rows());
        const auto freedoms = static_cast<uint32_t>(batch.type().freedoms);
        uint32_t in_order[kBatch * kMaxNodes];
        Pose moved[kBatch * kMaxNodes];
        for (uint32_t k = 0; k < batch.at.count * nodes; ++k) {
            const uint32_t seat = batch.at.node[k];
            in_order[k] = k;
            moved[k] = {sys_.pose[seat].x + sys_.scheme.h * sys_.exact[seat].v, sys_.pose[seat].R};
        }
        ElementBatch at = batch.at;
        double error[kBatch * kMaxRows], jacobian[kBatch * kMaxRows * kMostFreedoms], after[kBatch * kMaxRows];
        batch.type().evaluate(at, error, jacobian, batch.type().freedoms);
        at.node = in_order;
        at.x = moved;
        batch.type().evaluate(at, after, nullptr, 0);
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            const double extent = (moved[i * nodes + 1].x - moved[i * nodes].x).squaredNorm();
            for (uint32_t r = 0; r < rows; ++r) {
                double miss = after[i * rows + r] - error[i * rows + r], size = 0;
                for (uint32_t n = 0; n < nodes; ++n) {
                    const Vec3 j = Vec3::Map(jacobian + ((i * nodes + n) * rows + r) * freedoms);
                    miss -= j.dot(moved[i * nodes + n].x - batch.at.x[batch.seats(i)[n]].x);
                    size += 0.5 * j.squaredNorm();
                }
                if (size > 0 && extent > 0) most = std::max(most, miss * miss / (size * extent));
            }
        }
    });
    return std::sqrt(most);
}

// To a part of the way.
void BlockSolve::relinearise(double part) {
    b_.foresees = true;
    b_.relinearised = true;
    for_elastic([&](const auto& batch) {
        for (uint32_t k = 0; k < batch.at.count * static_cast<uint32_t>(batch.nodes()); ++k) {
            const uint32_t seat = batch.at.node[k];
            Vec3 u, way;
            along_way(seat, part, u, way);
            sys_.foreseen[seat] = {sys_.pose[seat].x + sys_.scheme.h * u, sys_.pose[seat].R};
        }
    });
}

// Of elastic elements on the block's nodes, at the mean of the velocities before and after [J].
double BlockSolve::elastic_work() const {
    double work = 0;
    for_elastic([&](const auto& batch) {
        ElasticSystem system(batch, sys_);
        for (uint32_t i = 0; i < batch.at.count; ++i) {
            double u[kMostFreedoms], start[kMostFreedoms], impulse[kMostFreedoms];
            gather_before(batch, i, u);
            system.known_side(i, u, impulse);
            gather_velocities(batch, i, sys_.exact, u);
            system.add_times(i, u, -1, impulse);
            gather_velocities(batch, i, sys_.start, start);
            const int freedoms = batch.type().freedoms;
            for (int n = 0; n < batch.nodes(); ++n) {
                if (local(batch.seats(i)[n]) == kNone) continue;
                for (int k = n * freedoms; k < (n + 1) * freedoms; ++k) work += 0.5 * impulse[k] * (start[k] + u[k]);
            }
        }
    });
    return work;
}

}  // namespace taut
