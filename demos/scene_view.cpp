#include "scene_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/pose.h"
#include "shape_mesh.h"

namespace demo {

namespace {

using render::Colour;
using render::from_srgb;
using render::Instance;
using render::Vec3;
using scenes::Look;
using scenes::ShapeKind;

constexpr float kCableWeightRadius = 0.30f, kContactRadius = 0.03f;  // drawn sizes [m]
// Needles of contacts: one that bears the weight of the median body is so long, one of ten times it the longest [m].
constexpr float kNeedle = 0.30f, kLongestNeedle = 10 * kNeedle;

const Colour kLinkGrey = from_srgb(0xA9B4C0), kStop = from_srgb(0xFF2F4F), kDecoration = from_srgb(0xE8B23A),
             kPin = from_srgb(0x2A2F36), kContact = from_srgb(0xFFE14D), kNormal = from_srgb(0xFF3D81);

// 0 for a joint that broke.
float force_on(taut_joint joint) {
    taut_vec3 force{};
    if (!taut_joint_is_valid(joint)) return 0;
    scenes::check(taut_joint_get_force(joint, &force), "reading a joint's force");
    return std::sqrt(force.x * force.x + force.y * force.y + force.z * force.z);
}

}  // namespace

TensionScale::TensionScale(const scenes::Scene& scene) {
    if (scene.forces) {
        low_ = scene.forces->low;
        high_ = scene.forces->high;
        return;
    }
    if (!scene.roles.chain) return;
    double gravity = std::fabs(scene.world.gravity.y), least = 1e30, all = 0;
    for (int index : scene.roles.chain->bodies) {
        double weight = gravity * static_cast<double>(scene.bodies[static_cast<size_t>(index)].mass);
        least = std::min(least, weight);
        all += weight;
    }
    low_ = static_cast<int>(std::lround(std::log10(std::max(least, 1e-3))));
    // A weight that falls freely from horizontal pulls three times its weight at the bottom.
    high_ = std::max(low_ + 1, static_cast<int>(std::ceil(std::log10(std::max(3 * all, 1e-2)))));
}

Colour TensionScale::ramp(float t) {
    static const Colour stops[] = {from_srgb(0x2447C9), from_srgb(0x2FA4C7), from_srgb(0x7CC46B),
                                   from_srgb(0xF5C542), from_srgb(0xEE6C2C), from_srgb(0xD01B2E)};
    constexpr int kSpans = 5;
    float at = std::clamp(t, 0.0f, 1.0f) * kSpans;
    int span = std::min(static_cast<int>(at), kSpans - 1);
    return mix(stops[span], stops[span + 1], at - static_cast<float>(span));
}

Colour TensionScale::colour(float force) const {
    if (!(force > 0)) return ramp(0);
    return ramp((std::log10(force) - static_cast<float>(low_)) / static_cast<float>(high_ - low_));
}

SceneView::SceneView(const scenes::Scene& scene, const scenes::TautWorld& world, render::Renderer& renderer)
    : scene_(scene), world_(world), renderer_(renderer), scale_(scene) {
    for (size_t i = 0; i < scene.shapes.size(); ++i)
        meshes_.push_back(mesh_of(scene.shapes[i], world.shapes[i], renderer));
    renderer.set_stage(stage());
}

render::Stage SceneView::stage() const { return {vec(scene_.stage.low), vec(scene_.stage.high), 0}; }

namespace {

// What the viewer looks through: all that is not drawn.
int32_t hides_view(taut_body body, taut_collider, void* user) {
    const auto& scene = *static_cast<const scenes::Scene*>(user);
    uint64_t index = 0;
    if (taut_body_get_user_data(body, &index) != TAUT_OK || index >= scene.bodies.size()) return 0;
    const Look look = scene.bodies[index].look;
    return look != Look::hidden && look != Look::wall;
}

}  // namespace

render::Camera SceneView::camera() const {
    const render::Camera still = {vec(scene_.camera.eye), vec(scene_.camera.target),
                                  scene_.camera.vertical_fov_deg * std::numbers::pi_v<float> / 180};
    if (!follows_) return still;
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    filter.accept = hides_view;
    filter.user_data = const_cast<scenes::Scene*>(&scene_);
    return clear_view(above_ground(follows_->camera(), 0), world_.world, {}, filter).camera;
}

void SceneView::follow(float aspect) {
    const render::Camera still = camera();
    follows_.emplace(still, size_of(scene_.world.gravity), aspect);
    step();
}

void SceneView::step() {
    if (!follows_) return;
    std::vector<taut_body> bodies;
    for (const int body : scene_.camera.follow) bodies.push_back(world_.bodies[static_cast<size_t>(body)]);
    if (bodies.empty()) bodies = moving_bodies(world_.world);
    const std::optional<scenes::Bounds> box = bounds_of(bodies);
    if (!box) return;
    follows_->follow(vec(box->low), vec(box->high), scene_.world.time_step);
    render::Stage here = stage();
    here.include(vec(box->low), vec(box->high));
    renderer_.set_stage(here);
}

void SceneView::add_body(render::DrawList& list, size_t index, Colour colour) const {
    const scenes::Body& body = scene_.bodies[index];
    taut_pose pose = world_.pose(index);
    Instance instance;
    instance.position = vec(pose.position);
    instance.rotation = quat(pose.rotation);
    instance.colour = colour;
    instance.gloss = body.look == Look::steel ? 0.9f : 0.22f;
    if (body.kind == TAUT_BODY_PARTICLE) {
        float radius = body.look == Look::steel ? kCableWeightRadius : kPointRadius;
        if (body.shape >= 0) radius = scene_.shapes[static_cast<size_t>(body.shape)].radius;
        instance.mesh = body.look == Look::steel ? render::kMeshSphere : render::kMeshDot;
        instance.scale = {radius, radius, radius};
        list.instances.push_back(instance);
        return;
    }
    if (body.drawn >= 0) {
        add_shape(list, body.drawn, instance);
        return;
    }
    if (body.shape >= 0) add_shape(list, body.shape, instance);
    for (const scenes::Part& part : body.parts) {
        Instance piece = instance;
        piece.position =
            instance.position + rotate(instance.rotation, {part.position.x, part.position.y, part.position.z});
        piece.rotation = quat(scenes::times(pose.rotation, part.rotation));
        add_shape(list, part.shape, piece);
    }
}

void SceneView::add_shape(render::DrawList& list, int index, const Instance& instance) const {
    const auto shape = static_cast<size_t>(index);
    demo::add_shape(list, scene_.shapes[shape], meshes_[shape], instance);
}

void SceneView::add_bodies(render::DrawList& list, bool tension) const {
    // A link shows the stronger of the forces at its ends.
    std::vector<float> force(scene_.bodies.size(), 0.0f);
    if (tension)
        for (size_t i = 0; i < scene_.joints.size(); ++i)
            for (int end : {scene_.joints[i].body_a, scene_.joints[i].body_b})
                if (end != scenes::kWorld) {
                    float& most = force[static_cast<size_t>(end)];
                    most = std::max(most, force_on(world_.joints[i]));
                }
    for (size_t i = 0; i < scene_.bodies.size(); ++i) {
        Look look = scene_.bodies[i].look;
        if (look == Look::hidden || look == Look::ground || is_in_the_way(i)) continue;
        bool shows_force = tension && (look == Look::link || look == Look::particle);
        const Colour colour = shows_force ? scale_.colour(force[i]) : colour_of(look, i);
        add_body(list, i, is_asleep(world_.bodies[i]) ? darker(colour) : colour);
    }
    for (const scenes::Decoration& decoration : scene_.decorations) {
        Instance instance;
        instance.position = vec(decoration.position);
        instance.scale = {decoration.half_extents.x, decoration.half_extents.y, decoration.half_extents.z};
        instance.colour = kDecoration;
        list.instances.push_back(instance);
    }
}

// Walls between the viewer and what they hold.
bool SceneView::is_in_the_way(size_t index) const {
    if (scene_.bodies[index].look != Look::wall) return false;
    Vec3 middle = vec(scene_.camera.target), wall = vec(scene_.bodies[index].position) - middle;
    Vec3 viewer = vec(scene_.camera.eye) - middle;
    return wall.x * viewer.x + wall.z * viewer.z > 0;
}

float SceneView::thickness_at(const scenes::Joint& joint) const {
    for (int end : {joint.body_b, joint.body_a}) {
        if (end == scenes::kWorld || scene_.bodies[static_cast<size_t>(end)].look != Look::link) continue;
        const scenes::Shape& shape = scene_.shapes[static_cast<size_t>(scene_.bodies[static_cast<size_t>(end)].shape)];
        return shape.kind == ShapeKind::capsule ? shape.radius : shape.half_extents.y;
    }
    return kPointRadius;
}

// A pin along the hinge's axis, red while a stop pushes.
void SceneView::add_hinge(render::DrawList& list, size_t index, Vec3 at) const {
    const scenes::Joint& joint = scene_.joints[index];
    taut_axis_forces forces{};
    scenes::check(taut_joint_get_axis_forces(world_.joints[index], 0, &forces), "reading a hinge's forces");
    const taut_quat body = world_.pose(static_cast<size_t>(joint.body_b)).rotation, own = joint.rotation_b;
    const Vec3 axis =
        render::rotate({body.x, body.y, body.z, body.w}, render::rotate({own.x, own.y, own.z, own.w}, {1, 0, 0}));
    const scenes::Body& end = scene_.bodies[static_cast<size_t>(joint.body_b)];
    const scenes::Shape& shape = scene_.shapes[static_cast<size_t>(end.shape)];
    const float half = shape.kind == ShapeKind::box ? 1.08f * shape.half_extents.z : 1.3f * shape.radius;
    const float radius = shape.kind == ShapeKind::box ? 0.55f * shape.half_extents.y : 0.8f * shape.radius;
    const bool stopped = forces.active_stop != 0;
    list.instances.push_back(rod(at - axis * half, at + axis * half, std::min(radius, 0.08f) * (stopped ? 1.6f : 1.0f),
                                 stopped ? kStop : kPin));
}

// Arms from knots to the joints that tie them, coloured by their force.
void SceneView::add_arms(render::DrawList& list, size_t index, const std::array<Vec3, 2>& anchors, bool tension) const {
    const scenes::Joint& joint = scene_.joints[index];
    const Colour colour = tension ? scale_.colour(force_on(world_.joints[index])) : kLinkGrey;
    const int ends[2] = {joint.body_a, joint.body_b};
    for (size_t end = 0; end < 2; ++end) {
        if (ends[end] == scenes::kWorld) continue;
        const auto body = static_cast<size_t>(ends[end]);
        const scenes::Body& knot = scene_.bodies[body];
        if (knot.look != Look::particle || knot.kind == TAUT_BODY_PARTICLE || knot.shape < 0) continue;
        const float radius = scene_.shapes[static_cast<size_t>(knot.shape)].radius;
        list.instances.push_back(rod(vec(world_.pose(body).position), anchors[end], 0.35f * radius, colour));
    }
}

void SceneView::add_joints(render::DrawList& list, bool tension) const {
    for (size_t i = 0; i < scene_.joints.size(); ++i) {
        const std::optional<double>& drawn = scene_.joints[i].drawn_radius;
        if (!world_.is_whole(i) || (drawn && *drawn <= 0)) continue;
        taut_pos a{}, b{};
        scenes::check(taut_joint_get_anchors(world_.joints[i], &a, &b), "reading a joint's anchors");
        switch (scene_.joints[i].kind) {
            case TAUT_JOINT_DISTANCE: {
                Colour colour = tension ? scale_.colour(force_on(world_.joints[i])) : kLinkGrey;
                const bool rope = scene_.joints[i].max_length > 0;
                const float radius = drawn ? static_cast<float>(*drawn) : rope ? kRopeRadius : kRodRadius;
                list.instances.push_back(rod(vec(a), vec(b), radius, colour));
                break;
            }
            case TAUT_JOINT_HINGE:
                add_hinge(list, i, vec(b));
                break;
            case TAUT_JOINT_PULLEY: {
                taut_frame first{}, second{};
                scenes::check(taut_joint_get_housing_frames(world_.joints[i], &first, &second), "reading sheaves");
                const Colour colour = tension ? scale_.colour(force_on(world_.joints[i])) : kLinkGrey;
                // Sheaves of scenes are in the world.
                const Vec3 way[] = {vec(a), vec(first.position), vec(second.position), vec(b)};
                for (int k = 0; k < 3; ++k) list.instances.push_back(rod(way[k], way[k + 1], kRopeRadius, colour));
                break;
            }
            case TAUT_JOINT_BALL:
                add_arms(list, i, {vec(a), vec(b)}, tension);
                list.instances.push_back(ball(
                    vec(b), drawn ? static_cast<float>(*drawn) : 1.25f * thickness_at(scene_.joints[i]), kPin, 0.7f));
                break;
            default:
                break;  // inside the bodies that they join
        }
    }
}

// A tube a segment, round where they meet.
void SceneView::add_cables(render::DrawList& list, bool tension) {
    for (size_t i = 0; i < scene_.cables.size(); ++i) {
        const taut_cable cable = world_.cables[i];
        scenes::check(read_all(taut_cable_get_points, cable, points_), "reading a cable's points");
        scenes::check(read_all(taut_cable_get_tensions, cable, tensions_), "reading a cable's tensions");
        const float radius = 0.5f * scene_.cables[i].def.diameter;
        for (size_t segment = 0; segment + 1 < points_.size(); ++segment) {
            const Colour colour = tension ? scale_.colour(std::fabs(tensions_[segment])) : kLinkGrey;
            const Vec3 a = vec(points_[segment]), b = vec(points_[segment + 1]);
            list.instances.push_back(rod(a, b, radius, colour));
            list.instances.push_back(ball(b, radius, colour, 0.22f));
        }
    }
}

// The mean of the elements about each vertex, so that colours pass smoothly from one to the next.
void SceneView::spread_over_vertices(const std::vector<uint32_t>& elements, size_t corners, size_t vertices) {
    std::vector<int> count(vertices, 0);
    at_vertices_.assign(vertices, 0);
    for (size_t i = 0; i < elements.size(); ++i) {
        at_vertices_[elements[i]] += values_[i / corners];
        ++count[elements[i]];
    }
    for (size_t v = 0; v < vertices; ++v) at_vertices_[v] /= static_cast<float>(std::max(1, count[v]));
}

// The skin in place of the solid's own boundary.
void SceneView::put_on(const scenes::Skin& skin) {
    std::vector<float> values(at_vertices_.empty() ? 0 : skin.corners.size() / 4);
    for (size_t i = 0; i < skin.corners.size() && !values.empty(); ++i)
        values[i / 4] += skin.weights[i] * at_vertices_[skin.corners[i]];
    surface_.points = skin_points(skin, surface_.points);
    at_vertices_ = std::move(values);
    surface_.triangles = skin.triangles;
    surface_.normals = normals_of(surface_.points, surface_.triangles);
}

void SceneView::add_surface(render::DrawList& list, const Paint& paint) const {
    const auto colour = [&](uint32_t v) {
        return paint.most > 0 ? TensionScale::ramp(at_vertices_[v] / static_cast<float>(paint.most)) : paint.plain;
    };
    surface_.add(list, colour, paint.both_sides);
}

void SceneView::add_softs(render::DrawList& list) {
    const auto paint_of = [](const scenes::SoftLook& look, uint32_t usual, bool both_sides) {
        const bool measured = look.colours != scenes::SoftColours::plain;
        return Paint{from_srgb(look.paint != 0 ? look.paint : usual), both_sides, measured ? look.most : 0};
    };
    for (size_t i = 0; i < scene_.cloths.size(); ++i) {
        const Paint paint = paint_of(scene_.cloths[i].look, kClothPaint, true);
        surface_.read(world_.cloths[i]);
        if (paint.most > 0) {
            scenes::check(read_all(taut_cloth_get_strains, world_.cloths[i], values_), "reading strains");
            spread_over_vertices(surface_.triangles, 3, surface_.points.size());
        }
        add_surface(list, paint);
    }
    for (size_t i = 0; i < scene_.solids.size(); ++i) {
        const scenes::Solid& solid = scene_.solids[i];
        Paint paint = paint_of(solid.look, kSolidPaint, false);
        if (solid.cells.empty()) paint.most = 0;  // what samples tell is nobody's cells
        surface_.read(world_.solids[i]);
        at_vertices_.clear();
        if (paint.most > 0) {
            scenes::check(read_all(taut_solid_get_stresses, world_.solids[i], values_), "reading stresses");
            spread_over_vertices(solid.cells, solid.def.corners, surface_.points.size());
        }
        if (!solid.skin.triangles.empty()) put_on(solid.skin);
        add_surface(list, paint);
    }
}

void SceneView::add_curves(render::DrawList& list) const {
    for (const scenes::Curve& curve : scene_.curves)
        for (size_t i = 1; i < curve.points.size(); ++i) {
            const auto radius = static_cast<float>(curve.radius);
            list.instances.push_back(rod(vec(curve.points[i - 1]), vec(curve.points[i]), radius, kDecoration));
            list.instances.push_back(ball(vec(curve.points[i]), radius, kDecoration, 0.2f));
        }
}

// Length of a needle for a newton [m/N].
float SceneView::needle_scale() const {
    std::vector<float> masses;
    for (taut_body body : world_.bodies) {
        float mass = 0;
        taut_vec3 centre{};
        taut_sym3 inertia{};
        if (taut_body_get_mass(body, &mass, &centre, &inertia) == TAUT_OK && mass > 0) masses.push_back(mass);
    }
    if (masses.empty()) return 0;
    const auto middle = masses.begin() + static_cast<ptrdiff_t>(masses.size() / 2);
    std::nth_element(masses.begin(), middle, masses.end());
    const taut_vec3 g = scene_.world.gravity;
    const float weight = *middle * std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z);
    return weight > 0 ? kNeedle / weight : 0;
}

