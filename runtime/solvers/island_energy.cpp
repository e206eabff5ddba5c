#include "solvers/island_energy.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

constexpr uint32_t kEnergyGrain = 4;   // batches that a thread takes at a time, some 20 us
constexpr uint32_t kPointGrain = 128;  // points, likewise
constexpr uint32_t kEnergyChunk = 64;  // batches of which matrices wait to be added, in one order whoever made them
constexpr uint32_t kEnergyWidth = 3 * kMaxNodes, kEnergyMatrix = kEnergyWidth * kEnergyWidth;

uint32_t nodes_in(const EnergyBatch& batch) { return static_cast<uint32_t>(batch.set->type->row.nodes); }
uint32_t rows_in(const EnergyBatch& batch) { return static_cast<uint32_t>(batch.set->type->row.rows); }

}  // namespace

IslandEnergy::IslandEnergy(Substep& substep, const EnergyIsland& island, bool statics)
    : s_(substep),
      island_(island),
      m_(substep.scratch.minimisation.get()),
      contacts_(substep.team, island, m_),
      penalties_(substep.team, island, m_, substep.system.scheme.contact_act() / substep.system.scheme.act),
      solids_(substep.team, island, m_, substep.system.scheme.contact_act() / substep.system.scheme.act),
      path_(substep.team, island, m_),
      statics_(statics),
      damped_(island.damped && !statics) {
    at()[0] = std::numeric_limits<double>::quiet_NaN();  // nothing is known yet
    for (uint32_t p = island.first_point; p < island.first_point + island.points; ++p)
        if (m_.free[p]) mass_ += m_.scale[p] * m_.scale[p] * s_.system.scheme.stiffness();
}

// act(batch), several at once.
template <class Act>
void IslandEnergy::for_batches(Act&& act) const {
    s_.team.for_ranges(island_.batches, kEnergyGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t b = begin; b < end; ++b) act(m_.batch[island_.first_batch + b]);
    });
}

ElementBatch IslandEnergy::view(const EnergyBatch& batch) const {
    return {batch.count, &m_.point_of[batch.node], &m_.element[batch.first], batch.set->data.data(), m_.pose.data()};
}

const EnergyKernel* IslandEnergy::kernel_of(const EnergyBatch& batch) const {
    return batch.set->type->energy ? &(kernels_.*batch.set->type->energy) : nullptr;
}

EnergyLanes IslandEnergy::lanes_of(const EnergyBatch& batch) const {
    static_assert(sizeof(Pose) % sizeof(double) == 0);
    return {batch.count,
            &m_.point_of[batch.node],
            &m_.element[batch.first],
            batch.set->data.data(),
            m_.pose.data()->x.data(),
            sizeof(Pose) / sizeof(double),
            batch.set->stiffness,
            batch.set->softness.data()};
}

void IslandEnergy::place(std::span<double> z) {
    for (uint32_t i = 0; i < island_.points; ++i) {
        const uint32_t p = island_.first_point + i;
        m_.pose[p].x = m_.begin[p] + (m_.free[p] ? Vec3(Vec3::Map(&z[3 * i]) / m_.scale[p]) : m_.led[p]);
    }
    if (!contacts_.any()) return;
    contacts_.project();
    for (uint32_t i = 0; i < island_.points; ++i) {
        const uint32_t p = island_.first_point + i;
        if (m_.touch[p].count > 0) Vec3::Map(&z[3 * i]) = m_.scale[p] * (m_.pose[p].x - m_.begin[p]);
    }
}

// Of a change of length what comes within the frame's other substeps is left out.
void IslandEnergy::find_errors(const EnergyBatch& batch, double* error, double* jacobian) const {
    batch.set->type->evaluate(view(batch), error, jacobian, 3);
    if (s_.system.frame_left == 0) return;
    for (uint32_t i = 0; i < batch.count; ++i)
        for (uint32_t r = 0; r < rows_in(batch); ++r)
            error[i * rows_in(batch) + r] -= s_.system.frame_left * batch.set->drift_of(m_.element[batch.first + i])[r];
}

// D C [N, N m].
void IslandEnergy::stress_of(const EnergyBatch& batch, uint32_t i, const double* error, double* out) const {
    const uint32_t rows = rows_in(batch);
    const double scale = 1 / batch.set->softness[m_.element[batch.first + i]];
    for (uint32_t r = 0; r < rows; ++r) {
        double sum = 0;
        for (uint32_t k = 0; k < rows; ++k) sum += batch.set->stiffness[r * rows + k] * error[k];
        out[r] = scale * sum;
    }
}

