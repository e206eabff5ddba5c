// What every entry point shares: checking arguments, finding and holding a world, keeping exceptions inside.
#pragma once

#include <algorithm>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <stdexcept>
#include <type_traits>

#include "base/float_environment.h"
#include "base/result.h"
#include "record/recorded.h"
#include "world.h"

namespace taut {

// ---------------------------------------------------------------- ranges

// Closed unless open_below. A float is compared with the limits rounded to float.
struct Range {
    double lo, hi;
    bool open_below = false;
};

// Each is stated in the public header that names the field.
constexpr Range kPosition{-1e7, 1e7};  // [m]; also the length of the vector
constexpr Range kSpeed{-1e4, 1e4};     // [m/s, rad/s]; also the length of the vector
constexpr Range kGravity{-1e4, 1e4};   // [m/s^2]
constexpr Range kGravityScale{-1000, 1000};
constexpr Range kDampingRate{0, 1e6};       // [1/s]
constexpr Range kSpeedLimit{0, 1e6, true};  // [m/s, rad/s]
constexpr Range kTimeStep{1e-4, 0.1};       // [s]
constexpr Range kFriction{0, 100};
constexpr Range kFrictionArm{0, 1000};  // [m]
constexpr Range kUnitInterval{0, 1};
constexpr Range kDensity{0, 1e8, true};                                       // [kg/m^3]
constexpr Range kBodyMass{1e-6, 1e15};                                        // [kg]
constexpr Range kParticleMass{1e-9, 1e21};                                    // [kg]
constexpr Range kShapeSize{TAUT_SHAPE_MIN_SIZE, TAUT_SHAPE_MAX_SIZE};         // [m]
constexpr Range kShapeCoordinate{-TAUT_SHAPE_MAX_SIZE, TAUT_SHAPE_MAX_SIZE};  // [m], in a body's frame
constexpr Range kShapeScale{1e-3, 1e3};                                       // size of a factor
constexpr Range kCompliance{0, 1e6};                                          // [m/N]
constexpr Range kDamping{0, 1e12};                                            // [N s/m]
constexpr Range kJointLength{1e-4, 1e6};                                      // [m]
constexpr Range kJointPosition{-1e6, 1e6};                                    // [m], of a stop or target
constexpr Range kJointAngle{-6.2831855, 6.2831855};                           // [rad], likewise
constexpr Range kSwing{0, 3.1415927410125732, true};                          // [rad]
constexpr Range kJointForce{0, 1e24};                                         // [N, N m], stiffness and damping too
constexpr Range kFrequency{1e-3, 1e3};                                        // [Hz]
constexpr Range kDampingRatio{0, 1000};
constexpr Range kOneWay{-1e4, 1e4};       // a direction of which the length does not matter
constexpr Range kHitSpeed{0, 1e4};        // [m/s]
constexpr Range kDirection{-1e30, 1e30};  // of which the length does not matter
constexpr Range kAdvance{0, 1e3};         // [s]
constexpr Range kQueryDistance{0, 1e7};   // [m]
// No header states these: above anything that double cannot carry through a step, far above any scene.
constexpr Range kInertia{-1e30, 1e30};   // [kg m^2]
constexpr Range kForce{-1e24, 1e24};     // [N, N m, N s, N m s]
constexpr double kUnitTolerance = 1e-3;  // of a quaternion's length

// ---------------------------------------------------------------- check

// Checks the arguments of one call in the order written; the first refusal stays, later checks do nothing.
class Check {
public:
    explicit Check(const char* call) : call_(call) {}

    // What stands before the fields of a struct inside a def ("angle."); "" at the end of it.
    Check& within(const char* scope) {
        scope_ = scope;
        return *this;
    }
    Check& pointer(const char* name, const void* value);
    // The first field of every def: that of an older header is shorter, of a newer one longer.
    Check& struct_size(uint32_t value, size_t known, size_t alignment);
    // Of a def inside another, which does not grow.
    Check& nested(uint32_t struct_size, size_t known);
    Check& zero(const char* field, uint64_t value);
    Check& boolean(const char* field, uint32_t value);
    Check& count(const char* field, uint32_t value, uint32_t lo, uint32_t hi);
    template <class Enum>
    Check& choice(const char* field, const Enum& value, uint32_t last) {
        static_assert(sizeof(Enum) == sizeof(uint32_t));
        uint32_t bits;  // a host may store anything, which an enum's own type may not hold
        std::memcpy(&bits, &value, sizeof bits);
        return count(field, bits, 0, last);
    }
    Check& number(const char* field, float value, Range range);
    Check& number(const char* field, double value, Range range);
    Check& zero_or(const char* field, float value, Range range);
    // In the range, or one value outside: an infinity.
    Check& number_or(const char* field, float value, Range range, float other);
    // Each component in the range.
    Check& vector(const char* field, const taut_vec3& value, Range range);
    Check& vector(const char* field, const taut_pos& value, Range range);
    // Each component in the range, and the length at most its upper end.
    Check& bounded(const char* field, const taut_vec3& value, Range range);
    Check& bounded(const char* field, const taut_pos& value, Range range);
    Check& zero(const char* field, float value, const char* why);
    Check& zero(const char* field, const taut_vec3& value, const char* why);
    Check& rotation(const char* field, const taut_quat& value);
    Check& pose(const char* position, const char* rotation_field, const taut_pose& value);
    // Any other condition: "<call>: <text>".
    Check& require(bool condition, const char* text, taut_result code = TAUT_INVALID_ARGUMENT);
    // "<call>: <text>: <reason>".
    Check& refuse_with(const char* text, const char* reason);

