// Every def against wrong sizes, null pointers and every float field out of range.
#include <cstring>
#include <utility>

#include "def_check.h"

using namespace taut_test;

namespace {

const double kSizeLo = TAUT_SHAPE_MIN_SIZE, kSizeHi = TAUT_SHAPE_MAX_SIZE;

struct Refusals : testing::Test {
    Populated p;
};

TEST_F(Refusals, Plane) {
    taut_plane_def def;
    taut_plane_def_init(&def);
    DefCheck check(p.world, "taut_world_add_plane", taut_world_add_plane);
    check.run(def, {FIELD3(taut_plane_def, normal, -1e4, 1e4)});
    def.normal = {0, 0, 0};
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "normal");
}

TEST_F(Refusals, Box) {
    taut_box_def def;
    taut_box_def_init(&def);
    DefCheck check(p.world, "taut_world_add_box", taut_world_add_box);
    check.run(def, {FIELD3(taut_box_def, half_extents, kSizeLo, kSizeHi)});
    def.half_extents.y = 0;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "half_extents.y is 0, expected [0.001, 10000]");
}

TEST_F(Refusals, Sphere) {
    taut_sphere_def def;
    taut_sphere_def_init(&def);
    DefCheck check(p.world, "taut_world_add_sphere", taut_world_add_sphere);
    check.run(def, {FIELD(taut_sphere_def, radius, kSizeLo, kSizeHi)});
    for (float radius : {0.0f, -0.0f, -1.0f}) {
        def.radius = radius;
        check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "radius");
    }
}

TEST_F(Refusals, Capsule) {
    taut_capsule_def def;
    taut_capsule_def_init(&def);
    DefCheck check(p.world, "taut_world_add_capsule", taut_world_add_capsule);
    check.run(def, {FIELD(taut_capsule_def, radius, kSizeLo, kSizeHi),
                    FIELD(taut_capsule_def, half_length, kSizeLo, kSizeHi)});
    def.half_length = 0;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "half_length");
}

TEST_F(Refusals, Cylinder) {
    taut_cylinder_def def;
    taut_cylinder_def_init(&def);
    DefCheck check(p.world, "taut_world_add_cylinder", taut_world_add_cylinder);
    check.run(def, {FIELD(taut_cylinder_def, radius, kSizeLo, kSizeHi),
                    FIELD(taut_cylinder_def, half_length, kSizeLo, kSizeHi)});
}

TEST_F(Refusals, Cone) {
    taut_cone_def def;
    taut_cone_def_init(&def);
    DefCheck check(p.world, "taut_world_add_cone", taut_world_add_cone);
    check.run(def,
              {FIELD(taut_cone_def, radius, kSizeLo, kSizeHi), FIELD(taut_cone_def, half_length, kSizeLo, kSizeHi)});
}

TEST_F(Refusals, TaperedCapsule) {
    using Def = taut_tapered_capsule_def;
    Def def;
    taut_tapered_capsule_def_init(&def);
    DefCheck check(p.world, "taut_world_add_tapered_capsule", taut_world_add_tapered_capsule);
    // A limit of one size makes one ball swallow the other.
    check.run(def, {FIELD(Def, bottom_radius, kSizeLo, kSizeHi, Field::unchecked),
                    FIELD(Def, top_radius, kSizeLo, kSizeHi, Field::unchecked),
                    FIELD(Def, half_length, kSizeLo, kSizeHi, Field::unchecked)});
    for (const float half : {0.05f, 0.0499f, 0.002f}) {
        Def bad = def;
        bad.bottom_radius = 0.3f;
        bad.top_radius = 0.2f;
        bad.half_length = half;
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, "one ball is inside the other");
        std::swap(bad.bottom_radius, bad.top_radius);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, "one ball is inside the other");
    }
}

