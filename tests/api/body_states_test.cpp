// Many bodies read at once, and the def read back.
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

bool same(const taut_vec3& a, const taut_vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool same(const taut_pose& a, const taut_pose& b) {
    const taut_pos &p = a.position, &q = b.position;
    const taut_quat &r = a.rotation, &s = b.rotation;
    return p.x == q.x && p.y == q.y && p.z == q.z && r.x == s.x && r.y == s.y && r.z == s.z && r.w == s.w;
}

TEST(BodyStates, AreThoseOfTheBodies) {
    Populated p;
    ASSERT_OK(taut_body_set_velocity(p.wedge, {1, 2, 3}, {0.5f, 0, 0}));
    const taut_body bodies[] = {p.bob, p.ground, p.wedge, p.wedge, p.crate};
    struct Drawn {  // as a host may keep them
        uint64_t mine;
        taut_pose pose;
        taut_vec3 angular;
        uint32_t more;
    };
    std::vector<Drawn> drawn(5, Drawn{7, {}, {}, 7});
    taut_vec3 linear[5];
    ASSERT_OK(taut_world_get_body_states(p.world, bodies, 5, &drawn[0].pose, sizeof(Drawn), linear, 0,
                                         &drawn[0].angular, sizeof(Drawn)));
    for (int i = 0; i < 5; ++i) {
        taut_pose pose;
        taut_vec3 v, w;
        ASSERT_OK(taut_body_get_pose(bodies[i], &pose));
        ASSERT_OK(taut_body_get_velocity(bodies[i], &v, &w));
        EXPECT_TRUE(same(pose, drawn[i].pose)) << i;
        EXPECT_TRUE(same(v, linear[i])) << i;
        EXPECT_TRUE(same(w, drawn[i].angular)) << i;
        EXPECT_EQ(drawn[i].mine, 7u);
        EXPECT_EQ(drawn[i].more, 7u);
    }
    EXPECT_OK(taut_world_get_body_states(p.world, bodies, 5, nullptr, 0, nullptr, 0, nullptr, 0));
    EXPECT_OK(taut_world_get_body_states(p.world, nullptr, 0, nullptr, 0, linear, 0, nullptr, 0));
}

TEST(BodyStates, RefuseAndWriteNothing) {
    Populated p, other;
    taut_pose poses[3] = {};
    poses[0].position.x = 99;
    const auto call = [&](taut_body third, size_t stride, taut_result code, const char* word) {
        const taut_body bodies[] = {p.crate, p.wedge, third};
        EXPECT_EQ(taut_world_get_body_states(p.world, bodies, 3, poses, stride, nullptr, 0, nullptr, 0), code) << word;
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(poses[0].position.x, 99);
    };
    call({0}, 0, TAUT_STALE_HANDLE, "bodies[2]");
    call(other.crate, 0, TAUT_FOREIGN_HANDLE, "bodies[2]");
    ASSERT_OK(taut_body_remove(p.bob));
    call(p.bob, 0, TAUT_STALE_HANDLE, "bodies[2]");
    call(p.crate, 47, TAUT_INVALID_ARGUMENT, "pose_stride");
    call(p.crate, 8, TAUT_INVALID_ARGUMENT, "pose_stride");
    EXPECT_EQ(taut_world_get_body_states(p.world, nullptr, 3, poses, 0, nullptr, 0, nullptr, 0), TAUT_NULL_POINTER);
    taut_vec3 v[3];
    const taut_body bodies[] = {p.crate, p.wedge, p.lift};
    EXPECT_EQ(taut_world_get_body_states(p.world, bodies, 3, nullptr, 0, v, 14, nullptr, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_get_body_states(p.world, bodies, 3, nullptr, 0, nullptr, 0, v, 4), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "angular_stride")) << taut_last_error();
}

TEST(World, TellsItsDef) {
    taut_world_def def, read;
    taut_world_def_init(&def);
    def.substeps = 7;
    def.time_step = 0.01f;
    def.solver = TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL;
    taut_world world;
    ASSERT_OK(taut_world_create(&def, &world));
    ASSERT_OK(taut_world_set_gravity(world, {1, 2, 3}));
    ASSERT_OK(taut_world_get_def(world, &read));
    EXPECT_EQ(read.struct_size, sizeof read);
    EXPECT_EQ(read.substeps, 7u);
    EXPECT_EQ(read.time_step, 0.01f);
    EXPECT_EQ(read.solver, def.solver);
    EXPECT_EQ(read.gravity.y, 2);
    EXPECT_EQ(taut_world_get_def(world, nullptr), TAUT_NULL_POINTER);
    taut_world twin;  // what is read makes a world like it
    ASSERT_OK(taut_world_create(&read, &twin));
    EXPECT_OK(taut_world_destroy(twin));
    EXPECT_OK(taut_world_destroy(world));
}

}  // namespace
