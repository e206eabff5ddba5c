// Solids stepped once a film frame by minimisation (Gast and Schroeder 2014).
#include <algorithm>
#include <cmath>

#include "builders.h"
#include "parts.h"
#include "random.h"
#include "soft_files.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr double kCube = 1;              // side [m]
constexpr double kFilmFrame = 1.0 / 24;  // [s]

Scene film_hall(double height) {
    Scene scene = soft_hall(height);
    scene.world.solver = TAUT_SOLVER_MINIMISATION;
    scene.world.time_step = static_cast<float>(kFilmFrame);
    scene.world.substeps = 1;
    scene.world.gravity = {0, 0, 0};
    return scene;
}

Solid soft_cube(int nodes, double young, taut_pos corner) {
    const double size[3] = {kCube, kCube, kCube};
    Solid solid = box_of_tets(size, {nodes, nodes, nodes}, corner);
    solid.def.material = TAUT_SOLID_FIXED_COROTATED;
    solid.def.young_modulus = static_cast<float>(young);
    solid.def.poisson_ratio = 0.45f;
    solid.def.density = 1000;
    solid.def.filter.mask = 0;
    return solid;
}

}  // namespace

// Its vertices are anywhere within its box, or all in the middle. Swept: neo-Hookean, in steps of real time.
Scene build_tangled_cube(double n, double r, const Options& options) {
    Scene scene = film_hall(1.8);
    const taut_pos corner{-kCube / 2, 0.5, -kCube / 2};
    Solid solid = soft_cube(std::max(2, static_cast<int>(n)), r, corner);
    solid.rest = solid.points;
    Random random(options.seed + 1);
    for (taut_pos& p : solid.points) {
        const auto part = [&] { return options.from_point ? 0.5 : random.uniform(); };
        const double x = part(), y = part(), z = part();
        p = {corner.x + kCube * x, corner.y + kCube * y, corner.z + kCube * z};
    }
    if (options.swept) {  // beside minimisation: real time's solver and material, at its steps
        const taut_world_def usual = empty_scene().world;
        scene.world.solver = usual.solver;
        scene.world.time_step = usual.time_step;
        scene.world.substeps = usual.substeps;
        solid.def.material = TAUT_SOLID_NEO_HOOKEAN;
    }
    solid.look = {SoftColours::stress, r, 0, ""};
    scene.add_solid(std::move(solid));
    return scene;
}

// Two sides are led apart to twice its length in a second; a second later they are back in two frames from a push
// towards each other.
Scene build_cube_stretch(double n, double r, const Options& options) {
    constexpr double kApart = 0.5, kPulse = 0.3, kStretched = 1, kPushed = 2;  // of each side [m]; [s]
    Scene scene = film_hall(1.8);
    const int side_nodes = std::max(2, static_cast<int>(n)), nodes[3] = {side_nodes, side_nodes, side_nodes};
    Solid solid = soft_cube(nodes[0], r, {-kCube / 2, 0.5, -kCube / 2});
    for (const int side : {-1, 1}) {
        Motion motion;
        motion.solid = 0;
        motion.along = {static_cast<float>(side), 0, 0};
        motion.track.keys = {{0, 0, 0},
                             {kStretched, kApart, 0},
                             {kPushed, kApart, 0},
                             {kPushed + kFilmFrame, kApart - kPulse, 0},
                             {kPushed + 2 * kFilmFrame, kApart, 0}};
        for (int j = 0; j < nodes[1]; ++j)
            for (int k = 0; k < nodes[2]; ++k)
                motion.vertices.push_back(box_vertex(nodes, side < 0 ? 0 : nodes[0] - 1, j, k));
        solid.pinned.insert(solid.pinned.end(), motion.vertices.begin(), motion.vertices.end());
        scene.motions.push_back(std::move(motion));
    }
    solid.look = {SoftColours::stress, 3 * r, 0, ""};
    scene.add_solid(std::move(solid));
    perturb(scene, options.seed);
    return scene;
}

