// Cables of particles do not tunnel either: segments that pass many times their own thickness in a step, and what
// passes many times its own against them.
#include "physics/cable_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

constexpr double kSpeeds[] = {5, 20, 50, 100, 300, 1000};
constexpr double kDiameter = 0.02, kMassPerMetre = 0.2;

// A straight cable around a middle; not tied to anything.
taut_cable straight(const CableLab& lab, const Vec& middle, const Vec& along, int segments, double segment) {
    const double half = 0.5 * segments * segment;
    const taut_pos path[2] = {(middle - half * along).pos(), (middle + half * along).pos()};
    taut_cable_def d = CableLab::plan(TAUT_CABLE_PARTICLES);
    d.points = path;
    d.point_count = 2;
    d.segment_count = static_cast<uint32_t>(segments);
    d.diameter = kDiameter;
    d.mass_per_metre = kMassPerMetre;
    return lab.cable(d);
}

struct Throw {
    const char* name;
    Wall wall;
    int segments;
    bool loaded = false;      // by a ball of 1 kg at an end
    bool wall_first = false;  // made before the cable
};

void PrintTo(const Throw& t, std::ostream* out) { *out << t.name; }

struct ThrownCable : testing::TestWithParam<Throw> {};

struct Outcome {
    int lost = 0;       // of the cables, those of which any point came through
    int grown = 0;      // those that gained more than 1 % of their energy
    double growth = 0;  // of the kinetic energy, at most
};

double kinetic(const std::vector<taut_body>& bodies) {
    double sum = 0;
    for (taut_body body : bodies) sum += 0.5 * mass_of(body).mass * dot(velocity(body), velocity(body));
    return sum;
}

// Of what is over the wall, as far as a point gets that lies behind it.
bool any_behind(const std::vector<taut_body>& bodies, double behind) {
    return std::any_of(bodies.begin(), bodies.end(), [&](taut_body body) {
        const Vec p = position(body);
        return !finite(p) || (p.x > behind && std::abs(p.y) < 5.9 && std::abs(p.z) < 5.9);
    });
}

std::vector<taut_body> cable_of(const CableLab& lab, const Throw& row, const Vec& middle, const Vec& along) {
    constexpr double kBall = 0.05, kGap = 0.01;  // [m]
    const double segment = row.segments == 1 ? 0.5 : 0.25;
    const taut_cable cable = straight(lab, middle, along, row.segments, segment);
    std::vector<taut_body> bodies = bodies_of(cable);
    if (!row.loaded) return bodies;
    const Vec lever = (kBall + kGap) * along;
    bodies.push_back(lab.add({.shape = lab.sphere(kBall), .position = position(bodies.back()) + lever, .mass = 1}));
    lab.ball(bodies[bodies.size() - 2], {}, bodies.back(), -1 * lever);
    return bodies;
}

// 20 cables thrown at a wall.
Outcome outcome(const Throw& row, double speed) {
    std::mt19937 random(7);
    Outcome out;
    for (int shot = 0; shot < 20; ++shot) {
        CableLab lab(weightless);
        const auto add_wall = [&] { lab.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(lab, row.wall)}); };
        const double angle = between(random, 0, 0.5), round = between(random, 0, 2 * kPi),
                     far = between(random, 1.2, 3);
        const Vec way(std::cos(angle), std::sin(angle) * std::cos(round), std::sin(angle) * std::sin(round));
        if (row.wall_first) add_wall();
        const std::vector<taut_body> bodies = cable_of(lab, row, -far * way, random_direction(random));
        if (!row.wall_first) add_wall();
        for (taut_body body : bodies) ok(taut_body_set_velocity(body, (speed * way).narrow(), {0, 0, 0}));
        const double before = kinetic(bodies);
        bool passed = false;
        double growth = 0;
        for (int frame = 0; frame < 30 || frame * lab.frame() * speed < 5; ++frame) {
            lab.step();
            passed = passed || any_behind(bodies, half_thickness(row.wall) + 0.5 * kDiameter);
            growth = std::max(growth, kinetic(bodies) / before - 1);
        }
        out.lost += passed;
        out.grown += growth > 0.01;
        out.growth = std::max(out.growth, growth);
    }
    return out;
}

// What hits a wall by its end is stopped there and pushed on by what holds its length, in the same step. One in a
// hundred cables gains some per cent for a frame, before it loses a third.
TEST_P(ThrownCable, StaysOnItsSideOfTheWallAndGainsNoEnergy) {
    for (double speed : kSpeeds) {
        const Outcome out = outcome(GetParam(), speed);
        EXPECT_EQ(out.lost, 0) << speed << " m/s";
        EXPECT_LE(out.grown, 2) << speed << " m/s";
        EXPECT_LE(out.growth, 0.05) << speed << " m/s";
    }
}

