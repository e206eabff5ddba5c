// Any two convex shapes: the direction of least overlap, then the points of a flat face, of two lines side by side, or
// one point. Last frame's direction is where the search starts.
#include <bit>
#include <cmath>

#include "collision/narrowphase/face_contact.h"
#include "collision/narrowphase/least_push.h"

namespace taut::collision {
namespace {

// Lines within 10 degrees (sine squared 0.03) of parallel touch along a stretch: two points.
constexpr float kFacingSine2 = 0.03f;
// They do as far as they run no further beside each other than this, in parts of the smaller shape's inner radius r:
// a round side falls off by kBeside^2 r / 2 there. A shorter stretch is a point.
constexpr float kBeside = 0.02f, kShort = 0.1f;

// Ids where no flat face bears the contact.
constexpr uint32_t kLineAlone = (3u << 30) | 1;
constexpr uint32_t kLineEnd = (3u << 30) | 2;  // the other end's is one more

// ---------------------------------------------------------------- cache

// Words 0 to 2: the normal; word 3: what bore the contact.
enum Bearer : uint32_t { kNothing, kFaceOfA, kFaceOfB, kRound };

struct KeptPush {
    Vec3 normal = Vec3::Zero();
    Bearer bearer = kNothing;
};

KeptPush read_push(const PairCache& cache) {
    KeptPush kept;
    kept.bearer = Bearer(cache.words[3] & 3);
    Vec3 normal;
    for (int i = 0; i < 3; ++i) normal[i] = double(std::bit_cast<float>(cache.words[i]));
    const double squared = normal.squaredNorm();
    if (squared > 0.9 && squared < 1.1) kept.normal = normal / std::sqrt(squared);
    return kept;
}

void write(const Vec3& normal, Bearer bearer, PairCache& cache) {
    for (int i = 0; i < 3; ++i) cache.words[i] = std::bit_cast<uint32_t>(float(normal[i]));
    cache.words[3] = bearer;
}

// ---------------------------------------------------------------- contacts

struct Solids {
    Solid a, b;
    Pose b_in_a, a_in_b;
    const Wanted& wanted;
    float size;

