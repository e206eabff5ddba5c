#include "urdf_file.h"

#include <tinyxml2.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "obj_file.h"
#include "pose.h"
#include "text_file.h"

namespace scenes {

namespace {

using Eigen::Isometry3d, Eigen::Matrix3d, Eigen::Quaterniond, Eigen::Vector3d;
using tinyxml2::XMLElement;

struct UrdfShape {
    Shape shape;
    Isometry3d link_from_shape;
    int line = 0;
};

struct UrdfLink {
    std::string name;
    int line = 0;
    double mass = 0;
    Vector3d centre = Vector3d::Zero();   // in the link's frame
    Matrix3d inertia = Matrix3d::Zero();  // about the centre, in the link's axes
    std::vector<UrdfShape> shapes;
    int joint = -1;  // that it is the child of
};

enum class UrdfKind { revolute, continuous, prismatic, fixed, floating, planar };

struct UrdfJoint {
    std::string name;
    int line = 0;
    UrdfKind kind = UrdfKind::fixed;
    size_t parent = 0, child = 0;
    Isometry3d parent_from_joint;
    Vector3d axis = Vector3d::UnitX();  // in the joint's frame
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
    double effort = 0, damping = 0, friction = 0;
};

// The file as it stands; every complaint names its line.
class UrdfReader {
public:
    UrdfReader(const std::string& text, const std::string& path) : path_(path) {
        if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
            refuse_file(path, std::max(1, document_.ErrorLineNum()),
                        std::string("not well-formed XML: ") + document_.ErrorName());
        const XMLElement* robot = document_.RootElement();
        if (!robot) refuse_file(path, 1, "not well-formed XML: there is no element");
        if (std::string(robot->Name()) != "robot")
            refuse(robot, "a <robot> was expected, not <" + std::string(robot->Name()) + ">");
        name = attribute(robot, "name");
        for (const XMLElement* each = robot->FirstChildElement("link"); each; each = each->NextSiblingElement("link"))
            read_link(each);
        for (const XMLElement* each = robot->FirstChildElement("joint"); each; each = each->NextSiblingElement("joint"))
            read_joint(each);
        if (links.empty()) refuse(robot, "there are no links");
        find_root(robot);
    }

    std::string name;
    std::vector<UrdfLink> links;
    std::vector<UrdfJoint> joints;
    size_t root = 0;

private:
    [[noreturn]] void refuse(const XMLElement* at, const std::string& why) const {
        refuse_file(path_, at->GetLineNum(), why);
    }

    static std::string tag(const XMLElement* at) { return "<" + std::string(at->Name()) + ">"; }

    std::string attribute(const XMLElement* at, const char* which) const {
        const char* text = at->Attribute(which);
        if (!text || *text == '\0') refuse(at, tag(at) + " has no " + which);
        return text;
    }

    const XMLElement* child(const XMLElement* at, const char* which) const {
        const XMLElement* found = at->FirstChildElement(which);
        if (!found) refuse(at, tag(at) + " has no <" + which + ">");
        if (found->NextSiblingElement(which))
            refuse(found->NextSiblingElement(which), "a second <" + std::string(which) + "> in one " + tag(at));
        return found;
    }

    std::vector<double> numbers(const XMLElement* at, const char* which, size_t count) const {
        constexpr double kMost = 1e6;
        const std::string text = attribute(at, which);
        std::istringstream words(text);
        std::vector<double> values;
        for (std::string word; words >> word;) {
            char* end = nullptr;
            values.push_back(std::strtod(word.c_str(), &end));
            if (*end != '\0' || !(std::fabs(values.back()) <= kMost))
                refuse(at, std::string(which) + " is no number within 1e6: '" + word + "'");
        }
        if (values.size() != count)
            refuse(at, std::string(which) + " needs " + std::to_string(count) + " numbers: '" + text + "'");
        return values;
    }
    double number(const XMLElement* at, const char* which) const { return numbers(at, which, 1)[0]; }
    double number(const XMLElement* at, const char* which, double usual) const {
        return at->Attribute(which) ? number(at, which) : usual;
    }
    double positive(const XMLElement* at, const char* which) const {
        const double value = number(at, which);
        if (!(value > 0)) refuse(at, std::string(which) + " must be above 0");
        return value;
    }
    Vector3d vector(const XMLElement* at, const char* which, const Vector3d& usual) const {
        if (!at->Attribute(which)) return usual;
        const std::vector<double> v = numbers(at, which, 3);
        return {v[0], v[1], v[2]};
    }

