// Cloths and solids: arguments, read-back, handles, pins, removal, memory.
#include <algorithm>
#include <limits>

#include "def_check.h"

using namespace taut_test;

namespace {

// Two triangles on the unit square, and a tetrahedron.
const taut_pos kSquare[] = {{0, 5, 0}, {0, 5, 1}, {1, 5, 0}, {1, 5, 1}};
const uint32_t kTriangles[] = {0, 1, 3, 0, 3, 2};
const taut_pos kTet[] = {{0, 5, 0}, {1, 5, 0}, {0, 6, 0}, {0, 5, 1}};
const uint32_t kCell[] = {0, 1, 2, 3};

taut_cloth_def cloth_def() {
    taut_cloth_def def;
    taut_cloth_def_init(&def);
    def.points = kSquare;
    def.point_count = 4;
    def.triangles = kTriangles;
    def.triangle_count = 2;
    def.user_data = 41;
    return def;
}

taut_solid_def solid_def() {
    taut_solid_def def;
    taut_solid_def_init(&def);
    def.points = kTet;
    def.point_count = 4;
    def.cells = kCell;
    def.cell_count = 1;
    def.user_data = 42;
    return def;
}

struct Deformable : testing::Test {
    Deformable() {
        taut_world_def def;
        taut_world_def_init(&def);
        def.hooks = ledger.hooks();
        EXPECT_OK(taut_world_create(&def, &world));
    }
    ~Deformable() override {
        taut_world_destroy(world);
        EXPECT_TRUE(ledger.empty());
        EXPECT_EQ(ledger.errors, 0u);
    }
    taut_cloth add(const taut_cloth_def& def) const {
        taut_cloth out{};
        EXPECT_OK(taut_world_add_cloth(world, &def, &out));
        return out;
    }
    taut_solid add(const taut_solid_def& def) const {
        taut_solid out{};
        EXPECT_OK(taut_world_add_solid(world, &def, &out));
        return out;
    }
    void refused(const taut_cloth_def& def, taut_result code, const char* text) const {
        taut_cloth out{};
        EXPECT_EQ(taut_world_add_cloth(world, &def, &out), code);
        EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
        expect_empty();
    }
    void refused(const taut_solid_def& def, taut_result code, const char* text) const {
        taut_solid out{};
        EXPECT_EQ(taut_world_add_solid(world, &def, &out), code);
        EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
        expect_empty();
    }
    void expect_empty() const {
        taut_profile profile{};
        profile.struct_size = sizeof profile;
        EXPECT_OK(taut_world_step(world));
        EXPECT_OK(taut_world_get_profile(world, &profile));
        EXPECT_EQ(profile.bodies, 0u);
    }
    static std::vector<taut_body> bodies_of(taut_cloth cloth) {
        std::vector<taut_body> out(4);
        uint32_t count = 0;
        EXPECT_OK(taut_cloth_get_bodies(cloth, out.data(), 4, &count));
        return out;
    }

