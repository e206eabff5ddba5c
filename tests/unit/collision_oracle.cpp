#include "collision_oracle.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btConvexInternalShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <ccd/ccd.h>

namespace taut::collision::oracle {

Memory& memory() {
    static Memory all{taut_hooks{}};
    return all;
}

std::vector<Vec3f> triangles_of(const Shape& shape) {
    struct List final : PointSink {
        void take(const Vec3f& point) override { points.push_back(point); }
        std::vector<Vec3f> points;
    } list;
    if (shape.hull)
        hull_triangles(*shape.hull, list);
    else
        surface_triangles(shape, list);
    return std::move(list.points);
}

Vec3 Random::unit() {
    while (true) {
        const Vec3 v(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
}

Mat3f Random::rotation() {
    const Vec3 axis = unit();
    const double angle = uniform(0, 6.28);
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix().cast<float>();
}

Shape box(float hx, float hy, float hz) {
    Shape shape;
    shape.kind = ShapeKind::box;
    shape.size = Vec3f(hx, hy, hz);
    return shape;
}

Shape sphere(float radius) {
    Shape shape;
    shape.kind = ShapeKind::sphere;
    shape.size = Vec3f(radius, 0, 0);
    return shape;
}

Shape capsule(float radius, float half_length) {
    Shape shape;
    shape.kind = ShapeKind::capsule;
    shape.size = Vec3f(radius, half_length, 0);
    return shape;
}

Shape cylinder(float radius, float half_length) {
    Shape shape = capsule(radius, half_length);
    shape.kind = ShapeKind::cylinder;
    return shape;
}

Shape cone(float radius, float half_length) {
    Shape shape = capsule(radius, half_length);
    shape.kind = ShapeKind::cone;
    return shape;
}

Shape tapered_capsule(float low, float half_length, float high) {
    Shape shape;
    shape.kind = ShapeKind::tapered_capsule;
    shape.size = Vec3f(low, half_length, high);
    return shape;
}

Shape plane(const Vec3f& normal) {
    Shape shape;
    shape.kind = ShapeKind::plane;
    shape.size = normal;
    return shape;
}

Shape hull(const std::vector<Vec3f>& points) {
    Shape shape;
    shape.kind = ShapeKind::hull;
    const char* reason = nullptr;
    shape.hull = build_hull(points, 64, 1e-3f, &reason, memory());
    return shape;
}

Shape random_shape(ShapeKind kind, Random& random) {
    const auto size = [&] { return float(random.uniform(0.2, 0.6)); };
    if (kind == ShapeKind::plane) return plane(random.unit().cast<float>());
    if (kind == ShapeKind::box) return box(size(), size(), size());
    if (kind == ShapeKind::sphere) return sphere(size());
    if (kind == ShapeKind::capsule) return capsule(0.5f * size(), size());
    if (kind == ShapeKind::cylinder) return cylinder(size(), size());
    if (kind == ShapeKind::cone) return cone(size(), size());
    if (kind == ShapeKind::tapered_capsule) {
        const float low = 0.5f * size(), high = 0.5f * size();
        return tapered_capsule(low, size(), high);
    }
    // Off the body's origin, to show that nothing relies on the centre.
    const Vec3 away = 0.2 * random.unit();
    std::vector<Vec3f> points;
    const int count = int(random.uniform(8, 30));
    for (int i = 0; i < count; ++i) points.push_back((away + random.uniform(0.3, 0.5) * random.unit()).cast<float>());
    return hull(points);
}

const char* name(ShapeKind kind) {
    constexpr const char* kNames[kShapeKinds] = {"plane",    "box",  "sphere",          "capsule", "hull",
                                                 "cylinder", "cone", "tapered_capsule", "surface"};
    return kNames[size_t(kind)];
}

Vec3 Core::furthest(const Vec3& direction) const {
    Vec3 best = Vec3::Zero();
    double most = -1e300;
    const auto offer = [&](const Vec3& p) {
        if (direction.dot(p) > most) {
            most = direction.dot(p);
            best = p;
        }
    };
    for (const Vec3& p : points) offer(p);
    for (const Disc& disc : discs) {
        Vec3 across = direction - disc.axis * disc.axis.dot(direction);
        if (across.norm() < 1e-9 * direction.norm()) across = disc.axis.unitOrthogonal();
        offer(disc.centre + across * (disc.radius / across.norm()));
    }
    for (const Ball& ball : balls) offer(ball.centre + direction * (ball.radius / direction.norm()));
    return best;
}

double Core::reach(const Vec3& direction) const { return direction.dot(furthest(direction)); }

Core core(const Shape& shape, const Placement& at) {
    Core out;
    const auto add = [&](double x, double y, double z) {
        out.points.push_back(at.rotation.cast<double>() * Vec3(x, y, z) + at.position);
    };
    const Vec3 h = shape.size.cast<double>();
    if (shape.kind == ShapeKind::sphere) {
        add(0, 0, 0);
        out.radius = h.x();
    } else if (shape.kind == ShapeKind::capsule) {
        add(0, -h.y(), 0);
        add(0, h.y(), 0);
        out.radius = h.x();
        out.edges.push_back({out.points[0], out.points[1] - out.points[0]});
    } else if (shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone) {
        const Vec3 axis = at.rotation.col(1).cast<double>().normalized();
        out.discs.push_back({at.position - h.y() * axis, axis, h.x()});
        if (shape.kind == ShapeKind::cone) {
            add(0, h.y(), 0);
        } else {
            out.discs.push_back({at.position + h.y() * axis, axis, h.x()});
            out.normals.push_back(axis);
        }
        out.normals.push_back(-axis);
    } else if (shape.kind == ShapeKind::tapered_capsule) {
        const Vec3 axis = at.rotation.col(1).cast<double>();
        out.balls = {{at.position - h.y() * axis, h.x()}, {at.position + h.y() * axis, h.z()}};
    } else if (shape.kind == ShapeKind::box) {
        for (int i = 0; i < 8; ++i) add(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
        for (int k = 0; k < 3; ++k) {
            const Vec3 axis = at.rotation.col(k).cast<double>();
            out.normals.push_back(axis);
            out.normals.push_back(-axis);
            for (size_t i = 0; i < 8; ++i)
                if (!(i >> k & 1)) out.edges.push_back({out.points[i], out.points[i | size_t(1) << k] - out.points[i]});
        }
    } else {
        const std::span<const Vec3f> vertices = hull_vertices(*shape.hull);
        for (const Vec3f& v : vertices) add(v.x(), v.y(), v.z());
        const std::vector<Vec3f> corners = triangles_of(shape);
        for (size_t i = 0; i < corners.size(); i += 3) {
            size_t index[3];
            Vec3 p[3];
            for (size_t k = 0; k < 3; ++k) {
                index[k] = size_t(std::ranges::find(vertices, corners[i + k]) - vertices.begin());
                p[k] = out.points[index[k]];
            }
            out.normals.push_back((p[1] - p[0]).cross(p[2] - p[0]).normalized());
            for (int k = 0; k < 3; ++k) {
                if (index[k] < index[(k + 1) % 3]) out.edges.push_back({p[k], p[(k + 1) % 3] - p[k]});
            }
        }
    }
    return out;
}

namespace {

void ccd_support(const void* object, const ccd_vec3_t* d, ccd_vec3_t* out) {
    const Vec3 best = static_cast<const Core*>(object)->furthest(Vec3(d->v[0], d->v[1], d->v[2]));
    ccdVec3Set(out, best.x(), best.y(), best.z());
}

// A core as Bullet asks for one, about an origin near by.
class BulletCore : public btConvexInternalShape {
public:
    BulletCore(const Core& core, const Vec3& origin) : core_(core), origin_(origin) {
        m_shapeType = CUSTOM_CONVEX_SHAPE_TYPE;
        setMargin(0);
    }
    btVector3 localGetSupportingVertexWithoutMargin(const btVector3& d) const override {
        const Vec3 p = core_.furthest(Vec3(d.x(), d.y(), d.z())) - origin_;
        return btVector3(float(p.x()), float(p.y()), float(p.z()));
    }
    void batchedUnitVectorGetSupportingVertexWithoutMargin(const btVector3*, btVector3*, int) const override {}
    void calculateLocalInertia(btScalar, btVector3&) const override {}
    const char* getName() const override { return "core"; }

private:
    const Core& core_;
    const Vec3 origin_;
};

// Bullet's GJK on the bare cores; 1e30 where it finds them touching.
double bullet_distance(const Core& a, const Core& b) {
    const Vec3 origin = a.furthest(Vec3::UnitX());
    const BulletCore shape_a(a, origin), shape_b(b, origin);
    btVoronoiSimplexSolver simplex;
    btGjkPairDetector detector(&shape_a, &shape_b, &simplex, nullptr);
    btGjkPairDetector::ClosestPointInput input;
    input.m_transformA.setIdentity();
    input.m_transformB.setIdentity();
    btPointCollector result;
    detector.getClosestPoints(input, result, nullptr);
    return result.m_hasResult ? double(result.m_distance) : 1e30;
}

// Largest separation over all axes that can bear the least push of two overlapping polytopes or segments.
double by_all_axes(const Core& a, const Core& b) {
    double best = -1e300;
    const auto test = [&](const Vec3& n) { best = std::max(best, -b.reach(-n) - a.reach(n)); };
    for (const Vec3& n : a.normals) test(n);
    for (const Vec3& n : b.normals) test(-n);
    // No axis separates by more than two points are apart along it: most edges need no look at all corners.
    for (const Core::Line& p : a.edges) {
        for (const Core::Line& q : b.edges) {
            const Vec3 cross = p.along.cross(q.along);
            const double length = cross.norm(), apart = cross.dot(q.from - p.from);
            if (length < 1e-6 * p.along.norm() * q.along.norm()) continue;
            if (apart > best * length) test(cross / length);
            if (-apart > best * length) test(-cross / length);
        }
    }
    return best;
}

// Largest separation over all directions: a net over the sphere and the faces' normals, then a pattern search from the
// best of them.
double by_all_directions(const Core& a, const Core& b, const Vec3& known) {
    const auto along = [&](const Vec3& n) { return -b.reach(-n) - a.reach(n); };
    std::vector<std::pair<double, Vec3>> tried;
    const auto test = [&](const Vec3& n) { tried.emplace_back(along(n), n); };
    for (const Vec3& n : a.normals) test(n);
    for (const Vec3& n : b.normals) test(-n);
    if (known != Vec3::Zero()) test(known.normalized());
    constexpr int kNet = 400;
    for (int i = 0; i < kNet; ++i) {  // a spiral, turned by the golden angle
        const double y = 1 - (2 * i + 1.0) / kNet, across = std::sqrt(1 - y * y), turn = 2.39996322972865332 * i;
        test(Vec3(across * std::cos(turn), y, across * std::sin(turn)));
    }
    constexpr int kStarts = 5;
    std::partial_sort(tried.begin(), tried.begin() + kStarts, tried.end(),
                      [](const auto& p, const auto& q) { return p.first > q.first; });
    double best = -1e300;
    for (int i = 0; i < kStarts; ++i) {
        auto [most, n] = tried[size_t(i)];
        for (double step = 0.1, turn = 0; step > 1e-6; turn += 0.7) {
            const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
            const double before = most;
            const Vec3 from = n;
            for (int k = 0; k < 6; ++k) {
                const double angle = turn + k * 1.04719755119659775;
                const Vec3 there = (from + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
                if (const double value = along(there); value > most) {
                    most = value;
                    n = there;
                }
            }
            if (most <= before) step *= 0.6;
        }
        best = std::max(best, most);
    }
    return best;
}

}  // namespace

bool cores_overlap(const Core& a, const Core& b) {
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = ccd.support2 = ccd_support;
    ccd.max_iterations = 500;
    return ccdGJKIntersect(&a, &b, &ccd) != 0;
}

double separation(const Core& a, const Core& b, const Vec3& known) {
    const double radii = a.radius + b.radius;
    if (a.curved() || b.curved()) return by_all_directions(a, b, known) - radii;
    const double gap = by_all_axes(a, b);
    // Two polytopes, or one and a segment, overlap if no axis separates them.
    const bool solid = !a.normals.empty() || !b.normals.empty();
    if (solid && gap <= 0) return gap - radii;
    return bullet_distance(a, b) - radii;
}

double distance_at_least(const Shape& shape, const Placement& at, const Vec3& point) {
    const Vec3 p = at.rotation.cast<double>().transpose() * (point - at.position);
    if (shape.kind == ShapeKind::plane) return shape.size.cast<double>().dot(p);
    if (shape.kind == ShapeKind::sphere) return p.norm() - shape.size.x();
    if (shape.kind == ShapeKind::capsule) {
        const double h = shape.size.y();
        return (p - Vec3(0, std::clamp(p.y(), -h, h), 0)).norm() - shape.size.x();
    }
    if (shape.kind == ShapeKind::tapered_capsule) {
        // In the plane through the axis: the ball on either side of the line that the side's normals sweep.
        const double low = shape.size.x(), half = shape.size.y(), high = shape.size.z();
        const double sine = (low - high) / (2 * half), cosine = std::sqrt(1 - sine * sine);
        const double x = std::hypot(p.x(), p.z());
        const double y = std::clamp(p.y() - x * sine / cosine, -half, half);
        return std::hypot(x, p.y() - y) - (low + (high - low) * (y + half) / (2 * half));
    }
    if (shape.kind == ShapeKind::cylinder) {
        return std::max(std::hypot(p.x(), p.z()) - shape.size.x(), std::fabs(p.y()) - shape.size.y());
    }
    if (shape.kind == ShapeKind::cone) {
        const double r = shape.size.x(), half = shape.size.y();
        const double side = (2 * half * std::hypot(p.x(), p.z()) + r * (p.y() - half)) / std::hypot(2 * half, r);
        return std::max(side, -p.y() - half);
    }
    const Core solid = core(shape, at);
    double most = -1e300;
    for (const Vec3& n : solid.normals) most = std::max(most, n.dot(point) - solid.reach(n));
    return most;
}

}  // namespace taut::collision::oracle
