// Robots of URDF files: their kinematics, masses, limits and shapes, and what is refused.
#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "scenes/parts.h"
#include "scenes/taut_world.h"
#include "scenes/urdf_file.h"

namespace {

constexpr const char* kCrooked = R"(<robot name="crooked">
  <link name="base">
    <collision><origin xyz="0 0 0.3"/><geometry><cylinder radius="0.1" length="0.6"/></geometry></collision>
  </link>
  <link name="a">
    <inertial><origin xyz="0.1 0.2 0.3" rpy="0.4 -0.5 0.6"/><mass value="2"/>
      <inertia ixx="0.02" iyy="0.03" izz="0.04" ixy="0.001" ixz="-0.002" iyz="0.003"/></inertial>
    <collision><origin xyz="0.1 0 0" rpy="0 0 0.5"/><geometry><box size="0.2 0.3 0.4"/></geometry></collision>
  </link>
  <link name="b">
    <inertial><origin xyz="-0.05 0 0.1"/><mass value="1.5"/>
      <inertia ixx="0.01" iyy="0.012" izz="0.011" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="tool">
    <inertial><origin xyz="0 0.1 0" rpy="0 0 1"/><mass value="0.5"/>
      <inertia ixx="0.003" iyy="0.001" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="c"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>
  <link name="d"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial></link>
  <joint name="one" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0 0 0.6" rpy="0.1 0.2 0.3"/>
    <axis xyz="0 3 4"/><limit lower="-1" upper="1.2" effort="9000" velocity="1"/></joint>
  <joint name="two" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.3 0.1 0.2" rpy="-0.5 0.4 0.9"/>
    <limit lower="0.3" upper="1.5" effort="9000" velocity="1"/></joint>
  <joint name="weld" type="fixed"><parent link="b"/><child link="tool"/><origin xyz="0.1 -0.2 0.3" rpy="0.3 0.2 -0.7"/>
  </joint>
  <joint name="three" type="prismatic"><parent link="tool"/><child link="c"/><origin xyz="0.2 0 0" rpy="1 0 0.2"/>
    <axis xyz="0 0 1"/><limit lower="-0.1" upper="0.2" effort="9000" velocity="1"/></joint>
  <joint name="four" type="continuous"><parent link="c"/><child link="d"/><origin xyz="0 0.2 0"/>
    <axis xyz="1 2 -2"/></joint>
</robot>
)";

// ---------------------------------------------------------------- kinematics by matrices, from the file's numbers

struct Spot {
    double x = 0, y = 0, z = 0;
};

Spot operator+(Spot a, Spot b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
double apart(Spot a, Spot b) {
    return std::sqrt(std::pow(a.x - b.x, 2) + std::pow(a.y - b.y, 2) + std::pow(a.z - b.z, 2));
}

using Matrix = std::array<double, 9>;  // row by row

Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 3; ++j)
            for (size_t k = 0; k < 3; ++k) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}
Spot operator*(const Matrix& a, Spot p) {
    return {a[0] * p.x + a[1] * p.y + a[2] * p.z, a[3] * p.x + a[4] * p.y + a[5] * p.z,
            a[6] * p.x + a[7] * p.y + a[8] * p.z};
}
Matrix transposed(const Matrix& a) { return {a[0], a[3], a[6], a[1], a[4], a[7], a[2], a[5], a[8]}; }

// By Rodrigues' formula.
Matrix turn_about(Spot axis, double angle) {
    const double size = apart(axis, {}), x = axis.x / size, y = axis.y / size, z = axis.z / size;
    const double c = std::cos(angle), s = std::sin(angle), v = 1 - c;
    return {c + x * x * v,     x * y * v - z * s, x * z * v + y * s, y * x * v + z * s, c + y * y * v,
            y * z * v - x * s, z * x * v - y * s, z * y * v + x * s, c + z * z * v};
}
Matrix roll_pitch_yaw(double r, double p, double y) {
    return turn_about({0, 0, 1}, y) * turn_about({0, 1, 0}, p) * turn_about({1, 0, 0}, r);
}
Matrix matrix_of(taut_quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
            2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
}
double turned_apart(const Matrix& a, const Matrix& b) {  // [rad], small ones
    double sum = 0;
    for (size_t i = 0; i < 9; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / 2);
}

struct Placed {
    Spot position;
    Matrix rotation{1, 0, 0, 0, 1, 0, 0, 0, 1};
};
Placed operator*(const Placed& a, const Placed& b) {
    return {a.position + a.rotation * b.position, a.rotation * b.rotation};
}

