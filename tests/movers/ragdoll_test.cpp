// Ragdolls: poses in and out, torques that hold against gravity as stiffness says, and limbs that fall without gain.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <taut/taut.h>

namespace {

constexpr double kFall = 9.81, kPi = 3.14159265358979323846;
#define ASSERT_OK(call) ASSERT_EQ(call, TAUT_OK) << taut_last_error()
#define EXPECT_OK(call) EXPECT_EQ(call, TAUT_OK) << taut_last_error()

taut_quat turn(taut_vec3 axis, double angle) {
    const double s = std::sin(angle / 2);
    return {static_cast<float>(double(axis.x) * s), static_cast<float>(double(axis.y) * s),
            static_cast<float>(double(axis.z) * s), static_cast<float>(std::cos(angle / 2))};
}

// Bones of 0.4 m one after the other along x, the first of which is the root; each a box about its middle.
class Limb {
public:
    static constexpr double kLength = 0.4, kMass = 2;

    explicit Limb(double hz, uint32_t count = 3) : seconds(static_cast<float>(1 / hz)), bones(count) {
        taut_world_def world_def;
        taut_world_def_init(&world_def);
        world_def.time_step = seconds;
        EXPECT_OK(taut_world_create(&world_def, &world));
        taut_box_def box;
        taut_box_def_init(&box);
        box.half_extents = {static_cast<float>(kLength / 2), 0.05f, 0.05f};
        taut_shape shape;
        EXPECT_OK(taut_world_add_box(world, &box, &shape));
        for (uint32_t i = 0; i < count; ++i) {
            taut_bone_def_init(&bones[i]);
            names[i] = "bone " + std::to_string(i);
            bones[i].name = names[i].c_str();
            bones[i].parent = static_cast<int32_t>(i) - 1;
            bones[i].pose.position = {i * kLength, 0, 0};
            bones[i].joint.position = {(i - 0.5) * kLength, 0, 0};
            bones[i].shape = shape;
            bones[i].mass = static_cast<float>(kMass);
            bones[i].lower = {-1, -1.4f, -2};
            bones[i].upper = {1, 1.4f, 2};
        }
        taut_ragdoll_def_init(&def);
        def.bones = bones.data();
        def.bone_count = count;
        taut_ragdoll_init(&ragdoll);
    }
    ~Limb() { EXPECT_OK(taut_world_destroy(world)); }
    Limb(const Limb&) = delete;
    Limb& operator=(const Limb&) = delete;

    void add() { ASSERT_OK(taut_world_add_ragdoll(world, &def, &ragdoll)); }
    std::vector<taut_pose> poses() const {
        std::vector<taut_pose> out(def.bone_count);
        EXPECT_OK(taut_ragdoll_get_poses(&ragdoll, out.data(), def.bone_count));
        return out;
    }
    void frame(taut_ragdoll_mode mode, const std::vector<taut_pose>& wanted) {
        ASSERT_OK(taut_ragdoll_drive(&def, mode, wanted.data(), seconds, &ragdoll));
        ASSERT_OK(taut_world_step(world));
    }
    double energy() const {
        double sum = 0;
        for (uint32_t i = 0; i < def.bone_count; ++i) {
            taut_pose pose;
            taut_vec3 v, w, centre;
            float mass;
            taut_sym3 inertia;
            EXPECT_OK(taut_body_get_pose(ragdoll.bodies[i], &pose));
            EXPECT_OK(taut_body_get_velocity(ragdoll.bodies[i], &v, &w));
            EXPECT_OK(taut_body_get_mass(ragdoll.bodies[i], &mass, &centre, &inertia));
            taut_vec3 own;
            EXPECT_OK(taut_body_get_local_vector(ragdoll.bodies[i], w, &own));
            const auto square = [](float x) { return double(x) * double(x); };
            sum += 0.5 * double(mass) * (square(v.x) + square(v.y) + square(v.z)) +
                   0.5 * (double(inertia.xx) * square(own.x) + double(inertia.yy) * square(own.y) +
                          double(inertia.zz) * square(own.z)) +
                   double(mass) * kFall * pose.position.y;
        }
        return sum;
    }

