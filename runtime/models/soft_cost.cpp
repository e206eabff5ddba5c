#include "models/soft_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

constexpr double kNs = 1e-9;
constexpr double kSheetPair = 8 * kNs, kSolidPair = 0.1 * kNs;  // of a factor
constexpr double kEnergyForm = 9 * kNs, kFoldedForm = 2 * kNs;  // of an element, by the square of its freedoms
constexpr double kSweptNode = 20 * kNs, kSweptEntry = 1.1 * kNs;
constexpr double kNever = std::numeric_limits<double>::infinity();

// Pairs of vertices that elements couple, each once.
size_t couplings_of(const SoftPlan& plan) {
    Array<uint64_t> pairs(plan.position.get_allocator());
    for (const ElementPlan& of : plan.element) {
        const auto nodes = static_cast<size_t>(of.type->row.nodes);
        for (size_t e = 0; e < of.softness.size(); ++e)
            for (size_t a = 0; a < nodes; ++a)
                for (size_t b = 0; b < a; ++b)
                    pairs.push_back(pair_key(of.vertex[e * nodes + a], of.vertex[e * nodes + b]));
    }
    std::ranges::sort(pairs);
    return static_cast<size_t>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
}

// The square of how fast the stiffest element of a set swings, over what sweeps hold of it [1/s^2].
double stiffest(const SoftPlan& plan, const ElementPlan& of) {
    const ConstraintType& row = of.type->row;
    const auto nodes = static_cast<size_t>(row.nodes), numbers = static_cast<size_t>(of.type->numbers);
    ElementSet material(*plan.position.get_allocator().memory);
    material.type = of.type;
    set_compliance(material, {of.compliance, static_cast<size_t>(row.rows * row.rows)}, of.relaxation);
    if (of.compliance[0] == 0) return kNever;
    double most = 0;
    for (size_t e = 0; e < of.softness.size(); ++e) {
        Pose x[kMaxNodes];
        double inverse[kMaxNodes];
        for (size_t n = 0; n < nodes; ++n) {
            const uint32_t vertex = of.vertex[e * nodes + n];
            x[n].x = plan.position[vertex];
            inverse[n] = 1 / plan.soft.mass[vertex];
        }
        const Swing swing = swing_of(row, material.stiffness, &of.data[e * numbers], of.softness[e], x, inverse);
        most = std::max(most, of.resolved ? swing.rate : swing.yield / of.tolerance);
    }
    return most;
}

// h of rate (h^2 + d h) = 1 [s].
double substep_of(double rate, double d) {
    if (rate == 0) return kNever;
    return rate < kNever ? 2 / (rate * (d + std::sqrt(d * d + 4 / rate))) : 0;
}

// N g / (4 L) over the tolerance of a sheet [1/s^2].
double of_own_weight(const World& world, const SoftPlan& plan, double tolerance) {
    const taut_vec3& g = world.def.gravity;
    double length = 0;
    const auto& corner = plan.soft.triangle;
    for (size_t t = 0; t < corner.size(); t += 3)
        for (size_t k = 0; k < 3; ++k)
            length += (plan.position[corner[t + k]] - plan.position[corner[t + (k + 1) % 3]]).norm();
    length /= static_cast<double>(corner.size());
    const double fall = std::abs(plan.soft.gravity_scale) * Vec3(g.x, g.y, g.z).norm();
    return static_cast<double>(plan.position.size()) * fall / (4 * length * tolerance);
}

}  // namespace

SoftCost cost_of(const World& world, const SoftPlan& plan) {
    SoftCost cost;
    const bool solid = plan.soft.kind == SoftKind::solid;
    const double step = world.def.time_step, least = world.least_substeps();
    const auto pairs = static_cast<double>(couplings_of(plan));
    double direct = solid ? kSolidPair * pairs * pairs : kSheetPair * pairs * std::sqrt(pairs);
    double swept = kSweptNode * static_cast<double>(plan.position.size()), shortest = step / least, weight = 0;
    bool sweeps = true;
    for (const ElementPlan& of : plan.element) {
        const double width = of.type->row.nodes * of.type->freedoms;
        const auto count = static_cast<double>(of.softness.size());
        direct += count * width * width * (of.form == ElementForm::energy ? kEnergyForm : kFoldedForm);
        swept += count * width * of.type->row.rows * kSweptEntry;
        sweeps = sweeps && of.type->sweep;
        if (!sweeps || of.tolerance == 0 || of.softness.empty()) continue;
        shortest = std::min(shortest, substep_of(stiffest(plan, of), of.relaxation));
        if (!solid) weight = std::max(weight, of_own_weight(world, plan, of.tolerance));
    }
    cost.direct = least * direct;
    cost.substeps = std::ceil(step / shortest);
    cost.least_substeps = solid ? kNever : std::max(least, std::ceil(step * std::sqrt(weight)));
    const double most = world.def.fixed_substeps != 0 ? least : kMostElasticSubsteps;
    const auto of = [&](double n) { return sweeps && n <= most ? n * swept : kNever; };
    cost.swept = of(cost.substeps);
    cost.swept_least = of(cost.least_substeps);
    return cost;
}

JointSolve cheapest_solve(const World& world, const SoftPlan& plan) {
    const SoftCost cost = cost_of(world, plan);
    const bool too_long = cost.direct > static_cast<double>(world.def.time_step);
    return std::min(cost.swept, too_long ? cost.swept_least : kNever) < cost.direct ? JointSolve::swept
                                                                                    : JointSolve::direct;
}

}  // namespace taut
