// Cloths that tear by strain.
#include <array>
#include <map>
#include <set>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

std::vector<uint32_t> triangles_of(taut_cloth cloth) {
    uint32_t count = 0;
    taut_cloth_get_triangles(cloth, nullptr, 0, &count);
    std::vector<uint32_t> out(3 * size_t{count});
    ok(taut_cloth_get_triangles(cloth, out.data(), count, &count));
    return out;
}

// Two triangles at an edge at most, which go along it in opposite directions; those about a vertex hang together by
// edges at it; no vertex is without.
void expect_manifold(const std::vector<uint32_t>& triangles, size_t vertices) {
    std::map<std::pair<uint32_t, uint32_t>, size_t> along;
    std::vector<std::set<size_t>> about(vertices);
    for (size_t i = 0; i < triangles.size(); ++i) {
        const size_t t = i / 3;
        ASSERT_LT(triangles[i], vertices);
        about[triangles[i]].insert(t);
        ASSERT_TRUE(along.emplace(std::pair(triangles[i], triangles[3 * t + (i + 1) % 3]), t).second);
    }
    for (uint32_t v = 0; v < vertices; ++v) {
        ASSERT_FALSE(about[v].empty()) << v;
        std::set<size_t> seen{*about[v].begin()};
        std::vector<size_t> queue(seen.begin(), seen.end());
        for (size_t i = 0; i < queue.size(); ++i)
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t a = triangles[3 * queue[i] + k], b = triangles[3 * queue[i] + (k + 1) % 3];
                const auto beside = along.find({b, a});
                if ((a != v && b != v) || beside == along.end()) continue;
                if (seen.insert(beside->second).second) queue.push_back(beside->second);
            }
        ASSERT_EQ(seen.size(), about[v].size()) << "vertex " << v << " is of several fans";
    }
}

// Triangles that hang together by edges.
size_t pieces(const std::vector<uint32_t>& triangles, size_t vertices) {
    std::vector<uint32_t> parent(vertices);
    for (uint32_t v = 0; v < vertices; ++v) parent[v] = v;
    const auto root = [&](uint32_t v) {
        while (parent[v] != v) v = parent[v];
        return v;
    };
    for (size_t i = 0; i < triangles.size(); ++i) parent[root(triangles[i])] = root(triangles[i - i % 3]);
    size_t count = 0;
    for (uint32_t v = 0; v < vertices; ++v) count += parent[v] == v;
    return count;
}

struct Told {
    uint32_t tears = 0;
    float least = 1e9f, most = 0;
};

// Reads the events of a step: each new vertex is the last but for those after it, and of this cloth.
void read_tears(const World& world, taut_cloth cloth, size_t& vertices, Told& told) {
    taut_events events{};
    ok(taut_world_get_events(world.handle, &events));
    for (uint32_t i = 0; i < events.torn_count; ++i) {
        const taut_tear_event& torn = events.torn[i];
        ASSERT_EQ(torn.cloth.bits, cloth.bits);
        ASSERT_EQ(torn.user_data, 5u);
        ASSERT_EQ(torn.new_vertex, vertices++);
        ASSERT_LT(torn.vertex, torn.new_vertex);
        ASSERT_NE(torn.edge[0], torn.edge[1]);
        ASSERT_LT(torn.step, events.steps);
        told.least = std::min(told.least, torn.strain);
        told.most = std::max(told.most, torn.strain);
        ++told.tears;
    }
}

constexpr double kTear = 0.1, kStiffness = 1000, kWidth = 0.2, kLength = 0.5;
constexpr int kRows = 11, kColumns = 5;

taut_cloth_def torn_def(const Sheet& sheet, taut_cloth_kind kind) {
    taut_cloth_def def = sheet.def(kind);
    def.area_density = 50;
    for (int i = 0; i < 2; ++i) {
        def.stretch_stiffness[i] = static_cast<float>(kStiffness);
        def.stretch_compliance[i] = 1 / static_cast<float>(kStiffness);
    }
    def.shear_stiffness = 400;
    def.poisson_ratio = 0;
    def.shear_compliance = 1;
    def.damping = 0.2f;
    def.filter.mask = 0;
    def.tear_strain = static_cast<float>(kTear);
    def.stretch_tolerance = 1e-3f;  // of swept ones
    def.user_data = 5;
    return def;
}

