// Convex decomposition by boxes. With S the solid and C a box, a part is the hull of S within C. Its extreme points are
// those of the triangles of S clipped to C, and the corners of C that lie within S, so that cuts along the axes need no
// caps. How far a hull H departs from S is
//
//     e(H) = max over x in H of dist(x, S)                                                               [m]
//
// dist grows by no more than 1 m a metre: over a box of half diagonal r about c it is at most dist(c) + r, which bounds
// e from above by as few samples as need be. Cuts are compared by air, the nodes of a grid within the hull and outside
// of S by more than the tolerance: those that the hulls of both sides still hold, weighted by how far out they are.
// The sum of squares over both sides is least where the worse side has little left, which one sum is not: it would
// slice off thin pieces. After Mamou and Ghorbel 2009 (hulls of pieces, best first) and Wei et al. 2022, CoACD (a
// measure in metres, joining at the end).
#include "collision/decomposition.h"

#include <algorithm>
#include <cmath>

#include "collision/collide.h"

namespace taut::collision {
namespace {

constexpr uint32_t kGridCells = 64;       // along the longest side of the solid
constexpr double kMeasurePart = 1 / 16.;  // of the tolerance, to which departures are measured
constexpr double kNudge = 1e-5;           // of a cell's half extents, above the rounding of welded vertices
constexpr uint32_t kPartsToJoin = 4;      // pieces for each part asked for, at most, before they are joined

// Clipped triangles of a piece: corners [m], and where each polygon begins.
struct Polygons {
    explicit Polygons(Memory& memory) : corner(memory), first(1, 0, memory) {}

    Array<Vec3> corner;
    Array<uint32_t> first;

    size_t size() const { return first.size() - 1; }
    std::span<const Vec3> of(size_t i) const { return std::span(corner).subspan(first[i], first[i + 1] - first[i]); }
    void end() { first.push_back(static_cast<uint32_t>(corner.size())); }
};

struct Piece {
    explicit Piece(Memory& memory) : polygons(memory), air(memory) {}

    ItemBox cell;
    bool corner_within[8] = {};  // of the cell, in S; bit k of the number: its upper side along axis k
    Polygons polygons;
    Array<uint32_t> air;  // nodes within the hull and outside of S
    ConvexPart part;

    double error() const { return std::max(part.departure, part.shortfall); }
};

Vec3 corner_of(const ItemBox& box, uint32_t i) {
    return {i & 1 ? box.hi.x() : box.lo.x(), i & 2 ? box.hi.y() : box.lo.y(), i & 4 ? box.hi.z() : box.lo.z()};
}

// Distances to S at nodes, and the planes that cuts may lie in.
struct Grid {
    explicit Grid(Memory& memory)
        : distance(memory), planes{Array<double>(memory), Array<double>(memory), Array<double>(memory)} {}

    Vec3 low = Vec3::Zero();
    double cell = 0;  // [m]
    uint32_t nodes[3] = {0, 0, 0};
    Array<float> distance;  // [m], x fastest
    Array<double> planes[3];

    Vec3 place(uint32_t node) const {
        const uint32_t x = node % nodes[0], y = node / nodes[0] % nodes[1], z = node / nodes[0] / nodes[1];
        return low + cell * Vec3(x, y, z);
    }
    uint32_t index(int axis, double at) const {
        return static_cast<uint32_t>(
            std::clamp(std::floor((at - low[axis]) / cell + 0.5), 0.0, double(nodes[axis]) - 1));
    }
    // dist(p) at most, by the nearest node.
    double bound(const Vec3& p) const {
        const uint32_t x = index(0, p.x()), y = index(1, p.y()), z = index(2, p.z());
        const uint32_t node = (z * nodes[1] + y) * nodes[0] + x;
        return double(distance[node]) + (place(node) - p).norm();
    }
};

// Primitive directions with components of at most 2: hulls are compared by their extents along these.
constexpr size_t kDirections = 98;
using Directions = std::array<Vec3, kDirections>;

Directions directions() {
    Directions out;
    size_t count = 0;
    for (int x = -2; x <= 2; ++x)
        for (int y = -2; y <= 2; ++y)
            for (int z = -2; z <= 2; ++z) {
                const bool odd = (x & 1) || (y & 1) || (z & 1);
                if (odd) out[count++] = Vec3(x, y, z);
            }
    return out;
}

struct Cut {
    int axis = 0;
    double at = 0;  // [m]
};
using Cost = std::array<double, 4>;  // of a cut, the first number first

// Twice the area of a polygon's shadow along an axis, signed.
double area_across(std::span<const Vec3> corners, int axis) {
    double area = 0;
    for (size_t k = 2; k < corners.size(); ++k)
        area += (corners[k - 1] - corners[0]).cross(corners[k] - corners[0])[axis];
    return area;
}

class Decomposition {
public:
    Decomposition(const TriangleSoup& soup, const ClosedSolid& solid, const DecompositionSettings& settings,
                  Memory& memory)
        : soup_(soup),
          solid_(solid),
          settings_(settings),
          memory_(memory),
          grid_(memory),
          directions_(directions()),
          pieces_(memory),
          heap_(memory) {}

