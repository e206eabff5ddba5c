// Four cases: the face is a polygon, a disc or a whole plane, and a line, a polygon or a disc lies against it. Discs
// are never replaced by polygons: corners, crossings of sides with the circle, and four points of the rim are found in
// closed form.
#include "collision/narrowphase/face_contact.h"

#include <array>
#include <cmath>

namespace taut::collision {
namespace {

// Ids of points, below 1 << 14: corners of the polygon by number; then
constexpr uint32_t kCrossing = kFaceCorners;  // + 2 * side + (0 where it enters the disc, 1 where it leaves)
constexpr uint32_t kRim = 256;                // + quarter of the incident disc's rim, from the deepest point on
constexpr uint32_t kOwnRim = 264;             // + quarter of the face's own rim
constexpr uint32_t kDeepest = 272;            // + 0 at the incident shape's -y end, 1 at +y; also the ends of its line
constexpr uint32_t kOwnDeepest = 274;
constexpr uint32_t kCircles = 276;  // + which of the two crossings of two circles
constexpr uint32_t kCut = 1024;     // + 2 * side (or kOfCircle) + (0 entering, 1 leaving), of a line
constexpr uint32_t kOfCircle = 128;

// A tilted disc counts as a circle up to 8 degrees (cosine), where it meets another.
constexpr float kFacing = 0.99f;

// How far a line runs over the face: from parameter enter to leave, with the sides that cut it.
struct LinePart {
    float enter = 0, leave = 1;
    uint32_t enter_id, leave_id;

    // from, to: how far the line's ends are outside of a side. The cut is on the side itself.
    void cut(float from, float to, float slack, uint32_t side) {
        if (from <= slack && to <= slack) return;
        if (from > slack && to > slack) {
            leave = -1;
        } else if (from > slack) {
            const float t = to < 0 ? from / (from - to) : 1.0f;
            if (t > enter) enter = t, enter_id = kCut + 2 * side;
        } else {
            const float t = from < 0 ? from / (from - to) : 0.0f;
            if (t < leave) leave = t, leave_id = kCut + 2 * side + 1;
        }
    }
    // |p + t d| <= radius: t^2 dd + 2 t pd + pp - rr = 0
    void cut_by_circle(float px, float py, float dx, float dy, float radius) {
        const float dd = dx * dx + dy * dy;
        const float pd = px * dx + py * dy;
        const float c = px * px + py * py - radius * radius;
        const float root = pd * pd - dd * c;
        if (c <= 0 && !(dd > 0)) return;  // a point within
        if (!(dd > 0) || root <= 0) {
            leave = -1;
            return;
        }
        const float half = std::sqrt(root);
        const float first = (-pd - half) / dd;
        const float second = (-pd + half) / dd;
        if (first > enter) enter = first, enter_id = kCut + kOfCircle;
        if (second < leave) leave = second, leave_id = kCut + kOfCircle + 1;
    }
};

// Plane coordinates and height above the face of a point of its frame.
ClipPoint above(const FlatFace& face, const Vec3f& p, uint32_t id) {
    return {face.u.dot(p), face.v.dot(p), face.normal.dot(p) - face.offset, id};
}

void line_on_face(const FlatFace& face, const Segment& line, float slack, Polygon& out) {
    const ClipPoint from = above(face, line.from, kDeepest);
    const ClipPoint to = above(face, line.at(1), kDeepest + 1);
    const float dx = to.x - from.x, dy = to.y - from.y, dz = to.z - from.z;
    LinePart stretch{0, 1, from.id, to.id};
    if (face.is_disc()) stretch.cut_by_circle(from.x, from.y, dx, dy, face.radius + slack);
    for (size_t i = 0; i < face.sides.size(); ++i) {
        const Side& side = face.sides[i];
        stretch.cut(side.x * from.x + side.y * from.y - side.offset, side.x * to.x + side.y * to.y - side.offset, slack,
                    uint32_t(i));
    }
    if (stretch.enter > stretch.leave) return;
    const auto at = [&](float t, uint32_t id) {
        return ClipPoint{from.x + t * dx, from.y + t * dy, from.z + t * dz, id};
    };
    out.points[out.count++] = at(stretch.enter, stretch.enter_id);
    if (line.step.squaredNorm() > 0) out.points[out.count++] = at(stretch.leave, stretch.leave_id);
}

// ---------------------------------------------------------------- discs

// A disc placed in the face's frame: centre + x e1 + y e2, |(x, y)| <= radius.
struct Disc {
    Vec3f centre, e1, e2;
    float radius;
};

// Slope over a plane, in its coordinates: z = at + slope_x x + slope_y y.
struct Slope {
    float at, slope_x, slope_y;

