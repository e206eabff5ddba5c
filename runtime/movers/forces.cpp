// Fluids and explosions: sums over the triangles of bodies' surfaces.
#include <taut/forces.h>

#include <algorithm>
#include <cmath>

#include <taut/world.h>

#include <Eigen/Cholesky>

#include "api/sized.h"
#include "collision/polyhedron_mass.h"
#include "movers/body_motion.h"
#include "movers/body_surface.h"
#include "movers/call_parts.h"

using namespace taut;

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

constexpr Range kFluidDensity{0, 1e6};  // [kg/m^3]
constexpr Range kFluidDrag{0, 100};
constexpr Range kFluidSkin{0, 1e9};          // [N s/m^3]
constexpr Range kForceSeconds{1e-4, 1};      // [s]
constexpr Range kBlastRadius{1e-3, 1e6};     // [m]
constexpr Range kBlastImpulse{-1e12, 1e12};  // [N s/m^2]
constexpr uint32_t kMostFalloff = 16;

// Middles of a triangle's sides: with a third of its area each they integrate quadratic functions exactly.
std::array<Vec3, 3> middles(const Vec3& a, const Vec3& b, const Vec3& c) {
    return {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
}

taut_result read_body_surface(taut_body body, const BodyMotion& motion, const Vec3& origin,
                              Array<SurfaceTriangle>& out) {
    constexpr uint32_t kFew = 32;
    taut_collider few[kFew];
    uint32_t count = 0;
    taut_result result = taut_body_get_colliders(body, few, kFew, &count);
    Array<taut_collider> many(out.get_allocator());
    if (result == TAUT_TOO_SMALL) {
        many.resize(count);
        result = taut_body_get_colliders(body, many.data(), count, &count);
    }
    const taut_collider* const colliders = many.empty() ? few : many.data();
    for (uint32_t i = 0; result == TAUT_OK && i < count; ++i)
        result = read_surface(colliders[i], motion.origin - origin, motion.rotation, out);
    return result;
}

// ---------------------------------------------------------------- fluids

// What is beneath the plane n . x = height of triangles about a body's centre of mass.
class Wetted {
public:
    Wetted(const taut_fluid_def& def, const BodyMotion& motion)
        : def_(def), motion_(motion), normal_(to_vec(def.normal)), everywhere_(normal_.isZero(0)) {
        if (!everywhere_) {
            normal_.normalize();
            height_ = normal_.dot(to_vec(def.point) - motion.centre);
        }
        mass_ = collision::PolyhedronMass(height_ * normal_);
    }

    void add(const SurfaceTriangle& triangle) {
        if (everywhere_) return add_part(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
        Vec3 kept[4];
        double over[3];
        int count = 0, entry = -1;  // entry: the corner where the surface comes down through the plane
        for (int k = 0; k < 3; ++k) over[k] = normal_.dot(triangle.corner[k]) - height_;
        int leave = -1;
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3;
            if (over[k] <= 0) kept[count++] = triangle.corner[k];
            if ((over[k] <= 0) == (over[next] <= 0)) continue;
            (over[k] <= 0 ? leave : entry) = count;
            kept[count++] =
                triangle.corner[k] + over[k] / (over[k] - over[next]) * (triangle.corner[next] - triangle.corner[k]);
        }
        for (int k = 2; k < count; ++k) add_part(kept[0], kept[k - 1], kept[k]);
        if (leave >= 0 && entry >= 0) add_rim(kept[entry], kept[leave]);
    }

    bool is_dry() const { return !(area_ > 0); }
    double area() const { return area_; }
    double volume() const { return std::max(0.0, mass_.volume()); }
    Vec3 middle() const { return volume() > 0 ? mass_.properties(1).centre : Vec3::Zero().eval(); }

    // Forces and torques about the centre over the next time h. With u the body's velocities, w those of the fluid and
    // F the weight and lift at the start,
    //     (M + h D + h^2/2 K) u' = M u + h (F + D w)
    // and the force that a body with u' at the end feels is lift - D (u' - w) - h/2 K u': half of the way's end, which
    // of a float takes and gives nothing.
    Vec6 force(double h) const {
        Vec6 lift = Vec6::Zero(), fall = Vec6::Zero(), u, flow = Vec6::Zero();
        const Vec3 gravity = to_vec(def_.gravity), up = -double(def_.density) * volume() * gravity;
        lift << up, middle().cross(up);
        const double mass = 1 / motion_.inv_mass;
        fall.head<3>() = mass * gravity;
        u << motion_.linear, motion_.angular;
        flow.head<3>() = to_vec(def_.velocity);
        Mat6 inertia = Mat6::Zero();
        inertia.topLeftCorner<3, 3>() = mass * Mat3::Identity();
        inertia.bottomRightCorner<3, 3>() =
            motion_.inv_inertia.isZero(0) ? Mat3::Identity().eval() : motion_.inv_inertia.inverse().eval();
        const Mat6 stiffness = std::max(0.0, -gravity.dot(normal_)) * double(def_.density) * plane_;
        const Mat6 matrix = inertia + h * drag_ + 0.5 * h * h * stiffness;
        const Vec6 right = inertia * u + h * (lift + fall + drag_ * flow);
        const Vec6 end = matrix.ldlt().solve(right);
        return lift - drag_ * (end - flow) - 0.5 * h * (stiffness * end);
    }

private:
    void add_part(const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 cross = (b - a).cross(c - a);
        const double twice = cross.norm();
        if (!(twice > 0)) return;
        mass_.add(a, b, c);
        area_ += 0.5 * twice;
        const Vec3 out = cross / twice, wind = motion_.linear - to_vec(def_.velocity);
        for (const Vec3& p : middles(a, b, c)) {
            const double against = std::max(0.0, out.dot(wind + motion_.angular.cross(p)));
            const double each =
                (0.5 * double(def_.density) * double(def_.drag) * against + double(def_.skin_drag)) * twice / 6;
            Eigen::Matrix<double, 3, 6> velocity;
            velocity << Mat3::Identity(), -hat(p);
            drag_ += each * velocity.transpose() * velocity;
        }
    }
    // The area that the fluid's plane has within the body, by triangles to its rim: int J J^T dA, J = (n, p x n).
    void add_rim(const Vec3& from, const Vec3& to) {
        const Vec3 foot = height_ * normal_;
        const double area = 0.5 * normal_.dot((from - foot).cross(to - foot));
        for (const Vec3& p : middles(foot, from, to)) {
            Vec6 rise;
            rise << normal_, p.cross(normal_);
            plane_ += area / 3 * rise * rise.transpose();
        }
    }

    const taut_fluid_def& def_;
    const BodyMotion& motion_;
    Vec3 normal_;
    bool everywhere_;
    double height_ = 0, area_ = 0;
    collision::PolyhedronMass mass_{Vec3::Zero()};
    Mat6 drag_ = Mat6::Zero(), plane_ = Mat6::Zero();
};

// ---------------------------------------------------------------- explosions

struct Push {
    taut_body body;
    Vec3 impulse, moment;  // about the centre of mass [N s], [N m s]
};

struct Blast {
    const taut_explosion_def& def;
    Vec3 centre;

    // On a surface whose points are relative to the centre of the blast.
    void add(std::span<const SurfaceTriangle> surface, const Vec3& arm, Push& push) const {
        for (const SurfaceTriangle& t : surface) {
            const Vec3 cross = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
            for (const Vec3& p : middles(t.corner[0], t.corner[1], t.corner[2])) {
                const double distance = p.norm(), left = 1 - distance / double(def.radius);
                if (!(left > 0) || !(distance > 0)) continue;
                const double shown = -cross.dot(p) / distance / 6;  // area, a third of the triangle's
                if (!(shown > 0)) continue;
                double strength = double(def.impulse) * shown;
                for (uint32_t i = 0; i < def.falloff; ++i) strength *= left;
                const Vec3 impulse = strength / distance * p;
                push.impulse += impulse;
                push.moment += (p - arm).cross(impulse);
            }
        }
    }
};

// A filter that sees no collider of one body beside what the host's leaves out.
class FilterWithout {
public:
    explicit FilterWithout(const taut_query_filter& filter) : filter_(filter) {
        std::copy_n(filter.ignored_bodies, filter.ignored_body_count, bodies_.begin());
        filter_.ignored_bodies = bodies_.data();
        ++filter_.ignored_body_count;
    }
    const taut_query_filter* of(taut_body body) {
        bodies_[filter_.ignored_body_count - 1] = body;
        return &filter_;
    }

private:
    taut_query_filter filter_;
    std::array<taut_body, TAUT_QUERY_MAX_IGNORED> bodies_{};
};

taut_result is_hidden(taut_world world, const Vec3& from, taut_collider collider, taut_body body, FilterWithout& filter,
                      bool& hidden) {
    taut_pos low, high;
    taut_result result = taut_collider_get_bounds(collider, &low, &high);
    if (result != TAUT_OK) return result;
    const Vec3 way = 0.5 * (to_vec(low) + to_vec(high)) - from;
    hidden = false;
    if (!(way.norm() > 1e-6)) return TAUT_OK;  // the shortest ray
    const taut_ray ray = {to_pos(from), to_vec3(way), 0};
    int32_t met = 0;
    result = taut_world_cast_ray_any(world, &ray, filter.of(body), &met);
    hidden = met != 0;
    return result;
}

taut_result find_pushes(taut_world world, const Blast& blast, const taut_query_filter& filter, Array<Push>& pushes) {
    const Vec3 reach = Vec3::Constant(double(blast.def.radius));
    const taut_pos low = to_pos(blast.centre - reach), high = to_pos(blast.centre + reach);
    uint32_t count = 0;
    taut_result result = taut_world_overlap_box(world, low, high, &filter, nullptr, 0, &count);
    if (result != TAUT_TOO_SMALL) return result;
    Array<taut_collider> colliders(count, taut_collider{0}, pushes.get_allocator());
    result = taut_world_overlap_box(world, low, high, &filter, colliders.data(), count, &count);
    Array<SurfaceTriangle> surface(pushes.get_allocator());
    FilterWithout without(filter);
    for (uint32_t i = 0; result == TAUT_OK && i < count; ++i) {
        taut_body body;
        BodyMotion motion;
        bool hidden = false;
        result = taut_collider_get_body(colliders[i], &body);
        if (result == TAUT_OK) result = read_motion(body, motion);
        if (result != TAUT_OK || !motion.is_pushed()) continue;
        if (blast.def.occlusion) result = is_hidden(world, blast.centre, colliders[i], body, without, hidden);
        if (result != TAUT_OK || hidden) continue;
        surface.clear();
        result = read_surface(colliders[i], motion.origin - blast.centre, motion.rotation, surface);
        Push push{body, Vec3::Zero(), Vec3::Zero()};
        blast.add(surface, motion.centre - blast.centre, push);
        if (motion.kind == TAUT_BODY_PARTICLE) push.moment.setZero();
        if (!push.impulse.isZero(0)) pushes.push_back(push);
    }
    return result;
}

// One for each body: sums of what its colliders got.
void sum_pushes(Array<Push>& pushes) {
    std::ranges::stable_sort(pushes, {}, [](const Push& each) { return each.body.bits; });
    size_t kept = 0;
    for (const Push& each : pushes) {
        if (kept > 0 && pushes[kept - 1].body.bits == each.body.bits) {
            pushes[kept - 1].impulse += each.impulse;
            pushes[kept - 1].moment += each.moment;
        } else {
            pushes[kept++] = each;
        }
    }
    pushes.erase(pushes.begin() + static_cast<ptrdiff_t>(kept), pushes.end());
}

taut_result check_push(Check& check, const Push& push) {
    BodyMotion motion;
    if (const taut_result result = read_motion(push.body, motion); result != TAUT_OK) return refuse_as(check, result);
    const double most = kSpeed.hi * (1 - 1e-6);
    check
        .require((motion.linear + motion.inv_mass * push.impulse).norm() <= most,
                 "impulse would drive a body past 1e4 m/s")
        .require((motion.angular + motion.inv_inertia * push.moment).norm() <= most,
                 "impulse would drive a body past 1e4 rad/s");
    return check.result();
}

// The host's allocator, for the length of a call.
taut_result read_hooks(const char* call, taut_world world, taut_hooks& hooks) {
    return with_world(call, world, Use::read, [&](const World& target) {
        hooks = target.def.hooks;
        return TAUT_OK;
    });
}

}  // namespace