    float seconds;
    taut_world world{};
    std::vector<taut_bone_def> bones;
    std::array<std::string, TAUT_RAGDOLL_MAX_BONES> names;
    taut_ragdoll_def def{};
    taut_ragdoll ragdoll{};
};

class AtRates : public testing::TestWithParam<double> {};
using RagdollAtRates = AtRates;
INSTANTIATE_TEST_SUITE_P(Hz, RagdollAtRates, testing::Values(30.0, 60.0, 120.0, 240.0));

TEST(Ragdoll, GivesTheRestPoseThatItWasMadeOf) {
    Limb limb(60, 5);
    limb.def.pose.position = {100, 20, -3};
    limb.def.pose.rotation = turn({0, 0.6f, 0.8f}, 1.1);
    limb.add();
    const std::vector<taut_pose> poses = limb.poses();
    for (uint32_t i = 0; i < 5; ++i) {
        // Turned about (0, 0.6, 0.8): x -> cos x + sin (axis x x).
        const double c = std::cos(1.1), s = std::sin(1.1), x = i * Limb::kLength;
        EXPECT_NEAR(poses[i].position.x, 100 + c * x, 1e-5);
        EXPECT_NEAR(poses[i].position.y, 20 + 0.8 * s * x, 1e-5);
        EXPECT_NEAR(poses[i].position.z, -3 - 0.6 * s * x, 1e-5);
        char name[TAUT_BODY_NAME_SIZE];
        uint32_t count = 0;
        ASSERT_OK(taut_body_get_name(limb.ragdoll.bodies[i], name, sizeof name, &count));
        EXPECT_EQ(limb.names[i], name);
        if (i == 0) continue;
        for (uint32_t axis = 0; axis < 6; ++axis) {
            float value = 1;
            ASSERT_OK(taut_joint_get_coordinates(limb.ragdoll.joints[i], axis, &value, nullptr));
            EXPECT_NEAR(value, 0, 1e-5);
        }
    }
    // Poses in are poses out.
    std::vector<taut_pose> moved = poses;
    for (taut_pose& pose : moved) pose.position.y += 3, pose.rotation = turn({1, 0, 0}, 0.7);
    ASSERT_OK(taut_ragdoll_set_poses(&limb.ragdoll, moved.data()));
    const std::vector<taut_pose> out = limb.poses();
    for (uint32_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(out[i].position.y, moved[i].position.y, 1e-5);
        EXPECT_NEAR(out[i].rotation.x, moved[i].rotation.x, 1e-5);
    }
}

// The last bone stands out from a led root: m g L/2 cos(a) = k a, k the drive's stiffness in force.
TEST_P(RagdollAtRates, PowerHoldsAgainstGravityAsStiffnessSays) {
    for (const float frequency : {2.0f, 4.0f}) {
        Limb limb(GetParam(), 2);
        limb.bones[1].frequency = frequency;
        limb.add();
        const std::vector<taut_pose> rest = limb.poses();
        for (int i = 0; i < 4 * GetParam(); ++i) limb.frame(TAUT_RAGDOLL_HELD, rest);
        taut_axis_def axis;
        taut_axis_def_init(&axis);
        ASSERT_OK(taut_joint_get_axis(limb.ragdoll.joints[1], 5, &axis));
        const double stiffness = static_cast<double>(axis.drive.stiffness),
                     moment = Limb::kMass * kFall * Limb::kLength / 2;
        ASSERT_GT(stiffness, 0);
        double angle = 0;
        for (int i = 0; i < 50; ++i) angle = -moment * std::cos(angle) / stiffness;
        float value = 0;
        ASSERT_OK(taut_joint_get_coordinates(limb.ragdoll.joints[1], 5, &value, nullptr));
        EXPECT_NEAR(static_cast<double>(value), angle, 2e-3 + 0.01 * std::abs(angle)) << frequency;
        EXPECT_LT(angle, -0.005);
    }
}

// An animation that swings the limb: weightless, the drives follow it by rate and angle.
TEST_P(RagdollAtRates, PowerFollowsAnAnimation) {
    Limb limb(GetParam());
    for (taut_bone_def& bone : limb.bones) bone.frequency = 8;
    limb.add();
    ASSERT_OK(taut_world_set_gravity(limb.world, {0, 0, 0}));
    const auto animated = [&](double t) {
        std::vector<taut_pose> out = limb.poses();
        const double angle = 0.6 * (1 - std::cos(kPi * t));
        taut_pos at = {-Limb::kLength / 2, 0, 0};
        double sum = 0;
        for (uint32_t i = 0; i < out.size(); ++i) {
            if (i > 0) sum += angle;
            out[i].rotation = turn({0, 0, 1}, sum);
            const double x = Limb::kLength / 2 * std::cos(sum), y = Limb::kLength / 2 * std::sin(sum);
            out[i].position = {at.x + x, at.y + y, 0};
            at = {at.x + 2 * x, at.y + 2 * y, 0};
        }
        return out;
    };
    const int frames = static_cast<int>(2 * GetParam());
    double worst = 0;
    for (int i = 1; i <= frames; ++i) {
        const double t = i / GetParam();
        limb.frame(TAUT_RAGDOLL_HELD, animated(t));
        for (uint32_t k = 1; k < 3; ++k) {
            float value = 0;
            ASSERT_OK(taut_joint_get_coordinates(limb.ragdoll.joints[k], 5, &value, nullptr));
            worst = std::max(worst, std::abs(static_cast<double>(value) - 0.6 * (1 - std::cos(kPi * t))));
        }
    }
    EXPECT_LT(worst, 0.1);
}

TEST_P(RagdollAtRates, LimpFallsWithoutGain) {
    Limb limb(GetParam(), 4);
    limb.add();
    ASSERT_OK(taut_body_set_kind(limb.ragdoll.bodies[0], TAUT_BODY_STATIC));  // which it hangs by
    const double start = limb.energy();
    double most = start;
    for (int i = 0; i < 6 * GetParam(); ++i) {
        ASSERT_OK(taut_world_step(limb.world));
        most = std::max(most, limb.energy());
    }
    EXPECT_LT(most, start + 0.01 * Limb::kMass * kFall * 4 * Limb::kLength);
    EXPECT_LT(limb.energy(), start);
}

TEST_P(RagdollAtRates, IsLedToItsPosesAndLetGoAtTheirSpeed) {
    Limb limb(GetParam());
    limb.add();
    std::vector<taut_pose> wanted = limb.poses();
    const int frames = static_cast<int>(GetParam());
    for (int i = 1; i <= frames; ++i) {
        for (taut_pose& pose : wanted) pose.position.y = 2.0 * i / GetParam();
        limb.frame(TAUT_RAGDOLL_LED, wanted);
    }
    const std::vector<taut_pose> there = limb.poses();
    for (uint32_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(there[i].position.y, wanted[i].position.y, 1e-4);
        EXPECT_NEAR(there[i].position.x, wanted[i].position.x, 1e-4);
    }
    ASSERT_OK(taut_ragdoll_drive(&limb.def, TAUT_RAGDOLL_LIMP, nullptr, limb.seconds, &limb.ragdoll));
    for (int i = 0; i < frames / 2; ++i) ASSERT_OK(taut_world_step(limb.world));
    // Thrown up at 2 m/s: y = 2 t - g t^2 / 2.
    for (const taut_pose& pose : limb.poses()) EXPECT_NEAR(pose.position.y - 2, 1 - kFall / 8, 0.06);
}

TEST(Ragdoll, NeighboursDoNotCollideAndLimitsHold) {
    Limb limb(60);
    for (taut_bone_def& bone : limb.bones) bone.lower = {0, 0, -0.3f}, bone.upper = {0, 0, 0.3f};
    limb.add();
    ASSERT_OK(taut_body_set_kind(limb.ragdoll.bodies[0], TAUT_BODY_STATIC));
    for (int i = 0; i < 300; ++i) {
        ASSERT_OK(taut_world_step(limb.world));
        for (uint32_t k = 1; k < 3; ++k) {
            float value = 0, error = 0;
            ASSERT_OK(taut_joint_get_coordinates(limb.ragdoll.joints[k], 5, &value, nullptr));
            ASSERT_OK(taut_joint_get_angular_error(limb.ragdoll.joints[k], &error));
            EXPECT_GE(value, -0.31f);
            EXPECT_LT(error, 0.01f);
        }
    }
    taut_profile profile;
    profile.struct_size = sizeof profile;
    ASSERT_OK(taut_world_get_profile(limb.world, &profile));
    EXPECT_EQ(profile.touching, 0u);
}

TEST(Ragdoll, RefusesAndLeavesNothingBehind) {
    Limb limb(60);
    uint32_t count = 9;
    const auto refused = [&](taut_result expected, const char* text, auto&& change) {
        taut_ragdoll_def def = limb.def;
        std::vector<taut_bone_def> bones = limb.bones;
        def.bones = bones.data();
        change(def, bones);
        const taut_ragdoll before = limb.ragdoll;
        EXPECT_EQ(taut_world_add_ragdoll(limb.world, &def, &limb.ragdoll), expected) << text;
        EXPECT_NE(std::string(taut_last_error()).find(text), std::string::npos) << taut_last_error();
        EXPECT_EQ(std::memcmp(&before, &limb.ragdoll, sizeof before), 0);
        ASSERT_OK(taut_world_get_bodies(limb.world, nullptr, 0, &count));
        EXPECT_EQ(count, 0u);
    };
    using Def = taut_ragdoll_def;
    using Bones = std::vector<taut_bone_def>;
    refused(TAUT_STRUCT_SIZE, "struct_size", [](Def& def, Bones&) { def.struct_size = 3; });
    refused(TAUT_STRUCT_SIZE, "bones[1].struct_size", [](Def&, Bones& bones) { bones[1].struct_size = 0; });
    refused(TAUT_INVALID_ARGUMENT, "bone_count", [](Def& def, Bones&) { def.bone_count = 65; });
    refused(TAUT_NULL_POINTER, "bones", [](Def& def, Bones&) { def.bones = nullptr; });
    refused(TAUT_INVALID_ARGUMENT, "parent", [](Def&, Bones& bones) { bones[1].parent = 1; });
    refused(TAUT_INVALID_ARGUMENT, "bones[2].lower.y", [](Def&, Bones& bones) { bones[2].lower.y = -1.6f; });
    refused(TAUT_INVALID_ARGUMENT, "bones[2].upper.x", [](Def&, Bones& bones) { bones[2].upper.x = NAN; });
    refused(TAUT_INVALID_ARGUMENT, "bones[0].mass", [](Def&, Bones& bones) { bones[0].mass = -1; });
    refused(TAUT_STALE_HANDLE, "shape", [](Def&, Bones& bones) { bones[2].shape = {0}; });
    refused(TAUT_INVALID_ARGUMENT, "name",
            [](Def&, Bones& bones) { bones[2].name = "a name that is longer than one may be"; });
    limb.add();
    std::vector<taut_pose> poses = limb.poses();
    uint64_t hash = 0, after = 0;
    ASSERT_OK(taut_world_get_state_hash(limb.world, &hash));
    const auto drive = [&](taut_ragdoll_mode mode, const taut_pose* wanted, float seconds) {
        return taut_ragdoll_drive(&limb.def, mode, wanted, seconds, &limb.ragdoll);
    };
    EXPECT_EQ(drive(TAUT_RAGDOLL_POWERED, nullptr, 0.1f), TAUT_NULL_POINTER);
    EXPECT_EQ(drive(TAUT_RAGDOLL_POWERED, poses.data(), 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(drive(static_cast<taut_ragdoll_mode>(4), poses.data(), 0.1f), TAUT_INVALID_ARGUMENT);
    poses[1].rotation.w = 4;
    EXPECT_EQ(drive(TAUT_RAGDOLL_LED, poses.data(), 0.1f), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("poses[1].rotation"), std::string::npos);
    EXPECT_EQ(taut_ragdoll_set_poses(&limb.ragdoll, poses.data()), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_ragdoll_get_poses(&limb.ragdoll, poses.data(), 2), TAUT_TOO_SMALL);
    ASSERT_OK(taut_world_get_state_hash(limb.world, &after));
    EXPECT_EQ(hash, after);
    ASSERT_OK(taut_ragdoll_remove(&limb.ragdoll));
    ASSERT_OK(taut_world_get_bodies(limb.world, nullptr, 0, &count));
    EXPECT_EQ(count, 0u);
    EXPECT_EQ(limb.ragdoll.bone_count, 0u);
}

}  // namespace
