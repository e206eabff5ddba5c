// A host that means no good: calls the interface in any order with valid and invalid arguments, as a stream of bytes
// tells it, and checks after each call what must hold whatever the call was. The seeded test and the fuzzer share it.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include <taut/taut.h>

namespace taut_test {

// Where decisions come from; take() fills size bytes, false: no more.
using ByteSource = std::function<bool(void* out, size_t size)>;

class Driver {
public:
    // broken: told the call and what is wrong with it.
    Driver(ByteSource source, std::function<void(const char* call, const char* what)> broken)
        : source_(std::move(source)), broken_(std::move(broken)) {
        for (taut_world& world : worlds_) create(world);
    }
    ~Driver() {
        for (taut_world world : worlds_) taut_world_destroy(world);
    }
    Driver(const Driver&) = delete;
    Driver& operator=(const Driver&) = delete;

    // One call. False: the source ran dry.
    bool call() {
        using Action = void (Driver::*)();
        static constexpr Action actions[] = {
            &Driver::add_shape,      &Driver::add_shape,    &Driver::add_body,     &Driver::add_body,
            &Driver::add_body,       &Driver::add_particle, &Driver::add_particle, &Driver::add_joint,
            &Driver::add_joint,      &Driver::remove,       &Driver::read_body,    &Driver::read_body,
            &Driver::read_joint,     &Driver::read_shape,   &Driver::read_world,   &Driver::write_body,
            &Driver::write_body,     &Driver::write_body,   &Driver::push_body,    &Driver::push_body,
            &Driver::put_to_sleep,   &Driver::write_joint,  &Driver::write_world,  &Driver::step,
            &Driver::step,           &Driver::step,         &Driver::advance,      &Driver::replace_world,
            &Driver::check_validity,
        };
        uint8_t which = 0;
        if (!source_(&which, 1)) return false;
        (this->*actions[which % (sizeof actions / sizeof *actions)])();
        return !dry_;
    }

    uint64_t accepted = 0, refused = 0;

private:
    static constexpr size_t kMostBodies = 30, kMostShapes = 12, kMostJoints = 30;

    template <class Handle>
    struct Known {
        Handle handle;
        size_t world;  // index into worlds_
    };

    // ------------------------------------------------------------ decisions

    uint8_t byte() {
        uint8_t out = 0;
        if (!source_(&out, 1)) dry_ = true;
        return out;
    }
    uint32_t word() {
        uint32_t out = 0;
        if (!source_(&out, 4)) dry_ = true;
        return out;
    }
    bool one_in(unsigned n) { return byte() % n == 0; }
    double unit() { return word() / 4294967296.0; }
    // Mostly within the limits; now and then anything.
    double number(double lo, double hi) {
        static const double odd[] = {NAN,   INFINITY, -INFINITY, 0.0,   -0.0, -1.0,  1e30,
                                     -1e30, 1e-45,    1e-30,     1e300, 3e38, -3e38, 1e-300};
        if (one_in(64)) return odd[byte() % (sizeof odd / sizeof *odd)];
        if (one_in(16)) return one_in(2) ? lo : hi;
        return lo + (hi - lo) * unit();
    }
    float real(double lo, double hi) {
        const double value = number(lo, hi);
        if (std::abs(value) > std::numeric_limits<float>::max()) return value < 0 ? -INFINITY : INFINITY;
        return static_cast<float>(value);
    }
    taut_vec3 vec(double size) {
        taut_vec3 out;
        out.x = real(-size, size);
        out.y = real(-size, size);
        out.z = real(-size, size);
        return out;
    }
    taut_pos pos(double size) {
        taut_pos out;
        out.x = number(-size, size);
        out.y = number(-size, size);
        out.z = number(-size, size);
        return out;
    }
    taut_quat quat() {
        taut_quat q = {real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)};
        const float size = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
        if (one_in(32)) return q;
        if (!(size > 0.1f)) return {0, 0, 0, 1};
        return {q.x / size, q.y / size, q.z / size, q.w / size};
    }
    taut_pose pose() {
        taut_pose out = {pos(20), quat(), {0, 0}};
        if (one_in(64)) out.reserved[0] = word();
        return out;
    }
    // A size field or flag, now and then wrong.
    void spoil(uint32_t& field) {
        if (one_in(64)) field = word() >> (byte() % 32);
    }
    size_t pick_world() { return byte() & 1; }
    // Live, long dead, of the other world, null or invented.
    template <class Handle>
    Handle pick(const std::vector<Known<Handle>>& known, size_t world) {
        const uint8_t how = byte();
        if (how < 2) return {0};
        if (how < 4) return {static_cast<uint64_t>(word()) << 32 | word()};
        for (int attempt = 0; attempt < 8 && !known.empty(); ++attempt) {
            const Known<Handle>& one = known[word() % known.size()];
            if (one.world == world || how < 8) return one.handle;
        }
        return {0};
    }

    // ------------------------------------------------------------ checks

