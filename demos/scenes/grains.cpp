// Granular matter: particles with a radius and friction, poured into a heap.
#include <array>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr double kGrainRadius = 0.05, kGrainMass = 1;  // [m, kg]

Body grain_at(int shape, taut_pos at, float friction, double mass = kGrainMass, Look look = Look::sand) {
    Body grain = crate(shape, at, mass, look);
    grain.kind = TAUT_BODY_PARTICLE;
    grain.friction = friction;
    grain.grain = true;
    return grain;
}

double mass_of_ball(double radius, double density) { return density * 4.18879020478639 * radius * radius * radius; }

// Grains as a block of columns x rows in each layer, a tenth of a radius out of their places, above a point.
struct Poured {
    double radius;
    int count, columns, rows;
    double density;
    Look look;
};
void pour(Scene& scene, const Poured& of, taut_pos above, Random& random) {
    const double spacing = 2.25 * of.radius, mass = mass_of_ball(of.radius, of.density);
    const int ball = sphere_shape(scene, of.radius);
    for (int i = 0; i < of.count; ++i) {
        const int column = i % of.columns, row = i / of.columns % of.rows, layer = i / (of.columns * of.rows);
        const taut_pos place = plus(above, (column - 0.5 * (of.columns - 1)) * spacing, of.radius + layer * spacing,
                                    (row - 0.5 * (of.rows - 1)) * spacing);
        const taut_pos at = scattered(place, 0.1 * of.radius, 0.1 * of.radius, random);
        scene.roles.pile.push_back(scene.add_body(grain_at(ball, at, 0.5f, mass, of.look)));
    }
}

}  // namespace

// R is the friction of the grains. They do not turn, so that even round ones heap up.
Scene build_grains(double n, double r, const Options& options) {
    constexpr double kBed = 3.2, kBump = 2.2 * kGrainRadius;  // [m]
    constexpr int kRow = 4;                                   // of the column that is poured
    Scene scene = empty_scene();
    add_ground(scene);
    const int ball = sphere_shape(scene, kGrainRadius);
    const auto friction = static_cast<float>(r);
    // A bed of grains held fast.
    for (double x = -kBed / 2; x <= kBed / 2; x += kBump)
        for (double z = -kBed / 2; z <= kBed / 2; z += kBump) {
            Body bump = crate(ball, {x, 0, z}, 0, Look::stone);
            bump.kind = TAUT_BODY_STATIC;
            bump.friction = friction;
            scene.add_body(bump);
        }
    Random random(1);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        // A loose column, out of line enough to scatter as it lands.
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1), beside = 3 * kGrainRadius, above = 2.6 * kGrainRadius;
        const taut_pos at =
            scattered({(column - middle) * beside, 4 * kGrainRadius + layer * above, (row - middle) * beside},
                      0.45 * kGrainRadius, 0.18 * kGrainRadius, random);
        scene.roles.pile.push_back(scene.add_body(grain_at(ball, at, friction)));
    }
    perturb(scene, options.seed);
    scene.camera = {{2.9, 2.1, 3.7}, {0, 0.5, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, 8, 2}};
    return scene;
}

// A lattice of grains, each a centimetre out of its place, falls into a box of 2 x 2 m.
Scene build_grains_box(double n, double, const Options& options) {
    constexpr double kHalf = 1, kJitter = 0.01, kSpacing = 2.4 * kGrainRadius;  // [m]
    constexpr int kRow = 16;
    Scene scene = empty_scene();
    add_ground(scene);
    const int count = static_cast<int>(n), layers = (count + kRow * kRow - 1) / (kRow * kRow);
    const double tall = 2 * kGrainRadius + layers * kSpacing;
    add_bin(scene, kHalf, tall, 0.5);
    scene.roles.bin = Bounds{{-kHalf, -0.5, -kHalf}, {kHalf, 2 * tall, kHalf}};
    const int ball = sphere_shape(scene, kGrainRadius);
    Random random(1);
    for (int i = 0; i < count; ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1);
        const taut_pos at =
            scattered({(column - middle) * kSpacing, 2 * kGrainRadius + layer * kSpacing, (row - middle) * kSpacing},
                      kJitter, kJitter, random);
        scene.roles.pile.push_back(scene.add_body(grain_at(ball, at, 0.5f)));
    }
    perturb(scene, options.seed);
    scene.camera = {{2.6, 0.7 * tall + 1.5, 3.2}, {0, 0.3 * tall, 0}, 42};
    scene.stage = {{-2, 0, -2}, {2, tall + 1, 2}};
    return scene;
}