namespace {

// A hall with gravity in which things meet on the ground.
Scene film_stage(double height) {
    Scene scene = film_hall(height);
    scene.camera = {{1.6, 0.9 * height, 3.2}, {0, height / 3, 0}, 40};
    scene.world.gravity = {0, -9.81f, 0};
    add_ground(scene);
    return scene;
}

void make_rubber(Solid& solid, double young, uint32_t paint) {
    solid.def.material = TAUT_SOLID_FIXED_COROTATED;
    solid.def.young_modulus = static_cast<float>(young);
    solid.def.poisson_ratio = 0.45f;
    solid.def.density = 1000;
    solid.look.paint = paint;
}

// Kinematic, led along a direction by so much a unit of the track.
int add_led(Scene& scene, int shape, taut_pos at, taut_quat turned, taut_vec3 along, Track track, Look look) {
    Body body;
    body.kind = TAUT_BODY_KINEMATIC;
    body.shape = shape;
    body.position = at;
    body.rotation = turned;
    body.look = look;
    Motion motion;
    motion.body = scene.add_body(body);
    motion.along = along;
    motion.track = std::move(track);
    scene.motions.push_back(std::move(motion));
    return scene.motions.back().body;
}

// Of a ring with so many vertices across its section, even.
int cells_around(int across) { return 2 * (5 * (across - 1) / 2 + 4); }

constexpr uint32_t kPaints[] = {0x3D7EBF, 0x4E9B58, 0xC9463D, 0xE3B23C, 0x8A5FA8};

}  // namespace

// A ball of a metre's width falls hard on the ground.
Scene build_film_ball(double n, double r, const Options& options) {
    constexpr double kFall = 10;  // [m/s]
    Scene scene = film_stage(1.6);
    Solid ball = ball_of_tets(0.5, std::max(3, static_cast<int>(n)), {0, 1.2, 0});
    make_rubber(ball, r, kPaints[0]);
    ball.velocities.assign(ball.points.size(), {0, static_cast<float>(-kFall), 0});
    scene.add_solid(std::move(ball));
    perturb(scene, options.seed);
    return scene;
}

// Two balls, one falls on the other.
Scene build_film_balls(double n, double r, const Options& options) {
    Scene scene = film_stage(2.2);
    for (int i = 0; i < 2; ++i) {
        Solid ball = ball_of_tets(0.4, std::max(3, static_cast<int>(n)), {0.1 * i, 0.5 + 1.1 * i, 0});
        make_rubber(ball, r, kPaints[i]);
        ball.velocities.assign(ball.points.size(), {0, -4.0f * static_cast<float>(i), 0});
        scene.add_solid(std::move(ball));
    }
    perturb(scene, options.seed);
    return scene;
}

// A ring falls on its edge and closes on itself.
Scene build_film_ring(double n, double r, const Options& options) {
    const int across = std::max(3, static_cast<int>(n));
    Scene scene = film_stage(1.6);
    Solid ring = ring_of_tets(0.42, 0.13, cells_around(across), across, {0, 1, 0});
    make_rubber(ring, r, kPaints[3]);
    ring.def.self_collision = 1;
    scene.add_solid(std::move(ring));
    perturb(scene, options.seed);
    return scene;
}