void IslandEnergy::find_energies(const EnergyBatch& batch, bool with_force) const {
    if (const EnergyKernel* const kernel = kernel_of(batch)) {
        double* const force = with_force ? &m_.force[3 * size_t{batch.node}] : nullptr;
        return kernel->evaluate(lanes_of(batch), frame_of(batch), &m_.energy[batch.first], force);
    }
    const uint32_t rows = rows_in(batch), nodes = nodes_in(batch);
    double error[kEnergyBatch * kMaxRows], jacobian[kEnergyBatch * kMaxNodes * kMaxRows * 3];
    find_errors(batch, error, with_force ? jacobian : nullptr);
    std::copy_n(error, batch.count * rows, errors_of(batch));
    for (uint32_t i = 0; i < batch.count; ++i) {
        const double* c = error + i * rows;
        double f[kMaxRows] = {}, sum = 0;
        if (!is_slack(batch, c)) stress_of(batch, i, c, f);
        for (uint32_t r = 0; r < rows; ++r) sum += 0.5 * f[r] * c[r];
        m_.energy[batch.first + i] = sum;
        if (!with_force) continue;
        for (uint32_t n = 0; n < nodes; ++n) {
            Vec3 force = Vec3::Zero();
            for (uint32_t r = 0; r < rows; ++r)
                if (f[r] != 0) force += f[r] * Vec3::Map(jacobian + ((i * nodes + n) * rows + r) * 3);
            Vec3::Map(&m_.force[3 * size_t{batch.node + i * nodes + n}]) = force;
        }
    }
}

double IslandEnergy::sum_of_energies() const {
    const EnergyBatch& last = m_.batch[island_.first_batch + island_.batches - 1];
    double sum = 0;
    for (uint32_t e = m_.batch[island_.first_batch].first; e < last.first + last.count; ++e) sum += m_.energy[e];
    return sum;
}

double IslandEnergy::evaluate(std::span<double> z, std::span<double> gradient) {
    place(z);
    std::ranges::copy(z, at().begin());
    for_batches([&](const EnergyBatch& batch) { find_energies(batch, !gradient.empty()); });
    const std::span<const double> wanted(&m_.wanted[3 * size_t{island_.first_point}], size());
    const double elastic =
        sum_of_energies() + (solids_.any() ? solids_.evaluate() : 0) + (penalties_.any() ? penalties_.evaluate() : 0);
    double inertia = 0, damping = 0;
    if (statics_)
        inertia = -2 * dot_of(z, wanted);
    else
        for (uint32_t i = 0; i < size(); ++i) inertia += (z[i] - wanted[i]) * (z[i] - wanted[i]);
    if (damped_) {
        multiply(m_.damping, z.data(), m_.damped.data());
        const std::span<double> bz(m_.damped.data(), size());
        const std::span<const double> bias(&m_.bias[3 * size_t{island_.first_point}], size());
        damping = 0.5 * dot_of(z, bz) + dot_of(z, bias);
        for (uint32_t i = 0; i < size(); ++i) bz[i] += bias[i];
    }
    terms_ = std::abs(0.5 * inertia) + elastic + std::abs(damping);
    if (gradient.empty()) return 0.5 * inertia + elastic + damping;
    for (uint32_t i = 0; i < size(); ++i) gradient[i] = (statics_ ? 0 : z[i]) - wanted[i];
    add_springs(gradient);
    add_penalties(gradient);
    if (contacts_.any()) {
        std::ranges::copy(gradient, raw().begin());
        contacts_.pull_back(gradient);
    }
    return 0.5 * inertia + elastic + damping;
}

void IslandEnergy::add_springs(std::span<double> gradient) const {
    if (damped_)
        for (uint32_t i = 0; i < size(); ++i) gradient[i] += m_.damped[i];
    const EnergyBatch& last = m_.batch[island_.first_batch + island_.batches - 1];
    const uint32_t end = last.node + last.count * nodes_in(last);
    for (uint32_t k = m_.batch[island_.first_batch].node; k < end; ++k) {
        const uint32_t p = m_.point_of[k];
        if (m_.free[p])
            Vec3::Map(&gradient[3 * (p - island_.first_point)]) += Vec3::Map(&m_.force[3 * size_t{k}]) / m_.scale[p];
    }
}

void IslandEnergy::add_penalties(std::span<double> gradient) const {
    if (solids_.any()) solids_.add_gradient(gradient);
    if (penalties_.any()) penalties_.add_gradient(gradient);
}

