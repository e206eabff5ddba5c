// The energy of one island in a substep, over the displacements of its points,
//   E = 1/2 |x - y|^2_M / a + sum W(x) + 1/2 (x - x_n)^T B (x - x_n)/h + c/t sum Phi(x),   y = x_n + h u*,   a = h t
// of any scheme (system/scheme.h), with W of the elements, B their damping, of x_n and positive (Gast and Schroeder
// 2014, section 4: lagged) and by the velocity that moves the points, as rows have it, and Phi of contacts. The
// unknowns are z = s (x - x_n) with s = sqrt(m/a) [sqrt(J)], in which inertia has the matrix 1; held points have none.
// Points are kept out of obstacles by projection (point_contacts.h): what is evaluated is E(P(x)).
// In statics 1/a and B are 0, and E = sum W(x) - f . (x - x_n) with the external forces f.
#pragma once

#include "linear/block_rows.h"
#include "solvers/minimisation.h"
#include "solvers/point_contacts.h"
#include "solvers/point_penalties.h"
#include "solvers/solid_contacts.h"
#include "solvers/solver.h"
#include "solvers/turning_path.h"

namespace taut {

class IslandEnergy final : public Objective {
public:
    IslandEnergy(Substep& substep, const EnergyIsland& island, bool statics);

    uint32_t size() const override { return 3 * island_.points; }
    double evaluate(std::span<double> z, std::span<double> gradient) override;
    void hold(std::span<double> z, std::span<double> gradient) override;
    void linearise(std::span<double> z, Hessian which) override;
    void multiply(std::span<const double> d, std::span<double> out) override;
    // Of the blocks on the diagonal, each by its own.
    void precondition(std::span<const double> r, std::span<double> out) override;
    double direct_cost() const override;
    bool solve(std::span<double> x) override;
    double size_of_terms() const override { return terms_; }
    void begin_path(std::span<const double> z, std::span<const double> d) override { path_.begin(z, d); }
    void follow(std::span<const double> z, std::span<const double> d, double part, std::span<double> place,
                std::span<double> way) override {
        path_.follow(z, d, part, place, way);
    }

    // Makes z the place of the last evaluation, which it is as a rule.
    void settle_at(std::span<double> z, std::span<double> gradient);
    // Lets go of points that obstacles hold.
    void release() { contacts_.release(); }
    // Damping, at x_n.
    void find_damping();
    double mass() const { return mass_; }  // of its free points [kg]
    // lambda = -D C at the places of the last evaluation, of sets that keep it.
    void store_forces() const;
    // Add dE/dz of elements and their damping, and of contacts, at the place of the last evaluation with a gradient.
    void add_springs(std::span<double> gradient) const;
    void add_penalties(std::span<double> gradient) const;

private:
    template <class Act>
    void for_batches(Act&& act) const;
    ElementBatch view(const EnergyBatch& batch) const;
    // Null where its set's energy does not come in lanes.
    const EnergyKernel* kernel_of(const EnergyBatch& batch) const;
    EnergyLanes lanes_of(const EnergyBatch& batch) const;
    double* frame_of(const EnergyBatch& batch) const { return &m_.frame[size_t{batch.frame} * kFrameNumbers]; }
    double sum_of_energies() const;
    void place(std::span<double> z);
    void find_errors(const EnergyBatch& batch, double* error, double* jacobian) const;
    bool is_slack(const EnergyBatch& batch, const double* error) const { return batch.set->pulls && !(*error > 0); }
    void stress_of(const EnergyBatch& batch, uint32_t i, const double* error, double* out) const;
    void find_energies(const EnergyBatch& batch, bool with_force) const;
    void find_matrices(const EnergyBatch& batch, const double* error, Curvature part, double* out) const;
    double* errors_of(const EnergyBatch& batch) const { return &m_.error[size_t{batch.first} * kMaxRows]; }
    std::span<double> at() const { return {&m_.at[3 * size_t{island_.first_point}], 3 * size_t{island_.points}}; }
    // dE'/dz of the last evaluation with a gradient.
    std::span<double> raw() const { return {&m_.raw[3 * size_t{island_.first_point}], 3 * size_t{island_.points}}; }
    void find_damping_of(const EnergyBatch& batch, double* out, double* push) const;
    void find_inverses();
    void scatter(const EnergyBatch& batch, const double* matrix, Array<double>& into) const;
    template <class Find, class Take>
    void for_matrices(Find&& find, Take&& take) const;
    void multiply(const Array<double>& matrix, const double* d, double* out) const;

    Substep& s_;
    const EnergyIsland& island_;
    MinimisationMemory& m_;
    PointContacts contacts_;
    PointPenalties penalties_;
    SolidContacts solids_;
    TurningPath path_;
    const EnergyKernels& kernels_ = energy_kernels();
    const MultiplyRows multiply_rows_ = multiply_rows();
    const bool statics_, damped_;
    double terms_ = 0;  // [J]
    double mass_ = 0;
};

}  // namespace taut
