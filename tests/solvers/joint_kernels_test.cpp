// The sweep of joints in lanes: the same bits from its three builds, and the impulses that its equations give one by
// one in double precision.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "constraints/instance.h"
#include "constraints/random.h"
#include "constraints/soft_contact.h"
#include "system/assemble.h"
#include "system/axis_rows.h"
#include "widths.h"

namespace taut::test {
namespace {

constexpr double kStep = 1.0 / 240;
constexpr uint32_t kJoints = 60;

// Random joints of every type, of which no two share a body, some with compliance, stops, drives and friction.
struct Mechanism {
    struct Part {
        Part(const ConstraintType& type, uint64_t seed) : instance(type, seed) {}
        Instance instance;
        std::array<Axis, kMaxRows> axis{};
        std::array<AxisMemory, kMaxRows> memory{};
        std::array<double, kMaxRows> force{}, drift{};
        Matrix compliance;
    };

    explicit Mechanism(uint64_t seed) : team(taut_hooks{}, 1) {
        Random random(seed);
        system.scheme.set_length(kStep);
        system.sweep.resize(1 + kMaxNodes * kJoints);
        system.pose.resize(1 + kMaxNodes * kJoints);
        system.sweep_pose.resize(1 + kMaxNodes * kJoints);
        system.found.resize(1 + kMaxNodes * kJoints);
        system.filtered.resize(1 + kMaxNodes * kJoints);
        group.joint_colour_begin.assign(kMaxColours + 1, kJoints);
        group.joint_colour_begin[0] = 0;
        group.element_colour_begin.assign(kMaxColours + 1, 0);
        std::vector<const ConstraintType*> types;
        for (const ConstraintType* type : constraint_types())
            if (type->bound == Bound::free) types.push_back(type);
        parts.reserve(kJoints);
        for (uint32_t j = 0; j < kJoints; ++j)
            add(*types[static_cast<size_t>(random.unit() * static_cast<double>(types.size()))], seed * 1000 + j,
                random);
        system.rows.joints = system.rows.lasting = kJoints;
        build_joint_lanes(team, system, group, kStep);
    }

    void add(const ConstraintType& type, uint64_t seed, Random& random) {
        Part& part = parts.emplace_back(type, seed);
        RowBlock block{};
        block.type = &type;
        block.in_lanes = true;
        block.data = part.instance.data.data();
        block.force = part.force.data();
        block.drift = part.drift.data();
        block.row = static_cast<uint32_t>(system.rows.error.size());
        block.jacobian = static_cast<uint32_t>(system.rows.jacobian.size());
        const uint32_t first = 1 + kMaxNodes * static_cast<uint32_t>(parts.size() - 1);
        for (int n = 0; n < type.nodes; ++n) {
            const uint32_t node = first + static_cast<uint32_t>(n);
            const bool world = n == 0 && random.unit() < 0.2;
            block.node[n] = world ? 0 : node;
            if (!world) place(node, random);
            if (!world) move_to(node, part.instance.pose[static_cast<size_t>(n)]);
        }
        if (random.unit() < 0.3) {
            block.compliance[0] = 1e-4 * random.unit();
            block.compliance[1] = 1e-3 * random.unit();
            block.relaxation[0] = 0.01 * random.unit();
        }
        if (random.unit() < 0.6) add_axes(part, block, random);
        for (double& f : part.force) f = 3 * (2 * random.unit() - 1) / kStep;
        const auto rows = static_cast<size_t>(type.rows);
        system.rows.error.resize(system.rows.error.size() + rows, 0.0);
        system.rows.impulse.resize(system.rows.error.size(), 0.0);
        system.rows.jacobian.resize(system.rows.jacobian.size() + rows * static_cast<size_t>(type.nodes) * kDof, 0.0);
        system.rows.block.push_back(block);
    }
    void move_to(uint32_t node, const Pose& pose) {
        system.pose[node] = pose;
        system.found[node].x = pose.x;
        const Quat q(pose.R);
        for (int k = 0; k < 4; ++k) system.sweep_pose[node].q[k] = static_cast<float>(q.coeffs()[k]);
    }
    void place(uint32_t node, Random& random) {
        const Vec3 v = random.vector(), w = random.vector();
        for (int k = 0; k < 3; ++k) {
            system.sweep[node].velocity.v[k] = static_cast<float>(v[k]);
            system.sweep[node].velocity.w[k] = static_cast<float>(w[k]);
        }
        const double inv_mass = std::pow(10.0, 2 * random.unit() - 1);
        const auto along = [&](uint32_t axis) {
            return node % 7 == 6 && node % 3 == axis ? 0 : static_cast<float>(inv_mass);
        };
        system.sweep[node].set_inv_mass(static_cast<float>(inv_mass), along(0), along(1), along(2));  // some are locked
        for (int k = 0; k < 6; ++k)
            system.sweep[node].mass.inv_inertia[k] =
                static_cast<float>(inv_mass * (k < 3 ? 2 + random.unit() : 0.5 * random.unit()));
    }
    void add_axes(Part& part, RowBlock& block, Random& random) const {
        for (int r = 0; r < block.type->rows; ++r) {
            Axis& axis = part.axis[static_cast<size_t>(r)];
            const double kind = random.unit();
            axis.mode = kind < 0.4 ? AxisMode::locked : kind < 0.6 ? AxisMode::free : AxisMode::limited;
            axis.lower = static_cast<float>(-0.3 * random.unit());
            axis.upper = static_cast<float>(0.3 * random.unit());
            if (random.unit() < 0.3) axis.limit_compliance = 1e-3f;
            if (random.unit() < 0.5) {
                axis.max_force = 1000;
                axis.damping = 30;
                axis.stiffness = 200;
                axis.speed = 1;
            }
            if (random.unit() < 0.5) axis.friction = static_cast<float>(100 * random.unit());
            part.memory[static_cast<size_t>(r)] = {static_cast<float>(100 * random.unit()), 0, 5, -3};
        }
        block.axis = part.axis.data();
        block.memory = part.memory.data();
    }

