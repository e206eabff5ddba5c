// Sensors ask the broadphase's tree as queries do: pairs of contacts are made before the bodies move, and their boxes
// need not hold a body that was thrown off.
#include "detect/sensors.h"

#include <algorithm>
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
            if (may_sense(nodes, colliders, shapes, sensor, id))
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

bool meet(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t sensor, uint32_t visitor) {
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

void sense(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
           const collision::Broadphase& broadphase, uint32_t world, uint32_t step, Sensors& sensors) {
    if (colliders.sensors.empty() && sensors.inside.empty()) return;
    Array<uint64_t>& candidates = sensors.candidates;
    candidates.clear();
    for (const uint32_t sensor : colliders.sensors)
        add_candidates(nodes, colliders, shapes, broadphase, sensor, candidates);
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());

    sensors.meets.resize(candidates.size());
    team.for_ranges(static_cast<uint32_t>(candidates.size()), kOverlapGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            sensors.meets[i] = meet(nodes, colliders, shapes, static_cast<uint32_t>(candidates[i] >> 32),
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
