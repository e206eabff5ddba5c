// Every solver in the list on scenes whose forces are known: what the direct solve gives exactly, the sweeps approach.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "rig.h"

namespace taut::test {
namespace {

constexpr double kGravity = 9.81f;

Vec3 vec(const taut_vec3& v) { return Vec3(v.x, v.y, v.z); }

// A world through its public interface.
class Scene {
public:
    Scene(size_t solver, uint32_t sweeps) : def(default_def()) {
        def.solver = static_cast<taut_solver>(solver);
        def.sweeps = sweeps;
        def.fixed_substeps = 1;  // impulses are of a substep
        EXPECT_EQ(taut_world_create(&def, &world), TAUT_OK) << taut_last_error();
        substep = def.time_step / def.substeps;
    }
    ~Scene() { taut_world_destroy(world); }
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    taut_body particle(double mass, taut_pos at) {
        taut_particle_def d;
        taut_particle_def_init(&d);
        d.mass = static_cast<float>(mass);
        d.position = at;
        taut_body body{};
        EXPECT_EQ(taut_world_add_particle(world, &d, &body), TAUT_OK) << taut_last_error();
        return body;
    }
    taut_body box(taut_body_kind kind, taut_vec3 half, taut_pos at, double mass = 0) {
        taut_box_def shape_def;
        taut_box_def_init(&shape_def);
        shape_def.half_extents = half;
        taut_shape shape{};
        EXPECT_EQ(taut_world_add_box(world, &shape_def, &shape), TAUT_OK) << taut_last_error();
        return body(kind, shape, at, mass);
    }
    taut_body sphere(taut_body_kind kind, float radius, taut_pos at) {
        taut_sphere_def shape_def;
        taut_sphere_def_init(&shape_def);
        shape_def.radius = radius;
        taut_shape shape{};
        EXPECT_EQ(taut_world_add_sphere(world, &shape_def, &shape), TAUT_OK) << taut_last_error();
        return body(kind, shape, at, 0);
    }
    taut_body ground() {  // y = 0
        taut_plane_def shape_def;
        taut_plane_def_init(&shape_def);
        taut_shape shape{};
        EXPECT_EQ(taut_world_add_plane(world, &shape_def, &shape), TAUT_OK) << taut_last_error();
        return body(TAUT_BODY_STATIC, shape, {0, 0, 0}, 0);
    }
    taut_joint ball(taut_body a, taut_body b, taut_pos anchor_a, taut_pos anchor_b) {
        taut_ball_joint_def d;
        taut_ball_joint_def_init(&d);
        d.body_a = a;
        d.body_b = b;
        d.anchor_a = anchor_a;
        d.anchor_b = anchor_b;
        taut_joint joint{};
        EXPECT_EQ(taut_world_add_ball_joint(world, &d, &joint), TAUT_OK) << taut_last_error();
        return joint;
    }
    taut_joint rod(taut_body a, taut_body b, taut_pos anchor_a, taut_pos anchor_b, double length, double compliance = 0,
                   double damping = 0) {
        taut_distance_joint_def d;
        taut_distance_joint_def_init(&d);
        d.body_a = a;
        d.body_b = b;
        d.anchor_a = anchor_a;
        d.anchor_b = anchor_b;
        d.length = static_cast<float>(length);
        d.compliance = static_cast<float>(compliance);
        d.damping = static_cast<float>(damping);
        taut_joint joint{};
        EXPECT_EQ(taut_world_add_distance_joint(world, &d, &joint), TAUT_OK) << taut_last_error();
        return joint;
    }
    void step(int frames) {
        for (int i = 0; i < frames; ++i) ASSERT_EQ(taut_world_step(world), TAUT_OK) << taut_last_error();
    }
    Vec3 position(taut_body body) {
        taut_pose pose{};
        EXPECT_EQ(taut_body_get_pose(body, &pose), TAUT_OK);
        return Vec3(pose.position.x, pose.position.y, pose.position.z);
    }
    double speed(taut_body body) {
        taut_vec3 v{};
        EXPECT_EQ(taut_body_get_velocity(body, &v, nullptr), TAUT_OK);
        return vec(v).norm();
    }
    double weight(taut_body body) {
        float mass = 0;
        taut_vec3 centre;
        taut_sym3 inertia;
        EXPECT_EQ(taut_body_get_mass(body, &mass, &centre, &inertia), TAUT_OK);
        return mass * kGravity;
    }
    Vec3 force(taut_joint joint) {
        taut_vec3 f{};
        EXPECT_EQ(taut_joint_get_force(joint, &f), TAUT_OK);
        return vec(f);
    }
    // Normal and friction forces of all contacts of a body in the last substep, added up [N].
    std::pair<double, double> contact_forces(taut_body body) {
        uint32_t count = 0;
        taut_world_get_contacts(world, nullptr, 0, &count);
        std::vector<taut_contact> contacts(count + 1);
        EXPECT_EQ(taut_world_get_contacts(world, contacts.data(), count + 1, &count), TAUT_OK);
        std::pair<double, double> sum{0, 0};
        for (uint32_t i = 0; i < count; ++i) {
            if (contacts[i].body_a.bits != body.bits && contacts[i].body_b.bits != body.bits) continue;
            sum.first += contacts[i].normal_impulse / substep;
            sum.second += contacts[i].friction_impulse / substep;
        }
        return sum;
    }

