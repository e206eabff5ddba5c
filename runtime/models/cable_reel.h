// One end of one cable that is being reeled. Whatever changes there, a joint goes on as it was: it keeps lambda, and
// its error at the start of the step counts as what it was before, or as that times the growth of its compliance, by
// which the same force holds. Joint::drift lets the difference come bit by bit over the substeps of the frame.
#pragma once

#include "models/bodies.h"
#include "models/cable_parts.h"
#include "state/joint_reading.h"

namespace taut {

// A joint or element before a change, to be let go after it.
class Kept {
public:
    Kept(World& world, const ConstraintRef& ref);
    Kept(World& world, const JointRef& joint) : Kept(world, ref_of(world, joint)) {}
    // Where it is now.
    void let_go(const ConstraintRef& now) const;
    void let_go() const { let_go(ref_); }

private:
    World& world_;
    ConstraintRef ref_;
    double error_[kMaxRows] = {}, compliance_[2] = {};
};

class Reel {
public:
    Reel(World& world, uint32_t index, int end)
        : world_(world), index_(index), e_(end), c_(world.cables.record[index]), end_(c_.end[end]) {}

    bool works() const { return tied() && (end_.reel_speed != 0 || end_.wanted_speed != 0 || end_.owed != 0); }
    // Cuts and joins segments of an awake cable until the end segment can change by what is planned.
    void fit();
    void advance();
    void rest();
    void wake_up();

private:
    struct Plan {
        double speed, owed, paid;  // [m/s], of what is owed [m], in all [m]
    };
    Plan plan() const;
    bool tied() const;
    bool can_join() const;

    double step() const { return world_.def.time_step; }
    bool links() const { return taut::links(c_); }
    uint32_t at() const { return e_ == 0 ? 0 : c_.segments() - 1; }  // the end segment
    double& length() const { return c_.length[at()]; }
    uint32_t outer() const { return e_ == 0 ? c_.node.front() : c_.node.back(); }
    uint32_t second() const { return e_ == 0 ? c_.node[1] : c_.node[c_.node.size() - 2]; }
    NodeMotion& motion(uint32_t node) const { return world_.nodes.motion[node]; }
    bool moves(uint32_t node) const { return moves_by_forces(world_.nodes.info[node].kind); }
    // Whether the end segment and the next are tied.
    bool is_whole() const { return taut::is_whole(world_, c_, links() && e_ == 1 ? at() - 1 : at()); }

    template <class T>
    void insert(Array<T>& list, const T& value, uint32_t from_end) {
        list.insert(e_ == 0 ? list.begin() + from_end : list.end() - from_end, value);
    }
    template <class T>
    void erase(Array<T>& list, uint32_t from_end) {
        list.erase(e_ == 0 ? list.begin() + from_end : list.end() - 1 - from_end);
    }

    // Room for the end events of pairs on nodes that go or change.
    void reserve_ended_of(std::initializer_list<uint32_t> nodes);
    // A node, the slot of a joint if one is asked for and room for elements; all that may fail when a segment is cut.
    uint32_t add_parts(const NodeMotion& m, double share, JointRef* joint);
    Joint& place_joint(const JointRef& ref, Joint joint);
    // So many shares of its force onto `force`.
    void blend(const ConstraintRef& ref, double weight, double* force) const;
    // Drift by which what is straight now soon gives way as this force asks.
    void load(const ConstraintRef& ref, const double* force);
    // Joints of someone else on a node that goes away with it; forgotten pairs have their room.
    void remove_ties_of(uint32_t node);  // joints and attachments

    // cable_reel_links.cpp
    void grow_link(double d);
    void divide_link();
    void join_links();
    const JointRef& inner(uint32_t i) const { return e_ == 0 ? joint_after(c_, i) : joint_before(c_, i); }
    Vec3 outward(const NodeMotion& m) const { return m.q * Vec3(0, e_ == 0 ? -1 : 1, 0); }
    void retie(uint32_t i);

    // cable_reel_particles.cpp
    void grow_particles(double d);
    void divide_particles();
    void join_particles();
    uint32_t point(uint32_t from_end) const { return e_ == 0 ? from_end : c_.segments() - from_end; }
    void set_points(uint32_t count);

    World& world_;
    uint32_t index_;
    int e_;
    Cable& c_;
    CableEnd& end_;
};

}  // namespace taut
