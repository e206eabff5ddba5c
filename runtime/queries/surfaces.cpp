#include "queries/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/soft_points.h"

namespace taut {
namespace {

// A triangle as it is now, relative to where it is asked from.
struct Corners {
    Vec3 x[3];

    Vec3 low() const { return x[0].cwiseMin(x[1]).cwiseMin(x[2]); }
    Vec3 high() const { return x[0].cwiseMax(x[1]).cwiseMax(x[2]); }
    Vec3 at(const double (&weight)[3]) const { return weight[0] * x[0] + weight[1] * x[1] + weight[2] * x[2]; }
    // Squared distance of its box from the origin [m^2].
    double box_distance() const { return low().cwiseMax(-high()).cwiseMax(0).squaredNorm(); }
};

struct Triangle {
    uint32_t soft, index;
};

// act(Triangle, Corners) for each, by slots; the filter is asked by the act.
template <class Act>
void for_triangles(const World& world, const Vec3& from, Act&& act) {
    for (uint32_t s = 0; s < world.softs.record.size(); ++s) {
        const Soft& soft = world.softs.record[s];
        for (uint32_t t = 0; t < soft.triangles(); ++t) {
            Corners corners;
            for (size_t k = 0; k < 3; ++k)
                corners.x[k] = vertex_of(world, soft, soft.triangle[3 * size_t{t} + k]) - from;
            act(Triangle{s, t}, corners);
        }
    }
}

bool sees(const Sight& sight, const Triangle& of) {
    const Soft& soft = sight.world().softs.record[of.soft];
    const uint32_t* corner = &soft.triangle[3 * size_t{of.index}];
    return std::any_of(corner, corner + 3, [&](uint32_t v) { return sight.sees_node(soft.node[v]); });
}

taut_surface_hit hit_of(const World& world, const Vec3& from, const Triangle& of, const Corners& corners,
                        const double (&weight)[3], float distance) {
    taut_surface_hit out{};
    if (world.softs.record[of.soft].kind == SoftKind::cloth)
        out.cloth = world.cloth_handle(of.soft);
    else
        out.solid = world.solid_handle(of.soft);
    const Vec3 point = from + corners.at(weight);
    const Vec3 normal = (corners.x[1] - corners.x[0]).cross(corners.x[2] - corners.x[0]).normalized();
    out.point = {point.x(), point.y(), point.z()};
    out.normal = {static_cast<float>(normal.x()), static_cast<float>(normal.y()), static_cast<float>(normal.z())};
    out.triangle = of.index;
    for (int k = 0; k < 3; ++k) out.weights[k] = static_cast<float>(weight[k]);
    out.distance = distance;
    return out;
}

// Where a ray from the origin meets a triangle: volumes of the tetrahedra that it makes with the edges, which of two
// triangles at a common edge differ in their sign alone, so that none goes between them. distance: in lengths of it.
bool meets(const Corners& of, const Vec3& along, double (&weight)[3], double& distance) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        weight[k] = along.dot(of.x[(k + 1) % 3].cross(of.x[(k + 2) % 3]));
        sum += weight[k];
    }
    if (!(sum != 0)) return false;
    for (double& each : weight) {
        if (each * sum < 0) return false;
        each = std::abs(each / sum);
    }
    distance = of.at(weight).dot(along) / along.squaredNorm();
    return distance >= 0 && distance <= 1;
}

}  // namespace

taut_surface_hit first_surface(const Sight& sight, const RayQuery& query) {
    taut_surface_hit best{};
    const double length = query.along.norm();
    bool found = false;
    Vec3 low = query.along.cwiseMin(0), high = query.along.cwiseMax(0);
    for_triangles(sight.world(), query.from, [&](const Triangle& triangle, const Corners& corners) {
        if ((corners.low().array() > high.array()).any() || (corners.high().array() < low.array()).any()) return;
        double weight[3], share;
        if (!meets(corners, query.along, weight, share)) return;
        const auto distance = static_cast<float>(share * length);
        if ((found && !(distance < best.distance)) || !sees(sight, triangle)) return;
        best = hit_of(sight.world(), query.from, triangle, corners, weight, distance);
        found = true;
    });
    return best;
}

taut_surface_hit nearest_surface(const Sight& sight, const Vec3& point, double within) {
    taut_surface_hit best{};
    bool found = false;
    for_triangles(sight.world(), point, [&](const Triangle& triangle, const Corners& corners) {
        const double limit = found ? static_cast<double>(best.distance) : within;
        if (corners.box_distance() > limit * limit) return;
        double weight[3];
        nearest_of_triangle(corners.x, Vec3::Zero(), weight);
        const auto distance = static_cast<float>(corners.at(weight).norm());
        if (!(distance <= within) || (found && !(distance < best.distance)) || !sees(sight, triangle)) return;
        best = hit_of(sight.world(), point, triangle, corners, weight, distance);
        found = true;
    });
    return best;
}

void all_surfaces(const Sight& sight, const Vec3& point, double within, Sink<taut_surface_hit>& sink) {
    for_triangles(sight.world(), point, [&](const Triangle& triangle, const Corners& corners) {
        if (corners.box_distance() > within * within) return;
        double weight[3];
        nearest_of_triangle(corners.x, Vec3::Zero(), weight);
        const auto distance = static_cast<float>(corners.at(weight).norm());
        if (distance <= within && sees(sight, triangle))
            sink.take(hit_of(sight.world(), point, triangle, corners, weight, distance));
    });
}

}  // namespace taut