void IslandEnergy::hold(std::span<double> z, std::span<double> gradient) {
    if (!contacts_.any()) return;
    settle_at(z, gradient);
    std::ranges::copy(raw(), gradient.begin());
    contacts_.hold(gradient);
}

void IslandEnergy::settle_at(std::span<double> z, std::span<double> gradient) {
    if (!std::ranges::equal(z, at())) evaluate(z, gradient);
}

// ---------------------------------------------------------------- matrices

// [element][3 nodes][3 nodes]: J^T D J + K.
void IslandEnergy::find_matrices(const EnergyBatch& batch, const double* error, Curvature part, double* out) const {
    const uint32_t rows = rows_in(batch), width = 3 * nodes_in(batch);
    double lambda[kEnergyBatch * kMaxRows];
    for (uint32_t i = 0; i < batch.count; ++i) {
        stress_of(batch, i, error + i * rows, lambda + i * rows);
        for (uint32_t r = i * rows; r < (i + 1) * rows; ++r) lambda[r] = -lambda[r];
    }
    element_hessian(*batch.set->type, view(batch), {batch.set->stiffness, batch.set->softness.data()}, lambda, part,
                    out);
    for (uint32_t i = 0; i < batch.count; ++i)
        if (is_slack(batch, error + i * rows)) std::fill_n(out + i * width * width, width * width, 0.0);
}

// The same of damping over h: d J^T D J but for the part of Rayleigh's, which is of the whole matrix. push: what an
// element's own change of length does to it, [element][3 nodes] [N].
void IslandEnergy::find_damping_of(const EnergyBatch& batch, double* out, double* push) const {
    const uint32_t rows = rows_in(batch), nodes = nodes_in(batch), width = 3 * nodes;
    const double h = s_.system.scheme.h, along = batch.set->relaxation - batch.set->rayleigh;
    std::fill_n(out, batch.count * width * width, 0.0);
    std::fill_n(push, batch.count * width, 0.0);
    if (!(batch.set->relaxation > 0)) return;
    double error[kEnergyBatch * kMaxRows], jacobian[kEnergyBatch * kMaxNodes * kMaxRows * 3];
    find_errors(batch, error, jacobian);
    if (batch.set->rayleigh > 0) find_matrices(batch, error, Curvature::positive, out);
    for (uint32_t i = 0; i < batch.count; ++i) {
        double* const matrix = out + i * width * width;
        for (uint32_t k = 0; k < width * width; ++k) matrix[k] *= batch.set->rayleigh / h;
        if (is_slack(batch, error + i * rows)) continue;
        const auto slope = [&](uint32_t r, uint32_t k) {
            return jacobian[((i * nodes + k / 3) * rows + r) * 3 + k % 3];
        };
        const double* const drift = batch.set->drift_of(m_.element[batch.first + i]);
        double f[kMaxRows];
        stress_of(batch, i, drift, f);
        for (uint32_t k = 0; k < width; ++k) {
            double column[kMaxRows], stress[kMaxRows];
            for (uint32_t r = 0; r < rows; ++r) column[r] = slope(r, k);
            stress_of(batch, i, column, stress);
            for (uint32_t r = 0; r < rows; ++r) {
                push[i * width + k] += batch.set->relaxation / s_.system.frame * f[r] * column[r];
                for (uint32_t l = 0; l < width; ++l) matrix[k * width + l] += along / h * stress[r] * slope(r, l);
            }
        }
    }
}

// Between free points, in z. Both matrices are symmetric: what is a block by rows of one is by columns of the other.
void IslandEnergy::scatter(const EnergyBatch& batch, const double* matrix, Array<double>& into) const {
    const uint32_t nodes = nodes_in(batch), width = 3 * nodes;
    const uint32_t* point = &m_.point_of[batch.node];
    const uint32_t* block = &m_.block_of[batch.block];
    for (uint32_t i = 0; i < batch.count; ++i, matrix += width * width, point += nodes) {
        double inverse[kMaxNodes];  // of s; a held point has none
        for (uint32_t n = 0; n < nodes; ++n) inverse[n] = m_.free[point[n]] ? 1 / m_.scale[point[n]] : 0;
        for (uint32_t n = 0; n < nodes; ++n)
            for (uint32_t m = 0; m < nodes; ++m, ++block) {
                const double scale = inverse[n] * inverse[m];
                if (scale == 0) continue;
                double* const to = &into[9 * size_t{*block}];
                const double* const from = matrix + 3 * m * width + 3 * n;
                for (uint32_t r = 0; r < 3; ++r)
                    for (uint32_t c = 0; c < 3; ++c) to[3 * r + c] += scale * from[r * width + c];
            }
    }
}

