// A robot that moves all its joints within their limits: an arm, or that of a URDF file.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "urdf_file.h"

namespace scenes {

namespace {

constexpr float kHoldHertz = 15;                             // of the joints' drives [Hz]
constexpr double kSwingTurn = 0.6, kSwingShare = 0.35;       // of a joint's swing to a side [rad], and of its range
constexpr double kSlowestSwing = 0.2, kSwingStagger = 0.07;  // frequencies of the swings [Hz]

// Six axes and a gripper of two fingers, 27 kg, on a foot that stands still.
constexpr const char* kArmUrdf = R"(<?xml version="1.0"?>
<robot name="arm">
  <link name="foot">
    <collision><origin xyz="0 0 0.1"/><geometry><cylinder radius="0.15" length="0.2"/></geometry></collision>
  </link>
  <link name="turret">
    <inertial><origin xyz="0 0 0.1"/><mass value="8"/>
      <inertia ixx="0.06" iyy="0.06" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.2 0.2"/></geometry></collision>
  </link>
  <link name="upper_arm">
    <inertial><origin xyz="0 0 0.25"/><mass value="9"/>
      <inertia ixx="0.2" iyy="0.2" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0.25"/><geometry><capsule radius="0.06" length="0.42"/></geometry></collision>
  </link>
  <link name="forearm">
    <inertial><origin xyz="0.2 0 0"/><mass value="5"/>
      <inertia ixx="0.01" iyy="0.08" izz="0.08" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.2 0 0" rpy="0 1.5707963 0"/><geometry><cylinder radius="0.05" length="0.4"/></geometry></collision>
  </link>
  <link name="wrist">
    <inertial><mass value="2"/><inertia ixx="0.004" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.06"/></geometry></collision>
  </link>
  <link name="hand">
    <inertial><origin xyz="0.05 0 0"/><mass value="2"/>
      <inertia ixx="0.004" iyy="0.003" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="palm">
    <collision><origin xyz="0.02 0 0"/><geometry><box size="0.04 0.16 0.08"/></geometry></collision>
  </link>
  <link name="left_finger">
    <inertial><origin xyz="0.05 0 0"/><mass value="0.5"/>
      <inertia ixx="0.0002" iyy="0.0006" izz="0.0006" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.04"/></geometry></collision>
  </link>
  <link name="right_finger">
    <inertial><origin xyz="0.05 0 0"/><mass value="0.5"/>
      <inertia ixx="0.0002" iyy="0.0006" izz="0.0006" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.05 0 0"/><geometry><box size="0.1 0.02 0.04"/></geometry></collision>
  </link>
  <joint name="turn" type="continuous"><parent link="foot"/><child link="turret"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>
  <joint name="shoulder" type="revolute"><parent link="turret"/><child link="upper_arm"/>
    <origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><limit lower="-1" upper="1.5" effort="400" velocity="2"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper_arm"/><child link="forearm"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="1.5" effort="200" velocity="2"/></joint>
  <joint name="roll" type="revolute"><parent link="forearm"/><child link="wrist"/>
    <origin xyz="0.46 0 0"/><axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="50" velocity="3"/></joint>
  <joint name="nod" type="revolute"><parent link="wrist"/><child link="hand"/>
    <axis xyz="0 1 0"/><limit lower="-1.6" upper="1.6" effort="50" velocity="3"/></joint>
  <joint name="flange" type="fixed"><parent link="hand"/><child link="palm"/><origin xyz="0.08 0 0"/></joint>
  <joint name="left" type="prismatic"><parent link="palm"/><child link="left_finger"/>
    <origin xyz="0.04 0.02 0"/><axis xyz="0 1 0"/><limit lower="0" upper="0.05" effort="60" velocity="0.2"/></joint>
  <joint name="right" type="prismatic"><parent link="palm"/><child link="right_finger"/>
    <origin xyz="0.04 -0.02 0"/><axis xyz="0 -1 0"/><limit lower="0" upper="0.05" effort="60" velocity="0.2"/></joint>
</robot>
)";

// The lowest point of a part, in the scene.
double lowest_of_part(const Scene& scene, const Body& body, const Part& part) {
    const Shape& shape = scene.shapes[static_cast<size_t>(part.shape)];
    const taut_quat turned = times(body.rotation, part.rotation);
    const taut_pos offset = rotated(body.rotation, {part.position.x, part.position.y, part.position.z});
    const taut_pos centre = plus(body.position, offset.x, offset.y, offset.z);
    const double r = shape.radius, h = shape.half_length;
    const double along = std::fabs(rotated(turned, {0, 1, 0}).y);
    switch (shape.kind) {
        case ShapeKind::sphere:
            return centre.y - r;
        case ShapeKind::capsule:
            return centre.y - h * along - r;
        case ShapeKind::cylinder:
            return centre.y - h * along - r * std::sqrt(std::max(0.0, 1 - along * along));
        case ShapeKind::box: {
            const taut_vec3& e = shape.half_extents;
            return centre.y - std::fabs(rotated(turned, {e.x, 0, 0}).y) - std::fabs(rotated(turned, {0, e.y, 0}).y) -
                   std::fabs(rotated(turned, {0, 0, e.z}).y);
        }
        default: {
            double least = centre.y;
            for (const taut_vec3& p : shape.points)
                least = std::min(least, centre.y + rotated(turned, {p.x, p.y, p.z}).y);
            return least;
        }
    }
}

void swing_joints(Scene& scene, const Robot& robot) {
    double frequency = kSlowestSwing;
    for (const RobotJoint& joint : robot.joints) {
        if (joint.joint < 0 || scene.joints[static_cast<size_t>(joint.joint)].kind == TAUT_JOINT_SIX_DOF) continue;
        const double range = joint.is_limited ? joint.upper - joint.lower : 2 * std::numbers::pi;
        // About where it begins, or the middle of its range where a stop is near.
        const double low = joint.lower, high = joint.upper;
        const bool near_stop = joint.is_limited && std::min(joint.at - low, high - joint.at) < kSwingShare * range;
        const double about = near_stop ? (low + high) / 2 : joint.at;
        Motion motion;
        motion.joint = joint.joint;
        motion.track.keys = {{0, joint.at, 0}, {1, about, 0}};
        motion.track.shake = {std::min(kSwingTurn, kSwingShare * range), frequency, 1, 1e6};
        frequency += kSwingStagger;
        scene.motions.push_back(motion);
    }
}

}  // namespace