    Array<ConvexPart> run();

private:
    // What a plane leaves: of each side the extents up to it, and the air that its hull holds.
    struct Side {
        double excess = 0, air = 0;
    };

    void sample();
    void choose_planes();
    bool finish(Piece& piece);
    Array<Vec3f> points_of(const Piece& piece) const;
    std::shared_ptr<const Hull> hull_of(std::span<const Vec3f> points) const;
    double shortfall_of(const Hull& hull, std::span<const Vec3f> points) const;
    double departure_of(const Hull& hull, double enough);
    double sampled_departure(const Hull& hull) const;
    template <class Act>
    void for_nodes(const Hull& hull, Act&& act) const;
    bool split(size_t worst);
    Cut choose_cut(const Piece& piece) const;
    void compare_cuts(const Piece& piece, int axis, Cut& best, Cost& least) const;
    void add_extents(const Piece& piece, int axis, std::span<const double> planes, Array<double>& low,
                     Array<double>& high) const;
    void clip(const Piece& piece, const Cut& cut, Piece& low, Piece& high) const;
    bool holds_corner(const ItemBox& cell, uint32_t i) const;
    void join();

    const TriangleSoup& soup_;
    const ClosedSolid& solid_;
    const DecompositionSettings& settings_;
    Memory& memory_;
    Grid grid_;
    Directions directions_;
    Array<Piece> pieces_;

