#include "soak/playground.h"

#include <algorithm>

namespace soak {

using namespace lab;

namespace {

constexpr double kCell = 1;  // of the terrain [m]

template <class Def, class Add>
taut_shape make(taut_world world, void (*init)(Def*), Add add, const std::function<void(Def&)>& change) {
    Def def;
    init(&def);
    change(def);
    taut_shape out{};
    ok(add(world, &def, &out));
    return out;
}

}  // namespace

// Rolling hills in a bowl that keeps everything in: at 45 degrees towards the rim.
double Playground::height(double x, double z) {
    const double out = std::max(std::abs(x), std::abs(z));
    return 0.6 * std::sin(0.5 * x) * std::cos(0.4 * z) + std::max(0.0, out - 0.6 * kHalf);
}

Playground::Playground(uint64_t seed) : random_(seed) {
    taut_world_def def;
    taut_world_def_init(&def);
    def.sleeping = def.continuous = 1;
    def.contact_events = TAUT_CONTACT_EVENTS_ALL;
    memory_.hook(def.hooks);
    ok(taut_world_create(&def, &world_));
    add_shapes();
    add_terrain();
    add_sensors();
}

Playground::~Playground() { taut_world_destroy(world_); }

void Playground::add_shapes() {
    const taut_world w = world_;
    shapes_ = {make<taut_box_def>(w, taut_box_def_init, taut_world_add_box,
                                  [](auto& d) {
                                      d.half_extents = {0.3f, 0.2f, 0.25f};
                                  }),
               make<taut_sphere_def>(w, taut_sphere_def_init, taut_world_add_sphere, [](auto& d) { d.radius = 0.25f; }),
               make<taut_capsule_def>(w, taut_capsule_def_init, taut_world_add_capsule,
                                      [](auto& d) { d.radius = 0.15f, d.half_length = 0.3f; }),
               make<taut_cylinder_def>(w, taut_cylinder_def_init, taut_world_add_cylinder,
                                       [](auto& d) { d.radius = 0.25f, d.half_length = 0.2f; }),
               make<taut_cone_def>(w, taut_cone_def_init, taut_world_add_cone,
                                   [](auto& d) { d.radius = 0.3f, d.half_length = 0.3f; }),
               make<taut_tapered_capsule_def>(w, taut_tapered_capsule_def_init, taut_world_add_tapered_capsule,
                                              [](auto& d) { d.bottom_radius = 0.2f, d.top_radius = 0.1f; }),
               taut_shape{}};
    std::vector<taut_vec3> points(20);
    for (taut_vec3& point : points) {
        const taut_vec3 n = random_.direction();
        point = {0.3f * n.x, 0.3f * n.y, 0.3f * n.z};
    }
    shapes_.back() = make<taut_hull_def>(w, taut_hull_def_init, taut_world_add_hull, [&](auto& d) {
        d.points = points.data(), d.point_count = static_cast<uint32_t>(points.size());
    });
    limb_ = make<taut_capsule_def>(w, taut_capsule_def_init, taut_world_add_capsule,
                                   [](auto& d) { d.radius = 0.07f, d.half_length = 0.15f; });
    trunk_ = make<taut_box_def>(w, taut_box_def_init, taut_world_add_box, [](auto& d) {
        d.half_extents = {0.2f, 0.3f, 0.12f};
    });
    bead_ = make<taut_sphere_def>(w, taut_sphere_def_init, taut_world_add_sphere, [](auto& d) { d.radius = 0.12f; });
}

void Playground::add_terrain() {
    constexpr int side = static_cast<int>(2 * kHalf / kCell);
    std::vector<taut_vec3> vertices;
    std::vector<uint32_t> indices;
    for (int row = 0; row <= side; ++row)
        for (int column = 0; column <= side; ++column) {
            const double x = kCell * column - kHalf, z = kCell * row - kHalf;
            vertices.push_back(Vec(x, height(x, z), z).narrow());
        }
    const auto at = [](int row, int column) { return static_cast<uint32_t>(row * (side + 1) + column); };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column) {
            const uint32_t a = at(row, column), b = at(row + 1, column), c = at(row, column + 1),
                           d = at(row + 1, column + 1);
            indices.insert(indices.end(), {a, b, c, c, b, d});
        }
    const taut_shape terrain = make<taut_mesh_def>(world_, taut_mesh_def_init, taut_world_add_mesh, [&](auto& d) {
        d.vertices = vertices.data(), d.vertex_count = static_cast<uint32_t>(vertices.size());
        d.indices = indices.data(), d.triangle_count = static_cast<uint32_t>(indices.size() / 3);
    });
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = TAUT_BODY_STATIC;
    def.shape = terrain;
    taut_body out{};
    ok(taut_world_add_body(world_, &def, &out));
}