void taut_fluid_def_init_sized(taut_fluid_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_fluid_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.density = 1000;
        own.normal = {0, 1, 0};
        own.gravity = {0, -9.81f, 0};
        own.drag = 1;
    });
}

void taut_explosion_def_init_sized(taut_explosion_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_explosion_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.radius = 10;
        own.impulse = 1000;
        own.falloff = 1;
    });
}

taut_result taut_body_apply_fluid_sized(taut_body body, const taut_fluid_def* given, float seconds,
                                        taut_fluid_report* first, uint32_t size) {
    Check check("taut_body_apply_fluid");
    taut_fluid_def def;
    if (!take_def(check, given, taut_fluid_def_init, def)) return check.result();
    check.number("density", def.density, kFluidDensity)
        .bounded("point", def.point, kPosition)
        .vector("normal", def.normal, kDirection)
        .vector("gravity", def.gravity, kGravity)
        .bounded("velocity", def.velocity, kSpeed)
        .number("drag", def.drag, kFluidDrag)
        .number("skin_drag", def.skin_drag, kFluidSkin)
        .number("seconds", seconds, kForceSeconds);
    if (!check) return check.result();
    return contain(check.call(), [&] {
        BodyMotion motion;
        taut_result result = read_motion(body, motion);
        taut_hooks hooks{};
        HandleBits bits;
        if (result == TAUT_OK && unpack_handle(body.bits, bits)) result = read_hooks(check.call(), {bits.world}, hooks);
        Memory memory(hooks);
        Array<SurfaceTriangle> surface(memory);
        if (result == TAUT_OK) result = read_body_surface(body, motion, motion.centre, surface);
        if (result != TAUT_OK) return refuse_as(check, result);
        Wetted wetted(def, motion);
        for (const SurfaceTriangle& each : surface) wetted.add(each);
        taut_fluid_report report{};
        report.volume = to_float(wetted.volume());
        report.area = to_float(wetted.area());
        if (wetted.volume() > 0) report.centre = to_pos(motion.centre + wetted.middle());
        if (motion.is_pushed() && !wetted.is_dry()) {
            const Vec6 force = wetted.force(double(seconds));
            report.force = to_vec3(force.head<3>());
            report.torque = motion.kind == TAUT_BODY_PARTICLE ? taut_vec3{0, 0, 0} : to_vec3(force.tail<3>());
            result = taut_body_apply_force(body, report.force, report.torque);
            if (result != TAUT_OK) return refuse_as(check, result);
        }
        if (first) *RecordOut<taut_fluid_report>(first, size) = report;
        return TAUT_OK;
    });
}

