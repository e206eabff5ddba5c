// What is put together from other parts than triangles and tetrahedra: quadrilaterals, points without a mesh, metal.
#include <algorithm>
#include <cmath>

#include "builders.h"
#include "parts.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// A joint of a vertex and a body where the vertex is.
Joint vertex_on(const Scene& scene, int body, const SoftVertex& vertex, const taut_pos& at) {
    const taut_pos& from = scene.bodies[static_cast<size_t>(body)].position;
    Joint joint;
    joint.body_a = body;
    joint.anchor_a = {at.x - from.x, at.y - from.y, at.z - from.z};
    joint.vertex_b = vertex;
    joint.drawn_radius = 0;
    return joint;
}

Track there_and_back(double way, double begin, double there, double back) {
    return {{{0, 0, 0}, {begin, 0, 0}, {there, way, 0}, {back, way, 0}, {back + 1, 0, 0}}, {}};
}

}  // namespace

// Patches of quadrilaterals with a Green strain and an orthotropic law, ten times as stiff along as across, pulled from
// their sides: along the stiff direction, across it, and at an eighth of a turn to it, where they shear (Tournier et
// al. 2015, figure 6 left).
Scene build_quads(double, double, const Options& options) {
    constexpr int kSide = 11;
    constexpr double kWide = 0.7, kStiff = 4000, kSoft = 400, kPulled = 0.22;
    struct Kind {
        const char* label;
        double turn;
        uint32_t paint;
    };
    constexpr Kind kKinds[] = {{"left: stiff along the pull", 0, 0x3D7EBF},
                               {"middle: at 45 degrees to it", 45, 0x4E9B58},
                               {"right: across it", 90, 0xC9463D}};
    Scene scene = soft_hall(1.4);
    double x = -1.35;
    for (const Kind& kind : kKinds) {
        Cloth patch = grid_cloth(kSide, kSide, kWide, kWide, 0);
        patch.triangles.clear();
        const double c = std::cos(degrees(kind.turn)), s = std::sin(degrees(kind.turn));
        for (size_t v = 0; v < patch.points.size(); ++v) {  // upright, with the warp turned within
            taut_pos& p = patch.points[v];
            patch.uv[2 * v] = static_cast<float>(c * p.x + s * p.z);
            patch.uv[2 * v + 1] = static_cast<float>(c * p.z - s * p.x);
            p = {x + p.x, 1 + p.z, 0};
        }
        for (uint32_t i = 0; i + 1 < kSide; ++i)
            for (uint32_t k = 0; k + 1 < kSide; ++k) {
                const uint32_t a = i * kSide + k;
                patch.quads.insert(patch.quads.end(), {a, a + kSide, a + kSide + 1, a + 1});
            }
        patch.def.kind = TAUT_CLOTH_QUADS;
        patch.def.stretch_stiffness[0] = kStiff;
        patch.def.stretch_stiffness[1] = kSoft;
        patch.def.shear_stiffness = 200;
        patch.def.poisson_ratio = 0.3f;
        patch.def.area_density = 0.5f;
        patch.def.damping = 0.01f;
        patch.def.filter.mask = 0;
        patch.look.most = 0.35;
        patch.look.label = kind.label;
        patch.look.paint = kind.paint;
        for (const bool far : {false, true}) {
            Body bar;
            bar.kind = TAUT_BODY_KINEMATIC;
            bar.shape = box_shape(scene, 0.015, kWide / 2 + 0.03, 0.015);
            bar.position = {x + (far ? 1 : -1) * (kWide / 2 + 0.015), 1, 0};
            bar.look = Look::steel;
            const int body = scene.add_body(bar);
            if (far) {
                Motion pull;
                pull.body = body;
                pull.along = {1, 0, 0};
                pull.track = there_and_back(kPulled, 0.3, 1.5, 2.8);
                scene.motions.push_back(pull);
            }
            for (uint32_t k = 0; k < kSide; ++k) {
                const uint32_t v = (far ? kSide - 1 : 0) * kSide + k;
                scene.add_joint(
                    vertex_on(scene, body, {static_cast<int>(scene.cloths.size()), -1, v}, patch.points[v]));
            }
        }
        scene.add_cloth(std::move(patch));
        x += 1.2;
    }
    scene.forces = ForceScale{-1, 3};
    scene.camera = {{0.0, 1.15, 3.4}, {-0.02, 1.0, 0}, 40};
    scene.stage = {{-2, 0, -1}, {2, 2, 1}};
    perturb(scene, options.seed);
    return scene;
}

