// Attachments: points that move with some nodes, held on each other. Each owns elements in sets that attachments of one
// type and law share, and is read by where its two ends are.
//
// A distance may only pull, and may have a second element that only pulls, from its limit on: a biphasic spring.
#pragma once

#include <array>

#include "state/elements.h"

namespace taut {

constexpr uint32_t kAnchorNodes = 4;

// sum_n weight_n (x_n + R_n point_n), of weights whose sum is 1; without nodes point[0] in the world [m].
struct Anchor {
    uint32_t count = 0;
    std::array<uint32_t, kAnchorNodes> node{kNone, kNone, kNone, kNone};
    std::array<double, kAnchorNodes> weight{};
    // Relative to the centre of mass, body axes; of a particle 0 [m].
    std::array<Vec3, kAnchorNodes> point{Vec3(Vec3::Zero()), Vec3(Vec3::Zero()), Vec3(Vec3::Zero()),
                                         Vec3(Vec3::Zero())};

    std::span<const uint32_t> nodes() const { return {node.data(), count}; }
};
template <class Visitor, Like<Anchor> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [count, node, weight, point] = of;
    TAUT_FIELDS(visitor, count, node, weight, point);
}

enum class AttachmentKind : uint8_t {
    ball,      // the points are one
    distance,  // they are `length` apart
    fixed,     // each node of one end is held where it is on the other, a rigid body or the world
};

struct Attachment {
    AttachmentKind kind = AttachmentKind::ball;
    Anchor end[2];
    double length = 0;      // of a distance [m]
    double compliance = 0;  // of each element [m/N]
    double damping = 0;     // likewise [N s/m]
    JointSolve solve = JointSolve::direct;
    bool collide_connected = false;
    double break_force = std::numeric_limits<double>::infinity();   // removed when a step ends with more [N]
    double break_torque = std::numeric_limits<double>::infinity();  // of a fixed one [N m]
    bool pulls = false;                                             // of a distance
    double limit = 0;                                               // of a distance [m]; 0: none
    double limit_compliance = 0;                                    // of what pulls beyond it [m/N]
    uint32_t set = kNone;
    std::array<uint32_t, kAnchorNodes> element{kNone, kNone, kNone, kNone};
    uint32_t limit_set = kNone, limit_element = kNone;  // kNone: without a limit
    // Of a fixed one: the end whose nodes are held one by one, and where each is on the other, as Anchor::point.
    uint8_t held_end = 0;
    std::array<Vec3, kAnchorNodes> place{Vec3(Vec3::Zero()), Vec3(Vec3::Zero()), Vec3(Vec3::Zero()),
                                         Vec3(Vec3::Zero())};
    uint64_t user_data = 0;
    uint64_t serial = 0;  // by age

    uint32_t elements() const { return kind == AttachmentKind::fixed ? end[held_end].count : 1; }
    bool breakable() const { return std::isfinite(break_force) || std::isfinite(break_torque); }
};
template <class Visitor, Like<Attachment> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [kind, end, length, compliance, damping, solve, collide_connected, break_force, break_torque, pulls, limit,
           limit_compliance, set, element, limit_set, limit_element, held_end, place, user_data, serial] = of;
    TAUT_FIELDS(visitor, kind, end, length, compliance, damping, solve, collide_connected, break_force, break_torque,
                pulls, limit, limit_compliance, set, element, limit_set, limit_element, held_end, place);
    TAUT_ASIDE(visitor, user_data, serial);
}

struct Attachments {
    explicit Attachments(Memory& memory) : ids(memory), record(memory), sets(memory) {}

    // So that add() cannot throw.
    void reserve_one() {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 4);
        if (sets.capacity() < sets.size() + 2) sets.reserve(2 * sets.size() + 4);
    }
    uint32_t add(const Attachment& attachment) {
        const uint32_t index = ids.create();
        if (index == record.size())
            record.push_back(attachment);
        else
            record[index] = attachment;
        record[index].serial = ++version;
        return index;
    }
    void remove(uint32_t index) {
        record[index] = {};
        ids.destroy(index);
    }

    IdPool ids;
    Array<Attachment> record;  // dead ones have no elements
    Array<uint32_t> sets;      // of elements, that attachments share
    uint64_t version = 1;      // grows with each that is added
};
template <class Visitor, Like<Attachments> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record, sets, version] = of;
    TAUT_ASIDE(visitor, ids, sets, version);
    TAUT_ROWS(visitor, ids, record);
}

// act(node) for the nodes of both ends.
template <class Act>
void for_ends(const Attachment& attachment, Act&& act) {
    for (const Anchor& end : attachment.end)
        for (const uint32_t node : end.nodes()) act(node);
}
template <class Condition>
bool any_end(const Attachment& attachment, Condition&& condition) {
    bool any = false;
    for_ends(attachment, [&](uint32_t node) { any = any || condition(node); });
    return any;
}

// World position of an anchor [m].
Vec3 point_of(const Nodes& nodes, const Anchor& anchor);

// The way from one anchor to another as a sum over nodes; see constraints/attachment.h.
struct AttachedWay {
    struct Term {
        uint32_t node;
        double weight;
        Vec3 moment;
    };
    uint32_t count = 0;
    std::array<Term, 2 * kAnchorNodes> term;
    Vec3 rest = Vec3::Zero();  // c
};
AttachedWay way_between(const Anchor& from, const Anchor& to);
// Of an attachment's element.
AttachedWay way_of(const Attachment& attachment, uint32_t i);

// What an attachment carries on end b: force, and of a fixed one the torque about the anchor whose nodes it holds one
// by one, world axes; zero of one that was not solved yet.
struct AttachmentLoad {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m]
};
AttachmentLoad load_of(const Nodes& nodes, const Elements& elements, const Attachment& attachment);
// The largest of its elements' |C| [m].
double gap_of(const Nodes& nodes, const Elements& elements, const Attachment& attachment);

}  // namespace taut
