#include "soak/hostile.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "physics/cable_lab.h"

namespace soak {

using namespace lab;

namespace {

// Of hills a metre wide.
double hill(double x, double z) { return 0.25 * std::sin(2 * x) * std::cos(1.7 * z); }

void place(std::vector<taut_pos>& points, const Vec& at, const Quat& turn) {
    Vec middle;
    for (const taut_pos& p : points) middle += 1.0 / static_cast<double>(points.size()) * Vec(p);
    for (taut_pos& p : points) p = (at + turn.rotate(Vec(p) - middle)).pos();
}

double any_hz(scenes::Random& random) { return std::vector<double>{30, 60, 120}[random.bits() % 3]; }

}  // namespace

const char* name_of(HostileKind kind) {
    static constexpr const char* names[kHostileKinds] = {"links", "triangles", "quads", "tetrahedra", "hexahedra",
                                                         "cloud", "cable",     "chain", "grains",     "rigid"};
    return names[static_cast<int>(kind)];
}

Hostile::Hostile(HostileKind kind, uint64_t seed, int things)
    : random_(seed * kHostileKinds + static_cast<uint64_t>(kind)),
      hz_(any_hz(random_)),
      world_([this](taut_world_def& def) { plan_world(def, hz_); }),
      entangled_(random_.uniform() < 0.15) {
    tell("%g Hz%s", hz_, entangled_ ? " entangled" : "");
    add_ground();
    if (chance(0.5)) add_posts();
    add_things(kind, things);
    for (int i = 0; i < 4; ++i) tie();
    for (const taut_body body : moving_) {
        const Mass m = mass_of(body);
        masses_.push_back(m.mass);
        mass_ += m.mass;
        height_ = std::max(height_, position(body).y);
    }
}

void Hostile::plan_world(taut_world_def& def, double hz) {
    def.time_step = static_cast<float>(1 / hz);
    def.substeps = 4;
}

void Hostile::tell(const char* format, ...) {
    char text[160];
    va_list values;
    va_start(values, format);
    std::vsnprintf(text, sizeof text, format, values);
    va_end(values);
    told_ += text;
}

int Hostile::steps() const { return static_cast<int>(1.5 * hz_); }

// A plane, a slab, or hills of triangles.
void Hostile::add_ground() {
    const auto which = random_.bits() % 3;
    if (which == 0) {
        world_.add_ground();
        return;
    }
    if (which == 1) {
        world_.add({.kind = TAUT_BODY_STATIC, .shape = world_.box({kHalf, 0.5, kHalf}), .position = {0, -0.5, 0}});
        return;
    }
    rough_ = true;
    constexpr int kSide = 32;
    std::vector<taut_vec3> vertices;
    std::vector<uint32_t> indices;
    for (int row = 0; row <= kSide; ++row)
        for (int column = 0; column <= kSide; ++column) {
            const double x = kHalf * (2.0 * column / kSide - 1), z = kHalf * (2.0 * row / kSide - 1);
            vertices.push_back(Vec(x, hill(x, z), z).narrow());
        }
    const auto at = [](int row, int column) { return static_cast<uint32_t>(row * (kSide + 1) + column); };
    for (int row = 0; row < kSide; ++row)
        for (int column = 0; column < kSide; ++column) {
            const uint32_t a = at(row, column), b = at(row + 1, column), c = at(row, column + 1),
                           d = at(row + 1, column + 1);
            indices.insert(indices.end(), {a, b, c, c, b, d});
        }
    world_.add({.kind = TAUT_BODY_STATIC,
                .shape = world_.shape(taut_mesh_def_init, taut_world_add_mesh, [&](taut_mesh_def& d) {
                    d.vertices = vertices.data();
                    d.vertex_count = static_cast<uint32_t>(vertices.size());
                    d.indices = indices.data();
                    d.triangle_count = static_cast<uint32_t>(indices.size() / 3);
                })});
}

// Thin posts and a box on its edge, in the way.
void Hostile::add_posts() {
    for (int i = 0; i < 3; ++i)
        world_.add({.kind = TAUT_BODY_STATIC,
                    .shape = world_.capsule(decades(0.01, 0.1), 1),
                    .position = {1.5 * random_.around_zero(), 0.6, 1.5 * random_.around_zero()},
                    .rotation = any_turn()});
    world_.add({.kind = TAUT_BODY_STATIC,
                .shape = world_.box({0.4, 0.4, 1}),
                .position = {0.5 * random_.around_zero(), 0.3, 0},
                .rotation = Quat::turn({0, 0, 1}, 0.25 * kPi)});
}

// In cells of a lattice above the ground, thrown about; entangled ones in cells that are too small.
void Hostile::add_things(HostileKind kind, int things) {
    const double cell = entangled_ ? 0.5 : 1.8;
    constexpr int kCells = 12;
    int order[kCells];
    for (int i = 0; i < kCells; ++i) order[i] = i;
    for (int i = kCells - 1; i > 0; --i) std::swap(order[i], order[random_.bits() % static_cast<uint64_t>(i + 1)]);
    for (int i = 0; i < things; ++i) {
        const int c = order[i];
        const Vec at = {cell * (c % 2 - 0.5), 1.4 + cell * (c / 6), cell * (c / 2 % 3 - 1.0)};
        const auto other = static_cast<HostileKind>(random_.bits() % kHostileKinds);
        const size_t before = moving_.size();
        add(i % 2 == 0 ? kind : other, at);
        const double speed = chance(0.2) ? 30 : decades(0.1, 10);
        const Vec v = speed * unit(Vec(0, 0.7, 0) - at + 0.7 * Vec(random_.direction()));
        for (size_t n = before; n < moving_.size(); ++n) ok(taut_body_set_velocity(moving_[n], v.narrow(), {}));
        first_speed_ = std::max(first_speed_, speed);
    }
}

void Hostile::add(HostileKind kind, const Vec& at) {
    const size_t before = things_.size();
    switch (kind) {
        case HostileKind::links:
        case HostileKind::triangles:
        case HostileKind::quads:
            add_cloth(kind, at);
            break;
        case HostileKind::tetrahedra:
        case HostileKind::hexahedra:
        case HostileKind::cloud:
            add_solid(kind, at);
            break;
        case HostileKind::cable:
        case HostileKind::chain:
            add_cable(kind, at);
            break;
        case HostileKind::grains:
            add_grains(at);
            break;
        case HostileKind::rigid:
            add_rigid(at);
            break;
    }
    for (size_t n = before; n < things_.size(); ++n)
        for (const taut_body body : things_[n].bodies) {
            taut_body_kind made{};
            ok(taut_body_get_kind(body, &made));
            if (made != TAUT_BODY_KINEMATIC) moving_.push_back(body);
        }
}

taut_deformable_solve Hostile::any_solve() { return static_cast<taut_deformable_solve>(random_.bits() % 3); }

void Hostile::add_cloth(HostileKind kind, const Vec& at) {
    const int n = 4 + static_cast<int>(random_.bits() % 6);
    const double side = 0.4 + 0.6 * random_.uniform();
    Sheet sheet(n, n, side, side * (0.6 + 0.4 * random_.uniform()), 0);
    place(sheet.points, at, any_turn());
    taut_cloth_def def = sheet.def(kind == HostileKind::links ? TAUT_CLOTH_LINKS : TAUT_CLOTH_TRIANGLES);
    std::vector<uint32_t> quads;
    if (kind == HostileKind::quads) {
        for (int i = 0; i + 1 < n; ++i)
            for (int k = 0; k + 1 < n; ++k)
                quads.insert(quads.end(),
                             {sheet.at(i, k), sheet.at(i, k + 1), sheet.at(i + 1, k + 1), sheet.at(i + 1, k)});
        def.kind = TAUT_CLOTH_QUADS;
        def.triangles = nullptr;
        def.triangle_count = 0;
        def.quads = quads.data();
        def.quad_count = static_cast<uint32_t>(quads.size() / 4);
    }
    def.strain = chance(0.3) ? TAUT_CLOTH_STRAIN_COROTATED : TAUT_CLOTH_STRAIN_GREEN;
    def.area_density = static_cast<float>(decades(0.05, 50));
    def.thickness = static_cast<float>(decades(0.003, 0.05));
    const double stiffness = decades(10, 1e6);
    def.stretch_stiffness[0] = def.stretch_stiffness[1] = static_cast<float>(stiffness);
    def.shear_stiffness = static_cast<float>(0.4 * stiffness);
    if (chance(0.4)) def.bending_stiffness = static_cast<float>(decades(1e-6, 1));
    const auto compliance = static_cast<float>(decades(1e-8, 1e-2));
    def.stretch_compliance[0] = def.stretch_compliance[1] = chance(0.3) ? 0 : compliance;
    def.shear_compliance = 10 * compliance;
    def.damping = chance(0.5) ? 0.01f : 0;
    def.tear_strain = kind != HostileKind::quads && chance(0.15) ? 0.3f : 0;
    def.solve = any_solve();
    def.self_collision = chance(0.5) ? 1 : 0;
    tell("; %s %d^2 %g kg/m^2 thick %g stiff %g bend %g compliance %g tear %g self %u solve %d", name_of(kind), n,
         static_cast<double>(def.area_density), static_cast<double>(def.thickness), stiffness,
         static_cast<double>(def.bending_stiffness), static_cast<double>(def.stretch_compliance[0]),
         static_cast<double>(def.tear_strain), def.self_collision, static_cast<int>(def.solve));
    Thing thing;
    thing.cloth = lab::add(world_, def);
    if (chance(0.25))
        for (const int k : {0, n - 1}) ok(taut_cloth_pin(thing.cloth, sheet.at(0, k), 1));
    thing.bodies = bodies_of(thing.cloth);
    things_.push_back(thing);
}

void Hostile::add_solid(HostileKind kind, const Vec& at) {
    const int n = 2 + static_cast<int>(random_.bits() % 3);
    const double side = 0.2 + 0.4 * random_.uniform();
    Beam beam({side, side * (0.4 + 0.6 * random_.uniform()), side}, n + 1, n, n, kind == HostileKind::hexahedra);
    place(beam.points, at, any_turn());
    const auto material = static_cast<taut_solid_material>(random_.bits() % (kind == HostileKind::cloud ? 4 : 5));
    const double young = decades(2e3, 1e9);
    taut_solid_def def = beam.def(material, young, 0.05 + 0.43 * random_.uniform());
    for (float& modulus : def.orthotropic.young_moduli) modulus = static_cast<float>(young);
    for (float& modulus : def.orthotropic.shear_moduli) modulus = static_cast<float>(0.38 * young);
    std::vector<uint32_t> boundary;
    if (kind == HostileKind::cloud) {
        def.cells = nullptr;
        def.cell_count = 0;
        def.corners = TAUT_SOLID_MESHLESS;
    }
    def.density = static_cast<float>(decades(30, 8000));
    def.thickness = static_cast<float>(decades(0.005, 0.04));
    def.damping = chance(0.5) ? 0.005f : 0;
    if (material != TAUT_SOLID_ORTHOTROPIC && chance(0.2)) def.yield_stress = 0.05f * def.young_modulus;
    def.solve = any_solve();
    def.self_collision = chance(0.5) ? 1 : 0;
    tell("; %s %d^3 of %g m law %d E %g nu %g %g kg/m^3 thick %g yield %g self %u solve %d", name_of(kind), n, side,
         static_cast<int>(material), young, static_cast<double>(def.poisson_ratio), static_cast<double>(def.density),
         static_cast<double>(def.thickness), static_cast<double>(def.yield_stress), def.self_collision,
         static_cast<int>(def.solve));
    Thing thing;
    thing.solid = lab::add(world_, def);
    if (chance(0.1)) ok(taut_solid_pin(thing.solid, 0, 1));
    thing.bodies = bodies_of(thing.solid);
    things_.push_back(thing);
}

void Hostile::add_cable(HostileKind kind, const Vec& at) {
    const Vec along = 0.6 * Vec(random_.direction());
    const taut_pos path[] = {(at - along).pos(), (at + along).pos()};
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = kind == HostileKind::chain ? TAUT_CABLE_LINKS : TAUT_CABLE_PARTICLES;
    def.points = path;
    def.point_count = 2;
    def.segment_count = 4 + static_cast<uint32_t>(random_.bits() % 12);
    def.diameter = static_cast<float>(decades(0.01, 0.08));
    def.mass_per_metre = static_cast<float>(decades(0.05, 50));
    if (chance(0.4)) def.stretch_compliance = static_cast<float>(decades(1e-7, 1e-3));
    if (chance(0.4)) def.bending_stiffness = static_cast<float>(decades(1e-4, 100));
    def.self_collision = chance(0.5) ? 1 : 0;
    if (chance(0.2)) {
        def.end[0].attached = 1;
        def.end[0].anchor = path[0];
    }
    tell("; %s of %u, %g kg/m, thick %g compliance %g bend %g self %u", name_of(kind), def.segment_count,
         static_cast<double>(def.mass_per_metre), static_cast<double>(def.diameter),
         static_cast<double>(def.stretch_compliance), static_cast<double>(def.bending_stiffness), def.self_collision);
    taut_cable cable{};
    ok(taut_world_add_cable(world_.handle, &def, &cable));
    Thing thing;
    thing.bodies = bodies_of(cable);
    things_.push_back(thing);
}

// A lattice of some, all grains or all plain particles.
void Hostile::add_grains(const Vec& at) {
    const double radius = decades(0.02, 0.08);
    const taut_shape ball = world_.sphere(radius);
    const double mass = decades(0.01, 10);
    const bool grain = chance(0.7);
    tell("; %s of %g m, %g kg", grain ? "grains" : "particles", radius, mass);
    Thing thing;
    for (int i = 0; i < 12; ++i) {
        taut_particle_def def;
        taut_particle_def_init(&def);
        def.mass = static_cast<float>(mass * (0.5 + random_.uniform()));
        def.shape = ball;
        def.position = (at + 2.2 * radius * Vec(i % 2, i / 4, i / 2 % 2)).pos();
        def.collider_flags = grain ? TAUT_COLLIDER_GRAIN : 0;
        taut_body one{};
        ok(taut_world_add_particle(world_.handle, &def, &one));
        thing.bodies.push_back(one);
    }
    things_.push_back(thing);
}

void Hostile::add_rigid(const Vec& at) {
    const double size = decades(0.05, 0.45);
    taut_shape shape{};
    std::vector<taut_vec3> points;
    switch (random_.bits() % 6) {
        case 0:
            shape = world_.box({size, size * (0.2 + 0.8 * random_.uniform()), size});
            break;
        case 1:
            shape = world_.sphere(size);
            break;
        case 2:
            shape = world_.capsule(0.3 * size, size);
            break;
        case 3:
            shape = world_.cylinder(0.6 * size, 0.7 * size);
            break;
        case 4:  // thin as a blade
            shape = world_.box({size, 0.03 * size + 0.002, 0.5 * size});
            break;
        default:
            for (int i = 0; i < 8; ++i) {
                const Vec p = size * Vec(random_.direction());
                points.insert(points.end(), {p.narrow(), (-p).narrow()});  // its centre is that of its mass
            }
            shape = world_.shape(taut_hull_def_init, taut_world_add_hull, [&](taut_hull_def& d) {
                d.points = points.data();
                d.point_count = static_cast<uint32_t>(points.size());
            });
    }
    Thing thing;
    const double mass = decades(0.1, 100);
    tell("; rigid of %g m, %g kg", size, mass);
    thing.bodies.push_back(world_.add({.shape = shape, .position = at, .rotation = any_turn(), .mass = mass}));
    things_.push_back(thing);
}

taut_anchor Hostile::anchor_of(const Thing& thing, const Vec& near) const {
    taut_anchor out{};
    if (thing.cloth.bits)
        ok(taut_cloth_find_anchor(thing.cloth, near.pos(), &out, nullptr));
    else if (thing.solid.bits)
        ok(taut_solid_find_anchor(thing.solid, near.pos(), &out, nullptr));
    else
        ok(taut_world_get_anchor(world_.handle, thing.bodies.back(), position(thing.bodies.back()).pos(), &out));
    return out;
}

// Two things as far apart as they are, rigidly or softly.
void Hostile::tie() {
    const Thing &one = things_[random_.bits() % things_.size()], &other = things_[random_.bits() % things_.size()];
    if (&one == &other) return;
    taut_attachment_def def;
    taut_attachment_def_init(&def);
    def.a = anchor_of(one, position(other.bodies.front()));
    taut_pos at{};
    ok(taut_world_get_anchor_point(world_.handle, &def.a, &at));
    def.b = anchor_of(other, at);
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    def.compliance = chance(0.5) ? static_cast<float>(decades(1e-7, 1e-3)) : 0;
    def.break_force = chance(0.3) ? 300 : 0;
    def.pulls = chance(0.5) ? 1 : 0;
    tell("; tie %g%s", static_cast<double>(def.compliance), def.pulls ? " pulls" : "");
    taut_attachment made{};
    // Of pinned vertices, or closer than a length may be, it is refused.
    const taut_result result = taut_world_add_attachment(world_.handle, &def, &made);
    if (result != TAUT_INVALID_ARGUMENT) ok(result);
}

double Hostile::energy() const {
    double sum = 0;
    for (size_t n = 0; n < moving_.size(); ++n) {
        const BodyState s = state(moving_[n]);
        sum += masses_[n] * (0.5 * dot(s.velocity, s.velocity) + kG * s.position.y);
        if (dot(s.spin, s.spin) > 0) sum += 0.5 * dot(s.spin, spin_momentum(s, mass_of(moving_[n]).inertia));
    }
    return sum;
}

double Hostile::fastest() const {
    double out = 0;
    for (const taut_body body : moving_) out = std::max(out, norm(velocity(body)));
    return out;
}

size_t Hostile::below() const {
    size_t out = 0;
    for (const taut_body body : moving_) {
        const Vec p = position(body);
        if (std::max(std::abs(p.x), std::abs(p.z)) < kHalf - 0.5) out += p.y < (rough_ ? hill(p.x, p.z) : 0) - 0.5;
    }
    return out;
}

bool Hostile::sound() const {
    return std::ranges::all_of(moving_, [](taut_body body) { return finite(body); });
}

uint64_t Hostile::quarantined() const {
    taut_events events{};
    ok(taut_world_get_events(world_.handle, &events));
    return events.quarantined_count;
}

uint64_t Hostile::hash() const {
    uint64_t out = 0;
    ok(taut_world_get_state_hash(world_.handle, &out));
    return out;
}

}  // namespace soak