Scene build_plastic_bar(double, double r, const Options& options) { return build_plastic_bar_n(25, r, options); }

// Bars that are bent down and let go: one that yields and hardens keeps a part of the bend, the other comes back.
// Of n vertices along.
Scene build_plastic_bar_n(double n, double, const Options& options) {
    constexpr double kBar[3] = {1.2, 0.08, 0.08}, kBent = 0.45;
    const int kNodes[3] = {std::max(3, static_cast<int>(n)), 3, 3};
    Scene scene = soft_hall(1.2);
    for (const bool yields : {true, false}) {
        const double z = yields ? 0.15 : -0.2;
        Solid bar = box_of_hexahedra(kBar, kNodes, {-kBar[0] / 2, 0.9, z});
        bar.def.material = TAUT_SOLID_COROTATED;
        bar.def.young_modulus = 1e8f;
        bar.def.poisson_ratio = 0.3f;
        bar.def.density = 2700;
        if (yields) bar.def.yield_stress = 1.2e6f, bar.def.hardening = 1e7f;
        bar.def.damping = 0.002f;
        bar.def.mass_damping = 1;
        bar.def.filter.mask = 0;
        bar.look = {SoftColours::stress, 4e6, 0, yields ? "in front: yields at 1.2 MPa" : "behind: elastic"};
        Body hand;
        hand.kind = TAUT_BODY_KINEMATIC;
        hand.shape = box_shape(scene, 0.02, 0.02, 0.06);
        hand.position = {kBar[0] / 2 - 0.04, 1.005, z + kBar[2] / 2};
        hand.look = Look::steel;
        const int body = scene.add_body(hand);
        Motion down;
        down.body = body;
        down.along = {0, -1, 0};
        down.track = {{{0, 0, 0}, {0.3, 0, 0}, {1.5, kBent, 0}, {1.8, kBent, 0}, {2.3, 0.0, 0}}, {}};
        scene.motions.push_back(down);
        const int solid = static_cast<int>(scene.solids.size());
        for (int j = 0; j < kNodes[1]; ++j)
            for (int k = 0; k < kNodes[2]; ++k) {
                bar.pinned.push_back(box_vertex(kNodes, 0, j, k));
                if (j + 1 < kNodes[1]) continue;
                const uint32_t v = box_vertex(kNodes, kNodes[0] - 2, j, k);
                Joint hold = vertex_on(scene, body, {-1, solid, v}, bar.points[v]);
                hold.until = 1.8;
                scene.add_joint(hold);
            }
        scene.add_solid(std::move(bar));
    }
    add_static_box(scene, {-kBar[0] / 2 - 0.05, 0.93, 0.0}, 0.05, 0.12, 0.35, Look::stone);
    scene.forces = ForceScale{0, 4};
    scene.camera = {{0.5, 1.15, 2.1}, {-0.02, 0.72, 0}, 40};
    scene.stage = {{-1.5, 0, -1}, {1.5, 1.5, 1}};
    perturb(scene, options.seed);
    return scene;
}

// n cubes of r Pa of points without a mesh, dropped beside each other.
Scene build_meshless(double n, double r, const Options& options) {
    constexpr double kCube[3] = {0.4, 0.4, 0.4};
    constexpr int kNodes[3] = {5, 5, 5};
    constexpr taut_solid_material kOf[] = {TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_ST_VENANT_KIRCHHOFF,
                                           TAUT_SOLID_COROTATED};
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        Solid cube = without_mesh(box_of_hexahedra(kCube, kNodes, {-0.8 + 0.6 * i, 0.3 + 0.2 * i, -0.2}));
        cube.def.material = kOf[i % 3];
        cube.def.young_modulus = static_cast<float>(r);
        cube.def.poisson_ratio = 0.4f;
        scene.add_solid(std::move(cube));
    }
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
