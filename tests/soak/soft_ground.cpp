#include "soak/soft_ground.h"

#include <algorithm>
#include <string>

namespace soak {

using namespace lab;

namespace {

template <class Def, class Add, class Set>
taut_shape shape(taut_world world, void (*init)(Def*), Add add, Set set) {
    Def def;
    init(&def);
    set(def);
    taut_shape out{};
    ok(add(world, &def, &out));
    return out;
}

void move(std::vector<taut_pos>& points, const Vec& by) {
    for (taut_pos& p : points) p = (Vec(p) + by).pos();
}

}  // namespace

SoftGround::SoftGround(uint64_t seed, uint32_t threads, size_t most_nodes) : most_nodes_(most_nodes), random_(seed) {
    taut_world_def def;
    taut_world_def_init(&def);
    memory_.hook(def.hooks);
    def.threads = threads;
    def.sleeping = 1;
    ok(taut_world_create(&def, &world_));
    add_floor();
}

SoftGround::~SoftGround() { taut_world_destroy(world_); }

void SoftGround::add_floor() {
    plane_ = shape(world_, taut_plane_def_init, taut_world_add_plane, [](taut_plane_def&) {});
    wall_ = shape(world_, taut_box_def_init, taut_world_add_box, [](taut_box_def& d) {
        d.half_extents = {0.5f, 6, static_cast<float>(kHalf) + 1};
    });
    const taut_shape across = shape(world_, taut_box_def_init, taut_world_add_box, [](taut_box_def& d) {
        d.half_extents = {static_cast<float>(kHalf) + 1, 6, 0.5f};
    });
    box_ = shape(world_, taut_box_def_init, taut_world_add_box, [](taut_box_def& d) {
        d.half_extents = {0.15f, 0.1f, 0.2f};
    });
    grain_ = shape(world_, taut_sphere_def_init, taut_world_add_sphere, [](taut_sphere_def& d) { d.radius = 0.05f; });
    add_body(TAUT_BODY_STATIC, plane_, {});
    for (const double side : {-1.0, 1.0}) {
        add_body(TAUT_BODY_STATIC, wall_, {side * (kHalf + 0.5), 6, 0});
        add_body(TAUT_BODY_STATIC, across, {0, 6, side * (kHalf + 0.5)});
    }
}

taut_body SoftGround::add_body(taut_body_kind kind, taut_shape shape, const Vec& at) {
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = kind;
    def.shape = shape;
    def.position = at.pos();
    def.density = 300;
    taut_body out{};
    ok(taut_world_add_body(world_, &def, &out));
    return out;
}

Vec SoftGround::place() {
    const double room = kHalf - 1.2;
    return {room * random_.around_zero(), 0.6 + 2.5 * random_.uniform(), room * random_.around_zero()};
}

// Of links or triangles, direct or swept, some hung by two corners, some that tear.
void SoftGround::add_cloth() {
    Sheet sheet(8, 7, 1, 0.9, 0);
    move(sheet.points, place());
    taut_cloth_def def = sheet.def(chance(0.5) ? TAUT_CLOTH_LINKS : TAUT_CLOTH_TRIANGLES);
    def.solve = chance(0.5) ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    def.damping = 0.01f;
    def.air_drag = chance(0.3) ? 1.0f : 0;
    def.tear_strain = chance(0.4) ? 0.2f : 0;
    def.tethers = chance(0.2) ? 1 : 0;
    if (def.kind == TAUT_CLOTH_TRIANGLES && def.solve == TAUT_DEFORMABLE_DIRECT && chance(0.5))
        def.bending_stiffness = 1e-4f;
    if (def.kind == TAUT_CLOTH_LINKS && chance(0.3)) def.compression = 0.3f;
    Group group;
    ok(taut_world_add_cloth(world_, &def, &group.cloth));
    if (chance(0.5))
        for (const int k : {0, 6}) ok(taut_cloth_pin(group.cloth, sheet.at(0, k), 1));
    group.nodes = sheet.points.size();
    groups_.push_back(group);
    ++tally.cloths;
}

void SoftGround::add_balloon() {
    Ball ball(0.25, 1);
    move(ball.points, place());
    taut_cloth_def def = ball.def();
    def.gas = 1;
    def.pressure = 2000;
    def.damping = 0.01f;
    Group group;
    ok(taut_world_add_cloth(world_, &def, &group.cloth));
    group.nodes = ball.points.size();
    groups_.push_back(group);
    ++tally.balloons;
}

// Of tetrahedra or hexahedra, some of clay.
void SoftGround::add_solid() {
    const bool hexahedra = chance(0.3);
    Beam beam({0.45, 0.3, 0.3}, 4, 3, 3, hexahedra);
    move(beam.points, place());
    taut_solid_def def = beam.def(TAUT_SOLID_NEO_HOOKEAN, 1e5 * (1 + 9 * random_.uniform()), 0.4);
    def.solve = !hexahedra && chance(0.6) ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT;
    def.damping = 0.005f;
    if (def.solve == TAUT_DEFORMABLE_DIRECT && chance(0.4)) {
        def.yield_stress = 0.05f * def.young_modulus;
        def.creep = 20;
    }
    Group group;
    ok(taut_world_add_solid(world_, &def, &group.solid));
    group.nodes = beam.points.size();
    groups_.push_back(group);
    ++tally.solids;
}

void SoftGround::add_cable() {
    const Vec at = place();
    const taut_pos path[] = {at.pos(), (at + Vec(1.2, 0.3, 0)).pos()};
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = chance(0.5) ? TAUT_CABLE_LINKS : TAUT_CABLE_PARTICLES;
    def.points = path;
    def.point_count = 2;
    def.segment_count = 10;
    def.diameter = 0.05f;
    if (chance(0.5)) {
        def.end[0].attached = 1;
        def.end[0].anchor = at.pos();
    }
    Group group;
    ok(taut_world_add_cable(world_, &def, &group.cable));
    group.nodes = 11;
    groups_.push_back(group);
    ++tally.cables;
}

void SoftGround::add_grains() {
    const Vec at = place();
    Group group;
    for (int i = 0; i < 27; ++i) {
        taut_particle_def def;
        taut_particle_def_init(&def);
        def.mass = 0.3f;
        def.shape = grain_;
        def.position = (at + 0.11 * Vec(i % 3, i / 9, i / 3 % 3) + Vec(random_.in_cube(0.004))).pos();
        taut_body one{};
        ok(taut_world_add_particle(world_, &def, &one));
        group.bodies.push_back(one);
    }
    group.nodes = group.bodies.size();
    groups_.push_back(group);
    ++tally.grains;
}

void SoftGround::add_box() {
    Group group;
    group.bodies = {add_body(TAUT_BODY_DYNAMIC, box_, place())};
    group.nodes = 1;
    groups_.push_back(group);
    ++tally.boxes;
}

// On a group's surface, within it, or at its first body; the world for cables.
taut_anchor SoftGround::anchor_of(const Group& group, const Vec& near) const {
    taut_anchor out{};
    if (group.cloth.bits)
        ok(taut_cloth_find_anchor(group.cloth, near.pos(), &out, nullptr));
    else if (group.solid.bits)
        ok(taut_solid_find_anchor(group.solid, near.pos(), &out, nullptr));
    else
        ok(taut_world_get_anchor(world_, group.bodies.empty() ? taut_body{} : group.bodies.front(),
                                 (group.bodies.empty() ? near : position(group.bodies.front())).pos(), &out));
    return out;
}

// Two things, or one and the world, by a ball or a distance that breaks.
void SoftGround::tie() {
    if (groups_.empty()) return;
    const Group &one = groups_[random_.bits() % groups_.size()], &other = groups_[random_.bits() % groups_.size()];
    if (one.cable.bits || &one == &other) return;
    const Vec near = place();
    taut_attachment_def def;
    taut_attachment_def_init(&def);
    def.a = anchor_of(one, near);
    taut_pos at{};
    ok(taut_world_get_anchor_point(world_, &def.a, &at));
    def.b = chance(0.3) ? anchor_of({}, at) : anchor_of(other, at);
    taut_pos there{};
    ok(taut_world_get_anchor_point(world_, &def.b, &there));
    const double apart = norm(Vec(there) - Vec(at));
    def.kind = apart < 0.01 ? TAUT_ATTACHMENT_BALL : TAUT_ATTACHMENT_DISTANCE;
    def.compliance = chance(0.5) ? 1e-4f : 0;
    def.break_force = chance(0.8) ? 300 : 0;
    if (apart > 2) return;
    taut_attachment made{};
    const taut_result result = taut_world_add_attachment(world_, &def, &made);
    // Between pinned vertices there is nothing to tie, and it says so.
    if (result == TAUT_INVALID_ARGUMENT && std::string(taut_last_error()).ends_with("no body is dynamic or a particle"))
        return;
    ok(result);
    ++tally.ties;
}

void SoftGround::kick() {
    if (groups_.empty()) return;
    const Group& group = groups_[random_.bits() % groups_.size()];
    std::vector<taut_body> bodies = group.bodies;
    if (group.cloth.bits) bodies = bodies_of(group.cloth);
    if (group.solid.bits) bodies = bodies_of(group.solid);
    const Vec v = 6.0 * Vec(random_.direction());
    for (const taut_body body : bodies) {
        taut_body_kind kind{};
        ok(taut_body_get_kind(body, &kind));
        if (kind != TAUT_BODY_KINEMATIC)
            ok(taut_body_set_velocity(body, v.narrow(), {}));  // a pin would go on for ever
    }
}

// A vertex of a cloth or solid, or lets it go.
void SoftGround::pin() {
    if (groups_.empty()) return;
    const Group& group = groups_[random_.bits() % groups_.size()];
    const auto vertex = static_cast<uint32_t>(random_.bits() % std::max<size_t>(group.nodes, 1));
    const uint32_t pinned = chance(0.4) ? 1 : 0;
    if (group.cloth.bits) ok(taut_cloth_pin(group.cloth, vertex, pinned));
    if (group.solid.bits) ok(taut_solid_pin(group.solid, vertex, pinned));
}

void SoftGround::remove(size_t index) {
    const Group& group = groups_[index];
    if (group.cloth.bits) ok(taut_cloth_remove(group.cloth));
    if (group.solid.bits) ok(taut_solid_remove(group.solid));
    if (group.cable.bits) ok(taut_cable_remove(group.cable));
    for (const taut_body one : group.bodies) ok(taut_body_remove(one));
    groups_.erase(groups_.begin() + static_cast<std::ptrdiff_t>(index));
    ++tally.removed;
}

void SoftGround::clear() {
    while (!groups_.empty()) remove(random_.bits() % groups_.size());
}

size_t SoftGround::nodes() const {
    size_t sum = 0;
    for (const Group& group : groups_) sum += group.nodes;
    return sum;
}

void SoftGround::change() {
    while (nodes() + 64 > most_nodes_) remove(random_.bits() % groups_.size());
    switch (random_.bits() % 12) {
        case 0:
        case 1:
            return add_cloth();
        case 2:
        case 3:
            return add_solid();
        case 4:
            return chance(0.5) ? add_balloon() : add_cable();
        case 5:
            return chance(0.5) ? add_grains() : add_box();
        case 6:
            return add_box();
        case 7:
        case 8:
            return tie();
        case 9:
            return kick();
        case 10:
            return pin();
        default:
            ok(taut_world_set_wind(world_, Vec(3.0 * Vec(random_.direction())).narrow()));
    }
}

void SoftGround::take_events() {
    taut_events events;
    ok(taut_world_get_events(world_, &events));
    tally.torn += events.torn_count;
    tally.detached += events.detached_count;
    tally.slept += events.fell_asleep_count;
    tally.quarantined += events.quarantined_count;
}

template <class Act>
void SoftGround::for_points(Act&& act) const {
    for (const Group& group : groups_) {
        for (const taut_body one : group.bodies) act(position(one));
        if (group.cloth.bits)
            for (const Vec& p : points_of(group.cloth)) act(p);
        if (group.solid.bits)
            for (const Vec& p : points_of(group.solid)) act(p);
        if (!group.cable.bits) continue;
        taut_pos points[16];
        uint32_t count = 0;
        ok(taut_cable_get_points(group.cable, points, 16, &count));
        for (uint32_t i = 0; i < count; ++i) act(Vec(points[i]));
    }
}

bool SoftGround::sound() const {
    bool out = true;
    for_points([&](const Vec& p) { out = out && finite(p); });
    return out;
}

size_t SoftGround::escaped() const {
    size_t out = 0;
    for_points([&](const Vec& p) { out += p.y < -0.5; });
    return out;
}

uint64_t SoftGround::hash() const {
    uint64_t out = 0;
    ok(taut_world_get_state_hash(world_, &out));
    return out;
}

}  // namespace soak