    Ledger ledger;
    taut_world world{};
};

TEST_F(Deformable, ClothReadsBackWhatItIs) {
    const taut_cloth cloth = add(cloth_def());
    uint64_t data = 0;
    uint32_t count = 0, triangles[6];
    taut_pos points[4];
    taut_vec3 normals[4];
    float strains[2];
    EXPECT_OK(taut_cloth_get_user_data(cloth, &data));
    EXPECT_EQ(data, 41u);
    EXPECT_EQ(taut_cloth_get_points(cloth, points, 3, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 4u);
    EXPECT_OK(taut_cloth_get_points(cloth, points, 4, &count));
    for (int i = 0; i < 4; ++i) EXPECT_EQ(points[i].x, kSquare[i].x);
    EXPECT_OK(taut_cloth_get_triangles(cloth, triangles, 2, &count));
    EXPECT_TRUE(std::ranges::equal(triangles, kTriangles));
    EXPECT_OK(taut_cloth_get_normals(cloth, normals, 4, &count));
    for (const taut_vec3& normal : normals) EXPECT_NEAR(std::abs(normal.y), 1, 1e-6);
    EXPECT_OK(taut_cloth_get_strains(cloth, strains, 2, &count));
    for (const float strain : strains) EXPECT_NEAR(strain, 0, 1e-6);
    taut_cloth of_body{};
    EXPECT_OK(taut_body_get_cloth(bodies_of(cloth)[2], &of_body));
    EXPECT_EQ(of_body.bits, cloth.bits);
}

// A third of each triangle's mass to each corner.
TEST_F(Deformable, MassesAreThoseOfTheRestShape) {
    float sum = 0, mass = 0;
    taut_vec3 centre;
    taut_sym3 inertia;
    for (const taut_body body : bodies_of(add(cloth_def()))) {
        EXPECT_OK(taut_body_get_mass(body, &mass, &centre, &inertia));
        sum += mass;
    }
    EXPECT_NEAR(sum, 0.2, 1e-6);
    taut_body corner[4];
    uint32_t count = 0;
    EXPECT_OK(taut_solid_get_bodies(add(solid_def()), corner, 4, &count));
    EXPECT_OK(taut_body_get_mass(corner[0], &mass, &centre, &inertia));
    EXPECT_NEAR(mass, 1000.0 / 6 / 4, 1e-4);
}

TEST_F(Deformable, PinnedVerticesStayAndMoveAsToldUntilLetGo) {
    const taut_cloth cloth = add(cloth_def());
    const taut_body corner = bodies_of(cloth)[0];
    EXPECT_OK(taut_cloth_pin(cloth, 0, 1));
    EXPECT_EQ(taut_cloth_pin(cloth, 4, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_pin(cloth, 0, 2), TAUT_INVALID_ARGUMENT);
    taut_pose pose{};
    for (int i = 0; i < 60; ++i) EXPECT_OK(taut_world_step(world));
    EXPECT_OK(taut_body_get_pose(corner, &pose));
    EXPECT_EQ(pose.position.y, 5);
    pose.position.y = 5.001;
    EXPECT_OK(taut_body_move_kinematic(corner, &pose));
    EXPECT_OK(taut_world_step(world));
    EXPECT_OK(taut_body_get_pose(corner, &pose));
    EXPECT_NEAR(pose.position.y, 5.001, 1e-9);
    EXPECT_OK(taut_cloth_pin(cloth, 0, 0));
    for (int i = 0; i < 60; ++i) EXPECT_OK(taut_world_step(world));
    EXPECT_OK(taut_body_get_pose(corner, &pose));
    EXPECT_LT(pose.position.y, 4);
}

TEST_F(Deformable, BadMeshesAreRefused) {
    taut_cloth_def cloth = cloth_def();
    const uint32_t beyond[] = {0, 1, 4}, twice[] = {0, 1, 1}, flipped[] = {0, 1, 3, 0, 2, 3}, one[] = {0, 1, 3};
    const uint32_t fan[] = {0, 1, 2, 0, 1, 3, 1, 0, 3};
    cloth.triangle_count = 1;
    cloth.triangles = beyond;
    refused(cloth, TAUT_INVALID_ARGUMENT, "triangles[0][2]");
    cloth.triangles = twice;
    refused(cloth, TAUT_INVALID_ARGUMENT, "names a vertex twice");
    cloth.triangles = one;
    refused(cloth, TAUT_INVALID_ARGUMENT, "vertex 2");
    cloth.triangles = flipped;
    cloth.triangle_count = 2;
    refused(cloth, TAUT_INVALID_ARGUMENT, "same direction");
    cloth.triangles = fan;
    cloth.triangle_count = 3;
    refused(cloth, TAUT_INVALID_ARGUMENT, "triangles");
    cloth = cloth_def();
    const taut_pos line[] = {{0, 5, 0}, {0, 5, 1}, {0, 5, 2}, {0, 5, 3}};
    cloth.points = line;
    refused(cloth, TAUT_INVALID_ARGUMENT, "no area");
    taut_solid_def solid = solid_def();
    const uint32_t inverted[] = {0, 2, 1, 3};
    solid.cells = inverted;
    refused(solid, TAUT_INVALID_ARGUMENT, "cells[0] is flat or inverted");
    solid = solid_def();
    solid.corners = 5;
    refused(solid, TAUT_INVALID_ARGUMENT, "corners");
}

TEST_F(Deformable, BadQuadrilateralsAreRefused) {
    taut_cloth_def def = cloth_def();
    const uint32_t quad[] = {0, 1, 3, 2}, bow[] = {0, 1, 2, 3}, beyond[] = {0, 1, 3, 4};
    def.kind = TAUT_CLOTH_QUADS;
    refused(def, TAUT_INVALID_ARGUMENT, "triangles");
    def.triangles = nullptr, def.triangle_count = 0;
    refused(def, TAUT_INVALID_ARGUMENT, "quad_count");
    def.quad_count = 1;
    refused(def, TAUT_NULL_POINTER, "quads");
    def.quads = beyond;
    refused(def, TAUT_INVALID_ARGUMENT, "quads[0][3]");
    def.quads = bow;
    refused(def, TAUT_INVALID_ARGUMENT, "");
    const taut_pos dart[] = {{0, 5, 0}, {0.2, 5, 0.2}, {1, 5, 0}, {0, 5, 1}};
    const uint32_t dented[] = {3, 1, 2, 0};
    def.points = dart;
    def.quads = dented;
    refused(def, TAUT_INVALID_ARGUMENT, "");
    def.points = kSquare;
    def.quads = quad;
    def.tear_strain = 0.5f;
    refused(def, TAUT_INVALID_ARGUMENT, "tear_strain");
    def.tear_strain = 0;
    def.plane_strain = 1;
    def.stretch_stiffness[1] = 6000;
    refused(def, TAUT_INVALID_ARGUMENT, "plane_strain");
    def.stretch_stiffness[1] = def.stretch_stiffness[0];
    def.poisson_ratio = 0.5f;
    refused(def, TAUT_INVALID_ARGUMENT, "plane_strain");
    def.poisson_ratio = 0.3f;
    def.strain = static_cast<taut_cloth_strain>(2);
    refused(def, TAUT_INVALID_ARGUMENT, "strain");
    def.strain = TAUT_CLOTH_STRAIN_GREEN;
    const taut_cloth cloth = add(def);
    uint32_t triangles[6], count = 0;
    EXPECT_OK(taut_cloth_get_triangles(cloth, triangles, 2, &count));
    EXPECT_EQ(count, 2u);
    EXPECT_TRUE(std::equal(triangles, triangles + 6, kTriangles));
    EXPECT_OK(taut_cloth_remove(cloth));
    taut_cloth_def sheet = cloth_def();
    sheet.quads = quad, sheet.quad_count = 1;
    refused(sheet, TAUT_INVALID_ARGUMENT, "quads");
}

TEST_F(Deformable, BadCloudsAreRefused) {
    taut_solid_def def;
    taut_solid_def_init(&def);
    std::vector<taut_pos> cube;
    for (int i = 0; i < 8; ++i) cube.push_back({0.1 * (i & 1), 5 + 0.1 * (i >> 1 & 1), 0.1 * (i >> 2)});
    def.corners = TAUT_SOLID_MESHLESS;
    def.points = cube.data();
    def.point_count = 7;
    refused(def, TAUT_INVALID_ARGUMENT, "point_count");
    def.point_count = 8;
    def.cells = kCell, def.cell_count = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "cells");
    def.cells = nullptr, def.cell_count = 0;
    const taut_pos samples[] = {{0.05, 5.05, 0.05}, {0.02, 5.02, 0.02}};
    const float volumes[] = {5e-4f, 5e-4f}, empty[] = {5e-4f, 0};
    def.samples = samples;
    def.sample_count = 2;
    refused(def, TAUT_INVALID_ARGUMENT, "sample_volumes");
    def.sample_volumes = empty;
    refused(def, TAUT_INVALID_ARGUMENT, "sample_volumes[1]");
    def.sample_volumes = volumes;
    def.neighbour_radius = 0.04f;
    refused(def, TAUT_INVALID_ARGUMENT, "samples[0] has fewer than four neighbours");
    def.neighbour_radius = 0;
    const uint32_t beyond[] = {0, 1, 8};
    def.triangles = beyond;
    refused(def, TAUT_INVALID_ARGUMENT, "triangles");
    def.triangle_count = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "triangles[0][2]");
    def.triangles = nullptr, def.triangle_count = 0;
    def.air_drag = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "air_drag");
    def.air_drag = 0;
    const std::vector<taut_pos> whole = cube;
    for (taut_pos& p : cube) p.y = 5;
    refused(def, TAUT_INVALID_ARGUMENT, "samples[0]");
    def.samples = nullptr, def.sample_volumes = nullptr, def.sample_count = 0;
    refused(def, TAUT_INVALID_ARGUMENT, "points");
    cube = whole;
    const taut_quat turns[] = {{0, 0, 0, 1}};
    def.points = cube.data();
    def.material = TAUT_SOLID_ORTHOTROPIC;
    def.orthotropic.cells = turns;
    refused(def, TAUT_INVALID_ARGUMENT, "orthotropic.cells");
    def.orthotropic.cells = nullptr;
    const taut_solid solid = add(def);
    uint32_t count = 0;
    EXPECT_EQ(taut_solid_get_stresses(solid, nullptr, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 8u);
    uint32_t none[3];
    EXPECT_OK(taut_solid_get_triangles(solid, none, 1, &count));
    EXPECT_EQ(count, 0u);
    taut_anchor anchor{};
    uint32_t vertex = 9;
    EXPECT_OK(taut_solid_find_anchor(solid, {0.1, 5.1, 0.1}, &anchor, &vertex));
    EXPECT_EQ(vertex, 7u);
    EXPECT_EQ(anchor.count, 1u);
    const float thirds[] = {0.4f, 0.3f, 0.3f};
    EXPECT_EQ(taut_solid_get_anchor(solid, 0, thirds, &anchor), TAUT_INVALID_ARGUMENT);
    EXPECT_OK(taut_world_step(world));
    taut_solid_def mesh = solid_def();
    mesh.samples = samples;
    EXPECT_EQ(taut_world_add_solid(world, &mesh, nullptr), TAUT_NULL_POINTER);
    EXPECT_OK(taut_solid_remove(solid));
    refused(mesh, TAUT_INVALID_ARGUMENT, "samples");
    mesh = solid_def();
    mesh.neighbour_radius = 1;
    refused(mesh, TAUT_INVALID_ARGUMENT, "neighbour_radius");
}

TEST_F(Deformable, BadNumbersAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    taut_cloth_def cloth = cloth_def();
    cloth.area_density = nan;
    refused(cloth, TAUT_INVALID_ARGUMENT, "area_density");
    cloth = cloth_def();
    cloth.stretch_stiffness[1] = 0;
    refused(cloth, TAUT_INVALID_ARGUMENT, "stretch_stiffness[1]");
    const auto bad = [&](const char* field, auto change) {
        taut_cloth_def def = cloth_def();
        change(def);
        refused(def, TAUT_INVALID_ARGUMENT, field);
    };
    bad("compression", [](taut_cloth_def& d) { d.compression = 1.1f; });
    bad("compression", [&](taut_cloth_def& d) { d.compression = nan; });
    bad("compression",
        [](taut_cloth_def& d) { d.kind = TAUT_CLOTH_LINKS, d.compression = 0.5f, d.stretch_compliance[1] = 0; });
    bad("strain_limit", [](taut_cloth_def& d) { d.strain_limit = 0; });
    bad("limit_compliance", [](taut_cloth_def& d) { d.limit_compliance = 0; });
    bad("tethers", [](taut_cloth_def& d) { d.tethers = TAUT_CLOTH_MAX_TETHERS + 1; });
    bad("tether_slack", [](taut_cloth_def& d) { d.tether_slack = -0.1f; });
    bad("tear_strain", [](taut_cloth_def& d) { d.tear_strain = 1e-4f; });
    cloth = cloth_def();
    cloth.filter.group = 3;
    refused(cloth, TAUT_INVALID_ARGUMENT, "filter.group");
    cloth = cloth_def();
    cloth.struct_size = sizeof cloth + 8;
    refused(cloth, TAUT_STRUCT_SIZE, "struct_size");
    cloth = cloth_def();
    cloth.triangles = nullptr;
    refused(cloth, TAUT_NULL_POINTER, "triangles");
    taut_solid_def solid = solid_def();
    solid.poisson_ratio = 0.5f;
    refused(solid, TAUT_INVALID_ARGUMENT, "poisson_ratio");
    solid = solid_def();
    solid.material = TAUT_SOLID_FIXED_COROTATED;
    solid.poisson_ratio = 0;
    refused(solid, TAUT_INVALID_ARGUMENT, "poisson_ratio");
    const auto bad_solid = [&](const char* field, float taut_solid_def::*member, std::initializer_list<float> values) {
        for (const float value : values) {
            taut_solid_def def = solid_def();
            def.*member = value;
            refused(def, TAUT_INVALID_ARGUMENT, field);
        }
    };
    bad_solid("mass_damping", &taut_solid_def::mass_damping, {-1.0f, 2e4f, nan});
    bad_solid("stiffness_damping", &taut_solid_def::stiffness_damping, {-1.0f, 11.0f, nan});
    bad_solid("hardening", &taut_solid_def::hardening, {-1.0f, 2e12f, nan});
    bad("mass_damping", [&](taut_cloth_def& d) { d.mass_damping = nan; });
    bad("stiffness_damping", [](taut_cloth_def& d) { d.stiffness_damping = -1; });
}

TEST_F(Deformable, PartsAreNotRemovedAloneAndGoWithTheWhole) {
    const taut_cloth cloth = add(cloth_def());
    const std::vector<taut_body> bodies = bodies_of(cloth);
    EXPECT_EQ(taut_body_remove(bodies[0]), TAUT_IN_USE);
    taut_ball_joint_def joint;
    taut_ball_joint_def_init(&joint);
    joint.base.body_a = bodies[1];
    joint.base.frame_b.position = kSquare[1];
    taut_joint held{};
    EXPECT_OK(taut_world_add_ball_joint(world, &joint, &held));
    EXPECT_OK(taut_world_step(world));
    EXPECT_OK(taut_cloth_remove(cloth));
    EXPECT_EQ(taut_cloth_is_valid(cloth), 0);
    EXPECT_EQ(taut_body_is_valid(bodies[0]), 0);
    EXPECT_EQ(taut_joint_is_valid(held), 0);
    EXPECT_EQ(taut_cloth_pin(cloth, 0, 1), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_cloth_set_contact_events(cloth, 0), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_cloth_set_pre_solve(cloth, 1), TAUT_STALE_HANDLE);
    expect_empty();
}

// All vertices ask.
TEST_F(Deformable, AskForContactEventsAndPreSolveAsAWhole) {
    const taut_cloth cloth = add(cloth_def());
    const taut_solid solid = add(solid_def());
    EXPECT_OK(taut_cloth_set_contact_events(cloth, TAUT_CONTACT_EVENTS_HIT));
    EXPECT_OK(taut_cloth_set_pre_solve(cloth, 1));
    EXPECT_OK(taut_solid_set_contact_events(solid, TAUT_CONTACT_EVENTS_PERSIST));
    const auto asks = [](taut_body body) {
        taut_collider collider{};
        uint32_t count = 0;
        EXPECT_OK(taut_body_get_colliders(body, &collider, 1, &count));
        taut_collider_def def;
        taut_collider_def_init(&def);
        EXPECT_OK(taut_collider_get_def(collider, &def));
        return std::pair(def.contact_events, def.flags & TAUT_COLLIDER_PRE_SOLVE);
    };
    for (const taut_body body : bodies_of(cloth))
        EXPECT_EQ(asks(body), std::pair(TAUT_CONTACT_EVENTS_HIT, TAUT_COLLIDER_PRE_SOLVE));
    taut_body corner[4];
    uint32_t count = 0;
    EXPECT_OK(taut_solid_get_bodies(solid, corner, 4, &count));
    for (const taut_body body : corner) EXPECT_EQ(asks(body), std::pair(TAUT_CONTACT_EVENTS_PERSIST, 0u));
    EXPECT_EQ(taut_cloth_set_contact_events(cloth, TAUT_CONTACT_EVENTS_ALL + 1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_solid_set_contact_events(solid, 1u << 31), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_set_pre_solve(cloth, 2), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_solid_set_pre_solve(solid, -1), TAUT_INVALID_ARGUMENT);
    for (const taut_body body : bodies_of(cloth))
        EXPECT_EQ(asks(body), std::pair(TAUT_CONTACT_EVENTS_HIT, TAUT_COLLIDER_PRE_SOLVE)) << "changed by a refusal";
}

// Each number of the defs that air and plastic flow take, at its limits and beyond.
TEST_F(Deformable, LoadsAreChecked) {
    taut_cloth_def cloth = cloth_def();
    cloth.air_drag = 100;
    DefCheck(world, "taut_world_add_cloth", taut_world_add_cloth)
        .run(cloth, {FIELD(taut_cloth_def, air_lift, 0, 100), FIELD(taut_cloth_def, air_drag, 0, 100)});
    cloth.air_drag = 1;
    cloth.air_lift = 1.01f;
    taut_cloth out{};
    EXPECT_EQ(taut_world_add_cloth(world, &cloth, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "air_lift is more than air_drag")) << taut_last_error();
    // A tetrahedron's hull is closed.
    const uint32_t hull[] = {1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1};
    cloth = cloth_def();
    cloth.points = kTet;
    cloth.triangles = hull;
    cloth.triangle_count = 4;
    DefCheck(world, "taut_world_add_cloth", taut_world_add_cloth)
        .run(cloth, {FIELD(taut_cloth_def, pressure, -1e7, 1e7)});
    cloth.gas = 1;
    const taut_cloth full = add(cloth);
    float pressure = 1;
    double volume = 0;
    EXPECT_OK(taut_cloth_get_pressure(full, &pressure));
    EXPECT_OK(taut_cloth_get_volume(full, &volume));
    EXPECT_NEAR(pressure, 0, 0.1);
    EXPECT_NEAR(volume, 1.0 / 6, 1e-12);
    EXPECT_OK(taut_cloth_set_pressure(full, 1e5f));
    EXPECT_OK(taut_cloth_get_pressure(full, &pressure));
    EXPECT_NEAR(pressure, 1e5f, 1);
    EXPECT_EQ(taut_cloth_set_pressure(full, -101326), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_set_pressure(full, 1.1e7f), TAUT_INVALID_ARGUMENT);
    taut_solid_def solid = solid_def();
    solid.air_drag = 100;
    DefCheck(world, "taut_world_add_solid", taut_world_add_solid)
        .run(solid,
             {FIELD(taut_solid_def, air_lift, 0, 100), FIELD(taut_solid_def, yield_stress, 1, 1e12, Field::or_infinite),
              FIELD(taut_solid_def, creep, 0, 1e6, Field::or_infinite),
              FIELD(taut_solid_def, plastic_limit, 0, 10, Field::or_infinite)});
    uint32_t count = 0;
    float strain = 1;
    EXPECT_EQ(taut_solid_get_plastic_strains(add(solid), &strain, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 1u);
    EXPECT_OK(taut_solid_get_plastic_strains(add(solid), &strain, 1, &count));
    EXPECT_EQ(strain, 0);
}

TEST_F(Deformable, WindIsOfTheWorld) {
    taut_vec3 wind{1, 1, 1};
    EXPECT_OK(taut_world_get_wind(world, &wind));
    EXPECT_EQ(wind.x, 0);
    EXPECT_OK(taut_world_set_wind(world, {1, -1000, 1000}));
    EXPECT_EQ(taut_world_set_wind(world, {1, -1001, 1000}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_set_wind(world, {std::nanf(""), 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_OK(taut_world_get_wind(world, &wind));
    EXPECT_EQ(wind.y, -1000);
    taut_world_def def;
    EXPECT_OK(taut_world_get_def(world, &def));
    EXPECT_EQ(def.wind.z, 1000);
    taut_world made{};
    taut_world_def_init(&def);
    def.air_density = -1;
    EXPECT_EQ(taut_world_create(&def, &made), TAUT_INVALID_ARGUMENT);
    taut_world_def_init(&def);
    def.wind.x = 1001;
    EXPECT_EQ(taut_world_create(&def, &made), TAUT_INVALID_ARGUMENT);
}

// A handle of the other kind names nothing.
TEST_F(Deformable, ClothsAreNoSolids) {
    const taut_cloth cloth = add(cloth_def());
    EXPECT_EQ(taut_solid_is_valid(taut_solid{cloth.bits}), 0);
    EXPECT_EQ(taut_solid_remove(taut_solid{cloth.bits}), TAUT_STALE_HANDLE);
}

TEST_F(Deformable, FailedAllocationsChangeNothing) {
    for (uint64_t fail = 1;; ++fail) {
        ledger.fail_from = ledger.calls + fail;
        ledger.fail_until = ledger.fail_from + 1;
        const uint64_t failed = ledger.failed;
        taut_cloth cloth{};
        const taut_cloth_def def = cloth_def();
        const taut_result result = taut_world_add_cloth(world, &def, &cloth);
        ledger.fail_from = ledger.fail_until = UINT64_MAX;
        if (ledger.failed == failed) {
            EXPECT_EQ(result, TAUT_OK);
            EXPECT_OK(taut_cloth_remove(cloth));
            return;
        }
        ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << fail;
        expect_empty();
    }
}

// A strip of three rows that is stretched as it is made, beyond what it bears: where memory fails it does not tear, or
// did so in whole.
TEST_F(Deformable, TearsThatFindNoMemoryWait) {
    taut_pos points[9], rest[9];
    uint32_t triangles[24], *t = triangles;
    for (uint32_t i = 0; i < 3; ++i)
        for (uint32_t k = 0; k < 3; ++k) {
            rest[3 * i + k] = {0.1 * i, 5, 0.1 * k};
            points[3 * i + k] = {0.15 * i, 5, 0.1 * k};
            if (i == 2 || k == 2) continue;
            const uint32_t a = 3 * i + k, corner[] = {a, a + 1, a + 4, a, a + 4, a + 3};
            t = std::copy_n(corner, 6, t);
        }
    taut_cloth_def def = cloth_def();
    def.points = points;
    def.rest = rest;
    def.point_count = 9;
    def.triangles = triangles;
    def.triangle_count = 8;
    def.tear_strain = 0.2f;
    def.tethers = 1;
    bool failed_within = false;
    for (uint64_t fail = 1;; ++fail) {
        const taut_cloth cloth = add(def);
        EXPECT_OK(taut_cloth_pin(cloth, 0, 1));
        ledger.fail_from = ledger.calls + fail;
        ledger.fail_until = ledger.fail_from + 1;
        const uint64_t failed = ledger.failed;
        const taut_result result = taut_world_step(world);
        ledger.fail_from = ledger.fail_until = UINT64_MAX;
        taut_events events{};
        uint32_t count = 0, corners[24];
        EXPECT_OK(taut_world_get_events(world, &events));
        EXPECT_EQ(taut_cloth_get_points(cloth, nullptr, 0, &count), TAUT_TOO_SMALL);
        EXPECT_EQ(count, 9 + events.torn_count);
        EXPECT_OK(taut_cloth_get_triangles(cloth, corners, 8, &count));
        EXPECT_EQ(std::ranges::equal(corners, triangles), events.torn_count == 0);
        failed_within = failed_within || (result == TAUT_OK && ledger.failed > failed && events.torn_count == 0);
        if (result == TAUT_OK && ledger.failed == failed) {
            EXPECT_GE(events.torn_count, 1u);
            EXPECT_OK(taut_cloth_remove(cloth));
            EXPECT_TRUE(failed_within);
            return;
        }
        EXPECT_OK(taut_cloth_remove(cloth));
        ASSERT_LT(fail, 2000u);
    }
}

TEST_F(Deformable, PresetsAreTaken) {
    for (uint32_t i = 0; i <= TAUT_FABRIC_LEATHER; ++i) {
        taut_cloth_def def = cloth_def();
        EXPECT_OK(taut_cloth_def_set_fabric(&def, static_cast<taut_fabric>(i)));
        add(def);
    }
    for (uint32_t i = 0; i <= TAUT_SUBSTANCE_WOOD; ++i) {
        taut_solid_def def = solid_def();
        EXPECT_OK(taut_solid_def_set_substance(&def, static_cast<taut_substance>(i)));
        add(def);
    }
    taut_cloth_def def = cloth_def();
    EXPECT_EQ(taut_cloth_def_set_fabric(&def, static_cast<taut_fabric>(9)), TAUT_INVALID_ARGUMENT);
    for (int i = 0; i < 30; ++i) EXPECT_OK(taut_world_step(world));
}

}  // namespace