constexpr Throw kThrows[] = {{"segment_thick", Wall::thick, 1},
                             {"segment_plate", Wall::plate, 1},
                             {"segment_plate_made_first", Wall::plate, 1, false, true},
                             {"segment_sheet", Wall::sheet, 1},
                             {"segment_mesh", Wall::mesh, 1},
                             {"segment_plane", Wall::plane, 1},
                             {"cable_thick", Wall::thick, 6},
                             {"cable_plate", Wall::plate, 6},
                             {"cable_plate_made_first", Wall::plate, 6, false, true},
                             {"cable_sheet", Wall::sheet, 6},
                             {"cable_mesh", Wall::mesh, 6},
                             {"cable_plane", Wall::plane, 6},
                             {"loaded_plate", Wall::plate, 6, true},
                             {"loaded_sheet", Wall::sheet, 6, true},
                             {"loaded_mesh", Wall::mesh, 6, true}};

std::string throw_name(const testing::TestParamInfo<Throw>& tested) { return tested.param.name; }

INSTANTIATE_TEST_SUITE_P(Of, ThrownCable, testing::ValuesIn(kThrows), throw_name);

// A cable that hangs beside a plate is jerked over its edge by a ball: in that step all of it goes where nothing
// foresaw it.
struct PulledCable {
    static constexpr double kSide = 0.5, kThick = 0.01;  // half of the plate [m]

    CableLab lab{weightless};
    std::vector<taut_body> points;

    PulledCable(double speed, std::mt19937& random) {
        constexpr double kBall = 0.05, kGap = 0.01;  // [m]
        lab.add({.kind = TAUT_BODY_STATIC, .shape = lab.box({kThick, kSide, kSide})});
        const double off = between(random, 0.05, 0.3), top = between(random, 0.55, 0.9),
                     hangs = between(random, 0.6, 1.2), over = between(random, 0.1, 0.5);
        const taut_pos path[3] = {Vec(-off, top - hangs, between(random, -0.2, 0.2)).pos(), Vec(-off, top, 0).pos(),
                                  Vec(over, top, 0).pos()};
        taut_cable_def d = CableLab::plan(TAUT_CABLE_PARTICLES);
        d.points = path;
        d.point_count = 3;
        d.segment_count = 10;
        d.diameter = kDiameter;
        d.mass_per_metre = kMassPerMetre;
        points = bodies_of(lab.cable(d));
        const Vec lever = {kBall + kGap, 0, 0};
        const taut_body ball = lab.add({.shape = lab.sphere(kBall),
                                        .position = position(points.back()) + lever,
                                        .velocity = {speed, 0, 0},
                                        .mass = 50});
        lab.ball(points.back(), {}, ball, -1 * lever);
    }

    // Whether a step takes a point through the plate, well off its edges.
    bool goes_through() {
        std::vector<Vec> before;
        for (taut_body point : points) before.push_back(position(point));
        ok(taut_world_step(lab.handle));
        for (size_t i = 0; i < points.size(); ++i) {
            const Vec way = position(points[i]) - before[i];
            if (before[i].x >= 0 || before[i].x + way.x <= 0) continue;
            const Vec met = before[i] - before[i].x / way.x * way;
            if (std::abs(met.y) < 0.7 * kSide && std::abs(met.z) < kSide) return true;
        }
        return false;
    }
};

TEST(JerkedCable, GoesAroundThePlateBesideIt) {
    for (double speed : {20.0, 40.0, 60.0, 100.0, 150.0, 300.0}) {
        std::mt19937 random(77);
        int through = 0;
        for (int start = 0; start < 40; ++start) {
            PulledCable cable(speed, random);
            bool any = false;
            const auto steps = std::lround(8 * cable.lab.frame() / static_cast<double>(cable.lab.def.time_step));
            for (int step = 0; step < steps && !any; ++step) any = cable.goes_through();
            through += any;
        }
        EXPECT_EQ(through, 0) << speed << " m/s";
    }
}

struct ThrownGrain : testing::TestWithParam<Wall> {};

TEST_P(ThrownGrain, StaysOnItsSideOfTheWall) {
    constexpr double kRadius = 0.01;
    for (double speed : kSpeeds)
        for (const bool wall_first : {false, true}) {
            std::mt19937 random(11);
            int lost = 0;
            for (int shot = 0; shot < 20; ++shot) {
                World world(weightless);
                const auto add_wall = [&] {
                    world.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(world, GetParam())});
                };
                if (wall_first) add_wall();
                const Vec way = unit(Vec(1, between(random, -0.5, 0.5), between(random, -0.5, 0.5)));
                taut_particle_def def;
                taut_particle_def_init(&def);
                def.mass = 0.05f;
                def.position = (-between(random, 0.5, 3) * way).pos();
                def.velocity = (speed * way).narrow();
                def.shape = world.sphere(kRadius);
                taut_body grain{};
                ok(taut_world_add_particle(world.handle, &def, &grain));
                if (!wall_first) add_wall();
                bool passed = false;
                for (int frame = 0; frame < 30 || frame * world.frame() * speed < 5; ++frame) {
                    world.step();
                    passed = passed || any_behind({grain}, half_thickness(GetParam()) + kRadius);
                }
                lost += passed;
            }
            EXPECT_EQ(lost, 0) << speed << " m/s";
        }
}

