// Shapes and motions of cloth that mechanics knows: a catenary, a drumhead, an overhang, a square over a bar.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

// To rest by dropping all velocities whenever the kinetic energy begins to fall.
template <class Cloth>
void let_rest(const World& world, Cloth cloth, int steps) {
    const std::vector<taut_body> bodies = bodies_of(cloth);
    double before = 0;
    for (int i = 0; i < steps; ++i) {
        world.step();
        double now = 0;
        for (const taut_body body : bodies) now += dot(velocity(body), velocity(body));
        if (now < before) {
            set_velocities(bodies, {});
            now = 0;
        }
        before = now;
    }
}

// ---------------------------------------------------------------- catenary

class Strip : public testing::TestWithParam<taut_cloth_kind> {};
INSTANTIATE_TEST_SUITE_P(Of, Strip, testing::Values(TAUT_CLOTH_TRIANGLES, TAUT_CLOTH_LINKS),
                         [](const auto& each) { return each.param == TAUT_CLOTH_LINKS ? "Links" : "Triangles"; });

// Half the length a sinh(s / 2a) of a catenary with that span, y = a cosh(x / a).
double catenary_scale(double span, double length) {
    double low = 0.05 * span, high = 100 * span;
    for (int i = 0; i < 200; ++i) {
        const double a = 0.5 * (low + high);
        (2 * a * std::sinh(span / (2 * a)) > length ? low : high) = a;
    }
    return low;
}

// A strip held at both ends that hardly stretches. As a polygon of n parts of one length it is off the curve by their
// sagitta and by what its masses, lumped at the corners, are off: both of the order of length / n^2.
TEST_P(Strip, HangsAsACatenary) {
    constexpr double kLength = 2, kSpan = 1.4;
    constexpr int kRows = 33;
    World world;
    Sheet sheet(kRows, 3, kLength, 0.125, 0);
    taut_cloth_def def = sheet.def(GetParam());
    for (float& each : def.stretch_stiffness) each = 1e5f;
    def.shear_stiffness = 5e4f;
    def.poisson_ratio = 0;
    for (float& each : def.stretch_compliance) each = 1e-6f;
    def.shear_compliance = std::numeric_limits<float>::infinity();
    def.rest = sheet.points.data();
    // An arc of that length over the span to begin with.
    double angle = 1;
    for (int i = 0; i < 100; ++i) angle = kLength / kSpan * std::sin(angle);
    const double radius = kLength / (2 * angle);
    std::vector<taut_pos> hung = sheet.points;
    for (taut_pos& p : hung) {
        const double at = (2 * p.x / kLength - 1) * angle;
        p = {radius * std::sin(at), radius * (std::cos(angle) - std::cos(at)), p.z};
    }
    def.points = hung.data();
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const int row : {0, kRows - 1})
        for (int k = 0; k < 3; ++k) ok(taut_cloth_pin(cloth, sheet.at(row, k), 1));
    let_rest(world, cloth, 400);
    const std::vector<Vec> x = points_of(cloth);
    const double a = catenary_scale(kSpan, kLength), bank = a * std::cosh(kSpan / (2 * a));
    const double near = 2 * kLength / ((kRows - 1) * (kRows - 1));
    for (int row = 0; row < kRows; ++row)
        for (int k = 0; k < 3; ++k) {
            const Vec& p = x[sheet.at(row, k)];
            EXPECT_NEAR(p.y, a * std::cosh(p.x / a) - bank, near) << row << ' ' << k;
            EXPECT_NEAR(p.z, 0.0625 * k, near) << row << ' ' << k;
        }
    // It is no arc of a circle, nor a parabola.
    const double sag = bank - a;
    EXPECT_GT(std::abs(sag - radius * (1 - std::cos(angle))), 4 * near);
    EXPECT_NEAR(-x[sheet.at(kRows / 2, 1)].y, sag, near);
}

// ---------------------------------------------------------------- drumhead

// A disc of rings, six more points in each; the first is the middle.
struct Disc {
    Disc(int rings, double radius) : count(rings) {
        points.push_back({0, 0, 0});
        for (int ring = 1; ring <= rings; ++ring)
            for (int i = 0; i < 6 * ring; ++i) {
                const double at = 2 * kPi * i / (6 * ring), r = radius * ring / rings;
                points.push_back({r * std::cos(at), 0, r * std::sin(at)});
            }
        for (int ring = 1; ring <= rings; ++ring)
            for (int side = 0; side < 6; ++side)
                for (int i = 0; i < ring; ++i) {
                    const uint32_t outer = at(ring, side * ring + i), next = at(ring, side * ring + i + 1),
                                   inner = at(ring - 1, side * (ring - 1) + i);
                    triangles.insert(triangles.end(), {inner, next, outer});
                    if (i + 1 < ring)
                        triangles.insert(triangles.end(), {inner, at(ring - 1, side * (ring - 1) + i + 1), next});
                }
    }
    uint32_t at(int ring, int i) const {
        return ring == 0 ? 0 : static_cast<uint32_t>(1 + 3 * ring * (ring - 1) + i % (6 * ring));
    }