taut_result taut_world_apply_explosion(taut_world world, const taut_explosion_def* given, uint32_t* pushed) {
    Check check(__func__);
    taut_explosion_def def;
    if (!take_def(check, given, taut_explosion_def_init, def)) return check.result();
    check.number("radius", def.radius, kBlastRadius)
        .bounded("position", def.position, Range{kPosition.lo + kBlastRadius.hi, kPosition.hi - kBlastRadius.hi})
        .number("impulse", def.impulse, kBlastImpulse)
        .count("falloff", def.falloff, 0, kMostFalloff)
        .boolean("occlusion", def.occlusion)
        .zero("reserved", def.reserved);
    taut_query_filter filter;
    if (!check || !take_filter(check, def.filter, TAUT_QUERY_MAX_IGNORED - 1, TAUT_QUERY_MAX_IGNORED, filter))
        return check.result();
    return contain(check.call(), [&] {
        taut_hooks hooks{};
        if (const taut_result result = read_hooks(check.call(), world, hooks); result != TAUT_OK) return result;
        Memory memory(hooks);
        Array<Push> pushes(memory);
        taut_result result = find_pushes(world, {def, to_vec(def.position)}, filter, pushes);
        if (result != TAUT_OK) return refuse_as(check, result);
        sum_pushes(pushes);
        for (const Push& each : pushes)
            if (result = check_push(check, each); result != TAUT_OK) return result;
        for (const Push& each : pushes) {
            result = taut_body_apply_impulse(each.body, to_vec3(each.impulse), to_vec3(each.moment));
            if (result != TAUT_OK) return refuse_as(check, result);
        }
        if (pushed) *pushed = static_cast<uint32_t>(pushes.size());
        return TAUT_OK;
    });
}
