// Sheets that hang, with and without weights.
#include <algorithm>
#include <cmath>

#include "builders.h"
#include "parts.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// n x n vertices, held by two neighbouring corners.
Scene hung_sheet(int n) {
    constexpr double kSheetHeight = 2.2;
    Scene scene = soft_hall(kSheetHeight);
    Cloth cloth = sheet(n, kSheetHeight);
    cloth.def.filter.mask = 0;
    cloth.pinned = {0, static_cast<uint32_t>(n - 1)};
    scene.add_cloth(std::move(cloth));
    return scene;
}

// A point mass on a vertex.
void load_vertex(Scene& scene, int cloth, uint32_t vertex, double mass) {
    Body weight;
    weight.kind = TAUT_BODY_PARTICLE;
    weight.position = scene.cloths[static_cast<size_t>(cloth)].points[vertex];
    weight.mass = static_cast<float>(mass);
    weight.look = Look::particle;
    Joint joint;
    joint.body_a = scene.add_body(weight);
    joint.vertex_b.cloth = cloth;
    joint.vertex_b.vertex = vertex;
    scene.add_joint(joint);
}

}  // namespace

Scene build_cloth_hang(double n, double, const Options& options) {
    Scene scene = hung_sheet(std::max(2, static_cast<int>(n)));
    perturb(scene, options.seed);
    return scene;
}

// The row opposite the fixed corners weighs r times the sheet more.
Scene build_cloth_row(double n, double r, const Options& options) {
    const int side = std::max(2, static_cast<int>(n));
    Scene scene = hung_sheet(side);
    for (int k = 0; k < side; ++k)
        load_vertex(scene, 0, static_cast<uint32_t>(side * (side - 1) + k), r * kSheetMass / side);
    perturb(scene, options.seed);
    return scene;
}

// A box of r times the sheet's mass falls on its middle.
Scene build_cloth_load(double, double r, const Options& options) {
    constexpr double kSheetHeight = 1.8, kBox = 0.4;
    constexpr int kSide = 30;
    Scene scene = soft_hall(kSheetHeight);
    add_ground(scene);
    Cloth cloth = sheet(kSide, kSheetHeight);
    cloth.pinned = {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1};
    scene.add_cloth(std::move(cloth));
    scene.add_body(crate(cube_shape(scene, kBox), {0, kSheetHeight + 0.1 + kBox / 2, 0}, r * kSheetMass));
    perturb(scene, options.seed);
    return scene;
}

// Balls of 500 times the mass of a vertex hang on a sheet of links that do not stretch (Tournier et al. 2015, section
// 4).
Scene build_cloth_loaded(double, double, const Options& options) {
    constexpr int kSide = 30, kEvery = 7, kBalls = 5;
    constexpr double kRatio = 500, kRadius = 0.05;
    Scene scene = hung_sheet(kSide);
    Cloth& cloth = scene.cloths.front();
    cloth.def.stretch_compliance[0] = cloth.def.stretch_compliance[1] = 0;
    cloth.look.most = 0.02;
    const int shape = sphere_shape(scene, kRadius);
    for (int i = 0; i < kBalls; ++i) {
        const auto vertex = static_cast<uint32_t>(kSide * (kSide - 1) + 1 + std::min(kEvery * i, kSide - 3));
        const taut_pos& at = cloth.points[vertex];
        Body weight = crate(shape, {at.x + kRadius, at.y, at.z}, kRatio * kSheetMass / (kSide * kSide), Look::steel);
        weight.group = -1;
        Joint joint;
        joint.body_a = scene.add_body(weight);
        joint.anchor_a = {-kRadius, 0, 0};
        joint.vertex_b.cloth = 0;
        joint.vertex_b.vertex = vertex;
        joint.drawn_radius = 0.012;
        scene.add_joint(joint);
    }
    scene.forces = ForceScale{-1, 3};
    scene.camera = {{2.6, 1.9, 3.3}, {-0.3, 1.45, 0}, 38};
    perturb(scene, options.seed);
    return scene;
}

// A sheet of links beside one of triangles with the figures of cotton.
Scene build_cloth_fem_beside_links(double, double, const Options& options) {
    constexpr int kSide = 28;
    constexpr double kSheetHeight = 2.1, kAside = 0.95;
    Scene scene = soft_hall(kSheetHeight);
    for (const bool links : {false, true}) {
        Cloth cloth = sheet(kSide, kSheetHeight);
        if (!links) {
            cloth.def.kind = TAUT_CLOTH_TRIANGLES;
            taut_cloth_def_set_fabric(&cloth.def, TAUT_FABRIC_COTTON);
            cloth.def.area_density = static_cast<float>(kSheetDensity);
        }
        for (taut_pos& p : cloth.points) p.z += links ? -kAside : kAside;
        cloth.pinned = {0, kSide - 1};
        cloth.def.filter.mask = 0;
        cloth.look.most = 0.04;
        cloth.look.label = links ? "right: links" : "left: triangles, cotton";
        cloth.look.paint = 0xB8473A;
        scene.add_cloth(std::move(cloth));
    }
    scene.camera = {{4.3, 2.3, 0}, {-0.75, 1.35, 0}, 40};
    scene.stage = {{-2.5, 0, -2}, {2, kSheetHeight + 0.3, 2}};
    perturb(scene, options.seed);
    return scene;
}