    // <origin>: roll about x, then pitch about y, then yaw about z, all fixed axes.
    Isometry3d origin(const XMLElement* at) const {
        Isometry3d pose = Isometry3d::Identity();
        const XMLElement* found = at->FirstChildElement("origin");
        if (!found) return pose;
        const Vector3d rpy = vector(found, "rpy", Vector3d::Zero());
        pose.linear() = (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                         Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
                            .toRotationMatrix();
        pose.translation() = vector(found, "xyz", Vector3d::Zero());
        return pose;
    }

    void read_link(const XMLElement* at) {
        UrdfLink link;
        link.name = attribute(at, "name");
        link.line = at->GetLineNum();
        if (!link_of_.emplace(link.name, links.size()).second) refuse(at, "a second link '" + link.name + "'");
        if (at->FirstChildElement("inertial")) read_inertial(child(at, "inertial"), link);
        for (const XMLElement* each = at->FirstChildElement("collision"); each;
             each = each->NextSiblingElement("collision"))
            read_collision(each, link);
        links.push_back(std::move(link));
    }

    void read_inertial(const XMLElement* at, UrdfLink& link) const {
        const XMLElement *mass = child(at, "mass"), *tensor = child(at, "inertia");
        link.mass = number(mass, "value");
        if (link.mass < 0) refuse(mass, "the mass of '" + link.name + "' is below 0");
        if (link.mass == 0) return;  // as if there were none
        const Isometry3d pose = origin(at);
        Matrix3d inertia;
        const double xy = number(tensor, "ixy", 0), xz = number(tensor, "ixz", 0), yz = number(tensor, "iyz", 0);
        inertia << number(tensor, "ixx"), xy, xz, xy, number(tensor, "iyy"), yz, xz, yz, number(tensor, "izz");
        if (!(Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia).eigenvalues().minCoeff() > 0))
            refuse(tensor, "the inertia of '" + link.name + "' is not positive definite");
        link.centre = pose.translation();
        link.inertia = pose.linear() * inertia * pose.linear().transpose();
    }

    void read_collision(const XMLElement* at, UrdfLink& link) const {
        const XMLElement* kind = child(at, "geometry")->FirstChildElement();
        if (!kind) refuse(at, "<geometry> is empty");
        const std::string what = kind->Name();
        Isometry3d pose = origin(at);
        Shape shape;
        shape.source = path_ + ":" + std::to_string(kind->GetLineNum()) + ": " + tag(kind) + " of '" + link.name + "'";
        if (what == "mesh") {
            read_mesh(kind, pose, link);
            return;
        }
        if (what == "box") {
            const std::vector<double> size = numbers(kind, "size", 3);
            shape.half_extents = {static_cast<float>(size[0] / 2), static_cast<float>(size[1] / 2),
                                  static_cast<float>(size[2] / 2)};
        } else if (what == "sphere") {
            shape.kind = ShapeKind::sphere;
            shape.radius = static_cast<float>(positive(kind, "radius"));
        } else if (what == "cylinder" || what == "capsule") {  // along z there, along y here
            shape.kind = what == "cylinder" ? ShapeKind::cylinder : ShapeKind::capsule;
            shape.radius = static_cast<float>(positive(kind, "radius"));
            shape.half_length = static_cast<float>(positive(kind, "length") / 2);
            pose = pose * Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitX());
        } else
            refuse(kind, tag(kind) + " is none of box, sphere, cylinder, capsule and mesh");
        link.shapes.push_back({std::move(shape), pose, kind->GetLineNum()});
    }

    // Each piece of the file as its hull.
    void read_mesh(const XMLElement* at, const Isometry3d& pose, UrdfLink& link) const {
        const std::string file = find_mesh(at);
        const Vector3d scale = vector(at, "scale", Vector3d::Ones());
        for (const ObjPiece& piece : read_obj(file)) {
            Shape shape;
            shape.kind = ShapeKind::hull;
            shape.source =
                file + ":" + std::to_string(piece.line) + ": piece '" + piece.name + "' of '" + link.name + "'";
            for (const taut_vec3& p : piece.points)
                shape.points.push_back({static_cast<float>(scale.x()) * p.x, static_cast<float>(scale.y()) * p.y,
                                        static_cast<float>(scale.z()) * p.z});
            link.shapes.push_back({std::move(shape), pose, at->GetLineNum()});
        }
    }