// find(batch, out) of several batches at once, then take(batch, out) in their order.
template <class Find, class Take>
void IslandEnergy::for_matrices(Find&& find, Take&& take) const {
    constexpr uint32_t kRoom = kEnergyBatch * (kEnergyMatrix + kEnergyWidth);
    m_.matrix.resize(size_t{kEnergyChunk} * kRoom);
    for (uint32_t begin = 0; begin < island_.batches; begin += kEnergyChunk) {
        const uint32_t count = std::min(kEnergyChunk, island_.batches - begin);
        const EnergyBatch* const batch = &m_.batch[island_.first_batch + begin];
        s_.team.for_ranges(count, kEnergyGrain, [&](uint32_t from, uint32_t to) {
            for (uint32_t b = from; b < to; ++b) find(batch[b], &m_.matrix[size_t{b} * kRoom]);
        });
        for (uint32_t b = 0; b < count; ++b) take(batch[b], &m_.matrix[size_t{b} * kRoom]);
    }
}

void IslandEnergy::linearise(std::span<double> z, Hessian which) {
    settle_at(z, {});
    const uint32_t begin = m_.row_begin[island_.first_point], end = m_.row_begin[island_.first_point + island_.points];
    if (damped_)
        std::copy_n(m_.damping.begin() + 9 * begin, 9 * (end - begin), m_.hessian.begin() + 9 * begin);
    else
        std::fill_n(m_.hessian.begin() + 9 * begin, 9 * (end - begin), 0.0);
    for_matrices(
        [&](const EnergyBatch& batch, double* out) {
            if (const EnergyKernel* const kernel = kernel_of(batch))
                return kernel->hessian(lanes_of(batch), frame_of(batch), which == Hessian::positive, out);
            find_matrices(batch, errors_of(batch), which == Hessian::positive ? Curvature::positive : Curvature::raw,
                          out);
        },
        [&](const EnergyBatch& batch, const double* out) { scatter(batch, out, m_.hessian); });
    if (penalties_.any()) penalties_.add_matrix(which, m_.hessian);
    if (contacts_.any()) contacts_.restrict(which, m_.hessian);
    if (solids_.any()) solids_.linearise(which);
    find_inverses();
}

void IslandEnergy::find_inverses() {
    const uint32_t first = island_.first_point;
    for (uint32_t p = first; p < first + island_.points; ++p) {
        m_.inverse[p] = Mat3::Map(&m_.hessian[9 * size_t{m_.diagonal[p]}]);
        if (!statics_) m_.inverse[p].diagonal().array() += 1;
    }
    if (solids_.any()) solids_.add_diagonal({&m_.inverse[first], island_.points});
    s_.team.for_ranges(island_.points, kPointGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t p = first + begin; p < first + end; ++p) {
            const Eigen::LLT<Mat3> factor(m_.inverse[p]);
            m_.inverse[p] = Mat3::Identity();
            if (factor.info() == Eigen::Success) factor.solveInPlace(m_.inverse[p]);
        }
    });
}

void IslandEnergy::precondition(std::span<const double> r, std::span<double> out) {
    s_.team.for_ranges(island_.points, kPointGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            Vec3::Map(&out[3 * size_t{i}]) = m_.inverse[island_.first_point + i] * Vec3::Map(&r[3 * size_t{i}]);
    });
}

void IslandEnergy::find_damping() {
    const uint32_t begin = m_.row_begin[island_.first_point], end = m_.row_begin[island_.first_point + island_.points];
    std::fill_n(m_.bias.begin() + 3 * island_.first_point, size(), 0.0);
    if (!damped_) return;
    std::fill_n(m_.damping.begin() + 9 * begin, 9 * (end - begin), 0.0);
    for (uint32_t p = island_.first_point; p < island_.first_point + island_.points; ++p) m_.pose[p].x = m_.begin[p];
    const auto push_of = [](const EnergyBatch& batch, auto* out) {
        return out + batch.count * 9 * nodes_in(batch) * nodes_in(batch);
    };
    for_matrices([&](const EnergyBatch& batch, double* out) { find_damping_of(batch, out, push_of(batch, out)); },
                 [&](const EnergyBatch& batch, const double* out) {
                     scatter(batch, out, m_.damping);
                     const uint32_t nodes = nodes_in(batch), width = 3 * nodes;
                     for (uint32_t i = 0; i < batch.count; ++i)
                         for (uint32_t k = 0; k < width; ++k) {
                             const uint32_t p = m_.point_of[batch.node + i * nodes + k / 3];
                             if (!m_.free[p]) continue;
                             double sum = push_of(batch, out)[i * width + k];
                             for (uint32_t l = 0; l < width; ++l) {  // of held points, whose way is known
                                 const uint32_t q = m_.point_of[batch.node + i * nodes + l / 3];
                                 if (!m_.free[q]) sum += out[(i * width + k) * width + l] * m_.led[q][l % 3];
                             }
                             m_.bias[3 * size_t{p} + k % 3] += sum / m_.scale[p];
                         }
                 });
}