    explicit Solids(const Pair& pair)
        : a(pair.a),
          b(pair.b),
          b_in_a(pair.b_in_a),
          a_in_b{b_in_a.rotation.transpose(), b_in_a.rotation.transpose() * -b_in_a.position},
          wanted(pair.wanted),
          size(std::min(inner_radius(pair.a), inner_radius(pair.b))) {}
};

struct BearingFace {
    Bearer bearer = kNothing;
    int face = -1;
    float separation = -1e30f;  // along the face's normal [m]
};

float face_separation(const Solid& solid, const Solid& other, const Pose& other_in_solid, int number) {
    const FlatFace face = solid.face(number);
    const Vec3 towards = (other_in_solid.rotation.transpose() * -face.normal).cast<double>();
    const Vec3f lowest = other_in_solid * furthest_point(other.shape(), towards.normalized()).cast<float>();
    return face.normal.dot(lowest) - face.offset;
}

// The flat face that looks along the normal and separates most; last frame's is kept if it is nearly as good.
BearingFace best_face(const Solids& solids, const Vec3f& normal, Bearer was) {
    BearingFace on_a, on_b;
    const float keep = Preference(solids.size).keep;
    const int face_a = solids.a.face_along(normal);
    const int face_b = solids.b.face_along(solids.b_in_a.rotation.transpose() * -normal);
    if (face_a >= 0) on_a = {kFaceOfA, face_a, face_separation(solids.a, solids.b, solids.b_in_a, face_a)};
    if (face_b >= 0) on_b = {kFaceOfB, face_b, face_separation(solids.b, solids.a, solids.a_in_b, face_b)};
    return on_b.separation > on_a.separation + (was == kFaceOfB ? -keep : keep) ? on_b : on_a;
}

void clip_face(const Solids& solids, const BearingFace& bearing, Manifold& out) {
    const bool on_b = bearing.bearer == kFaceOfB;
    const float slack = flush_slack(solids.size);
    const uint32_t base = face_base(on_b, bearing.face, 0);
    if (on_b) {
        face_contact(solids.b.face(bearing.face), solids.a, solids.a_in_b, base, slack, solids.wanted, out);
        move_to_a(solids.b_in_a, out);
    } else {
        face_contact(solids.a.face(bearing.face), solids.b, solids.b_in_a, base, slack, solids.wanted, out);
    }
}

// The part of line a, by its parameters, that runs over line b as seen along n, and no further beside it than width:
// beside it = n . (a(s) - b.from) x (direction of b), linear in s.
Segment side_by_side(const Segment& a, const Segment& b, const Vec3f& n, float width) {
    const float s0 = a.nearest(b.from);
    const float s1 = a.nearest(b.at(1));
    float lo = std::min(s0, s1);
    float hi = std::max(s0, s1);
    const Vec3f across = b.step.cross(n).normalized();
    const float beside = across.dot(a.from - b.from);
    const float slope = across.dot(a.step);
    if (std::fabs(slope) > 1e-12f) {
        const float first = (-width - beside) / slope;
        const float second = (width - beside) / slope;
        lo = std::max(lo, std::min(first, second));
        hi = std::min(hi, std::max(first, second));
    } else if (std::fabs(beside) > width) {
        hi = lo;
    }
    return {a.at(lo), a.step * std::max(hi - lo, 0.0f)};
}

// Both ends of the stretch where two lines run side by side.
void add_line(const Solids& solids, Manifold& out) {
    const Segment a = solids.a.line_along(out.normal);
    const Segment own = solids.b.line_along(solids.b_in_a.rotation.transpose() * -out.normal);
    const Segment b = {solids.b_in_a * own.from, solids.b_in_a.rotation * own.step};
    const float aa = a.step.squaredNorm();
    const float bb = b.step.squaredNorm();
    if (!(aa > 0 && bb > 0) || a.step.cross(b.step).squaredNorm() >= kFacingSine2 * aa * bb) return;
    const Segment stretch = side_by_side(a, b, out.normal, kBeside * solids.size);
    if (stretch.step.norm() < kShort * solids.size) return;
    uint32_t feature = kLineEnd;
    for (const float s : {0.0f, 1.0f}) {
        const Vec3f p = stretch.at(s);
        const Vec3f q = b.at(b.nearest(p));
        const float separation = out.normal.dot(q - p);
        if (separation <= solids.wanted.margin) out.points[out.count++] = {0.5f * (p + q), separation, feature};
        ++feature;
    }
}

// Where no face bears: along a line, and at the nearest point unless the line is as near.
void round_contact(const Solids& solids, const Push& push, double radius_a, Manifold& out) {
    out.normal = push.normal.cast<float>();
    add_line(solids, out);
    const float separation = float(push.separation);
    if (out.count > 0 && deepest(out) <= separation + std::min(5e-4f, 0.01f * solids.size)) return;
    const Vec3 middle = push.on_a + push.normal * (radius_a + 0.5 * push.separation);
    out.points[out.count++] = {middle.cast<float>(), separation, kLineAlone};
}

}  // namespace

float convex_convex(const Pair& pair, Manifold& out) {
    const Solids solids(pair);
    const KeptPush kept = read_push(pair.cache);
    const Push push = least_push(solids.a, solids.b, pair, kept.normal, double(pair.wanted.margin));
    if (push.separation > double(pair.wanted.margin)) {
        write(push.normal, kNothing, pair.cache);
        return float(push.separation);
    }

    const Preference preference(solids.size);
    const float separation = float(push.separation);
    const BearingFace face = best_face(solids, push.normal.cast<float>(), kept.bearer);
    Manifold clipped;
    if (face.bearer != kNothing) clip_face(solids, face, clipped);
    if (clipped.count > 0 && !preference.edge_wins(separation, face.separation, kept.bearer == kRound) &&
        !preference.face_misses(deepest(clipped), separation, face.separation)) {
        out = clipped;
        write(push.normal, face.bearer, pair.cache);
        return 0;
    }
    round_contact(solids, push, core_radius(pair.a), out);
    add_beside(clipped, out);
    write(push.normal, kRound, pair.cache);
    return 0;
}

// A plane is a face without sides. Its tangents do not matter: there are no diagonals to choose along.
float convex_plane(const Pair& pair, Manifold& out) {
    // Height of a's origin in double: a plane's own origin may be kilometres away.
    const Vec3f up = pair.at_b.rotation * pair.b.size;
    const float height = float(up.cast<double>().dot(pair.at_a.position - pair.at_b.position));
    FlatFace plane;
    plane.normal = pair.at_a.rotation.transpose() * up;
    plane.u = plane.normal.unitOrthogonal();
    plane.v = plane.normal.cross(plane.u);
    plane.offset = -height;
    face_contact(plane, Solid(pair.a), {Mat3f::Identity(), Vec3f::Zero()}, 0, 0, pair.wanted, out);
    out.normal = -plane.normal;
    return 0;
}

}  // namespace taut::collision