Scene build_robot(double, double, const Options& options) {
    Scene scene = empty_scene();
    add_ground(scene);
    RobotPlace place;
    place.hold = kHoldHertz;
    const auto half = static_cast<float>(std::numbers::sqrt2 / 2);
    place.rotation = {-half, 0, 0, half};  // z, which is up there, to y
    const size_t first = scene.bodies.size();
    const Robot robot = options.mesh.empty() ? add_urdf_text(scene, kArmUrdf, "the arm made here", place)
                                             : add_urdf(scene, options.mesh, place);
    double least = 0, reach = 0.5;
    bool any = false;
    for (size_t i = first; i < scene.bodies.size(); ++i)
        for (const Part& part : scene.bodies[i].parts) {
            const double here = lowest_of_part(scene, scene.bodies[i], part);
            least = any ? std::min(least, here) : here;
            any = true;
        }
    for (size_t i = first; i < scene.bodies.size(); ++i) {
        Body& body = scene.bodies[i];
        body.position.y -= least;
        reach = std::max(reach, length(body.position));
    }
    swing_joints(scene, robot);
    perturb(scene, options.seed);
    scene.camera = {{1.6 * reach, 1.3 * reach, 2.2 * reach}, {0, 0.5 * reach, 0}, 38};
    scene.stage = {{-2 * reach, 0, -2 * reach}, {2 * reach, 2 * reach, 2 * reach}};
    return scene;
}

}  // namespace scenes