    int count;
    std::vector<taut_pos> points;
    std::vector<uint32_t> triangles;
};

// A membrane stretched by l from its rest shape bears S = k (l^2 - 1)/2 a metre, k: its stiffness over 1 - nu, and is
// l^2 times as light a square metre. Its first frequency is j_01 / (2 pi R) sqrt(S / rho), j_01 = 2.40483. A lattice of
// equilateral triangles with its mass at the corners is slower by (j_01 d / R)^2 / 32, d: the rings' distance, substeps
// of implicit Euler by (omega h)^2 / 3, and the amplitude's own stretch is k/S (A/R)^2: together 0.3 %.
TEST(Drumhead, SwingsAtItsFirstFrequency) {
    constexpr double kRadius = 0.5, kDensity = 0.2, kStretch = 1.05, kFrequency = 2, kFirst = 2.404825557695773;
    constexpr double kAmplitude = 1e-3;
    const double speed = 2 * kPi * kRadius * kFrequency / kFirst;  // of waves [m/s]
    const double tension = kDensity / (kStretch * kStretch) * speed * speed;
    const double stiffness = tension / (0.5 * (kStretch * kStretch - 1));
    World world([](taut_world_def& def) {
        def.gravity = {0, 0, 0};
        def.time_step = 1 / 120.0f;
        def.substeps = 4;
    });
    const Disc disc(9, kRadius), rest(9, kRadius / kStretch);
    taut_cloth_def def;
    taut_cloth_def_init(&def);
    def.points = disc.points.data();
    def.rest = rest.points.data();
    def.point_count = static_cast<uint32_t>(disc.points.size());
    def.triangles = disc.triangles.data();
    def.triangle_count = static_cast<uint32_t>(disc.triangles.size() / 3);
    def.area_density = static_cast<float>(kDensity);
    for (float& each : def.stretch_stiffness) each = static_cast<float>(stiffness);
    def.shear_stiffness = static_cast<float>(stiffness / 2);
    def.poisson_ratio = 0;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < 6 * disc.count; ++i) ok(taut_cloth_pin(cloth, disc.at(disc.count, i), 1));
    const std::vector<taut_body> bodies = bodies_of(cloth);
    for (size_t i = 0; i < bodies.size(); ++i) {
        const double r = std::hypot(disc.points[i].x, disc.points[i].z);
        if (r > kRadius * (1 - 1e-9)) continue;
        const double v = kAmplitude * 2 * kPi * kFrequency * std::cyl_bessel_j(0.0, kFirst * r / kRadius);
        ok(taut_body_set_velocity(bodies[i], Vec(0, v, 0).narrow(), {}));
    }
    Crossings crossings;
    double highest = 0, flat = 0;
    for (int i = 1; i <= 200; ++i) {
        world.step();
        const std::vector<Vec> x = points_of(cloth);
        crossings.sample(i / 120.0, x[0].y);
        highest = std::max(highest, x[0].y);
        flat = std::max(flat, std::hypot(x[0].x, x[0].z));
    }
    ASSERT_GE(crossings.times.size(), 3u);
    EXPECT_NEAR(crossings.period() * kFrequency, 1, 0.01);
    EXPECT_NEAR(highest / kAmplitude, 1, 0.1);
    EXPECT_LT(flat, 1e-6);
}

// ---------------------------------------------------------------- overhang

// Height of the end of a strip of that length, clamped level, under its own weight: the heavy elastica
//   B theta'' = w (L - s) cos theta,   theta(0) = 0,  theta'(L) = 0,  theta: below the level,
// with c = B / w, by bisection over theta'(0) and steps of Runge and Kutta.
double overhang(double length, double c) {
    struct State {
        double theta, turn, y;
    };
    const auto end = [&](double turn) {
        constexpr int kSteps = 2000;
        const double h = length / kSteps;
        State at{0, turn, 0};
        const auto rate = [&](const State& of, double s) {
            return State{of.turn, -(length - s) * std::cos(of.theta) / c, -std::sin(of.theta)};
        };
        const auto moved = [](const State& of, const State& by, double t) {
            return State{of.theta + t * by.theta, of.turn + t * by.turn, of.y + t * by.y};
        };
        for (int i = 0; i < kSteps; ++i) {
            const double s = i * h;
            const State a = rate(at, s), b = rate(moved(at, a, h / 2), s + h / 2),
                        d = rate(moved(at, b, h / 2), s + h / 2), e = rate(moved(at, d, h), s + h);
            at = moved(at, a, h / 6), at = moved(at, b, h / 3), at = moved(at, d, h / 3), at = moved(at, e, h / 6);
        }
        return at;
    };
    double low = 0, high = 2 * length * length / c;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (end(middle).turn < 0 ? low : high) = middle;
    }
    return end(low).y;
}