    // Sweeps before and after positions are corrected, which is taken back if there are any after it.
    void run(const JointKernels& kernels, int before, int after) {
        evaluate_rows(team, system, 0, kStep);
        evaluate_joint_lanes(team, system);
        prepare_joint_lanes(team, system, kernels);
        const JointView view = system.joints.view();
        const auto groups = static_cast<uint32_t>(system.joints.group.size());
        kernels.warm_start(view, 0, groups, system.sweep.data());
        kernels.stiffen(view, 0, groups, float(kStep));
        for (int i = 0; i < before; ++i) kernels.sweep(view, 0, groups, system.sweep.data());
        kernels.keep(view, 0, groups);
        kernels.correct(view, 0, groups, system.sweep.data());
        if (after > 0) kernels.take_back(view, 0, groups, system.sweep.data());
        for (int i = 0; i < after; ++i) kernels.sweep(view, 0, groups, system.sweep.data());
        store_joint_lanes(team, system);
    }

    Memory memory{taut_hooks{}};
    Team team;
    System system{memory};
    Group group{memory};
    std::vector<Part> parts;
};

template <class T>
bool same_bits(const Array<T>& a, const Array<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const JointKernels& kernels) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(testing::Message() << kernels.name << ", seed " << seed);
        Mechanism scalar(seed), other(seed);
        scalar.run(kJointKernelsScalar, 3, 2);
        other.run(kernels, 3, 2);
        float sum = 0;
        for (const SweepNode& n : scalar.system.sweep) sum += n.velocity.v[0] + n.velocity.w[2];
        ASSERT_TRUE(std::isfinite(sum));
        ASSERT_TRUE(same_bits(scalar.system.sweep, other.system.sweep));
        for (uint32_t j = 0; j < kJoints; ++j) ASSERT_EQ(scalar.parts[j].force, other.parts[j].force);
        const auto groups = scalar.system.joints.group.size();
        ASSERT_EQ(std::memcmp(scalar.system.joints.stiffness.data(), other.system.joints.stiffness.data(),
                              groups * sizeof(LaneStiffness)),
                  0);
    }
}

TEST(JointKernels, EveryBuildHasTheBitsOfTheScalarOne) {
    for (const JointKernels* build : builds_here({TAUT_BUILDS(kJointKernels)})) {
        SCOPED_TRACE(build->name);
        expect_same_bits(*build);
    }
}

// ---------------------------------------------------------------- equations

Matrix inverse_masses(const System& system, const RowBlock& block) {
    const int size = kDof * block.type->nodes;
    Matrix w = Matrix::Zero(size, size);
    for (int n = 0; n < block.type->nodes; ++n) {
        const auto& [velocity, m] = system.sweep[block.node[n]];
        const float* i = m.inv_inertia;
        w(kDof * n, kDof * n) = m.inv_mass_x;
        w(kDof * n + 1, kDof * n + 1) = velocity.inv_mass_y;
        w(kDof * n + 2, kDof * n + 2) = velocity.inv_mass_z;
        w.block<3, 3>(kDof * n + 3, kDof * n + 3) << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
    }
    return w;
}

