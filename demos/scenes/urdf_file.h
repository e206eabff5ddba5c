// Robots from URDF files: links, their masses and collision geometry, and joints with limits.
//
// Links that fixed joints tie are one body, whose frame is that of the uppermost of them, with the mass, centre and
// inertia of all. Bodies of a robot do not collide with each other. Visual geometry, materials and what other programs
// keep in the file (transmission, gazebo) are left out; limits of velocity have no counterpart here.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace scenes {

struct RobotPlace {
    taut_pos position{};             // of the root link [m]
    taut_quat rotation{0, 0, 0, 1};  // from the robot's axes, of which z is up, to the scene's
    bool fixed_base = false;         // the root stands still; a root without mass always does
    float hold = 0;                  // above 0: joints keep their place by drives of so many hertz, with at most
                                     // the effort of their limits
    Look look = Look::steel;
};

struct RobotLink {
    std::string name;
    int body = -1;                   // of the scene
    taut_pos position{};             // of the link's frame in its body's [m]
    taut_quat rotation{0, 0, 0, 1};  // likewise
};

struct RobotJoint {
    std::string name;
    int joint = -1;                                   // of the scene; none of floating ones
    int parent = -1, child = -1;                      // links
    double lower = 0, upper = 0, effort = 0, at = 0;  // of the file, and where it begins [rad or m, N m or N]
    bool is_limited = false;
};

struct Robot {
    std::string name;
    std::vector<RobotLink> links;
    std::vector<RobotJoint> joints;  // but for fixed ones
};

// Adds a robot, every joint at 0 or the nearest value that its limits allow. Throws BadFile naming file and line.
Robot add_urdf(Scene& scene, const std::string& path, const RobotPlace& place);
// Of a text; path is what complaints name, and where meshes are looked for.
Robot add_urdf_text(Scene& scene, const std::string& text, const std::string& path, const RobotPlace& place);

}  // namespace scenes
