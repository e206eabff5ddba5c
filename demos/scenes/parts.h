// Pieces that scenes are put together from.
#pragma once

#include "catalogue.h"
#include "random.h"
#include "scene.h"

namespace scenes {

// An empty scene with the default world.
Scene empty_scene();

int box_shape(Scene& scene, double half_x, double half_y, double half_z);
int cube_shape(Scene& scene, double side);
int sphere_shape(Scene& scene, double radius);

void add_ground(Scene& scene);
void add_static_box(Scene& scene, taut_pos centre, double half_x, double half_y, double half_z, Look look);
Body crate(int shape, taut_pos position, double mass, Look look = Look::crate);

// A chain of equal links joined end to end by ball joints and held at its anchor, with a weight at its end.
struct ChainPlan {
    taut_pos anchor{};
    int links = 10;
    double link_length = 0.5, link_thickness = 0.2;  // [m]
    double link_mass = 1, weight_mass = 1000;        // [kg]
    int weight_shape = -1;
    double weight_reach = 0.25;  // from the last joint to the weight's centre [m]
    double angle = 0;            // of the chain against the x axis, about z [rad]
};
void add_chain(Scene& scene, const ChainPlan& plan);

// The same start for the same seed; nothing for seed 0. Chains: turned by up to 30 degrees about the anchor in
// their plane, and velocities that don't fit together; others: offsets of millimetres and small velocities.
enum class ChainStart { turned, laid_out };
void perturb(Scene& scene, uint64_t seed, ChainStart start = ChainStart::turned);

// A mast and an arm behind the anchor, for the eye only.
void decorate_with_crane(Scene& scene, taut_pos anchor);

}  // namespace scenes
