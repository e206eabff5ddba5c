// Every scene by name.
#pragma once

#include <string>
#include <vector>

#include "scene.h"

namespace scenes {

struct Options {
    uint64_t seed = 0;        // above 0: a random start, the same for the same seed
    std::string mesh;         // file of scenes that take one
    bool swept = false;       // cloths and solids are swept, not solved directly
    bool from_point = false;  // what begins tangled has all its vertices in one point
    bool line_search = true;  // else minimisation takes Newton's steps as they come, few of them
};

// A family of scenes. In a pattern, N stands for a count and R for a mass, ratio or weight.
struct Family {
    const char* pattern;
    const char* example;
    const char* description;
    uint32_t steps;
    bool needs_mesh;
    Scene (*build)(double n, double r, const Options& options);
    double largest_n;
    bool takes_mesh = false;  // it can do without
    bool large = false;       // a step takes tens of milliseconds: quick tests take few
};

const std::vector<Family>& families();

// Builds a scene. Throws BadScene (unknown name, number out of range) or BadFile.
Scene make_scene(const std::string& name, const Options& options = {});
// Of some families; likewise.
Scene make_scene(const std::string& name, const Options& options, const std::vector<Family>& among);

}  // namespace scenes