    // Beside the file, or package://NAME/REST in a folder NAME, or as REST, beside or above it.
    std::string find_mesh(const XMLElement* at) const {
        namespace fs = std::filesystem;
        std::string named = attribute(at, "filename");
        const std::string package = "package://", file = "file://";
        if (named.starts_with(file)) named = named.substr(file.size());
        const bool in_package = named.starts_with(package);
        if (in_package) named = named.substr(package.size());
        const fs::path without = fs::path(named.substr(std::min(named.find('/') + 1, named.size())));
        fs::path folder = fs::absolute(path_).parent_path();
        fs::path found = folder / named;
        while (in_package && !fs::exists(found)) {
            found = fs::exists(folder / named) ? folder / named : folder / without;
            if (fs::exists(found) || folder == folder.root_path()) break;
            folder = folder.parent_path();
        }
        if (!fs::exists(found)) refuse(at, "the mesh '" + named + "' is not there");
        if (found.extension() != ".obj" && found.extension() != ".OBJ")
            refuse(at, "the mesh '" + named + "' is no .obj file");
        return found.string();
    }

    size_t link_named(const XMLElement* joint, const char* which) const {
        const XMLElement* at = child(joint, which);
        const std::string link = attribute(at, "link");
        const auto found = link_of_.find(link);
        if (found == link_of_.end()) refuse(at, "there is no link '" + link + "'");
        return found->second;
    }

    void read_joint(const XMLElement* at) {
        static const std::map<std::string, UrdfKind> kinds = {
            {"revolute", UrdfKind::revolute}, {"continuous", UrdfKind::continuous}, {"prismatic", UrdfKind::prismatic},
            {"fixed", UrdfKind::fixed},       {"floating", UrdfKind::floating},     {"planar", UrdfKind::planar}};
        UrdfJoint joint;
        joint.name = attribute(at, "name");
        joint.line = at->GetLineNum();
        if (!joint_of_.emplace(joint.name, joints.size()).second) refuse(at, "a second joint '" + joint.name + "'");
        const auto kind = kinds.find(attribute(at, "type"));
        if (kind == kinds.end()) refuse(at, "there are no joints of type '" + attribute(at, "type") + "'");
        joint.kind = kind->second;
        joint.parent = link_named(at, "parent");
        joint.child = link_named(at, "child");
        joint.parent_from_joint = origin(at);
        if (at->FirstChildElement("mimic"))
            refuse(at->FirstChildElement("mimic"), "<mimic> is not supported: no joint here follows another");
        if (at->FirstChildElement("axis")) {
            const XMLElement* axis = child(at, "axis");
            joint.axis = vector(axis, "xyz", Vector3d::UnitX());
            if (!(joint.axis.norm() > 1e-6)) refuse(axis, "the axis of '" + joint.name + "' has no direction");
            joint.axis.normalize();
        }
        if (joint.kind == UrdfKind::revolute || joint.kind == UrdfKind::prismatic)
            read_limit(child(at, "limit"), joint);
        if (at->FirstChildElement("dynamics")) {
            const XMLElement* dynamics = child(at, "dynamics");
            joint.damping = number(dynamics, "damping", 0);
            joint.friction = number(dynamics, "friction", 0);
            if (joint.damping < 0 || joint.friction < 0) refuse(dynamics, "damping and friction may not be below 0");
        }
        UrdfLink& child_link = links[joint.child];
        if (child_link.joint >= 0)
            refuse(at, "the link '" + child_link.name + "' is the child of two joints; a robot is a tree");
        child_link.joint = static_cast<int>(joints.size());
        joints.push_back(std::move(joint));
    }

    void read_limit(const XMLElement* at, UrdfJoint& joint) const {
        joint.lower = number(at, "lower", 0);
        joint.upper = number(at, "upper", 0);
        joint.effort = number(at, "effort", 0);
        if (joint.lower > joint.upper) refuse(at, "lower is above upper");
        if (joint.effort < 0) refuse(at, "effort is below 0");
    }

    // Of a tree: the one link that is nobody's child; what does not hang on it is a loop.
    void find_root(const XMLElement* robot) {
        const UrdfLink* found = nullptr;
        for (const UrdfLink& link : links) {
            if (link.joint >= 0) continue;
            if (found)
                refuse_file(path_, link.line, "'" + link.name + "' and '" + found->name + "' are both no one's child");
            found = &link;
        }
        if (!found) refuse(robot, "every link is the child of a joint: there is no root");
        root = static_cast<size_t>(found - links.data());
        for (const UrdfLink& link : links) {
            const UrdfLink* up = &link;
            for (size_t steps = 0; up != found; ++steps) {
                if (steps > links.size()) refuse_file(path_, link.line, "'" + link.name + "' is in a loop of joints");
                up = &links[joints[static_cast<size_t>(up->joint)].parent];
            }
        }
    }