// A thousand grains fall on a sheet of 20 x 20 held by its corners (Francu 2016, figure 5.10).
Scene build_grains_on_cloth(double, double, const Options& options) {
    constexpr int kSide = 20;
    constexpr double kHeight = 1.3, kRadius = 0.03;
    Scene scene = soft_hall(kHeight);
    add_ground(scene);
    Cloth cloth = sheet(kSide, kHeight);
    cloth.def.thickness = 0.02f;
    cloth.def.self_collision = 1;
    sag(cloth, kSheetSide, 0.5);
    cloth.pinned = {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1};
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x3D7EBF;
    scene.add_cloth(std::move(cloth));
    Random random(1);
    pour(scene, {kRadius, 1000, 10, 10, 500, Look::paint}, {0, kHeight - 0.05, 0}, random);
    scene.camera = {{1.9, 1.9, 2.7}, {0, 1.1, 0}, 42};
    scene.stage = {{-2, 0, -2}, {2, 3, 2}};
    perturb(scene, options.seed);
    return scene;
}

namespace {

constexpr double kNetHalf = 0.8, kNetHeight = 1.2;  // [m]
constexpr int32_t kNetGroup = -7;

// The bars of a frame about the net, on posts; x at -1 and 1, then z. They are shaken.
std::array<int, 4> add_net_frame(Scene& scene) {
    constexpr double kBar = 0.03, kAway = kNetHalf + kBar, kShake = 0.025, kPerSecond = 2.5;  // [m], [m], [m], [Hz]
    std::array<int, 4> bars{};
    for (size_t i = 0; i < bars.size(); ++i) {
        const double side = i % 2 == 0 ? -1 : 1;
        const bool across = i < 2;
        const int shape = across ? box_shape(scene, kBar, kBar, kAway + kBar) : box_shape(scene, kNetHalf, kBar, kBar);
        Body bar = crate(shape, {across ? side * kAway : 0, kNetHeight, across ? 0 : side * kAway}, 0, Look::wood);
        bar.kind = TAUT_BODY_KINEMATIC;
        bar.group = kNetGroup;
        bars[i] = scene.add_body(bar);
        Motion shake;
        shake.body = bars[i];
        shake.along = {0.8f, 0, 0.6f};
        shake.track.keys = {{0, 0, 0}};
        shake.track.shake = {kShake, kPerSecond, 1.2, 4};
        scene.motions.push_back(shake);
        for (const double other : {-1.0, 1.0})
            if (across)
                add_static_box(scene, {side * kAway, (kNetHeight - kBar) / 2, other * kAway}, kBar,
                               (kNetHeight - kBar) / 2, kBar, Look::wood);
    }
    return bars;
}

}  // namespace

// Grains on a net of cables tied where they cross, in a frame that is shaken: small ones pass, large ones stay. Small
// ones are less than a third as thick as the openings: those of half arch over them, the more as they do not turn.
Scene build_grains_through_mesh(double, double, const Options& options) {
    constexpr int kCables = 9, kSegments = 20;  // each way, of each
    constexpr double kSag = 0.12, kMesh = 2 * kNetHalf / (kCables + 1);
    Scene scene = soft_hall(kNetHeight);
    add_ground(scene);
    const std::array<int, 4> bars = add_net_frame(scene);
    const auto place = [&](double x, double z) {
        const double u = x / kNetHalf, v = z / kNetHalf;
        return taut_pos{x, kNetHeight - kSag * (1 - u * u) * (1 - v * v), z};
    };
    for (const bool along : {true, false})
        for (int i = 0; i < kCables; ++i) {
            const double side = kMesh * (i + 1) - kNetHalf;
            std::vector<taut_pos> path;
            for (int k = 0; k <= kSegments; ++k) {
                const double way = 2 * kNetHalf * k / kSegments - kNetHalf;
                path.push_back(along ? place(way, side) : place(side, way));
            }
            const size_t first = along ? 0 : 2;
            Cable cable =
                cable_along(scene, TAUT_CABLE_PARTICLES, std::move(path), bars[first], bars[first + 1], 0.02, 0.3);
            cable.def.filter.group = kNetGroup;
            scene.add_cable(cable);
        }
    const auto knot = [](int i) { return static_cast<uint32_t>(kSegments / (kCables + 1) * (i + 1)); };
    for (int i = 0; i < kCables; ++i)
        for (int k = 0; k < kCables; ++k) {
            Joint tie;
            tie.vertex_a.cable = i;
            tie.vertex_a.vertex = knot(k);
            tie.vertex_b.cable = kCables + k;
            tie.vertex_b.vertex = knot(i);
            tie.drawn_radius = 0.018;
            scene.add_joint(tie);
        }
    Random random(1);
    pour(scene, {0.02, 800, 20, 20, 1500, Look::paint}, {0, kNetHeight + 0.75, 0}, random);
    pour(scene, {0.1, 14, 4, 4, 1000, Look::stone}, {0, kNetHeight + 0.4, 0}, random);
    scene.forces = ForceScale{0, 3};
    scene.camera = {{2.0, 2.1, 2.9}, {0, 0.95, 0}, 42};
    scene.stage = {{-2, 0, -2}, {2, 3, 2}};
    perturb(scene, options.seed);
    return scene;
}