void Playground::add_sensors() {
    const taut_shape room = make<taut_box_def>(world_, taut_box_def_init, taut_world_add_box, [](auto& d) {
        d.half_extents = {3, 2, 3};
    });
    for (double x : {-8.0, 0.0, 8.0}) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.kind = TAUT_BODY_STATIC;
        def.shape = room;
        def.position = {x, 1.5, x / 2};
        def.collider_flags = TAUT_COLLIDER_SENSOR;
        taut_body out{};
        ok(taut_world_add_body(world_, &def, &out));
    }
}

Vec Playground::place() {
    const double x = 14 * random_.around_zero(), z = 14 * random_.around_zero();
    return {x, height(x, z) + 3 + 4 * random_.uniform(), z};
}

taut_body Playground::body(taut_shape shape, const Vec& at, double density) {
    taut_body_def def;
    taut_body_def_init(&def);
    def.shape = shape;
    def.position = at.pos();
    def.density = static_cast<float>(density);
    taut_body out{};
    ok(taut_world_add_body(world_, &def, &out));
    ++tally.made;
    return out;
}

// A ball or hinge joint at a point of the world, by defs that are in the bodies' frames, which are not turned.
void Playground::link(taut_body a, taut_body b, const Vec& pivot, bool hinge) {
    taut_joint out{};
    const Vec in_a = pivot - position(a), in_b = pivot - position(b);
    if (!hinge) {
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_a = a, def.base.body_b = b, def.base.frame_a.position = in_a.pos(),
        def.base.frame_b.position = in_b.pos();
        return ok(taut_world_add_ball_joint(world_, &def, &out));
    }
    taut_hinge_joint_def def;
    taut_hinge_joint_def_init(&def);
    def.base.body_a = a, def.base.body_b = b;
    def.base.frame_a.position = in_a.pos(), def.base.frame_b.position = in_b.pos();
    def.angle.mode = TAUT_AXIS_LIMITED, def.angle.lower = -1, def.angle.upper = 1;
    ok(taut_world_add_hinge_joint(world_, &def, &out));
}

void Playground::add_single() {
    const taut_body one = body(shapes_[random_.bits() % shapes_.size()], place(), 200 + 2000 * random_.uniform());
    const taut_vec3 v = random_.in_cube(5);
    const float down = random_.bits() % 20 == 0 ? 60 : std::abs(v.y);  // now and then a shot into the ground
    ok(taut_body_set_velocity(one, {v.x, -down, v.z}, random_.in_cube(5)));
    groups_.push_back({{one}, {0}, 1});
}

// A trunk, a head and four limbs of two pieces.
void Playground::add_ragdoll() {
    const Vec at = place();
    Group group;
    const taut_body trunk = body(trunk_, at), head = body(bead_, at + Vec(0, 0.45, 0));
    group.bodies = {trunk, head};
    link(trunk, head, at + Vec(0, 0.32, 0), false);
    for (double x : {-1.0, 1.0})
        for (double y : {-1.0, 1.0}) {
            const Vec joint = at + Vec(0.24 * x, 0.27 * y, 0);
            const double away = y > 0 ? 0.6 : -1;
            const taut_body upper = body(limb_, joint + Vec(0.08 * x, 0.24 * away, 0)),
                            lower = body(limb_, joint + Vec(0.08 * x, 0.72 * away, 0));
            link(trunk, upper, joint, false);
            link(upper, lower, joint + Vec(0.08 * x, 0.48 * away, 0), true);
            group.bodies.insert(group.bodies.end(), {upper, lower});
        }
    group.size = group.bodies.size();
    groups_.push_back(group);
}

void Playground::add_chain() {
    const Vec at = place();
    Group group;
    for (int i = 0; i < 8; ++i) {
        group.bodies.push_back(body(bead_, at + Vec(0.3 * i, 0, 0)));
        if (i > 0)
            link(group.bodies[static_cast<size_t>(i) - 1], group.bodies.back(), at + Vec(0.3 * i - 0.15, 0, 0), false);
    }
    group.size = group.bodies.size();
    groups_.push_back(group);
}

