// What the tests of the interface share: an allocator that keeps books and fails on demand, a world with one of
// everything, and the check that a refused call changed nothing.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <initializer_list>
#include <string>
#include <unordered_map>
#include <vector>

#include <taut/taut.h>

#include "aligned_memory.h"

#define ASSERT_OK(call) ASSERT_EQ(call, TAUT_OK) << taut_last_error()
#define EXPECT_OK(call) EXPECT_EQ(call, TAUT_OK) << taut_last_error()

namespace taut_test {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Keeps every live block with its size and alignment; single-threaded.
class Ledger {
public:
    taut_hooks hooks() {
        taut_hooks out = {};
        out.allocate = [](size_t size, size_t alignment, void* self) {
            return static_cast<Ledger*>(self)->allocate(size, alignment);
        };
        out.free = [](void* pointer, size_t size, size_t alignment, void* self) {
            static_cast<Ledger*>(self)->release(pointer, size, alignment);
        };
        out.memory_user_data = this;
        return out;
    }

    uint64_t bytes = 0;   // live now
    uint64_t calls = 0;   // of allocate
    uint64_t errors = 0;  // of whoever allocates: bad sizes and alignments, blocks that are not his
    uint64_t fail_from = UINT64_MAX, fail_until = UINT64_MAX;  // numbers of calls that return null
    uint64_t failed = 0;
    std::function<void()> on_allocate;

    bool empty() const { return blocks_.empty() && bytes == 0; }

private:
    struct Block {
        size_t size, alignment;
    };

    void* allocate(size_t size, size_t alignment) {
        ++calls;
        if (size == 0 || alignment == 0 || alignment > 64 || (alignment & (alignment - 1)) != 0) ++errors;
        if (on_allocate) on_allocate();
        if (calls >= fail_from && calls < fail_until) {
            ++failed;
            return nullptr;
        }
        void* pointer = allocate_aligned(size, alignment);
        blocks_[pointer] = {size, alignment};
        bytes += size;
        return pointer;
    }
    void release(void* pointer, size_t size, size_t alignment) {
        const auto block = blocks_.find(pointer);
        if (block == blocks_.end() || block->second.size != size || block->second.alignment != alignment) {
            ++errors;
            return;
        }
        bytes -= size;
        blocks_.erase(block);
        free_aligned(pointer);
    }

