// Answers from elsewhere for the collision tests: random shapes and poses, and the exact separation of two shapes
// by libccd's GJK, Bullet's GJK and a search over all axes, or over all directions, in double precision.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "base/memory.h"
#include "collision/collide.h"

namespace taut::collision::oracle {

// What shapes of tests are built with.
Memory& memory();
// Corners of triangles, three a triangle.
std::vector<Vec3f> triangles_of(const Shape& shape);

class Random {
public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    double uniform(double lo, double hi) { return lo + (hi - lo) * double(engine_()) / 4294967296.0; }
    Vec3 unit();
    Mat3f rotation();

private:
    std::mt19937 engine_;
};

Shape box(float hx, float hy, float hz);
Shape sphere(float radius);
Shape capsule(float radius, float half_length);
Shape cylinder(float radius, float half_length);
Shape cone(float radius, float half_length);
Shape tapered_capsule(float low, float half_length, float high);
Shape plane(const Vec3f& normal);
Shape hull(const std::vector<Vec3f>& points);
Shape random_shape(ShapeKind kind, Random& random);

const char* name(ShapeKind kind);

// A shape as the hull of points, discs and balls in the world, grown by a radius; triangles and edges where points
// alone span a volume.
struct Core {
    struct Disc {
        Vec3 centre, axis;
        double radius;
    };
    struct Ball {
        Vec3 centre;
        double radius;
    };
    std::vector<Vec3> points;
    std::vector<Disc> discs;
    std::vector<Ball> balls;
    double radius = 0;
    std::vector<Vec3> normals;  // outward
    struct Line {
        Vec3 from, along;
    };
    std::vector<Line> edges;
    bool curved() const { return !discs.empty() || !balls.empty(); }
    Vec3 furthest(const Vec3& direction) const;  // point, without the radius
    double reach(const Vec3& direction) const;   // max direction . p over unit directions, without the radius
};
Core core(const Shape& shape, const Placement& at);

// Signed distance of two cores less their radii: exact distance where the cores are apart, least push where
// they overlap; of curved ones the best that a search finds, and no worse than along a direction known. Not for planes.
double separation(const Core& a, const Core& b, const Vec3& known = Vec3::Zero());
bool cores_overlap(const Core& a, const Core& b);  // libccd's GJK, without the radii

// Signed distance of a point from a shape, at least: exact for round shapes and planes, by the faces for others.
double distance_at_least(const Shape& shape, const Placement& at, const Vec3& point);

}  // namespace taut::collision::oracle