    std::string path_;
    tinyxml2::XMLDocument document_;
    std::map<std::string, size_t> link_of_, joint_of_;
};

taut_pos pos_of(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
taut_vec3 vec3_of(const Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}
taut_quat quat_of(const Matrix3d& rotation) {
    const Quaterniond q = Quaterniond(rotation).normalized();
    return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()), static_cast<float>(q.w())};
}

// Builds the scene's bodies and joints from the root on.
class RobotBuilder {
public:
    RobotBuilder(Scene& scene, const UrdfReader& urdf, const RobotPlace& place, const std::string& path)
        : scene_(scene), urdf_(urdf), place_(place), path_(path), placed_(urdf.links.size()) {
        robot_.name = urdf.name;
        for (const UrdfLink& link : urdf.links) robot_.links.push_back({link.name});
        const taut_quat& q = place.rotation;
        Isometry3d pose = Isometry3d::Identity();
        pose.linear() = Quaterniond(static_cast<double>(q.w), static_cast<double>(q.x), static_cast<double>(q.y),
                                    static_cast<double>(q.z))
                            .normalized()
                            .toRotationMatrix();
        pose.translation() = Vector3d(place.position.x, place.position.y, place.position.z);
        add_group(urdf.root, pose);
    }

    Robot take() { return std::move(robot_); }

private:
    struct Placed {
        Isometry3d body_from_link = Isometry3d::Identity();
        size_t group = 0;  // its uppermost link
    };

    // A link with all that fixed joints tie to it, then what hangs on that.
    void add_group(size_t top, const Isometry3d& world_from_top) {
        std::vector<size_t> members = {top};
        placed_[top] = {Isometry3d::Identity(), top};
        for (size_t i = 0; i < members.size(); ++i)
            for (const UrdfJoint& joint : urdf_.joints)
                if (joint.kind == UrdfKind::fixed && joint.parent == members[i]) {
                    placed_[joint.child] = {placed_[members[i]].body_from_link * joint.parent_from_joint, top};
                    members.push_back(joint.child);
                }
        const int body = add_body(members, world_from_top);
        for (const size_t member : members) {
            robot_.links[member].body = body;
            robot_.links[member].position = pos_of(placed_[member].body_from_link.translation());
            robot_.links[member].rotation = quat_of(placed_[member].body_from_link.linear());
        }
        for (const size_t member : members)
            for (const UrdfJoint& joint : urdf_.joints)
                if (joint.kind != UrdfKind::fixed && joint.parent == member) add_child(joint, body, world_from_top);
    }

    int add_body(const std::vector<size_t>& members, const Isometry3d& world_from_top) {
        Body body;
        body.look = place_.look;
        body.group = group_;
        body.position = pos_of(world_from_top.translation());
        body.rotation = quat_of(world_from_top.linear());
        double mass = 0;
        Vector3d sum = Vector3d::Zero();
        for (const size_t member : members) {
            const UrdfLink& link = urdf_.links[member];
            mass += link.mass;
            sum += link.mass * (placed_[member].body_from_link * link.centre);
            for (const UrdfShape& each : link.shapes) add_part(body, each, placed_[member].body_from_link);
        }
        const bool is_root = members.front() == urdf_.root;
        if (is_root && (mass == 0 || place_.fixed_base)) {
            body.kind = TAUT_BODY_STATIC;
            return scene_.add_body(body);
        }
        const UrdfLink& top = urdf_.links[members.front()];
        if (mass == 0) refuse_file(path_, top.line, "'" + top.name + "' moves and has no mass: it needs <inertial>");
        const Vector3d centre = sum / mass;
        Matrix3d inertia = Matrix3d::Zero();  // by Steiner about the common centre
        for (const size_t member : members) {
            const UrdfLink& link = urdf_.links[member];
            const Isometry3d& pose = placed_[member].body_from_link;
            const Vector3d arm = pose * link.centre - centre;
            inertia += pose.linear() * link.inertia * pose.linear().transpose() +
                       link.mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
        }
        body.mass = static_cast<float>(mass);
        body.centre_of_mass = vec3_of(centre);
        body.inertia = {static_cast<float>(inertia(0, 0)), static_cast<float>(inertia(1, 1)),
                        static_cast<float>(inertia(2, 2)), static_cast<float>(inertia(0, 1)),
                        static_cast<float>(inertia(0, 2)), static_cast<float>(inertia(1, 2))};
        return scene_.add_body(body);
    }

