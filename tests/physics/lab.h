// A laboratory for the tests: a world made through the public C API, vectors in double and the quantities of
// mechanics, computed here and not by the library.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <taut/taut.h>

namespace lab {

constexpr double kG = 9.81;  // [m/s^2], as float in taut_world_def's default
constexpr double kPi = std::numbers::pi;

struct Vec {
    double x = 0, y = 0, z = 0;

    Vec() = default;
    Vec(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
    Vec(taut_vec3 v)
        : x(static_cast<double>(v.x)), y(static_cast<double>(v.y)), z(static_cast<double>(v.z)) {}  // NOLINT
    Vec(taut_pos p) : x(p.x), y(p.y), z(p.z) {}  // NOLINT: implicit by design

    taut_vec3 narrow() const { return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}; }
    taut_pos pos() const { return {x, y, z}; }
    Vec& operator+=(const Vec& b) { return x += b.x, y += b.y, z += b.z, *this; }
};

inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
inline Vec operator*(double s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec& a, const Vec& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double norm(const Vec& a) { return std::sqrt(dot(a, a)); }
inline Vec unit(const Vec& a) { return 1 / norm(a) * a; }
inline bool finite(const Vec& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

struct Quat {
    double x = 0, y = 0, z = 0, w = 1;

    Quat() = default;
    Quat(double x_, double y_, double z_, double w_) : x(x_), y(y_), z(z_), w(w_) {}
    Quat(taut_quat q)  // NOLINT: implicit by design
        : x(static_cast<double>(q.x)),
          y(static_cast<double>(q.y)),
          z(static_cast<double>(q.z)),
          w(static_cast<double>(q.w)) {}
    static Quat turn(const Vec& axis, double angle) {
        const Vec v = std::sin(angle / 2) * unit(axis);
        return {v.x, v.y, v.z, std::cos(angle / 2)};
    }
    taut_quat narrow() const {
        return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)};
    }
    Vec rotate(const Vec& v) const {
        const Vec u(x, y, z), t = 2 * cross(u, v);
        return v + w * t + cross(u, t);
    }
    Vec rotate_back(const Vec& v) const { return Quat(-x, -y, -z, w).rotate(v); }
};

inline Quat operator*(const Quat& a, const Quat& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

inline void ok(taut_result result) {
    if (result != TAUT_OK) throw std::runtime_error(std::string(taut_result_name(result)) + ": " + taut_last_error());
}

// What a body is made of, with the tests' own names for the common cases.
struct BodyPlan {
    taut_body_kind kind = TAUT_BODY_DYNAMIC;
    taut_shape shape{};
    Vec position{};
    Quat rotation{};
    Vec velocity{}, spin{};
    double mass = 0;  // [kg], 0: from density
    Vec inertia{};    // principal, about the centre [kg m^2]; 0: from the shape
    double friction = 0.5, restitution = 0;
    double rolling = 0, spinning = 0;  // arms of the friction torques [m]
    double gravity_scale = 1;
    int32_t group = 0;
};

struct BodyState {
    Vec position;
    Quat rotation;
    Vec velocity, spin;
};

// How all tests of a run step time, where a test does not say it itself: TAUT_LAB_HZ (30, 60, 120 or 240 steps a
// second) and TAUT_LAB_SUBSTEPS in the environment. The tests labelled full run with several of each.
struct Pace {
    double hz = number("TAUT_LAB_HZ", 60);
    uint32_t substeps = static_cast<uint32_t>(number("TAUT_LAB_SUBSTEPS", 4));

    static double number(const char* name, double otherwise) {
        const char* text = std::getenv(name);
        return text ? std::atof(text) : otherwise;
    }
};

inline const Pace& pace() {
    static const Pace read;
    return read;
}

class World {
public:
    explicit World(const std::function<void(taut_world_def&)>& change = {}) {
        taut_world_def_init(&def);
        // Of no test's own choosing: a step by the last bit off.
        const float usual = def.time_step, paced = static_cast<float>(1 / pace().hz);
        const float unchosen = pace().hz == 60 ? usual : std::nextafter(paced, 0.0f);
        def.time_step = unchosen;
        def.substeps = pace().substeps;
        if (change) change(def);
        if (def.time_step == unchosen && paced != usual) {
            def.time_step = paced;
            tick_ = static_cast<double>(usual);
        }
        ok(taut_world_create(&def, &handle));
    }
    ~World() { taut_world_destroy(handle); }
    World(const World&) = delete;
    World& operator=(const World&) = delete;

    taut_shape box(const Vec& half) const {
        return shape(taut_box_def_init, taut_world_add_box, [&](taut_box_def& d) { d.half_extents = half.narrow(); });
    }
    taut_shape sphere(double radius) const {
        return shape(taut_sphere_def_init, taut_world_add_sphere,
                     [&](taut_sphere_def& d) { d.radius = static_cast<float>(radius); });
    }
    taut_shape cylinder(double radius, double half_length) const {
        return shape(taut_cylinder_def_init, taut_world_add_cylinder, [&](taut_cylinder_def& d) {
            d.radius = static_cast<float>(radius);
            d.half_length = static_cast<float>(half_length);
        });
    }
    taut_shape cone(double radius, double half_length) const {
        return shape(taut_cone_def_init, taut_world_add_cone, [&](taut_cone_def& d) {
            d.radius = static_cast<float>(radius);
            d.half_length = static_cast<float>(half_length);
        });
    }
    taut_shape capsule(double radius, double half_length) const {
        return shape(taut_capsule_def_init, taut_world_add_capsule, [&](taut_capsule_def& d) {
            d.radius = static_cast<float>(radius);
            d.half_length = static_cast<float>(half_length);
        });
    }
    taut_shape tapered_capsule(double bottom, double top, double half_length) const {
        return shape(taut_tapered_capsule_def_init, taut_world_add_tapered_capsule, [&](taut_tapered_capsule_def& d) {
            d.bottom_radius = static_cast<float>(bottom);
            d.top_radius = static_cast<float>(top);
            d.half_length = static_cast<float>(half_length);
        });
    }
    taut_shape plane(const Vec& normal = {0, 1, 0}) const {
        return shape(taut_plane_def_init, taut_world_add_plane, [&](taut_plane_def& d) { d.normal = normal.narrow(); });
    }
    // Of a def with its defaults but for what set writes.
    template <class Def, class Set>
    taut_shape shape(void (*init)(Def*), taut_result (*add_shape)(taut_world, const Def*, taut_shape*), Set set) const {
        Def d;
        init(&d);
        set(d);
        taut_shape out{};
        ok(add_shape(handle, &d, &out));
        return out;
    }
    taut_body add(const BodyPlan& plan) const {
        taut_body_def d;
        taut_body_def_init(&d);
        d.kind = plan.kind;
        d.shape = plan.shape;
        d.position = plan.position.pos();
        d.rotation = plan.rotation.narrow();
        d.linear_velocity = plan.velocity.narrow();
        d.angular_velocity = plan.spin.narrow();
        d.mass = static_cast<float>(plan.mass);
        d.inertia = {static_cast<float>(plan.inertia.x),
                     static_cast<float>(plan.inertia.y),
                     static_cast<float>(plan.inertia.z),
                     0,
                     0,
                     0};
        d.material.friction = static_cast<float>(plan.friction);
        d.material.restitution = static_cast<float>(plan.restitution);
        d.material.rolling_friction = static_cast<float>(plan.rolling);
        d.material.spinning_friction = static_cast<float>(plan.spinning);
        d.gravity_scale = static_cast<float>(plan.gravity_scale);
        d.filter.group = plan.group;
        taut_body out{};
        ok(taut_world_add_body(handle, &d, &out));
        return out;
    }
    taut_body add_ground(double friction = 0.5, double restitution = 0) const {
        return add({.kind = TAUT_BODY_STATIC, .shape = plane(), .friction = friction, .restitution = restitution});
    }
    taut_body particle(double mass, const Vec& position, const Vec& velocity = {}, double gravity_scale = 1) const {
        taut_particle_def d;
        taut_particle_def_init(&d);
        d.mass = static_cast<float>(mass);
        d.position = position.pos();
        d.velocity = velocity.narrow();
        d.gravity_scale = static_cast<float>(gravity_scale);
        taut_body out{};
        ok(taut_world_add_particle(handle, &d, &out));
        return out;
    }
    taut_joint ball(taut_body a, const Vec& at_a, taut_body b, const Vec& at_b) const {
        taut_ball_joint_def d;
        taut_ball_joint_def_init(&d);
        d.base.body_a = a;
        d.base.body_b = b;
        d.base.frame_a.position = at_a.pos();
        d.base.frame_b.position = at_b.pos();
        taut_joint out{};
        ok(taut_world_add_ball_joint(handle, &d, &out));
        return out;
    }
    // A rod, or a spring where compliance [m/N] is not zero.
    taut_joint rod(taut_body a, const Vec& at_a, taut_body b, const Vec& at_b, double length, double compliance = 0,
                   double damping = 0) const {
        taut_distance_joint_def d;
        taut_distance_joint_def_init(&d);
        d.base.body_a = a;
        d.base.body_b = b;
        d.base.frame_a.position = at_a.pos();
        d.base.frame_b.position = at_b.pos();
        d.length = static_cast<float>(length);
        d.base.compliance = static_cast<float>(compliance);
        d.base.damping = static_cast<float>(damping);
        taut_joint out{};
        ok(taut_world_add_distance_joint(handle, &d, &out));
        return out;
    }

    // Steps of the world; of a sixtieth of a second where the run's pace is another and the test leaves it to the run.
    void step(int count = 1) const {
        for (int i = 0; i < count; ++i)
            ok(tick_ > 0 ? taut_world_advance(handle, tick_, nullptr) : taut_world_step(handle));
    }
    double frame() const { return tick_ > 0 ? tick_ : static_cast<double>(def.time_step); }  // what step() steps [s]
    // What so many steps of step() have stepped: where the world's own are longer, whole ones of those [s].
    double stepped(int count) const {
        const auto own = static_cast<double>(def.time_step);
        return std::floor(count * frame() / own + 1e-3) * own;
    }
    double substep() const {  // of the last step [s]
        return static_cast<double>(def.time_step) / profile().substeps;
    }
    taut_profile profile() const {
        taut_profile p{};
        p.struct_size = sizeof p;
        ok(taut_world_get_profile(handle, &p));
        return p;
    }
    std::vector<taut_contact> contacts() const {
        uint32_t count = 0;
        taut_world_get_contacts(handle, nullptr, 0, &count);
        std::vector<taut_contact> out(count);
        ok(taut_world_get_contacts(handle, out.data(), count, &count));
        return out;
    }

    taut_world_def def{};
    taut_world handle{};

private:
    double tick_ = 0;  // [s], 0: the world's own step
};

inline BodyState state(taut_body body) {
    taut_pose pose{};
    taut_vec3 v{}, w{};
    ok(taut_body_get_pose(body, &pose));
    ok(taut_body_get_velocity(body, &v, &w));
    return {pose.position, pose.rotation, v, w};
}

inline Vec position(taut_body body) { return state(body).position; }
inline Vec velocity(taut_body body) { return state(body).velocity; }

inline bool finite(taut_body body) {
    const BodyState s = state(body);
    return finite(s.position) && finite(s.velocity) && finite(s.spin) && std::isfinite(s.rotation.w + s.rotation.x);
}

struct Mass {
    double mass = 0;
    taut_sym3 inertia{};
};

inline Mass mass_of(taut_body body) {
    Mass out;
    float mass = 0;
    taut_vec3 centre{};
    ok(taut_body_get_mass(body, &mass, &centre, &out.inertia));
    out.mass = static_cast<double>(mass);
    return out;
}

// I w in world axes.
inline Vec spin_momentum(const BodyState& s, const taut_sym3& i) {
    const Vec w = s.rotation.rotate_back(s.spin);
    const double xx = static_cast<double>(i.xx), yy = static_cast<double>(i.yy), zz = static_cast<double>(i.zz),
                 xy = static_cast<double>(i.xy), xz = static_cast<double>(i.xz), yz = static_cast<double>(i.yz);
    return s.rotation.rotate(
        {xx * w.x + xy * w.y + xz * w.z, xy * w.x + yy * w.y + yz * w.z, xz * w.x + yz * w.y + zz * w.z});
}

// Of a set of bodies whose centres of mass are their origins.
struct Totals {
    double mass = 0, kinetic = 0;
    Vec centre, momentum;
    Vec spin;           // angular momentum about the centre of mass
    double height = 0;  // sum m y: potential energy over g
};

inline Totals totals(const std::vector<taut_body>& bodies) {
    Totals t;
    for (taut_body body : bodies) {
        const BodyState s = state(body);
        const Mass m = mass_of(body);
        t.mass += m.mass;
        t.centre += m.mass * s.position;
        t.momentum += m.mass * s.velocity;
        t.height += m.mass * s.position.y;
    }
    t.centre = 1 / t.mass * t.centre;
    for (taut_body body : bodies) {
        const BodyState s = state(body);
        const Mass m = mass_of(body);
        const Vec own = spin_momentum(s, m.inertia);
        t.kinetic += 0.5 * m.mass * dot(s.velocity, s.velocity) + 0.5 * dot(s.spin, own);
        t.spin += own + m.mass * cross(s.position - t.centre, s.velocity - 1 / t.mass * t.momentum);
    }
    return t;
}

// K(k), the complete elliptic integral of the first kind: pi / (2 agm(1, sqrt(1 - k^2))).
inline double elliptic_k(double k) {
    double a = 1, b = std::sqrt(1 - k * k);
    for (int i = 0; i < 40 && std::abs(a - b) > 1e-16 * a; ++i) {
        const double mean = 0.5 * (a + b);
        b = std::sqrt(a * b);
        a = mean;
    }
    return kPi / (2 * a);
}

// Times at which a signal sampled each frame crosses zero upwards, linearly between frames.
class Crossings {
public:
    void sample(double time, double value) {
        if (seen_ && last_ < 0 && value >= 0)
            times.push_back(last_time_ + (time - last_time_) * last_ / (last_ - value));
        seen_ = true;
        last_ = value;
        last_time_ = time;
    }
    double period() const {
        return times.size() < 2 ? std::numeric_limits<double>::quiet_NaN()
                                : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
    }
    std::vector<double> times;

private:
    bool seen_ = false;
    double last_ = 0, last_time_ = 0;
};

}  // namespace lab
