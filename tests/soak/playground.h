// A valley where bodies of all shapes, ragdolls, cables and chains come and go for as long as one likes.
#pragma once

#include <array>
#include <deque>

#include "physics/lab.h"
#include "scenes/random.h"
#include "soak/counted_memory.h"

namespace soak {

class Playground {
public:
    static constexpr size_t kMostBodies = 300;  // of all kinds, ground and sensors not counted
    static constexpr double kHalf = 30;         // of the terrain's side [m]

    explicit Playground(uint64_t seed);
    ~Playground();
    Playground(const Playground&) = delete;
    Playground& operator=(const Playground&) = delete;

    void add_ragdoll();
    double spin() const;  // of the fastest body [rad/s]
    void change();        // between steps: something comes, or the oldest goes
    void queries();       // rays, casts, overlaps and distances of one frame
    // Queries as above from any thread while the world does not change; how many colliders they found.
    uint64_t search(uint64_t seed) const;
    // Counts events and checks their bookkeeping: who enters leaves once.
    void take_events();
    // Height of the terrain [m].
    static double height(double x, double z);
    bool sound() const;  // all finite
    // Bodies and cable points under the surface by more than their reach. What a shot throws over the rim, 12 m up, is
    // none of them.
    size_t below_terrain() const;
    taut_world handle() const { return world_; }
    uint64_t live_bytes() const { return memory_.bytes(); }
    size_t population() const;

    struct Tally {
        uint64_t made = 0, removed = 0, found = 0, begun = 0, entered = 0, left = 0, slept = 0, quarantined = 0;
    } tally;

private:
    struct Group {
        std::vector<taut_body> bodies;
        taut_cable cable = {0};
        size_t size = 0;  // in bodies
    };

    template <class Act>
    void for_points(Act&& act) const;
    void add_terrain();
    void add_shapes();
    void add_sensors();
    void add_single();
    void add_chain();
    void add_cable();
    void remove(const Group& group);
    taut_body body(taut_shape shape, const lab::Vec& at, double density = 500);
    void link(taut_body a, taut_body b, const lab::Vec& pivot, bool hinge);
    lab::Vec place();  // above the ground, within the valley

    CountedMemory memory_;
    taut_world world_ = {0};
    std::array<taut_shape, 7> shapes_{};
    taut_shape limb_ = {0}, trunk_ = {0}, bead_ = {0};
    std::deque<Group> groups_;  // the oldest first
    scenes::Random random_;
};

}  // namespace soak
