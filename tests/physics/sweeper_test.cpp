// What a kinematic wall or blade sweeps over goes along, however fast it comes and thin it is: the wall stops for
// nothing, so what it passed in a step goes on instead of back.
#include "physics/cable_lab.h"
#include "physics/tunnel_lab.h"
#include "starts.h"

namespace {

using namespace lab;

enum class Thing { ball, box, rod, grain, sheet, cable, chain };
constexpr Thing kThings[] = {Thing::ball,  Thing::box,   Thing::rod,  Thing::grain,
                             Thing::sheet, Thing::cable, Thing::chain};
constexpr const char* kNames[] = {"ball", "box", "rod", "grain", "sheet", "cable", "chain"};

using Bodies = std::vector<taut_body>;

taut_body grain(const World& world, const Vec& at) {
    taut_particle_def def;
    taut_particle_def_init(&def);
    def.mass = 0.05f;
    def.position = at.pos();
    def.shape = world.sphere(0.02);
    taut_body out{};
    ok(taut_world_add_particle(world.handle, &def, &out));
    return out;
}

Bodies cable(const CableLab& lab, const Vec& middle, const Vec& along) {
    const taut_pos path[2] = {(middle - 0.5 * along).pos(), (middle + 0.5 * along).pos()};
    taut_cable_def def = CableLab::plan(TAUT_CABLE_PARTICLES);
    def.points = path;
    def.point_count = 2;
    def.segment_count = 6;
    def.diameter = 0.02;
    def.mass_per_metre = 0.2;
    return bodies_of(lab.cable(def));
}

// Bars on ball joints.
Bodies chain(CableLab& lab, const Vec& middle, const Quat& turned) {
    constexpr double kHalf = 0.15;
    Bodies out;
    for (int i = -2; i <= 2; ++i) {
        out.push_back(lab.add({.shape = lab.capsule(0.05, kHalf - 0.05),
                               .position = middle + turned.rotate({0, 2 * kHalf * i, 0}),
                               .rotation = turned,
                               .mass = 1}));
        if (i > -2) lab.ball(out[out.size() - 2], {0, kHalf, 0}, out.back(), {0, -kHalf, 0});
    }
    return out;
}

Bodies add(CableLab& lab, Thing thing, const Vec& at, std::mt19937& random) {
    const Quat turned = Quat::turn(random_direction(random), between(random, 0, kPi));
    const auto body = [&](taut_shape shape) {
        return Bodies{lab.add({.shape = shape, .position = at, .rotation = turned, .mass = 1})};
    };
    if (thing == Thing::grain) return {grain(lab, at)};
    if (thing == Thing::cable) return cable(lab, at, turned.rotate({0, 1, 0}));
    if (thing == Thing::chain) return chain(lab, at, turned);
    if (thing == Thing::ball) return body(lab.sphere(0.1));
    if (thing == Thing::box) return body(lab.box({0.1, 0.15, 0.07}));
    if (thing == Thing::rod) return body(lab.capsule(0.03, 0.3));
    return body(lab.box({0.005, 0.2, 0.2}));
}

// A wall six metres to each side that goes along x.
struct Sweep {
    CableLab lab{weightless};
    double speed;
    taut_body wall;

    Sweep(Wall kind, double speed_)
        : speed(speed_),
          wall(lab.add({.kind = TAUT_BODY_KINEMATIC,
                        .shape = shape_of(lab, kind),
                        .position = {-2, 0, 0},
                        .velocity = {speed_, 0, 0}})) {}
    void run(double way) {
        for (int frame = 0; frame * lab.frame() * speed < way; ++frame) lab.step();
    }
    int left_behind(const Bodies& bodies) const {
        const double x = position(wall).x;
        return static_cast<int>(std::count_if(bodies.begin(), bodies.end(), [&](taut_body body) {
            const Vec p = position(body);
            return !finite(p) || (p.x < x && std::abs(p.y) < 5.9 && std::abs(p.z) < 5.9);
        }));
    }
};

constexpr double kSpeeds[] = {2, 5, 20, 50, 100, 300};

struct Swept : testing::TestWithParam<Wall> {};

TEST_P(Swept, NothingIsLeftBehind) {
    for (double speed : kSpeeds)
        for (size_t kind = 0; kind < std::size(kThings); ++kind) {
            std::mt19937 random(3);
            int left = 0;
            for (int start = 0; start < 20; ++start) {
                Sweep sweep(GetParam(), speed);
                const Vec at(between(random, -0.5, 2), between(random, -2, 2), between(random, -2, 2));
                const Bodies bodies = add(sweep.lab, kThings[kind], at, random);
                sweep.run(6);
                left += sweep.left_behind(bodies) > 0;
            }
            EXPECT_EQ(left, 0) << kNames[kind] << ", " << speed << " m/s";
        }
}

// Where one thing is driven into the next, that goes along too. A few in a thousand do not.
TEST_P(Swept, CrowdsGoAlong) {
    int left = 0, all = 0;
    for (double speed : kSpeeds) {
        std::mt19937 random(5);
        for (int start = 0; start < 10; ++start) {
            Sweep sweep(GetParam(), speed);
            Bodies bodies;
            for (int i = 0; i < 24; ++i) {
                const Vec at(between(random, -1, 3), between(random, -2, 2), between(random, -2, 2));
                for (taut_body body : add(sweep.lab, kThings[i % 5], at, random)) bodies.push_back(body);
            }
            sweep.run(7);
            left += sweep.left_behind(bodies);
            all += static_cast<int>(bodies.size());
        }
    }
    EXPECT_LE(left, all / 200) << "of " << all;
}

// Pressed against what does not move either, things stay on that one's side, but for one or two that are squeezed
// through it.
TEST_P(Swept, NothingIsDrivenThroughAStaticWall) {
    int through = 0;
    for (double speed : kSpeeds) {
        std::mt19937 random(7);
        for (int start = 0; start < 10; ++start) {
            Sweep sweep(GetParam(), speed);
            sweep.lab.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(sweep.lab, Wall::plate), .position = {1, 0, 0}});
            Bodies bodies;
            for (int i = 0; i < 5; ++i) {
                const Vec at(between(random, -1, 0.6), between(random, -2, 2), between(random, -2, 2));
                bodies.push_back(add(sweep.lab, kThings[i], at, random).front());
            }
            sweep.run(2.9 - half_thickness(GetParam()));
            ok(taut_body_set_velocity(sweep.wall, {0, 0, 0}, {0, 0, 0}));
            sweep.lab.step(20);
            for (taut_body body : bodies) {
                const Vec p = position(body);
                through += !finite(p) || (p.x > 1 && std::abs(p.y) < 5.9 && std::abs(p.z) < 5.9);
            }
        }
    }
    EXPECT_LE(through, 3) << "of 300";
}

