// Round things that lie still on level ground have no cause to roll; those that roll keep their speed.
#include "physics/lab.h"

namespace {

using namespace lab;

enum class Ground { plane, box, mesh };

struct Lying {
    Ground ground;
    bool first;  // made before the ground, so that it is body a of the contact
    double hertz;
    uint32_t substeps;
};

void PrintTo(const Lying& lying, std::ostream* out) {
    *out << (lying.ground == Ground::plane ? "plane" : lying.ground == Ground::box ? "box" : "mesh")
         << (lying.first ? ", first, " : ", ") << lying.hertz << " Hz, " << lying.substeps << " substeps";
}

taut_shape mesh_of_cells(const World& world, double cell, int count) {
    std::vector<taut_vec3> vertices;
    std::vector<uint32_t> triangles;
    const auto side = static_cast<uint32_t>(count + 1);
    for (int j = 0; j <= count; ++j)
        for (int i = 0; i <= count; ++i)
            vertices.push_back(Vec((i - 0.5 * count) * cell, 0, (j - 0.5 * count) * cell).narrow());
    for (uint32_t j = 0; j + 1 < side; ++j)
        for (uint32_t i = 0; i + 1 < side; ++i) {
            const uint32_t a = j * side + i, b = a + 1, c = a + side, d = c + 1;
            triangles.insert(triangles.end(), {a, c, b, b, c, d});
        }
    return world.shape(taut_mesh_def_init, taut_world_add_mesh, [&](taut_mesh_def& d) {
        d.vertices = vertices.data();
        d.vertex_count = static_cast<uint32_t>(vertices.size());
        d.indices = triangles.data();
        d.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
    });
}

class RoundOn : public testing::TestWithParam<Lying> {
protected:
    World world{[](taut_world_def& def) {
        def.time_step = static_cast<float>(1 / GetParam().hertz);
        def.substeps = GetParam().substeps;
        def.sleeping = 0;
    }};
    std::vector<taut_body> things;

    void add_ground() const {
        const Ground ground = GetParam().ground;
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = ground == Ground::plane ? world.plane()
                            : ground == Ground::box ? world.box({300, 0.4, 300})
                                                    : mesh_of_cells(world, 7, 80),
                   .position = {0, ground == Ground::box ? -0.4 : 0, 0}});
    }
    // Balls and lying capsules of several sizes, near the origin and far from it.
    void add_things() {
        for (const double away : {1.3, 187.31})
            for (const double radius : {0.021, 0.11, 0.43}) {
                const double x = away + 3 * radius, z = -0.6 * away;
                things.push_back(world.add({.shape = world.sphere(radius), .position = {x, radius, z}}));
                const Quat lies = Quat::turn({0, 0.4, 0}, 0.7) * Quat::turn({0, 0, 1}, kPi / 2);
                things.push_back(world.add({.shape = world.capsule(radius, 1.5 * radius),
                                            .position = {x, radius, z + 10 * radius},
                                            .rotation = lies}));
            }
    }
    void add_all() {
        if (GetParam().first) add_things();
        add_ground();
        if (!GetParam().first) add_things();
    }
};

TEST_P(RoundOn, StaysWhereItWasLaid) {
    add_all();
    std::vector<Vec> at;
    for (const taut_body thing : things) at.push_back(position(thing));
    world.step(static_cast<int>(15 * GetParam().hertz));
    for (size_t i = 0; i < things.size(); ++i) {
        const Vec moved = position(things[i]) - at[i];
        EXPECT_LT(std::hypot(moved.x, moved.z), 1e-4) << "thing " << i;
        EXPECT_LT(norm(velocity(things[i])), 1e-4) << "thing " << i;
    }
}

// Balls that roll without slipping, slowly and faster.
TEST_P(RoundOn, RollsOnAtItsSpeed) {
    if (GetParam().ground == Ground::mesh) GTEST_SKIP() << "edges of triangles have tests of their own";
    constexpr double kSpeeds[] = {0.003, 0.02, 0.3, 2};
    const auto add_balls = [&] {
        for (int i = 0; i < 4; ++i) {
            const double radius = 0.05 + 0.04 * i;
            things.push_back(world.add({.shape = world.sphere(radius),
                                        .position = {5, radius, 2.0 * i},
                                        .velocity = {kSpeeds[i], 0, 0},
                                        .spin = {0, 0, -kSpeeds[i] / radius}}));
        }
    };
    if (GetParam().first) add_balls();
    add_ground();
    if (!GetParam().first) add_balls();
    world.step(static_cast<int>(10 * GetParam().hertz));
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(velocity(things[i]).x / kSpeeds[i], 1, 1e-3) << kSpeeds[i] << " m/s";
        EXPECT_LT(std::abs(position(things[i]).z - 2.0 * static_cast<double>(i)), 2e-3 * 10 * kSpeeds[i]);
    }
}

std::vector<Lying> all_lying() {
    std::vector<Lying> out;
    for (const Ground ground : {Ground::plane, Ground::box, Ground::mesh})
        for (const bool first : {false, true}) {
            for (const uint32_t substeps : {1u, 2u, 4u, 8u, 16u}) out.push_back({ground, first, 60, substeps});
            for (const double hertz : {30.0, 120.0, 240.0}) out.push_back({ground, first, hertz, 4});
        }
    return out;
}
INSTANTIATE_TEST_SUITE_P(Each, RoundOn, testing::ValuesIn(all_lying()));

}  // namespace
