#include "solvers/contact_split.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace taut {
namespace {

constexpr double kOver = 1.6;  // a: Boyd et al. 2011, 3.4.3
// c of pushes that undo an overlap over their J R^-1 J^T. Where they contradict each other, as on cloth that is pinched
// within two bodies, sweeps then end at the mean of both; a load rests deeper by c mu h, some micrometres.
constexpr double kYields = 0.1;
constexpr double kNear = 1e-6;  // [m]: nodes of the two halves, at the end of a substep
constexpr double kShare = 0.1;  // of what x and z are apart, that sweeps may leave of rows
constexpr uint32_t kMostLawSweeps = 20;

using Kind = BoundedRow::Kind;
using Mat6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using RowMat3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// sqrt(m) A^1/2 of a positive definite A.
RowMat3 mean_of(const RowMat3& a, double mass) {
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(a);
    const Vec3 root = (mass * eigen.eigenvalues()).cwiseMax(0.0).cwiseSqrt();
    return eigen.eigenvectors() * root.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace

void ContactSplit::make_room() {
    const auto rows = set_.rows();
    of_.built = false;
    of_.slot.assign(b_.nodes.size(), kNone);
    of_.node.clear();
    for (const BoundedRow& r : rows)
        for (int n = 0; n < r.nodes; ++n)
            if (r.place[n] != kNone) of_.slot[r.place[n]] = 0;
    for (uint32_t i = 0; i < of_.slot.size(); ++i) {
        if (of_.slot[i] == kNone) continue;
        of_.slot[i] = static_cast<uint32_t>(of_.node.size());
        of_.node.push_back(i);
    }
    const size_t touched = of_.node.size();
    grow_to(of_.load, touched);
    grow_to(of_.metric, touched * kDof * kDof);
    grow_to(of_.inverse, touched * kDof * kDof);
    grow_to(of_.velocity, touched * kDof);
    grow_to(of_.stiffness, rows.size());
    grow_to(of_.listed, rows.size());
    grow_to(of_.row, rows.size());
    of_.row.clear();
    of_.touch.clear();
    of_.begin.clear();
    for (const BoundedRow& r : rows) {
        of_.begin.push_back(static_cast<uint32_t>(of_.touch.size()));
        const double* j = r.jacobian;
        for (int n = 0; n < r.nodes; ++n, j += r.stride) {
            if (r.place[n] == kNone) continue;
            const uint32_t slot = of_.slot[r.place[n]];
            for (int k = r.begin; k < size_of(slot); k += 3)
                of_.touch.push_back({slot * kDof + static_cast<uint32_t>(k), r.sign * Vec3::Map(j + k), Vec3::Zero()});
        }
    }
    of_.begin.push_back(static_cast<uint32_t>(of_.touch.size()));
    begin_at_start();
    find_free_parts();
    find_loads();
}

void ContactSplit::begin_at_start() {
    for (uint32_t i = 0; i < of_.node.size(); ++i) {
        const Velocity& u = sys_.start[sys_.at(b_.nodes[of_.node[i]])];
        Vec3::Map(&of_.velocity[i * kDof]) = u.v;
        Vec3::Map(&of_.velocity[i * kDof] + 3) = u.w;
    }
}

void ContactSplit::begin_anew() {
    begin_at_start();
    for (BoundedRow& row : set_.rows()) {
        row.mu = 0;
        if (row.kind == Kind::tangent) row.limit = 0;
    }
}

double ContactSplit::near() const { return kNear / sys_.scheme.h; }

// Of nodes themselves, and by contacts of what hangs together freely on either side: its mass in equal parts on its
// contacts with others, and there by the weights of the nodes. How many a node has is kept where its R^-1 will be, of a
// part where its impulse will.
void ContactSplit::find_loads() {
    const auto rows = set_.rows();
    const auto part_of = [&](uint32_t slot) { return b_.part[of_.node[slot]]; };
    const auto for_sides = [&](const BoundedRow& row, auto&& act) {  // act(slot, weight)
        for (int n = 0; row.kind == Kind::push && n < row.nodes; ++n)
            if (row.place[n] != kNone)
                act(of_.slot[row.place[n]], Vec3::Map(row.jacobian + static_cast<size_t>(n) * row.stride).norm());
    };
    const auto is_within = [&](const BoundedRow& row) {  // a part
        const uint32_t first = row.place[0] == kNone ? kNone : b_.part[row.place[0]];
        for (int n = 1; n < row.nodes; ++n)
            if (row.place[n] == kNone || b_.part[row.place[n]] != first) return false;
        return first != kNone;
    };
    for (uint32_t i = 0; i < of_.node.size(); ++i) {
        of_.load[i] = mass_of(of_.node[i]);
        *at(of_.inverse, i) = 0;
    }
    for (FreePart& part : of_.free) part.impulse = Vec3::Zero();
    for (const BoundedRow& row : rows)
        for_sides(row, [&](uint32_t slot, double w) {
            *at(of_.inverse, slot) += w;
            if (part_of(slot) != kNone && !is_within(row)) of_.free[part_of(slot)].impulse[0] += w;
        });
    for (const BoundedRow& row : rows) {
        const bool within = is_within(row);
        const auto own = [&](uint32_t slot, double w) {
            const double contacts = *at(of_.inverse, slot);
            return contacts > 0 ? w * mass_of(of_.node[slot]) / contacts : 0;
        };
        const auto bears = [&](uint32_t slot, double w) {
            if (within || part_of(slot) == kNone) return own(slot, w);
            const FreePart& part = of_.free[part_of(slot)];
            return part.impulse[0] > 0 ? w * part.mass / part.impulse[0] : 0;
        };
        double all = 0;
        for_sides(row, [&](uint32_t slot, double w) { all += bears(slot, w); });
        for_sides(row, [&](uint32_t slot, double w) { of_.load[slot] += w * std::max(0.0, all - own(slot, w)); });
    }
}

void ContactSplit::find_free_parts() {
    uint32_t parts = 0;
    for (const uint32_t part : b_.part)
        if (part != kNone) parts = std::max(parts, part + 1);
    of_.free.assign(parts, FreePart{});
    for (uint32_t i = 0; i < b_.nodes.size(); ++i)
        if (b_.part[i] != kNone) of_.free[b_.part[i]].mass += mass_of(i);
}

// The rows as they act on whole parts: what row_laws.h asks for.
class ContactSplit::WholeParts {
public:
    explicit WholeParts(ContactSplit& of) : of_(of) {}
    BoundedRow& row(uint32_t i) { return of_.row(i); }
    double miss(uint32_t i) const {
        double sum = of_.miss(i);
        for (const RowTouch& touch : touches(i))
            if (const uint32_t part = part_of(touch); part != kNone) sum += touch.j.dot(shift_of(part));
        return sum;
    }
    double stiffness(uint32_t i) {
        const BoundedRow& r = row(i);
        double sum = r.c;
        for (const RowTouch& touch : touches(i)) {
            if (is_loose(touch)) sum += touch.j.dot(touch.g);
            const uint32_t part = part_of(touch);
            if (part == kNone) continue;
            Vec3 whole = Vec3::Zero();
            for (const RowTouch& other : touches(i))
                if (part_of(other) == part) whole += other.j;
            sum += touch.j.dot(whole) / of_.of_.free[part].mass;
        }
        return sum > kNothing * of_.stiffness(i) ? sum : 0;  // a part pushes itself nowhere
    }
    void change(uint32_t first, uint32_t count, const double* by) {
        for (uint32_t k = 0; k < count; ++k)
            for (const RowTouch& touch : touches(first + k)) {
                if (is_loose(touch)) Vec3::Map(&of_.of_.velocity[touch.at]) += by[k] * touch.g;
                if (const uint32_t part = part_of(touch); part != kNone) of_.of_.free[part].impulse += by[k] * touch.j;
            }
    }
    Vec3 shift_of(uint32_t part) const { return of_.of_.free[part].impulse / of_.of_.free[part].mass; }

private:
    static constexpr double kNothing = 1e-9;

    std::span<const RowTouch> touches(uint32_t i) const { return of_.touches(of_.of_.row[i]); }
    bool is_loose(const RowTouch& touch) const { return !of_.is_split(touch.at / kDof); }
    uint32_t part_of(const RowTouch& touch) const {
        return touch.at % kDof == 0 ? of_.b_.part[of_.of_.node[touch.at / kDof]] : kNone;
    }

    ContactSplit& of_;
};

void ContactSplit::move_free_parts() {
    if (of_.free.empty()) return;
    for (FreePart& part : of_.free) part.impulse = Vec3::Zero();
    for (uint32_t k = 0; k < of_.node.size(); ++k) {
        const uint32_t i = of_.node[k], part = b_.part[i];
        const int size = size_of(k);
        const double* x = &b_.solution[size_t{i} * kDof];
        double* z = &of_.velocity[k * kDof];
        const double* r = at(of_.metric, k);
        for (int a = 0; part != kNone && a < 3; ++a)
            for (int b = 0; b < size; ++b) of_.free[part].impulse[a] += r[a * size + b] * (x[b] - z[b]);
    }
    for (uint32_t k = 0; k < of_.node.size(); ++k)
        std::copy_n(&b_.solution[size_t{of_.node[k]} * kDof], size_of(k), &of_.velocity[k * kDof]);
    list_rows();
    WholeParts whole(*this);
    for (uint32_t sweep = 0; sweep < kMostLawSweeps; ++sweep)
        if (sweep_laws(whole, set_.rows(), static_cast<uint32_t>(of_.row.size())) <= near()) break;
    for (uint32_t k = 0; k < of_.node.size(); ++k)
        if (!is_split(k)) std::copy_n(&of_.velocity[k * kDof], size_of(k), &b_.solution[size_t{of_.node[k]} * kDof]);
    for (uint32_t i = 0; i < b_.nodes.size(); ++i)
        if (const uint32_t part = b_.part[i]; part != kNone)
            Vec3::Map(&b_.solution[size_t{i} * kDof]) += whole.shift_of(part);
}

void ContactSplit::add_metric() {
    for (uint32_t i = 0; i < of_.node.size(); ++i) {
        double* r = at(of_.metric, i);
        double* inverse = at(of_.inverse, i);
        const int size = size_of(i);
        b_.matrix.read(of_.node[i], r);
        if (size == 3) {
            if (is_split(i)) RowMat3::Map(r) = mean_of(RowMat3::Map(r), of_.load[i]);
            RowMat3::Map(inverse) = RowMat3::Map(r).inverse();
        } else {
            if (is_split(i)) Mat6::Map(r) *= std::sqrt(of_.load[i] / mass_of(of_.node[i]));
            Mat6::Map(inverse) = Mat6::Map(r).llt().solve(Mat6::Identity());
        }
        if (is_split(i)) b_.matrix.add(b_.places[of_.node[i]], {r, size, size, size});
    }
}

void ContactSplit::add_known(double* side) const {
    for (uint32_t i = 0; i < of_.node.size(); ++i) {
        if (!is_split(i)) continue;
        const int size = size_of(i);
        const double* r = at(of_.metric, i);
        const double* z = &of_.velocity[i * kDof];
        double* to = side + size_t{of_.node[i]} * kDof;
        for (int a = 0; a < size; ++a)
            for (int b = 0; b < size; ++b) to[a] += r[a * size + b] * z[b];
    }
}

// R^-1 J^T and J R^-1 J^T + c of the rows.
void ContactSplit::build() {
    const auto rows = set_.rows();
    for (uint32_t k = 0; k < rows.size(); ++k) {
        BoundedRow& row = rows[k];
        double sum = 0;
        for (RowTouch& to : touches(k)) {
            const uint32_t slot = to.at / kDof, first = to.at % kDof;
            const auto size = static_cast<uint32_t>(size_of(slot));
            const double* inverse = at(of_.inverse, slot) + first * size;
            Vec3 g = Vec3::Zero();
            for (const RowTouch& from : touches(k)) {
                if (from.at / kDof != slot) continue;
                const double* m = inverse + from.at % kDof;
                for (uint32_t a = 0; a < 3; ++a, m += size)
                    g[a] += m[0] * from.j[0] + m[1] * from.j[1] + m[2] * from.j[2];
            }
            to.g = g;
            sum += to.j.dot(g);
        }
        if (row.kind == Kind::push && !row.physical) row.c = row.gap < 0 ? kYields * sum : 0;
        of_.stiffness[k] = sum + row.c;
    }
    of_.built = true;
}

double ContactSplit::miss_of(uint32_t place) const {
    const BoundedRow& row = set_.rows()[place];
    double sum = row.known + row.c * row.mu - row.goal;
    for (const RowTouch& touch : touches(place)) sum += touch.j.dot(Vec3::Map(&of_.velocity[touch.at]));
    return sum;
}

void ContactSplit::change(uint32_t first, uint32_t count, const double* by) {
    for (uint32_t k = 0; k < count; ++k)
        for (const RowTouch& touch : touches(of_.row[first + k])) Vec3::Map(&of_.velocity[touch.at]) += by[k] * touch.g;
}

// Rows that have an impulse, or would have one; frictions with what loads them.
void ContactSplit::list_rows() {
    const auto rows = set_.rows();
    of_.row.clear();
    const auto is_loaded = [&](const BoundedRow& lead) {
        for (uint32_t k = 0; k < lead.loads; ++k)
            if (of_.listed[lead.load + kContactRows * k]) return lead.limit > 0;
        return false;
    };
    for (uint32_t i = 0, width; i < rows.size(); i += width) {
        const BoundedRow& lead = rows[i];
        width = std::max<uint32_t>(1, lead.width);
        const bool is_in = lead.kind == Kind::push      ? lead.mu > 0 || miss_of(i) < 0
                           : lead.kind == Kind::tangent ? is_loaded(lead)
                                                        : true;
        for (uint32_t k = i; k < i + width; ++k) {
            of_.listed[k] = is_in;
            if (is_in) of_.row.push_back(k);
        }
    }
}

double ContactSplit::improve() {
    if (!of_.built) build();
    double apart = 0;  // [m/s]
    for (uint32_t i = 0; i < of_.node.size(); ++i) {
        const double* x = &b_.solution[of_.node[i] * kDof];
        double* z = &of_.velocity[i * kDof];
        const double over = is_split(i) ? kOver : 1;
        for (int a = 0; a < size_of(i); ++a) {
            const double way = x[a] - z[a];
            if (is_split(i) && a < 3) apart = std::max(apart, std::abs(way));
            z[a] += over * way;
        }
    }
    list_rows();
    const double least = std::max(near(), kShare * apart);
    double miss = 0;
    for (uint32_t sweep = 0; sweep < kMostLawSweeps; ++sweep) {
        ++s_.report.rounds;
        const double now = sweep_laws(*this, set_.rows(), static_cast<uint32_t>(of_.row.size()));
        miss = std::max(miss, now);
        if (now <= least) break;
    }
    return std::max(apart, miss);
}

}  // namespace taut
