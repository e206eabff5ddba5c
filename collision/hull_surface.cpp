// From a closed surface of small polygons to a hull: coplanar faces merged, planes, edges with their two faces.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "collision/hull.h"

namespace taut::collision {
namespace {

struct Plane {
    Vec3 normal = Vec3::Zero();
    double offset = 0;
    double area = 0;
};

// Newell's method: half the sum of cross products about the first corner is the area vector.
Plane plane_of(const std::vector<Vec3f>& points, const std::vector<int>& loop) {
    const Vec3 first = points[size_t(loop[0])].cast<double>();
    Vec3 area = Vec3::Zero();
    Vec3 mean = first;
    for (size_t i = 1; i < loop.size(); ++i) {
        const Vec3 here = points[size_t(loop[i])].cast<double>();
        mean += here;
        area += (points[size_t(loop[i - 1])].cast<double>() - first).cross(here - first);
    }
    mean /= double(loop.size());
    Plane plane;
    plane.area = 0.5 * area.norm();
    if (plane.area > 0) plane.normal = area.normalized();
    plane.offset = plane.normal.dot(mean);
    return plane;
}

// Which face has the edge i -> j; -1 for none.
class Adjacency {
public:
    Adjacency(size_t points, const Loops& loops) : points_(points), face_(points * points, -1) {
        for (size_t f = 0; f < loops.size(); ++f) {
            for (size_t i = 0; i < loops[f].size(); ++i) {
                face_[size_t(loops[f][i]) * points_ + size_t(loops[f][(i + 1) % loops[f].size()])] = int(f);
            }
        }
    }
    int face(int from, int to) const { return face_[size_t(from) * points_ + size_t(to)]; }

private:
    size_t points_;
    std::vector<int> face_;
};

// Grows groups from the largest faces outwards over neighbours that lie in the first face's plane, so that
// errors do not add up along the way. Slivers between two faces go with the larger, whatever their normals are.
// Returns the group of each face.
std::vector<int> group_coplanar(const std::vector<Vec3f>& points, const Loops& loops, const Adjacency& adjacency,
                                double tolerance, int& groups) {
    std::vector<Plane> planes;
    for (const auto& loop : loops) planes.push_back(plane_of(points, loop));
    std::vector<int> order(loops.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) {
        const double a = planes[size_t(i)].area;
        const double b = planes[size_t(j)].area;
        return a != b ? a > b : loops[size_t(i)] < loops[size_t(j)];
    });
    std::vector<int> group(loops.size(), -1);
    groups = 0;
    for (const int seed : order) {
        if (group[size_t(seed)] >= 0) continue;
        const Plane& plane = planes[size_t(seed)];
        group[size_t(seed)] = groups;
        std::vector<int> open = {seed};
        while (!open.empty()) {
            const auto& loop = loops[size_t(open.back())];
            open.pop_back();
            for (size_t i = 0; i < loop.size(); ++i) {
                const int next = adjacency.face(loop[(i + 1) % loop.size()], loop[i]);
                if (next < 0 || group[size_t(next)] >= 0) continue;
                const auto in_plane = [&](int corner) {
                    const Vec3 p = points[size_t(corner)].cast<double>();
                    return std::fabs(plane.normal.dot(p) - plane.offset) <= tolerance;
                };
                if (!std::all_of(loops[size_t(next)].begin(), loops[size_t(next)].end(), in_plane)) continue;
                group[size_t(next)] = groups;
                open.push_back(next);
            }
        }
        ++groups;
    }
    return group;
}

// The outline of each group; false if one is not a single ring or the result is not closed.
bool outlines(const Loops& loops, const Adjacency& adjacency, const std::vector<int>& group, int groups,
              size_t point_count, Loops& merged) {
    std::vector<std::vector<std::pair<int, int>>> border{size_t(groups)};  // edges from -> to of each group
    for (size_t f = 0; f < loops.size(); ++f) {
        const auto& loop = loops[f];
        for (size_t i = 0; i < loop.size(); ++i) {
            const int from = loop[i];
            const int to = loop[(i + 1) % loop.size()];
            const int twin = adjacency.face(to, from);
            if (twin < 0) return false;
            if (group[size_t(twin)] != group[f]) border[size_t(group[f])].push_back({from, to});
        }
    }
    merged.assign(size_t(groups), {});
    std::vector<int> faces_at(point_count, 0);
    for (size_t g = 0; g < border.size(); ++g) {
        auto& ring = border[g];
        std::sort(ring.begin(), ring.end());
        if (ring.empty()) return false;
        int at = ring.front().first;
        do {
            const auto edge = std::lower_bound(ring.begin(), ring.end(), std::make_pair(at, -1));
            if (edge == ring.end() || edge->first != at || merged[g].size() >= ring.size()) return false;
            merged[g].push_back(at);
            at = edge->second;
        } while (at != ring.front().first);
        if (merged[g].size() != ring.size()) return false;
        for (const int corner : merged[g]) ++faces_at[size_t(corner)];
    }
    // A corner of two faces only lies on the straight edge between them.
    for (auto& loop : merged) {
        std::erase_if(loop, [&](int corner) { return faces_at[size_t(corner)] < 3; });
        if (loop.size() < 3) return false;
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    std::sort(merged.begin(), merged.end());
    return true;
}

void add_vertices(const std::vector<Vec3f>& points, Loops& loops, Hull& hull) {
    std::vector<int> index(points.size(), -1);
    for (const auto& loop : loops) {
        for (const int corner : loop) index[size_t(corner)] = 0;
    }
    for (size_t i = 0; i < points.size(); ++i) {
        if (index[i] < 0) continue;
        index[i] = int(hull.vertices.size());
        hull.vertices.push_back(points[i]);
    }
    for (auto& loop : loops) {
        for (int& corner : loop) corner = index[size_t(corner)];
    }
    Vec3 sum = Vec3::Zero();
    for (const Vec3f& v : hull.vertices) sum += v.cast<double>();
    hull.centre = (sum / double(hull.vertices.size())).cast<float>();
}

// The plane touches the hull's highest vertex, so that no vertex is ever outside a face.
void add_face(const std::vector<int>& loop, Hull& hull) {
    const Plane plane = plane_of(hull.vertices, loop);
    Face face;
    face.normal = plane.normal.cast<float>().normalized();
    face.offset = -1e30f;
    for (const Vec3f& v : hull.vertices) face.offset = std::max(face.offset, face.normal.dot(v));
    const Vec3f along = hull.vertices[size_t(loop[1])] - hull.vertices[size_t(loop[0])];
    face.u = (along - face.normal * face.normal.dot(along)).normalized();
    face.v = face.normal.cross(face.u);
    face.first = uint16_t(hull.loops.size());
    face.count = uint16_t(loop.size());
    for (size_t i = 0; i < loop.size(); ++i) {
        const Vec3f& from = hull.vertices[size_t(loop[i])];
        const Vec3f step = hull.vertices[size_t(loop[(i + 1) % loop.size()])] - from;
        // Counter-clockwise: the outward side of the step (x, y) is (y, -x).
        const Eigen::Vector2f out = Eigen::Vector2f(face.v.dot(step), -face.u.dot(step)).normalized();
        hull.loops.push_back(uint8_t(loop[i]));
        hull.sides.push_back({out.x(), out.y(), out.x() * face.u.dot(from) + out.y() * face.v.dot(from)});
    }
    hull.faces.push_back(face);
}

// So many numbers of each thing, which number(thing, column) tells.
template <class Number>
Columns fill_columns(size_t things, uint32_t numbers, std::vector<FloatLanes>& lanes, Number&& number) {
    if (things == 0) return {};
    const uint32_t length = column_length(things), blocks = length / kLanes;
    lanes.resize(numbers * blocks);
    for (uint32_t c = 0; c < numbers; ++c) {
        for (uint32_t i = 0; i < length; ++i) {
            const size_t thing = std::min(size_t(i), things - 1);
            lanes[c * blocks + i / kLanes].of[i % kLanes] = number(thing, int(c));
        }
    }
    return {lanes[0].of, length};
}

bool add_edges(const Loops& loops, Hull& hull) {
    const Adjacency adjacency(hull.vertices.size(), loops);
    const int count = int(hull.vertices.size());
    for (int from = 0; from < count; ++from) {
        for (int to = from + 1; to < count; ++to) {
            const int left = adjacency.face(from, to);
            const int right = adjacency.face(to, from);
            if ((left < 0) != (right < 0)) return false;
            if (left >= 0) hull.edges.push_back({uint8_t(from), uint8_t(to), uint8_t(left), uint8_t(right)});
        }
    }
    return hull.vertices.size() + hull.faces.size() == hull.edges.size() + 2;  // Euler
}

}  // namespace

void Hull::lay_out() {
    const auto coordinate = [&](size_t vertex, int i) { return vertices[vertex][i]; };
    const auto of_plane = [&](size_t face, int i) { return i < 3 ? faces[face].normal[i] : faces[face].offset; };
    polytope = {vertices,
                faces,
                loops,
                sides,
                edges,
                fans,
                around,
                fill_columns(vertices.size(), 3, corners, coordinate),
                fill_columns(faces.size(), 4, planes, of_plane),
                centre,
                inner_radius,
                outer_radius};
}

std::shared_ptr<const Hull> hull_of_surface(const std::vector<Vec3f>& points, const Loops& surface, double tolerance) {
    const Adjacency adjacency(points.size(), surface);
    int groups = 0;
    const std::vector<int> group = group_coplanar(points, surface, adjacency, tolerance, groups);
    Loops loops;
    if (!outlines(surface, adjacency, group, groups, points.size(), loops)) return nullptr;
    auto hull = std::make_shared<Hull>();
    add_vertices(points, loops, *hull);
    for (const auto& loop : loops) add_face(loop, *hull);
    if (!add_edges(loops, *hull)) return nullptr;
    hull->fans.resize(hull->vertices.size());
    hull->around.resize(2 * hull->edges.size());
    find_fans(hull->edges, hull->fans, hull->around);
    hull->inner_radius = 1e30f;
    for (const Face& face : hull->faces) {
        if (!(std::fabs(face.normal.squaredNorm() - 1) < 1e-3f)) return nullptr;
        hull->inner_radius = std::min(hull->inner_radius, face.offset - face.normal.dot(hull->centre));
    }
    for (const Vec3f& v : hull->vertices) hull->outer_radius = std::max(hull->outer_radius, (v - hull->centre).norm());
    hull->lay_out();
    return hull;
}

}  // namespace taut::collision