// Between a post in the air and nothing, of either kind.
void Playground::add_cable() {
    const Vec at = place();
    const taut_pos path[] = {at.pos(), (at + Vec(3, 0, 0)).pos()};
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = random_.bits() % 2 ? TAUT_CABLE_LINKS : TAUT_CABLE_PARTICLES;
    def.points = path;
    def.point_count = 2;
    def.segment_count = 10;
    def.diameter = 0.08f;
    def.end[0].attached = 1;
    def.end[0].anchor = at.pos();
    Group group;
    ok(taut_world_add_cable(world_, &def, &group.cable));
    group.size = 11;
    tally.made += group.size;
    groups_.push_back(group);
}

void Playground::remove(const Group& group) {
    if (group.cable.bits) ok(taut_cable_remove(group.cable));
    for (taut_body one : group.bodies) ok(taut_body_remove(one));
    tally.removed += group.size;
}

size_t Playground::population() const {
    size_t sum = 0;
    for (const Group& group : groups_) sum += group.size;
    return sum;
}

void Playground::change() {
    while (population() + 11 > kMostBodies) {
        remove(groups_.front());
        groups_.pop_front();
    }
    switch (random_.bits() % 16) {
        case 0:
            return add_ragdoll();
        case 1:
            return add_chain();
        case 2:
            return add_cable();
        default:
            return add_single();
    }
}

uint64_t Playground::search(uint64_t seed) const {
    scenes::Random random(seed);
    uint64_t found = 0;
    taut_ray rays[8];
    taut_query_hit hits[8], hit;
    for (taut_ray& ray : rays) ray = {{14 * random.around_zero(), 8, 14 * random.around_zero()}, {0, -20, 0}, 0};
    ok(taut_world_cast_rays(world_, rays, 8, nullptr, hits));
    for (const taut_query_hit& one : hits) found += one.body.bits != 0;
    const taut_shape_cast cast = {shapes_[1], {rays[0].origin, {0, 0, 0, 1}, {0, 0}}, {1, -20, 1}, 0};
    ok(taut_world_cast_shape(world_, &cast, nullptr, &hit));
    found += hit.body.bits != 0;
    taut_collider colliders[64];
    uint32_t count = 0;
    const taut_pose at = {{10 * random.around_zero(), 0.5, 10 * random.around_zero()}, {0, 0, 0, 1}, {0, 0}};
    const taut_result result = taut_world_overlap_shape(world_, shapes_[0], &at, nullptr, colliders, 64, &count);
    if (result != TAUT_TOO_SMALL) ok(result);
    taut_distance nearest;
    ok(taut_world_nearest_collider(world_, shapes_[1], &at, 5, nullptr, &nearest));
    return found + count + (nearest.body.bits != 0);
}

void Playground::queries() { tally.found += search(random_.bits()); }

void Playground::take_events() {
    taut_events events;
    ok(taut_world_get_events(world_, &events));
    tally.begun += events.begin_count;
    tally.entered += events.sensor_enter_count;
    tally.left += events.sensor_leave_count;
    tally.slept += events.fell_asleep_count;
    tally.quarantined += events.quarantined_count;
}

// act(point) for the origin of each body and each point of each cable.
template <class Act>
void Playground::for_points(Act&& act) const {
    for (const Group& group : groups_) {
        for (taut_body one : group.bodies) act(position(one));
        if (!group.cable.bits) continue;
        taut_pos points[16];
        uint32_t count = 0;
        ok(taut_cable_get_points(group.cable, points, 16, &count));
        for (uint32_t i = 0; i < count; ++i) act(Vec(points[i]));
    }
}

bool Playground::sound() const {
    bool out = true;
    for_points([&](const Vec& p) { out = out && finite(p); });
    return out;
}

double Playground::spin() const {
    double most = 0;
    for (const Group& group : groups_)
        for (taut_body one : group.bodies) most = std::max(most, norm(state(one).spin));
    return most;
}

size_t Playground::below_terrain() const {
    constexpr double kReach = 0.6;  // of the largest body [m]
    size_t out = 0;
    for_points([&](const Vec& p) {
        out += std::max(std::abs(p.x), std::abs(p.z)) < kHalf && p.y < height(p.x, p.z) - kReach;
    });
    return out;
}

}  // namespace soak