void IslandEnergy::multiply(const Array<double>& matrix, const double* d, double* out) const {
    const BlockRows rows{m_.row_begin.data(), m_.column.data(), matrix.data()};
    s_.team.for_ranges(island_.points, kPointGrain, [&](uint32_t begin, uint32_t end) {
        multiply_rows_(rows, island_.first_point + begin, island_.first_point + end, island_.first_point, d, out);
    });
}

void IslandEnergy::multiply(std::span<const double> d, std::span<double> out) {
    multiply(m_.hessian, d.data(), out.data());
    if (solids_.any()) solids_.add_product(d.data(), out.data());
    if (statics_) return;
    for (size_t i = 0; i < d.size(); ++i) out[i] += d[i];
}

// Of an elimination in the order of points, which no good order exceeds: row by row 27 operations for each pair of the
// blocks from its first one to the diagonal. A product has 18 for each block. Soft bodies that touch are tied beyond
// these blocks.
double IslandEnergy::direct_cost() const {
    if (solids_.any()) return std::numeric_limits<double>::infinity();
    double pairs = 0;
    for (uint32_t p = island_.first_point; p < island_.first_point + island_.points; ++p) {
        const double reach = p - m_.column[m_.row_begin[p]];
        pairs += (reach + 1) * (reach + 1);
    }
    const uint32_t blocks = m_.row_begin[island_.first_point + island_.points] - m_.row_begin[island_.first_point];
    return 27 * pairs / (18.0 * blocks);
}

bool IslandEnergy::solve(std::span<double> x) {
    SparseBlockLdlt& factor = m_.factor[static_cast<size_t>(&island_ - m_.island.data())];
    const uint32_t first = island_.first_point;
    const auto for_lower = [&](auto&& act) {
        for (uint32_t i = 0; i < island_.points; ++i)
            for (uint32_t b = m_.row_begin[first + i]; b < m_.row_begin[first + i + 1]; ++b)
                if (m_.column[b] <= first + i) act(i, m_.column[b] - first, b);
    };
    if (!factor.analysed()) {
        factor.begin(island_.points);
        for (uint32_t i = 0; i < island_.points; ++i) factor.set_unknown(i, 3, false);
        for_lower([&](uint32_t i, uint32_t k, uint32_t) { factor.link(i, k); });
        factor.analyse();
    }
    factor.clear();
    // By columns a block of the lower half is what its mirror is by rows.
    const Mat3 one = Mat3::Identity();
    for_lower([&](uint32_t i, uint32_t k, uint32_t b) {
        factor.add(factor.place(k, i), {&m_.hessian[9 * size_t{b}], 3, 3, 3});
        if (i == k && (!statics_ || !m_.free[first + i])) factor.add(factor.place(i, i), {one.data(), 3, 3, 3});
    });
    if (!factor.factor()) return false;
    m_.solution.resize(6 * size_t{island_.points});
    for (uint32_t i = 0; i < island_.points; ++i) std::copy_n(&x[3 * i], 3, &m_.solution[6 * size_t{i}]);
    factor.solve(m_.solution.data());
    for (uint32_t i = 0; i < island_.points; ++i) std::copy_n(&m_.solution[6 * size_t{i}], 3, &x[3 * i]);
    return true;
}

void IslandEnergy::store_forces() const {
    for_batches([&](const EnergyBatch& batch) {
        if (batch.set->form == ElementForm::energy && !batch.set->pulls) return;
        const uint32_t rows = rows_in(batch);
        double error[kEnergyBatch * kMaxRows], f[kMaxRows];
        find_errors(batch, error, nullptr);
        for (uint32_t i = 0; i < batch.count; ++i) {
            double* const lambda = batch.set->lambda_of(m_.element[batch.first + i]);
            const bool slack = is_slack(batch, error + i * rows);
            stress_of(batch, i, error + i * rows, f);
            for (uint32_t r = 0; r < rows; ++r) lambda[r] = slack ? 0 : -f[r];
            batch.set->fresh[m_.element[batch.first + i]] = 0;
        }
    });
}

}  // namespace taut
