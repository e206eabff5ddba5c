// Cables: which nodes, joints and elements a user's cable is made of, in order, and how its ends are being reeled.
#pragma once

#include "state/colliders.h"
#include "state/elements.h"

namespace taut {

enum class CableKind : uint8_t { particles, links };

// A joint that may be gone: slots are used again, serials are not.
struct JointRef {
    uint32_t slot = kNone;
    uint64_t serial = 0;
};
template <class Visitor, Like<JointRef> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [slot, serial] = of;
    TAUT_FIELDS(visitor, slot);
    TAUT_ASIDE(visitor, serial);
}

struct CableEnd {
    JointRef joint;           // to what the end is attached to; node[end == 0] of it is the cable's
    JointRef clamp;           // of particles: the bend between the direction held there and the end segment
    double reel_speed = 0;    // of the last step, positive pays out [m/s]
    double wanted_speed = 0;  // [m/s]
    double acceleration = 0;  // towards it; 0: at once [m/s^2]
    double paid = 0;          // in the last step [m]
    double owed = 0;          // still to be paid out, beside the speed [m]
    double lost = 0;          // where bent segments were joined, not made good yet [m]
};
template <class Visitor, Like<CableEnd> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [joint, clamp, reel_speed, wanted_speed, acceleration, paid, owed, lost] = of;
    TAUT_FIELDS(visitor, joint, clamp, reel_speed, wanted_speed, acceleration, paid, owed, lost);
}

struct Cable {
    explicit Cable(Memory& memory) : node(memory), joint(memory), length(memory) {}

    CableKind kind = CableKind::particles;
    Array<uint32_t> node;      // points, or links
    Array<JointRef> joint;     // of links, between node i and node i + 1
    uint32_t stretch = kNone;  // of particles: element set of the segments, in order
    uint32_t bending = kNone;  // of particles with bending stiffness: that of the bends, i at point i + 1
    Array<double> length;      // of each segment, unstretched [m]
    CableEnd end[2];
    double nominal = 0;             // length of a segment that is cut off when paying out [m]
    double mass_per_metre = 0;      // [kg/m]
    double radius = 0;              // [m]
    double stretch_compliance = 0;  // [1/N]
    double stretch_damping = 0;     // [N s]
    double bending_stiffness = 0;   // [N m^2]; 0: limp
    double bending_damping = 0;     // [N m^2 s]
    double gravity_scale = 1;
    taut_material material{};
    taut_filter filter{};
    bool self_collision = false;
    uint64_t user_data = 0;

    uint32_t segments() const { return static_cast<uint32_t>(length.size()); }
};
template <class Visitor, Like<Cable> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [kind, node, joint, stretch, bending, length, end, nominal, mass_per_metre, radius, stretch_compliance,
           stretch_damping, bending_stiffness, bending_damping, gravity_scale, material, filter, self_collision,
           user_data] = of;
    TAUT_FIELDS(visitor, kind, node, joint, stretch, bending, length, end, nominal, mass_per_metre, radius,
                stretch_compliance, stretch_damping, bending_stiffness, bending_damping, gravity_scale, material,
                filter, self_collision);
    TAUT_ASIDE(visitor, user_data);
}

struct Cables {
    explicit Cables(Memory& memory) : ids(memory), record(memory) {}

    // Room for one more, so that add() cannot throw.
    void reserve_one() {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 4);
    }
    uint32_t add(Cable&& cable) {
        const uint32_t index = ids.create();
        if (index == record.size())
            record.push_back(std::move(cable));
        else
            record[index] = std::move(cable);
        return index;
    }
    void remove(uint32_t index) {
        record[index] = Cable(*record[index].node.get_allocator().memory);
        ids.destroy(index);
    }

    IdPool ids;
    Array<Cable> record;
};
template <class Visitor, Like<Cables> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record] = of;
    TAUT_ASIDE(visitor, ids);
    TAUT_ROWS(visitor, ids, record);
}

inline const Joint* find(const Joints& joints, const JointRef& ref) {
    if (ref.slot == kNone || !joints.record[ref.slot].type) return nullptr;
    return joints.record[ref.slot].serial == ref.serial ? &joints.record[ref.slot] : nullptr;
}
inline Joint* find(Joints& joints, const JointRef& ref) {
    return const_cast<Joint*>(find(static_cast<const Joints&>(joints), ref));
}

}  // namespace taut