void SceneView::add_contacts(render::DrawList& list) {
    const float scale = needle_scale();
    const float substep = scene_.world.time_step / static_cast<float>(scene_.world.substeps);  // of the impulses told
    uint32_t count = 0;
    taut_result result =
        taut_world_get_contacts(world_.world, contacts_.data(), static_cast<uint32_t>(contacts_.size()), &count);
    if (result == TAUT_TOO_SMALL) {
        contacts_.resize(count);
        result = taut_world_get_contacts(world_.world, contacts_.data(), count, &count);
    }
    scenes::check(result, "reading the contacts");
    for (uint32_t i = 0; i < count; ++i) {
        const taut_contact& contact = contacts_[i];
        Vec3 at = vec(contact.position), normal = {contact.normal.x, contact.normal.y, contact.normal.z};
        Instance point = ball(at, kContactRadius, kContact, 0);
        const float length = std::min(scale * contact.normal_impulse / substep, kLongestNeedle);
        Instance needle = rod(at, at + normal * length, 0.3f * kContactRadius, kNormal);
        point.mesh = render::kMeshDot;
        needle.mesh = render::kMeshBox;
        point.pass = needle.pass = render::Pass::overlay;
        list.instances.push_back(point);
        list.instances.push_back(needle);
    }
}

}  // namespace demo
