// A scene as plain data: built once, used by the demo, the tests and the benchmark, in any engine.
// TautWorld (taut_world.h) brings it to life through Taut's C API; taut-bench can do so in Bullet as well.
#pragma once

#include <taut/taut.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace scenes {

constexpr int kWorld = -1;  // in place of a body's index

enum class ShapeKind : uint8_t {
    plane,
    box,
    sphere,
    capsule,
    hull,
    cylinder,
    cone,
    tapered_capsule,
    scaled_hull,
    mesh,
    height_field
};

struct Shape {
    ShapeKind kind = ShapeKind::box;
    taut_vec3 half_extents{};       // box [m]
    taut_vec3 normal{0, 1, 0};      // plane
    float radius = 0;               // sphere, capsule, cylinder, base of a cone, bottom of a tapered capsule [m]
    float top_radius = 0;           // tapered capsule [m]
    float half_length = 0;          // capsule, cylinder, cone, tapered capsule, along y [m]
    std::vector<taut_vec3> points;  // hull, mesh [m]
    int hull = -1;                  // scaled hull: index of the hull among the scene's shapes
    taut_vec3 scale{1, 1, 1};       // scaled hull
    std::vector<uint32_t> indices;  // mesh, three a triangle
    bool sampled = false;           // its distances are: taut_shape_sample_distance
    uint32_t rows = 0;              // height field
    float spacing = 1;              // between its samples, either way [m]
    std::vector<float> heights;     // row by row [m]
    std::string source;             // where it came from, for messages ("cow.obj:12: group 'horn'")
};

// How a body looks; physics doesn't read it.
enum class Look : uint8_t {
    hidden,
    crate,
    brick,
    steel,
    link,
    particle,
    stone,
    wall,
    ground,
    wood,
    paint,
    skin,
    cloth,
    sand
};

// A shape on a body, beside its own.
struct Part {
    int shape = -1;
    taut_vec3 position{};  // in the body's frame [m]
    taut_quat rotation{0, 0, 0, 1};
};

struct Body {
    taut_body_kind kind = TAUT_BODY_DYNAMIC;
    int shape = -1;  // index into Scene::shapes; none for particles
    taut_pos position{};
    taut_quat rotation{0, 0, 0, 1};
    taut_vec3 linear_velocity{}, angular_velocity{};
    float mass = 0;              // [kg], 0: from density
    float density = 1000;        // [kg/m^3]
    taut_sym3 inertia{};         // all zero: from the shape [kg m^2]
    taut_vec3 centre_of_mass{};  // where inertia is given: that is about it [m]
    float friction = 0.5f;
    int32_t group = 0;  // bodies of the same negative group don't collide
    Look look = Look::crate;
    bool grain = false;         // of particles: TAUT_COLLIDER_GRAIN
    std::vector<Part> parts{};  // of a body that has mass and inertia of its own
    int drawn = -1;             // shape that is drawn in place of its own and of its parts
};

// A vertex of a cloth or of a solid, or a point of a cable of particles, which a joint ends at in place of a body; of
// cables only the first two.
struct SoftVertex {
    int cloth = -1, solid = -1;  // index of one of these; none: the end is the body
    uint32_t vertex = 0;
    int cable = -1;
};

struct Joint {
    taut_joint_kind kind = TAUT_JOINT_BALL;
    int body_a = kWorld, body_b = kWorld;
    SoftVertex vertex_a, vertex_b;
    taut_pos anchor_a{}, anchor_b{};                           // in each body's frame, in the world for kWorld
    taut_quat rotation_a{0, 0, 0, 1}, rotation_b{0, 0, 0, 1};  // from the joint's axes; not of ball and distance joints
    int housing = kWorld;                                      // of gears, racks and pulleys, as the next
    taut_frame housing_a{{}, {0, 0, 0, 1}}, housing_b{{}, {0, 0, 0, 1}};
    float ratio = 1;
    std::vector<taut_axis_def> axes;          // as taut_joint_set_axis counts them; the rest keep their defaults
    float length = 0;                         // of a rod [m]
    float max_length = 0;                     // above 0: a rope instead [m]
    float compliance = 0;                     // of positions, a rod or a rope [m/N]
    float angular_compliance = 0;             // of locked angles [rad/(N m)]
    float damping = 0;                        // of positions, a rod or a rope [N s/m]
    float break_force = 0, break_torque = 0;  // 0: never [N, N m]
    taut_joint_solve solve = TAUT_JOINT_SOLVE_BY_LOAD;
    double until = 0;                      // taken away at that time [s]; 0: never
    std::optional<double> drawn_radius{};  // of the line or ball that it is drawn as, 0: it is not [m]
};

// A cable of the library's own. The ends' bodies and the path are put into the def by TautWorld.
struct Cable {
    taut_cable_def def{};                // initialised
    int end_body[2] = {kWorld, kWorld};  // of attached ends
    SoftVertex end_vertex[2];
    std::vector<taut_pos> path;  // def.points [m]
};

// What the colours of its surface tell.
enum class SoftColours : uint8_t { plain, strain, stress };

struct SoftLook {
    SoftColours colours = SoftColours::plain;
    double most = 0.05;  // at the top of the colours' scale: stretch - 1 of a cloth, stress of a solid [Pa]
    uint32_t paint = 0;  // sRGB of a plain one; 0: its kind's
    std::string label;   // beside that colour in the picture; none: no label
};

// A surface that is drawn in place of a solid's own; each point moves with four of its vertices.
struct Skin {
    std::vector<uint32_t> triangles;
    std::vector<uint32_t> corners;  // four a point
    std::vector<float> weights;     // of them, in sum 1
};