    struct Probe {
        Vec3 centre, half;
        double bound;
        uint32_t number;
        bool operator<(const Probe& o) const { return bound != o.bound ? bound < o.bound : number > o.number; }
    };
    Array<Probe> heap_;
};

// ---------------------------------------------------------------- the grid

void Decomposition::sample() {
    const Vec3 extent = solid_.box().hi - solid_.box().lo;
    grid_.cell = extent.maxCoeff() / kGridCells;
    grid_.low = solid_.box().lo;
    for (int k = 0; k < 3; ++k) grid_.nodes[k] = static_cast<uint32_t>(std::ceil(extent[k] / grid_.cell)) + 1;
    grid_.distance.resize(size_t{grid_.nodes[0]} * grid_.nodes[1] * grid_.nodes[2]);
    for (uint32_t i = 0; i < grid_.distance.size(); ++i)
        grid_.distance[i] = static_cast<float>(solid_.distance(grid_.place(i)));
    choose_planes();
}

// One a cell: where the largest of the triangles across the axis lies, or the middle.
void Decomposition::choose_planes() {
    for (int axis = 0; axis < 3; ++axis) {
        Array<double>& planes = grid_.planes[axis];
        Array<double> largest(grid_.nodes[axis], 0, memory_);
        for (uint32_t i = 0; i < grid_.nodes[axis]; ++i) planes.push_back(grid_.low[axis] + i * grid_.cell);
        for (size_t t = 0; t < soup_.triangles(); ++t) {
            const Vec3 &a = soup_.at(t, 0), &b = soup_.at(t, 1), &c = soup_.at(t, 2);
            if (a[axis] != b[axis] || b[axis] != c[axis]) continue;
            const double area = (b - a).cross(c - a).norm();
            const uint32_t i = grid_.index(axis, a[axis]);
            if (area > largest[i]) largest[i] = area, planes[i] = a[axis];
        }
    }
}

// ---------------------------------------------------------------- hulls

Array<Vec3f> Decomposition::points_of(const Piece& piece) const {
    Array<Vec3f> points(memory_);
    points.reserve(piece.polygons.corner.size() + 8);
    for (const Vec3& p : piece.polygons.corner) points.push_back(p.cast<float>());
    for (uint32_t i = 0; i < 8; ++i)
        if (piece.corner_within[i]) points.push_back(corner_of(piece.cell, i).cast<float>());
    return points;
}

// What is thinner than a hull may be is thickened all around by that much.
std::shared_ptr<const Hull> Decomposition::hull_of(std::span<const Vec3f> points) const {
    auto hull = build_hull(points, settings_.max_vertices, settings_.thickness, nullptr, memory_);
    if (hull || points.empty()) return hull;
    Array<Vec3f> thick(memory_);
    for (const Vec3f& p : points)
        for (int k = 0; k < 3; ++k)
            for (const float way : {-settings_.thickness, settings_.thickness})
                thick.push_back(p + way * Vec3f::Unit(k));
    return build_hull(thick, settings_.max_vertices, settings_.thickness, nullptr, memory_);
}

double Decomposition::shortfall_of(const Hull& hull, std::span<const Vec3f> points) const {
    double most = 0;
    for (const Vec3f& p : points) most = std::max(most, double(outside(hull.view(), p)));
    return most;
}

// e(H), from above: within kMeasurePart of the tolerance, or no closer than enough [m].
double Decomposition::departure_of(const Hull& hull, double enough) {
    const double precision = kMeasurePart * settings_.tolerance;
    ItemBox box;
    for (const Vec3f& v : hull.vertices) box.add(v.cast<double>());
    double best = 0, settled = 0;
    uint32_t number = 0;
    heap_.clear();
    const auto add = [&](const Vec3& centre, const Vec3& half) {
        double over = -std::numeric_limits<double>::infinity();
        for (const Face& face : hull.faces) {
            const Vec3 normal = face.normal.cast<double>();
            const double height = normal.dot(centre) - double(face.offset);
            if (height > normal.cwiseAbs().dot(half)) return;  // all of it is outside
            over = std::max(over, height);
        }
        const double reach = half.norm();
        const auto settles = [&](double bound) {
            if (bound > std::max(best + precision, enough)) return false;
            settled = std::max(settled, bound);
            return true;
        };
        if (settles(grid_.bound(centre) + reach)) return;
        const double distance = solid_.distance(centre);
        if (over <= 0) best = std::max(best, distance);
        if (settles(distance + reach)) return;
        heap_.push_back({centre, half, distance + reach, number++});
        std::push_heap(heap_.begin(), heap_.end());
    };
    add(0.5 * (box.lo + box.hi), 0.5 * (box.hi - box.lo));
    while (!heap_.empty() && heap_.front().bound > std::max(best + precision, enough)) {
        std::pop_heap(heap_.begin(), heap_.end());
        const Probe probe = heap_.back();
        heap_.pop_back();
        int axis;
        probe.half.maxCoeff(&axis);
        Vec3 half = probe.half;
        half[axis] *= 0.5;
        for (const double way : {-half[axis], half[axis]}) add(probe.centre + way * Vec3::Unit(axis), half);
    }
    return std::max({best, settled, heap_.empty() ? 0.0 : heap_.front().bound});
}

template <class Act>
void Decomposition::for_nodes(const Hull& hull, Act&& act) const {
    ItemBox box;
    for (const Vec3f& v : hull.vertices) box.add(v.cast<double>());
    uint32_t first[3], last[3];
    for (int k = 0; k < 3; ++k) first[k] = grid_.index(k, box.lo[k]), last[k] = grid_.index(k, box.hi[k]);
    for (uint32_t z = first[2]; z <= last[2]; ++z)
        for (uint32_t y = first[1]; y <= last[1]; ++y)
            for (uint32_t x = first[0]; x <= last[0]; ++x) {
                const uint32_t node = (z * grid_.nodes[1] + y) * grid_.nodes[0] + x;
                if (grid_.distance[node] > 0 && outside(hull.view(), grid_.place(node).cast<float>()) <= 0) act(node);
            }
}

// e(H) at the nodes: never above it, and off by at most half a cell's diagonal.
double Decomposition::sampled_departure(const Hull& hull) const {
    float most = 0;
    for_nodes(hull, [&](uint32_t node) { most = std::max(most, grid_.distance[node]); });
    return double(most);
}

// Hull, errors and air of a piece; false where it has none.
bool Decomposition::finish(Piece& piece) {
    const Array<Vec3f> points = points_of(piece);
    piece.part.hull = hull_of(points);
    if (!piece.part.hull) return false;
    piece.part.shortfall = shortfall_of(*piece.part.hull, points);
    piece.part.departure = departure_of(*piece.part.hull, settings_.tolerance);
    for_nodes(*piece.part.hull, [&](uint32_t node) { piece.air.push_back(node); });
    return true;
}

// ---------------------------------------------------------------- cuts

// Whether S fills the corner of a cell: a little inside, as what only touches the cell is not in it.
bool Decomposition::holds_corner(const ItemBox& cell, uint32_t i) const {
    const Vec3 corner = corner_of(cell, i);
    return solid_.holds(corner + kNudge * (0.5 * (cell.lo + cell.hi) - corner));
}

// Polygons on either side of a plane. One that lies in it belongs to the side that the solid is on: it looks away from
// that; one that only touches it to the side of its other corners.
void Decomposition::clip(const Piece& piece, const Cut& cut, Piece& low, Piece& high) const {
    const double look = solid_.signed_volume() < 0 ? -1 : 1;
    for (size_t i = 0; i < piece.polygons.size(); ++i) {
        const std::span<const Vec3> corners = piece.polygons.of(i);
        double least = 0, most = 0;
        for (const Vec3& p : corners)
            least = std::min(least, p[cut.axis] - cut.at), most = std::max(most, p[cut.axis] - cut.at);
        bool to_low = least<0, to_high = most> 0;
        if (!to_low && !to_high) {
            const double way = area_across(corners, cut.axis);
            to_low = look * way > 0, to_high = !to_low;
        }
        for (const bool upper : {false, true}) {
            if (!(upper ? to_high : to_low)) continue;
            Polygons& out = upper ? high.polygons : low.polygons;
            for (size_t k = 0; k < corners.size(); ++k) {
                const Vec3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
                const double at = a[cut.axis] - cut.at, next = b[cut.axis] - cut.at;
                if (upper ? at >= 0 : at <= 0) out.corner.push_back(a);
                if ((at < 0 && next > 0) || (at > 0 && next < 0)) {
                    Vec3 p = a + at / (at - next) * (b - a);
                    p[cut.axis] = cut.at;
                    out.corner.push_back(p);
                }
            }
            out.end();
        }
    }
    low.cell = high.cell = piece.cell;
    low.cell.hi[cut.axis] = high.cell.lo[cut.axis] = cut.at;
    for (uint32_t i = 0; i < 8; ++i) {
        const bool upper = i >> cut.axis & 1;
        low.corner_within[i] = upper ? holds_corner(low.cell, i) : piece.corner_within[i];
        high.corner_within[i] = upper ? piece.corner_within[i] : holds_corner(high.cell, i);
    }
}

// Of each plane the extents of what is below it (low) and above it (high), by direction.
void Decomposition::add_extents(const Piece& piece, int axis, std::span<const double> planes, Array<double>& low,
                                Array<double>& high) const {
    const size_t count = planes.size();
    low.assign(count * kDirections, -std::numeric_limits<double>::infinity());
    high = low;
    const auto raise = [&](Array<double>& extents, size_t plane, const Vec3& p) {
        double* const row = &extents[plane * kDirections];
        for (size_t d = 0; d < kDirections; ++d) row[d] = std::max(row[d], directions_[d].dot(p));
    };
    const auto add_edge = [&](const Vec3& a, const Vec3& b) {
        const size_t above = size_t(std::lower_bound(planes.begin(), planes.end(), a[axis]) - planes.begin());
        const size_t below = size_t(std::upper_bound(planes.begin(), planes.end(), a[axis]) - planes.begin());
        if (above < count) raise(low, above, a);
        if (below > 0) raise(high, below - 1, a);
        const double lo = std::min(a[axis], b[axis]), hi = std::max(a[axis], b[axis]);
        size_t i = size_t(std::upper_bound(planes.begin(), planes.end(), lo) - planes.begin());
        for (; i < count && planes[i] < hi; ++i) {
            const Vec3 p = a + (planes[i] - a[axis]) / (b[axis] - a[axis]) * (b - a);
            raise(low, i, p);
            raise(high, i, p);
        }
    };
    for (size_t i = 0; i < piece.polygons.size(); ++i) {
        const std::span<const Vec3> corners = piece.polygons.of(i);
        for (size_t k = 0; k < corners.size(); ++k) add_edge(corners[k], corners[(k + 1) % corners.size()]);
    }
    for (uint32_t i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) {
            const uint32_t other = i ^ 1u << k;
            if (piece.corner_within[i])
                add_edge(corner_of(piece.cell, i), corner_of(piece.cell, piece.corner_within[other] ? other : i));
        }
    for (size_t d = 0; d < kDirections; ++d) {
        for (size_t i = 1; i < count; ++i)
            low[i * kDirections + d] = std::max(low[i * kDirections + d], low[(i - 1) * kDirections + d]);
        for (size_t i = count - 1; i-- > 0;)
            high[i * kDirections + d] = std::max(high[i * kDirections + d], high[(i + 1) * kDirections + d]);
    }
}

// The best plane across an axis: least squares of the excess that is left and of the air, most surface that lies in it,
// and nearest to the middle, one after the other.
void Decomposition::compare_cuts(const Piece& piece, int axis, Cut& best, Cost& least) const {
    const double margin = double(settings_.thickness), lo = piece.cell.lo[axis], hi = piece.cell.hi[axis];
    Array<double> planes(memory_);
    for (const double at : grid_.planes[axis])
        if (at > lo + margin && at < hi - margin) planes.push_back(at);
    std::ranges::sort(planes);
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
    if (planes.empty()) return;
    Array<double> low(memory_), high(memory_);
    add_extents(piece, axis, planes, low, high);
    const size_t count = planes.size();
    Array<Side> below(count, Side(), memory_), above(count, Side(), memory_);
    for (const uint32_t node : piece.air) {
        const Vec3 p = grid_.place(node);
        const double out = double(grid_.distance[node]), excess = std::max(0.0, out - settings_.tolerance);
        // Extents grow with the plane: below the first that holds the node, it is held by all that follow.
        size_t i = size_t(std::lower_bound(planes.begin(), planes.end(), p[axis]) - planes.begin());
        size_t k = size_t(std::upper_bound(planes.begin(), planes.end(), p[axis]) - planes.begin());
        for (size_t d = 0; d < kDirections; ++d) {
            const double along = directions_[d].dot(p);
            while (i < count && low[i * kDirections + d] < along) ++i;
            while (k > 0 && high[(k - 1) * kDirections + d] < along) --k;
        }
        if (i < count) below[i].excess += excess, below[i].air += out;
        if (k > 0) above[k - 1].excess += excess, above[k - 1].air += out;
    }
    for (size_t i = 1; i < count; ++i) below[i].excess += below[i - 1].excess, below[i].air += below[i - 1].air;
    for (size_t i = count - 1; i-- > 0;) above[i].excess += above[i + 1].excess, above[i].air += above[i + 1].air;
    Array<double> surface(count, 0, memory_);
    for (size_t i = 0; i < piece.polygons.size(); ++i) {
        const std::span<const Vec3> corners = piece.polygons.of(i);
        const double at = corners.front()[axis];
        const auto plane = std::lower_bound(planes.begin(), planes.end(), at);
        if (plane == planes.end() || *plane != at) continue;
        if (std::ranges::all_of(corners, [&](const Vec3& p) { return p[axis] == at; }))
            surface[size_t(plane - planes.begin())] += std::fabs(area_across(corners, axis));
    }
    for (size_t i = 0; i < count; ++i) {
        const Cost cost = {below[i].excess * below[i].excess + above[i].excess * above[i].excess,
                           below[i].air * below[i].air + above[i].air * above[i].air, -surface[i],
                           std::fabs(planes[i] - 0.5 * (lo + hi))};
        if (cost < least) least = cost, best = {axis, planes[i]};
    }
}

Cut Decomposition::choose_cut(const Piece& piece) const {
    Cut best;
    (piece.cell.hi - piece.cell.lo).maxCoeff(&best.axis);
    best.at = 0.5 * (piece.cell.lo[best.axis] + piece.cell.hi[best.axis]);
    if (piece.part.departure <= settings_.tolerance) return best;  // of too many corners: they are halved
    Cost least;
    least.fill(std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis) compare_cuts(piece, axis, best, least);
    return best;
}

// False: the piece is as small as hulls may be.
bool Decomposition::split(size_t worst) {
    const Piece& piece = pieces_[worst];
    if (!((piece.cell.hi - piece.cell.lo).maxCoeff() > 4 * double(settings_.thickness))) return false;
    Piece low(memory_), high(memory_);
    clip(piece, choose_cut(piece), low, high);
    const bool has_low = finish(low), has_high = finish(high);
    if (has_low && has_high) {
        pieces_[worst] = std::move(low);
        pieces_.push_back(std::move(high));
    } else if (has_low || has_high) {
        pieces_[worst] = std::move(has_low ? low : high);
    }
    return has_low || has_high;
}

// ---------------------------------------------------------------- joining

// Two parts as one, cheapest first; what a pair costs is sampled, and measured when its turn has come.
void Decomposition::join() {
    struct Pair {
        size_t a, b;
        ConvexPart part;
        double cost;
        bool measured;
    };
    Array<Pair> pairs(memory_);
    size_t left = pieces_.size();
    const auto box_of = [](const Hull& hull) {
        ItemBox box;
        for (const Vec3f& v : hull.vertices) box.add(v.cast<double>());
        return box;
    };
    bool far = false;  // parts that do not meet are joined too
    const auto add_pair = [&](size_t a, size_t b) {
        const ConvexPart &one = pieces_[a].part, &other = pieces_[b].part;
        const ItemBox box = box_of(*one.hull);
        ItemBox wide = box;
        wide.add(box.lo - Vec3::Constant(settings_.tolerance));
        wide.add(box.hi + Vec3::Constant(settings_.tolerance));
        if (!far && !wide.meets(box_of(*other.hull))) return;
        Array<Vec3f> points(one.hull->vertices.begin(), one.hull->vertices.end(), memory_);
        points.insert(points.end(), other.hull->vertices.begin(), other.hull->vertices.end());
        Pair pair{a, b, {}, 0, false};
        pair.part.hull = hull_of(points);
        if (!pair.part.hull) return;
        pair.part.shortfall = shortfall_of(*pair.part.hull, points) + std::max(one.shortfall, other.shortfall);
        pair.cost = std::max(pair.part.shortfall, sampled_departure(*pair.part.hull));
        pairs.push_back(std::move(pair));
    };
    const auto add_pairs = [&] {
        for (size_t a = 0; a < pieces_.size(); ++a)
            for (size_t b = a + 1; b < pieces_.size(); ++b)
                if (pieces_[a].part.hull && pieces_[b].part.hull) add_pair(a, b);
    };
    add_pairs();
    for (;;) {
        if (pairs.empty() && left > settings_.max_parts && !far) {
            far = true;
            add_pairs();
        }
        if (pairs.empty()) return;
        const size_t at = size_t(std::ranges::min_element(pairs, {}, &Pair::cost) - pairs.begin());
        Pair& pair = pairs[at];
        if (pair.cost > settings_.tolerance && left <= settings_.max_parts) return;
        if (!pair.measured) {
            pair.part.departure = departure_of(*pair.part.hull, settings_.tolerance);
            pair.cost = std::max(pair.cost, pair.part.departure);
            pair.measured = true;
            if (pair.cost > settings_.tolerance) continue;
        }
        const size_t a = pair.a, b = pair.b;
        pieces_[a].part = std::move(pair.part);
        pieces_[b].part.hull = nullptr;
        --left;
        std::erase_if(pairs,
                      [&](const Pair& each) { return each.a == a || each.b == a || each.a == b || each.b == b; });
        for (size_t other = 0; other < pieces_.size(); ++other)
            if (other != a && pieces_[other].part.hull) add_pair(std::min(a, other), std::max(a, other));
    }
}

Array<ConvexPart> Decomposition::run() {
    Array<ConvexPart> parts(memory_);
    sample();
    Piece whole(memory_);
    whole.cell = solid_.box();
    for (size_t t = 0; t < soup_.triangles(); ++t) {
        for (size_t k = 0; k < 3; ++k) whole.polygons.corner.push_back(soup_.at(t, k));
        whole.polygons.end();
    }
    if (!finish(whole)) return parts;
    pieces_.push_back(std::move(whole));
    const size_t most = size_t{kPartsToJoin} * settings_.max_parts;
    while (pieces_.size() < most) {
        const auto worst = std::ranges::max_element(pieces_, {}, &Piece::error);
        if (worst->error() <= settings_.tolerance || !split(size_t(worst - pieces_.begin()))) break;
    }
    join();
    for (Piece& piece : pieces_)
        if (piece.part.hull) parts.push_back(std::move(piece.part));
    return parts;
}

}  // namespace

Array<ConvexPart> decompose(const TriangleSoup& soup, const ClosedSolid& solid, const DecompositionSettings& settings,
                            Memory& memory) {
    return Decomposition(soup, solid, settings, memory).run();
}

}  // namespace taut::collision
