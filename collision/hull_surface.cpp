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
Plane plane_of(std::span<const Vec3f> points, const Loop& loop) {
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
    Adjacency(size_t points, const Loops& loops, Memory& memory) : points_(points), face_(points * points, -1, memory) {
        for (size_t f = 0; f < loops.size(); ++f) {
            for (size_t i = 0; i < loops[f].size(); ++i) {
                face_[size_t(loops[f][i]) * points_ + size_t(loops[f][(i + 1) % loops[f].size()])] = int(f);
            }
        }
    }
    int face(int from, int to) const { return face_[size_t(from) * points_ + size_t(to)]; }

private:
    size_t points_;
    Array<int> face_;
};

// Polygons that become one face.
struct Group {
    explicit Group(Memory& memory) : members(memory), outline(memory) {}

    Array<int> members;
    Loop outline;
    double flatness = 0;  // furthest corner off the first polygon's plane [m]
};

// Gathers polygons to faces, from the largest outwards over neighbours that lie in the first one's plane, so that
// errors do not add up along the way. Slivers between two faces go with either, whatever their normals are. A face is
// convex, within the tolerance that its polygons lie in its plane: what would make it otherwise stays out.
class Merging {
public:
    Merging(std::span<const Vec3f> points, const Loops& loops, double tolerance, Memory& memory)
        : points_(points),
          loops_(loops),
          adjacency_(points.size(), loops, memory),
          tolerance_(tolerance),
          memory_(memory),
          planes_(memory),
          taken_(memory) {
        for (const auto& loop : loops) planes_.push_back(plane_of(points, loop));
    }
    // The outline of each face; false if one is not a single ring or the surface is not closed.
    bool run(Loops& outlines);

private:
    Array<int> largest_first() const;
    double off(int polygon, const Plane& plane) const;
    Group grow(int seed, double tolerance) const;
    bool find_outline(Group& group) const;
    bool is_convex(const Group& group) const;

    const std::span<const Vec3f> points_;
    const Loops& loops_;
    const Adjacency adjacency_;
    const double tolerance_;
    Memory& memory_;
    Array<Plane> planes_;
    Array<char> taken_;
};

Array<int> Merging::largest_first() const {
    Array<int> order(loops_.size(), 0, memory_);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int i, int j) {
        const double a = planes_[size_t(i)].area;
        const double b = planes_[size_t(j)].area;
        return a != b ? a > b : loops_[size_t(i)] < loops_[size_t(j)];
    });
    return order;
}

// How far a corner of the polygon lies off the plane at most [m].
double Merging::off(int polygon, const Plane& plane) const {
    double most = 0;
    for (const int corner : loops_[size_t(polygon)])
        most = std::max(most, std::fabs(plane.normal.dot(points_[size_t(corner)].cast<double>()) - plane.offset));
    return most;
}

// Of polygons that are free, those around the seed that lie off its plane by less than tolerance [m].
Group Merging::grow(int seed, double tolerance) const {
    Group group(memory_);
    group.members.push_back(seed);
    for (size_t next = 0; next < group.members.size(); ++next) {
        const auto& loop = loops_[size_t(group.members[next])];
        for (size_t i = 0; i < loop.size(); ++i) {
            const int other = adjacency_.face(loop[(i + 1) % loop.size()], loop[i]);
            if (other < 0 || taken_[size_t(other)]) continue;
            if (std::find(group.members.begin(), group.members.end(), other) != group.members.end()) continue;
            const double distance = off(other, planes_[size_t(seed)]);
            if (!(distance < tolerance)) continue;
            group.flatness = std::max(group.flatness, distance);
            group.members.push_back(other);
        }
    }
    return group;
}