    explicit operator bool() const { return result_ == TAUT_OK; }
    taut_result result() const { return result_; }
    const char* call() const { return call_; }

private:
    template <class T>
    Check& in_range(const char* field, const char* part, T value, Range range);
    Check& length(const char* field, double squared, Range range);

    const char* call_;
    const char* scope_ = "";
    taut_result result_ = TAUT_OK;
};

// Whether more of them fit: below the limit of the world's def, and into the slots.
taut_result room_for_bodies(const char* call, const World& world, size_t more);
taut_result room_for_colliders(const char* call, const World& world, size_t more);
taut_result room_for_joints(const char* call, const World& world, size_t more);
taut_result room_for_attachments(const char* call, const World& world, size_t more);

// ---------------------------------------------------------------- find

// Readers share a world; a writer holds it alone. Whoever comes in between is refused, not kept waiting: he is a
// callback inside a step or breaks the rule of one thread at a time. Alone: a reader that works in the world's
// memory, or a writer of what is the host's and no state.
enum class Use { read, alone, write };

// Holds a world while it lives. The lock stands in a static table, not in the world, so that looking up a handle
// whose world is being destroyed by another thread touches no freed memory.
class Hold {
public:
    Hold(uint32_t world, Use use) noexcept;
    ~Hold();
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

    World* world() const { return world_; }  // null: refused
    taut_result refusal() const { return refusal_; }

private:
    friend void destroy_world(Hold& hold);