// A ring is pushed through a hole that is narrower, bounded by capsules.
Scene build_film_hole(double n, double r, const Options& options) {
    constexpr int kSides = 16;
    constexpr double kTau = 6.283185307179586, kHole = 0.5, kRim = 0.1, kHigh = 1.2;  // [m]
    const int across = std::max(3, static_cast<int>(n));
    Scene scene = film_stage(2.4);
    Solid ring = ring_of_tets(0.44, 0.15, cells_around(across), across, {0, 0, 0});
    for (taut_pos& p : ring.points) p = {p.x, kHigh + 0.3 + p.z, -p.y};
    make_rubber(ring, r, kPaints[2]);
    scene.add_solid(std::move(ring));
    const double middle = kHole + kRim;
    const int rim = capsule_shape(scene, kRim, middle * std::tan(kTau / 2 / kSides));
    for (int i = 0; i < kSides; ++i) {
        const double turn = kTau * i / kSides;
        Body side;
        side.kind = TAUT_BODY_STATIC;
        side.shape = rim;
        side.position = {middle * std::cos(turn), kHigh, middle * std::sin(turn)};
        // The capsule's y axis along the tangent (-sin, 0, cos): a quarter turn about the radius (cos, 0, sin).
        const double half = std::sqrt(0.5);
        side.rotation = {static_cast<float>(half * std::cos(turn)), 0, static_cast<float>(half * std::sin(turn)),
                         static_cast<float>(half)};
        side.look = Look::steel;
        scene.add_body(side);
    }
    Shape disc;
    disc.kind = ShapeKind::cylinder;
    disc.radius = 0.42f;
    disc.half_length = 0.05f;
    Track down;
    down.keys = {{0, 0, 0}, {0.3, 0, 0}, {2.0, 0.7, 0}, {2.5, 0.7, 0}, {3.5, 0, 0}};
    add_led(scene, scene.add_shape(std::move(disc)), {0, kHigh + 0.55, 0}, {0, 0, 0, 1}, {0, -1, 0}, down, Look::wood);
    scene.camera = {{1.9, 2.3, 2.8}, {0, 0.9, 0}, 42};
    perturb(scene, options.seed);
    return scene;
}

// A figure is squeezed between 32 cubes that come from all sides, and let go.
Scene build_film_squeeze(double n, double r, const Options& options) {
    constexpr int kCubes = 32;
    constexpr double kGolden = 2.399963229728653, kFar = 1.1, kSide = 0.22;  // [rad], [m]
    static_cast<void>(n);
    Scene scene = film_hall(1.8);
    Solid solid = figure(options.mesh);
    stand_up(solid.points, 1, 0.5);
    make_rubber(solid, r, kPaints[1]);
    scene.add_solid(std::move(solid));
    const int cube = cube_shape(scene, kSide);
    Random random(options.seed + 1);
    for (int i = 0; i < kCubes; ++i) {
        const double y = 1 - (2 * i + 1.0) / kCubes, flat = std::sqrt(1 - y * y), turn = kGolden * i;
        const taut_vec3 in{static_cast<float>(-flat * std::cos(turn)), static_cast<float>(-y),
                           static_cast<float>(-flat * std::sin(turn))};
        float q[4], size = 0;
        for (float& each : q) each = static_cast<float>(random.uniform()) - 0.5f, size += each * each;
        for (float& each : q) each /= std::sqrt(size);
        Track squeeze;
        squeeze.keys = {{0, 0, 0}, {1.5, 0.6, 0}, {2, 0.6, 0}, {3, 0, 0}};
        add_led(scene, cube, {-kFar * in.x, 1 - kFar * in.y, -kFar * in.z}, {q[0], q[1], q[2], q[3]}, in, squeeze,
                Look::steel);
    }
    scene.camera = {{1.8, 1.8, 3.6}, {0, 1, 0}, 40};
    return scene;
}

// A wall of n x n soft boxes, each other one ten times as stiff, is struck by a cube.
Scene build_film_stack(double n, double r, const Options& options) {
    constexpr double kBox = 0.3, kGap = 0.005;
    Scene scene = film_stage(2);
    const int rows = std::max(1, static_cast<int>(n));
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < rows; ++j) {
            const double size[3] = {kBox, kBox, kBox};
            const double pitch = kBox + kGap;
            Solid box = box_of_tets(size, {5, 5, 5}, {pitch * (i - 0.5 * rows), kGap + pitch * j, -kBox / 2});
            const bool stiff = (i + j) % 2 != 0;
            make_rubber(box, stiff ? 10 * r : r, kPaints[stiff ? 1 : 0]);
            scene.add_solid(std::move(box));
        }
    Track strike;
    strike.keys = {{0, 0, 0}, {0.5, 0, 0}, {1.5, 1.4, 2}, {2.5, 2.6, 0}};
    add_led(scene, cube_shape(scene, 0.5), {-0.5 * rows * kBox - 1.2, 0.6, 0}, {0, 0, 0, 1}, {1, 0, 0}, strike,
            Look::stone);
    scene.camera = {{1.6, 2, 4.8}, {0.4, 0.5, 0}, 40};
    scene.stage = {{-3, 0, -2}, {3, 3, 2}};
    perturb(scene, options.seed);
    return scene;
}