// False if it is not a single ring.
bool Merging::find_outline(Group& group) const {
    Array<std::pair<int, int>> border(memory_);  // edges from -> to
    for (const int member : group.members) {
        const auto& loop = loops_[size_t(member)];
        for (size_t i = 0; i < loop.size(); ++i) {
            const int from = loop[i], to = loop[(i + 1) % loop.size()];
            const int twin = adjacency_.face(to, from);
            if (twin < 0) return false;
            if (std::find(group.members.begin(), group.members.end(), twin) == group.members.end())
                border.push_back({from, to});
        }
    }
    if (border.empty()) return false;
    std::sort(border.begin(), border.end());
    group.outline.clear();
    int at = border.front().first;
    do {
        const auto edge = std::lower_bound(border.begin(), border.end(), std::make_pair(at, -1));
        if (edge == border.end() || edge->first != at || group.outline.size() >= border.size()) return false;
        group.outline.push_back(at);
        at = edge->second;
    } while (at != border.front().first);
    return group.outline.size() == border.size();
}

// Whether each corner lies inside of each side, but for the tolerance.
bool Merging::is_convex(const Group& group) const {
    const Vec3& normal = planes_[size_t(group.members[0])].normal;
    const auto& ring = group.outline;
    for (size_t i = 0; i < ring.size(); ++i) {
        const Vec3 from = points_[size_t(ring[i])].cast<double>();
        const Vec3 step = points_[size_t(ring[(i + 1) % ring.size()])].cast<double>() - from;
        const Vec3 out = step.cross(normal).normalized();
        for (const int corner : ring)
            if (out.dot(points_[size_t(corner)].cast<double>() - from) > tolerance_) return false;
    }
    return true;
}

bool Merging::run(Loops& outlines) {
    taken_.assign(loops_.size(), 0);
    outlines.clear();
    for (const int seed : largest_first()) {
        if (taken_[size_t(seed)]) continue;
        Group group = grow(seed, tolerance_);
        while (!find_outline(group) || !is_convex(group)) {
            if (group.members.size() == 1) break;
            group = grow(seed, group.flatness);  // without what is furthest off
        }
        if (group.outline.empty()) return false;
        for (const int member : group.members) taken_[size_t(member)] = 1;
        outlines.push_back(group.outline);
    }
    Array<int> faces_at(points_.size(), 0, memory_);
    for (const auto& loop : outlines)
        for (const int corner : loop) ++faces_at[size_t(corner)];
    // A corner of two faces only lies on the straight edge between them.
    for (auto& loop : outlines) {
        std::erase_if(loop, [&](int corner) { return faces_at[size_t(corner)] < 3; });
        if (loop.size() < 3) return false;
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
    }
    std::sort(outlines.begin(), outlines.end());
    return true;
}

// A hull with the memory that its view is of.
struct StoredHull : Hull {
    explicit StoredHull(Memory& memory)
        : vertex(memory),
          face(memory),
          corner(memory),
          side(memory),
          edge(memory),
          fan(memory),
          face_around(memory),
          corner_lanes(memory),
          plane_lanes(memory) {}

    void lay_out();

    Array<Vec3f> vertex;
    Array<Face> face;
    Array<uint8_t> corner;
    Array<Side> side;
    Array<Edge> edge;
    Array<Fan> fan;
    Array<uint8_t> face_around;
    Array<FloatLanes> corner_lanes, plane_lanes;
};

void StoredHull::lay_out() {
    static_cast<Polytope&>(*this) = {vertex,      face, corner, side,   edge,         fan,
                                     face_around, {},   {},     centre, inner_radius, outer_radius};
    corner_lanes.resize(3 * column_length(vertex.size()) / kLanes);
    plane_lanes.resize(4 * column_length(face.size()) / kLanes);
    corners = fill_columns(vertex.size(), 3, corner_lanes, [&](size_t v, int i) { return vertex[v][i]; });
    planes = fill_columns(face.size(), 4, plane_lanes,
                          [&](size_t f, int i) { return i < 3 ? face[f].normal[i] : face[f].offset; });
}

void add_vertices(std::span<const Vec3f> points, Loops& loops, StoredHull& hull, Memory& memory) {
    Array<int> index(points.size(), -1, memory);
    for (const auto& loop : loops) {
        for (const int corner : loop) index[size_t(corner)] = 0;
    }
    for (size_t i = 0; i < points.size(); ++i) {
        if (index[i] < 0) continue;
        index[i] = int(hull.vertex.size());
        hull.vertex.push_back(points[i]);
    }
    for (auto& loop : loops) {
        for (int& corner : loop) corner = index[size_t(corner)];
    }
    Vec3 sum = Vec3::Zero();
    for (const Vec3f& v : hull.vertex) sum += v.cast<double>();
    hull.centre = (sum / double(hull.vertex.size())).cast<float>();
}

