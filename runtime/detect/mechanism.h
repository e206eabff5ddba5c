// What is put back as one where something passed.
#pragma once

#include "state/elements.h"
#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

// Mechanisms::ties. Anchored: also to what does not move by forces; driven: by a heavier one, in this step.
constexpr uint8_t kJointed = 1, kAnchored = 2, kDriven = 4;
// Who drives with so many times as much as the other takes it along.
constexpr float kDrives = 10;
constexpr float kKinematic = 1e30f;  // what kinematic bodies drive with [kg]
// More than any mass, and less than what those drive with that a few kinematic bodies' drives were handed on to [kg].
constexpr float kOfKinematic = 1e-10f * kKinematic;

constexpr double kWhole = 0.99;  // such a share is all of the way
constexpr uint8_t kRounds = 3;   // where a mechanism was put back, other parts of it may have passed

void find_mechanisms(const Nodes& nodes, const Joints& joints, const Elements& elements, Mechanisms& of);

// After all rounds: forgets what was found, and of stays those of mechanisms that did not stay in this frame, and those
// that lasted too long.
void end_mechanisms(const Nodes& nodes, Mechanisms& of);

// A body and what joints and rigid elements tie to it, which stay as they are against each other.
class Mechanism {
public:
    Mechanism(Nodes& nodes, const Joints& joints, const Elements& elements, Mechanisms& all, uint32_t node)
        : nodes_(nodes),
          joints_(joints),
          elements_(elements),
          all_(all),
          moves_(nodes.solved(node)),
          root_(moves_ ? all.root[node] : node),
          kinematic_(nodes.info[node].kind == NodeKind::kinematic) {}

    bool has(uint32_t node) const { return node != kNone && nodes_.solved(node) && all_.root[node] == root_; }

    template <class Act>
    void for_nodes(Act&& act) const {
        if (!moves_) return;
        uint32_t node = root_;
        do {
            act(node);
            node = all_.next[node];
        } while (node != root_);
    }

    // A share of the way. One body along it, which is free; more of them only as far as they must; what is anchored
    // each along its own, and in the last rounds all of it. Nobody does all of it for good.
    void go_back(double share, const Vec3& way, const Vec3& normal, uint8_t round) {
        if (!moves_) return;
        if (all_.ties[root_] & kAnchored) {
            if (round >= kRounds) share = 1;
            if (share > kWhole && !may_stay()) return;
            stay_behind(share, round);
            return close_joints();
        }
        const Vec3 back = share * (all_.ties[root_] & kJointed ? Vec3(normal.dot(way) * normal) : way);
        for_each(round, [&](uint32_t node) { nodes_.shift(node, -back); });
    }
    // By what it drives others [kg]: its mass, or a share of what it is driven by, so that both drive it on.
    float drive() const { return kinematic_ ? kKinematic : moves_ ? all_.drive[root_] : 0; }
    bool is_driven() const { return moves_ && (all_.ties[root_] & kDriven); }
    // Whether the other does not stop for it. What is anchored yields to kinematic bodies alone, and what they drive.
    bool goes_along_with(const Mechanism& other) const {
        const bool held = (all_.ties[root_] & kAnchored) && other.drive() < kOfKinematic;
        return moves_ && !held && other.drive() > kDrives * drive();
    }
    void go_along_with(const Mechanism& other, const Vec3& way, const Vec3& normal, uint8_t round) {
        all_.any_drives = true;
        all_.ties[root_] |= kDriven;
        all_.drive[root_] = other.drive() / (2 * kDrives);
        const bool across = (all_.ties[root_] & kJointed) || round < kRounds;
        const Vec3 on = across ? Vec3(normal.dot(way) * normal) : way;
        for_each(round, [&](uint32_t node) { nodes_.shift(node, on); });
    }
    // Not in frame after frame: whose joints pull it into what it may not pass would hang there for good.
    bool may_stay();
    // Where they were before the step.
    void stay(uint8_t round) { stay_behind(1, round); }

private:
    // By a share s of their way d in the step, on which they turn by theta: along d and, as what turns about an anchor
    // goes on an arc, off it by s (1 - s)/2 theta x d. A spin is turned back with its body, whose energy of it stays:
    // of a rod that spins about its axis, in another direction, it would be a hundred times as much.
    void stay_behind(double share, uint8_t round) {
        for_each(round, [&](uint32_t node) {
            const NodePose& before = nodes_.before[node];
            NodeMotion& m = nodes_.motion[node];
            Quat turn = m.q * before.rotation.conjugate();
            if (turn.w() < 0) turn.coeffs() *= -1;
            const Vec3 was = before.position + before.rotation * nodes_.mass[node].centre, way = m.x - was;
            nodes_.place(node, was + (1 - share) * (way - share * turn.vec().cross(way)));
            if (nodes_.locks_of(node).all_angular()) return;
            turn.coeffs() *= 1 - share;
            turn.w() += share;
            const Quat there = m.q;
            m.q = turn.normalized() * before.rotation;
            if (!nodes_.locks_of(node).any_angular()) m.w = m.q * (there.conjugate() * m.w);
        });
    }
    template <class Act>
    void for_each(uint8_t round, Act&& act) {
        for_nodes([&](uint32_t node) {
            act(node);
            all_.put_back[node] = round;
        });
    }

    // What turns far does not keep its joints closed on a part of its way.
    void close_joints();

    Nodes& nodes_;
    const Joints& joints_;
    const Elements& elements_;
    Mechanisms& all_;
    bool moves_;
    uint32_t root_;
    bool kinematic_;
};

}  // namespace taut
