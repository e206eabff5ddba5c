// Random scenes in which heavy bodies, up to ten tons, meet light ones of about a kilogram, and what goes wrong there.
#pragma once

#include <functional>
#include <ostream>
#include <random>
#include <span>
#include <vector>

#include "physics/joint_lab.h"

namespace soak {

using Random = std::mt19937;

// A world with what is in it.
class Medley {
public:
    explicit Medley(uint32_t threads);

    taut_body add_fixed(taut_shape shape, const lab::Vec& position, const lab::Quat& rotation = {});
    taut_body add_kinematic(taut_shape shape, const lab::Vec& position);
    // mass [kg]; core: radius of a ball within [m].
    taut_body add(const lab::BodyPlan& plan, double core);
    taut_body add_compound(const taut_body_def& def, double core);
    void add_ground();
    // A ball, box, brick, cylinder or capsule, 3 to 15 cm from its middle; how far that is.
    double light_shape(Random& random, taut_shape& out) const;
    // So many of these on the ground, apart from each other.
    void scatter(Random& random, int count, const lab::Vec& from, const lab::Vec& to);

    // What becomes of it in so many frames.
    struct Outcome {
        double fastest = 0;  // body [m/s]
        double gain = 0;     // of energy, kinetic and of height, at most, in parts of the largest kinetic energy
        double gap = 0;      // of a joint, at most [m]
        double overlap = 0;  // at the end, in parts of the smaller of two cores
        uint64_t hash = 0;   // of the end
    };
    Outcome run();

    lab::World world;
    std::vector<taut_joint> joints;
    int frames = 240;
    std::function<void(int frame)> before_step;  // what moves by plan

private:
    double energy() const;                // [J]
    bool tied(size_t a, size_t b) const;  // bodies by place
    double overlap() const;

    std::vector<taut_body> bodies_, fixed_;  // fixed: static and kinematic
    std::vector<double> cores_;              // of bodies
};

// What holds for one kind of scene from any start.
struct Bounds {
    bool driven = false;      // energy comes in; else it rises by no more than a hundredth of the motion's
    bool leaves_room = true;  // in the end at most one start in twenty overlaps by more than a third of a core
    double fastest = 0;       // no body is faster [m/s]
    double gap = 0;           // no joint opens wider [m]
};

struct Family {
    const char* name;
    void (*make)(Medley& medley, Random& random);
    Bounds bounds;
};

inline void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

std::span<const Family> families();

}  // namespace soak