Vector velocities_of(const System& system, const RowBlock& block) {
    Vector u(kDof * block.type->nodes);
    for (int n = 0; n < block.type->nodes; ++n) {
        const SweepVelocity& from = system.sweep[block.node[n]].velocity;
        for (int k = 0; k < 3; ++k) {
            u[kDof * n + k] = from.v[k];
            u[kDof * n + 3 + k] = from.w[k];
        }
    }
    return u;
}

// One joint's warm start and correction, written out: joint_sweep.inl, system.h and axis.h.
struct Written {
    Vector u, p;
    double condition = 1;  // of the block of locked rows, each scaled to 1

    Written(const Mechanism& m, uint32_t j, const Vector& start) : u(start) {
        const auto& part = m.parts[j];
        const RowBlock& block = m.system.rows.block[j];
        const int rows = block.type->rows;
        Matrix jacobian = part.instance.jacobian();
        Vector error = part.instance.error();
        if (block.node[0] == 0) {  // an end on the world, which is elsewhere than the sample's node
            std::vector<double> raw(static_cast<size_t>(rows * block.type->nodes * kDof));
            Pose pose[kMaxNodes];
            for (int n = 0; n < block.type->nodes; ++n) pose[n] = m.system.pose[block.node[n]];
            block.type->evaluate(block.data, pose, error.data(), raw.data());
            for (int n = 0; n < block.type->nodes; ++n)
                for (int r = 0; r < rows; ++r)
                    for (int k = 0; k < kDof; ++k)
                        jacobian(r, n * kDof + k) = raw[static_cast<size_t>((n * rows + r) * kDof + k)];
        }
        const Matrix w = inverse_masses(m.system, block), s = jacobian * w * jacobian.transpose();
        const auto turns = [&](int r) { return block.type->evaluate_lanes && block.angular(r); };
        const auto most_friction = [&](int r) {
            const double gearing = turns(r) ? jacobian.row(r).tail<3>().norm() : 1;
            return kStep * static_cast<double>(part.axis[static_cast<size_t>(r)].friction) / gearing;
        };
        const auto rubbed = [&](int r) {  // what friction carries on
            const double before = kStep * part.memory[static_cast<size_t>(r)].friction, most = most_friction(r);
            return turns(r) ? std::clamp(before, -most, most) : before;
        };
        p = kStep * Vector::Map(part.force.data(), rows);
        for (int r = 0; block.axis && r < rows; ++r) {
            const Axis& axis = part.axis[static_cast<size_t>(r)];
            if (axis.mode == AxisMode::locked) continue;
            if (!block.type->swept(static_cast<uint32_t>(r)))
                p[r] = 0;
            else if (axis.friction > 0)
                p[r] += rubbed(r) - kStep * part.memory[static_cast<size_t>(r)].friction;
        }
        u += w * jacobian.transpose() * p;

        const SweepTerms soft = joint_terms(kStep);
        std::vector<int> locked;
        for (int r = 0; r < rows; ++r)
            if (block.locked(r)) locked.push_back(r);
        const auto count = static_cast<Eigen::Index>(locked.size());
        if (count > 0) {
            const bool elastic = block.compliance[0] > 0;
            Matrix a(count, count);
            Vector residual(count), change(count);
            const Vector v = jacobian * u;
            for (Eigen::Index i = 0; i < count; ++i) {
                const int r = locked[static_cast<size_t>(i)];
                for (Eigen::Index k = 0; k < count; ++k) a(i, k) = s(r, locked[static_cast<size_t>(k)]);
                const double c = block.compliance[block.angular(r)], d = block.relaxation[block.angular(r)];
                if (elastic) a(i, i) += c / (kStep * (kStep + d));
                residual[i] = elastic ? v[r] + error[r] / (kStep + d) + c / (kStep * (kStep + d)) * p[r]
                                      : v[r] + soft.bias_rate * error[r];
            }
            change = -a.inverse() * residual;
            const Vector scale = a.diagonal().cwiseSqrt().cwiseInverse();
            const Vector values =
                Eigen::SelfAdjointEigenSolver<Matrix>(scale.asDiagonal() * a * scale.asDiagonal()).eigenvalues();
            condition = values[count - 1] / values[0];
            Vector all = Vector::Zero(rows);
            for (Eigen::Index i = 0; i < count; ++i) {
                const int r = locked[static_cast<size_t>(i)];
                all[r] = change[i];
            }
            p += all;
            u += w * jacobian.transpose() * all;
        }
        auto solve_row = [&](int r, double sign, double before, double c, double target, double least, double most) {
            const double step = (target - sign * jacobian.row(r).dot(u) - c * before) / (s(r, r) + c);
            const double change = sign * (std::clamp(before + step, least, most) - before);
            p[r] += change;
            u += w * jacobian.row(r).transpose() * change;
        };
        for (int r = 0; block.axis && r < rows; ++r) {
            const Axis& axis = part.axis[static_cast<size_t>(r)];
            const AxisMemory& memory = part.memory[static_cast<size_t>(r)];
            if (axis.mode == AxisMode::locked || !block.type->swept(static_cast<uint32_t>(r))) continue;
            auto stop = [&](double sign, double gap, double carried) {
                const double c = axis.limit_compliance / (kStep * kStep);
                const double push = std::min<double>(soft.push, -soft.bias_rate * gap);
                if (carried == 0 && gap > 50 * kStep && !is_driven(axis)) return;
                solve_row(r, sign, kStep * carried, c, gap > 0 || c > 0 ? -gap / kStep : push, 0, 1e30);
            };
            if (axis.max_force > 0) {
                const double k = axis.stiffness, d = axis.damping, rate = kStep * k + d, turn = 2 * std::numbers::pi;
                const double at = block.angular(r) ? error[r] - turn * std::round(error[r] / turn) : error[r];
                const double most = kStep * axis.max_force, softest = 2 * s(r, r) * kStep * k / rate;
                solve_row(r, 1, kStep * memory.drive, std::max(1 / (kStep * rate), softest),
                          (d * axis.speed - k * at) / rate, -most, most);
            }
            if (axis.friction > 0) solve_row(r, 1, rubbed(r), 0, 0, -most_friction(r), most_friction(r));
            if (axis.mode == AxisMode::limited) {
                const double middle = 0.5 * (axis.lower + axis.upper), turn = 2 * std::numbers::pi;
                const double at =
                    block.angular(r) ? error[r] - turn * std::round((error[r] - middle) / turn) : error[r];
                stop(1, at - axis.lower, memory.lower);
                stop(-1, axis.upper - at, memory.upper);
            }
        }
    }
};

