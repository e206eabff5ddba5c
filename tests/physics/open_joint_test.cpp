// Joints that the host opens: a body of a mechanism is put elsewhere, and they pull it together again.
#include "physics/joint_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

enum class Tie { ball, hinge, fixed };

// Bodies of 1 kg in a row, half a metre from middle to middle.
struct Row {
    World world;
    std::vector<taut_body> bodies;
    std::vector<taut_joint> joints;

    Row(Tie tie, int count) : world([](taut_world_def& def) { weightless(def); }) {
        for (int i = 0; i < count; ++i)
            bodies.push_back(world.add({.shape = world.box({0.2, 0.1, 0.1}), .position = {0.5 * i, 0, 0}, .mass = 1}));
        for (size_t i = 0; i + 1 < bodies.size(); ++i) joints.push_back(join(tie, i));
    }
    taut_joint join(Tie tie, size_t i) const {
        const Vec pivot(0.5 * static_cast<double>(i) + 0.25, 0, 0);
        if (tie == Tie::ball) return world.ball(bodies[i], {0.25, 0, 0}, bodies[i + 1], {-0.25, 0, 0});
        if (tie == Tie::hinge) return hinge(world, bodies[i], bodies[i + 1], pivot, {0, 0, 1});
        auto def = at(world, taut_fixed_joint_def_init, bodies[i], bodies[i + 1], pivot, {1, 0, 0});
        taut_joint joint{};
        ok(taut_world_add_fixed_joint(world.handle, &def, &joint));
        return joint;
    }
    void put(size_t i, const Vec& by, const Quat& turn) const {
        const BodyState now = state(bodies[i]);
        taut_pose pose{};
        pose.position = (now.position + by).pos();
        pose.rotation = (turn * now.rotation).narrow();
        ok(taut_body_set_pose(bodies[i], &pose));
    }
    double fastest() const {
        double most = 0;
        for (const taut_body body : bodies) most = std::max(most, norm(velocity(body)));
        return most;
    }
    double gap() const {
        double most = 0;
        for (const taut_joint joint : joints) most = std::max(most, error(joint));
        return most;
    }
};

struct Opened {
    Tie tie;
    int count;
};

class OpenJoint : public testing::TestWithParam<Opened> {};

// Closed within a substep, a gap of half a metre gave 60 m/s, one of ten metres on hinges 10^5. A wide one closes by 5
// of itself a second.
TEST_P(OpenJoint, ClosesGently) {
    for (unsigned seed = 0; seed < 8; ++seed)
        for (const double far : {0.0, 0.5, 1.0, 3.0}) {  // [m]; 0: turned half about
            std::mt19937 random(seed);
            const Row row(GetParam().tie, GetParam().count);
            row.world.step(10);
            const Quat turn = far > 0 ? Quat() : Quat::turn(random_direction(random), kPi);
            row.put(random() % row.bodies.size(), far * random_direction(random), turn);
            double fastest = 0;
            for (int frame = 0; frame < 300; ++frame) {
                row.world.step();
                fastest = std::max(fastest, row.fastest());
            }
            EXPECT_LT(fastest, 5 + 5 * far) << "moved by " << far << " m, seed " << seed;
            EXPECT_LT(row.gap(), 0.005) << "moved by " << far << " m, seed " << seed;
        }
}

std::string name_of(const testing::TestParamInfo<Opened>& of) {
    constexpr const char* kTies[] = {"balls", "hinges", "fixed"};
    return kTies[static_cast<int>(of.param.tie)] + std::to_string(of.param.count);
}

INSTANTIATE_TEST_SUITE_P(Between, OpenJoint,
                         testing::Values(Opened{Tie::ball, 2}, Opened{Tie::ball, 6}, Opened{Tie::hinge, 2},
                                         Opened{Tie::hinge, 6}, Opened{Tie::fixed, 2}, Opened{Tie::fixed, 6}),
                         name_of);

}  // namespace