std::string wall_name(const testing::TestParamInfo<Wall>& tested) {
    constexpr const char* kWalls[] = {"thick", "plate", "sheet", "mesh"};
    return kWalls[static_cast<size_t>(tested.param)];
}

INSTANTIATE_TEST_SUITE_P(By, Swept, testing::Values(Wall::thick, Wall::plate, Wall::sheet, Wall::mesh), wall_name);

// A beam that turns by up to 38 degrees in a step.
TEST(TurningBlade, TakesAlongWhatItMeets) {
    for (double spin : {2.0, 5.0, 10.0, 20.0, 40.0})
        for (size_t kind = 0; kind < std::size(kThings); ++kind) {
            std::mt19937 random(9);
            int missed = 0;
            for (int start = 0; start < 20; ++start) {
                CableLab lab(weightless);
                lab.add({.kind = TAUT_BODY_KINEMATIC, .shape = lab.box({2, 0.03, 0.5}), .spin = {0, 0, spin}});
                const double far = between(random, 0.6, 1.2), angle = between(random, 0.9, kPi - 0.9);
                const Vec at(far * std::cos(angle), far * std::sin(angle), 0);
                const Bodies bodies = add(lab, kThings[kind], at, random);
                for (int frame = 0; frame * lab.frame() * spin < kPi + 0.3; ++frame) lab.step();
                double fastest = 0;
                for (taut_body body : bodies) fastest = std::max(fastest, norm(velocity(body)));
                missed += fastest < 0.2 * spin * far;
            }
            EXPECT_EQ(missed, 0) << kNames[kind] << ", " << spin << " rad/s";
        }
}

// Two metres wide, of walls of 10 cm, with a dozen things in it; kinematic or of 100 t.
struct Container {
    static constexpr double kHalf = 1, kWall = 0.05;  // [m]

    CableLab lab;
    taut_body body;
    Bodies content;

    Container(taut_body_kind kind, std::mt19937& random) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.kind = kind;
        if (kind == TAUT_BODY_DYNAMIC) {
            def.mass = def.inertia.xx = def.inertia.yy = def.inertia.zz = 1e5f;
            def.gravity_scale = 0;
        }
        ok(taut_world_add_body(lab.handle, &def, &body));
        for (const Vec& out : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1)})
            for (double side : {-kHalf, kHalf}) add_wall(out, side);
        const auto within = [&] { return between(random, -0.7, 0.7); };
        for (int i = 0; i < 12; ++i)
            content.push_back(add(lab, kThings[i % 5], {within(), within(), within()}, random).front());
    }
    void add_wall(const Vec& out, double side) {
        taut_collider_def def;
        taut_collider_def_init(&def);
        const double wide = kHalf + kWall;
        def.shape = lab.box(Vec(wide, wide, wide) - (wide - kWall) * out);
        def.position = (side * out).narrow();
        taut_collider collider{};
        ok(taut_body_add_collider(body, &def, &collider));
    }
    // Every third of a second it jumps from rest to a speed some way, turning, or back.
    void shake(double speed, std::mt19937& random) {
        for (int jolt = 0; jolt < 12; ++jolt) {
            const double now = jolt % 2 ? 0 : speed;
            ok(taut_body_set_velocity(body, (now * random_direction(random)).narrow(),
                                      (now / 5 * random_direction(random)).narrow()));
            lab.step(20);
        }
    }
    int outside() const {
        const BodyState at = state(body);
        return static_cast<int>(std::count_if(content.begin(), content.end(), [&](taut_body thing) {
            const Vec p = at.rotation.rotate_back(position(thing) - at.position);
            return !(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < kHalf);
        }));
    }
};

// A few that others press against a wall are pressed through it: of 60 such counts some 4
// of 96, 20 at most.
TEST(ShakenContainer, KeepsWhatIsInIt) {
    for (taut_body_kind kind : {TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC})
        for (double speed : {2.0, 5.0, 20.0, 50.0, 100.0}) {
            std::mt19937 random(13);
            int lost = 0;
            for (int start = 0; start < starts(8); ++start) {
                Container container(kind, random);
                container.lab.step(30);
                container.shake(speed, random);
                lost += container.outside();
            }
            EXPECT_LE(lost, speed > 10 ? 24 : 2) << "of 96 at " << speed << " m/s";
        }
}

}  // namespace