// Of each link of the crooked robot.
std::map<std::string, Placed> kinematics(const Placed& base, double one, double two, double three, double four) {
    std::map<std::string, Placed> at;
    at["base"] = base;
    at["a"] = base * Placed{{0, 0, 0.6}, roll_pitch_yaw(0.1, 0.2, 0.3)} * Placed{{}, turn_about({0, 3, 4}, one)};
    at["b"] =
        at["a"] * Placed{{0.3, 0.1, 0.2}, roll_pitch_yaw(-0.5, 0.4, 0.9)} * Placed{{}, turn_about({1, 0, 0}, two)};
    at["tool"] = at["b"] * Placed{{0.1, -0.2, 0.3}, roll_pitch_yaw(0.3, 0.2, -0.7)};
    at["c"] = at["tool"] * Placed{{0.2, 0, 0}, roll_pitch_yaw(1, 0, 0.2)} * Placed{{0, 0, three}};
    at["d"] = at["c"] * Placed{{0, 0.2, 0}} * Placed{{}, turn_about({1, 2, -2}, four)};
    return at;
}

// ---------------------------------------------------------------- a robot in a world

struct Running {
    explicit Running(float hold, bool gravity = false, const std::string& text = kCrooked) {
        place.position = {1, 2, 3};
        const float size = std::sqrt(0.25f + 0.25f + 0.01f + 0.49f);
        place.rotation = {0.5f / size, -0.5f / size, 0.1f / size, 0.7f / size};
        place.hold = hold;
        scene = scenes::empty_scene();
        if (!gravity) scene.world.gravity = {0, 0, 0};
        robot = scenes::add_urdf_text(scene, text, "crooked.urdf", place);
        world.emplace(scene);
    }
    Placed link(const scenes::RobotLink& link) const {
        const taut_pose pose = world->pose(static_cast<size_t>(link.body));
        return Placed{{pose.position.x, pose.position.y, pose.position.z}, matrix_of(pose.rotation)} *
               Placed{{link.position.x, link.position.y, link.position.z}, matrix_of(link.rotation)};
    }
    double coordinate(size_t joint) const {
        float value = 0;
        scenes::check(taut_joint_get_coordinates(handle(joint), 0, &value, nullptr), "reading a joint");
        return static_cast<double>(value);
    }
    taut_joint handle(size_t joint) const { return world->joints[static_cast<size_t>(robot.joints[joint].joint)]; }
    void expect_kinematics(double gap = 5e-5) const {
        const Placed base{{place.position.x, place.position.y, place.position.z}, matrix_of(place.rotation)};
        const auto expected = kinematics(base, coordinate(0), coordinate(1), coordinate(2), coordinate(3));
        ASSERT_EQ(robot.links.size(), expected.size());
        for (const scenes::RobotLink& each : robot.links) {
            const Placed found = link(each), wanted = expected.at(each.name);
            EXPECT_LT(apart(found.position, wanted.position), gap) << each.name;
            EXPECT_LT(turned_apart(found.rotation, wanted.rotation), 1e-4) << each.name;
        }
    }

    scenes::RobotPlace place;
    scenes::Scene scene;
    scenes::Robot robot;
    std::optional<scenes::TautWorld> world;
};

TEST(Urdf, LinksAreWhereTheirJointsPutThem) {
    Running run(5);
    const double begin[] = {0, 0.3, 0, 0}, targets[] = {-0.7, 1.1, 0.15, 2.5};
    ASSERT_EQ(run.robot.joints.size(), 4u);
    EXPECT_EQ(run.scene.bodies.size(), 5u) << "tool and b are one";
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(run.coordinate(i), begin[i], 1e-5) << run.robot.joints[i].name;
    run.expect_kinematics();
    for (size_t i = 0; i < 4; ++i)
        scenes::check(taut_joint_set_target(run.handle(i), 0, static_cast<float>(targets[i]), 0), "a target");
    for (int step = 0; step < 180; ++step) {
        run.world->step();
        if (step % 20 == 0) run.expect_kinematics(3e-4);  // targets that jump jerk the joints
    }
    for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(run.coordinate(i), targets[i], 0.02) << run.robot.joints[i].name;
    run.expect_kinematics();
}