struct Case {
    const char* name;
    taut_cloth_kind kind;
    taut_deformable_solve solve;
};
void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }
class Torn : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Of, Torn,
                         testing::Values(Case{"Links", TAUT_CLOTH_LINKS, TAUT_DEFORMABLE_DIRECT},
                                         Case{"Triangles", TAUT_CLOTH_TRIANGLES, TAUT_DEFORMABLE_DIRECT},
                                         Case{"SweptLinks", TAUT_CLOTH_LINKS, TAUT_DEFORMABLE_SWEPT}),
                         testing::PrintToStringParamName());

// A strip carries what stretches it to its tear strain e: of links k e L for each thread, of a sheet
// k (e + e^2/2) (1 + e) a metre's width. A little less holds, a little more tears it in two.
TEST_P(Torn, StripBearsWhatItsTearStrainSays) {
    const bool links = GetParam().kind == TAUT_CLOTH_LINKS;
    const double spacing = kLength / (kRows - 1);
    const double bears = links ? kStiffness * kTear * spacing * kColumns
                               : kStiffness * (kTear + kTear * kTear / 2) * (1 + kTear) * kWidth;
    // Sweeps give way by themselves, the more the longer their damping.
    const bool swept = GetParam().solve == TAUT_DEFORMABLE_SWEPT;
    for (const double share : {swept ? 0.9 : 0.98, swept ? 1.1 : 1.02}) {
        World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const Sheet sheet(kRows, kColumns, kLength, kWidth, 0);
        taut_cloth_def def = torn_def(sheet, GetParam().kind);
        def.solve = GetParam().solve;
        if (swept) def.damping = 0.002f;
        const taut_cloth cloth = add(world, def);
        for (int k = 0; k < kColumns; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
        const std::vector<taut_body> body = bodies_of(cloth);
        Told told;
        size_t vertices = sheet.points.size();
        for (int i = 0; i < 480; ++i) {
            const double load = share * bears * std::min(1.0, i / 300.0);
            for (int k = 0; k < kColumns; ++k) {
                const bool rim = k == 0 || k == kColumns - 1;
                const double part = links ? 1.0 / kColumns : (rim ? 0.5 : 1.0) / (kColumns - 1);
                ok(taut_body_apply_force(body[sheet.at(kRows - 1, k)], Vec(load * part, 0, 0).narrow(), {0, 0, 0}));
            }
            world.step();
            read_tears(world, cloth, vertices, told);
        }
        const std::vector<uint32_t> triangles = triangles_of(cloth);
        ASSERT_EQ(points_of(cloth).size(), vertices);
        ASSERT_EQ(bodies_of(cloth).size(), vertices);
        expect_manifold(triangles, vertices);
        if (share < 1) {
            EXPECT_EQ(told.tears, 0u);
            EXPECT_EQ(triangles, sheet.triangles);
        } else {
            EXPECT_GT(pieces(triangles, vertices), 1u);
            EXPECT_GT(told.least, static_cast<float>(kTear));
        }
        const double mass = totals(bodies_of(cloth)).mass;  // without the pinned row
        EXPECT_LE(mass, 50 * kLength * kWidth * (1 - 0.5 / (kRows - 1)) * (1 + 1e-5));
        taut_cloth of_last{};
        ok(taut_body_get_cloth(bodies_of(cloth).back(), &of_last));
        EXPECT_EQ(of_last.bits, cloth.bits);
    }
}

// ---------------------------------------------------------------- free pieces

// St-Venant-Kirchhoff's energy of the sheet by triangles, which keep their places [J].
double energy_of(const Sheet& sheet, const taut_cloth_def& def, const std::vector<Vec>& x,
                 const std::vector<uint32_t>& triangles) {
    double sum = 0;
    for (size_t t = 0; t < triangles.size(); t += 3) {
        const auto rest = [&](size_t k) { return Vec(sheet.points[sheet.triangles[t + k]]); };
        const Vec r1 = rest(1) - rest(0), r2 = rest(2) - rest(0);
        const Vec d1 = x[triangles[t + 1]] - x[triangles[t]], d2 = x[triangles[t + 2]] - x[triangles[t]];
        const double det = r1.x * r2.z - r2.x * r1.z;
        const Vec fx = 1 / det * (r2.z * d1 - r1.z * d2), fz = 1 / det * (r1.x * d2 - r2.x * d1);
        const double exx = 0.5 * (dot(fx, fx) - 1), ezz = 0.5 * (dot(fz, fz) - 1), exz = dot(fx, fz);
        sum += 0.25 * std::abs(det) *
               (static_cast<double>(def.stretch_stiffness[0]) * exx * exx +
                static_cast<double>(def.stretch_stiffness[1]) * ezz * ezz +
                static_cast<double>(def.shear_stiffness) * exz * exz);
    }
    return sum;
}

// Of links along the edges, but diagonals: what was within the sheet and is at a rim now has half of its stiffness.
double energy_of_links(const Sheet& sheet, const std::vector<Vec>& x, const std::vector<uint32_t>& triangles) {
    using Edge = std::pair<uint32_t, uint32_t>;
    const auto edges = [](const std::vector<uint32_t>& all) {
        std::map<Edge, std::vector<size_t>> out;
        for (size_t i = 0; i < all.size(); ++i) out[std::minmax(all[i], all[i - i % 3 + (i + 1) % 3])].push_back(i);
        return out;
    };
    const auto whole = edges(sheet.triangles);
    double sum = 0;
    for (const auto& [edge, at] : edges(triangles)) {
        const size_t i = at[0];
        const uint32_t a = sheet.triangles[i], b = sheet.triangles[i - i % 3 + (i + 1) % 3];
        const Vec rest = Vec(sheet.points[b]) - Vec(sheet.points[a]);
        if (rest.x != 0 && rest.z != 0) continue;
        const bool torn = whole.at(std::minmax(a, b)).size() > at.size();
        const double c = norm(x[edge.second] - x[edge.first]) - norm(rest);
        sum += 0.5 * (torn ? 0.5 : 1) * kStiffness * c * c;
    }
    return sum;
}

// A sheet flung apart, with nothing about it.
struct Flung {
    Flung(const Case& of, double tear_strain) : world([](taut_world_def& d) { d.gravity = {0, 0, 0}; }) {
        def = torn_def(sheet, of.kind);
        def.solve = of.solve;
        def.area_density = 2;
        def.damping = 0.001f;
        def.shear_compliance = std::numeric_limits<float>::infinity();
        def.tear_strain = static_cast<float>(tear_strain);
        cloth = add(world, def);
        const std::vector<taut_body> body = bodies_of(cloth);
        speed = def.kind == TAUT_CLOTH_LINKS ? 5 : 25;
        for (size_t v = 0; v < body.size(); ++v) {
            const Vec r = Vec(sheet.points[v]) - Vec(0.2, 0, 0.2);
            const Vec u(r.x > 0 ? speed : -speed, 0.5 * r.x, 8 * r.z + 1);
            ok(taut_body_set_velocity(body[v], (u + Vec(3 * r.z, 0, 0)).narrow(), {0, 0, 0}));
        }
        vertices = body.size();
    }
    void step() {
        world.step();
        read_tears(world, cloth, vertices, told);
    }
    Totals sums() const { return totals(bodies_of(cloth)); }
    double energy() const {
        const std::vector<Vec> x = points_of(cloth);
        const std::vector<uint32_t> t = triangles_of(cloth);
        return sums().kinetic +
               (def.kind == TAUT_CLOTH_LINKS ? energy_of_links(sheet, x, t) : energy_of(sheet, def, x, t));
    }

    Sheet sheet{9, 9, 0.4, 0.4, 0};
    World world;
    taut_cloth_def def{};
    taut_cloth cloth{};
    double speed = 0;
    size_t vertices = 0;
    Told told;
};

// At the end of the step in which it tears it has what one has that does not tear.
TEST_P(Torn, TearsKeepMassMomentaAndEnergy) {
    Flung torn(GetParam(), kTear), whole(GetParam(), 0);
    while (torn.told.tears == 0) {
        torn.step();
        whole.step();
        ASSERT_EQ(whole.told.tears, 0u);
    }
    const Totals a = torn.sums(), b = whole.sums();
    ASSERT_GT(torn.vertices, whole.vertices);
    EXPECT_NEAR(a.mass, b.mass, 1e-6 * b.mass);
    EXPECT_LE(norm(a.centre - b.centre), 1e-6);
    EXPECT_LE(norm(a.momentum - b.momentum), 1e-6 * b.mass * torn.speed);
    EXPECT_LE(norm(a.spin - b.spin), 1e-6 * b.mass * torn.speed * 0.4);
    EXPECT_NEAR(torn.energy(), whole.energy(), 1e-6 * whole.energy());
}

// From step to step its energy falls, tears or not; momentum stays.
TEST_P(Torn, PiecesKeepMomentumAndGainNoEnergy) {
    Flung flung(GetParam(), kTear);
    const Totals before = flung.sums();
    const double first = flung.energy();
    double last = first;
    for (int i = 0; i < 120; ++i) {
        flung.step();
        const double now = flung.energy();
        EXPECT_LE(now, last + (flung.def.solve == TAUT_DEFORMABLE_DIRECT ? 1e-5 : 1e-3) * first) << i;
        last = now;
        if (i % 10 != 0) continue;
        const Totals t = flung.sums();
        EXPECT_NEAR(t.mass, before.mass, 1e-6 * before.mass);
        EXPECT_LE(norm(t.momentum - before.momentum), 1e-5 * before.mass * flung.speed);
        ASSERT_NO_FATAL_FAILURE(expect_manifold(triangles_of(flung.cloth), flung.vertices));
    }
    EXPECT_GE(flung.told.tears, 5u);
}

// ---------------------------------------------------------------- state

// A sheet that tears under its own weight about its corners, with tethers, limits and softer compression.
struct Ripping {
    explicit Ripping(uint32_t threads) : world([&](taut_world_def& def) { def.threads = threads; }) {
        taut_cloth_def def = torn_def(sheet, TAUT_CLOTH_LINKS);
        def.area_density = 2;
        def.damping = 0.05f;
        def.shear_compliance = 1e-2f;
        def.compression = 0.5f;
        def.strain_limit = 0.05f;
        def.limit_compliance = 1e-3f;
        def.tethers = 2;
        def.tether_slack = 0.5f;
        def.filter.mask = UINT64_MAX;
        cloth = add(world, def);
        for (const int k : {0, 11}) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
        vertices = sheet.points.size();
    }
    uint64_t hash() const {
        uint64_t out = 0;
        ok(taut_world_get_state_hash(world.handle, &out));
        return out;
    }
    void run(int frames) {
        for (int i = 0; i < frames; ++i) {
            world.step();
            read_tears(world, cloth, vertices, told);
        }
    }

    Sheet sheet{12, 12, 1, 1, 3};
    World world;
    taut_cloth cloth{};
    size_t vertices = 0;
    Told told;
};

TEST(Tearing, IsTheSameOnAnyNumberOfThreads) {
    Ripping one(1);
    one.run(90);
    EXPECT_GE(one.told.tears, 3u);
    for (const uint32_t threads : {2u, 5u}) {
        Ripping many(threads);
        many.run(90);
        EXPECT_EQ(many.hash(), one.hash());
        EXPECT_EQ(triangles_of(many.cloth), triangles_of(one.cloth));
    }
}

TEST(Tearing, GoesOnAfterARestorationAsBefore) {
    Ripping ripping(2);
    while (ripping.told.tears < 2) ripping.run(1);
    uint64_t bytes = 0;
    ok(taut_world_snapshot_size(ripping.world.handle, &bytes));
    std::vector<unsigned char> saved(bytes);
    ok(taut_world_save(ripping.world.handle, saved.data(), bytes, &bytes));
    const std::vector<uint32_t> torn = triangles_of(ripping.cloth);
    const size_t vertices = ripping.vertices;
    ripping.run(40);
    const uint64_t then = ripping.hash();
    const std::vector<uint32_t> after = triangles_of(ripping.cloth);
    EXPECT_NE(after, torn);
    ok(taut_world_restore(ripping.world.handle, saved.data(), bytes));
    EXPECT_EQ(triangles_of(ripping.cloth), torn);
    ripping.vertices = vertices;
    ripping.run(40);
    EXPECT_EQ(ripping.hash(), then);
    EXPECT_EQ(triangles_of(ripping.cloth), after);
}

}  // namespace