TEST_F(Refusals, ScaledHull) {
    using Def = taut_scaled_hull_def;
    Def def;
    taut_scaled_hull_def_init(&def);
    def.hull = p.hull;
    DefCheck check(p.world, "taut_world_add_scaled_hull", taut_world_add_scaled_hull);
    check.run(def, {FIELD3(Def, scale, 1e-3, 1e3, Field::unchecked)});
    const auto refuse = [&](taut_result code, const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, code, word);
    };
    refuse(TAUT_INVALID_ARGUMENT, "reserved", [](Def& d) { d.reserved = 1; });
    refuse(TAUT_INVALID_ARGUMENT, "scale.y is 0", [](Def& d) { d.scale.y = 0; });
    refuse(TAUT_INVALID_ARGUMENT, "scale.x", [](Def& d) { d.scale.x = -2e3f; });
    refuse(TAUT_INVALID_ARGUMENT, "another kind", [&](Def& d) { d.hull = p.box; });
    refuse(TAUT_INVALID_ARGUMENT, "thinner", [](Def& d) { d.scale.z = 1e-3f; });
    refuse(TAUT_STALE_HANDLE, "hull", [](Def& d) { d.hull = {0}; });
}

TEST_F(Refusals, Hull) {
    taut_vec3 points[6] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}};
    taut_hull_def def;
    taut_hull_def_init(&def);
    def.points = points;
    def.point_count = 6;
    DefCheck check(p.world, "taut_world_add_hull", taut_world_add_hull);
    check.run(def, {});
    for (float bad : {NAN, INFINITY, -INFINITY, 1.1e4f, -1.1e4f}) {
        for (float* at : {&points[0].x, &points[2].y, &points[5].z}) {
            const float kept = std::exchange(*at, bad);
            check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "points");
            *at = kept;
        }
    }
    for (uint32_t count : {0u, 1u, 3u}) {
        def.point_count = count;
        check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "point_count");
    }
    def.point_count = 6;
    def.points = nullptr;
    check.expect_refused(&def, TAUT_NULL_POINTER, "points");
    def.points = points;
    for (taut_vec3& point : points) point.z = 0;  // in one plane
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "points");
    for (taut_vec3& point : points) point = {1, 2, 3};
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "points");
}

TEST_F(Refusals, Body) {
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0, 20, 0);
    DefCheck check(p.world, "taut_world_add_body", taut_world_add_body);
    using Def = taut_body_def;
    check.run(def, {
                       // limits of a component are beyond the limit of the length if another is not zero
                       FIELD(Def, position.x, -1e7, 1e7, Field::unchecked),
                       FIELD(Def, position.y, -1e7, 1e7),
                       FIELD(Def, position.z, -1e7, 1e7, Field::unchecked),
                       FIELD(Def, rotation.x, -1, 1, Field::unchecked),
                       FIELD(Def, rotation.y, -1, 1, Field::unchecked),
                       FIELD(Def, rotation.z, -1, 1, Field::unchecked),
                       FIELD(Def, rotation.w, -1, 1, Field::unchecked),
                       FIELD3(Def, linear_velocity, -1e4, 1e4),
                       FIELD3(Def, angular_velocity, -1e4, 1e4),
                       FIELD(Def, material.friction, 0, 100),
                       FIELD(Def, material.restitution, 0, 1),
                       FIELD(Def, material.rolling_friction, 0, 1000),
                       FIELD(Def, material.spinning_friction, 0, 1000),
                       FIELD(Def, density, 0, 1e8, Field::open_below),
                       FIELD(Def, mass, 1e-6, 1e15),
                       FIELD3(Def, centre_of_mass, -1e4, 1e4),
                       FIELD(Def, inertia.xx, 0, 0, Field::unchecked),
                       FIELD(Def, inertia.yy, 0, 0, Field::unchecked),
                       FIELD(Def, inertia.zz, 0, 0, Field::unchecked),
                       FIELD(Def, inertia.xy, 0, 0, Field::unchecked),
                       FIELD(Def, inertia.xz, 0, 0, Field::unchecked),
                       FIELD(Def, inertia.yz, 0, 0, Field::unchecked),
                       FIELD(Def, gravity_scale, -1000, 1000),
                       FIELD(Def, linear_damping, 0, 1e6),
                       FIELD(Def, angular_damping, 0, 1e6),
                       FIELD(Def, max_linear_speed, 0, 1e6),
                       FIELD(Def, max_angular_speed, 0, 1e6),
                   });
    const auto refuse = [&](const char* word, auto change) {
        Def bad = def;
        change(bad);
        check.expect_refused(&bad, TAUT_INVALID_ARGUMENT, word);
    };
    refuse("density is -1, expected (0, 1e+08]", [](Def& d) { d.density = -1; });
    refuse("mass is -1, expected 0 or [1e-06, 1e+15]", [](Def& d) { d.mass = -1; });
    refuse("position has length", [](Def& d) { d.position = {8e6, 8e6, 0}; });
    refuse("linear_velocity has length", [](Def& d) { d.linear_velocity = {8e3f, 0, 8e3f}; });
    refuse("rotation has length", [](Def& d) { d.rotation = {0, 0, 0, 0}; });
    refuse("rotation has length", [](Def& d) { d.rotation = {0, 0, 0, 0.998f}; });
    refuse("kind", [](Def& d) { d.kind = TAUT_BODY_PARTICLE; });
    refuse("kind", [](Def& d) { d.kind = TAUT_BODY_KIND_MAX; });
    refuse("filter.reserved", [](Def& d) { d.filter.reserved = 1; });
    refuse("linear_velocity", [](Def& d) { d.kind = TAUT_BODY_STATIC, d.linear_velocity.x = 1; });
    refuse("angular_velocity", [](Def& d) { d.kind = TAUT_BODY_STATIC, d.angular_velocity.z = 1; });
    refuse("shape is a plane", [&](Def& d) { d.shape = p.plane; });
    refuse("mass is 0", [](Def& d) { d.shape = {0}; });
    refuse("inertia is 0", [](Def& d) { d.shape = {0}, d.mass = 1; });
    refuse("mass is 0", [](Def& d) { d.shape = {0}, d.inertia = {1, 1, 1, 0, 0, 0}; });
    refuse("mass from shapes and densities", [](Def& d) { d.density = 1e-30f; });
    refuse("positive definite", [](Def& d) { d.inertia = {1, 1, -1, 0, 0, 0}; });
    refuse("positive definite", [](Def& d) { d.inertia = {1, 1, 0, 0, 0, 0}; });
    refuse("positive definite", [](Def& d) { d.inertia = {1, 1, 1, 1, 0, 0}; });
    refuse("positive definite", [](Def& d) { d.inertia = {0, 0, 0, 1, 0, 0}; });
    refuse("positive definite", [](Def& d) { d.inertia = {1, 1, 1, 0.9f, 0.9f, -0.9f}; });
}

