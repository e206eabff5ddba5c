#include "mesh.h"

#include <numbers>

namespace render {

namespace {

void add_quad(std::vector<Vertex>& mesh, const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
    mesh.insert(mesh.end(), {a, b, c, a, c, d});
}

Vec3 on_circle(int i, int sides) {
    float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(sides);
    return {std::cos(angle), 0, -std::sin(angle)};
}

}  // namespace

std::vector<Vertex> box_mesh() {
    std::vector<Vertex> mesh;
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; ++axis)
        for (float sign : {1.0f, -1.0f}) {
            Vec3 n = axes[axis] * sign, u = axes[(axis + 1) % 3] * sign, v = axes[(axis + 2) % 3];
            add_quad(mesh, {n - u - v, n}, {n + u - v, n}, {n + u + v, n}, {n - u + v, n});
        }
    return mesh;
}

std::vector<Vertex> sphere_mesh(int rings) {
    std::vector<Vertex> mesh;
    auto at = [&](int ring, int sector) {
        float polar = std::numbers::pi_v<float> * static_cast<float>(ring) / static_cast<float>(rings);
        Vec3 p = on_circle(sector, 2 * rings) * std::sin(polar) + Vec3{0, std::cos(polar), 0};
        return Vertex{p, p};
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int sector = 0; sector < 2 * rings; ++sector)
            add_quad(mesh, at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1));
    return mesh;
}

std::vector<Vertex> cylinder_mesh(int sides) {
    std::vector<Vertex> mesh;
    const Vec3 up = {0, 1, 0}, down = {0, -1, 0};
    for (int i = 0; i < sides; ++i) {
        Vec3 a = on_circle(i, sides), b = on_circle(i + 1, sides);
        add_quad(mesh, {a + down, a}, {b + down, b}, {b + up, b}, {a + up, a});
        mesh.insert(mesh.end(), {{up, up}, {a + up, up}, {b + up, up}});
        mesh.insert(mesh.end(), {{down, down}, {b + down, down}, {a + down, down}});
    }
    return mesh;
}

std::vector<Vertex> turned_mesh(const std::vector<ProfilePoint>& profile, int sides) {
    std::vector<Vertex> mesh;
    auto at = [&](const ProfilePoint& p, int side) {
        Vec3 out = on_circle(side, sides), up = {0, 1, 0};
        return Vertex{out * p.radius + up * p.y, out * p.normal_radius + up * p.normal_y};
    };
    for (size_t i = 0; i + 1 < profile.size(); ++i)
        for (int side = 0; side < sides; ++side)
            add_quad(mesh, at(profile[i], side), at(profile[i], side + 1), at(profile[i + 1], side + 1),
                     at(profile[i + 1], side));
    return mesh;
}

std::vector<Vertex> flat_mesh(const std::vector<Vec3>& points) {
    std::vector<Vertex> mesh;
    for (size_t i = 0; i + 2 < points.size(); i += 3) {
        Vec3 n = normalised(cross(points[i + 1] - points[i], points[i + 2] - points[i]));
        for (size_t k = 0; k < 3; ++k) mesh.push_back({points[i + k], n});
    }
    return mesh;
}

}  // namespace render
