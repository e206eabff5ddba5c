// Elements in every solver: as joints between the same nodes are, in whatever form, and with as many nodes as one may
// have.
#include <gtest/gtest.h>

#include <cstring>

#include "rig.h"

namespace taut::test {
namespace {

constexpr int kPoints = 7;

// A chain of particles of unequal mass from the world to a body, which hangs by its side.
struct Chain : Rig {
    Chain() {
        for (int i = 0; i < kPoints; ++i)
            point.push_back(
                particle(0.5 + 0.25 * (i % 3), Vec3(0.3 * i, 0.05 * (i % 2), 0.02 * i), Vec3(0, 0.1 * i, 0)));
        const uint32_t end =
            body(2, Vec3(0.1, 0.2, 0.15), Vec3(0.3 * kPoints, 0.1, 0), Quat::Identity(), Vec3(0, 0, 1));
        ball(kNone, point[0], Vec3::Zero(), Vec3::Zero());
        ball(point.back(), end, Vec3::Zero(), Vec3(-0.3, 0, 0), 1e-6);
        settings.sweeps = 300;
    }
    void step(const Solver& with, int substeps = 3) {
        for (int i = 0; i < substeps; ++i) {
            begin(with);
            predict();
            solve();
            move();
            relax();
        }
    }
    Eigen::VectorXd places() const {
        Eigen::VectorXd all(3 * kPoints);
        for (int i = 0; i < kPoints; ++i) all.segment<3>(3 * i) = w.nodes.motion[point[static_cast<size_t>(i)]].x;
        return all;
    }
    std::vector<uint32_t> point;
};

struct Material {
    double stretch, stretch_damping, bending, bending_damping;
};

struct ChainOfJoints : Chain {
    explicit ChainOfJoints(const Material& m) {
        for (size_t i = 0; i + 1 < kPoints; ++i)
            rod(point[i], point[i + 1], Vec3::Zero(), Vec3::Zero(), 0.3, 0.3 * m.stretch, m.stretch_damping / 0.3);
        for (size_t i = 1; i + 1 < kPoints; ++i) {
            Joint joint;
            joint.type = &kBend;
            std::copy_n(&point[i - 1], 3, joint.node);
            joint.angular_compliance = 0.3 * m.bending;
            joint.angular_damping = m.bending_damping / 0.3;
            w.joints.add(joint);
        }
    }
};

struct ChainOfElements : Chain {
    ChainOfElements(const Material& m, ElementForm form) {
        Elements& all = w.elements;
        const uint32_t stretch = all.add(kLinkElement), bending = all.add(kBendElement);
        set_compliance(all.set[stretch], m.stretch, m.stretch * m.stretch_damping);
        set_compliance(all.set[bending], m.bending, m.bending * m.bending_damping);
        for (uint32_t i = 0; i + 1 < kPoints; ++i) {
            all.insert(all.set[stretch], i, {&point[i], 2}, 0.3);
            *all.set[stretch].data_of(i) = 0.3;
            if (i > 0) all.insert(all.set[bending], i - 1, {&point[i - 1], 3}, 0.3);
        }
        for (const uint32_t set : {stretch, bending}) all.set[set].form = form;
    }
};

constexpr Material kElastic{1e-4, 30, 0.2, 0.05}, kRigid{0, 0, 0.5, 0};

class EverySolverOf : public testing::TestWithParam<size_t> {
protected:
    const Solver& solver() const { return *solvers()[GetParam()]; }
};
INSTANTIATE_TEST_SUITE_P(List, EverySolverOf, testing::ValuesIn(solvers_of_joints()),
                         [](const auto& param) { return std::string(solvers()[param.param]->name); });

// In the same places after some substeps; sweeps go through them in another order and keep velocities in float.
TEST_P(EverySolverOf, TakesElementsAsJoints) {
    for (const Material& material : {kElastic, kRigid}) {
        ChainOfJoints joints(material);
        ChainOfElements elements(material, ElementForm::rows);
        joints.step(solver());
        elements.step(solver());
        ASSERT_GT((joints.places() - Chain().places()).norm(), 1e-3);
        EXPECT_LE((joints.places() - elements.places()).norm(), solver().direct ? 1e-10 : 5e-5);
    }
}

// Forms differ in what they linearise, and where: what that makes of a substep shrinks as its square.
TEST(Elements, FormsAgreeAsStepsShrink) {
    const auto apart = [](ElementForm form, double h) {
        ChainOfElements rows(kElastic, ElementForm::rows), other(kElastic, form);
        for (ChainOfElements* each : {&rows, &other}) {
            each->h = h;
            each->step(kBlockLdlt, 1);
        }
        EXPECT_LT(other.w.partition.blocks[0].matrix.unknowns(), rows.w.partition.blocks[0].matrix.unknowns());
        return (rows.places() - other.places()).norm();
    };
    for (const ElementForm form : {ElementForm::folded, ElementForm::energy}) {
        const double coarse = apart(form, 1.0 / 240), fine = apart(form, 1.0 / 960);
        EXPECT_LE(coarse, 1e-2);
        EXPECT_LE(fine, coarse / 12);
    }
}

// ---------------------------------------------------------------- eight nodes

// C = sum of the distances of eight points from their middle, less what it was [m]; J_n = u_n - mean u.
Vec3 middle_of(const ElementBatch& batch, uint32_t i) {
    Vec3 sum = Vec3::Zero();
    for (uint32_t n = 0; n < 8; ++n) sum += batch.x[batch.node[8 * i + n]].x;
    return sum / 8;
}

void evaluate_cloud(const ElementBatch& batch, double* error, double* jacobian, int columns) {
    for (uint32_t i = 0; i < batch.count; ++i) {
        const Vec3 middle = middle_of(batch, i);
        Vec3 mean = Vec3::Zero(), u[8];
        error[i] = -batch.data[batch.index(i)];
        for (uint32_t n = 0; n < 8; ++n) {
            const Vec3 d = batch.x[batch.node[8 * i + n]].x - middle;
            error[i] += d.norm();
            mean += (u[n] = d.normalized()) / 8;
        }
        for (uint32_t n = 0; jacobian && n < 8; ++n)
            Vec3::Map(jacobian + (8 * i + n) * static_cast<uint32_t>(columns)) = u[n] - mean;
    }
}
void no_stiffness(const ElementBatch& batch, const double*, Curvature, double* k) {
    std::fill_n(k, batch.count * 24 * 24, 0.0);
}
constexpr uint32_t kOrder[8] = {0, 1, 2, 3, 4, 5, 6, 7};
void evaluate_one_cloud(const void* data, const Pose* x, double* error, double* jacobian) {
    if (jacobian) std::fill_n(jacobian, 8 * kDof, 0.0);
    evaluate_cloud({1, kOrder, nullptr, static_cast<const double*>(data), x}, error, jacobian, kDof);
}
void no_row_stiffness(const void*, const Pose*, const double*, Curvature, double* k) { std::fill_n(k, 48 * 48, 0.0); }

const ElementType kCloud{
    "cloud",
    3,
    1,
    {"cloud", 1, 8, sizeof(double), Bound::free, true, 0, evaluate_one_cloud, no_row_stiffness, nullptr, nullptr},
    evaluate_cloud,
    no_stiffness};

// A rigid one of eight nodes: what it holds does not change, momentum neither, whichever solver takes it.
TEST_P(EverySolverOf, HoldsAnElementOfEightNodes) {
    Rig rig;
    rig.gravity.setZero();
    rig.settings.sweeps = 60;
    std::vector<uint32_t> node;
    for (int i = 0; i < 8; ++i) {
        const Vec3 at(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        node.push_back(rig.particle(1 + 0.5 * i, at, Vec3(0.3 * i, -0.2 * i, 0.1) + 0.5 * at));
    }
    Elements& elements = rig.w.elements;
    ElementSet& set = elements.set[elements.add(kCloud)];
    elements.insert(set, 0, node, 1);
    *set.data_of(0) = 8 * std::sqrt(3.0);
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (const uint32_t n : node) sum += rig.w.nodes.mass[n].mass * rig.w.nodes.motion[n].v;
        return sum;
    };
    const Vec3 before = momentum();
    double free_error = 0;
    for (int i = 0; i < 30; ++i) {
        rig.begin(solver());
        rig.predict();
        rig.solve();
        rig.move();
        rig.relax();
    }
    std::vector<Pose> pose;
    for (const uint32_t n : node) pose.push_back({rig.w.nodes.motion[n].x, Mat3::Identity()});
    evaluate_one_cloud(set.data_of(0), pose.data(), &free_error, nullptr);
    EXPECT_LE(std::abs(free_error), 0.01);  // 4 m/s times an eighth of a second for nothing that holds
    EXPECT_LE((momentum() - before).norm(), 1e-4 * before.norm());
}

}  // namespace
}  // namespace taut::test