    std::unordered_map<void*, Block> blocks_;
};

inline taut_world make_world(const taut_hooks& hooks = {}) {
    taut_world_def def;
    taut_world_def_init(&def);
    def.hooks = hooks;
    taut_world world = {0};
    EXPECT_EQ(taut_world_create(&def, &world), TAUT_OK) << taut_last_error();
    return world;
}

inline uint64_t hash_of(taut_world world) {
    uint64_t hash = 0;
    EXPECT_EQ(taut_world_get_state_hash(world, &hash), TAUT_OK) << taut_last_error();
    return hash;
}

// Where bodies are and how they move: what a step that fails leaves as it was, though it may have foreseen boxes.
inline std::vector<double> motion_of(std::initializer_list<taut_body> bodies) {
    std::vector<double> out;
    for (const taut_body body : bodies) {
        taut_pose pose;
        taut_vec3 v, w;
        EXPECT_EQ(taut_body_get_pose(body, &pose), TAUT_OK) << taut_last_error();
        EXPECT_EQ(taut_body_get_velocity(body, &v, &w), TAUT_OK) << taut_last_error();
        const taut_pos& x = pose.position;
        const taut_quat& q = pose.rotation;
        for (const double number : {x.x, x.y, x.z}) out.push_back(number);
        for (const float number : {q.x, q.y, q.z, q.w, v.x, v.y, v.z, w.x, w.y, w.z})
            out.push_back(static_cast<double>(number));
    }
    return out;
}

// Of the steps since they were read last.
inline taut_events events_of(taut_world world) {
    taut_events out;
    EXPECT_OK(taut_world_get_events(world, &out));
    return out;
}

inline std::vector<unsigned char> save(taut_world world) {
    uint64_t size = 0, written = 0;
    EXPECT_OK(taut_world_snapshot_size(world, &size));
    std::vector<unsigned char> bytes(size);
    EXPECT_OK(taut_world_save(world, bytes.data(), size, &written));
    EXPECT_EQ(written, size);
    return bytes;
}
inline taut_result restore(taut_world world, const std::vector<unsigned char>& bytes) {
    return taut_world_restore(world, bytes.data(), bytes.size());
}

struct Counts {
    uint32_t bodies = 0, shapes = 0, joints = 0;
    bool operator==(const Counts&) const = default;
};

inline Counts counts_of(taut_world world) {
    Counts out;
    EXPECT_EQ(taut_world_get_counts(world, &out.bodies, &out.shapes, &out.joints), TAUT_OK) << taut_last_error();
    return out;
}

// Takes the state of a world; later, what must not have changed.
class Watch {
public:
    explicit Watch(taut_world world) : world_(world), hash_(hash_of(world)), counts_(counts_of(world)) {}
    bool unchanged() const { return hash_of(world_) == hash_ && counts_of(world_) == counts_; }

private:
    taut_world world_;
    uint64_t hash_;
    Counts counts_;
};

inline taut_body_def body_def(taut_body_kind kind, taut_shape shape, double x = 0, double y = 0, double z = 0) {
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = kind;
    def.shape = shape;
    def.position = {x, y, z};
    return def;
}

inline taut_body add_body(taut_world world, const taut_body_def& def) {
    taut_body body = {0};
    EXPECT_EQ(taut_world_add_body(world, &def, &body), TAUT_OK) << taut_last_error();
    return body;
}

inline taut_body add_particle(taut_world world, double x, double y, double z) {
    taut_particle_def def;
    taut_particle_def_init(&def);
    def.position = {x, y, z};
    taut_body body = {0};
    EXPECT_EQ(taut_world_add_particle(world, &def, &body), TAUT_OK) << taut_last_error();
    return body;
}

inline taut_shape add_box(taut_world world, float half = 0.5f) {
    taut_box_def def;
    taut_box_def_init(&def);
    def.half_extents = {half, half, half};
    taut_shape shape = {0};
    EXPECT_EQ(taut_world_add_box(world, &def, &shape), TAUT_OK) << taut_last_error();
    return shape;
}

inline taut_shape add_plane(taut_world world) {
    taut_plane_def def;
    taut_plane_def_init(&def);
    taut_shape shape = {0};
    EXPECT_EQ(taut_world_add_plane(world, &def, &shape), TAUT_OK) << taut_last_error();
    return shape;
}

// A tetrahedron on three axes of this length.
inline taut_shape add_hull(taut_world world, float length = 1) {
    const taut_vec3 points[] = {{0, 0, 0}, {length, 0, 0}, {0, length, 0}, {0, 0, length}};
    taut_hull_def def;
    taut_hull_def_init(&def);
    def.points = points;
    def.point_count = 4;
    taut_shape shape = {0};
    EXPECT_EQ(taut_world_add_hull(world, &def, &shape), TAUT_OK) << taut_last_error();
    return shape;
}

// Of arrays that outlive it.
template <size_t Vertices, size_t Indices>
taut_mesh_def mesh_def(const taut_vec3 (&vertices)[Vertices], const uint32_t (&indices)[Indices]) {
    taut_mesh_def def;
    taut_mesh_def_init(&def);
    def.vertices = vertices;
    def.vertex_count = Vertices;
    def.indices = indices;
    def.triangle_count = Indices / 3;
    return def;
}

// Two triangles, one unit square.
inline taut_result make_mesh(taut_world world, taut_shape* out) {
    const taut_vec3 vertices[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    const taut_mesh_def def = mesh_def(vertices, indices);
    return taut_world_add_mesh(world, &def, out);
}

// The same square with a hole in one corner.
inline taut_result make_height_field(taut_world world, taut_shape* out) {
    static const float heights[] = {0, 0, 0, NAN};
    taut_height_field_def def;
    taut_height_field_def_init(&def);
    def.heights = heights;
    def.rows = def.columns = 2;
    return taut_world_add_height_field(world, &def, out);
}

// Of a joint between two anchors, with defaults otherwise.
template <class Def>
taut_joint add_anchored(void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*), taut_world world,
                        taut_body a, taut_body b, taut_pos anchor_a, taut_pos anchor_b) {
    Def def;
    init(&def);
    def.base.body_a = a;
    def.base.body_b = b;
    def.base.frame_a.position = anchor_a;
    def.base.frame_b.position = anchor_b;
    taut_joint joint = {0};
    EXPECT_EQ(add(world, &def, &joint), TAUT_OK) << taut_last_error();
    return joint;
}
inline taut_joint add_ball(taut_world world, taut_body a, taut_body b, taut_pos anchor_a = {}, taut_pos anchor_b = {}) {
    return add_anchored(taut_ball_joint_def_init, taut_world_add_ball_joint, world, a, b, anchor_a, anchor_b);
}
inline taut_joint add_rod(taut_world world, taut_body a, taut_body b, taut_pos anchor_a = {}, taut_pos anchor_b = {}) {
    return add_anchored(taut_distance_joint_def_init, taut_world_add_distance_joint, world, a, b, anchor_a, anchor_b);
}

inline taut_pose at(double x, double y, double z, taut_quat q = {0, 0, 0, 1}) { return {{x, y, z}, q, {0, 0}}; }
inline taut_result set_pose(taut_body body, const taut_pose& pose) { return taut_body_set_pose(body, &pose); }
inline taut_result move_to(taut_body body, const taut_pose& pose) { return taut_body_move_kinematic(body, &pose); }

struct Mass {
    float mass;
    taut_vec3 centre;
    taut_sym3 inertia;
};

inline Mass mass_of(taut_body body) {
    Mass out{};
    EXPECT_OK(taut_body_get_mass(body, &out.mass, &out.centre, &out.inertia));
    return out;
}

// A world with one of everything, a box at rest on a plane and a pendulum; destroyed with the object.
struct Populated {
    explicit Populated(const taut_hooks& hooks = {}) : world(make_world(hooks)) {
        plane = add_plane(world);
        box = add_box(world);
        hull = add_hull(world);
        ground = add_body(world, body_def(TAUT_BODY_STATIC, plane));
        crate = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 0.5, 0));
        lift = add_body(world, body_def(TAUT_BODY_KINEMATIC, box, 5, 3, 0));
        wedge = add_body(world, body_def(TAUT_BODY_DYNAMIC, hull, -5, 4, 0));
        bob = add_particle(world, 10, 5, 0);
        ball = add_ball(world, wedge, {0}, {0, 0, 0}, {-5, 4, 0});
        rod = add_rod(world, bob, {0}, {0, 0, 0}, {12, 5, 0});
        uint32_t count = 0;
        EXPECT_EQ(taut_body_get_colliders(crate, &collider, 1, &count), TAUT_OK) << taut_last_error();
        for (int i = 0; i < 3; ++i) EXPECT_EQ(taut_world_step(world), TAUT_OK) << taut_last_error();
        saved = save(world);
    }
    ~Populated() { taut_world_destroy(world); }
    Populated(const Populated&) = delete;
    Populated& operator=(const Populated&) = delete;

    taut_world world;
    taut_shape plane, box, hull;
    taut_body ground, crate, lift, wedge, bob;
    taut_collider collider;  // of the crate
    taut_joint ball, rod;
    std::vector<unsigned char> saved;  // it as made
};

}  // namespace taut_test