TEST(Urdf, BodiesWeighWhatTheirLinksDo) {
    const Running run(0);
    const scenes::RobotLink &a = run.robot.links[1], &b = run.robot.links[2], &tool = run.robot.links[3];
    EXPECT_EQ(b.body, tool.body);
    float mass = 0;
    taut_vec3 centre{};
    taut_sym3 inertia{};
    const auto read = [&](const scenes::RobotLink& link) {
        scenes::check(taut_body_get_mass(run.world->bodies[static_cast<size_t>(link.body)], &mass, &centre, &inertia),
                      "reading a mass");
    };
    read(a);
    EXPECT_FLOAT_EQ(mass, 2);
    EXPECT_NEAR(centre.x, 0.1, 1e-6);
    EXPECT_NEAR(centre.y, 0.2, 1e-6);
    EXPECT_NEAR(centre.z, 0.3, 1e-6);
    const Matrix axes = roll_pitch_yaw(0.4, -0.5, 0.6);
    const Matrix own = axes * Matrix{0.02, 0.001, -0.002, 0.001, 0.03, 0.003, -0.002, 0.003, 0.04} * transposed(axes);
    EXPECT_NEAR(inertia.xx, own[0], 1e-7);
    EXPECT_NEAR(inertia.yy, own[4], 1e-7);
    EXPECT_NEAR(inertia.zz, own[8], 1e-7);
    EXPECT_NEAR(inertia.xy, own[1], 1e-7);
    EXPECT_NEAR(inertia.xz, own[2], 1e-7);
    EXPECT_NEAR(inertia.yz, own[5], 1e-7);

    // b and its tool: sums of masses, first and second moments about b's origin.
    read(b);
    const Placed at_tool{{0.1, -0.2, 0.3}, roll_pitch_yaw(0.3, 0.2, -0.7)};
    const Matrix tool_axes = at_tool.rotation * roll_pitch_yaw(0, 0, 1);
    const Matrix tool_own = tool_axes * Matrix{0.003, 0, 0, 0, 0.001, 0, 0, 0, 0.002} * transposed(tool_axes);
    const Spot c1 = {-0.05, 0, 0.1}, c2 = at_tool.position + at_tool.rotation * Spot{0, 0.1, 0};
    const Spot c = {(1.5 * c1.x + 0.5 * c2.x) / 2, (1.5 * c1.y + 0.5 * c2.y) / 2, (1.5 * c1.z + 0.5 * c2.z) / 2};
    EXPECT_FLOAT_EQ(mass, 2);
    EXPECT_LT(apart({centre.x, centre.y, centre.z}, c), 1e-6);
    const auto about_y_and_z = [](double m, Spot p) { return m * (p.y * p.y + p.z * p.z); };
    EXPECT_NEAR(inertia.xx, 0.01 + tool_own[0] + about_y_and_z(1.5, c1) + about_y_and_z(0.5, c2) - about_y_and_z(2, c),
                1e-6);
    EXPECT_NEAR(inertia.xy, tool_own[1] - 1.5 * c1.x * c1.y - 0.5 * c2.x * c2.y + 2 * c.x * c.y, 1e-6);
}

TEST(Urdf, JointsStopAtTheirLimits) {
    Running run(0);
    const double ends[2][3] = {{-1, 0.3, -0.1}, {1.2, 1.5, 0.2}};
    for (int side = 0; side < 2; ++side) {
        for (size_t i = 0; i < 3; ++i) {
            taut_axis_def axis;
            scenes::check(taut_joint_get_axis(run.handle(i), 0, &axis), "reading an axis");
            EXPECT_EQ(axis.mode, TAUT_AXIS_LIMITED);
            axis.drive.damping = 20;
            axis.drive.speed = side == 0 ? -2.0f : 2.0f;
            scenes::check(taut_joint_set_axis(run.handle(i), 0, &axis), "driving an axis");
        }
        for (int step = 0; step < 300; ++step) run.world->step();
        for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(run.coordinate(i), ends[side][i], 0.01) << run.robot.joints[i].name;
        run.expect_kinematics();
    }
}

TEST(Urdf, DrivesHoldTheRobotUp) {
    Running held(20, true), limp(0, true);
    const double begin[] = {0, 0.3, 0, 0};
    double sunk = 0;
    for (int step = 0; step < 180; ++step) {
        held.world->step();
        limp.world->step();
    }
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(held.coordinate(i), begin[i], 0.05);
        sunk = std::max(sunk, std::fabs(limp.coordinate(i) - begin[i]));
    }
    EXPECT_GT(sunk, 0.3) << "without them it falls until a joint stops it";
}