TEST(JointKernels, SolveTheEquationsOfEachJoint) {
    uint32_t compared = 0;
    for (uint64_t seed = 101; seed <= 130; ++seed) {
        SCOPED_TRACE(seed);
        Mechanism m(seed);
        std::vector<Written> written;
        for (uint32_t j = 0; j < kJoints; ++j)
            written.emplace_back(m, j, velocities_of(m.system, m.system.rows.block[j]));
        m.run(kJointKernelsBase, 0, 0);
        for (uint32_t j = 0; j < kJoints; ++j) {
            const RowBlock& block = m.system.rows.block[j];
            SCOPED_TRACE(testing::Message() << block.type->name << ", joint " << j);
            const Vector u = velocities_of(m.system, block);
            const Vector p = kStep * Vector::Map(m.parts[j].force.data(), block.type->rows);
            // Beyond what floats tell apart, or one row of several that a locked axis leaves the same.
            if (!(written[j].condition > 0 && written[j].condition <= 1e4)) continue;
            EXPECT_LE((u - written[j].u).norm(), 1e-3 * std::max(1.0, written[j].u.norm()));
            EXPECT_LE((p - written[j].p).norm(), 1e-3 * std::max(1.0, written[j].p.norm()));
            ++compared;
        }
    }
    EXPECT_GE(compared, 29 * kJoints);
}

// Joints between what does not move, and rows that say what others said already, change nothing and stay finite.
TEST(JointKernels, WhatCannotMoveIsLeftOut) {
    Mechanism m(7);
    for (SweepNode& n : m.system.sweep) n.mass = {};
    const auto before = m.system.sweep;
    m.run(kJointKernelsBase, 2, 2);
    EXPECT_TRUE(same_bits(before, m.system.sweep));
    for (const auto& part : m.parts)
        for (double force : part.force) EXPECT_TRUE(std::isfinite(force));
}

}  // namespace
}  // namespace taut::test
