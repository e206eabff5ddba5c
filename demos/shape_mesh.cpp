#include "shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/taut_world.h"

namespace demo {

namespace {

using render::Colour;
using render::from_srgb;
using render::Vec3;
using scenes::Look;
using scenes::ShapeKind;

const Colour kCrates[] = {from_srgb(0xE4572E), from_srgb(0xF3A712), from_srgb(0xF2E3BC),
                          from_srgb(0x4B9C8E), from_srgb(0x2E6F95), from_srgb(0x8E5572)};
const Colour kBricks[] = {from_srgb(0xC4553B), from_srgb(0xD6704A), from_srgb(0xB5473A), from_srgb(0xE08E5A)};
const Colour kSteel = from_srgb(0x3B424C), kLinkGrey = from_srgb(0xA9B4C0), kStone = from_srgb(0xB9B4A7);
const Colour kWood[] = {from_srgb(0xB98A58), from_srgb(0xA97A4C), from_srgb(0xC79A68)};
const Colour kSand[] = {from_srgb(0xD9B26F), from_srgb(0xC79A55), from_srgb(0xE6C88F), from_srgb(0xB78845)};
const Colour kCloth[] = {from_srgb(0x35618E), from_srgb(0x3D6B99)};
const Colour kPaint = from_srgb(0xE0B03A), kSkin = from_srgb(0xE3A983);
const Colour kWall = from_srgb(0x8FA3B5), kPin = from_srgb(0x2A2F36);

template <size_t N>
Colour pick(const Colour (&colours)[N], size_t index) {
    return colours[(index * 2654435761u >> 7) % N];
}

constexpr int kSides = 32;

std::vector<render::Vertex> cone_mesh(const scenes::Shape& shape) {
    const float r = shape.radius, h = shape.half_length, side = std::hypot(2 * h, r);
    const float out = 2 * h / side, up = r / side;
    return render::turned_mesh({{0, -h, 0, -1}, {r, -h, 0, -1}, {r, -h, out, up}, {0, h, out, up}}, kSides);
}

// Arcs of two balls with the line that touches both; its normal's slope is the difference of the radii over the length.
std::vector<render::Vertex> tapered_capsule_mesh(const scenes::Shape& shape) {
    constexpr int kArc = 12;
    const float h = shape.half_length, slope = (shape.radius - shape.top_radius) / (2 * h);
    const float low = -0.5f * std::numbers::pi_v<float>, middle = std::asin(slope), high = -low;
    std::vector<render::ProfilePoint> profile;
    auto arc = [&](float from, float to, float radius, float centre) {
        for (int i = 0; i <= kArc; ++i) {
            const float angle = from + (to - from) * static_cast<float>(i) / kArc;
            const float c = std::cos(angle), s = std::sin(angle);
            profile.push_back({radius * c, centre + radius * s, c, s});
        }
    };
    arc(low, middle, shape.radius, -h);
    arc(middle, high, shape.top_radius, h);
    return render::turned_mesh(profile, kSides);
}

std::vector<render::Vertex> triangles_of(taut_shape handle) {
    uint32_t count = 0;
    taut_shape_get_triangles(handle, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
    std::vector<taut_vec3> triangles(count);
    scenes::check(taut_shape_get_triangles(handle, triangles.data(), count, &count), "reading a shape's triangles");
    std::vector<Vec3> points;
    for (const taut_vec3& p : triangles) points.push_back({p.x, p.y, p.z});
    return render::flat_mesh(points);
}

std::vector<render::Vertex> scaled(std::vector<render::Vertex> mesh, float x, float y, float z) {
    for (render::Vertex& vertex : mesh)
        vertex.position = {x * vertex.position.x, y * vertex.position.y, z * vertex.position.z};
    return mesh;
}

std::vector<render::Vertex> plane_mesh(const taut_vec3& normal, float half) {
    const render::Quat turn = render::from_y_to(render::normalised({normal.x, normal.y, normal.z}));
    std::vector<Vec3> points;
    for (const Vec3& p : {Vec3{-half, 0, -half}, Vec3{-half, 0, half}, Vec3{half, 0, half}, Vec3{-half, 0, -half},
                          Vec3{half, 0, half}, Vec3{half, 0, -half}})
        points.push_back(rotate(turn, p));
    return render::flat_mesh(points);
}

}  // namespace

Colour colour_of(Look look, size_t index) {
    switch (look) {
        case Look::brick:
            return pick(kBricks, index);
        case Look::steel:
            return kSteel;
        case Look::link:
            return kLinkGrey;
        case Look::particle:
            return kPin;
        case Look::stone:
            return kStone;
        case Look::wall:
            return kWall;
        case Look::wood:
            return pick(kWood, index);
        case Look::paint:
            return kPaint;
        case Look::skin:
            return kSkin;
        case Look::cloth:
            return pick(kCloth, index);
        case Look::sand:
            return pick(kSand, index);
        case Look::crate:
        case Look::hidden:
        case Look::ground:
            break;
    }
    return pick(kCrates, index);
}

std::vector<render::Vertex> own_mesh(const scenes::Shape& shape, taut_shape handle) {
    switch (shape.kind) {
        case ShapeKind::cone:
            return cone_mesh(shape);
        case ShapeKind::tapered_capsule:
            return tapered_capsule_mesh(shape);
        case ShapeKind::hull:
        case ShapeKind::scaled_hull:
        case ShapeKind::mesh:
        case ShapeKind::height_field:
            return triangles_of(handle);
        default:
            return {};
    }
}

std::vector<render::Vertex> shape_mesh(const scenes::Shape& shape, taut_shape handle, float plane_half_width) {
    constexpr int kRings = 12;
    const float r = shape.radius;
    switch (shape.kind) {
        case ShapeKind::plane:
            return plane_mesh(shape.normal, plane_half_width);
        case ShapeKind::box:
            return scaled(render::box_mesh(), shape.half_extents.x, shape.half_extents.y, shape.half_extents.z);
        case ShapeKind::sphere:
            return scaled(render::sphere_mesh(kRings), r, r, r);
        case ShapeKind::cylinder:
            return scaled(render::cylinder_mesh(kSides), r, shape.half_length, r);
        case ShapeKind::capsule: {
            scenes::Shape alike = shape;
            alike.top_radius = r;
            return tapered_capsule_mesh(alike);
        }
        default:
            return own_mesh(shape, handle);
    }
}

std::vector<taut_pos> skin_points(const scenes::Skin& skin, const std::vector<taut_pos>& vertices) {
    std::vector<taut_pos> points(skin.corners.size() / 4);
    for (size_t i = 0; i < skin.corners.size(); ++i) {
        const taut_pos& from = vertices[skin.corners[i]];
        const auto weight = static_cast<double>(skin.weights[i]);
        taut_pos& p = points[i / 4];
        p = {p.x + weight * from.x, p.y + weight * from.y, p.z + weight * from.z};
    }
    return points;
}

std::vector<taut_vec3> normals_of(const std::vector<taut_pos>& points, const std::vector<uint32_t>& triangles) {
    const auto at = [&](uint32_t i) {
        const taut_pos& p = points[i];
        return Vec3{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    };
    std::vector<Vec3> sum(points.size());  // of areas
    for (size_t t = 0; t < triangles.size(); t += 3) {
        const Vec3 a = at(triangles[t]);
        const Vec3 area = cross(at(triangles[t + 1]) - a, at(triangles[t + 2]) - a);
        for (size_t k = 0; k < 3; ++k) sum[triangles[t + k]] = sum[triangles[t + k]] + area;
    }
    std::vector<taut_vec3> normals;
    for (const Vec3& n : sum) {
        const Vec3 unit = length(n) > 0 ? normalised(n) : Vec3{0, 1, 0};
        normals.push_back({unit.x, unit.y, unit.z});
    }
    return normals;
}

}  // namespace demo