TEST_F(Refusals, Particle) {
    taut_particle_def def;
    taut_particle_def_init(&def);
    DefCheck check(p.world, "taut_world_add_particle", taut_world_add_particle);
    using Def = taut_particle_def;
    check.run(def,
              {FIELD(Def, mass, 1e-9, 1e21), FIELD3(Def, position, -1e7, 1e7), FIELD3(Def, velocity, -1e4, 1e4),
               FIELD(Def, gravity_scale, -1000, 1000), FIELD(Def, damping, 0, 1e6), FIELD(Def, max_speed, 0, 1e6)});
    def.mass = 0;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "mass is 0");
}

TEST(WorldDef, RefusesWhatItDoesNotState) {
    taut_world_def good;
    taut_world_def_init(&good);
    using Def = taut_world_def;
    const auto create = [](const Def* def, taut_result code, const char* word) {
        taut_world out = {0x1234};
        EXPECT_EQ(taut_world_create(def, &out), code) << word << ": " << taut_last_error();
        if (code == TAUT_OK) {
            EXPECT_OK(taut_world_step(out));
            EXPECT_OK(taut_world_destroy(out));
            return;
        }
        EXPECT_EQ(out.bits, 0x1234u);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_create: ")) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
    };
    const auto changed = [&](taut_result code, const char* word, auto change) {
        Def def = good;
        change(def);
        create(&def, code, word);
    };
    create(nullptr, TAUT_NULL_POINTER, "def");
    EXPECT_EQ(taut_world_create(&good, nullptr), TAUT_NULL_POINTER);
    for (uint32_t size : {0u, good.struct_size - 1, good.struct_size + 1}) {
        changed(TAUT_STRUCT_SIZE, "struct_size", [&](Def& d) { d.struct_size = size; });
    }

    const Field fields[] = {FIELD3(Def, gravity, -1e4, 1e4),   FIELD(Def, time_step, 1e-4, 0.1),
                            FIELD(Def, velocity_filter, 0, 1), FIELD(Def, sleep_speed, 0, 10),
                            FIELD(Def, sleep_time, 0, 1e3),    FIELD(Def, restitution_threshold, 0, 1e4),
                            FIELD(Def, stabilisation, 0, 1),   FIELD(Def, relaxation, 0.001, 1.999)};
    for (const Field& field : fields) {
        for (double value : {std::nan(""), HUGE_VAL, -HUGE_VAL, below(field, field.lo), above(field, field.hi)}) {
            const Def def = with(good, field, value);
            create(&def, TAUT_INVALID_ARGUMENT, field.name);
        }
        for (double value : {field.lo, field.hi}) {
            const Def def = with(good, field, value);
            create(&def, TAUT_OK, field.name);
        }
    }

    const struct {
        const char* name;
        uint32_t Def::*field;
        uint32_t lo, hi;
    } counts[] = {
        {"substeps", &Def::substeps, 1, 64},
        {"fixed_substeps", &Def::fixed_substeps, 0, 1},
        {"sweeps", &Def::sweeps, 0, 1000},
        {"geometric_stiffness", &Def::geometric_stiffness, 0, 1},
        {"max_catch_up", &Def::max_catch_up, 1, 1000},
        {"threads", &Def::threads, 1, 64},
        {"sleeping", &Def::sleeping, 0, 1},
        {"continuous", &Def::continuous, 0, 1},
        {"adaptive_damping", &Def::adaptive_damping, 0, 1},
        {"fixed_step", &Def::fixed_step, 0, 1},
        {"report", &Def::report, 0, 1},
    };
    for (const auto& count : counts) {
        changed(TAUT_INVALID_ARGUMENT, count.name, [&](Def& d) { d.*count.field = count.lo - 1; });
        changed(TAUT_INVALID_ARGUMENT, count.name, [&](Def& d) { d.*count.field = count.hi + 1; });
        changed(TAUT_OK, count.name, [&](Def& d) { d.*count.field = count.lo; });
        changed(TAUT_OK, count.name, [&](Def& d) { d.*count.field = count.hi; });
    }
    changed(TAUT_INVALID_ARGUMENT, "solver", [](Def& d) { d.solver = TAUT_SOLVER_MAX; });
    changed(TAUT_OK, "solver", [](Def& d) { d.solver = TAUT_SOLVER_MINIMISATION; });
    changed(TAUT_OK, "scheme", [](Def& d) {
        d.solver = TAUT_SOLVER_MINIMISATION;
        d.scheme = TAUT_SCHEME_BDF2;
    });
    changed(TAUT_INVALID_ARGUMENT, "minimise_tolerance", [](Def& d) { d.minimise_tolerance = 0; });
    changed(TAUT_INVALID_ARGUMENT, "minimise_tolerance", [](Def& d) { d.minimise_tolerance = NAN; });
    changed(TAUT_OK, "minimise_tolerance", [](Def& d) { d.minimise_tolerance = 1; });
    changed(TAUT_INVALID_ARGUMENT, "line_search", [](Def& d) { d.line_search = 2; });
    changed(TAUT_OK, "line_search", [](Def& d) { d.line_search = 0; });
    changed(TAUT_INVALID_ARGUMENT, "stepping", [](Def& d) { d.stepping = TAUT_STEPPING_MAX; });
    changed(TAUT_OK, "stepping", [](Def& d) { d.stepping = TAUT_STEPPING_VELOCITY; });
    const auto by_rows = [](Def& d) { d.solver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL; };
    for (const taut_stepping stepping :
         {TAUT_STEPPING_LINKS_FIRST, TAUT_STEPPING_VELOCITY_FIRST, TAUT_STEPPING_POST_STABILISED}) {
        changed(TAUT_UNSUPPORTED, "stepping", [&](Def& d) { d.stepping = stepping; });
        changed(TAUT_OK, "stepping", [&](Def& d) { by_rows(d), d.stepping = stepping; });
    }
    changed(TAUT_UNSUPPORTED, "scheme",
            [&](Def& d) { by_rows(d), d.stepping = TAUT_STEPPING_POST_STABILISED, d.scheme = TAUT_SCHEME_NEWMARK; });
    changed(TAUT_UNSUPPORTED, "stepping", [](Def& d) {
        d.solver = TAUT_SOLVER_CONJUGATE_GRADIENTS;
        d.stepping = TAUT_STEPPING_POST_STABILISED;
    });
    changed(TAUT_UNSUPPORTED, "velocity_gain",
            [&](Def& d) { by_rows(d), d.stepping = TAUT_STEPPING_POST_STABILISED, d.velocity_gain = 0; });
    for (float Def::*gain : {&Def::contact_stabilisation, &Def::velocity_gain}) {
        const char* name = gain == &Def::velocity_gain ? "velocity_gain" : "contact_stabilisation";
        changed(TAUT_UNSUPPORTED, name, [&](Def& d) { d.*gain = 0.5f; });
        for (const float value : {-0.01f, 1.01f, NAN, INFINITY})
            changed(TAUT_INVALID_ARGUMENT, name, [&](Def& d) { by_rows(d), d.*gain = value; });
        for (const float value : {0.0f, 1.0f}) changed(TAUT_OK, name, [&](Def& d) { by_rows(d), d.*gain = value; });
    }
    changed(TAUT_INVALID_ARGUMENT, "friction_model", [](Def& d) { d.friction_model = TAUT_FRICTION_MAX; });
    changed(TAUT_OK, "friction_model", [](Def& d) { d.friction_model = TAUT_FRICTION_BOX; });
    changed(TAUT_INVALID_ARGUMENT, "momentum", [](Def& d) { d.momentum = TAUT_MOMENTUM_MAX; });
    changed(TAUT_OK, "momentum", [](Def& d) { d.momentum = TAUT_MOMENTUM_POWER; });

    Ledger ledger;
    changed(TAUT_INVALID_ARGUMENT, "hooks.allocate", [&](Def& d) { d.hooks.allocate = ledger.hooks().allocate; });
    changed(TAUT_INVALID_ARGUMENT, "hooks.free", [&](Def& d) { d.hooks.free = ledger.hooks().free; });
    changed(TAUT_INVALID_ARGUMENT, "hooks.enqueue_task", [](Def& d) {
        d.hooks.enqueue_task = [](taut_task_fn, uint32_t, uint32_t, void*, void*) -> void* { return nullptr; };
    });
    changed(TAUT_INVALID_ARGUMENT, "hooks.finish_task", [](Def& d) { d.hooks.finish_task = [](void*, void*) {}; });
    changed(TAUT_INVALID_ARGUMENT, "hooks.worker_count", [](Def& d) { d.hooks.worker_count = 4; });
    changed(TAUT_INVALID_ARGUMENT, "hooks.reserved", [](Def& d) { d.hooks.reserved = 1; });
    const auto with_tasks = [](Def& d) {
        d.hooks.enqueue_task = [](taut_task_fn, uint32_t, uint32_t, void*, void*) -> void* { return nullptr; };
        d.hooks.finish_task = [](void*, void*) {};
        d.hooks.worker_count = 63;
    };
    changed(TAUT_OK, "hooks.worker_count", with_tasks);
    changed(TAUT_INVALID_ARGUMENT, "hooks.worker_count", [&](Def& d) { with_tasks(d), d.hooks.worker_count = 64; });
    changed(TAUT_INVALID_ARGUMENT, "threads", [&](Def& d) { with_tasks(d), d.threads = 2; });
    EXPECT_TRUE(ledger.empty());
}

TEST(Init, TakesNullAndWritesSizes) {
    taut_world_def_init(nullptr);
    taut_body_def_init(nullptr);
    taut_particle_def_init(nullptr);
    taut_plane_def_init(nullptr);
    taut_box_def_init(nullptr);
    taut_sphere_def_init(nullptr);
    taut_capsule_def_init(nullptr);
    taut_hull_def_init(nullptr);
    taut_cylinder_def_init(nullptr);
    taut_cone_def_init(nullptr);
    taut_tapered_capsule_def_init(nullptr);
    taut_scaled_hull_def_init(nullptr);

    taut_world_def world;
    std::memset(&world, 0xff, sizeof world);
    taut_world_def_init(&world);
    EXPECT_EQ(world.struct_size, sizeof world);
    EXPECT_EQ(world.gravity.y, -9.81f);
    EXPECT_EQ(world.hooks.allocate, nullptr);
    taut_body_def body;
    std::memset(&body, 0xff, sizeof body);
    taut_body_def_init(&body);
    EXPECT_EQ(body.struct_size, sizeof body);
    EXPECT_EQ(body.filter.mask, UINT64_MAX);
    EXPECT_EQ(body.shape.bits, 0u);
}

}  // namespace
