// A walled floor where cloths, solids, balloons, cables, grains and boxes come and go, are tied together, torn and
// pulled about, for as long as one likes.
#pragma once

#include <vector>

#include "physics/attachment_lab.h"
#include "scenes/random.h"
#include "soak/counted_memory.h"

namespace soak {

class SoftGround {
public:
    static constexpr double kHalf = 4;  // of the floor's side [m]

    SoftGround(uint64_t seed, uint32_t threads, size_t most_nodes);
    ~SoftGround();
    SoftGround(const SoftGround&) = delete;
    SoftGround& operator=(const SoftGround&) = delete;

    void change();  // between steps: something comes, goes, is tied, let go, pinned or kicked
    void clear();   // all but floor and walls
    void take_events();
    bool sound() const;      // all finite
    size_t escaped() const;  // nodes far below the floor
    size_t nodes() const;
    taut_world handle() const { return world_; }
    uint64_t live_bytes() const { return memory_.bytes(); }
    uint64_t hash() const;

    struct Tally {
        uint64_t cloths = 0, solids = 0, balloons = 0, cables = 0, grains = 0, boxes = 0, ties = 0, removed = 0;
        uint64_t torn = 0, detached = 0, slept = 0, quarantined = 0;
    } tally;

private:
    // What came as one; one of its handles, or its bodies.
    struct Group {
        taut_cloth cloth = {0};
        taut_solid solid = {0};
        taut_cable cable = {0};
        std::vector<taut_body> bodies;
        size_t nodes = 0;
    };

    template <class Act>
    void for_points(Act&& act) const;
    void add_floor();
    void add_cloth();
    void add_balloon();
    void add_solid();
    void add_cable();
    void add_grains();
    void add_box();
    void tie();
    void kick();
    void pin();
    void remove(size_t group);
    taut_body add_body(taut_body_kind kind, taut_shape shape, const lab::Vec& at);
    taut_anchor anchor_of(const Group& group, const lab::Vec& near) const;
    lab::Vec place();  // above the floor
    bool chance(double share) { return random_.uniform() < share; }

    CountedMemory memory_;
    size_t most_nodes_;  // of all kinds
    taut_world world_ = {0};
    taut_shape plane_ = {0}, wall_ = {0}, box_ = {0}, grain_ = {0};
    std::vector<Group> groups_;  // in the order in which they came
    scenes::Random random_;
};

}  // namespace soak