namespace {

// A shell between two spheres, open at the top, its rim flat: closed, looking outward.
Shape bowl(double inner, double outer, double high) {
    constexpr int kAround = 48, kDown = 16;
    constexpr double kTau = 6.283185307179586;
    Shape shape;
    shape.kind = ShapeKind::mesh;
    shape.sampled = true;
    // Rings from the lowest point outside up to the rim and down inside.
    std::vector<std::pair<double, double>> profile;   // radius, height
    const auto add_arc = [&](double radius, int i) {  // about a centre above the lowest point
        const double angle = std::acos((outer - high) / radius) * i / kDown;
        profile.emplace_back(radius * std::sin(angle), outer - radius * std::cos(angle));
    };
    for (int i = 1; i <= kDown; ++i) add_arc(outer, i);
    for (int i = kDown; i >= 1; --i) add_arc(inner, i);
    shape.points.push_back({0, 0, 0});
    for (const auto& [r, y] : profile)
        for (int k = 0; k < kAround; ++k) {
            const double turn = kTau * k / kAround;
            shape.points.push_back({static_cast<float>(r * std::cos(turn)), static_cast<float>(y),
                                    static_cast<float>(r * std::sin(turn))});
        }
    shape.points.push_back({0, static_cast<float>(outer - inner), 0});
    const auto at = [](size_t ring, int k) { return static_cast<uint32_t>(1 + ring * kAround + k % kAround); };
    for (int k = 0; k < kAround; ++k) {
        shape.indices.insert(shape.indices.end(), {0, at(0, k), at(0, k + 1)});
        for (size_t ring = 0; ring + 1 < profile.size(); ++ring)
            shape.indices.insert(shape.indices.end(), {at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k),
                                                       at(ring + 1, k + 1), at(ring, k + 1)});
        const auto top = static_cast<uint32_t>(shape.points.size() - 1);
        shape.indices.insert(shape.indices.end(), {top, at(profile.size() - 1, k + 1), at(profile.size() - 1, k)});
    }
    return shape;
}

}  // namespace

// n x n x n rings of r Pa fall into a bowl, apart at first and above it, five steps a film frame.
Scene build_film_tori(double n, double r, const Options& options) {
    constexpr double kPitch = 0.32, kRing = 0.11, kTube = 0.045;  // [m]
    const int side = std::max(1, static_cast<int>(n));
    Scene scene = film_stage(3);
    scene.world.time_step = static_cast<float>(kFilmFrame / 5);
    Body body;
    body.kind = TAUT_BODY_STATIC;
    body.shape = scene.add_shape(bowl(1.2, 1.35, 0.9));
    body.look = Look::stone;
    scene.add_body(body);
    Random random(options.seed + 1);
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            for (int k = 0; k < side; ++k) {
                const taut_pos centre{kPitch * (i - 0.5 * (side - 1)), 1.1 + kPitch * j,
                                      kPitch * (k - 0.5 * (side - 1))};
                Solid ring = ring_of_tets(kRing, kTube, 16, 4, {0, 0, 0});
                const double tilt = random.uniform(), turn = 6.28 * random.uniform();
                for (taut_pos& p : ring.points) {
                    const double y = p.y * std::cos(tilt) - p.z * std::sin(tilt);
                    const double z = p.y * std::sin(tilt) + p.z * std::cos(tilt);
                    p = {centre.x + p.x * std::cos(turn) - z * std::sin(turn), centre.y + y,
                         centre.z + p.x * std::sin(turn) + z * std::cos(turn)};
                }
                make_rubber(ring, r, kPaints[scene.solids.size() % std::size(kPaints)]);
                ring.def.self_collision = 1;
                scene.add_solid(std::move(ring));
            }
    scene.camera = {{1.3, 2.7, 2}, {0, 0.6, 0}, 44};
    return scene;
}

}  // namespace scenes
