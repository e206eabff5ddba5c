// Rocks in a bag of cloth that a cable lifts.
#include <array>
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr int kBagRings = 15, kBagAround = 36;
constexpr double kBagRadius = 0.42, kBagNeck = 2.6;  // [m], polar angle of the rim [rad]

// A ball of cloth without its top; vertex 0 is the bottom, then rings upward.
Cloth bag(taut_pos centre) {
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    cloth.points.push_back(plus(centre, 0, -kBagRadius, 0));
    for (int i = 1; i <= kBagRings; ++i)
        for (int k = 0; k < kBagAround; ++k) {
            const double polar = kBagNeck * i / kBagRings, round = 2 * std::numbers::pi * k / kBagAround;
            const double out = kBagRadius * std::sin(polar);
            cloth.points.push_back(
                plus(centre, out * std::cos(round), -kBagRadius * std::cos(polar), out * std::sin(round)));
        }
    const auto at = [](int i, int k) { return static_cast<uint32_t>(1 + (i - 1) * kBagAround + k % kBagAround); };
    for (int k = 0; k < kBagAround; ++k) {
        cloth.triangles.insert(cloth.triangles.end(), {0, at(1, k), at(1, k + 1)});
        for (int i = 1; i < kBagRings; ++i) {
            const uint32_t a = at(i, k), b = at(i, k + 1), c = at(i + 1, k), d = at(i + 1, k + 1);
            if ((i + k) % 2 == 0)
                cloth.triangles.insert(cloth.triangles.end(), {a, c, d, a, d, b});
            else
                cloth.triangles.insert(cloth.triangles.end(), {a, c, b, b, c, d});
        }
    }
    return cloth;
}

// Points about an ellipsoid.
int rock_shape(Scene& scene, Random& random) {
    const taut_vec3 half = {static_cast<float>(0.08 + 0.03 * random.uniform()),
                            static_cast<float>(0.07 + 0.03 * random.uniform()),
                            static_cast<float>(0.08 + 0.03 * random.uniform())};
    Shape rock;
    rock.kind = ShapeKind::hull;
    for (int i = 0; i < 16; ++i) {
        const taut_vec3 n = random.direction();
        rock.points.push_back({half.x * n.x, half.y * n.y, half.z * n.z});
    }
    return scene.add_shape(std::move(rock));
}

}  // namespace

Scene build_sack(double, double, const Options& options) {
    constexpr double kRim = kBagRadius * 0.857, kHook = 0.3, kWinch = 3.4;  // [m], above the bag's centre and its rim
    Scene scene = soft_hall(2);
    add_ground(scene);
    const taut_pos centre = {0, kBagRadius + 0.02, 0}, at = plus(centre, 0, kRim + kHook, 0);
    Cloth cloth = bag(centre);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = 0.6f;
    cloth.def.thickness = 0.012f;
    cloth.def.self_collision = 1;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0xB98A58;
    const std::vector<taut_pos> points = cloth.points;
    scene.add_cloth(std::move(cloth));
    const int hook = scene.add_body(crate(cube_shape(scene, 0.08), at, 3, Look::steel));
    for (int k = 0; k < kBagAround; k += 2) {
        Joint rope;
        rope.kind = TAUT_JOINT_DISTANCE;
        rope.vertex_a.cloth = 0;
        rope.vertex_a.vertex = static_cast<uint32_t>(1 + (kBagRings - 1) * kBagAround + k);
        rope.body_b = hook;
        rope.max_length = static_cast<float>(length(minus(at, points[rope.vertex_a.vertex])));
        rope.drawn_radius = 0.006;
        scene.add_joint(rope);
    }
    Cable cable = cable_along(scene, TAUT_CABLE_PARTICLES, {at, {0, kWinch, 0}}, hook, kWorld, 0.03, 1);
    cable.def.end[0].anchor = {0, 0, 0};
    cable.def.segment_count = 24;
    const int index = scene.add_cable(cable);
    scene.motions.push_back({-1, -1, 1, {}, {{{1, 0, 0}, {5, -1.3, 0}}, {}}, index});
    scene.decorations.push_back({{0, kWinch + 0.06, 0}, {0.25f, 0.06f, 0.12f}});
    Random random(3);
    constexpr int kRing = 5;
    for (int i = 0; i < 2 * kRing + 1; ++i) {
        const double round = 2 * std::numbers::pi * (i % kRing + 0.5 * (i / kRing)) / kRing;
        const double out = i < 2 * kRing ? 0.2 : 0, up = i < kRing ? -0.2 : i < 2 * kRing ? 0.02 : 0.21;
        Body rock = crate(rock_shape(scene, random), plus(centre, out * std::cos(round), up, out * std::sin(round)), 0,
                          Look::stone);
        rock.density = 2500;
        scene.roles.pile.push_back(scene.add_body(rock));
    }
    scene.forces = ForceScale{1, 4};
    scene.camera = {{1.5, 1.9, 2.4}, {0, 1.1, 0}, 48};
    scene.stage = {{-2, 0, -2}, {2, 3.6, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