class Overhang : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Of, Overhang, testing::Values(0.15, 0.25, 0.35));

// Peirce's test of a fabric's stiffness (1930), at lengths from 1.5 to 3.5 of its bending length (B / w)^(1/3). A strip
// that bends at its rows begins to half a cell before the first of them. Cells fold along their diagonals too, which
// leaves 0.82 of the stiffness for small bends on this mesh. Bends are evaluated where gravity alone would take the
// vertices, h^2 g lower, by which the first fold is off, h^2 g / cell: at 16 substeps 0.002 rad, 0.5 % of the shortest
// one's sink.
TEST_P(Overhang, BendsAsAHeavyElastica) {
    constexpr double kDensity = 0.2, kLength3 = 1e-3, kLeast = 0.8;  // kLength3: B / w [m^3]
    constexpr int kRows = 31;
    const double cell = GetParam() / (kRows - 1.5), length = cell * kRows;
    World world([](taut_world_def& def) {
        def.time_step = 1 / 60.0f;
        def.substeps = 16;
    });
    const Sheet sheet(kRows + 1, 3, length, 2 * cell, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    for (float& each : def.stretch_stiffness) each = 2e5f;
    def.shear_stiffness = 1e5f;
    def.poisson_ratio = 0;
    def.area_density = static_cast<float>(kDensity);
    def.bending_stiffness = static_cast<float>(kLength3 * kDensity * kG);
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const int row : {0, 1})
        for (int k = 0; k < 3; ++k) ok(taut_cloth_pin(cloth, sheet.at(row, k), 1));
    let_rest(world, cloth, 80);
    const double stiff = overhang(length - 0.5 * cell, kLength3),
                 soft = overhang(length - 0.5 * cell, kLeast * kLength3);
    const std::vector<Vec> x = points_of(cloth);
    for (int k = 0; k < 3; ++k) {
        EXPECT_LT(x[sheet.at(kRows, k)].y, 0.99 * stiff) << k;
        EXPECT_GT(x[sheet.at(kRows, k)].y, 1.01 * soft) << k;
    }
}

// ---------------------------------------------------------------- drape

// A square over a bar of radius R - t/2: edges of length s stand off by half the thickness t, so that vertices lie at
// sqrt(R^2 + s^2/4) from its axis. It lies on half a turn and hangs on either side by what is left, (L - pi R)/2; the
// fold on top is as long as the square is wide. Tangents come by R (s/R)^2/12 a radian over the arc, and ends lie
// within s of where the cloth leaves the bar.
TEST(Drape, HangsFromABarByHalfOfWhatIsLeft) {
    constexpr int kSide = 17;
    constexpr double kSize = 1, kBar = 0.08, kThick = 0.005, kHeight = 1;
    World world;
    world.add({.kind = TAUT_BODY_STATIC,
               .shape = world.capsule(kBar, 1),
               .position = {kSize / 2, kHeight, kSize / 2},
               .rotation = Quat::turn({1, 0, 0}, kPi / 2)});
    const double radius = kBar + kThick / 2;
    const Sheet sheet(kSide, kSide, kSize, kSize, kHeight + radius + 0.002);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.thickness = static_cast<float>(kThick);
    def.damping = 0.01f;
    const taut_cloth cloth = add(world, def);
    for (int i = 0; i < 140; ++i) {
        world.step();
        if (i % 10 == 0) set_velocities(bodies_of(cloth), {});  // let down: what swings is chaotic
    }
    const std::vector<Vec> x = points_of(cloth);
    const double hangs = kHeight - 0.5 * (kSize - kPi * radius), spacing = kSize / (kSide - 1);
    const double near = kPi * spacing * spacing / (12 * radius) + 0.2 * spacing;
    const double top = std::sqrt(radius * radius + 0.25 * spacing * spacing);
    double fold = 0;
    for (int k = 0; k < kSide; ++k) {
        EXPECT_NEAR(x[sheet.at(0, k)].y, hangs, near) << k;
        EXPECT_NEAR(x[sheet.at(kSide - 1, k)].y, hangs, near) << k;
        EXPECT_NEAR(x[sheet.at(kSide / 2, k)].y, kHeight + top, 0.002) << k;
        if (k > 0) fold += norm(x[sheet.at(kSide / 2, k)] - x[sheet.at(kSide / 2, k - 1)]);
    }
    EXPECT_NEAR(fold, kSize, 1e-3);
}

}  // namespace