INSTANTIATE_TEST_SUITE_P(At, ThrownGrain,
                         testing::Values(Wall::thick, Wall::plate, Wall::sheet, Wall::mesh, Wall::plane));

void launch(taut_cable cable, const Vec& velocity) {
    for (taut_body body : bodies_of(cable)) ok(taut_body_set_velocity(body, velocity.narrow(), {0, 0, 0}));
}

// Of the speed. The segments turn on in what is left of the frame, and push: at 1000 m/s by 3 % in steps sixteen times
// finer.
double off_the_blow(double speed) { return (speed > 300 ? 0.04 : 0.02) * speed; }

// A free segment takes along what hits it about its middle, and momentum is kept.
TEST(ThinCable, StopsABall) {
    constexpr double kBall = 0.1, kLong = 0.5, kEnd = 0.5 * kLong * kMassPerMetre;  // [kg], [m], [kg]
    for (double speed : kSpeeds) {
        std::mt19937 random(3);
        for (int shot = 0; shot < 20; ++shot) {
            CableLab lab(weightless);
            const taut_cable cable = straight(lab, {0, 0, 0}, {0, 1, 0}, 1, kLong);
            const double start = between(random, 0.5, 3), high = between(random, -0.05, 0.05);
            const taut_body ball = lab.add(
                {.shape = lab.sphere(0.02), .position = {-start, high, 0}, .velocity = {speed, 0, 0}, .mass = kBall});
            lab.step(static_cast<int>(start / (speed * lab.frame())) + 2);
            // The blow ends their approach: p (1/m + ((1 - t)^2 + t^2) / m_end) = v
            const double t = high / kLong + 0.5, blow = speed / (1 / kBall + ((1 - t) * (1 - t) + t * t) / kEnd);
            EXPECT_NEAR(velocity(ball).x, speed - blow / kBall, off_the_blow(speed)) << speed << " m/s, shot " << shot;
            double momentum = kBall * velocity(ball).x;
            for (taut_body body : bodies_of(cable)) momentum += kEnd * velocity(body).x;
            EXPECT_NEAR(momentum, kBall * speed, 1e-3 * kBall * speed);
        }
    }
}

// Two segments that cross, the middle of one thrown at the other.
TEST(ThinCable, StopsAnother) {
    constexpr double kLong = 0.5, kEnd = 0.5 * kLong * kMassPerMetre;  // [m], [kg]
    for (double speed : kSpeeds) {
        std::mt19937 random(5);
        for (int shot = 0; shot < 20; ++shot) {
            CableLab lab(weightless);
            const double turn = between(random, 0.3, kPi - 0.3), start = between(random, 0.5, 3),
                         high = between(random, -0.05, 0.05);
            straight(lab, {0, 0, 0}, {0, 1, 0}, 1, kLong);
            const taut_cable thrown = straight(lab, {-start, high, 0}, {0, std::cos(turn), std::sin(turn)}, 1, kLong);
            launch(thrown, {speed, 0, 0});
            lab.step(static_cast<int>(start / (speed * lab.frame())) + 2);
            const double t = high / kLong + 0.5, blow = speed * kEnd / (0.5 + (1 - t) * (1 - t) + t * t);
            double after = 0;
            for (taut_body body : bodies_of(thrown)) after += 0.5 * velocity(body).x;
            EXPECT_NEAR(after, speed - blow / (2 * kEnd), off_the_blow(speed)) << speed << " m/s, shot " << shot;
        }
    }
}

// Switched off at one of its ends a segment is not looked for, nor in a world that looks for nothing.
TEST(ThinCable, TunnelsWhereItIsAllowedTo) {
    for (const bool by_world : {false, true}) {
        CableLab lab([&](taut_world_def& def) { weightless(def), def.continuous = !by_world; });
        lab.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(lab, Wall::sheet)});
        const taut_cable cable = straight(lab, {-1.1, 0, 0}, {0, 1, 0}, 1, 0.5);
        if (!by_world) ok(taut_body_set_continuous(bodies_of(cable)[1], 0));
        launch(cable, {100, 0, 0});
        lab.step(4);
        EXPECT_GT(points_of(cable)[0].x, 4);
    }
}

}  // namespace
