// Tyres of closed cloth with gas in them: of a car, and of one wheel that is led along under its load.
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr int kCarGroup = -31;

// Tubes of vertices about an axle.
struct Tyre {
    int round, about;           // vertices round the axle, and about the tube
    double ring, tube;          // from the axle to the tube's middle, its radius [m]
    double density, stiffness;  // [kg/m^2], [N/m]
    double pressure;            // over the air's [Pa]
};
constexpr Tyre kCarTyre = {24, 8, 0.215, 0.085, 3, 1e5, 4e4};

// About an axle along z.
Cloth tyre(const Tyre& of, taut_pos axle) {
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    for (int i = 0; i < of.round; ++i)
        for (int k = 0; k < of.about; ++k) {
            const double round = 2 * std::numbers::pi * i / of.round, about = 2 * std::numbers::pi * k / of.about;
            const double out = of.ring + of.tube * std::cos(about);
            cloth.points.push_back(plus(axle, out * std::cos(round), out * std::sin(round), of.tube * std::sin(about)));
            const auto at = [&](int a, int b) {
                return static_cast<uint32_t>((i + a) % of.round * of.about + (k + b) % of.about);
            };
            cloth.triangles.insert(cloth.triangles.end(), {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
        }
    cloth.def.kind = TAUT_CLOTH_TRIANGLES;
    cloth.def.area_density = static_cast<float>(of.density);
    cloth.def.stretch_stiffness[0] = cloth.def.stretch_stiffness[1] = static_cast<float>(of.stiffness);
    cloth.def.shear_stiffness = static_cast<float>(0.3 * of.stiffness);
    cloth.def.damping = 0.005f;
    cloth.def.pressure = static_cast<float>(of.pressure);
    cloth.def.gas = 1;
    cloth.def.material.friction = 1;
    cloth.def.filter.group = kCarGroup;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x30343A;
    return cloth;
}

// Holds a tyre on a hub along the rows of vertices, an odd number, that are nearest to the axle.
void add_tyre(Scene& scene, const Tyre& of, int rows, int hub, taut_pos axle) {
    Cloth cloth = tyre(of, axle);
    const int index = static_cast<int>(scene.cloths.size());
    for (int i = 0; i < of.round; ++i)
        for (int k = of.about / 2 - rows / 2; k <= of.about / 2 + rows / 2; ++k) {
            Joint hold;
            hold.body_a = hub;
            hold.vertex_b.cloth = index;
            hold.vertex_b.vertex = static_cast<uint32_t>(i * of.about + k);
            hold.anchor_a = in_body(scene, hub, cloth.points[hold.vertex_b.vertex]);
            hold.drawn_radius = 0;
            scene.add_joint(hold);
        }
    scene.add_cloth(std::move(cloth));
}

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
    add_tyre(scene, kCarTyre, 3, hub, axle);
}

}  // namespace

Scene build_soft_car(double, double, const Options& options) {
    constexpr double kAxle = kCarTyre.ring + kCarTyre.tube + 0.005, kStart = -2.2, kSpeed = 3.2;  // [m], [m], [rad/s]
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
    scene.camera = {{1.0, 1.7, 4.0}, {-0.1, 0.3, 0}, 44, {chassis}};
    scene.stage = {{-4, 0, -2.5}, {4, 1.5, 2.5}};
    perturb(scene, options.seed);
    return scene;
}

// A wheel on a joint that springs and turns freely, under a load, led over a plank and kerbs.
Scene build_tyre(double, double, const Options& options) {
    constexpr Tyre kTyre = {36, 12, 0.31, 0.12, 6, 3e5, 8e4};
    constexpr double kAxle = kTyre.ring + kTyre.tube + 0.005, kStart = -2.4, kWay = 4.6;  // [m]
    constexpr double kHub = 0.18, kHubHalf = 0.1, kHubMass = 25, kLoad = 180;             // [m], [m], [kg], [kg]
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    // What leads it: a bar across, off which the load slides up and down.
    Body bar = crate(box_shape(scene, 0.05, 0.6, 0.05), {kStart, 1.2, -0.62}, 0, Look::steel);
    bar.kind = TAUT_BODY_KINEMATIC;
    bar.group = kCarGroup;
    Motion lead;
    lead.body = scene.add_body(bar);
    lead.along = {1, 0, 0};
    lead.track.keys = {{1, 0, 0}, {2, 0.5, 1}, {kWay + 1, kWay - 0.5, 1}, {kWay + 2, kWay, 0}};
    scene.motions.push_back(lead);
    Body box = crate(box_shape(scene, 0.4, 0.22, 0.4), {kStart, 1.22, 0}, kLoad);
    box.group = kCarGroup;
    const int load = scene.add_body(box);
    Joint guide = joint_at(scene, TAUT_JOINT_SLIDER, lead.body, load, box.position, {0, 1, 0});
    guide.axes = {free_axis()};
    guide.drawn_radius = 0;
    scene.add_joint(guide);
    Shape cylinder;
    cylinder.kind = ShapeKind::cylinder;
    cylinder.radius = static_cast<float>(kHub);
    cylinder.half_length = static_cast<float>(kHubHalf);
    const taut_pos axle = {kStart, kAxle, 0};
    Body body = crate(scene.add_shape(std::move(cylinder)), axle, kHubMass, Look::wood);
    body.rotation = turn_from_to({0, 1, 0}, {0, 0, 1});
    body.group = kCarGroup;
    const float across = static_cast<float>(kHubMass * (kHub * kHub / 4 + kHubHalf * kHubHalf / 3));
    body.inertia = {across, static_cast<float>(kHubMass * kHub * kHub / 2), across, 0, 0, 0};
    body.parts = {{box_shape(scene, 0.16, 0.13, 0.03)}, {box_shape(scene, 0.03, 0.13, 0.16)}};  // spokes
    const int hub = scene.add_body(body);
    Joint wheel = joint_at(scene, TAUT_JOINT_SIX_DOF, load, hub, axle, {0, 0, 1});
    taut_axis_def locked = free_axis(), spring = locked, turning = locked;
    locked.mode = TAUT_AXIS_LOCKED;
    spring.mode = TAUT_AXIS_LIMITED;
    spring.lower = -0.15f;
    spring.upper = 0.15f;
    spring.drive.stiffness = 3e4f;
    spring.drive.damping = 1500;
    spring.drive.target = -static_cast<float>(kLoad * 9.81 / 3e4);  // what the load presses it by
    wheel.axes = {locked, spring, locked, turning, locked, locked};
    scene.add_joint(wheel);
    add_tyre(scene, kTyre, 5, hub, axle);
    add_static_box(scene, {-0.4, 0.03, 0}, 0.3, 0.03, 0.35, Look::wood);
    for (const double along : {0.8, 1.3}) {
        const int kerb = add_capsule(scene, {along, 0.02, -0.35}, {along, 0.02, 0.35}, 0.045, 0, Look::stone);
        scene.bodies[static_cast<size_t>(kerb)].kind = TAUT_BODY_STATIC;
    }
    scene.roles.load = load;
    scene.forces = ForceScale{1, 4};
    scene.camera = {{0.6, 1.05, 4.4}, {-0.1, 0.75, 0}, 42};
    scene.stage = {{-3, 0, -1.5}, {3, 2, 1.5}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