// The plane touches the hull's highest vertex, so that no vertex is ever outside a face.
void add_face(const Loop& loop, StoredHull& hull) {
    const Plane plane = plane_of(hull.vertex, loop);
    Face face;
    face.normal = plane.normal.cast<float>().normalized();
    face.offset = -1e30f;
    for (const Vec3f& v : hull.vertex) face.offset = std::max(face.offset, face.normal.dot(v));
    const Vec3f along = hull.vertex[size_t(loop[1])] - hull.vertex[size_t(loop[0])];
    face.u = (along - face.normal * face.normal.dot(along)).normalized();
    face.v = face.normal.cross(face.u);
    face.first = uint16_t(hull.corner.size());
    face.count = uint16_t(loop.size());
    for (size_t i = 0; i < loop.size(); ++i) {
        const Vec3f& from = hull.vertex[size_t(loop[i])];
        const Vec3f step = hull.vertex[size_t(loop[(i + 1) % loop.size()])] - from;
        // Counter-clockwise: the outward side of the step (x, y) is (y, -x).
        const Eigen::Vector2f out = Eigen::Vector2f(face.v.dot(step), -face.u.dot(step)).normalized();
        hull.corner.push_back(uint8_t(loop[i]));
        hull.side.push_back({out.x(), out.y(), out.x() * face.u.dot(from) + out.y() * face.v.dot(from)});
    }
    hull.face.push_back(face);
}

// Whether each face looks away from the middle.
bool looks_outward(const Loops& loops, const StoredHull& hull) {
    return std::all_of(loops.begin(), loops.end(), [&](const Loop& loop) {
        const Plane plane = plane_of(hull.vertex, loop);
        return plane.offset > plane.normal.dot(hull.centre.cast<double>());
    });
}

bool add_edges(const Loops& loops, StoredHull& hull, Memory& memory) {
    const Adjacency adjacency(hull.vertex.size(), loops, memory);
    const int count = int(hull.vertex.size());
    for (int from = 0; from < count; ++from) {
        for (int to = from + 1; to < count; ++to) {
            const int left = adjacency.face(from, to);
            const int right = adjacency.face(to, from);
            if ((left < 0) != (right < 0)) return false;
            if (left >= 0) hull.edge.push_back({uint8_t(from), uint8_t(to), uint8_t(left), uint8_t(right)});
        }
    }
    return hull.vertex.size() + hull.face.size() == hull.edge.size() + 2;  // Euler
}

}  // namespace

std::shared_ptr<const Hull> hull_of_surface(std::span<const Vec3f> points, const Loops& surface, double tolerance,
                                            Memory& memory) {
    Loops loops(memory);
    if (!Merging(points, surface, tolerance, memory).run(loops)) return nullptr;
    auto hull = std::allocate_shared<StoredHull>(HostAllocator<StoredHull>(memory), memory);
    add_vertices(points, loops, *hull, memory);
    if (!looks_outward(loops, *hull)) return nullptr;
    for (const auto& loop : loops) add_face(loop, *hull);
    if (!add_edges(loops, *hull, memory)) return nullptr;
    hull->fan.resize(hull->vertex.size());
    hull->face_around.resize(2 * hull->edge.size());
    find_fans(hull->edge, hull->fan, hull->face_around);
    hull->inner_radius = 1e30f;
    for (const Face& face : hull->face) {
        if (!(std::fabs(face.normal.squaredNorm() - 1) < 1e-3f)) return nullptr;
        hull->inner_radius = std::min(hull->inner_radius, face.offset - face.normal.dot(hull->centre));
    }
    for (const Vec3f& v : hull->vertex) hull->outer_radius = std::max(hull->outer_radius, (v - hull->centre).norm());
    hull->lay_out();
    return hull;
}

}  // namespace taut::collision