    void add_part(Body& body, const UrdfShape& each, const Isometry3d& body_from_link) {
        const Isometry3d pose = body_from_link * each.link_from_shape;
        Part part;
        part.shape = scene_.add_shape(each.shape);
        part.position = vec3_of(pose.translation());
        part.rotation = quat_of(pose.linear());
        body.parts.push_back(part);
    }

    void add_child(const UrdfJoint& joint, int parent_body, const Isometry3d& world_from_top) {
        const bool angular = joint.kind == UrdfKind::revolute || joint.kind == UrdfKind::continuous;
        RobotJoint told;
        told.name = joint.name;
        told.parent = static_cast<int>(joint.parent);
        told.child = static_cast<int>(joint.child);
        told.is_limited = joint.kind == UrdfKind::revolute || joint.kind == UrdfKind::prismatic;
        told.effort = joint.effort;
        if (told.is_limited) {
            told.lower = joint.lower;
            told.upper = joint.upper;
            told.at = std::clamp(0.0, joint.lower, joint.upper);
        }
        const Isometry3d body_from_joint = placed_[joint.parent].body_from_link * joint.parent_from_joint;
        Isometry3d joint_from_child = Isometry3d::Identity();
        if (angular)
            joint_from_child.linear() = Eigen::AngleAxisd(told.at, joint.axis).toRotationMatrix();
        else
            joint_from_child.translation() = told.at * joint.axis;
        const int before = static_cast<int>(scene_.bodies.size());  // the child's body comes next
        if (joint.kind != UrdfKind::floating) {
            const Matrix3d axes = Quaterniond::FromTwoVectors(Vector3d::UnitX(), joint.axis).toRotationMatrix();
            Joint added;
            added.kind = angular                             ? TAUT_JOINT_HINGE
                         : joint.kind == UrdfKind::prismatic ? TAUT_JOINT_SLIDER
                                                             : TAUT_JOINT_SIX_DOF;
            added.body_a = parent_body;
            added.body_b = before;
            added.anchor_a = pos_of(body_from_joint.translation());
            added.rotation_a = quat_of(body_from_joint.linear() * axes);
            added.rotation_b = quat_of(axes);
            added.axes = axes_of(joint, told);
            added.solve = TAUT_JOINT_SOLVE_DIRECT;
            told.joint = scene_.add_joint(added);
        }
        robot_.joints.push_back(told);
        add_group(joint.child, world_from_top * body_from_joint * joint_from_child);
    }

    std::vector<taut_axis_def> axes_of(const UrdfJoint& joint, const RobotJoint& told) const {
        taut_axis_def axis;
        taut_axis_def_init(&axis);
        if (joint.kind == UrdfKind::planar) {  // in the plane across x, and about x
            taut_axis_def locked = axis;
            locked.mode = TAUT_AXIS_LOCKED;
            axis.drive.damping = static_cast<float>(joint.damping);
            return {locked, axis, axis, axis, locked, locked};
        }
        const double turn = 2 * std::numbers::pi;
        const bool whole = joint.kind == UrdfKind::revolute && told.upper - told.lower >= turn;
        if (told.is_limited && !whole) {
            axis.mode = TAUT_AXIS_LIMITED;
            axis.lower = static_cast<float>(told.lower);
            axis.upper = static_cast<float>(told.upper);
        }
        axis.friction = static_cast<float>(joint.friction);
        if (place_.hold > 0) {
            axis.drive.frequency = place_.hold;
            axis.drive.target = static_cast<float>(told.at);
            if (joint.effort > 0) axis.drive.max_force = static_cast<float>(joint.effort);
        } else
            axis.drive.damping = static_cast<float>(joint.damping);
        return {axis};
    }

    Scene& scene_;
    const UrdfReader& urdf_;
    const RobotPlace& place_;
    const std::string& path_;
    std::vector<Placed> placed_;  // of each link
    int32_t group_ = -1000 - static_cast<int32_t>(scene_.bodies.size());
    Robot robot_;
};

}  // namespace

Robot add_urdf(Scene& scene, const std::string& path, const RobotPlace& place) {
    return add_urdf_text(scene, read_text(path), path, place);
}

Robot add_urdf_text(Scene& scene, const std::string& text, const std::string& path, const RobotPlace& place) {
    const UrdfReader urdf(text, path);
    return RobotBuilder(scene, urdf, place, path).take();
}

}  // namespace scenes
