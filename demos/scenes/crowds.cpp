// Much of one kind: what stands about far away, what comes together in one place, tall trees on hills, nets of many
// knots, a drum that turns, hulls on many triangles.
#include <cmath>

#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

// A square sheet of triangles about the origin, of so many cells a side.
template <class Height>
int hills(Scene& scene, uint32_t cells, double spacing, Height&& height_of) {
    Shape shape;
    shape.kind = ShapeKind::mesh;
    const double half = 0.5 * cells * spacing;
    for (uint32_t row = 0; row <= cells; ++row)
        for (uint32_t column = 0; column <= cells; ++column) {
            const double x = column * spacing - half, z = row * spacing - half;
            shape.points.push_back({static_cast<float>(x), static_cast<float>(height_of(x, z)), static_cast<float>(z)});
        }
    for (uint32_t row = 0; row < cells; ++row)
        for (uint32_t column = 0; column < cells; ++column) {
            const uint32_t a = row * (cells + 1) + column, b = a + cells + 1;
            for (const uint32_t corner : {a, b, a + 1, a + 1, b, b + 1}) shape.indices.push_back(corner);
        }
    return scene.add_shape(shape);
}

void add_fixed(Scene& scene, int shape) {
    Body body = crate(shape, {0, 0, 0}, 0, Look::ground);
    body.kind = TAUT_BODY_STATIC;
    scene.add_body(body);
}

}  // namespace

Scene build_static_grid(double n, double, const Options& options) {
    constexpr int kBalls = 10;                                 // a side
    constexpr double kSlab = 10, kRadius = 0.5, kShare = 0.8;  // [m], of the width
    Scene scene = empty_scene();
    const int side = static_cast<int>(n), slab = box_shape(scene, kSlab / 2, 0.25, kSlab / 2);
    for (int i = 0; i < side; ++i)
        for (int k = 0; k < side; ++k) {
            Body body = crate(slab, {kSlab * (i - 0.5 * side), 0, kSlab * (k - 0.5 * side)}, 0, Look::stone);
            body.kind = TAUT_BODY_STATIC;
            scene.add_body(body);
        }
    const int ball = sphere_shape(scene, kRadius);
    for (int i = 0; i < kBalls; ++i)
        for (int k = 0; k < kBalls; ++k) {
            const auto at = [&](int j) { return kShare * kSlab * side * (static_cast<double>(j) / kBalls - 0.45); };
            scene.roles.pile.push_back(scene.add_body(crate(ball, {at(i), 1.5, at(k)}, 0)));
        }
    perturb(scene, options.seed);
    scene.camera = {{20, 15, 30}, {0, 0, 0}, 42};
    return scene;
}

Scene build_tipping(double n, double, const Options& options) {
    constexpr uint32_t kCells = 150;
    constexpr int kParts = 22;
    constexpr double kTaper = 0.95, kApart = 3, kSpin = 0.5;  // of the half width; [m]; [rad/s]
    Scene scene = empty_scene();
    const int count = static_cast<int>(n);
    add_fixed(scene,
              hills(scene, kCells, 1, [](double x, double z) { return 0.4 * std::sin(0.3 * x) * std::cos(0.6 * z); }));
    struct Box {
        int shape;
        double y, half_width, half_height;
    };
    std::vector<Box> boxes;
    double y = 1, half_width = 0.75;
    for (int i = 0; i < kParts; ++i, half_width *= kTaper) {
        const double half_height = 0.75 + half_width;
        boxes.push_back({box_shape(scene, half_width, half_height, half_width), y + 0.75, half_width, half_height});
        y += 1.5 + 2 * half_width;
    }
    double mass = 0, middle = 0;
    const auto mass_of = [](const Box& box) { return 8 * box.half_width * box.half_width * box.half_height; };
    for (const Box& box : boxes) mass += mass_of(box), middle += mass_of(box) * box.y;
    middle /= mass;
    Body pole = crate(boxes[0].shape, {0, 0, 0}, mass, Look::wood);
    double across = 0, along = 0;  // moments of inertia [kg m^2]
    for (const Box& box : boxes) {
        const double w = 4 * box.half_width * box.half_width, h = 4 * box.half_height * box.half_height;
        across += mass_of(box) * ((w + h) / 12 + (box.y - middle) * (box.y - middle));
        along += mass_of(box) * w / 6;
        if (&box != &boxes[0]) pole.parts.push_back({box.shape, {0, static_cast<float>(box.y - boxes[0].y), 0}});
    }
    pole.friction = 0.9f;
    for (int i = 0; i < count; ++i) {
        const double spin = (i % 2 ? kSpin : -kSpin) * (0.5 + 0.5 * i / count);
        pole.position = {0, 1 + boxes[0].y, kApart * (i - 0.5 * (count - 1))};
        pole.inertia = {static_cast<float>(across), static_cast<float>(along), static_cast<float>(across), 0, 0, 0};
        pole.angular_velocity = {0, 0, static_cast<float>(spin)};
        pole.linear_velocity = {static_cast<float>(-spin * boxes[0].y), 0, 0};
        scene.roles.pile.push_back(scene.add_body(pole));
    }
    perturb(scene, options.seed);
    scene.camera = {{30, 35, 80}, {0, 15, 0}, 42};
    scene.stage = {{-60, 0, -40}, {60, 60, 40}};
    return scene;
}

