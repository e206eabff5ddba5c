#include "collision_oracle.h"

#include <algorithm>
#include <cmath>

#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <ccd/ccd.h>

namespace taut::collision::oracle {

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
    shape.hull = build_hull(points, 64, 1e-3f, &reason);
    return shape;
}

Shape random_shape(ShapeKind kind, Random& random) {
    const auto size = [&] { return float(random.uniform(0.2, 0.6)); };
    if (kind == ShapeKind::plane) return plane(random.unit().cast<float>());
    if (kind == ShapeKind::box) return box(size(), size(), size());
    if (kind == ShapeKind::sphere) return sphere(size());
    if (kind == ShapeKind::capsule) return capsule(0.5f * size(), size());
    // Off the body's origin, to show that nothing relies on the centre.
    const Vec3 away = 0.2 * random.unit();
    std::vector<Vec3f> points;
    const int count = int(random.uniform(8, 30));
    for (int i = 0; i < count; ++i) points.push_back((away + random.uniform(0.3, 0.5) * random.unit()).cast<float>());
    return hull(points);
}

const char* name(ShapeKind kind) {
    constexpr const char* kNames[kShapeKinds] = {"plane", "box", "sphere", "capsule", "hull", "surface"};
    return kNames[size_t(kind)];
}

double Core::reach(const Vec3& direction) const {
    double most = -1e300;
    for (const Vec3& p : points) most = std::max(most, direction.dot(p));
    return most;
}

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
        out.edges.push_back((out.points[1] - out.points[0]).normalized());
    } else if (shape.kind == ShapeKind::box) {
        for (int i = 0; i < 8; ++i) add(i & 1 ? h.x() : -h.x(), i & 2 ? h.y() : -h.y(), i & 4 ? h.z() : -h.z());
        for (int k = 0; k < 3; ++k) {
            const Vec3 axis = at.rotation.col(k).cast<double>();
            out.normals.push_back(axis);
            out.normals.push_back(-axis);
            out.edges.push_back(axis);
        }
    } else {
        for (const Vec3f& v : hull_vertices(*shape.hull)) add(v.x(), v.y(), v.z());
        std::vector<uint32_t> indices;
        hull_triangles(*shape.hull, indices);
        for (size_t i = 0; i < indices.size(); i += 3) {
            const Vec3 p[3] = {out.points[indices[i]], out.points[indices[i + 1]], out.points[indices[i + 2]]};
            out.normals.push_back((p[1] - p[0]).cross(p[2] - p[0]).normalized());
            for (int k = 0; k < 3; ++k) {
                if (indices[i + size_t(k)] < indices[i + size_t((k + 1) % 3)])
                    out.edges.push_back((p[(k + 1) % 3] - p[k]).normalized());
            }
        }
    }
    return out;
}

namespace {

void ccd_support(const void* object, const ccd_vec3_t* d, ccd_vec3_t* out) {
    const Vec3 direction(d->v[0], d->v[1], d->v[2]);
    const auto& points = static_cast<const Core*>(object)->points;
    const Vec3& best = *std::max_element(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
        return direction.dot(p) < direction.dot(q);
    });
    ccdVec3Set(out, best.x(), best.y(), best.z());
}

// Bullet's GJK on the bare points; 1e30 where it finds them touching.
double bullet_distance(const Core& a, const Core& b) {
    btConvexHullShape shape_a, shape_b;
    const Vec3 origin = a.points[0];
    const auto fill = [&](const Core& from, btConvexHullShape& to) {
        for (const Vec3& p : from.points) {
            const Vec3 r = p - origin;
            to.addPoint(btVector3(float(r.x()), float(r.y()), float(r.z())), false);
        }
        to.recalcLocalAabb();
        to.setMargin(0);
    };
    fill(a, shape_a);
    fill(b, shape_b);
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
    for (const Vec3& p : a.edges) {
        for (const Vec3& q : b.edges) {
            const Vec3 cross = p.cross(q);
            if (cross.norm() < 1e-6) continue;
            test(cross.normalized());
            test(-cross.normalized());
        }
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

double separation(const Core& a, const Core& b) {
    const double radii = a.radius + b.radius;
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
    const Core solid = core(shape, at);
    double most = -1e300;
    for (const Vec3& n : solid.normals) most = std::max(most, n.dot(point) - solid.reach(n));
    return most;
}

}  // namespace taut::collision::oracle
