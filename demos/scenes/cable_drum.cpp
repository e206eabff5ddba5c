// Three cables over drums: two loads balanced by friction on a fixed one, two carried by a driven one, and a load a
// hundred times as heavy as its cable, which is wound one and a half turns and reeled at its other end.
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

constexpr double kRadius = 0.5, kHalfLength = 0.45, kHeight = 5.5;  // of the drums [m]
constexpr double kDiameter = 0.05;                                  // of the cables [m]
constexpr int kChords = 8;                                          // in half a turn

// Its axis along z.
Body drum(Scene& scene, double x, double friction) {
    Shape shape;
    shape.kind = ShapeKind::cylinder;
    shape.radius = static_cast<float>(kRadius);
    shape.half_length = static_cast<float>(kHalfLength);
    Body body = crate(scene.add_shape(std::move(shape)), {x, kHeight, 0}, 800, Look::steel);
    body.rotation = turn_from_to({0, 1, 0}, {0, 0, 1});
    body.friction = static_cast<float>(friction);
    return body;
}

// A cube that hangs below a point.
int hang(Scene& scene, taut_pos hook, double mass, double side, Look look) {
    return scene.add_body(crate(cube_shape(scene, side), plus(hook, 0, -side / 2, 0), mass, look));
}

// From a point below the left of a drum over its top, round it by half turns, and down on the right. The chords'
// middles touch the drum; the turns lie side by side.
std::vector<taut_pos> path_over(double x, int half_turns, double left_length, double right_length) {
    const double half = std::numbers::pi / kChords / 2, out = (kRadius + kDiameter / 2) / std::cos(half);
    const double chord = 2 * out * std::sin(half), pitch = 0.15, width = pitch * (half_turns - 1);
    const auto straight = [chord](double length) { return static_cast<int>(std::round(length / chord)); };
    const auto at_angle = [&](int i) {
        const double share = static_cast<double>(i) / (half_turns * kChords), a = std::numbers::pi * i / kChords;
        return taut_pos{x - out * std::cos(a), kHeight + out * std::sin(a), width * (share - 0.5)};
    };
    std::vector<taut_pos> path;
    for (int i = straight(left_length); i > 0; --i) path.push_back(plus(at_angle(0), 0, -i * chord, 0));
    for (int i = 0; i <= half_turns * kChords; ++i) path.push_back(at_angle(i));
    const taut_pos last = path.back();
    for (int i = 1; i <= straight(right_length); ++i) path.push_back(plus(last, 0, -i * chord, 0));
    return path;
}

Cable cable_over(Scene& scene, taut_cable_kind kind, const std::vector<taut_pos>& path, int left, int right,
                 double friction) {
    Cable cable = cable_along(scene, kind, path, left, right, kDiameter, 1);
    cable.def.material.friction = static_cast<float>(friction);
    return cable;
}

void balance_on_fixed_drum(Scene& scene, double x) {
    constexpr double kFriction = 0.5;
    Body fixed = drum(scene, x, kFriction);
    fixed.kind = TAUT_BODY_STATIC;
    scene.add_body(fixed);
    const auto path = path_over(x, 1, 3, 2);
    const int light = hang(scene, path.front(), 250, 0.5, Look::wood);
    const int heavy = hang(scene, path.back(), 500, 0.7, Look::crate);
    scene.roles.pile = {heavy};
    scene.add_cable(cable_over(scene, TAUT_CABLE_PARTICLES, path, light, heavy, kFriction));
}

// There and back by an angle.
void carry_on_driven_drum(Scene& scene, double x) {
    constexpr double kFriction = 0.9, kTurn = 2.4;
    const int turning = scene.add_body(drum(scene, x, kFriction));
    Joint axle = joint_at(scene, TAUT_JOINT_HINGE, kWorld, turning, {x, kHeight, 0}, {0, 0, 1});
    axle.axes = {strong_motor()};
    const int joint = scene.add_joint(axle);
    scene.motions.push_back({-1, joint, 0, {}, {{{1, 0, 0}, {6, kTurn, 0}, {8, kTurn, 0}, {13, 0, 0}}, {}}});
    const auto path = path_over(x, 1, 3.2, 2.2);
    const int left = hang(scene, path.front(), 300, 0.5, Look::wood);
    const int right = hang(scene, path.back(), 330, 0.5, Look::crate);
    scene.roles.pile.push_back(right);
    scene.add_cable(cable_over(scene, TAUT_CABLE_LINKS, path, left, right, kFriction));
}

void reel_over_fixed_drum(Scene& scene, double x) {
    constexpr double kFriction = 0.1, kLoad = 1000, kOut = 1.2;
    Body fixed = drum(scene, x, kFriction);
    fixed.kind = TAUT_BODY_STATIC;
    scene.add_body(fixed);
    const auto path = path_over(x, 3, 2.4, 2.2);
    const taut_pos foot = path.front();
    scene.decorations.push_back({{foot.x, foot.y / 2, foot.z}, {0.12f, static_cast<float>(foot.y / 2), 0.12f}});
    const int load = hang(scene, path.back(), kLoad, 0.7, Look::steel);
    Cable cable = cable_over(scene, TAUT_CABLE_PARTICLES, path, kWorld, load, kFriction);
    double length_of_path = 0;
    for (size_t i = 1; i < path.size(); ++i) length_of_path += length(minus(path[i], path[i - 1]));
    cable.def.mass_per_metre = static_cast<float>(0.01 * kLoad / length_of_path);
    scene.roles.load = load;
    const int index = scene.add_cable(cable);
    scene.motions.push_back({-1, -1, 0, {}, {{{1, 0, 0}, {6, kOut, 0}, {8, kOut, 0}, {13, 0, 0}}, {}}, index});
}

}  // namespace

Scene build_cable_drum(double, double, const Options& options) {
    constexpr double kApart = 3;
    Scene scene = empty_scene();
    add_ground(scene);
    balance_on_fixed_drum(scene, -kApart);
    carry_on_driven_drum(scene, 0);
    reel_over_fixed_drum(scene, kApart);
    scene.forces = ForceScale{2, 5};
    perturb(scene, options.seed);
    scene.camera = {{2.2, 4.8, 13.5}, {0, 3.9, 0}, 38};
    scene.stage = {{-5, 0, -3}, {5, 7, 3}};
    return scene;
}

}  // namespace scenes