Scene build_joint_grid(double n, double, const Options& options) {
    constexpr double kApart = 1, kRadius = 0.4;  // [m]
    Scene scene = empty_scene();
    const int side = static_cast<int>(n), ball = sphere_shape(scene, kRadius);
    const auto at = [side](int column, int row) { return column * side + row; };
    for (int column = 0; column < side; ++column)
        for (int row = 0; row < side; ++row) {
            Body body = crate(ball, {kApart * (column - 0.5 * side), kApart * (side - row), 0}, 0, Look::particle);
            if (row == 0) body.kind = TAUT_BODY_STATIC;
            body.group = -1;
            scene.add_body(body);
        }
    const auto tie = [&](int a, int b, double x, double y) {
        Joint joint;
        joint.body_a = a, joint.body_b = b;
        joint.anchor_a = {x, y, 0}, joint.anchor_b = {-x, -y, 0};
        scene.add_joint(joint);
    };
    for (int column = 0; column < side; ++column)
        for (int row = 1; row < side; ++row) {
            tie(at(column, row - 1), at(column, row), 0, -kApart / 2);
            if (column > 0) tie(at(column - 1, row), at(column, row), kApart / 2, 0);
        }
    scene.roles.mesh_width = kApart;
    perturb(scene, options.seed);
    scene.camera = {{0, 0.6 * side, 1.5 * side}, {0, 0.5 * side, 0}, 42};
    scene.stage = {{-0.6 * side, -0.2 * side, -0.6 * side}, {0.6 * side, 1.1 * side, 0.6 * side}};
    return scene;
}

Scene build_crowd(double n, double, const Options& options) {
    constexpr double kSide = 1, kHeight = 5;  // [m]
    Scene scene = empty_scene();
    add_ground(scene);
    const int cube = cube_shape(scene, kSide);
    for (int i = 0; i < static_cast<int>(n); ++i)
        scene.roles.pile.push_back(scene.add_body(crate(cube, {0, kHeight, 0}, 1)));
    perturb(scene, options.seed);
    scene.camera = {{12, 9, 16}, {0, 2, 0}, 42};
    return scene;
}

