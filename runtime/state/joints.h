// Joints: constraints that a user made. Their forces are carried over frames.
#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "base/id_pool.h"
#include "constraints/axis.h"
#include "constraints/constraint.h"
#include "state/nodes.h"

namespace taut {

enum class JointSolve : uint8_t {
    direct,   // part of a block
    swept,    // never
    by_load,  // part of a block while something in its mechanism needs it and that is not too dear
};

struct Joint {
    static constexpr size_t kDataSize = 256;

    const ConstraintType* type = nullptr;                    // null: dead slot
    uint32_t node[kMaxEnds] = {kNone, kNone, kNone, kNone};  // as many as the type has; kNone: the world
    double lambda[kMaxRows] = {};   // force of the last substep, stops and drives included [N, N m]
    double drift[kMaxRows] = {};    // of C since the last step, by a change of length or anchors: it comes bit by
                                    // bit over the substeps of the next one, and so without a kick
    double compliance = 0;          // of each locked row [m/N]
    double damping = 0;             // of each locked row [N s/m]; relaxation time [s] of a compliance block
    double angular_compliance = 0;  // of each locked row that is an angle [rad/(N m)]
    double angular_damping = 0;     // [N m s/rad]
    double break_force = std::numeric_limits<double>::infinity();   // removed when a step ends with more [N]
    double break_torque = std::numeric_limits<double>::infinity();  // [N m]
    bool plain = true;                                              // every row is locked: axis is not read
    JointSolve solve = JointSolve::direct;
    bool collide_connected = false;
    bool inner = false;             // of something that the host knows as a whole: no handle leads to it
    bool idle = false;              // the host switched it off, or an end is disabled: as if it was not there
    Switch off;                     // the former
    uint8_t loaded = 0;             // frames under or since a load beyond what contacts in sweeps hold; partition.h
    float need = 0;                 // of a direct solve [s]; partition/needs.h
    bool fresh = true;              // not solved yet: lambda means nothing
    Vec3 slow_turn = Vec3::Zero();  // low-passed angular velocity of its line [rad/s]; see ConstraintType::line
    uint64_t user_data = 0;
    uint64_t serial = 0;  // tells joints of one slot apart; Joints::add()
    Axis axis[kMaxRows];
    AxisMemory memory[kMaxRows];
    alignas(16) unsigned char data[kDataSize] = {};  // the type's own

    // Rows up to the last locked one: as many multipliers as a direct solve needs.
    int held() const {
        int rows = type->rows;
        while (!plain && rows > 0 && axis[rows - 1].mode != AxisMode::locked) --rows;
        return rows;
    }
    // Tells what a direct solve's matrix is made for: who, and which rows are multipliers.
    uint64_t mark() const { return serial << 4 | static_cast<uint64_t>(held()) << 1 | (plain ? 1 : 0); }

    bool works() const { return type && !idle; }
    std::span<const uint32_t> ends() const { return {node, static_cast<size_t>(type ? type->nodes : 0)}; }
    // Those that it ties: none while it is idle.
    std::span<const uint32_t> nodes() const { return {node, static_cast<size_t>(works() ? type->nodes : 0)}; }
};
template <class Visitor, Like<Joint> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [type, node, lambda, drift, compliance, damping, angular_compliance, angular_damping, break_force,
           break_torque, plain, solve, collide_connected, inner, idle, off, loaded, need, fresh, slow_turn, user_data,
           serial, axis, memory, data] = of;
    TAUT_FIELDS(visitor, type, plain);
    const int nodes = type ? type->nodes : 0, rows = type ? type->rows : 0;
    for (int n = 0; n < nodes; ++n) TAUT_FIELDS(visitor, node[n]);
    for (int r = 0; r < rows; ++r) TAUT_FIELDS(visitor, lambda[r], drift[r]);
    for (int r = 0; r < rows && !plain; ++r) TAUT_FIELDS(visitor, axis[r], memory[r]);
    TAUT_FIELDS(visitor, compliance, damping, angular_compliance, angular_damping, break_force, break_torque, solve,
                collide_connected, inner, loaded, need, fresh, slow_turn);
    Bytes own{data, type ? type->data_size : 0};
    TAUT_FIELDS(visitor, own);
    TAUT_RARE(visitor, off);
    TAUT_ASIDE(visitor, idle, user_data, serial);
}

inline bool ends_on(const Joint& joint, uint32_t node) {
    const auto ends = joint.ends();
    return std::find(ends.begin(), ends.end(), node) != ends.end();
}

// Between nodes that sleep; worlds without sleeping have none.
inline bool asleep(const Nodes& nodes, std::span<const uint32_t> ends) {
    return std::any_of(ends.begin(), ends.end(), [&](uint32_t node) { return node != kNone && nodes.sleeps(node); });
}
inline bool asleep(const Nodes& nodes, const Joint& joint) { return asleep(nodes, joint.nodes()); }

struct Joints {
    explicit Joints(Memory& memory) : ids(memory), record(memory) {}

    uint32_t add(const Joint& joint) {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 16);
        const uint32_t index = ids.create();
        if (index == record.size())
            record.push_back(joint);
        else
            record[index] = joint;
        record[index].serial = ++version;
        return index;
    }
    void remove(uint32_t index) {
        record[index].type = nullptr;
        ids.destroy(index);
        ++version;
    }

    IdPool ids;
    Array<Joint> record;
    uint64_t version = 1;  // grows whenever the joint graph changes
};
template <class Visitor, Like<Joints> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record, version] = of;
    TAUT_ASIDE(visitor, ids, version);
    TAUT_ROWS(visitor, ids, record);
}

}  // namespace taut
