// A host that means no good: what its calls share. It decides by a stream of bytes, remembers every handle that it was
// ever given, and checks after each call what must hold whatever the call was.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include <taut/taut.h>

namespace taut_test {

// Where decisions come from; take() fills size bytes, false: no more.
using ByteSource = std::function<bool(void* out, size_t size)>;

class Host {
public:
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    uint64_t accepted = 0, refused = 0;

protected:
    Host() = default;
    ~Host() = default;

    static constexpr size_t kMostBodies = 30, kMostShapes = 12, kMostJoints = 30, kMostCables = 4;

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
    // To the ends of their ranges now and then, over all orders of magnitude.
    float scale(double lo, double hi) { return static_cast<float>(lo * std::pow(hi / lo, unit())); }
    double reach(double usual) { return one_in(32) ? 1e7 : one_in(16) ? 1e4 : usual; }
    taut_pose pose() {
        taut_pose out;
        taut_pose_init(&out);
        out.position = pos(reach(20));
        out.rotation = quat();
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
    // Of a handle that was picked, which may be of the other world.
    template <class Handle>
    size_t world_of(const std::vector<Known<Handle>>& known, Handle handle, size_t otherwise) const {
        for (const Known<Handle>& one : known)
            if (one.handle.bits == handle.bits) return one.world;
        return otherwise;
    }
    taut_body pick_body(size_t world) { return one_in(6) ? pick(cable_bodies_, world) : pick(bodies_, world); }
    taut_material material(double most_friction) {
        taut_material out;
        taut_material_init(&out);
        out.friction = real(0, most_friction);
        out.restitution = real(0, 1);
        if (one_in(8)) out.friction_rule = static_cast<taut_combine>(byte() % 7);
        if (one_in(8)) out.rolling_friction = real(0, 0.2);
        if (one_in(8)) out.spinning_friction = real(0, 0.2);
        return out;
    }

    taut_friction friction() {
        taut_friction out;
        taut_friction_init(&out);
        if (one_in(2)) out.static_friction = real(0, 2);
        if (one_in(2)) out.slide_factor = real(0, 1);
        if (one_in(2)) out.slide_direction = vec(1);
        spoil(out.reserved);
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
        if (one_in(8)) def.friction = friction();
        return def;
    }

    // ------------------------------------------------------------ checks

    void expect(bool condition, const char* what) {
        if (!condition) broken_(call_, what);
    }
    // Runs a call: its result is known, and where it refuses both worlds are as they were.
    template <class Act>
    bool run(const char* name, Act&& act) {
        return run(name, false, act);
    }
    // The same of a call that changes nothing in any case.
    template <class Act>
    bool ask(const char* name, Act&& act) {
        return run(name, true, act);
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
    // Whatever was done, no state that is not finite can be read.
    void expect_all_finite() {
        for (const auto* known : {&bodies_, &cable_bodies_})
            for (const Known<taut_body>& body : *known) {
                taut_pose at;
                taut_vec3 v, w;
                if (taut_body_get_pose(body.handle, &at) == TAUT_OK) expect_finite(at);
                if (taut_body_get_velocity(body.handle, &v, &w) == TAUT_OK)
                    expect(finite(v) && finite(w), "a velocity that is not finite");
            }
    }

    template <class Handle>
    void keep(std::vector<Known<Handle>>& known, Handle handle, size_t world) {
        expect(handle.bits != 0, "a null handle of success");
        known.push_back({handle, world});
    }
    // Of both worlds, or of one.
    template <class Handle>
    size_t live(const std::vector<Known<Handle>>& known, int32_t (*valid)(Handle), size_t world = SIZE_MAX) const {
        size_t count = 0;
        for (const Known<Handle>& one : known)
            count += (world == SIZE_MAX || one.world == world) && valid(one.handle) ? 1 : 0;
        return count;
    }
    // Bodies of the live cables, cloths and solids of a world.
    uint32_t count_cable_bodies(size_t w) const {
        uint32_t sum = count_vertices(cloths_, w, taut_cloth_is_valid, taut_cloth_get_bodies) +
                       count_vertices(solids_, w, taut_solid_is_valid, taut_solid_get_bodies);
        for (const Known<taut_cable>& cable : cables_) {
            uint32_t count = 0;
            if (cable.world == w && taut_cable_is_valid(cable.handle)) {
                taut_cable_get_bodies(cable.handle, nullptr, 0, &count);
                sum += count;
            }
        }
        return sum;
    }
    template <class Handle, class Get>
    static uint32_t count_vertices(const std::vector<Known<Handle>>& known, size_t w, int32_t (*valid)(Handle),
                                   Get get) {
        uint32_t sum = 0;
        for (const Known<Handle>& one : known) {
            uint32_t count = 0;
            if (one.world == w && valid(one.handle)) get(one.handle, nullptr, 0, &count);
            sum += count;
        }
        return sum;
    }
    void keep_colliders(taut_body body, size_t world) {
        taut_collider colliders[4];
        uint32_t count = 0;
        if (taut_body_get_colliders(body, colliders, 4, &count) != TAUT_OK) return;
        for (uint32_t i = 0; i < count; ++i) keep(colliders_, colliders[i], world);
    }

    // What may be done with a world as created alone.
    virtual void record_new(size_t) {}

    ByteSource source_;
    std::function<void(const char*, const char*)> broken_;
    std::function<void(taut_world)> created_;
    bool dry_ = false;
    const char* call_ = "";
    taut_world worlds_[2] = {};
    std::vector<Known<taut_shape>> shapes_;
    std::vector<Known<taut_body>> bodies_, cable_bodies_;  // made one by one, and of cables
    std::vector<Known<taut_collider>> colliders_;
    std::vector<Known<taut_joint>> joints_, cable_joints_;
    std::vector<Known<taut_cable>> cables_;
    std::vector<Known<taut_attachment>> attachments_;
    std::vector<Known<taut_cloth>> cloths_;
    std::vector<Known<taut_solid>> solids_;
    std::vector<Known<taut_baked>> baked_;

private:
    template <class Act>
    bool run(const char* name, bool pure, Act& act) {
        call_ = name;
        const uint64_t before[2] = {hash(0), hash(1)};
        const taut_result result = act();
        call_ = name;
        expect(result >= TAUT_OK && result <= TAUT_UNSUPPORTED, "a result that is none");
        // A flipped bit of the version; what the world's solver, an open mesh or a solid does not take.
        const auto is_one_of = [&](std::initializer_list<const char*> names) {
            return std::any_of(names.begin(), names.end(),
                               [&](const char* one) { return std::strcmp(name, one) == 0; });
        };
        const bool may_be_of_others =
            is_one_of({"taut_world_restore", "taut_world_relax", "taut_shape_sample_distance", "taut_solid_recover",
                       "taut_world_add_cloth", "taut_world_add_solid", "taut_replay_open", "taut_replay_next"});
        expect(result != TAUT_LOCKED && (result != TAUT_UNSUPPORTED || may_be_of_others),
               "a result that nothing here calls for");
        if (result != TAUT_OK)
            expect(std::strstr(taut_last_error(), name) == taut_last_error(), "a text that does not name the call");
        if (result != TAUT_OK || pure)
            expect(before[0] == hash(0) && before[1] == hash(1), "a call without effect that changed a world");
        ++(result == TAUT_OK ? accepted : refused);
        return result == TAUT_OK;
    }
};

}  // namespace taut_test
