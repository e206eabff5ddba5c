#include "load_scenes.h"

#include <cmath>

#include "scenes/parts.h"

namespace bench {

namespace {

using namespace scenes;

Scene build_vise(double, double force, const Options& options) {
    Scene scene = empty_scene();
    add_ground(scene);
    Random random(options.seed + 1);
    double end = 0.05;
    for (const double mass : {0.2, 3.0, 0.5, 1.0, 0.2}) {
        const double half = 0.03 + 0.07 * random.uniform();
        scene.add_body(crate(cube_shape(scene, 2 * half), {end + half, half, 0.04 * random.uniform() - 0.02}, mass));
        end += 2.2 * half;
    }
    add_static_box(scene, {end + 0.1, 0.5, 0}, 0.1, 0.5, 0.5, Look::wall);
    const taut_pos start{-0.15, 0.202, 0};
    const int plate = scene.add_body(crate(box_shape(scene, 0.1, 0.2, 0.4), start, 4, Look::steel));
    Joint slider = joint_at(scene, TAUT_JOINT_SLIDER, kWorld, plate, start);
    taut_axis_def motor = free_axis();
    motor.drive.damping = 1e8f;
    motor.drive.speed = 0.5f;
    motor.drive.max_force = static_cast<float>(force);
    slider.axes = {motor};
    scene.add_joint(slider);
    return scene;
}

Scene build_pebbles(double, double mass, const Options& options) {
    constexpr double kRadius = 0.1;
    Scene scene = empty_scene();
    add_ground(scene);
    const int pebble = sphere_shape(scene, kRadius);
    for (int i = 0; i < 16; ++i)
        scene.add_body(crate(pebble, {0.3 * (i % 4) - 0.45, kRadius, 0.3 * (i / 4) - 0.45}, 1, Look::stone));
    scene.add_body(crate(box_shape(scene, 0.6, 0.3, 0.6), {0, 2 * kRadius + 1.3, 0}, mass, Look::steel));
    perturb(scene, options.seed);
    return scene;
}

Scene build_wall(double n, double, const Options& options) {
    constexpr double kHalf[] = {0.125, 0.05, 0.05}, kDensity = 2400;  // [m], [kg/m^3]
    constexpr int kLength = 8;
    Scene scene = empty_scene();
    add_ground(scene);
    Random random(options.seed + 1);
    const int whole = box_shape(scene, 0.98 * kHalf[0], kHalf[1], kHalf[2]);
    const int half = box_shape(scene, 0.49 * kHalf[0], kHalf[1], kHalf[2]);
    for (int course = 0; course < static_cast<int>(n); ++course)
        for (int i = 0; i < kLength + course % 2; ++i) {
            const bool at_end = course % 2 && (i == 0 || i == kLength);
            const double shift = at_end ? (i == 0 ? 0.5 : -0.5) * kHalf[0] : 0;
            const double x = 2 * kHalf[0] * (i - 0.5 * (course % 2)) + shift;
            const double across = 0.1 * (random.uniform() - 0.5) * kHalf[2];
            const double mass = kDensity * 8 * kHalf[0] * kHalf[1] * kHalf[2] * (at_end ? 0.49 : 0.98);
            scene.roles.pile.push_back(scene.add_body(
                crate(at_end ? half : whole, {x, kHalf[1] * (1 + 2 * course), across}, mass, Look::brick)));
        }
    return scene;
}

Scene build_squeeze(double, double too_far, const Options&) {
    constexpr double kHalf = 0.4, kSpeed = 0.5, kRoom = 2;  // [m], [m/s], [m]
    Scene scene = empty_scene();
    add_static_box(scene, {0, kRoom + 0.5, 0}, 4, 0.5, 4, Look::wall);
    Body lift = crate(box_shape(scene, 1.5, 0.15, 1.5), {0, -0.15, 0}, 0, Look::steel);
    lift.kind = TAUT_BODY_KINEMATIC;
    const int driven = scene.add_body(lift);
    const int box = box_shape(scene, 0.5, kHalf, 0.3);
    for (int i = 0; i < 2; ++i) scene.add_body(crate(box, {0.1, (2 * i + 1) * kHalf, 0.05}, 12));
    const double way = kRoom - 4 * kHalf + 1e-3 * too_far, takes = way / kSpeed;
    Motion motion;
    motion.body = driven;
    motion.along = {0, 1, 0};
    motion.track.keys = {{0.5, 0, 0}, {0.5 + 1.5 * takes, way, 0}, {4, way, 0}, {4 + 1.5 * takes, 0, 0}};
    scene.motions.push_back(motion);
    return scene;
}

std::vector<Family> with_loads() {
    std::vector<Family> all = families();
    all.insert(
        all.end(),
        {{"vise_rR", "vise_r1000", "a motor of R N pushes five light boxes against a wall", 240, false, build_vise, 0},
         {"pebbles_rR", "pebbles_r10000", "R kg fall on sixteen pebbles of 1 kg", 240, false, build_pebbles, 0},
         {"wallN", "wall20", "N courses of bricks in running bond", 240, false, build_wall, 60},
         {"squeeze_rR", "squeeze_r20", "a lift drives two boxes R mm too far against a ceiling", 360, false,
          build_squeeze, 0}});
    return all;
}

}  // namespace

const std::vector<Family>& bench_families() {
    static const std::vector<Family> all = with_loads();
    return all;
}

}  // namespace bench
