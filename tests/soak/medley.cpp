#include "soak/medley.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "physics/tunnel_lab.h"

namespace soak {

using namespace lab;

Medley::Medley(uint32_t threads) : world([&](taut_world_def& def) { def.threads = threads; }) {}

taut_body Medley::add_fixed(taut_shape shape, const Vec& position, const Quat& rotation) {
    fixed_.push_back(world.add({.kind = TAUT_BODY_STATIC, .shape = shape, .position = position, .rotation = rotation}));
    return fixed_.back();
}

taut_body Medley::add_kinematic(taut_shape shape, const Vec& position) {
    fixed_.push_back(world.add({.kind = TAUT_BODY_KINEMATIC, .shape = shape, .position = position}));
    return fixed_.back();
}

taut_body Medley::add(const BodyPlan& plan, double core) {
    bodies_.push_back(world.add(plan));
    cores_.push_back(core);
    return bodies_.back();
}

taut_body Medley::add_compound(const taut_body_def& def, double core) {
    bodies_.emplace_back();
    ok(taut_world_add_body(world.handle, &def, &bodies_.back()));
    cores_.push_back(core);
    return bodies_.back();
}

void Medley::add_ground() { add_fixed(world.box({30, 1, 30}), {0, -1, 0}); }

double Medley::light_shape(Random& random, taut_shape& out) const {
    const double r = between(random, 0.03, 0.15);
    switch (random() % 5) {
        case 0:
            out = world.sphere(r);
            break;
        case 1:
            out = world.box({r, r, r});
            break;
        case 2:
            out = world.box({1.5 * r, r, 1.2 * r});
            break;
        case 3:
            out = world.cylinder(r, between(random, 1, 2) * r);
            break;
        default:
            out = world.capsule(r, r);
    }
    return r;
}

void Medley::scatter(Random& random, int count, const Vec& from, const Vec& to) {
    struct Place {
        Vec centre;
        double radius;
    };
    std::vector<Place> taken;
    constexpr double kReach = 2.3;  // of a shape from its middle, in parts of its core
    for (int tries = 0; count > 0 && tries < 1000; ++tries) {
        taut_shape shape{};
        const double core = light_shape(random, shape), reach = kReach * core;
        const Vec at(between(random, from.x, to.x), reach, between(random, from.z, to.z));
        const auto is_near = [&](const Place& place) { return norm(place.centre - at) < place.radius + reach; };
        if (std::any_of(taken.begin(), taken.end(), is_near)) continue;
        taken.push_back({at, reach});
        add({.shape = shape,
             .position = at,
             .rotation = Quat::turn(random_direction(random), between(random, 0, 3)),
             .mass = between(random, 0.3, 3)},
            core);
        --count;
    }
}

double Medley::energy() const {
    const Totals all = totals(bodies_);
    return all.kinetic + kG * all.height;
}

// The two ends of a joint pass through each other.
bool Medley::tied(size_t a, size_t b) const {
    const auto is_end = [&](taut_body body, size_t at) {
        return at < bodies_.size() && std::memcmp(&body, &bodies_[at], sizeof body) == 0;
    };
    return std::any_of(joints.begin(), joints.end(), [&](taut_joint joint) {
        taut_body one{}, other{};
        ok(taut_joint_get_bodies(joint, &one, &other));
        return (is_end(one, a) && is_end(other, b)) || (is_end(one, b) && is_end(other, a));
    });
}

double Medley::overlap() const {
    struct Part {
        taut_collider collider;
        size_t body;
        double core;
    };
    std::vector<Part> parts;
    size_t bodies = 0;
    const auto take = [&](taut_body body, double core) {
        taut_collider all[16];
        uint32_t count = 0;
        ok(taut_body_get_colliders(body, all, 16, &count));
        for (uint32_t i = 0; i < count; ++i) parts.push_back({all[i], bodies, core});
        ++bodies;
    };
    for (size_t i = 0; i < bodies_.size(); ++i) take(bodies_[i], cores_[i]);
    const size_t moving = parts.size();
    for (const taut_body body : fixed_) take(body, std::numeric_limits<double>::infinity());
    double most = 0;
    for (size_t i = 0; i < moving; ++i)
        for (size_t j = i + 1; j < parts.size(); ++j) {
            if (parts[i].body == parts[j].body || tied(parts[i].body, parts[j].body)) continue;
            taut_distance gap;
            ok(taut_collider_distance(parts[i].collider, parts[j].collider, &gap));
            most = std::max(most, -static_cast<double>(gap.distance) / std::min(parts[i].core, parts[j].core));
        }
    return most;
}

Medley::Outcome Medley::run() {
    Outcome out;
    const double start = energy();
    double kinetic = totals(bodies_).kinetic, most = start;
    for (int frame = 0; frame < frames; ++frame) {
        if (before_step) before_step(frame);
        world.step();
        kinetic = std::max(kinetic, totals(bodies_).kinetic);
        most = std::max(most, energy());
        for (const taut_body body : bodies_) {
            const double speed = norm(velocity(body));
            out.fastest = std::isfinite(speed) ? std::max(out.fastest, speed) : HUGE_VAL;
        }
        for (const taut_joint joint : joints) out.gap = std::max(out.gap, error(joint));
    }
    out.gain = (most - start) / kinetic;
    out.overlap = overlap();
    ok(taut_world_get_state_hash(world.handle, &out.hash));
    return out;
}

}  // namespace soak
