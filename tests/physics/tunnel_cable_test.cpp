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

void launch(taut_cable cable, const Vec& velocity) {
    for (taut_body body : bodies_of(cable)) ok(taut_body_set_velocity(body, velocity.narrow(), {0, 0, 0}));
}

struct Throw {
    const char* name;
    Wall wall;
    int segments;
};

void PrintTo(const Throw& t, std::ostream* out) { *out << t.name; }

struct ThrownCable : testing::TestWithParam<Throw> {};

struct Outcome {
    int lost = 0;       // of the cables, those whose middle came through
    double growth = 0;  // of the kinetic energy, at most
};

double kinetic(taut_cable cable) {
    double sum = 0;
    for (taut_body body : bodies_of(cable)) sum += 0.5 * mass_of(body).mass * dot(velocity(body), velocity(body));
    return sum;
}

// 20 cables thrown at a wall.
Outcome outcome(const Throw& row, double speed) {
    std::mt19937 random(7);
    Outcome out;
    for (int shot = 0; shot < 20; ++shot) {
        CableLab lab(weightless);
        lab.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(lab, row.wall)});
        const double angle = between(random, 0, 0.5), round = between(random, 0, 2 * kPi),
                     far = between(random, 1.2, 3);
        const Vec way(std::cos(angle), std::sin(angle) * std::cos(round), std::sin(angle) * std::sin(round));
        const taut_cable cable =
            straight(lab, -far * way, direction(random), row.segments, row.segments == 1 ? 0.5 : 0.25);
        launch(cable, speed * way);
        const double before = kinetic(cable);
        bool passed = false;
        for (int frame = 0; frame * lab.frame() * speed < 5; ++frame) {
            lab.step();
            Vec middle;
            const auto points = points_of(cable);
            for (const Vec& p : points) middle += 1.0 / static_cast<double>(points.size()) * p;
            passed = passed || !finite(middle) || middle.x > 0.5 * kDiameter;
            out.growth = std::max(out.growth, kinetic(cable) / before - 1);
        }
        out.lost += passed;
    }
    return out;
}

// What hits a wall by its end pushes itself on: its contact and what holds its length are not solved as one. Of those
// that are not looked for along their way, nearly all come through at 100 m/s.
TEST_P(ThrownCable, MostlyStaysOnItsSideOfTheWallAndGainsNoEnergy) {
    const std::pair<double, int> most_lost[] = {{5, 0}, {20, 2}, {50, 6}, {100, 10}};
    for (const auto& [speed, most] : most_lost) {
        const Outcome out = outcome(GetParam(), speed);
        EXPECT_LE(out.lost, most) << speed << " m/s";
        EXPECT_LE(out.growth, 0.01) << speed << " m/s";
    }
}

constexpr Throw kThrows[] = {{"segment_plate", Wall::plate, 1}, {"segment_sheet", Wall::sheet, 1},
                             {"segment_mesh", Wall::mesh, 1},   {"segment_plane", Wall::plane, 1},
                             {"cable_plate", Wall::plate, 6},   {"cable_sheet", Wall::sheet, 6},
                             {"cable_mesh", Wall::mesh, 6},     {"cable_plane", Wall::plane, 6}};

std::string throw_name(const testing::TestParamInfo<Throw>& tested) { return tested.param.name; }

INSTANTIATE_TEST_SUITE_P(Of, ThrownCable, testing::ValuesIn(kThrows), throw_name);

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
            EXPECT_NEAR(velocity(ball).x, speed - blow / kBall, 0.02 * speed) << speed << " m/s, shot " << shot;
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
            EXPECT_NEAR(after, speed - blow / (2 * kEnd), 0.02 * speed) << speed << " m/s, shot " << shot;
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