    void expect(bool condition, const char* what) {
        if (!condition) broken_(call_, what);
    }
    // Runs a call: its result is known, and where it refuses both worlds are as they were.
    template <class Act>
    bool run(const char* name, Act&& act) {
        call_ = name;
        const uint64_t before[2] = {hash(0), hash(1)};
        const taut_result result = act();
        expect(result >= TAUT_OK && result <= TAUT_UNSUPPORTED, "a result that is none");
        expect(result != TAUT_LOCKED && result != TAUT_UNSUPPORTED, "a result that nothing here calls for");
        if (result == TAUT_OK) {
            ++accepted;
            return true;
        }
        ++refused;
        expect(std::strstr(taut_last_error(), name) == taut_last_error(), "a text that does not name the call");
        expect(before[0] == hash(0) && before[1] == hash(1), "a refused call that changed a world");
        return false;
    }
    uint64_t hash(size_t world) {
        uint64_t out = 0;
        taut_world_get_state_hash(worlds_[world], &out);
        return out;
    }
    static bool finite(const taut_vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
    static bool finite(const taut_pos& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
    void expect_finite(const taut_pose& at) {
        expect(finite(at.position), "a position that is not finite");
        const taut_quat& q = at.rotation;
        const float size = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        expect(size > 0.99f && size < 1.01f, "a rotation that is none");
    }
    void expect_all_finite() {
        for (const Known<taut_body>& body : bodies_) {
            taut_pose at;
            if (taut_body_get_pose(body.handle, &at) == TAUT_OK) expect_finite(at);
        }
    }

    // ------------------------------------------------------------ calls

    void create(taut_world& world) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.solver = static_cast<taut_solver>(byte() % 3);
        def.substeps = 1 + byte() % 4;
        def.fixed_substeps = byte() & 1;
        def.sweeps = 1 + byte() % 4;
        def.sleeping = byte() & 1;
        def.sleep_time = 0.05f;
        taut_world out = {0};
        if (taut_world_create(&def, &out) != TAUT_OK) expect(false, taut_last_error());
        world = out;
    }
    template <class Handle>
    void keep(std::vector<Known<Handle>>& known, Handle handle, size_t world) {
        expect(handle.bits != 0, "a null handle of success");
        known.push_back({handle, world});
    }
    template <class Handle>
    size_t live(const std::vector<Known<Handle>>& known, int32_t (*valid)(Handle)) {
        size_t count = 0;
        for (const Known<Handle>& one : known) count += valid(one.handle) ? 1 : 0;
        return count;
    }

    void add_shape() {
        if (live(shapes_, taut_shape_is_valid) >= kMostShapes) return;
        const size_t w = pick_world();
        const taut_world world = worlds_[w];
        taut_shape out = {0};
        bool added = false;
        switch (byte() % 11) {
            case 0: {
                taut_plane_def def;
                taut_plane_def_init(&def);
                if (one_in(2)) def.normal = vec(1);
                spoil(def.struct_size);
                added = run("taut_world_add_plane", [&] { return taut_world_add_plane(world, &def, &out); });
                break;
            }
            case 1: {
                taut_box_def def;
                taut_box_def_init(&def);
                def.half_extents = {real(0.01, 2), real(0.01, 2), real(0.01, 2)};
                spoil(def.struct_size);
                added = run("taut_world_add_box", [&] { return taut_world_add_box(world, &def, &out); });
                break;
            }
            case 2: {
                taut_sphere_def def;
                taut_sphere_def_init(&def);
                def.radius = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_sphere", [&] { return taut_world_add_sphere(world, &def, &out); });
                break;
            }
            case 3: {
                taut_capsule_def def;
                taut_capsule_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_capsule", [&] { return taut_world_add_capsule(world, &def, &out); });
                break;
            }
            case 4: {
                taut_cylinder_def def;
                taut_cylinder_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_cylinder", [&] { return taut_world_add_cylinder(world, &def, &out); });
                break;
            }
            case 5: {
                taut_cone_def def;
                taut_cone_def_init(&def);
                def.radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_cone", [&] { return taut_world_add_cone(world, &def, &out); });
                break;
            }
            case 6: {
                taut_tapered_capsule_def def;
                taut_tapered_capsule_def_init(&def);
                def.bottom_radius = real(0.01, 1);
                def.top_radius = real(0.01, 1);
                def.half_length = real(0.01, 2);
                spoil(def.struct_size);
                added = run("taut_world_add_tapered_capsule",
                            [&] { return taut_world_add_tapered_capsule(world, &def, &out); });
                break;
            }
            case 7: {
                taut_scaled_hull_def def;
                taut_scaled_hull_def_init(&def);
                def.hull = pick(shapes_, w);
                def.scale = vec(3);
                spoil(def.struct_size);
                added =
                    run("taut_world_add_scaled_hull", [&] { return taut_world_add_scaled_hull(world, &def, &out); });
                break;
            }
            case 8: {
                std::vector<taut_vec3> vertices(byte() % 20);
                for (taut_vec3& vertex : vertices) vertex = vec(2);
                std::vector<uint32_t> indices(byte() % 30 * 3u);
                for (uint32_t& index : indices) index = one_in(64) ? word() : byte() % 20;
                taut_mesh_def def;
                taut_mesh_def_init(&def);
                def.vertices = vertices.data();
                def.vertex_count = static_cast<uint32_t>(vertices.size());
                def.indices = indices.data();
                def.triangle_count = static_cast<uint32_t>(indices.size() / 3);
                def.two_sided = byte() % 2;
                spoil(def.struct_size);
                added = run("taut_world_add_mesh", [&] { return taut_world_add_mesh(world, &def, &out); });
                break;
            }
            case 9: {
                float heights[36];
                for (float& height : heights) height = real(-1, 1);
                taut_height_field_def def;
                taut_height_field_def_init(&def);
                def.heights = heights;
                def.rows = byte() % 7;
                def.columns = byte() % 7;
                def.row_spacing = real(0.1, 2);
                def.column_spacing = real(0.1, 2);
                spoil(def.struct_size);
                added =
                    run("taut_world_add_height_field", [&] { return taut_world_add_height_field(world, &def, &out); });
                break;
            }
            default: {
                std::vector<taut_vec3> points(byte() % 40);
                for (taut_vec3& point : points) point = vec(1);
                taut_hull_def def;
                taut_hull_def_init(&def);
                def.points = points.data();
                def.point_count = static_cast<uint32_t>(points.size());
                spoil(def.struct_size);
                added = run("taut_world_add_hull", [&] { return taut_world_add_hull(world, &def, &out); });
            }
        }
        if (added) keep(shapes_, out, w);
    }

    taut_material material(double most_friction) {
        taut_material out{};
        out.friction = real(0, most_friction);
        out.restitution = real(0, 1);
        if (one_in(8)) out.friction_rule = static_cast<taut_combine>(byte() % 7);
        if (one_in(8)) out.rolling_friction = real(0, 0.2);
        if (one_in(8)) out.spinning_friction = real(0, 0.2);
        return out;
    }

    taut_collider_def collider_def(size_t w) {
        taut_collider_def def;
        taut_collider_def_init(&def);
        spoil(def.struct_size);
        def.shape = pick(shapes_, w);
        def.position = vec(1);
        def.rotation = quat();
        def.density = real(0, 5000);
        def.material = material(2);
        if (one_in(4)) def.flags = byte() % (one_in(16) ? 16 : 8);
        if (one_in(4)) def.contact_events = byte() % (one_in(16) ? 32 : 16);
        if (one_in(8)) def.one_way = vec(1);
        return def;
    }

    void add_body() {
        if (live(bodies_, taut_body_is_valid) >= kMostBodies) return;
        const size_t w = pick_world();
        taut_body_def def;
        taut_body_def_init(&def);
        spoil(def.struct_size);
        const uint8_t kind = byte();
        def.kind = static_cast<taut_body_kind>(kind < 4 ? kind : kind < 40 ? kind % 2 : 2);
        def.position = pos(10);
        def.rotation = quat();
        if (def.kind != TAUT_BODY_STATIC || one_in(32)) {
            def.linear_velocity = vec(10);
            def.angular_velocity = vec(10);
        }
        def.shape = pick(shapes_, w);
        def.material = material(2);
        def.density = real(1, 5000);
        if (one_in(3)) def.mass = real(0.01, 1000);
        if (one_in(8))
            def.inertia = {real(0.1, 10), real(0.1, 10), real(0.1, 10), real(-1, 1), real(-1, 1), real(-1, 1)};
        if (one_in(8)) def.centre_of_mass = vec(1);
        if (one_in(8)) def.filter = {word(), word(), static_cast<int32_t>(byte() % 5) - 2, one_in(32) ? 1u : 0u};
        if (one_in(8)) def.collider_flags = byte() % (one_in(16) ? 16 : 8);
        if (one_in(8)) def.contact_events = byte() % (one_in(16) ? 32 : 16);
        def.gravity_scale = real(-2, 2);
        taut_collider_def colliders[2];
        for (taut_collider_def& collider : colliders) collider = collider_def(w);
        if (one_in(8)) def.colliders = colliders, def.collider_count = 1 + byte() % 2;
        taut_body out = {0};
        if (run("taut_world_add_body", [&] { return taut_world_add_body(worlds_[w], &def, &out); }))
            keep(bodies_, out, w);
    }

    void add_particle() {
        if (live(bodies_, taut_body_is_valid) >= kMostBodies) return;
        const size_t w = pick_world();
        taut_particle_def def;
        taut_particle_def_init(&def);
        spoil(def.struct_size);
        def.mass = one_in(4) ? real(1e-9, 1e6) : real(0.1, 10);
        def.position = pos(10);
        def.velocity = vec(10);
        if (one_in(2)) def.shape = pick(shapes_, w);
        taut_body out = {0};
        if (run("taut_world_add_particle", [&] { return taut_world_add_particle(worlds_[w], &def, &out); })) {
            keep(bodies_, out, w);
        }
    }

    template <class Def>
    Def joint_def(size_t w, void (*init)(Def*)) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        def.collide_connected = byte() & 1;
        spoil(def.collide_connected);
        def.body_a = pick(bodies_, w);
        def.body_b = pick(bodies_, w);
        if (one_in(2)) def.anchor_a = pos(2);
        if (one_in(2)) def.anchor_b = pos(2);
        if (one_in(2)) def.compliance = real(0, 0.01);
        if (one_in(2)) def.damping = real(0, 10);
        if (one_in(4)) def.break_force = real(0, 1e4);
        if (one_in(4)) def.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 3 : 2));
        return def;
    }
    taut_frame joint_frame() {
        taut_frame out = {{0, 0, 0}, {0, 0, 0, 1}};
        if (one_in(2)) out.position = pos(2);
        if (one_in(2)) out.rotation = quat();
        return out;
    }
    taut_axis_def axis_def(bool lockable) {
        taut_axis_def def;
        taut_axis_def_init(&def);
        spoil(def.struct_size);
        def.mode = static_cast<taut_axis_mode>(lockable && one_in(4) ? 0 : 1 + byte() % 2);
        if (one_in(2)) def.lower = real(-3, 0);
        if (one_in(2)) def.upper = real(0.01, 3);
        if (one_in(4)) def.stop_compliance = real(0, 0.01);
        if (one_in(4)) def.stop_damping = real(0, 10);
        if (def.mode != TAUT_AXIS_LOCKED || one_in(8)) {
            if (one_in(4)) def.drive = drive();
            if (one_in(4)) def.friction = real(0, 10);
        }
        return def;
    }
    taut_drive drive() {
        taut_drive out = {real(-1, 1), real(-5, 5), 0, 0, 0, real(0, 2), real(0, 1000)};
        if (one_in(2)) {
            out.frequency = real(0.1, 30);
        } else {
            out.stiffness = real(0, 1000);
            out.damping = one_in(8) ? INFINITY : real(0, 100);
        }
        if (one_in(8)) out.stiffness = 0;
        return out;
    }
    template <class Def>
    Def framed_def(size_t w, void (*init)(Def*)) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        def.collide_connected = byte() & 1;
        def.body_a = pick(bodies_, w);
        def.body_b = pick(bodies_, w);
        def.frame_a = joint_frame();
        def.frame_b = joint_frame();
        if (one_in(4)) {
            const taut_vec3 axis = vec(1);
            const taut_pos pivot = pos(5);
            run("taut_joint_frames_from_world", [&] {
                return taut_joint_frames_from_world(worlds_[w], def.body_a, def.body_b, pivot, axis, &def.frame_a,
                                                    &def.frame_b);
            });
        }
        if (one_in(4)) def.compliance = real(0, 0.01);
        if (one_in(4)) def.damping = real(0, 10);
        if (one_in(4)) def.angular_compliance = real(0, 0.01);
        if (one_in(4)) def.angular_damping = real(0, 10);
        if (one_in(4)) def.break_force = real(0, 1e4);
        if (one_in(4)) def.break_torque = real(0, 1e4);
        if (one_in(4)) def.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 3 : 2));
        spoil(def.reserved);
        return def;
    }
    bool add_framed(size_t w, taut_joint& out) {
        const taut_world world = worlds_[w];
        switch (byte() % 7) {
            case 0: {
                const auto def = framed_def(w, taut_fixed_joint_def_init);
                return run("taut_world_add_fixed_joint", [&] { return taut_world_add_fixed_joint(world, &def, &out); });
            }
            case 1: {
                auto def = framed_def(w, taut_hinge_joint_def_init);
                def.angle = axis_def(true);
                return run("taut_world_add_hinge_joint", [&] { return taut_world_add_hinge_joint(world, &def, &out); });
            }
            case 2: {
                auto def = framed_def(w, taut_slider_joint_def_init);
                def.slide = axis_def(true);
                return run("taut_world_add_slider_joint",
                           [&] { return taut_world_add_slider_joint(world, &def, &out); });
            }
            case 3: {
                auto def = framed_def(w, taut_cylindrical_joint_def_init);
                def.slide = axis_def(true);
                def.angle = axis_def(true);
                return run("taut_world_add_cylindrical_joint",
                           [&] { return taut_world_add_cylindrical_joint(world, &def, &out); });
            }
            case 4: {
                auto def = framed_def(w, taut_universal_joint_def_init);
                def.angle_a = axis_def(true);
                def.angle_b = axis_def(true);
                return run("taut_world_add_universal_joint",
                           [&] { return taut_world_add_universal_joint(world, &def, &out); });
            }
            case 5: {
                auto def = framed_def(w, taut_cone_twist_joint_def_init);
                def.swing = axis_def(false);
                if (!one_in(8)) def.swing.drive = {0, 0, 0, 0, 0, 1, 0};
                def.twist = axis_def(true);
                return run("taut_world_add_cone_twist_joint",
                           [&] { return taut_world_add_cone_twist_joint(world, &def, &out); });
            }
            default: {
                auto def = framed_def(w, taut_six_dof_joint_def_init);
                for (taut_axis_def& axis : def.axes)
                    if (one_in(2)) axis = axis_def(true);
                return run("taut_world_add_six_dof_joint",
                           [&] { return taut_world_add_six_dof_joint(world, &def, &out); });
            }
        }
    }
    void add_joint() {
        if (live(joints_, taut_joint_is_valid) >= kMostJoints) return;
        const size_t w = pick_world();
        taut_joint out = {0};
        bool added;
        if (one_in(2)) {
            added = add_framed(w, out);
        } else if (one_in(2)) {
            const auto def = joint_def(w, taut_ball_joint_def_init);
            added = run("taut_world_add_ball_joint", [&] { return taut_world_add_ball_joint(worlds_[w], &def, &out); });
        } else {
            auto def = joint_def(w, taut_distance_joint_def_init);
            if (one_in(2)) def.length = real(0, 3);
            if (one_in(3)) {
                if (one_in(2)) def.min_length = real(0.01, 2);
                def.max_length = one_in(4) ? INFINITY : real(2, 4);
                if (one_in(2)) def.drive = drive();
                if (one_in(2)) def.friction = real(0, 10);
            }
            if (one_in(4)) def.compliance = def.damping = 0, def.frequency = real(0.1, 30);
            spoil(def.reserved);
            added = run("taut_world_add_distance_joint",
                        [&] { return taut_world_add_distance_joint(worlds_[w], &def, &out); });
        }
        if (added) keep(joints_, out, w);
    }

    void remove() {
        const size_t w = pick_world();
        switch (byte() % 4) {
            case 0: {
                const taut_shape shape = pick(shapes_, w);
                if (run("taut_shape_remove", [&] { return taut_shape_remove(shape); })) {
                    expect(!taut_shape_is_valid(shape), "a removed shape that lives");
                }
                break;
            }
            case 1: {
                const taut_joint joint = pick(joints_, w);
                if (run("taut_joint_remove", [&] { return taut_joint_remove(joint); })) {
                    expect(!taut_joint_is_valid(joint), "a removed joint that lives");
                }
                break;
            }
            default: {
                const taut_body body = pick(bodies_, w);
                if (run("taut_body_remove", [&] { return taut_body_remove(body); })) {
                    expect(!taut_body_is_valid(body), "a removed body that lives");
                }
            }
        }
    }

    void read_body() {
        const taut_body body = pick(bodies_, pick_world());
        taut_pose at;
        if (run("taut_body_get_pose", [&] { return taut_body_get_pose(body, &at); })) expect_finite(at);
        if (run("taut_body_get_render_pose", [&] { return taut_body_get_render_pose(body, &at); })) expect_finite(at);
        float mass;
        taut_vec3 centre;
        taut_sym3 inertia;
        if (run("taut_body_get_mass", [&] { return taut_body_get_mass(body, &mass, &centre, &inertia); })) {
            expect(mass >= 0 && std::isfinite(mass) && finite(centre) && inertia.xx >= 0, "a mass that is none");
        }
        taut_body_kind kind;
        if (run("taut_body_get_kind", [&] { return taut_body_get_kind(body, &kind); })) {
            expect(kind >= TAUT_BODY_STATIC && kind <= TAUT_BODY_PARTICLE, "a kind that is none");
        }
        taut_material material;
        if (run("taut_body_get_material", [&] { return taut_body_get_material(body, &material); })) {
            expect(material.friction >= 0 && material.restitution <= 1, "a material that is none");
        }
        taut_vec3 v, w;
        if (run("taut_body_get_velocity", [&] { return taut_body_get_velocity(body, &v, &w); })) {
            expect(finite(v) && finite(w), "a velocity that is not finite");
        }
    }

    void read_joint() {
        const taut_joint joint = pick(joints_, pick_world());
        taut_pos a, b;
        if (run("taut_joint_get_anchors", [&] { return taut_joint_get_anchors(joint, &a, &b); })) {
            expect(finite(a) && finite(b), "an anchor that is not finite");
        }
        float error;
        if (run("taut_joint_get_error", [&] { return taut_joint_get_error(joint, &error); })) {
            expect(error >= 0, "an error that is none");
        }
        taut_vec3 force;
        run("taut_joint_get_force", [&] { return taut_joint_get_force(joint, &force); });
        taut_joint_kind kind;
        run("taut_joint_get_kind", [&] { return taut_joint_get_kind(joint, &kind); });
        taut_body body_a, body_b;
        if (run("taut_joint_get_bodies", [&] { return taut_joint_get_bodies(joint, &body_a, &body_b); })) {
            expect(body_a.bits == 0 || taut_body_is_valid(body_a), "a joint on a dead body");
            expect(body_b.bits == 0 || taut_body_is_valid(body_b), "a joint on a dead body");
        }
        if (run("taut_joint_get_angular_error", [&] { return taut_joint_get_angular_error(joint, &error); }))
            expect(error >= 0, "an error that is none");
        taut_vec3 torque;
        if (run("taut_joint_get_torque", [&] { return taut_joint_get_torque(joint, &torque); }))
            expect(!std::isnan(torque.x) && !std::isnan(torque.y) && !std::isnan(torque.z), "a torque that is none");
        taut_frame frame_a, frame_b;
        if (run("taut_joint_get_frames", [&] { return taut_joint_get_frames(joint, &frame_a, &frame_b); }))
            expect(finite(frame_a.position) && finite(frame_b.position), "a frame that is not finite");
        uint32_t axes = 0;
        const bool known = run("taut_joint_get_axis_count", [&] { return taut_joint_get_axis_count(joint, &axes); });
        const uint32_t axis = byte() % 8;
        float value, rate;
        const bool read =
            run("taut_joint_get_coordinates", [&] { return taut_joint_get_coordinates(joint, axis, &value, &rate); });
        expect(read == (known && axis < axes), "an axis that is there and is not");
        expect(!read || (std::isfinite(value) && std::isfinite(rate)), "a coordinate that is not finite");
        taut_axis_forces forces;
        if (run("taut_joint_get_axis_forces", [&] { return taut_joint_get_axis_forces(joint, axis, &forces); }))
            expect(std::abs(forces.active_stop) <= 1 && forces.reserved == 0, "forces that are none");
        taut_axis_def def;
        if (run("taut_joint_get_axis", [&] { return taut_joint_get_axis(joint, axis, &def); })) {
            // What is read can be written, and changes nothing.
            const uint64_t before[2] = {hash(0), hash(1)};
            expect(run("taut_joint_set_axis", [&] { return taut_joint_set_axis(joint, axis, &def); }),
                   "an axis that is read but not taken");
            expect(before[0] == hash(0) && before[1] == hash(1), "an axis that is not what was read");
        }
    }

    void read_shape() {
        const taut_shape shape = pick(shapes_, pick_world());
        const float density = real(1, 1e4);
        taut_mass_properties mass;
        if (run("taut_shape_mass_properties", [&] { return taut_shape_mass_properties(shape, density, &mass); })) {
            expect(mass.mass >= 0 && finite(mass.centre_of_mass) && mass.inertia.xx >= 0, "a mass that is none");
        }
        std::vector<taut_vec3> points(byte() * 2u);
        uint32_t count = 0;
        run("taut_shape_hull_triangles", [&] {
            return taut_shape_hull_triangles(shape, points.data(), static_cast<uint32_t>(points.size()), &count);
        });
        expect(count % 3 == 0, "triangles that are none");
        taut_shape_kind kind;
        if (run("taut_shape_get_kind", [&] { return taut_shape_get_kind(shape, &kind); })) {
            expect(kind <= TAUT_SHAPE_SURFACE, "a kind that is none");
        }
        taut_vec3 low, high;
        if (run("taut_shape_get_bounds", [&] { return taut_shape_get_bounds(shape, &low, &high); })) {
            expect(finite(low) && finite(high) && low.x < high.x && low.y < high.y && low.z < high.z, "no bounds");
        }
        run("taut_shape_triangles",
            [&] { return taut_shape_triangles(shape, points.data(), static_cast<uint32_t>(points.size()), &count); });
        taut_mesh_info info;
        if (run("taut_shape_get_mesh_info", [&] { return taut_shape_get_mesh_info(shape, &info); }))
            expect(info.facets > 0 && info.facets <= info.triangles, "facets that are none");
    }

    void read_world() {
        const taut_world world = worlds_[pick_world()];
        taut_events events;
        if (run("taut_world_get_events", [&] { return taut_world_get_events(world, &events); })) {
            for (uint32_t i = 0; i < events.moved_count; ++i) expect_finite(events.moved[i].pose);
            for (uint32_t i = 0; i < events.broken_count; ++i)
                expect(!taut_joint_is_valid(events.broken[i].joint), "a broken joint that lives");
            for (uint32_t i = 0; i < events.point_count; ++i) {
                const taut_contact_point& point = events.points[i];
                expect(finite(point.position) && std::isfinite(point.approach_speed), "a point that is not finite");
                expect(point.normal_impulse >= 0 && point.friction_impulse >= 0, "impulses that are none");
            }
            for (uint32_t i = 0; i < events.hit_count; ++i)
                expect(finite(events.hit[i].position) && events.hit[i].approach_speed > 0, "a hit that is none");
        }
        read_all(world);
        std::vector<taut_contact> contacts(byte());
        uint32_t count = 0;
        if (run("taut_world_get_contacts", [&] {
                return taut_world_get_contacts(world, contacts.data(), static_cast<uint32_t>(contacts.size()), &count);
            })) {
            for (uint32_t i = 0; i < count; ++i) {
                expect(taut_body_is_valid(contacts[i].body_a) && taut_body_is_valid(contacts[i].body_b),
                       "a contact of a dead body");
                expect(finite(contacts[i].position) && finite(contacts[i].normal), "a contact that is not finite");
            }
        }
        taut_profile profile;
        profile.struct_size = sizeof profile;
        spoil(profile.struct_size);
        run("taut_world_get_profile", [&] { return taut_world_get_profile(world, &profile); });
    }

    void read_all(taut_world world) {
        std::vector<taut_lint_entry> entries(byte());
        uint32_t count = 0;
        if (run("taut_world_lint", [&] {
                return taut_world_lint(world, entries.data(), static_cast<uint32_t>(entries.size()), &count);
            })) {
            for (uint32_t i = 0; i < count; ++i) {
                expect(entries[i].body.bits == 0 || taut_body_is_valid(entries[i].body), "lint of a dead body");
                expect(entries[i].joint.bits == 0 || taut_joint_is_valid(entries[i].joint), "lint of a dead joint");
                expect(std::strcmp(taut_lint_text(entries[i].kind), "unknown") != 0, "lint of no kind");
            }
        }
        taut_world_def def;
        if (run("taut_world_get_def", [&] { return taut_world_get_def(world, &def); }))
            expect(def.struct_size == sizeof def, "a def that is none");
        taut_body bodies[4];
        for (taut_body& body : bodies) body = pick(bodies_, 0);
        taut_pose poses[8];
        const size_t strides[] = {0, sizeof(taut_pose), 2 * sizeof(taut_pose), 4, 52};
        const size_t stride = strides[byte() % 5];
        const uint32_t wanted = byte() % 4;
        if (run("taut_world_get_body_states", [&] {
                return taut_world_get_body_states(worlds_[0], bodies, wanted, poses, stride, nullptr, 0, nullptr, 0);
            })) {
            for (uint32_t i = 0; i < wanted; ++i) expect_finite(poses[i * (stride == 2 * sizeof(taut_pose) ? 2 : 1)]);
        }
    }

    void write_body() {
        const taut_body body = pick(bodies_, pick_world());
        switch (byte() % 5) {
            case 0: {
                const taut_pose to = pose();
                run("taut_body_set_pose", [&] { return taut_body_set_pose(body, &to); });
                break;
            }
            case 1: {
                const taut_vec3 linear = vec(one_in(16) ? 1e4 : 20), angular = one_in(2) ? taut_vec3{0, 0, 0} : vec(20);
                run("taut_body_set_velocity", [&] { return taut_body_set_velocity(body, linear, angular); });
                break;
            }
            case 2: {
                const taut_pose to = pose();
                run("taut_body_move_kinematic", [&] { return taut_body_move_kinematic(body, &to); });
                break;
            }
            case 3: {
                const taut_material changed = material(100);
                run("taut_body_set_material", [&] { return taut_body_set_material(body, &changed); });
                break;
            }
            default: {
                const uint64_t value = word();
                if (!run("taut_body_set_user_data", [&] { return taut_body_set_user_data(body, value); })) return;
                uint64_t read = 0;
                taut_body_get_user_data(body, &read);
                expect(read == value, "user data that changed");
            }
        }
    }

    void put_to_sleep() {
        const taut_body body = pick(bodies_, pick_world());
        uint32_t flag = byte() & 1, read = 0;
        spoil(flag);
        run("taut_body_set_can_sleep", [&] { return taut_body_set_can_sleep(body, flag); });
        if (run("taut_body_set_awake", [&] { return taut_body_set_awake(body, flag); })) {
            expect(taut_body_is_awake(body, &read) == TAUT_OK && read == flag, "a sleeper who is awake");
        }
        const taut_pos lo = pos(5), hi = pos(5);
        const taut_world world = worlds_[pick_world()];
        run("taut_world_wake_box", [&] { return taut_world_wake_box(world, lo, hi); });
    }

    void push_body() {
        const taut_body body = pick(bodies_, pick_world());
        const taut_vec3 push = vec(one_in(16) ? 1e8 : 100), turn = one_in(2) ? taut_vec3{0, 0, 0} : vec(100);
        const taut_pos point = pos(10);
        switch (byte() % 4) {
            case 0:
                run("taut_body_apply_force", [&] { return taut_body_apply_force(body, push, turn); });
                break;
            case 1:
                run("taut_body_apply_force_at", [&] { return taut_body_apply_force_at(body, push, point); });
                break;
            case 2:
                run("taut_body_apply_impulse", [&] { return taut_body_apply_impulse(body, push, turn); });
                break;
            default:
                run("taut_body_apply_impulse_at", [&] { return taut_body_apply_impulse_at(body, push, point); });
        }
    }

    void write_joint() {
        const taut_joint joint = pick(joints_, pick_world());
        const float a = real(0, one_in(8) ? 1e6 : 0.01), b = real(0, 100), length = real(1e-4, 5);
        run("taut_joint_set_compliance", [&] { return taut_joint_set_compliance(joint, a, b); });
        run("taut_joint_set_length", [&] { return taut_joint_set_length(joint, length); });
        const uint32_t axis = byte() % 6;
        switch (byte() % 8) {
            case 0: {
                const taut_axis_def def = axis_def(true);
                run("taut_joint_set_axis", [&] { return taut_joint_set_axis(joint, axis, &def); });
                break;
            }
            case 1:
                run("taut_joint_set_target", [&] { return taut_joint_set_target(joint, axis, a, b); });
                break;
            case 2:
                run("taut_joint_set_angular_compliance",
                    [&] { return taut_joint_set_angular_compliance(joint, a, b); });
                break;
            case 3:
                run("taut_joint_set_break", [&] { return taut_joint_set_break(joint, 1e4f * a, b); });
                break;
            case 4: {
                const taut_joint_solve solve = static_cast<taut_joint_solve>(byte() % (one_in(8) ? 3 : 2));
                run("taut_joint_set_solve", [&] { return taut_joint_set_solve(joint, solve); });
                break;
            }
            case 5: {
                const taut_frame frame_a = joint_frame(), frame_b = joint_frame();
                run("taut_joint_set_frames", [&] { return taut_joint_set_frames(joint, &frame_a, &frame_b); });
                break;
            }
            case 6: {
                const uint32_t collide = byte() % (one_in(8) ? 3 : 2);
                run("taut_joint_set_collide_connected",
                    [&] { return taut_joint_set_collide_connected(joint, collide); });
                break;
            }
            default: {
                const uint64_t value = word();
                if (!run("taut_joint_set_user_data", [&] { return taut_joint_set_user_data(joint, value); })) return;
                uint64_t read = 0;
                taut_joint_get_user_data(joint, &read);
                expect(read == value, "user data that changed");
            }
        }
    }

    void write_world() {
        const taut_world world = worlds_[pick_world()];
        const taut_vec3 gravity = vec(20);
        run("taut_world_set_gravity", [&] { return taut_world_set_gravity(world, gravity); });
        const uint32_t asked = byte() % (one_in(16) ? 32 : 16);
        run("taut_world_set_contact_events", [&] { return taut_world_set_contact_events(world, asked); });
        const float speed = real(0, 10);
        run("taut_world_set_hit_speed", [&] { return taut_world_set_hit_speed(world, speed); });
        const taut_pre_solve_fn filter = one_in(2) ? judge : nullptr;
        run("taut_world_set_pre_solve", [&] { return taut_world_set_pre_solve(world, filter, this); });
    }

    // A host's filter that answers anything.
    static int32_t judge(const taut_pre_solve*, taut_pre_solve_answer* answer, void* self) {
        Driver& driver = *static_cast<Driver*>(self);
        *answer = {driver.real(0, 2), driver.real(0, 1)};
        return driver.byte() % (driver.one_in(16) ? 3 : 2);
    }

    void step() {
        const taut_world world = worlds_[pick_world()];
        run("taut_world_step", [&] { return taut_world_step(world); });
        expect_all_finite();
    }

    void advance() {
        const taut_world world = worlds_[pick_world()];
        const double seconds = number(0, 0.05);
        taut_advance out;
        if (!run("taut_world_advance", [&] { return taut_world_advance(world, seconds, &out); })) return;
        expect(out.fraction >= 0 && out.fraction < 1, "a fraction that is none");
        expect(out.steps <= 4 && out.dropped >= 0, "steps beyond the limit");
        expect_all_finite();
    }

    void replace_world() {
        if (!one_in(32)) return;
        const size_t w = pick_world();
        run("taut_world_destroy", [&] { return taut_world_destroy(worlds_[w]); });
        expect(!taut_world_is_valid(worlds_[w]), "a destroyed world that lives");
        create(worlds_[w]);
    }

    // The counts of the worlds are those of the handles that live.
    void check_validity() {
        call_ = "taut_world_get_counts";
        uint32_t bodies[2], shapes[2], joints[2];
        for (size_t w = 0; w < 2; ++w) taut_world_get_counts(worlds_[w], &bodies[w], &shapes[w], &joints[w]);
        expect(bodies[0] + bodies[1] == live(bodies_, taut_body_is_valid), "bodies that are not counted");
        expect(shapes[0] + shapes[1] == live(shapes_, taut_shape_is_valid), "shapes that are not counted");
        expect(joints[0] + joints[1] == live(joints_, taut_joint_is_valid), "joints that are not counted");
    }

    ByteSource source_;
    std::function<void(const char*, const char*)> broken_;
    bool dry_ = false;
    const char* call_ = "";
    taut_world worlds_[2] = {};
    std::vector<Known<taut_shape>> shapes_;
    std::vector<Known<taut_body>> bodies_;
    std::vector<Known<taut_joint>> joints_;
};

// A source without end: splitmix64.
inline ByteSource random_source(uint64_t seed) {
    return [state = seed](void* out, size_t size) mutable {
        for (size_t i = 0; i < size; ++i) {
            state += 0x9e3779b97f4a7c15;
            uint64_t z = state;
            z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
            z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
            static_cast<uint8_t*>(out)[i] = static_cast<uint8_t>((z ^ (z >> 31)) >> 24);
        }
        return true;
    };
}

}  // namespace taut_test
