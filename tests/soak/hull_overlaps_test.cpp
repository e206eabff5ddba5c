// Hulls as meshes make them, in each other at random: a step finds contact points wherever the distance query finds an
// overlap, and as deep.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "hull_points.h"
#include "physics/lab.h"

namespace {

using namespace lab;
using hull_points::Like;

// Pairs far from each other, two bodies each, in a step so short that nothing moves.
class Overlaps {
public:
    Overlaps(Like a, Like b, uint32_t seed) : likes_{a, b}, maker_(seed) {}

    void run(int pairs) {
        World world([](taut_world_def& def) {
            def.gravity = {0, 0, 0};
            def.time_step = 1e-4f;
            def.substeps = 1;
        });
        std::vector<taut_body> bodies;
        for (int i = 0; i < pairs; ++i) {
            const Vec at = {10.0 * i, 0, 0};
            bodies.push_back(add(world, likes_[0], at));
            const double apart = maker_.uniform(0.05, 0.6);
            bodies.push_back(add(world, likes_[1], at + apart * direction()));
        }
        std::vector<double> distance;
        for (size_t i = 0; i < bodies.size(); i += 2) distance.push_back(distance_of(bodies[i], bodies[i + 1]));
        ok(taut_world_step(world.handle));
        std::vector<taut_contact> contacts(bodies.size() * 4);
        uint32_t count = 0;
        ok(taut_world_get_contacts(world.handle, contacts.data(), static_cast<uint32_t>(contacts.size()), &count));
        contacts.resize(count);
        std::vector<double> deepest(distance.size(), 1e30);
        for (const taut_contact& contact : contacts) {
            const size_t pair = size_t(std::lround(contact.position.x / 10));
            deepest[pair] = std::min(deepest[pair], double(contact.separation));
        }
        for (size_t i = 0; i < distance.size(); ++i) {
            if (distance[i] > -1e-4) continue;
            ++overlaps;
            if (deepest[i] > 1e29) {
                ++missed;
            } else {
                wrong += std::fabs(deepest[i] - distance[i]) > 0.0028 - 0.11 * distance[i];
            }
        }
    }

    int overlaps = 0, missed = 0, wrong = 0;

private:
    Vec direction() {
        while (true) {
            const double x = maker_.uniform(-1, 1), y = maker_.uniform(-1, 1), z = maker_.uniform(-1, 1);
            const Vec v = {x, y, z};
            if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
        }
    }
    // Of shapes too thin for a hull none is added: another is drawn.
    taut_body add(const World& world, Like like, const Vec& at) {
        BodyPlan plan;
        taut_result result = TAUT_INVALID_ARGUMENT;
        while (result == TAUT_INVALID_ARGUMENT) {
            std::vector<taut_vec3> points;
            for (const auto& [x, y, z] : maker_.make(like)) points.push_back({x, y, z});
            taut_hull_def hull;
            taut_hull_def_init(&hull);
            hull.points = points.data();
            hull.point_count = static_cast<uint32_t>(points.size());
            result = taut_world_add_hull(world.handle, &hull, &plan.shape);
        }
        ok(result);
        const Vec axis = direction();
        plan.position = at;
        plan.rotation = Quat::turn(axis, maker_.uniform(0, 2 * kPi));
        return world.add(plan);
    }
    static double distance_of(taut_body a, taut_body b) {
        taut_collider of_a{}, of_b{};
        uint32_t count = 0;
        ok(taut_body_get_colliders(a, &of_a, 1, &count));
        ok(taut_body_get_colliders(b, &of_b, 1, &count));
        taut_distance gap{};
        ok(taut_collider_distance(of_a, of_b, &gap));
        return gap.distance;
    }

    const Like likes_[2];
    hull_points::Maker maker_;
};

void expect_none_missed(Like like, int pairs, uint32_t seed) {
    for (const Like other : hull_points::kAll) {
        Overlaps overlaps(like, other, seed + uint32_t(other));
        for (int done = 0; done < pairs; done += 500) overlaps.run(std::min(500, pairs - done));
        std::printf("%s and %s: %d overlaps, %d missed, %d of another depth\n", hull_points::name(like),
                    hull_points::name(other), overlaps.overlaps, overlaps.missed, overlaps.wrong);
        EXPECT_GT(overlaps.overlaps, pairs / 100);
        EXPECT_EQ(overlaps.missed, 0);
        EXPECT_LE(overlaps.wrong, overlaps.overlaps / 1000);
    }
}

struct HullOverlapsShort : testing::TestWithParam<Like> {};
TEST_P(HullOverlapsShort, AreFound) { expect_none_missed(GetParam(), 100, 71); }

struct HullOverlaps : testing::TestWithParam<Like> {};
TEST_P(HullOverlaps, AreFound) { expect_none_missed(GetParam(), 20000, 4300); }

const auto name_of = [](const auto& param) { return std::string(hull_points::name(param.param)); };
INSTANTIATE_TEST_SUITE_P(Of, HullOverlapsShort, testing::ValuesIn(hull_points::kAll), name_of);
INSTANTIATE_TEST_SUITE_P(Of, HullOverlaps, testing::ValuesIn(hull_points::kAll), name_of);

}  // namespace
