#include "soak/shots.h"

#include <algorithm>

namespace soak {

using namespace lab;

namespace {

constexpr int kCells = 20;         // of the ground, along each side
constexpr double kShotCell = 0.5;  // [m]
constexpr double kRough = 0.3;     // [m]
constexpr double kSide = kShotCell * kCells;

size_t sample(int row, int column) { return static_cast<size_t>(row * (kCells + 1) + column); }

Triangles ground_of(const std::vector<double>& heights) {
    Triangles out;
    const auto at = [&](int row, int column) {
        return Vec(kShotCell * column, heights[sample(row, column)], kShotCell * row);
    };
    for (int row = 0; row < kCells; ++row)
        for (int column = 0; column < kCells; ++column)
            out.add_quad(at(row, column + 1), at(row, column), at(row + 1, column), at(row + 1, column + 1), true);
    return out;
}

template <class Def, class Add>
taut_shape make(taut_world world, void (*init)(Def*), Add add, double radius, double half_length) {
    Def def;
    init(&def);
    def.radius = static_cast<float>(radius), def.half_length = static_cast<float>(half_length);
    taut_shape out{};
    ok(add(world, &def, &out));
    return out;
}

}  // namespace

const char* ShootingRange::name(int kind) {
    constexpr const char* kNames[kKinds] = {"ball", "box",  "rod",     "capsule", "cylinder",
                                            "disc", "cone", "tapered", "hull"};
    return kNames[kind];
}

ShootingRange::ShootingRange(const ShotPlan& plan, uint64_t seed) : plan_(plan), random_(seed) {
    for (int i = 0; i < (kCells + 1) * (kCells + 1); ++i) heights_.push_back(kRough * random_.uniform());
    BodyPlan wall;
    wall.kind = TAUT_BODY_STATIC;
    if (plan.target == Target::plate || plan.target == Target::sheet) {
        const double half = plan.target == Target::plate ? 0.01 : 0.001;
        wall.shape = world_.box({kSide / 2, half, kSide / 2});
        wall.position = {kSide / 2, -half, kSide / 2};
        std::fill(heights_.begin(), heights_.end(), 0.0);
    } else if (plan.target == Target::mesh) {
        wall.shape = mesh(world_, ground_of(heights_));
    } else {
        wall.shape = height_field(world_, kCells + 1, kCells + 1, kShotCell, [&](double x, double z) {
            return heights_[sample(static_cast<int>(std::lround(z / kShotCell)),
                                   static_cast<int>(std::lround(x / kShotCell)))];
        });
    }
    wall.restitution = 0.5;
    world_.add(wall);
    trunk_ = world_.box({0.2, 0.3, 0.12}), head_ = world_.sphere(0.12), limb_ = world_.capsule(0.07, 0.15);
}

taut_shape ShootingRange::shape(int kind) {
    const double size = 0.03 * std::pow(10, random_.uniform());
    const taut_world w = world_.handle;
    reach_ = 2 * size;
    switch (kind) {
        case 0:
            return world_.sphere(size);
        case 1:
            return world_.box({size, size * (0.3 + 0.7 * random_.uniform()), size * (0.3 + 0.7 * random_.uniform())});
        case 2:
            return world_.capsule(0.08 * size, size);
        case 3:
            return world_.capsule(0.4 * size, size);
        case 4:
            return make<taut_cylinder_def>(w, taut_cylinder_def_init, taut_world_add_cylinder, 0.5 * size, size);
        case 5:
            return make<taut_cylinder_def>(w, taut_cylinder_def_init, taut_world_add_cylinder, size, 0.1 * size);
        case 6:
            return make<taut_cone_def>(w, taut_cone_def_init, taut_world_add_cone, 0.6 * size, size);
        case 7: {
            taut_tapered_capsule_def def;
            taut_tapered_capsule_def_init(&def);
            def.bottom_radius = static_cast<float>(0.6 * size), def.top_radius = static_cast<float>(0.2 * size);
            def.half_length = static_cast<float>(size);
            taut_shape out{};
            ok(taut_world_add_tapered_capsule(w, &def, &out));
            return out;
        }
        default:
            break;
    }
    // Points all about and off the origin.
    std::vector<taut_vec3> points(6 + random_.bits() % 8);
    const Vec off = 0.5 * size * Vec(random_.direction());
    for (taut_vec3& point : points)
        point = (off + size * (0.4 + 0.6 * random_.uniform()) * Vec(random_.direction())).narrow();
    return hull(world_, points);
}

// Half of the shots go for an edge or a vertex.
Vec ShootingRange::aim() {
    const auto along = [&] { return kSide * (0.3 + 0.4 * random_.uniform()); };
    double x = along(), z = along();
    const uint64_t at = random_.bits() % 4;
    if (at > 1) x = kShotCell * std::round(x / kShotCell);
    if (at > 2) z = kShotCell * std::round(z / kShotCell);
    return {x, 0.5 * kRough, z};
}

Vec ShootingRange::centre(taut_body body) const {
    taut_sym3 inertia{};
    float mass = 0;
    taut_vec3 centre{};
    ok(taut_body_get_mass(body, &mass, &centre, &inertia));
    const BodyState s = state(body);
    return s.position + s.rotation.rotate(centre);
}

bool ShootingRange::over_target(const Vec& p) const {
    return p.x > reach_ && p.x < kSide - reach_ && p.z > reach_ && p.z < kSide - reach_;
}

bool ShootingRange::beyond(taut_body body) const {
    const Vec p = centre(body);
    if (!over_target(p)) return !finite(p);
    const int row = static_cast<int>(p.z / kShotCell), column = static_cast<int>(p.x / kShotCell);
    const double lowest = std::min({heights_[sample(row, column)], heights_[sample(row + 1, column)],
                                    heights_[sample(row, column + 1)], heights_[sample(row + 1, column + 1)]});
    return p.y < lowest - 0.02;
}

// Downwards, at up to 70 degrees from the vertical.
Vec ShootingRange::velocity() {
    speed_ = plan_.slowest * std::pow(plan_.fastest / plan_.slowest, random_.uniform());
    const double tilt = 1.2 * random_.uniform(), round = 2 * kPi * random_.uniform();
    return speed_ * Vec(std::sin(tilt) * std::cos(round), -std::cos(tilt), std::sin(tilt) * std::sin(round));
}

bool ShootingRange::comes_through(int kind) {
    const Vec v = velocity();
    const taut_shape bullet = shape(kind);
    const taut_body body = world_.add({.shape = bullet,
                                       .position = aim() - (1 + 3 * random_.uniform()) / speed_ * v,
                                       .rotation = Quat(scenes::turn(random_.direction(), kPi * random_.uniform())),
                                       .velocity = v,
                                       .spin = plan_.spin * random_.uniform() * Vec(random_.direction()),
                                       .restitution = random_.bits() % 2 ? 0.5 : 0.0});
    bool through = false;
    const int frames = 40 + static_cast<int>(4 / (speed_ * world_.frame()));
    for (int frame = 0; frame < frames && !through; ++frame) {
        world_.step();
        through = beyond(body);
    }
    ok(taut_body_remove(body));
    ok(taut_shape_remove(bullet));
    return through;
}

void ShootingRange::tie(taut_body a, taut_body b, const Vec& pivot, taut_joint_solve solve) {
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    const BodyState s = state(a), t = state(b);
    def.base.body_a = a, def.base.body_b = b;
    def.base.frame_a.position = s.rotation.rotate_back(pivot - s.position).pos();
    def.base.frame_b.position = t.rotation.rotate_back(pivot - t.position).pos();
    def.base.solve = solve;
    taut_joint out{};
    ok(taut_world_add_ball_joint(world_.handle, &def, &out));
}

std::vector<taut_body> ShootingRange::ragdoll(const Vec& at, const Quat& turned, taut_joint_solve solve) {
    std::vector<taut_body> out;
    const auto add = [&](taut_shape shape, const Vec& place) {
        out.push_back(world_.add({.shape = shape, .position = at + turned.rotate(place), .rotation = turned}));
        return out.back();
    };
    const auto pivot = [&](const Vec& place) { return at + turned.rotate(place); };
    const taut_body trunk = add(trunk_, {}), head = add(head_, {0, 0.45, 0});
    tie(trunk, head, pivot({0, 0.32, 0}), solve);
    for (double x : {-1.0, 1.0})
        for (double y : {-1.0, 1.0}) {
            const Vec joint(0.24 * x, 0.27 * y, 0), along(0, y > 0 ? 0.15 : -0.24, 0), aside(0.08 * x, 0, 0);
            const taut_body upper = add(limb_, joint + aside + along), lower = add(limb_, joint + aside + 3 * along);
            tie(trunk, upper, pivot(joint), solve);
            tie(upper, lower, pivot(joint + aside + 2 * along), solve);
        }
    return out;
}

int ShootingRange::limbs_through(taut_joint_solve solve) {
    reach_ = 0;
    const Vec v = velocity(), spin = 0.1 * plan_.spin * random_.uniform() * Vec(random_.direction());
    constexpr double kClear = 1.5;  // [m], of all limbs as well
    Vec at = aim() - (2 + 2 * random_.uniform()) / speed_ * v;
    at.y = std::max(at.y, kClear);
    const std::vector<taut_body> bodies =
        ragdoll(at, Quat(scenes::turn(random_.direction(), kPi * random_.uniform())), solve);
    for (taut_body body : bodies)
        ok(taut_body_set_velocity(body, (v + cross(spin, position(body) - at)).narrow(), spin.narrow()));
    std::vector<bool> through(bodies.size()), aside(bodies.size());  // aside: gone over the rim, swings below as it may
    for (int frame = 0; frame < 60 + static_cast<int>(4 / (speed_ * world_.frame())); ++frame) {
        world_.step(1);
        for (size_t i = 0; i < bodies.size(); ++i) {
            const Vec p = centre(bodies[i]);
            if (finite(p) && !over_target(p))
                aside[i] = aside[i] || !through[i];
            else
                through[i] = !aside[i] && beyond(bodies[i]);
        }
    }
    for (taut_body body : bodies) ok(taut_body_remove(body));
    return static_cast<int>(std::count(through.begin(), through.end(), true));
}

}  // namespace soak
