// Questions to a world between steps: what a query is, whom it sees, and what it finds. Nothing here writes to the
// world or takes memory, so that any number of threads may ask at once.
#pragma once

#include <taut/query.h>

#include "detect/detect.h"
#include "world.h"

namespace taut {

// Which colliders a query sees, by a filter as checked.
class Sight {
public:
    Sight(const World& world, const taut_query_filter& filter) : world_(world), filter_(filter) {}

    bool sees(uint32_t collider) const;
    // By its collider; without one by its kind.
    bool sees_node(uint32_t node) const;
    const World& world() const { return world_; }

private:
    const World& world_;
    const taut_query_filter& filter_;
};

// ---------------------------------------------------------------- what goes along a way

struct RayQuery {
    Vec3 from, along;

    collision::Probe probe() const { return {from, along}; }
    bool meets(const collision::Shape& shape, const collision::Placement& at, double limit, collision::Hit& hit) const {
        return collision::cast_ray(shape, at, from, along, limit, hit);
    }
};

struct CastQuery {
    const collision::Shape& shape;
    collision::Placement from;
    Vec3 along;

    collision::Probe probe() const;
    bool meets(const collision::Shape& other, const collision::Placement& at, double limit, collision::Hit& hit) const {
        return collision::cast_shape(shape, from, along, other, at, limit, hit);
    }
};

// ---------------------------------------------------------------- what stays

struct PointQuery {
    Vec3 point;

    collision::Probe probe() const { return {point, Vec3::Zero()}; }
    bool meets(const collision::Shape& other, const collision::Placement& at) const {
        return collision::contains(other, at, point);
    }
};

struct BoxQuery {
    Vec3 middle, half;  // [m]

    collision::Probe probe() const { return {middle, Vec3::Zero(), -half, half}; }
    bool meets(const collision::Shape& other, const collision::Placement& at) const;
};

struct ShapeQuery {
    const collision::Shape& shape;
    collision::Placement at;

    collision::Probe probe() const { return CastQuery{shape, at, Vec3::Zero()}.probe(); }
    bool meets(const collision::Shape& other, const collision::Placement& there) const {
        return collision::overlap(shape, at, other, there);
    }
};

// ---------------------------------------------------------------- answers

// The first that is met, or a hit of nothing.
template <class Query>
taut_query_hit first_hit(const Sight& sight, const Query& query);
// Whether anything is met.
bool any_hit(const Sight& sight, const RayQuery& query);

// Where all answers go, one call each, in any order.
template <class Item>
class Sink {
public:
    virtual void take(const Item& item) = 0;

protected:
    ~Sink() = default;
};
template <class Query>
void all_hits(const Sight& sight, const Query& query, Sink<taut_query_hit>& sink);
template <class Query>
void all_overlaps(const Sight& sight, const Query& query, Sink<taut_collider>& sink);

// Of one collider, whether or not anybody sees it: where a ray meets it, or a hit of nothing; whether it is met.
taut_query_hit hit_on(const World& world, uint32_t collider, const RayQuery& query);
template <class Query>
bool is_met(const World& world, uint32_t collider, const Query& query);

// The least axis-aligned box about a collider, found about its own place, which far from the world's is exact only so.
struct Bounds {
    Vec3 low, high;  // [m]
};
Bounds bounds_of(const World& world, uint32_t collider);

// The collider nearest to a shape, within a distance [m], or none.
taut_distance nearest(const Sight& sight, const ShapeQuery& query, float within);
// From one collider, and from a point, to another.
taut_distance distance_between(const World& world, uint32_t a, uint32_t b);
taut_distance distance_to_point(const World& world, const Vec3& point, uint32_t b);

}  // namespace taut
