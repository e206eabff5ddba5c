// A car on tyres of closed cloth with gas in them.
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr int kCarGroup = -31;
constexpr int kTyreRound = 24, kTyreAbout = 8;
constexpr double kTyreRing = 0.215, kTyreTube = 0.085;  // from the axle to the tube's middle, its radius [m]

// A ring about an axle along z.
Cloth tyre(taut_pos axle) {
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    for (int i = 0; i < kTyreRound; ++i)
        for (int k = 0; k < kTyreAbout; ++k) {
            const double round = 2 * std::numbers::pi * i / kTyreRound, about = 2 * std::numbers::pi * k / kTyreAbout;
            const double out = kTyreRing + kTyreTube * std::cos(about);
            cloth.points.push_back(
                plus(axle, out * std::cos(round), out * std::sin(round), kTyreTube * std::sin(about)));
            const auto at = [&](int a, int b) {
                return static_cast<uint32_t>((i + a) % kTyreRound * kTyreAbout + (k + b) % kTyreAbout);
            };
            cloth.triangles.insert(cloth.triangles.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
        }
    cloth.def.kind = TAUT_CLOTH_TRIANGLES;
    cloth.def.area_density = 3;
    cloth.def.stretch_stiffness[0] = cloth.def.stretch_stiffness[1] = 1e5f;
    cloth.def.shear_stiffness = 3e4f;
    cloth.def.damping = 0.005f;
    cloth.def.pressure = 4e4f;
    cloth.def.gas = 1;
    cloth.def.material.friction = 1;
    cloth.def.filter.group = kCarGroup;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x30343A;
    return cloth;
}

// Its tyre holds on to the hub along the three rows of vertices that are nearest to the axle.
void add_wheel(Scene& scene, int chassis, taut_pos axle, double speed) {
    constexpr double kHub = 0.12, kHubHalf = 0.07;
    Shape cylinder;
    cylinder.kind = ShapeKind::cylinder;
    cylinder.radius = static_cast<float>(kHub);
    cylinder.half_length = static_cast<float>(kHubHalf);
    Body body = crate(scene.add_shape(std::move(cylinder)), axle, 8, Look::steel);
    body.rotation = turn_from_to({0, 1, 0}, {0, 0, 1});
    body.group = kCarGroup;
    const int hub = scene.add_body(body);
    Joint hinge = joint_at(scene, TAUT_JOINT_HINGE, chassis, hub, axle, {0, 0, 1});
    taut_axis_def motor = free_axis();
    motor.drive.damping = 300;
    motor.drive.max_force = 150;
    hinge.axes = {motor};
    const int joint = scene.add_joint(hinge);
    // Off, even, and to a stand.
    scene.motions.push_back(
        {-1,
         joint,
         0,
         {},
         {{{0.5, 0, 0}, {2, -0.75 * speed, -speed}, {5, -3.75 * speed, -speed}, {6, -4.25 * speed, 0}}, {}}});
    Cloth cloth = tyre(axle);
    const int index = static_cast<int>(scene.cloths.size());
    for (int i = 0; i < kTyreRound; ++i)
        for (int k = kTyreAbout / 2 - 1; k <= kTyreAbout / 2 + 1; ++k) {
            Joint hold;
            hold.body_a = hub;
            hold.vertex_b.cloth = index;
            hold.vertex_b.vertex = static_cast<uint32_t>(i * kTyreAbout + k);
            hold.anchor_a = in_body(scene, hub, cloth.points[hold.vertex_b.vertex]);
            hold.drawn_radius = 0;
            scene.add_joint(hold);
        }
    scene.add_cloth(std::move(cloth));
}

}  // namespace

Scene build_soft_car(double, double, const Options& options) {
    constexpr double kAxle = kTyreRing + kTyreTube + 0.005, kStart = -2.2, kSpeed = 3.2;  // [m], [m], [rad/s]
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    Body hull = crate(box_shape(scene, 0.85, 0.12, 0.36), {kStart, kAxle + 0.18, 0}, 120, Look::paint);
    hull.group = kCarGroup;
    const int chassis = scene.add_body(hull);
    Body cabin = crate(box_shape(scene, 0.38, 0.13, 0.3), {kStart - 0.1, kAxle + 0.43, 0}, 25, Look::crate);
    cabin.group = kCarGroup;
    scene.add_joint(joint_at(scene, TAUT_JOINT_FIXED, chassis, scene.add_body(cabin), {kStart - 0.1, kAxle + 0.3, 0}));
    for (const double along : {-0.58, 0.58})
        for (const double side : {-0.5, 0.5}) add_wheel(scene, chassis, {kStart + along, kAxle, side}, kSpeed);
    for (int i = 0; i < 4; ++i)
        add_static_box(scene, {-0.9 + 0.75 * i, 0.035, i % 2 == 0 ? 0.5 : -0.5}, 0.09, 0.035, 0.35, Look::stone);
    scene.roles.load = chassis;
    scene.forces = ForceScale{0, 4};
    scene.camera = {{1.2, 2.1, 5.0}, {0, 0.3, 0}, 42};
    scene.stage = {{-4, 0, -2.5}, {4, 1.5, 2.5}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
