#include "scene_export.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "scenes/pose.h"
#include "shape_mesh.h"

namespace demo {

namespace {

using Json = nlohmann::ordered_json;
using render::Colour;
using render::from_srgb;
using render::Vec3;
using scenes::Look;

constexpr float kRodRadius = 0.04f, kRopeRadius = 0.028f, kPointRadius = 0.05f;  // drawn sizes [m]
constexpr float kRough = 0.85f, kGlossy = 0.35f;
constexpr int kRodSides = 12;
constexpr int kPoint = -1;  // in place of a shape's index: of particles without one
const Colour kRodColour = from_srgb(0xA9B4C0), kGroundColour = from_srgb(0xC8CDD2);

std::vector<float> numbers(const taut_pos& p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

void append(std::vector<float>& to, const std::vector<float>& values) {
    to.insert(to.end(), values.begin(), values.end());
}

// Of the two quaternions of a rotation the one nearer to that before, so that samplers take the short way; of unit
// length to the last digit.
void append_rotation(std::vector<float>& to, const taut_quat& q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    double s = 1 / std::sqrt(x * x + y * y + z * z + w * w);
    if (to.size() >= 4) {
        const float* last = &to[to.size() - 4];
        if (x * last[0] + y * last[1] + z * last[2] + w * last[3] < 0) s = -s;
    }
    append(to, {static_cast<float>(s * x), static_cast<float>(s * y), static_cast<float>(s * z),
                static_cast<float>(s * w)});
}

bool changes(const std::vector<float>& values, size_t width) {
    for (size_t i = width; i < values.size(); ++i)
        if (values[i] != values[i - width]) return true;
    return false;
}

std::vector<float> first(const std::vector<float>& values, size_t width) {
    return {values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)};
}

template <class Read, class Handle>
std::vector<taut_pos> all_points(Read read, Handle handle) {
    uint32_t count = 0;
    read(handle, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
    std::vector<taut_pos> points(count);
    scenes::check(read(handle, points.data(), count, &count), "reading points");
    return points;
}

template <class Read, class Handle>
std::vector<uint32_t> all_triangles(Read read, Handle handle) {
    uint32_t count = 0;
    read(handle, nullptr, 0, &count);
    std::vector<uint32_t> triangles(3 * count);
    scenes::check(read(handle, triangles.data(), count, &count), "reading triangles");
    return triangles;
}

}  // namespace

void GltfExport::watch() {
    if (scene_.cloths.empty()) return;
    taut_events events{};
    scenes::check(taut_world_get_events(world_.world, &events), "reading the events");
    for (uint32_t i = 0; i < events.torn_count; ++i)
        cloths_[events.torn[i].user_data].split_from.push_back(events.torn[i].vertex);
}

void GltfExport::record(double time) {
    times_.push_back(static_cast<float>(time));
    bodies_.resize(scene_.bodies.size());
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const taut_pose pose = world_.pose(i);
        append(bodies_[i].translations, numbers(pose.position));
        append_rotation(bodies_[i].rotations, pose.rotation);
    }
    record_rods();
    cloths_.resize(scene_.cloths.size());
    solids_.resize(scene_.solids.size());
    for (size_t i = 0; i < cloths_.size(); ++i)
        cloths_[i].frames.push_back(all_points(taut_cloth_get_points, world_.cloths[i]));
    for (size_t i = 0; i < solids_.size(); ++i)
        solids_[i].frames.push_back(all_points(taut_solid_get_points, world_.solids[i]));
}

// A rod that is not there, before a cable was paid out or after a joint broke, has no size.
void GltfExport::put_rod(size_t rod, taut_pos a, taut_pos b, float radius) {
    if (rod >= rods_.size()) rods_.resize(rod + 1);
    Placed& placed = rods_[rod];
    for (size_t frame = placed.scales.size() / 3; frame + 1 < times_.size(); ++frame) {
        append(placed.translations, numbers(a));
        append_rotation(placed.rotations, {0, 0, 0, 1});
        append(placed.scales, {0, 0, 0});
    }
    const auto half = static_cast<float>(scenes::length(scenes::minus(b, a)) / 2);
    append(placed.translations, numbers(scenes::middle(a, b)));
    append_rotation(placed.rotations,
                    half > 0 ? scenes::turn_from_to({0, 1, 0}, scenes::minus(b, a)) : taut_quat{0, 0, 0, 1});
    append(placed.scales, {radius, half, radius});
}

void GltfExport::record_rods() {
    size_t rod = 0;
    for (size_t i = 0; i < scene_.joints.size(); ++i) {
        const scenes::Joint& joint = scene_.joints[i];
        if (joint.kind != TAUT_JOINT_DISTANCE || (joint.drawn_radius && *joint.drawn_radius <= 0)) continue;
        if (world_.is_whole(i)) {
            taut_pos a{}, b{};
            scenes::check(taut_joint_get_anchors(world_.joints[i], &a, &b), "reading a joint's anchors");
            put_rod(rod, a, b,
                    joint.drawn_radius     ? static_cast<float>(*joint.drawn_radius)
                    : joint.max_length > 0 ? kRopeRadius
                                           : kRodRadius);
        }
        ++rod;
    }
    first_rod_of_cable_.resize(scene_.cables.size());
    for (size_t i = 0; i < scene_.cables.size(); ++i) {
        // Cables that are paid out get more segments: room for all that they may have.
        if (times_.size() == 1)
            first_rod_of_cable_[i] = i == 0 ? rod : first_rod_of_cable_[i - 1] + TAUT_CABLE_MAX_SEGMENTS;
        record_cable(i);
    }
}

void GltfExport::record_cable(size_t cable) {
    const std::vector<taut_pos> points = all_points(taut_cable_get_points, world_.cables[cable]);
    const float radius = 0.5f * scene_.cables[cable].def.diameter;
    for (size_t segment = 0; segment + 1 < points.size(); ++segment)
        put_rod(first_rod_of_cable_[cable] + segment, points[segment], points[segment + 1], radius);
}

size_t GltfExport::material(const Colour& colour, bool both_sides, float roughness) {
    const auto [found, is_new] =
        materials_.try_emplace({colour.x, colour.y, colour.z, both_sides, roughness}, materials_.size());
    if (is_new) {
        Json entry = {{"pbrMetallicRoughness",
                       {{"baseColorFactor", {colour.x, colour.y, colour.z, 1}},
                        {"metallicFactor", 0},
                        {"roughnessFactor", roughness}}}};
        if (both_sides) entry["doubleSided"] = true;
        file_.add("materials", std::move(entry));
    }
    return found->second;
}

// The accessor of the positions; normals: that of those.
size_t GltfExport::geometry(const std::vector<render::Vertex>& triangles, size_t& normals) {
    std::vector<float> position, normal;
    for (const render::Vertex& vertex : triangles) {
        append(position, {vertex.position.x, vertex.position.y, vertex.position.z});
        const Vec3 n = length(vertex.normal) > 0.5f ? render::normalised(vertex.normal) : Vec3{0, 1, 0};
        append(normal, {n.x, n.y, n.z});
    }
    normals = file_.add_floats(GlbFile::Use::vertices, normal, 3, false);
    return file_.add_floats(GlbFile::Use::vertices, position, 3, true);
}

size_t GltfExport::mesh_of(const std::vector<render::Vertex>& triangles, size_t material) {
    size_t normals = 0;
    const size_t positions = geometry(triangles, normals);
    return file_.add(
        "meshes",
        {{"primitives", {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"material", material}}}}});
}