// Twenty thousand grains on a table with a rim, ploughed by blades that are led, a ball that rolls and boxes that fall.
Scene build_sand_on_table(double, double, const Options& options) {
    constexpr int kGrains = 20000, kRow = 70;
    constexpr double kRadius = 0.02, kHalf = 1.6, kTable = 0.7, kRim = 0.24, kAbove = 0.35;
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    add_static_box(scene, {0, kTable - 0.05, 0}, kHalf + 0.06, 0.05, kHalf + 0.06, Look::wood);
    for (const double side : {-1.0, 1.0}) {
        add_static_box(scene, {side * (kHalf + 0.03), kTable + kRim / 2, 0}, 0.03, kRim / 2, kHalf + 0.06, Look::wood);
        add_static_box(scene, {0, kTable + kRim / 2, side * (kHalf + 0.03)}, kHalf, kRim / 2, 0.03, Look::wood);
    }
    Random random(1);
    pour(scene, {kRadius, kGrains, kRow, kRow, 1500, Look::paint}, {0, kTable, 0}, random);
    // Blades come down into the sand before they move along.
    const auto lower = [&](int body) {
        Motion down;
        down.body = body;
        down.along = {0, -1, 0};
        down.track.keys = {{0.2, 0, 0}, {1, kAbove, 0}, {1e3, kAbove, 0}};
        scene.motions.push_back(down);
        return body;
    };
    const taut_pos hub = {0.5, kTable + 0.16 + kAbove, 0.5};
    for (int i = 0; i < 2; ++i) {  // a cross that turns
        Body blade = crate(box_shape(scene, i == 0 ? 0.4 : 0.02, 0.1, i == 0 ? 0.02 : 0.4), hub, 0, Look::steel);
        blade.kind = TAUT_BODY_KINEMATIC;
        Motion spin;
        spin.body = lower(scene.add_body(blade));
        spin.about = {0, 1, 0};
        spin.pivot = hub;
        spin.track.keys = {{1, 0, 0}, {2, 0.75, 1.5}};
        scene.motions.push_back(spin);
    }
    Body plough = crate(box_shape(scene, 0.02, 0.11, 0.28), {-1.4, kTable + 0.165 + kAbove, -0.9}, 0, Look::steel);
    plough.kind = TAUT_BODY_KINEMATIC;
    Motion there;
    there.body = lower(scene.add_body(plough));
    there.along = {1, 0, 0};
    there.track.keys = {{1, 0, 0}, {4, 2.7, 0}, {5, 2.7, 0}, {8, 0, 0}};
    scene.motions.push_back(there);
    Body ball = crate(sphere_shape(scene, 0.14), {-0.9, kTable + 0.55, 0.6}, 30, Look::steel);
    ball.linear_velocity = {1.5f, 0, -0.4f};
    scene.add_body(ball);
    for (int i = 0; i < 3; ++i) {
        Body box = crate(cube_shape(scene, 0.2), {-0.2 + 0.15 * i, kTable + 0.7 + 0.4 * i, -0.1 - 0.1 * i}, 8);
        box.rotation = turn({0.6f, 0, 0.8f}, 0.5 + i);
        scene.add_body(box);
    }
    scene.camera = {{2.2, 2.8, 3.3}, {0, 0.6, 0}, 42};
    scene.stage = {{-2.2, 0, -2.2}, {2.2, 3, 2.2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