    float operator()(float x, float y) const { return at + slope_x * x + slope_y * y; }
};

// Four quarters of a rim in the disc's own coordinates, from its lowest point on: they go around with that as the disc
// wobbles. Quarters that stay on the disc until another point is clearly lower drop it by as much each time. Where it
// lies flat to kFlatRim [m], no point is the lowest.
constexpr float kFlatRim = 1e-6f;

std::array<ClipPoint, 4> rim_points(float radius, const Slope& heights, uint32_t rim, uint32_t deepest) {
    const float steep = std::sqrt(heights.slope_x * heights.slope_x + heights.slope_y * heights.slope_y);
    const bool flat = steep * radius <= kFlatRim;
    const float x = flat ? 0.70710678f * radius : heights.slope_x * (-radius / steep);
    const float y = flat ? x : heights.slope_y * (-radius / steep);
    std::array<ClipPoint, 4> points = {
        {{x, y, 0, deepest}, {-y, x, 0, rim + 1}, {-x, -y, 0, rim + 2}, {y, -x, 0, rim + 3}}};
    for (ClipPoint& p : points) p.z = heights(p.x, p.y);
    return points;
}

// Whether a convex polygon holds a point, or has it within slack.
bool holds(const Polygon& polygon, float turn, float x, float y, float slack) {
    for (int i = 0; i < polygon.count; ++i) {
        const ClipPoint& p = polygon.points[i];
        const ClipPoint& q = polygon.points[i + 1 == polygon.count ? 0 : i + 1];
        const float dx = q.x - p.x, dy = q.y - p.y;
        const float outside = turn * (dy * (x - p.x) - dx * (y - p.y));
        if (outside > slack * std::sqrt(dx * dx + dy * dy)) return false;
    }
    return true;
}

// What a polygon (its corners' ids are their numbers, turn: 1 counter-clockwise, -1 clockwise) and a disc about the
// origin have in common, in the disc's coordinates.
void disc_and_polygon(const Polygon& polygon, float turn, float radius, const std::array<ClipPoint, 4>& rim,
                      const Slope& heights, float slack, Polygon& out) {
    for (const ClipPoint& p : rim) {
        if (holds(polygon, turn, p.x, p.y, slack)) out.points[out.count++] = p;
    }
    if (out.count == 4) return;
    for (int i = 0; i < polygon.count; ++i) {
        const ClipPoint& p = polygon.points[i];
        const ClipPoint& q = polygon.points[i + 1 == polygon.count ? 0 : i + 1];
        LinePart stretch{0, 1, p.id, q.id};
        stretch.cut_by_circle(p.x, p.y, q.x - p.x, q.y - p.y, radius);
        if (stretch.enter > stretch.leave) continue;
        const auto add = [&](float t, uint32_t id) {
            const float x = p.x + t * (q.x - p.x), y = p.y + t * (q.y - p.y);
            out.points[out.count++] = {x, y, heights(x, y), id};
        };
        add(stretch.enter, stretch.enter > 0 ? kCrossing + 2 * uint32_t(i) : p.id);
        if (stretch.leave < 1) add(stretch.leave, kCrossing + 2 * uint32_t(i) + 1);
    }
}

// The face is the polygon, a disc lies against it: in the disc's coordinates, looked at along the face's normal.
void disc_on_polygon(const FlatFace& face, const Disc& disc, uint32_t deepest, float slack, Polygon& out) {
    const ClipPoint middle = above(face, disc.centre, 0);
    const float a = face.u.dot(disc.e1), b = face.u.dot(disc.e2);
    const float c = face.v.dot(disc.e1), d = face.v.dot(disc.e2);
    const float determinant = a * d - b * c;
    const Slope heights = {middle.z, face.normal.dot(disc.e1), face.normal.dot(disc.e2)};
    Polygon corners;
    for (const uint8_t corner : face.loop) {
        const Vec3f& p = face.vertices[corner];
        const float x = face.u.dot(p) - middle.x, y = face.v.dot(p) - middle.y;
        corners.points[corners.count] = {(d * x - b * y) / determinant, (a * y - c * x) / determinant, 0,
                                         uint32_t(corners.count)};
        ++corners.count;
    }
    const auto rim = rim_points(disc.radius, heights, kRim, deepest);
    Polygon common;
    if (face.loop.empty()) {
        std::copy(rim.begin(), rim.end(), common.points);
        common.count = 4;
    } else {
        disc_and_polygon(corners, determinant > 0 ? 1.0f : -1.0f, disc.radius, rim, heights, slack, common);
    }
    for (int i = 0; i < common.count; ++i) {
        const ClipPoint& p = common.points[i];
        out.points[out.count++] = {middle.x + a * p.x + b * p.y, middle.y + c * p.x + d * p.y, p.z, p.id};
    }
}

// Slope over the face of the plane normal . p = offset, looked at along the face's normal.
Slope heights_of(const FlatFace& face, const Vec3f& normal, float offset) {
    const float along = normal.dot(face.normal);
    return {offset / along - face.offset, -normal.dot(face.u) / along, -normal.dot(face.v) / along};
}

// The face is the disc, a polygon lies against it.
void polygon_on_disc(const FlatFace& face, const FlatFace& incident, const Pose& pose, float slack, Polygon& out) {
    const Vec3f normal = pose.rotation * incident.normal;
    const Slope heights = heights_of(face, normal, incident.offset + normal.dot(pose.position));
    Polygon corners;
    for (const uint8_t corner : incident.loop) {
        corners.points[corners.count] = above(face, pose * incident.vertices[corner], uint32_t(corners.count));
        ++corners.count;
    }
    const auto rim = rim_points(face.radius, heights, kOwnRim, kOwnDeepest);
    disc_and_polygon(corners, -1.0f, face.radius, rim, heights, slack, out);
}

// Where the circles of two nearly parallel discs cross: along the line of centres, and across it by the half chord.
void circles_cross(float radius, const ClipPoint& middle, float other, const Slope& heights, float slack,
                   Polygon& out) {
    const float apart = std::sqrt(middle.x * middle.x + middle.y * middle.y);
    if (apart <= std::fabs(radius - other) + slack || apart >= radius + other) return;
    const float along = 0.5f * (apart + (radius - other) * (radius + other) / apart);
    const float chord = std::sqrt(std::max(radius * radius - along * along, 0.0f));
    const float x = middle.x / apart;
    const float y = middle.y / apart;
    for (const float side : {-1.0f, 1.0f}) {
        const float px = x * along - side * y * chord;
        const float py = y * along + side * x * chord;
        out.points[out.count++] = {px, py, heights(px, py), kCircles + (side > 0)};
    }
}

// Two discs: the points of either rim over the other disc, and where the circles cross.
void disc_on_disc(const FlatFace& face, const Disc& disc, uint32_t deepest, float slack, Polygon& out) {
    const ClipPoint middle = above(face, disc.centre, 0);
    const Slope own = {middle.z, face.normal.dot(disc.e1), face.normal.dot(disc.e2)};
    const float most = face.radius + slack;
    for (const ClipPoint& p : rim_points(disc.radius, own, kRim, deepest)) {
        const ClipPoint at = above(face, disc.centre + disc.e1 * p.x + disc.e2 * p.y, p.id);
        if (at.x * at.x + at.y * at.y <= most * most) out.points[out.count++] = at;
    }
    if (out.count == 4) return;
    const Vec3f normal = disc.e1.cross(disc.e2);
    const Slope heights = heights_of(face, normal, normal.dot(disc.centre));
    const float least = std::max(disc.radius - slack, 0.0f);
    int inside = 0;
    for (const ClipPoint& p : rim_points(face.radius, heights, kOwnRim, kOwnDeepest)) {
        const Vec3f away(p.x - middle.x, p.y - middle.y, p.z - middle.z);
        if (away.squaredNorm() > least * least) continue;
        out.points[out.count++] = p;
        ++inside;
    }
    if (inside < 4 && normal.dot(face.normal) < -kFacing) {
        circles_cross(face.radius, middle, disc.radius, heights, slack, out);
    }
}

}  // namespace

uint32_t common_points(const FlatFace& face, const Solid& other, const Pose& pose, float slack, Polygon& out) {
    const Feature feature = other.feature_along(pose.rotation.transpose() * -face.normal);
    if (feature.face < 0) {
        line_on_face(face, {pose * feature.line.from, pose.rotation * feature.line.step}, slack, out);
        return 0;
    }
    const FlatFace incident = other.face(feature.face);
    if (!incident.is_disc()) {
        polygon_on_disc(face, incident, pose, slack, out);
        return uint32_t(feature.face) << 14;
    }
    const Disc disc = {pose * (incident.normal * incident.offset), pose.rotation * incident.u,
                       pose.rotation * incident.v, incident.radius};
    const uint32_t deepest = kDeepest + uint32_t(feature.face);
    if (face.is_disc()) {
        disc_on_disc(face, disc, deepest, slack, out);
    } else {
        disc_on_polygon(face, disc, deepest, slack, out);
    }
    return 0;
}

void face_contact(const FlatFace& face, const Solid& other, const Pose& pose, uint32_t base, float slack,
                  const Wanted& wanted, Manifold& out) {
    Polygon points;
    base |= common_points(face, other, pose, slack, points);
    out.normal = face.normal;
    add_points(points, {face.u, face.v, face.normal, face.offset}, base, wanted, out);
}

}  // namespace taut::collision