float GltfExport::reach() const {
    const scenes::Bounds& stage = scene_.stage;
    return static_cast<float>(2 * std::max({std::fabs(stage.low.x), std::fabs(stage.low.z), std::fabs(stage.high.x),
                                            std::fabs(stage.high.z)}));
}

// A mesh a shape and material; those of a shape share its arrays.
size_t GltfExport::mesh(int shape, size_t material) {
    const auto found = meshes_.find({shape, material});
    if (found != meshes_.end()) return found->second;
    if (!geometries_.contains(shape)) {
        scenes::Shape ball;
        ball.kind = scenes::ShapeKind::sphere;
        ball.radius = kPointRadius;
        const auto index = static_cast<size_t>(shape);
        size_t normals = 0;
        const size_t positions = geometry(
            shape == kPoint ? shape_mesh(ball, {}, 0) : shape_mesh(scene_.shapes[index], world_.shapes[index], reach()),
            normals);
        geometries_[shape] = {positions, normals};
    }
    const auto [positions, normals] = geometries_[shape];
    const size_t added = file_.add(
        "meshes",
        {{"primitives", {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"material", material}}}}});
    meshes_[{shape, material}] = added;
    return added;
}

void GltfExport::animate(size_t node, const char* path, const std::vector<float>& values, size_t width) {
    Json sampler = {{"input", times_accessor_},
                    {"output", file_.add_floats(GlbFile::Use::animation, values, width, false)},
                    {"interpolation", "LINEAR"}};
    animation_["samplers"].push_back(std::move(sampler));
    animation_["channels"].push_back(
        {{"sampler", animation_["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
}

// What stays where it is has no samplers.
size_t GltfExport::add_node(Json node, const Placed& placed, bool with_scale) {
    node["translation"] = first(placed.translations, 3);
    node["rotation"] = first(placed.rotations, 4);
    if (with_scale) node["scale"] = first(placed.scales, 3);
    const size_t index = file_.add("nodes", std::move(node));
    file_.root["scenes"][0]["nodes"].push_back(index);
    if (changes(placed.translations, 3)) animate(index, "translation", placed.translations, 3);
    if (changes(placed.rotations, 4)) animate(index, "rotation", placed.rotations, 4);
    if (with_scale && changes(placed.scales, 3)) animate(index, "scale", placed.scales, 3);
    return index;
}

void GltfExport::add_parts(const scenes::Body& body, Json& node, size_t paint) {
    for (const scenes::Part& part : body.parts) {
        const taut_pos at = {part.position.x, part.position.y, part.position.z};
        std::vector<float> rotation;
        append_rotation(rotation, part.rotation);
        node["children"].push_back(file_.add(
            "nodes", {{"mesh", mesh(part.shape, paint)}, {"translation", numbers(at)}, {"rotation", rotation}}));
    }
}

void GltfExport::add_bodies() {
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const scenes::Body& body = scene_.bodies[i];
        if (body.look == Look::hidden) continue;
        const bool steel = body.look == Look::steel;
        const size_t paint = material(body.look == Look::ground ? kGroundColour : colour_of(body.look, i), false,
                                      steel ? kGlossy : kRough);
        Json node = {{"name", "body " + std::to_string(i)}};
        if (body.drawn >= 0)
            node["mesh"] = mesh(body.drawn, paint);
        else if (body.kind == TAUT_BODY_PARTICLE && body.shape < 0)
            node["mesh"] = mesh(kPoint, paint);
        else {
            if (body.shape >= 0) node["mesh"] = mesh(body.shape, paint);
            add_parts(body, node, paint);
        }
        add_node(std::move(node), bodies_[i], false);
    }
}

void GltfExport::add_rods() {
    const size_t none = ~size_t{0};
    size_t cylinder = none;
    for (Placed& rod : rods_) {
        if (rod.scales.empty()) continue;
        while (rod.scales.size() / 3 < times_.size()) {  // gone since
            append(rod.translations, {rod.translations.end() - 3, rod.translations.end()});
            append(rod.rotations, {rod.rotations.end() - 4, rod.rotations.end()});
            append(rod.scales, {0, 0, 0});
        }
        if (cylinder == none)
            cylinder = mesh_of(render::cylinder_mesh(kRodSides), material(kRodColour, false, kGlossy));
        add_node({{"name", "rod"}, {"mesh", cylinder}}, rod, true);
    }
}

void GltfExport::add_soft(const std::string& name, Soft& soft, const std::vector<uint32_t>& triangles, size_t paint) {
    // Vertices that a tear made later are where the one was that they split from: that has a smaller number.
    const size_t whole = soft.frames.back().size() - soft.split_from.size();
    for (std::vector<taut_pos>& points : soft.frames)
        while (points.size() < whole + soft.split_from.size())
            points.push_back(points[soft.split_from[points.size() - whole]]);
    const auto corners = [&](size_t frame, bool normals, bool change) {
        const auto values_at = [&](size_t each) {
            std::vector<float> values;
            if (normals)
                for (const taut_vec3& n : normals_of(soft.frames[each], triangles)) append(values, {n.x, n.y, n.z});
            else
                for (const taut_pos& p : soft.frames[each]) append(values, numbers(p));
            return values;
        };
        std::vector<float> values = values_at(frame);
        if (change) {
            const std::vector<float> from = values_at(0);
            for (size_t i = 0; i < values.size(); ++i) values[i] -= from[i];
        }
        return file_.add_floats(GlbFile::Use::vertices, values, 3, !normals);
    };
    Json primitive = {{"attributes", {{"POSITION", corners(0, false, false)}, {"NORMAL", corners(0, true, false)}}},
                      {"indices", file_.add_indices(triangles)},
                      {"material", paint}};
    const size_t targets = soft.frames.size() - 1;
    for (size_t frame = 1; frame <= targets; ++frame)
        primitive["targets"].push_back(
            {{"POSITION", corners(frame, false, true)}, {"NORMAL", corners(frame, true, true)}});
    Json mesh = {{"primitives", Json::array({std::move(primitive)})}};
    if (targets > 0) mesh["weights"] = std::vector<int>(targets, 0);
    const size_t node = file_.add("nodes", {{"name", name}, {"mesh", file_.add("meshes", std::move(mesh))}});
    file_.root["scenes"][0]["nodes"].push_back(node);
    if (targets == 0) return;
    std::vector<float> weights(soft.frames.size() * targets, 0.0f);
    for (size_t frame = 1; frame <= targets; ++frame) weights[frame * targets + frame - 1] = 1;
    animate(node, "weights", weights, 1);
}

void GltfExport::add_softs() {
    for (size_t i = 0; i < cloths_.size(); ++i) {
        const uint32_t paint = scene_.cloths[i].look.paint;
        add_soft("cloth " + std::to_string(i), cloths_[i], all_triangles(taut_cloth_get_triangles, world_.cloths[i]),
                 material(from_srgb(paint != 0 ? paint : kClothPaint), true, kRough));
    }
    for (size_t i = 0; i < solids_.size(); ++i) {
        const scenes::Solid& plan = scene_.solids[i];
        std::vector<uint32_t> triangles = plan.skin.triangles;
        if (triangles.empty())
            triangles = all_triangles(taut_solid_get_triangles, world_.solids[i]);
        else
            for (std::vector<taut_pos>& points : solids_[i].frames) points = skin_points(plan.skin, points);
        if (triangles.empty()) continue;  // of points without a surface
        const uint32_t paint = plan.look.paint;
        add_soft("solid " + std::to_string(i), solids_[i], triangles,
                 material(from_srgb(paint != 0 ? paint : kSolidPaint), false, kRough));
    }
}

void GltfExport::add_camera() {
    const scenes::Camera& camera = scene_.camera;
    const size_t lens = file_.add(
        "cameras",
        {{"type", "perspective"},
         {"perspective",
          {{"yfov", static_cast<double>(camera.vertical_fov_deg) * std::numbers::pi / 180}, {"znear", 0.05}}}});
    // A camera looks along -z: a turn about y, then one about its own x.
    const taut_pos way = scenes::minus(camera.target, camera.eye);
    const double about_y = std::atan2(-way.x, -way.z), about_x = std::atan2(way.y, std::hypot(way.x, way.z));
    const taut_quat y = {0, static_cast<float>(std::sin(about_y / 2)), 0, static_cast<float>(std::cos(about_y / 2))};
    const taut_quat x = {static_cast<float>(std::sin(about_x / 2)), 0, 0, static_cast<float>(std::cos(about_x / 2))};
    std::vector<float> rotation;
    append_rotation(rotation, scenes::times(y, x));
    file_.root["scenes"][0]["nodes"].push_back(file_.add(
        "nodes", {{"name", "camera"}, {"camera", lens}, {"translation", numbers(camera.eye)}, {"rotation", rotation}}));
}

void GltfExport::write(const std::string& path) {
    file_.root["asset"] = {{"version", "2.0"}, {"generator", "taut-demo"}};
    file_.root["scene"] = 0;
    file_.root["scenes"] = Json::array({{{"name", scene_.name}, {"nodes", Json::array()}}});
    times_accessor_ = file_.add_floats(GlbFile::Use::animation, times_, 1, true);
    animation_ = {{"name", scene_.name}, {"samplers", Json::array()}, {"channels", Json::array()}};
    add_bodies();
    add_rods();
    add_softs();
    add_camera();
    if (!animation_["channels"].empty()) file_.add("animations", std::move(animation_));
    file_.write(path);
}

PoseTable::PoseTable(const std::string& path, const scenes::TautWorld& world)
    : path_(path), file_(path), world_(world) {
    file_ << "frame,time,kind,index,vertex,x,y,z,qx,qy,qz,qw\n";
    if (!file_) throw std::runtime_error("cannot write " + path);
}

void PoseTable::record(uint32_t frame, double time) {
    char line[256];
    const auto put = [&](const char* kind, size_t index, size_t vertex, const taut_pos& p, const taut_quat& q) {
        std::snprintf(line, sizeof line, "%u,%.9g,%s,%zu,%zu,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", frame, time, kind,
                      index, vertex, p.x, p.y, p.z, static_cast<double>(q.x), static_cast<double>(q.y),
                      static_cast<double>(q.z), static_cast<double>(q.w));
        file_ << line;
    };
    const size_t bodies = world_.bodies.size();
    std::vector<taut_pose> poses(bodies);
    scenes::check(taut_world_get_body_states(world_.world, world_.bodies.data(), static_cast<uint32_t>(bodies),
                                             poses.data(), 0, nullptr, 0, nullptr, 0),
                  "reading the poses");
    for (size_t i = 0; i < bodies; ++i) put("body", i, 0, poses[i].position, poses[i].rotation);
    const auto put_all = [&](const char* kind, size_t index, const std::vector<taut_pos>& points) {
        for (size_t v = 0; v < points.size(); ++v) put(kind, index, v, points[v], {0, 0, 0, 1});
    };
    for (size_t i = 0; i < world_.cloths.size(); ++i)
        put_all("cloth", i, all_points(taut_cloth_get_points, world_.cloths[i]));
    for (size_t i = 0; i < world_.solids.size(); ++i)
        put_all("solid", i, all_points(taut_solid_get_points, world_.solids[i]));
}

void PoseTable::finish() {
    if (!file_.flush()) throw std::runtime_error("cannot write " + path_);
}

}  // namespace demo