// ---------------------------------------------------------------- shapes

bool holds(taut_world world, Spot p) {
    taut_collider found[8];
    uint32_t count = 0;
    scenes::check(taut_world_overlap_point(world, {p.x, p.y, p.z}, nullptr, found, 8, &count), "asking for a point");
    return count > 0;
}

TEST(Urdf, ShapesLieAsTheFileSays) {
    Running run(0);
    const Placed base{{1, 2, 3}, matrix_of(run.place.rotation)};
    const auto inside = [&](const Placed& frame, Spot p) {
        return holds(run.world->world, (frame * Placed{p}).position);
    };
    // The foot along z, from 0 to 0.6.
    for (const double z : {0.02, 0.3, 0.58}) EXPECT_TRUE(inside(base, {0.08, 0, z})) << z;
    EXPECT_FALSE(inside(base, {0.12, 0, 0.3}));
    EXPECT_FALSE(inside(base, {0.08, 0, -0.02}));
    // The box of a, turned about its z.
    const Placed box = run.link(run.robot.links[1]) * Placed{{0.1, 0, 0}, roll_pitch_yaw(0, 0, 0.5)};
    for (const double s : {-0.95, 0.95}) EXPECT_TRUE(inside(box, {s * 0.1, s * 0.15, s * 0.2}));
    EXPECT_FALSE(inside(box, {0, 0, 0.22}));
    EXPECT_FALSE(inside(box, {0.11, 0, 0.19}));
}

class Folder {
public:
    ~Folder() { std::filesystem::remove_all(path); }
    std::string put(const std::string& name, const std::string& text) const {
        const std::filesystem::path file = path / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << text;
        return file.string();
    }
    const std::filesystem::path path = testing::TempDir() + "taut_urdf_" + std::to_string(getpid());
};

TEST(Urdf, MeshesAreHullsOfTheirPiecesAtTheirScale) {
    const Folder folder;
    folder.put("bot/meshes/two.obj",
               "o low\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
               "o high\nv 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 6\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n");
    for (const char* named : {"package://bot/meshes/two.obj", "../meshes/two.obj"}) {
        const std::string file =
            folder.put("bot/urdf/two.urdf",
                       std::string("<robot name='two'><link name='only'><collision><geometry><mesh filename='") +
                           named + "' scale='0.5 1 2'/></geometry></collision></link></robot>");
        scenes::Scene scene = scenes::empty_scene();
        const scenes::Robot robot = scenes::add_urdf(scene, file, {});
        ASSERT_EQ(scene.bodies.size(), 1u);
        EXPECT_EQ(scene.bodies[0].parts.size(), 2u);
        EXPECT_EQ(scene.bodies[0].kind, TAUT_BODY_STATIC) << "a root without mass stands";
        const scenes::TautWorld world(scene);
        EXPECT_TRUE(holds(world.world, {0.4, 0.02, 0.05}));
        EXPECT_FALSE(holds(world.world, {0.6, 0.02, 0.05})) << "x is half as long";
        EXPECT_TRUE(holds(world.world, {0.02, 0.02, 1.8}));
        EXPECT_FALSE(holds(world.world, {0.1, 0.1, 5})) << "between the pieces";
        EXPECT_TRUE(holds(world.world, {0.1, 0.1, 10.5}));
    }
}

// ---------------------------------------------------------------- what is refused

struct BadRobot {
    const char* name;
    const char* part;   // of the crooked robot, or null: other is all of the file
    const char* other;  // in its place
    const char* says;
};

