// Sensors ask the broadphase's tree as queries do: pairs of contacts are made before the bodies move, and their boxes
// need not hold a body that was thrown off.
#include "detect/sensors.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "detect/detect.h"
#include "state/handle.h"

namespace taut {
namespace {

using collision::ShapeKind;

constexpr uint32_t kOverlapGrain = 16;  // overlap tests that a thread takes at a time

bool is_convex(const Shapes& shapes, const Collider& collider) {
    const ShapeKind kind = shapes[collider.shape].shape.kind;
    return kind != ShapeKind::plane && kind != ShapeKind::surface;
}

bool may_sense(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t by, uint32_t id) {
    const Collider &sensor = colliders.record[by], &visitor = colliders.record[id];
    if (visitor.sensor || visitor.node == sensor.node) return false;
    if (nodes.info[visitor.node].kind == NodeKind::fixed && !sensor.senses_static) return false;
    return filters_agree(colliders.traits[by].filter, colliders.traits[id].filter) &&
           (is_convex(shapes, sensor) || is_convex(shapes, visitor));
}

// Appends what a sensor's box meets, in the order of the tree.
void add_candidates(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                    const collision::Broadphase& broadphase, uint32_t sensor, Array<uint64_t>& candidates) {
    struct Found final : collision::Visitor {
        Found(const Nodes& n, const Colliders& c, const Shapes& s, uint32_t of, Array<uint64_t>& to)
            : nodes(n), colliders(c), shapes(s), sensor(of), out(to) {}
        void visit(uint32_t id, collision::Probe&) override {
            const bool of_soft = nodes.info[colliders.record[id].node].soft != kNone;  // seen as a whole
            if (!of_soft && may_sense(nodes, colliders, shapes, sensor, id))
                out.push_back(static_cast<uint64_t>(sensor) << 32 | id);
        }
        const Nodes& nodes;
        const Colliders& colliders;
        const Shapes& shapes;
        uint32_t sensor;
        Array<uint64_t>& out;
    };
    const Collider& collider = colliders.record[sensor];
    const collision::Placement at = placement_of(nodes, collider);
    // About its own origin: exact far from the world's.
    const collision::Box box = collision::bounds(shapes[collider.shape].shape, {Vec3::Zero(), at.rotation});
    Found found(nodes, colliders, shapes, sensor, candidates);
    broadphase.visit({at.position, Vec3::Zero(), box.lo.cast<double>(), box.hi.cast<double>()}, found);
}

// ---------------------------------------------------------------- soft bodies

// About all vertices now, thickness counted. lo > hi: it touches nothing.
SoftBounds bounds_of(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Soft& soft) {
    SoftBounds out;
    out.collider = collider_of(nodes, soft);
    if (out.collider == kNone) return out;
    for (const uint32_t node : soft.node) {
        out.lo = out.lo.cwiseMin(nodes.motion[node].x);
        out.hi = out.hi.cwiseMax(nodes.motion[node].x);
    }
    out.radius = collision::ball_radius(shapes[colliders.record[out.collider].shape].shape);
    out.lo.array() -= out.radius;
    out.hi.array() += out.radius;
    return out;
}

// Of a sensor, about its own origin: exact far from the world's.
struct SensorBox {
    Vec3 origin, lo, hi;

    SensorBox(const Shapes& shapes, const Collider& collider, const collision::Placement& at) : origin(at.position) {
        const collision::Box box = collision::bounds(shapes[collider.shape].shape, {Vec3::Zero(), at.rotation});
        lo = box.lo.cast<double>();
        hi = box.hi.cast<double>();
    }
    bool meets(const Vec3& low, const Vec3& high) const {
        return (low.array() <= hi.array()).all() && (lo.array() <= high.array()).all();
    }
};

void add_soft_candidates(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t sensor,
                         Sensors& sensors) {
    const Collider& collider = colliders.record[sensor];
    const SensorBox box(shapes, collider, placement_of(nodes, collider));
    for (const SoftBounds& soft : sensors.soft)
        if (soft.collider != kNone && box.meets(soft.lo - box.origin, soft.hi - box.origin) &&
            may_sense(nodes, colliders, shapes, sensor, soft.collider))
            sensors.candidates.push_back(static_cast<uint64_t>(sensor) << 32 | soft.collider);
}

// Whether a point is within a closed surface: the solid angles that its triangles are seen under (van Oosterom and
// Strackee 1983) make a whole sphere, not none.
bool is_within(const Nodes& nodes, const Soft& soft, const Vec3& point) {
    double angle = 0;
    for (uint32_t t = 0; t < soft.triangles(); ++t) {
        Vec3 r[3];
        double length[3];
        for (size_t k = 0; k < 3; ++k) {
            r[k] = nodes.motion[soft.node[soft.triangle[3 * size_t{t} + k]]].x - point;
            length[k] = r[k].norm();
        }
        const double across = r[0].dot(r[1].cross(r[2]));
        const double along = length[0] * length[1] * length[2] + r[0].dot(r[1]) * length[2] +
                             r[1].dot(r[2]) * length[0] + r[2].dot(r[0]) * length[1];
        angle += angle_of(across, along);
    }
    constexpr double kHalfSphere = 3.14159265358979;  // of sums of halves of solid angles
    return std::abs(angle) > kHalfSphere;
}

// Its vertices and triangles, as thick as it is; of a solid what is within as well.
bool meets_soft(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Collider& sensor,
                const Soft& soft) {
    const collision::Placement at = placement_of(nodes, sensor);
    const collision::Shape& shape = shapes[sensor.shape].shape;
    const SensorBox box(shapes, sensor, at);
    const double radius = collision::ball_radius(shapes[colliders.record[collider_of(nodes, soft)].shape].shape);
    const Vec3 thick = Vec3::Constant(radius);
    for (uint32_t t = 0; t < soft.triangles(); ++t) {
        Vec3 corner[3];
        for (size_t k = 0; k < 3; ++k)
            corner[k] = nodes.motion[soft.node[soft.triangle[3 * size_t{t} + k]]].x - at.position;
        const Vec3 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]) - thick,
                   high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]) + thick;
        if (box.meets(low, high) && collision::near_triangle(shape, at, corner, radius)) return true;
    }
    if (soft.triangles() > 0 && soft.kind == SoftKind::cloth) return false;
    for (const uint32_t node : soft.node) {
        const uint32_t own = nodes.info[node].collider;
        const Vec3 x = nodes.motion[node].x - at.position;
        if (own == kNone || !box.meets(x - thick, x + thick)) continue;
        const collision::Shape& ball = shapes[colliders.record[own].shape].shape;
        if (collision::overlap(ball, placement_of(nodes, colliders.record[own]), shape, at)) return true;
    }
    const bool bounded = is_convex(shapes, sensor);
    return bounded && soft.triangles() > 0 &&
           is_within(nodes, soft, at.position + at.rotation.cast<double>() * collision::middle(shape));
}