    uint32_t slot_ = 0;
    Use use_;
    World* world_ = nullptr;
    taut_result refusal_ = TAUT_OK;
};

// Creates a world in the table: its id, or 0 if the table is full. Throws std::bad_alloc.
uint32_t create_world(const taut_world_def& checked_def);
// Destroys a world held for writing.
void destroy_world(Hold& hold);
bool world_lives(uint32_t world) noexcept;
// Whether nobody has held it for writing.
bool is_as_created(const World& world) noexcept;

// 20 bits of a world's handle; 0 (no world) for anything else.
inline uint32_t world_of(taut_world handle) {
    return handle.bits >> kWorldBits ? 0 : static_cast<uint32_t>(handle.bits);
}

// Text and code for a world that could not be held.
taut_result refuse_hold(const char* call, const char* what, taut_result refusal);
taut_result refuse_stale(const char* call, const char* what, uint64_t bits);

// The live slot that a handle inside a call on this world names. field: the argument's name in texts.
taut_result find_body(const char* call, const char* field, const World& world, taut_body handle, uint32_t& node);
taut_result find_shape(const char* call, const char* field, const World& world, taut_shape handle, uint32_t& shape);
taut_result find_collider(const char* call, const char* field, const World& world, taut_collider handle,
                          uint32_t& collider);

inline const IdPool& pool_of(const World& world, taut_body) { return world.nodes.ids; }
inline const IdPool& pool_of(const World& world, taut_collider) { return world.colliders.ids; }
inline const IdPool& pool_of(const World& world, taut_joint) { return world.joints.ids; }
inline const IdPool& pool_of(const World& world, taut_cable) { return world.cables.ids; }
inline const IdPool& pool_of(const World& world, taut_cloth) { return world.softs.ids; }
inline const IdPool& pool_of(const World& world, taut_solid) { return world.softs.ids; }
inline const IdPool& pool_of(const World& world, taut_attachment) { return world.attachments.ids; }
// Whether the bits name something that lives; an inner joint has no handle.
template <class Handle>
bool names(const World& world, Handle handle, const HandleBits& bits) {
    return pool_of(world, handle).live(bits.index, bits.generation);
}
inline bool names(const World& world, taut_shape, const HandleBits& bits) {
    return world.shapes.live(bits.index, bits.generation);
}
inline bool names(const World& world, taut_joint handle, const HandleBits& bits) {
    return pool_of(world, handle).live(bits.index, bits.generation) && !world.joints.record[bits.index].inner;
}
inline bool names(const World& world, taut_cloth handle, const HandleBits& bits) {
    return pool_of(world, handle).live(bits.index, bits.generation) &&
           world.softs.record[bits.index].kind == SoftKind::cloth;
}
inline bool names(const World& world, taut_solid handle, const HandleBits& bits) {
    return pool_of(world, handle).live(bits.index, bits.generation) &&
           world.softs.record[bits.index].kind == SoftKind::solid;
}
constexpr const char* name_of(taut_body) { return "body"; }
constexpr const char* name_of(taut_shape) { return "shape"; }
constexpr const char* name_of(taut_collider) { return "collider"; }
constexpr const char* name_of(taut_joint) { return "joint"; }
constexpr const char* name_of(taut_cable) { return "cable"; }
constexpr const char* name_of(taut_cloth) { return "cloth"; }
constexpr const char* name_of(taut_solid) { return "solid"; }
constexpr const char* name_of(taut_attachment) { return "attachment"; }

// ---------------------------------------------------------------- act

// Nothing thrown inside crosses the interface, nor does the arithmetic of the host's thread.
template <class Act>
taut_result contain(const char* call, Act&& act) noexcept {
    const FloatEnvironment standard;
    try {
        const taut_result result = act();
        if (recording()) tell_result(result);
        return result;
    } catch (const std::bad_alloc&) {
        return refuse(TAUT_OUT_OF_MEMORY, "%s: out of memory", call);
    } catch (const std::length_error&) {
        return refuse(TAUT_OUT_OF_MEMORY, "%s: out of memory", call);
    } catch (const std::exception& error) {
        return refuse(TAUT_UNSUPPORTED, "%s: %s", call, error.what());
    } catch (...) {
        return refuse(TAUT_UNSUPPORTED, "%s: a host callback threw an exception", call);
    }
}

// act() on a world held so. What writes it is in its recording, if it has one, or is noted there as missing.
template <class Act>
taut_result changing(const char* call, Use use, const World& world, Act&& act) {
    const taut_result result = act();
    if (use == Use::write && result == TAUT_OK && recording()) note_change(call, world.id);
    return result;
}

// act(World&) with the world held.
template <class Act>
taut_result with_world(const char* call, taut_world handle, Use use, Act&& act) noexcept {
    return contain(call, [&] {
        const Hold hold(world_of(handle), use);
        if (!hold.world()) return refuse_hold(call, "world", hold.refusal());
        return changing(call, use, *hold.world(), [&] { return act(*hold.world()); });
    });
}

// Adds the name of a body that has one to the text of a refusal.
void tell_name(const World& world, uint32_t node);

// act(World&, index) for a handle of a body, shape, collider, joint or cable, with its world held.
template <class Handle, class Act>
taut_result with(const char* call, Handle handle, Use use, Act&& act) noexcept {
    return contain(call, [&] {
        HandleBits bits;
        if (!unpack_handle(handle.bits, bits)) return refuse_stale(call, name_of(handle), handle.bits);
        const Hold hold(bits.world, use);
        if (!hold.world()) return refuse_hold(call, name_of(handle), hold.refusal());
        if (!names(*hold.world(), handle, bits)) return refuse_stale(call, name_of(handle), handle.bits);
        const taut_result result = changing(call, use, *hold.world(), [&] { return act(*hold.world(), bits.index); });
        if constexpr (std::is_same_v<Handle, taut_body>)
            if (result != TAUT_OK) tell_name(*hold.world(), bits.index);
        return result;
    });
}

// For the _is_valid functions; a locked world answers no.
template <class Handle>
int32_t is_valid(Handle handle) noexcept {
    HandleBits bits;
    if (!unpack_handle(handle.bits, bits)) return 0;
    const Hold hold(bits.world, Use::read);
    return hold.world() && names(*hold.world(), handle, bits) ? 1 : 0;
}

// ---------------------------------------------------------------- values

// The world itself comes from its allocator too.
inline uint64_t held_bytes(const World& world) {
    return world.memory.bytes() + Memory::whole(sizeof(World), alignof(World));
}

constexpr taut_quat kUnturned{0, 0, 0, 1};
inline Vec3 to_vec(const taut_vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3 to_vec(const taut_pos& p) { return {p.x, p.y, p.z}; }
inline Quat to_quat(const taut_quat& q) { return Quat(q.w, q.x, q.y, q.z).normalized(); }
inline taut_pos to_pos(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
// What outgrows single precision is told as the largest float, what is no number as 0: all readings are finite.
inline float to_float(double x) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return x == x ? static_cast<float>(std::clamp(x, -kLargest, kLargest)) : 0.0f;
}
inline taut_vec3 to_vec3(const Vec3& v) { return {to_float(v.x()), to_float(v.y()), to_float(v.z())}; }
inline taut_quat to_quat(const Quat& q) {
    return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()), static_cast<float>(q.w())};
}
inline taut_sym3 to_sym3(const Sym3& m) {
    return {static_cast<float>(m.xx), static_cast<float>(m.yy), static_cast<float>(m.zz),
            static_cast<float>(m.xy), static_cast<float>(m.xz), static_cast<float>(m.yz)};
}

}  // namespace taut