Scene build_washer(double, double, const Options& options) {
    constexpr int kWalls = 40, kRow = 20;
    constexpr double kRadius = 15, kHalfDepth = 10, kHalfThickness = 0.5, kCube = 0.6, kSpin = 0.4;  // [m], [rad/s]
    constexpr double kTurn = 2 * 3.14159265358979 / kWalls;
    Scene scene = empty_scene();
    Body drum = crate(-1, {0, kRadius + 1, 0}, 0, Look::steel);
    drum.kind = TAUT_BODY_KINEMATIC;
    const auto hull_of = [&](double x, double y, double z) {
        Shape shape;
        shape.kind = ShapeKind::hull;
        for (int corner = 0; corner < 8; ++corner)
            shape.points.push_back({static_cast<float>(corner & 1 ? x : -x), static_cast<float>(corner & 2 ? y : -y),
                                    static_cast<float>(corner & 4 ? z : -z)});
        return scene.add_shape(shape);
    };
    const int wall = hull_of(kRadius * std::tan(kTurn / 2) + kHalfThickness, kHalfThickness, kHalfDepth);
    for (int i = 0; i < kWalls; ++i) {
        const double angle = i * kTurn;
        const Part part{
            wall,
            {static_cast<float>(kRadius * std::sin(angle)), static_cast<float>(-kRadius * std::cos(angle)), 0},
            turn({0, 0, 1}, angle)};
        if (i == 0) drum.shape = hull_of(0.01, 0.01, 0.01);  // on the axis, where nothing comes
        drum.parts.push_back(part);
    }
    const int turning = scene.add_body(drum);
    for (const double z : {-kHalfDepth - kHalfThickness, kHalfDepth + kHalfThickness})
        add_static_box(scene, {0, kRadius + 1, z}, kRadius + 1, kRadius + 1, kHalfThickness, Look::hidden);
    Motion motion;
    motion.body = turning;
    motion.about = {0, 0, 1};
    motion.pivot = drum.position;
    motion.track = {{{0, 0, kSpin}}, {}};
    scene.motions.push_back(motion);
    const int cube = cube_shape(scene, kCube);
    for (int x = 0; x < kRow; ++x)
        for (int y = 0; y < kRow; ++y)
            for (int z = 0; z < kRow; ++z) {
                const auto at = [](int i) { return 1.5 * kCube * (i - 0.5 * (kRow - 1)); };
                scene.roles.pile.push_back(
                    scene.add_body(crate(cube, {at(x), kRadius + 1 + at(y), at(z)}, 0, Look::crate)));
            }
    perturb(scene, options.seed);
    scene.roles.bin = Bounds{{-kRadius - 1, 0, -kHalfDepth - 1}, {kRadius + 1, 2 * kRadius + 2, kHalfDepth + 1}};
    scene.camera = {{0, kRadius, 3 * kRadius}, {0, kRadius, 0}, 42};
    scene.stage = {{-kRadius, 0, -kHalfDepth}, {kRadius, 2 * kRadius, kHalfDepth}};
    return scene;
}

Scene build_convex_mesh(double, double, const Options& options) {
    constexpr uint32_t kCells = 100;  // 20 000 triangles
    constexpr int kRow = 10;
    constexpr double kSpacing = 0.5, kSize = 0.35, kApart = 1.2;  // [m]
    Scene scene = empty_scene();
    add_fixed(scene, hills(scene, kCells, kSpacing, [](double x, double z) {
                  return 0.004 * (x * x + z * z) + 0.3 * std::sin(0.9 * x) * std::cos(0.8 * z);
              }));
    Random random(1);
    std::vector<int> hulls;
    for (int i = 0; i < kRow; ++i) {
        Shape shape;
        shape.kind = ShapeKind::hull;
        for (int k = 0; k < 14; ++k) {
            const taut_vec3 way = random.direction();
            const auto reach = static_cast<float>(kSize);
            shape.points.push_back({reach * way.x, reach * way.y, reach * way.z});
        }
        hulls.push_back(scene.add_shape(shape));
    }
    for (int layer = 0; layer < kRow; ++layer)
        for (int i = 0; i < kRow * kRow; ++i) {
            const auto at = [](int k) { return kApart * (k - 0.5 * (kRow - 1)); };
            Body body =
                crate(hulls[static_cast<size_t>(layer)], {at(i % kRow), 2.0 + layer, at(i / kRow)}, 0, Look::stone);
            body.rotation = turn(random.direction(), 3 * random.uniform());
            scene.roles.pile.push_back(scene.add_body(body));
        }
    perturb(scene, options.seed);
    scene.camera = {{14, 10, 18}, {0, 1, 0}, 42};
    scene.stage = {{-12, 0, -12}, {12, 12, 12}};
    return scene;
}

}  // namespace scenes