// ---------------------------------------------------------------- visits

bool meet(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs, uint32_t sensor,
          uint32_t visitor) {
    const uint32_t soft = nodes.info[colliders.record[visitor].node].soft;
    if (soft != kNone) return meets_soft(nodes, colliders, shapes, colliders.record[sensor], softs.record[soft]);
    const Collider *a = &colliders.record[sensor], *b = &colliders.record[visitor];
    if (!is_convex(shapes, *a)) std::swap(a, b);
    return collision::overlap(shapes[a->shape].shape, placement_of(nodes, *a), shapes[b->shape].shape,
                              placement_of(nodes, *b));
}

taut_sensor_event visit_of(const Nodes& nodes, const Colliders& colliders, uint32_t world, uint64_t key) {
    const auto bits = [&](const IdPool& ids, uint32_t index) {
        return pack_handle({index, ids.generation(index), world});
    };
    const uint32_t sensor = static_cast<uint32_t>(key >> 32), visitor = static_cast<uint32_t>(key);
    return {{bits(colliders.ids, sensor)},
            {bits(colliders.ids, visitor)},
            {bits(nodes.ids, colliders.record[sensor].node)},
            {bits(nodes.ids, colliders.record[visitor].node)},
            0,
            0};
}

// The slot is in the upper bits of a handle.
bool earlier(const taut_sensor_event& a, const taut_sensor_event& b) {
    return a.sensor.bits != b.sensor.bits ? a.sensor.bits < b.sensor.bits : a.visitor.bits < b.visitor.bits;
}

// Throws std::bad_alloc with nothing changed.
void append_difference(const Array<taut_sensor_event>& of, const Array<taut_sensor_event>& without, uint32_t step,
                       Array<taut_sensor_event>& out) {
    const size_t first = out.size();
    try {
        std::set_difference(of.begin(), of.end(), without.begin(), without.end(), std::back_inserter(out), earlier);
    } catch (...) {
        out.resize(first);
        throw;
    }
    for (size_t i = first; i < out.size(); ++i) out[i].step = step;
}

}  // namespace

void sense(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
           const collision::Broadphase& broadphase, uint32_t world, uint32_t step, Sensors& sensors) {
    if (colliders.sensors.empty() && sensors.inside.empty()) return;
    Array<uint64_t>& candidates = sensors.candidates;
    candidates.clear();
    sensors.soft.assign(colliders.sensors.empty() ? 0 : softs.record.size(), {});
    team.for_ranges(static_cast<uint32_t>(sensors.soft.size()), 1, [&](uint32_t begin, uint32_t end) {
        for (uint32_t s = begin; s < end; ++s)
            if (softs.ids.live(s)) sensors.soft[s] = bounds_of(nodes, colliders, shapes, softs.record[s]);
    });
    for (const uint32_t sensor : colliders.sensors) {
        add_candidates(nodes, colliders, shapes, broadphase, sensor, candidates);
        add_soft_candidates(nodes, colliders, shapes, sensor, sensors);
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());

    sensors.meets.resize(candidates.size());
    team.for_ranges(static_cast<uint32_t>(candidates.size()), kOverlapGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            sensors.meets[i] = meet(nodes, colliders, shapes, softs, static_cast<uint32_t>(candidates[i] >> 32),
                                    static_cast<uint32_t>(candidates[i]));
    });
    const size_t entered = sensors.enter.size();
    Array<taut_sensor_event>& found = sensors.before;  // those of the step before are told
    found.clear();
    for (size_t i = 0; i < candidates.size(); ++i)
        if (sensors.meets[i]) found.push_back(visit_of(nodes, colliders, world, candidates[i]));
    append_difference(found, sensors.inside, step, sensors.enter);
    try {
        append_difference(sensors.inside, found, step, sensors.leave);
    } catch (...) {  // entered again by the next step
        sensors.enter.resize(entered);
        throw;
    }
    sensors.inside.swap(found);
}

}  // namespace taut