// A flag along a pole with a slit from its far end to its middle, in a wind that is too strong for it: it tears on.
Scene build_tearing_flag(double, double, const Options& options) {
    constexpr int kLong = 25, kTall = 17;
    constexpr double kLength = 1.8, kHeight = 1.2, kTop = 2.1;
    Scene scene = soft_hall(kTop);
    add_ground(scene);
    Cloth flag = grid_cloth(kLong, kTall, kLength, kHeight, 0);
    for (taut_pos& p : flag.points) p = {p.x + kLength / 2, kTop - kHeight / 2 - p.z, 0.08 * std::sin(4 * p.x)};
    flag.def.kind = TAUT_CLOTH_TRIANGLES;
    flag.def.area_density = 0.2f;
    flag.def.stretch_stiffness[0] = flag.def.stretch_stiffness[1] = 2500;
    flag.def.shear_stiffness = 600;
    flag.def.bending_stiffness = 1e-5f;
    flag.def.stiffness_damping = 0.001f;
    flag.def.air_drag = 1.2f;
    flag.def.air_lift = 1;
    flag.def.tear_strain = 0.04f;
    flag.look.most = 0.05;
    for (uint32_t k = 0; k < kTall; ++k) flag.pinned.push_back(k);
    // The lower lip of the slit: vertices of their own for the triangles below it.
    std::vector<uint32_t> lip(flag.points.size());
    for (uint32_t i = kLong / 2; i < kLong; ++i) {
        const uint32_t v = i * kTall + kTall / 2;
        lip[v] = static_cast<uint32_t>(flag.points.size());
        flag.points.push_back(flag.points[v]);
        flag.uv.insert(flag.uv.end(), {flag.uv[2 * v], flag.uv[2 * v + 1]});
    }
    for (size_t t = 0; t < flag.triangles.size(); t += 3) {
        uint32_t* corner = &flag.triangles[t];
        const bool below = std::any_of(corner, corner + 3, [](uint32_t v) { return v % kTall > kTall / 2; });
        for (size_t k = 0; below && k < 3; ++k)
            if (lip[corner[k]] != 0) corner[k] = lip[corner[k]];
    }
    scene.add_cloth(std::move(flag));
    scene.world.wind = {18.5f, 0.5f, 7};
    add_static_box(scene, {-0.03, kTop / 2 + 0.05, 0}, 0.03, kTop / 2 + 0.05, 0.03, Look::steel);
    scene.camera = {{0.9, 1.7, 4.0}, {0.75, 1.35, 0}, 38};
    scene.stage = {{-1, 0, -2}, {3, 2.5, 2}};
    perturb(scene, options.seed);
    return scene;
}

void add_trampoline(Scene& scene, int side, double wide) {
    constexpr double kGap = 0.25, kSpring = 5e3;
    constexpr float kHard = 1e-10f;  // [m/N]
    Cloth mat = grid_cloth(side, side, wide, wide, kTrampolineHeight);
    mat.def.kind = TAUT_CLOTH_LINKS;
    mat.def.area_density = 0.4f;
    mat.def.stretch_compliance[0] = mat.def.stretch_compliance[1] = kHard;
    mat.look.most = 0.01;
    const std::vector<taut_pos> points = mat.points;
    scene.add_cloth(std::move(mat));
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            const int across = (i == side - 1) - (i == 0), along = (k == side - 1) - (k == 0);
            if (across == 0 && along == 0) continue;
            Joint spring;
            spring.kind = TAUT_JOINT_DISTANCE;
            spring.vertex_a.cloth = 0;
            spring.vertex_a.vertex = static_cast<uint32_t>(i * side + k);
            const taut_pos& at = points[spring.vertex_a.vertex];
            const double reach = std::hypot(across, along);
            spring.anchor_b = {at.x + across * kGap, at.y, at.z + along * kGap};
            spring.length = static_cast<float>(0.97 * kGap * reach);
            spring.compliance = static_cast<float>(1 / kSpring);
            spring.drawn_radius = 0.008;
            scene.add_joint(spring);
        }
    const double half = wide / 2 + kGap, thick = 0.03;
    for (const double end : {-1.0, 1.0}) {
        add_static_box(scene, {end * (half + thick), kTrampolineHeight, 0}, thick, thick, half + 2 * thick,
                       Look::steel);
        add_static_box(scene, {0, kTrampolineHeight, end * (half + thick)}, half, thick, thick, Look::steel);
        for (const double other : {-1.0, 1.0})
            add_static_box(scene, {end * (half + thick), kTrampolineHeight / 2, other * (half + thick)}, thick,
                           kTrampolineHeight / 2, thick, Look::steel);
    }
    scene.forces = ForceScale{0, 3};
}

// Balls on a mat (Tournier et al. 2015, section 5).
Scene build_trampoline(double, double, const Options& options) {
    constexpr int kSide = 22;
    constexpr double kWide = 2, kRadius = 0.22;
    Scene scene = soft_hall(1.6);
    add_ground(scene);
    add_trampoline(scene, kSide, kWide);
    const int ball = sphere_shape(scene, kRadius);
    scene.add_body(crate(ball, {0.05, kTrampolineHeight + 1.2, 0.1}, 30));
    scene.add_body(crate(ball, {-0.45, kTrampolineHeight + 2.2, -0.4}, 8));
    scene.add_body(crate(ball, {0.4, kTrampolineHeight + 3.2, -0.3}, 3));
    scene.camera = {{2.6, 2.5, 3.6}, {0, 1.15, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, 3.5, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
