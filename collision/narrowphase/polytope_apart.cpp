// How far apart a box or hull and another are along the axis that parted them, all in world axes.
#include <cmath>

#include "collision/hull.h"
#include "collision/narrowphase/polytope_cache.h"

namespace taut::collision {
namespace {

// A box or hull as axes of the world meet it.
struct Placed {
    const Shape& shape;
    const Mat3f& rotation;

    bool valid(AxisKind kind, int number) const {
        const bool edges = kind == AxisKind::edges;
        if (!shape.hull) return number < (edges ? 12 : 6);
        return size_t(number) < (edges ? shape.hull->edges.size() : shape.hull->faces.size());
    }
    // Its reach about its origin along an axis.
    float reach(const Vec3f& axis) const {
        const Vec3f own = rotation.transpose() * axis;
        return shape.hull ? highest(shape.hull->view(), own) : own.cwiseAbs().dot(shape.size);
    }
    Vec3f normal(int face) const {
        if (shape.hull) return rotation * shape.hull->faces[size_t(face)].normal;
        return rotation.col(face / 2) * (face % 2 ? 1.0f : -1.0f);
    }
    float offset(int face) const { return shape.hull ? shape.hull->faces[size_t(face)].offset : shape.size[face / 2]; }
    // Its direction, of any length.
    Vec3f edge(int number) const {
        if (!shape.hull) return rotation.col(number / 4);
        const Polytope& polytope = shape.hull->view();
        return rotation * polytope.direction(polytope.edges[size_t(number)]);
    }
    Vec3f centre() const { return shape.hull ? Vec3f(rotation * shape.hull->centre) : Vec3f::Zero(); }
};

// Along two edges' common normal.
float edges_part(const Placed& a, const Placed& b, Axis axis, const Sides& sides) {
    const Vec3f along_a = a.edge(axis.i), along_b = b.edge(axis.j);
    Vec3f n = along_a.cross(along_b);
    const float squared = n.squaredNorm();
    if (!(squared > kParallel * along_a.squaredNorm() * along_b.squaredNorm())) return kNoAxis;
    if (n.dot(sides.apart + b.centre() - a.centre()) < 0) n = -n;
    return (n.dot(sides.apart) - a.reach(n) - b.reach(-n)) / std::sqrt(squared);
}

}  // namespace

float polytopes_apart(const Sides& sides, const PairCache& cache) {
    const Kept kept = read_axis(cache.words[0]);
    if (kept.touching) return kNoAxis;
    const Placed a = {sides.a, sides.at_a.rotation};
    const Placed b = {sides.b, sides.at_b.rotation};
    const Axis axis = kept.axis;
    if (axis.kind == AxisKind::none || !a.valid(axis.kind, axis.i) || !b.valid(axis.kind, axis.j)) return kNoAxis;
    if (axis.kind == AxisKind::edges) return edges_part(a, b, axis, sides);
    if (axis.kind == AxisKind::face_a) {
        const Vec3f n = a.normal(axis.i);
        return n.dot(sides.apart) - a.offset(axis.i) - b.reach(-n);
    }
    const Vec3f n = b.normal(axis.j);
    return -n.dot(sides.apart) - b.offset(axis.j) - a.reach(-n);
}

}  // namespace taut::collision
