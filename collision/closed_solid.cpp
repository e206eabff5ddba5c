#include "collision/closed_solid.h"

#include <algorithm>
#include <cmath>

#include "collision/sorting.h"
#include "collision/triangle_distance.h"

namespace taut::collision {
namespace {

constexpr double kWeld = 5e-7;  // of the largest coordinate

// How often an edge is passed from its smaller vertex to the larger one, less the other way.
struct EdgeTurn {
    uint32_t low, high;
    int turn;
};

Array<EdgeTurn> open_edges(const TriangleSoup& soup, Memory& memory) {
    Array<EdgeTurn> edges(memory);
    edges.reserve(soup.corner.size());
    for (size_t t = 0; t < soup.triangles(); ++t) {
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t from = soup.corner[3 * t + k], to = soup.corner[3 * t + (k + 1) % 3];
            edges.push_back(from < to ? EdgeTurn{from, to, 1} : EdgeTurn{to, from, -1});
        }
    }
    std::ranges::sort(
        edges, [](const EdgeTurn& a, const EdgeTurn& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    size_t kept = 0;
    for (size_t begin = 0, end; begin < edges.size(); begin = end) {
        EdgeTurn sum = edges[begin];
        for (end = begin + 1; end < edges.size() && edges[end].low == sum.low && edges[end].high == sum.high; ++end)
            sum.turn += edges[end].turn;
        if (sum.turn != 0) edges[kept++] = sum;
    }
    edges.resize(kept, {0, 0, 0});
    return edges;
}

uint32_t root_of(Array<uint32_t>& parent, uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// A fan of triangles from the middle of each rim to its edges.
void close_rims(const Array<EdgeTurn>& open, TriangleSoup& soup, Memory& memory) {
    Array<uint32_t> parent(soup.vertex.size(), 0, memory), middle(soup.vertex.size(), UINT32_MAX, memory);
    for (uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
    for (const EdgeTurn& edge : open) parent[root_of(parent, edge.high)] = root_of(parent, edge.low);
    Array<uint32_t> count(memory);
    const size_t first = soup.vertex.size();
    for (const EdgeTurn& edge : open) {
        uint32_t& at = middle[root_of(parent, edge.low)];
        if (at == UINT32_MAX) {
            at = static_cast<uint32_t>(soup.vertex.size());
            soup.vertex.push_back(Vec3::Zero());
            count.push_back(0);
        }
        const Vec3 ends = soup.vertex[edge.low] + soup.vertex[edge.high];
        soup.vertex[at] += ends;
        count[at - first] += 2;
    }
    for (size_t i = 0; i < count.size(); ++i) soup.vertex[first + i] /= count[i];
    for (const EdgeTurn& edge : open) {
        const uint32_t at = middle[root_of(parent, edge.low)];
        for (int i = 0; i < std::abs(edge.turn); ++i) {
            soup.corner.push_back(edge.turn > 0 ? edge.high : edge.low);
            soup.corner.push_back(edge.turn > 0 ? edge.low : edge.high);
            soup.corner.push_back(at);
        }
    }
}

double turn_of(const Vec3& a, const Vec3& b) { return a.y() * b.z() - a.z() * b.y(); }

}  // namespace

WeldCounts weld(std::span<const Vec3f> vertices, std::span<const uint32_t> indices, bool close, TriangleSoup& out,
                Memory& memory) {
    double largest = 0;
    for (const Vec3f& v : vertices) largest = std::max(largest, double(v.cwiseAbs().maxCoeff()));
    const double cell = kWeld * largest;
    Array<Vec3> snapped(memory);
    snapped.reserve(vertices.size());
    for (const Vec3f& v : vertices) {
        Vec3 p = v.cast<double>();
        if (cell > 0)
            for (int k = 0; k < 3; ++k) p[k] = std::floor(p[k] / cell + 0.5) * cell;
        snapped.push_back(p);
    }
    Array<uint32_t> order(vertices.size(), 0, memory), number(vertices.size(), 0, memory);
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto before = [&](uint32_t a, uint32_t b) {
        for (int k = 0; k < 3; ++k)
            if (snapped[a][k] != snapped[b][k]) return snapped[a][k] < snapped[b][k];
        return a < b;
    };
    std::ranges::sort(order, before);
    for (size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || snapped[order[i]] != snapped[order[i - 1]]) out.vertex.push_back(snapped[order[i]]);
        number[order[i]] = static_cast<uint32_t>(out.vertex.size() - 1);
    }
    WeldCounts counts;
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        const uint32_t a = number[indices[t]], b = number[indices[t + 1]], c = number[indices[t + 2]];
        if (a == b || b == c || c == a) {
            ++counts.without_area;
            continue;
        }
        for (const uint32_t corner : {a, b, c}) out.corner.push_back(corner);
    }
    const Array<EdgeTurn> open = open_edges(out, memory);
    counts.open_edges = static_cast<uint32_t>(open.size());
    if (close) close_rims(open, out, memory);
    return counts;
}

ClosedSolid::ClosedSolid(const TriangleSoup& soup, Memory& memory)
    : soup_(soup), tree_(memory), boxes_(memory), first_(memory), listed_(memory) {
    const auto box_of = [&](uint32_t t) {
        ItemBox box;
        for (size_t k = 0; k < 3; ++k) box.add(soup.at(t, k));
        return box;
    };
    const auto count = static_cast<uint32_t>(soup.triangles());
    for (uint32_t t = 0; t < count; ++t) boxes_.push_back(box_of(t));
    tree_.build(count, [&](uint32_t t) { return boxes_[t]; });
    box_ = tree_.box();
    mass_ = PolyhedronMass(0.5 * (box_.lo + box_.hi));
    for (uint32_t t = 0; t < count; ++t) mass_.add(soup.at(t, 0), soup.at(t, 1), soup.at(t, 2));
    side_ = std::clamp(static_cast<uint32_t>(std::sqrt(double(count))), 1u, 512u);
    put_in_groups<uint32_t>(side_ * side_, first_, listed_, [&](const auto& put) {
        for (uint32_t t = 0; t < count; ++t) {
            const ItemBox& box = boxes_[t];
            for (uint32_t j = bucket(1, box.lo.y()); j <= bucket(1, box.hi.y()); ++j)
                for (uint32_t k = bucket(2, box.lo.z()); k <= bucket(2, box.hi.z()); ++k) put(j * side_ + k, t);
        }
    });
}

uint32_t ClosedSolid::bucket(int axis, double place) const {
    const double extent = box_.hi[axis] - box_.lo[axis];
    if (!(extent > 0)) return 0;
    return static_cast<uint32_t>(std::clamp((place - box_.lo[axis]) / extent * side_, 0.0, side_ - 1.0));
}

// How often a triangle turns around the ray along x from the point. An edge counts from the point's height on, and its
// side is the same number for both of its triangles, so that nothing is met twice or missed between them.
int ClosedSolid::turns(uint32_t triangle, const Vec3& point) const {
    const Vec3 p[3] = {soup_.at(triangle, 0) - point, soup_.at(triangle, 1) - point, soup_.at(triangle, 2) - point};
    double side[3];
    int turn = 0;
    for (int k = 0; k < 3; ++k) {
        const Vec3 &a = p[k], &b = p[(k + 1) % 3];
        side[k] = turn_of(a, b);
        if (a.z() <= 0 && b.z() > 0 && side[k] > 0) ++turn;
        if (a.z() > 0 && b.z() <= 0 && side[k] < 0) --turn;
    }
    if (turn == 0) return 0;
    const double area = side[0] + side[1] + side[2];
    if (area == 0) return 0;
    const double x = (side[1] * p[0].x() + side[2] * p[1].x() + side[0] * p[2].x()) / area;
    return x > 0 ? turn : 0;
}

bool ClosedSolid::holds(const Vec3& point) const {
    if (!box_.holds(point)) return false;
    const uint32_t at = bucket(1, point.y()) * side_ + bucket(2, point.z());
    int winding = 0;
    for (uint32_t i = first_[at]; i < first_[at + 1]; ++i) winding += turns(listed_[i], point);
    return winding != 0;
}

double ClosedSolid::distance(const Vec3& point) const {
    double least = std::numeric_limits<double>::infinity();
    tree_.nearest(point, [&](uint32_t t) {
        if (boxes_[t].distance_squared(point) >= least) return std::numeric_limits<double>::infinity();
        const Vec3 triangle[3] = {soup_.at(t, 0), soup_.at(t, 1), soup_.at(t, 2)};
        const double own = distance_squared(point, triangle);
        least = std::min(least, own);
        return own;
    });
    return holds(point) ? -std::sqrt(least) : std::sqrt(least);
}

}  // namespace taut::collision