class BadUrdf : public testing::TestWithParam<BadRobot> {};
INSTANTIATE_TEST_SUITE_P(
    File, BadUrdf,
    testing::Values(
        BadRobot{"Empty", nullptr, "", ":1: the file is empty"},
        BadRobot{"NoXml", nullptr, "hello", ":1: not well-formed XML"},
        BadRobot{"CutShort", "</robot>", "", ": not well-formed XML"},
        BadRobot{"AnotherRoot", nullptr, "\n<model name='x'/>", ":2: a <robot> was expected, not <model>"},
        BadRobot{"NoLinks", nullptr, "<robot name='x'>\n</robot>", ":1: there are no links"},
        BadRobot{"TwiceTheSameLink", "<link name=\"tool\">", "<link name=\"b\">", ":14: a second link 'b'"},
        BadRobot{"NoMass", "<mass value=\"2\"/>", "", ":6: <inertial> has no <mass>"},
        BadRobot{"MassNoNumber", "<mass value=\"2\"/>", "<mass value=\"2kg\"/>",
                 ":6: value is no number within 1e6: '2kg'"},
        BadRobot{"MassNaN", "<mass value=\"2\"/>", "<mass value=\"nan\"/>", ":6: value is no number"},
        BadRobot{"MassBelowZero", "<mass value=\"2\"/>", "<mass value=\"-2\"/>", ":6: the mass of 'a' is below 0"},
        BadRobot{"Inertia", "ixx=\"0.02\"", "ixx=\"-0.02\"", ":7: the inertia of 'a' is not positive definite"},
        BadRobot{"TwoNumbers", "xyz=\"0 0 0.6\"", "xyz=\"0 0.6\"", ":20: xyz needs 3 numbers: '0 0.6'"},
        BadRobot{"NoRadius", "radius=\"0.1\" ", "", ":3: <cylinder> has no radius"},
        BadRobot{"RadiusZero", "radius=\"0.1\"", "radius=\"0\"", ":3: radius must be above 0"},
        BadRobot{"Geometry", "<box size=\"0.2 0.3 0.4\"/>", "<torus/>", ":8: <torus> is none of box"},
        BadRobot{"NoGeometry", "<box size=\"0.2 0.3 0.4\"/>", "", ":8: <geometry> is empty"},
        BadRobot{"NoMesh", "<box size=\"0.2 0.3 0.4\"/>", "<mesh filename=\"package://x/y.obj\"/>",
                 ":8: the mesh 'x/y.obj' is not there"},
        BadRobot{"Type", "type=\"prismatic\"", "type=\"screw\"", ":26: there are no joints of type 'screw'"},
        BadRobot{"UnknownLink", "<child link=\"c\"/>", "<child link=\"e\"/>", ":26: there is no link 'e'"},
        BadRobot{"NoParent", "<parent link=\"tool\"/>", "", ":26: <joint> has no <parent>"},
        BadRobot{"NoLimit", "<limit lower=\"-0.1\" upper=\"0.2\" effort=\"9000\" velocity=\"1\"/>", "",
                 ":26: <joint> has no <limit>"},
        BadRobot{"LimitsCross", "lower=\"-0.1\"", "lower=\"0.4\"", ":27: lower is above upper"},
        BadRobot{"NoAxis", "<axis xyz=\"1 2 -2\"/>", "<axis xyz=\"0 0 0\"/>",
                 ":29: the axis of 'four' has no direction"},
        BadRobot{"Mimic", "<axis xyz=\"1 2 -2\"/>", "<mimic joint=\"one\"/>", ":29: <mimic> is not supported"},
        BadRobot{"TwoParents", "<child link=\"d\"/>", "<child link=\"c\"/>",
                 ":28: the link 'c' is the child of two joints"},
        BadRobot{"Loop", "<parent link=\"c\"/><child link=\"d\"/>", "<parent link=\"c\"/><child link=\"base\"/>",
                 ":2: 'base' is in a loop of joints"},
        BadRobot{"TwoRoots",
                 "<joint name=\"four\" type=\"continuous\"><parent link=\"c\"/><child link=\"d\"/>"
                 "<origin xyz=\"0 0.2 0\"/>\n    <axis xyz=\"1 2 -2\"/></joint>",
                 "", ":19: 'd' and 'base' are both no one's child"},
        BadRobot{"NoMassThatMoves", "<link name=\"c\"><inertial><mass value=\"1\"/>",
                 "<link name=\"c\"><inertial><mass value=\"0\"/>", ":18: 'c' moves and has no mass"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST_P(BadUrdf, IsRefusedWithFileAndLine) {
    const Folder folder;
    std::string text = GetParam().other;
    if (GetParam().part) {
        text = kCrooked;
        const size_t found = text.find(GetParam().part);
        ASSERT_NE(found, std::string::npos);
        text.replace(found, std::string(GetParam().part).size(), GetParam().other);
    }
    const std::string path = folder.put("bad.urdf", text);
    scenes::Scene scene = scenes::empty_scene();
    try {
        scenes::add_urdf(scene, path, {});
        FAIL() << "accepted";
    } catch (const scenes::BadFile& error) {
        EXPECT_THAT(error.what(), testing::StartsWith(path));
        EXPECT_THAT(error.what(), testing::HasSubstr(GetParam().says));
    }
}

}  // namespace
