// Cables against statics: tension, catenary, elongation, beams, and reeling under load.
#include "physics/cable_lab.h"

namespace {

using namespace lab;

// Plain implicit Euler damping: what is to hang still does so soon.
void calm(taut_world_def& def) { def.velocity_filter = 0; }

class EitherCable : public testing::TestWithParam<taut_cable_kind> {};

std::string kind_name(const testing::TestParamInfo<taut_cable_kind>& tested) {
    return tested.param == TAUT_CABLE_LINKS ? "links" : "particles";
}

INSTANTIATE_TEST_SUITE_P(Of, EitherCable, testing::Values(TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS), kind_name);

// The tension of a segment is the weight below its middle.
TEST_P(EitherCable, CarriesTheWeightBelow) {
    constexpr double kLength = 10, kPerMetre = 2, kLoad = 500;
    CableLab lab;
    const taut_body load = lab.add({.position = {0, -kLength, 0}, .mass = kLoad, .inertia = {10, 10, 10}});
    taut_cable_def d = CableLab::plan(GetParam(), load);
    d.mass_per_metre = kPerMetre;
    d.segment_count = 20;
    const taut_cable cable = lab.cable(d);
    EXPECT_NEAR(length_of(cable), kLength, 1e-5);
    lab.step(120);
    const auto tensions = tensions_of(cable);
    ASSERT_EQ(tensions.size(), 20u);
    for (size_t i = 0; i < tensions.size(); ++i) {
        const double below = kLoad + kPerMetre * kLength * (1 - (static_cast<double>(i) + 0.5) / 20);
        EXPECT_NEAR(tensions[i], below * kG, 1e-3 * below * kG) << i;
    }
    EXPECT_NEAR(position(load).y, -kLength, 1e-4);
    EXPECT_LT(norm(velocity(load)), 1e-3);
}

// y = a cosh((x - c)/a) + const through both ends with the given arc length.
struct Catenary {
    Catenary(double width, double height, double length) {
        double lo = 1e-3, hi = 1e3;
        for (int i = 0; i < 200; ++i) {
            a = 0.5 * (lo + hi);
            (2 * a * std::sinh(width / (2 * a)) > std::sqrt(length * length - height * height) ? lo : hi) = a;
        }
        c = width / 2 - a * std::atanh(height / length);
        base = -a * std::cosh(c / a);
    }
    double y(double x) const { return base + a * std::cosh((x - c) / a); }
    double a, c, base;
};

TEST_P(EitherCable, HangsAsACatenary) {
    constexpr double kWidth = 8, kHeight = 2, kLength = 12;
    constexpr uint32_t kSegments = 60;
    CableLab lab;
    taut_cable_def d = CableLab::plan(GetParam());
    d.end[0] = to_world({0, 0, 0});
    d.end[1] = to_world({kWidth, kHeight, 0});
    d.length = kLength;
    d.segment_count = kSegments;
    const taut_cable cable = lab.cable(d);
    EXPECT_NEAR(length_of(cable), kLength, 1e-4);
    settle(lab, bodies_of(cable), 600);
    lab.step(60);
    const Catenary wanted(kWidth, kHeight, kLength);
    double worst = 0;
    for (const Vec& p : points_of(cable)) {
        EXPECT_NEAR(p.z, 0, 1e-3);
        worst = std::max(worst, std::abs(p.y - wanted.y(p.x)));
    }
    EXPECT_LT(worst, 1e-3);
    RecordProperty("worst_mm", std::to_string(1e3 * worst));
    // The horizontal pull is the same everywhere: w a.
    const auto points = points_of(cable);
    const auto tensions = tensions_of(cable);
    for (size_t i = 0; i < tensions.size(); ++i) {
        const Vec along = unit(points[i + 1] - points[i]);
        EXPECT_NEAR(tensions[i] * along.x, kG * wanted.a, 0.01 * kG * wanted.a) << i;
    }
}

// Elongation of a hanging cable: compliance (W + w L/2) L.
TEST_P(EitherCable, StretchesByItsCompliance) {
    constexpr double kLength = 10, kPerMetre = 2, kLoad = 100, kCompliance = 1e-5;
    CableLab lab;
    const taut_body load = lab.particle(kLoad, {0, -kLength, 0});
    taut_cable_def d = CableLab::plan(GetParam(), load);
    d.mass_per_metre = kPerMetre;
    d.segment_count = 20;
    d.stretch_compliance = static_cast<float>(kCompliance);
    d.stretch_damping = 1e4f;
    const taut_cable cable = lab.cable(d);
    lab.step(900);
    const double wanted = kCompliance * (kLoad + 0.5 * kPerMetre * kLength) * kG * kLength;
    EXPECT_NEAR(-position(load).y - kLength, wanted, 0.005 * wanted);
    EXPECT_NEAR(length_of(cable), kLength, 1e-5);
}

// A clamped cable sags as a beam: w L^4 / (8 EI) under its own weight and F L^3 / (3 EI) under a load at its end.
TEST_P(EitherCable, SagsAsABeam) {
    constexpr double kLength = 2, kPerMetre = 1, kStiffness = 400;
    for (const double load : {0.0, 2.0}) {
        CableLab lab(calm);
        CableBeam beam(GetParam(), {kLength, 0, 0});
        taut_cable_def& d = beam.def;
        d.mass_per_metre = kPerMetre;
        d.bending_stiffness = kStiffness;
        d.bending_damping = 5;
        if (load > 0) d.end[1] = to_body(lab.particle(load, {kLength, 0, 0}));
        const taut_cable cable = lab.cable(d);
        lab.step(1200);
        const double wanted =
            kG * (kPerMetre * std::pow(kLength, 4) / 8 + load * std::pow(kLength, 3) / 3) / kStiffness;
        EXPECT_NEAR(-points_of(cable).back().y, wanted, 0.02 * wanted) << load;
    }
}

// First frequency of a beam that is clamped at one end: 3.516 / (2 pi) sqrt(EI / (w L^4)).
TEST_P(EitherCable, SwingsAsABeam) {
    constexpr double kLength = 2, kPerMetre = 1, kStiffness = 50;
    CableLab lab([](taut_world_def& def) { def.gravity = {}; });
    CableBeam beam(GetParam(), {kLength, 0, 0});
    taut_cable_def& d = beam.def;
    d.mass_per_metre = kPerMetre;
    d.bending_stiffness = kStiffness;
    const taut_cable cable = lab.cable(d);
    const auto bodies = bodies_of(cable);
    for (size_t i = 1; i < bodies.size(); ++i) {  // the first mode's shape, nearly
        const double at = points_of(cable)[i].x / kLength;
        ok(taut_body_set_velocity(bodies[i], Vec(0, 0.2 * at * at, 0).narrow(), {}));
    }
    double first = 0, last = 0, before = 0;
    int crossings = 0;
    for (int i = 1; i < 600; ++i) {
        lab.step();
        const double y = points_of(cable).back().y;
        if (before * y < 0) {
            last = (i - y / (y - before)) / 60;
            if (crossings++ == 0) first = last;
        }
        before = y;
    }
    ASSERT_GT(crossings, 5);
    const double wanted = 3.516 / (2 * kPi) * std::sqrt(kStiffness / (kPerMetre * std::pow(kLength, 4)));
    EXPECT_NEAR(0.5 * (crossings - 1) / (last - first), wanted, 0.02 * wanted);
}

// A column with a clamped foot bears pi^2 EI / (4 L^2) at its head, and no more.
TEST_P(EitherCable, BucklesAsEulersColumn) {
    constexpr double kLength = 2, kStiffness = 40;
    const double critical = kPi * kPi * kStiffness / (4 * kLength * kLength);
    for (const double share : {0.9, 1.1}) {
        CableLab lab(calm);
        CableBeam beam(GetParam(), {0, kLength, 0});
        taut_cable_def& d = beam.def;
        d.mass_per_metre = 0.01f;
        d.gravity_scale = 0;
        d.bending_stiffness = kStiffness;
        d.bending_damping = 1;
        const taut_body load = lab.particle(share * critical / kG, {0, kLength, 0});
        d.end[1] = to_body(load);
        lab.cable(d);
        ok(taut_body_set_velocity(load, {0.02f, 0, 0}, {}));
        lab.step(1800);
        const double aside = std::abs(position(load).x);
        if (share < 1)
            EXPECT_LT(aside, 0.01) << share;
        else
            EXPECT_GT(aside, 0.3) << share;
    }
}

// A load on a winch: hauled in or paid out at constant speed, over many points added and removed. Its height follows
// the length, and the tension stays its weight.
struct Winch {
    taut_cable_kind kind;
    double speed, load;
    double compliance = 0;
    double bending = 0;
};

void PrintTo(const Winch& w, std::ostream* out) {
    *out << (w.kind == TAUT_CABLE_LINKS ? "links" : "particles") << (w.speed > 0 ? "_out_" : "_in_") << w.load
         << (w.compliance > 0 ? "_elastic" : "") << (w.bending > 0 ? "_stiff" : "");
}

class Reeling : public testing::TestWithParam<Winch> {};

TEST_P(Reeling, MovesTheLoadWithoutKicks) {
    constexpr double kPerMetre = 1, kAcceleration = 2;
    const Winch& w = GetParam();
    const double start = w.speed > 0 ? 4 : 12;
    CableLab lab;
    const taut_body load = lab.add({.position = {0, -start, 0}, .mass = w.load, .inertia = {10, 10, 10}});
    taut_cable_def d = CableLab::plan(w.kind, load);
    d.segment_length = 0.5f;
    d.mass_per_metre = kPerMetre;
    d.stretch_compliance = static_cast<float>(w.compliance);
    d.stretch_damping = w.compliance > 0 ? static_cast<float>(0.2 / w.compliance) : 0;
    d.bending_stiffness = static_cast<float>(w.bending);
    d.bending_damping = static_cast<float>(0.1 * w.bending);
    const taut_cable cable = lab.cable(d);
    lab.step(w.compliance > 0 ? 600 : 60);
    ok(taut_cable_set_reel_speed(cable, 0, static_cast<float>(w.speed), kAcceleration));
    double worst_pull = 0, worst_place = 0, worst_gap = 0, worst_side = 0;
    const int frames = static_cast<int>(8 / std::abs(w.speed) * 60);
    const size_t segments = tensions_of(cable).size();
    for (int i = 0; i < frames; ++i) {
        lab.step();
        const double stretch = w.compliance * (w.load + 0.5 * kPerMetre * length_of(cable)) * kG * length_of(cable);
        if (w.compliance == 0 || i > 150)
            worst_place = std::max(worst_place, std::abs(-position(load).y - length_of(cable) - stretch));
        worst_side = std::max(worst_side, std::hypot(position(load).x, position(load).z));
        if (w.compliance == 0) worst_gap = std::max(worst_gap, static_cast<double>(lab.profile().joint_error));
        if (i < 90) continue;  // the reel gathers speed
        const auto points = points_of(cable);
        const auto tensions = tensions_of(cable);
        double below = w.load;  // the middle of each segment
        for (size_t k = tensions.size(); k-- > 0;) {
            const double half = 0.5 * kPerMetre * norm(points[k + 1] - points[k]);
            worst_pull = std::max(worst_pull, std::abs(tensions[k] / ((below + half) * kG) - 1));
            below += 2 * half;
        }
    }
    RecordProperty("pull_ppm", std::to_string(1e6 * worst_pull));
    EXPECT_GE(std::abs(static_cast<double>(tensions_of(cable).size()) - static_cast<double>(segments)), 11);
    // Bends of particles make loops, whose rods give way a little.
    const bool looped = w.kind == TAUT_CABLE_PARTICLES && w.bending > 0;
    EXPECT_LT(worst_pull, w.compliance > 0 ? 5e-4 : looped ? 2e-5 : 1e-6);
    EXPECT_LT(worst_place, 1e-4);
    EXPECT_LT(worst_gap, 1e-6);
    EXPECT_LT(worst_side, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Of, Reeling,
    testing::Values(Winch{TAUT_CABLE_PARTICLES, 1, 1000}, Winch{TAUT_CABLE_PARTICLES, -1, 1000},
                    Winch{TAUT_CABLE_LINKS, 1, 1000}, Winch{TAUT_CABLE_LINKS, -1, 1000},
                    Winch{TAUT_CABLE_PARTICLES, 3, 10}, Winch{TAUT_CABLE_PARTICLES, -3, 10},
                    Winch{TAUT_CABLE_LINKS, 3, 10}, Winch{TAUT_CABLE_LINKS, -3, 10},
                    Winch{TAUT_CABLE_PARTICLES, 1, 1000, 1e-6}, Winch{TAUT_CABLE_PARTICLES, -1, 1000, 1e-6},
                    Winch{TAUT_CABLE_LINKS, 1, 1000, 1e-6}, Winch{TAUT_CABLE_LINKS, -1, 1000, 1e-6},
                    Winch{TAUT_CABLE_LINKS, 1, 1000, 0, 10}, Winch{TAUT_CABLE_LINKS, -1, 1000, 0, 10},
                    Winch{TAUT_CABLE_PARTICLES, 1, 1000, 0, 10}, Winch{TAUT_CABLE_PARTICLES, -1, 1000, 0, 10}));

// A crane hauls in a load that swings, and pays it out again: bent ends are joined and cut, both ends at work.
TEST_P(EitherCable, IsReeledWhileItSwings) {
    CableLab lab;
    const taut_body load = lab.add({.position = {6, -6, 0}, .mass = 200, .inertia = {10, 10, 10}});
    taut_cable_def d = CableLab::plan(GetParam(), load);
    d.segment_length = 0.4f;
    const taut_cable cable = lab.cable(d);
    const double start = length_of(cable);
    double gap = 0, pull = 0, stretch = 0;
    for (int i = 0; i < 960; ++i) {
        const float speed = i / 240 % 2 == 0 ? -0.6f : 0.6f;
        if (i % 240 == 0) {
            ok(taut_cable_set_reel_speed(cable, 0, speed, 4));
            ok(taut_cable_set_reel_speed(cable, 1, 0.5f * speed, 4));
        }
        lab.step();
        gap = std::max(gap, static_cast<double>(lab.profile().joint_error));
        for (double t : tensions_of(cable)) pull = std::max(pull, t);
        const auto points = points_of(cable);
        double sum = 0;
        for (size_t k = 1; k < points.size(); ++k) sum += norm(points[k] - points[k - 1]);
        stretch = std::max(stretch, std::abs(sum - length_of(cable)));
    }
    EXPECT_LT(gap, 5e-5);
    EXPECT_LT(stretch, 2e-4);
    // From 45 degrees, and shorter: at most a few times the weight.
    EXPECT_LT(pull, 4 * 200 * kG);
    EXPECT_NEAR(length_of(cable) - start, -0.169, 0.02);  // what the ramps of both ends leave
    RecordProperty("gap_um", std::to_string(1e6 * gap));
    RecordProperty("stretch_um", std::to_string(1e6 * stretch));
    RecordProperty("pull_of_weight", std::to_string(pull / (200 * kG)));
    RecordProperty("length_mm", std::to_string(1e3 * (length_of(cable) - start)));
}

// The last segment is not hauled in, and nothing breaks.
TEST_P(EitherCable, IsHauledInToItsLastSegment) {
    CableLab lab;
    const taut_body load = lab.add({.position = {0, -2, 0}, .mass = 100, .inertia = {1, 1, 1}});
    taut_cable_def d = CableLab::plan(GetParam(), load);
    d.segment_length = 0.5f;
    const taut_cable cable = lab.cable(d);
    ok(taut_cable_reel(cable, 0, -5));
    ok(taut_cable_set_reel_speed(cable, 1, -1, 0));
    lab.step(300);
    EXPECT_EQ(tensions_of(cable).size(), 1u);
    EXPECT_NEAR(length_of(cable), 0.1, 1e-6);
    ok(taut_cable_set_reel_speed(cable, 1, 0, 0));
    ok(taut_cable_reel(cable, 0, 1.9f));
    lab.step(120);
    EXPECT_NEAR(length_of(cable), 2, 1e-5);
    EXPECT_LT(lab.profile().joint_error, 1e-3f);
}

// At any speed up to the fastest, half a segment a step, the end segment passes the lengths at which it is cut and
// joined in another order. What was joined must not be cut for what is left to be joined again, for ever.
TEST_P(EitherCable, IsHauledInAtAnySpeed) {
    for (int percent : {5, 10, 20, 30, 36, 40, 43, 46, 48, 50}) {
        CableLab lab;
        const taut_body load = lab.add({.position = {0, -4, 0}, .mass = 100, .inertia = {1, 1, 1}});
        taut_cable_def d = CableLab::plan(GetParam(), load);
        d.segment_length = 0.1f;
        const taut_cable cable = lab.cable(d);
        const double speed = 0.01 * percent * 0.1 / static_cast<double>(lab.def.time_step);
        ok(taut_cable_set_reel_speed(cable, 0, static_cast<float>(-speed), 0));
        const int steps = static_cast<int>(2 / (speed * lab.frame()));
        lab.step(steps);
        EXPECT_NEAR(length_of(cable), 4 - speed * lab.stepped(steps), 0.01) << percent;
        EXPECT_EQ(tensions_of(cable).size() + 1, points_of(cable).size());
    }
}

// A path's own stretches are segments: a long one beside short ones is cut more than once when they are joined.
TEST_P(EitherCable, HaulsInUnevenSegments) {
    CableLab lab;
    std::vector<taut_pos> path = {{0, 0, 0}};
    for (double length : {0.1, 0.02, 0.9, 0.05, 0.03, 0.7, 0.02, 1.3, 0.1})
        path.push_back({0, path.back().y - length, 0});
    const taut_body load = lab.add({.position = path.back(), .mass = 10, .inertia = {1, 1, 1}});
    taut_cable_def d = CableLab::plan(GetParam(), load);
    d.points = path.data();
    d.point_count = static_cast<uint32_t>(path.size());
    const taut_cable cable = lab.cable(d);
    const double before = length_of(cable);
    ok(taut_cable_set_reel_speed(cable, 0, -3, 0));
    lab.step(30);
    EXPECT_NEAR(length_of(cable), before - 30 * 3 * lab.frame(), 0.01);
    lab.step(60);
    EXPECT_EQ(tensions_of(cable).size(), 1u);
    EXPECT_TRUE(finite(position(load)));
}

// A cable folded to and fro ends where it begins: hauled in fast all of it is joined to one segment, which has a length
// and a direction all the same.
TEST_P(EitherCable, JoinsFoldedSegments) {
    for (double aside : {0.0, 1e-13, 1e-9, 1e-4}) {
        CableLab lab([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        taut_cable_def d = CableLab::plan(GetParam());
        const taut_pos path[] = {{0, 0, 0}, {0.4, 0, 0}, {-0.4, 0, 0}, {0.4, 0, 0}, {aside, 0, 0}};
        constexpr double kNominal = 0.6;  // (0.4 + 0.8 + 0.8 + 0.4) / 4
        d.points = path;
        d.point_count = 5;
        d.filter.mask = 0;
        d.end[0] = to_world({0, 0, 0});
        const taut_cable cable = lab.cable(d);
        ok(taut_cable_set_reel_speed(
            cable, 0, static_cast<float>(-0.499 * kNominal / static_cast<double>(lab.def.time_step)), 0));
        ok(taut_world_step(lab.handle));
        EXPECT_EQ(tensions_of(cable).size(), 1u);
        EXPECT_NEAR(length_of(cable), 0.2 * kNominal, 1e-4);
        ok(taut_cable_set_reel_speed(cable, 0, 1, 0));
        for (int i = 0; i < 60; ++i) {
            lab.step();
            for (const Vec& point : points_of(cable)) ASSERT_TRUE(finite(point)) << aside << ", step " << i;
            ASSERT_LT(norm(points_of(cable).back()), 2) << aside << ", step " << i;
        }
    }
}

// Twice the same bits, contacts, cuts and joins included.
TEST_P(EitherCable, GivesTheSameBitsTwice) {
    const auto run = [&] {
        CableLab lab;
        lab.add_ground();
        taut_cable_def d = CableLab::plan(GetParam());
        const taut_body load = lab.add({.shape = lab.box({0.2, 0.2, 0.2}), .position = {1, 1, 0.3}, .mass = 50});
        d.end[0] = to_world({0, 3, 0});
        d.end[1] = to_body(load, {0, 0.2, 0});
        d.segment_length = 0.2f;
        d.length = 3;
        d.self_collision = 1;
        const taut_cable cable = lab.cable(d);
        ok(taut_cable_set_reel_speed(cable, 0, -0.5f, 1));
        std::vector<uint64_t> hashes;
        for (int i = 0; i < 240; ++i) {
            if (i == 120) ok(taut_cable_set_reel_speed(cable, 0, 1, 5));
            lab.step();
            hashes.emplace_back();
            ok(taut_world_get_state_hash(lab.handle, &hashes.back()));
        }
        return hashes;
    };
    EXPECT_EQ(run(), run());
}

}  // namespace
