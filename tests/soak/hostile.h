// Scenes that nobody would make: things of all kinds, of sizes, masses and stiffnesses over decades, thrown at each
// other and at uneven ground, tied together at random. Each from a seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "physics/attachment_lab.h"
#include "scenes/random.h"

namespace soak {

// Kinds of things; of a scene's kind are about half of them.
enum class HostileKind : int { links, triangles, quads, tetrahedra, hexahedra, cloud, cable, chain, grains, rigid };
constexpr int kHostileKinds = 10;
const char* name_of(HostileKind kind);

class Hostile {
public:
    static constexpr double kHalf = 8;  // of the ground's side [m]

    Hostile(HostileKind kind, uint64_t seed, int things);

    void step() const { lab::ok(taut_world_step(world_.handle)); }
    int steps() const;  // of a second and a half

    // Kinetic energy and that of height of all that moves [J]; springs begin at rest, so they never add to it.
    double energy() const;
    double fastest() const;  // of the centres of bodies [m/s]
    size_t below() const;    // centres under the ground by more than half a metre
    bool sound() const;      // all finite
    uint64_t quarantined() const;
    uint64_t hash() const;

    double mass() const { return mass_; }                // of all that moves [kg]
    double first_speed() const { return first_speed_; }  // fastest throw [m/s]
    bool entangled() const { return entangled_; }        // things may begin within each other
    double height() const { return height_; }            // of the highest centre as it begins [m]
    double hz() const { return hz_; }
    const std::string& told() const { return told_; }  // what is in it

private:
    // What is tied to others: one of its handles, or its bodies.
    struct Thing {
        taut_cloth cloth = {0};
        taut_solid solid = {0};
        std::vector<taut_body> bodies;
    };

    static void plan_world(taut_world_def& def, double hz);
    void add_ground();
    void add_posts();
    void add_things(HostileKind kind, int things);
    void add(HostileKind kind, const lab::Vec& at);
    void add_cloth(HostileKind kind, const lab::Vec& at);
    void add_solid(HostileKind kind, const lab::Vec& at);
    void add_cable(HostileKind kind, const lab::Vec& at);
    void add_grains(const lab::Vec& at);
    void add_rigid(const lab::Vec& at);
    void tie();
    taut_anchor anchor_of(const Thing& thing, const lab::Vec& near) const;
    taut_deformable_solve any_solve();
    void tell(const char* format, ...) __attribute__((format(printf, 2, 3)));
    lab::Quat any_turn() { return lab::Quat::turn(lab::Vec(random_.direction()), 2 * lab::kPi * random_.uniform()); }
    bool chance(double share) { return random_.uniform() < share; }
    // Between two numbers, each decade alike.
    double decades(double low, double high) { return low * std::pow(high / low, random_.uniform()); }

    scenes::Random random_;
    double hz_;
    lab::World world_;
    bool entangled_, rough_ = false;
    std::vector<Thing> things_;
    std::vector<taut_body> moving_;
    std::vector<double> masses_;
    std::string told_;
    double mass_ = 0, first_speed_ = 0, height_ = 0;
};

}  // namespace soak