// A cloth or solid of the library's own. TautWorld puts the arrays into the def.
struct Cloth {
    taut_cloth_def def{};  // initialised
    std::vector<taut_pos> points;
    std::vector<taut_pos> rest;  // or none: points
    std::vector<uint32_t> triangles;
    std::vector<uint32_t> quads;        // in their place, of quadrilaterals
    std::vector<float> uv;              // two a point, or none
    std::vector<uint32_t> pinned;       // vertices
    std::vector<taut_vec3> velocities;  // one a point, or none
    std::string source;                 // where it came from, for messages
    SoftLook look;
};
struct Solid {
    taut_solid_def def{};  // initialised
    std::vector<taut_pos> points;
    std::vector<taut_pos> rest;  // or none: points
    std::vector<uint32_t> cells;
    std::vector<uint32_t> triangles;  // of the boundary, without a mesh
    std::vector<uint32_t> pinned;
    std::vector<taut_vec3> velocities;
    Skin skin;           // none: its own boundary
    std::string source;  // where it came from, for messages
    SoftLook look;
};

// A number over time: cubic between its keys, on at the last one's rate after it.
struct Track {
    struct Key {
        double time = 0, value = 0, rate = 0;  // [s], [unit], [unit/s]
    };
    struct Shake {  // amplitude sin(2 pi frequency (t - begin)) on top, swelling and fading for a period each
        double amplitude = 0, frequency = 1, begin = 0, end = 0;  // [unit], [Hz], [s], [s]
    };
    std::vector<Key> keys;
    Shake shake;
};

// What moves by plan: a kinematic body or pinned vertices of a cloth or solid, by the track along a direction from the
// start and about a pivot; the drive of a joint, whose target and speed follow the track; or a cable's end that is
// reeled: what is paid out [m] follows it. A body's motions are made one after another, each of what those before it
// say.
struct Motion {
    int body = -1, joint = -1;
    uint32_t axis = 0;  // of the joint; the cable's end
    taut_vec3 along{};  // of the body or vertices, [m] a unit of the track
    Track track;
    int cable = -1;
    int cloth = -1, solid = -1;
    std::vector<uint32_t> vertices{};
    taut_vec3 about{};  // of the body or vertices, [rad] a unit of the track
    taut_pos pivot{};
};

// A chain or cable, from its held end to its weight.
struct Chain {
    std::vector<int> joints, bodies;  // in order; the last body is the weight
    std::vector<double> hang_depth;   // depth of each body's centre below the anchor when all hangs straight [m]
    taut_pos anchor{};
    double link_length = 0;  // [m]
    double length = 0;       // from the anchor to the weight's centre, straight [m]
};

struct Bounds {
    taut_pos low{}, high{};
};

// What the figures of taut-bench and the tests are taken from.
struct Roles {
    std::vector<int> pile;  // bodies whose overlap and rest are measured
    int top_body = -1;      // of a stack
    std::optional<Chain> chain;
    std::optional<Bounds> bin;  // centres outside count as escaped
    bool swings = false;        // the chain swings freely: measure its period
    int load = -1;              // what is lifted, driven or shaken
    double mesh_width = 0;      // of a net, which all joints belong to [m]
    std::vector<uint32_t> tip;  // of a beam, the first solid: vertices of its end
    double tip_sink = 0;        // what theory says of it [m]
};

// The joint forces that colours tell apart, in powers of ten [N].
struct ForceScale {
    int low = 0, high = 5;
};

struct Camera {
    taut_pos eye{}, target{};
    float vertical_fov_deg = 38;
    std::vector<int> follow{};  // bodies that stay in the frame, from the direction in which the eye is; none: it stays
};

// A box that is drawn and touches nothing.
struct Decoration {
    taut_pos position{};
    taut_vec3 half_extents{};
};

// A line that is drawn and touches nothing.
struct Curve {
    std::vector<taut_pos> points;
    double radius = 0.004;  // [m]
};

struct Scene {
    std::string name, description;
    uint32_t steps = 600;
    taut_world_def world{};  // initialised; hooks are left to the user
    std::vector<Shape> shapes;
    std::vector<Body> bodies;
    std::vector<Joint> joints;
    std::vector<Cable> cables;
    std::vector<Cloth> cloths;
    std::vector<Solid> solids;
    std::vector<Motion> motions;
    std::vector<Decoration> decorations;
    std::vector<Curve> curves;
    Roles roles;
    std::optional<ForceScale> forces;  // else from the chain's weights
    Camera camera;
    Bounds stage{{-8, 0, -8}, {8, 8, 8}};  // where shadows fall

    int add_shape(Shape shape) {
        shapes.push_back(std::move(shape));
        return static_cast<int>(shapes.size()) - 1;
    }
    int add_body(const Body& body) {
        bodies.push_back(body);
        return static_cast<int>(bodies.size()) - 1;
    }
    int add_joint(const Joint& joint) {
        joints.push_back(joint);
        return static_cast<int>(joints.size()) - 1;
    }
    int add_cable(const Cable& cable) {
        cables.push_back(cable);
        return static_cast<int>(cables.size()) - 1;
    }
    int add_cloth(Cloth cloth) {
        cloths.push_back(std::move(cloth));
        return static_cast<int>(cloths.size()) - 1;
    }
    int add_solid(Solid solid) {
        solids.push_back(std::move(solid));
        return static_cast<int>(solids.size()) - 1;
    }
};

// A name or parameter that no scene has; what() says what was expected.
class BadScene : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

// A file that cannot be used; what() names file and line.
class BadFile : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace scenes