    taut_world_def def;
    taut_world world{};
    double substep = 0;

private:
    taut_body body(taut_body_kind kind, taut_shape shape, taut_pos at, double mass) {
        taut_body_def d;
        taut_body_def_init(&d);
        d.kind = kind;
        d.shape = shape;
        d.position = at;
        d.mass = static_cast<float>(mass);
        taut_body out{};
        EXPECT_EQ(taut_world_add_body(world, &d, &out), TAUT_OK) << taut_last_error();
        return out;
    }
};

constexpr taut_body kWorld{0};

class EverySolver : public testing::TestWithParam<size_t> {
protected:
    const Solver& solver() const { return *solvers()[GetParam()]; }
    // Tolerance of the direct solve (results are read as floats) or of one that sweeps.
    double within(double direct, double sweeps) const { return solver().direct ? direct : sweeps; }
};

INSTANTIATE_TEST_SUITE_P(List, EverySolver, testing::Range<size_t>(0, solvers().size()),
                         [](const auto& param) { return std::string(solvers()[param.param]->name); });

// Elastic rows are the same equations for all, so one substep has one answer; sweeps keep velocities in float.
TEST_P(EverySolver, AgreesWithDenseEquationsOfAnElasticChain) {
    Rig rig;
    uint32_t last = kNone;
    for (int i = 0; i < 6; ++i) {
        const uint32_t link = rig.body(1 + i % 3, Vec3(0.1, 0.15, 0.2), Vec3(i + 0.5, 0.1 * i, 0), Quat::Identity(),
                                       Vec3(0, 1, -0.5 * i), Vec3(1, 0, 1));
        rig.ball(last, link, Vec3(last == kNone ? 0 : 0.5, 0, 0), Vec3(-0.5, 0, 0), 1e-5, 1e3);
        last = link;
    }
    rig.rod(kNone, last, Vec3(9, 2, 0), Vec3(0.5, 0, 0), 3, 1e-4, 10);
    rig.settings.geometric_stiffness = false;
    rig.settings.sweeps = 20000;
    rig.begin(solver());
    rig.predict();
    const DenseSubstep exact = solve_dense(rig, {});
    rig.solve();
    EXPECT_LE((velocities(rig) - exact.velocity).norm(), within(1e-8, 1e-5) * exact.velocity.norm());
    double size = 0;
    for (const auto& f : exact.force) size = std::max(size, f.norm());
    for (size_t j = 0; j < exact.force.size(); ++j) {
        const Joint& joint = rig.w.joints.record[j];
        EXPECT_LE((Eigen::VectorXd::Map(joint.lambda, joint.type->rows) - exact.force[j]).norm(),
                  within(1e-8, 1e-4) * size);
    }
}

// Joint k carries what hangs below it. Rows that are swept are soft: S lambda / om^2 long, om = 2 pi 0.25 / h, and
// overdamped, so that a long chain with a weight takes seconds to hang still.
TEST_P(EverySolver, AgreesWithDirectOnHangingChain) {
    Scene scene(GetParam(), 100);
    constexpr int kLinks = 8;
    std::vector<taut_body> link;
    std::vector<taut_joint> joint;
    for (int i = 0; i < kLinks; ++i) {
        link.push_back(scene.box(TAUT_BODY_DYNAMIC, {0.05f, 0.5f, 0.05f}, {0, -0.5 - i, 0}, i + 1 == kLinks ? 10 : 1));
        joint.push_back(i == 0 ? scene.ball(kWorld, link[0], {0, 0, 0}, {0, 0.5, 0})
                               : scene.ball(link[i - 1], link[i], {0, -0.5, 0}, {0, 0.5, 0}));
    }
    scene.step(480);
    double below = 0;
    for (int i = kLinks; i-- > 0;) {
        below += scene.weight(link[i]);
        EXPECT_LE((scene.force(joint[i]) - Vec3(0, below, 0)).norm(), within(1e-6, 1e-3) * below) << "joint " << i;
    }
    const double om = 2 * 3.14159265 * 0.25 / scene.substep;
    const double give =
        kLinks * 7.0 * below / (om * om);  // at most: each joint with the whole load, S <= 7/kg with levers
    EXPECT_NEAR(scene.position(link.back()).y(), -kLinks + 0.5, within(1e-9, give));
    for (taut_body body : link) EXPECT_LE(scene.speed(body), within(1e-7, 1e-3));
}

// Particles on elastic rods between two banks, started straight. Velocities are dropped at every peak of the kinetic
// energy, which takes any solver to rest. At rest the horizontal pull H is the same everywhere and rod k carries
// (H, V_k), V_k = m g (n/2 - k): with that, lengths and sag follow.
TEST_P(EverySolver, AgreesWithDirectOnBridge) {
    constexpr int kPlanks = 9;  // particles; one rod more
    constexpr double kMass = 2, kSpacing = 0.5, kPull = 300, kCompliance = 1e-5;
    std::vector<Vec3> rest{Vec3::Zero()};
    std::vector<double> tension, length;
    for (int k = 0; k <= kPlanks; ++k) {
        const double v = kMass * kGravity * (0.5 * kPlanks - k);
        const Vec3 along(kSpacing, -kSpacing * v / kPull, 0);
        tension.push_back(std::hypot(kPull, v));
        length.push_back(static_cast<float>(along.norm() - kCompliance * tension.back()));
        rest.push_back(rest.back() + along);
    }
    Scene scene(GetParam(), 60);
    std::vector<taut_body> plank;
    std::vector<taut_joint> rod;
    for (int k = 1; k <= kPlanks; ++k) plank.push_back(scene.particle(kMass, {k * kSpacing, 0, 0}));
    for (int k = 0; k <= kPlanks; ++k)
        rod.push_back(scene.rod(k > 0 ? plank[k - 1] : kWorld, k < kPlanks ? plank[k] : kWorld, {0, 0, 0},
                                k < kPlanks ? taut_pos{0, 0, 0} : taut_pos{rest.back().x(), rest.back().y(), 0},
                                length[k], kCompliance));
    double before = 0;
    for (int frame = 0; frame < 400; ++frame) {
        scene.step(1);
        double now = 0;
        for (taut_body body : plank) now += std::pow(scene.speed(body), 2);
        if (now < before) {
            for (taut_body body : plank) taut_body_set_velocity(body, {0, 0, 0}, {0, 0, 0});
            now = 0;
        }
        before = now;
    }
    for (int k = 1; k <= kPlanks; ++k)
        EXPECT_LE((scene.position(plank[k - 1]) - rest[k]).norm(), within(2e-5, 1e-4)) << "particle " << k;
    for (int k = 0; k <= kPlanks; ++k)
        EXPECT_NEAR(scene.force(rod[k]).norm(), tension[k], within(1e-3, 1e-2) * tension[k]) << "rod " << k;
}

// A box on the ground, relieved of half its weight by a spring above it and pulled sideways by another within friction.
TEST_P(EverySolver, AgreesWithDirectOnBoxOnTheGroundWithSprings) {
    Scene scene(GetParam(), 200);
    scene.ground();
    const taut_body box = scene.box(TAUT_BODY_DYNAMIC, {0.5f, 0.25f, 0.5f}, {0, 0.25, 0}, 20);
    const double weight = scene.weight(box), lift = 0.5 * weight, pull = 0.15 * weight, compliance = 1e-3;
    const taut_joint above = scene.rod(box, kWorld, {0, 0, 0}, {0, 3.25, 0}, 3 - compliance * lift, compliance, 50);
    const taut_joint aside = scene.rod(box, kWorld, {0, -0.2, 0}, {4, 0.05, 0}, 4 - compliance * pull, compliance, 50);
    scene.step(120);
    const auto [normal, friction] = scene.contact_forces(box);
    EXPECT_NEAR(scene.force(above).norm(), lift, 5e-3 * weight);
    EXPECT_NEAR(scene.force(aside).norm(), pull, 5e-3 * weight);
    EXPECT_NEAR(normal, weight - lift, 1e-2 * weight);
    EXPECT_GE(friction, 0.99 * pull);  // magnitudes at four points, not all of one direction
    EXPECT_LE(friction, 1.001 * 0.5 * normal);
    EXPECT_LE((scene.position(box) - Vec3(0, 0.25, 0)).norm(), 2e-3);
    EXPECT_LE(scene.speed(box), 1e-3);
}

// A beam on two supports at one end and on a rigid rod from above at the other: half the weight each, by symmetry.
TEST_P(EverySolver, AgreesWithDirectOnBeamBetweenContactAndRod) {
    Scene scene(GetParam(), 200);
    constexpr float kRadius = 0.25f;
    for (double z : {-0.3, 0.3}) scene.sphere(TAUT_BODY_STATIC, kRadius, {-0.8, -kRadius, z});
    const taut_body beam = scene.box(TAUT_BODY_DYNAMIC, {1, 0.1f, 0.4f}, {0, 0.1, 0}, 30);
    const taut_joint rod = scene.rod(beam, kWorld, {0.8, 0, 0}, {0.8, 2, 0}, 1.9);
    scene.step(120);
    const double weight = scene.weight(beam);
    EXPECT_NEAR(scene.force(rod).norm(), 0.5 * weight, 1e-2 * weight);
    EXPECT_NEAR(scene.contact_forces(beam).first, 0.5 * weight, 1e-2 * weight);
    EXPECT_LE((scene.position(beam) - Vec3(0, 0.1, 0)).norm(), 3e-3);
}

// Two boxes side by side, tied by a rigid rod between their tops: the ground carries both.
TEST_P(EverySolver, CarriesJointedBoxesOnTheGround) {
    Scene scene(GetParam(), 200);
    scene.ground();
    const taut_body small = scene.box(TAUT_BODY_DYNAMIC, {0.4f, 0.3f, 0.4f}, {-1, 0.3, 0}, 5),
                    large = scene.box(TAUT_BODY_DYNAMIC, {0.4f, 0.4f, 0.4f}, {1, 0.4, 0}, 50);
    scene.ball(small, large, {0.4, 0.1, 0}, {-1.6, 0, 0});
    scene.step(120);
    const double weight = scene.weight(small) + scene.weight(large);
    EXPECT_NEAR(scene.contact_forces(small).first + scene.contact_forces(large).first, weight, 1e-2 * weight);
    EXPECT_LE(scene.speed(small) + scene.speed(large), 1e-3);
}

// Boxes of many sizes at rest, alone and stacked two by two: each pair of surfaces carries what stands on it.
TEST_P(EverySolver, ContactForcesCarryTheWeight) {
    Scene scene(GetParam(), 100);
    scene.ground();
    struct Stack {
        taut_body lower, upper;
    };
    std::vector<Stack> stacks;
    for (int i = 0; i < 4; ++i) {
        const float half = 0.2f + 0.1f * static_cast<float>(i);
        stacks.push_back({scene.box(TAUT_BODY_DYNAMIC, {half, half, half}, {3.0 * i, half, 0}),
                          scene.box(TAUT_BODY_DYNAMIC, {half, 0.1f, half}, {3.0 * i, 2 * half + 0.1, 0})});
    }
    const taut_body alone = scene.box(TAUT_BODY_DYNAMIC, {0.5f, 0.5f, 0.5f}, {-3, 0.5, 0}, 7);
    scene.step(120);
    EXPECT_NEAR(scene.contact_forces(alone).first, scene.weight(alone), 2e-3 * scene.weight(alone));
    for (const Stack& s : stacks) {
        const double upper = scene.weight(s.upper), both = upper + scene.weight(s.lower);
        EXPECT_NEAR(scene.contact_forces(s.upper).first, upper, 5e-3 * upper);
        EXPECT_NEAR(scene.contact_forces(s.lower).first - scene.contact_forces(s.upper).first, both, 5e-3 * both);
    }
}

// A ball dropped on the ground leaves it with its restitution times the speed of impact.
TEST_P(EverySolver, BouncesBack) {
    Scene scene(GetParam(), 0);
    const taut_body ground = scene.ground(), ball = scene.sphere(TAUT_BODY_DYNAMIC, 0.5f, {0, 2, 0});
    taut_material lively{};
    lively.friction = 0.5f;
    lively.restitution = 0.6f;
    taut_body_set_material(ground, &lively);
    taut_body_set_material(ball, &lively);
    double fastest = 0, up = 0;
    for (int frame = 0; frame < 60; ++frame) {
        scene.step(1);
        taut_vec3 v{};
        taut_body_get_velocity(ball, &v, nullptr);
        fastest = std::max(fastest, -static_cast<double>(v.y));
        up = std::max(up, static_cast<double>(v.y));
    }
    EXPECT_NEAR(up, 0.6 * fastest, 0.1 * fastest);
}

}  // namespace
}  // namespace taut::test
