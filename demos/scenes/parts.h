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
int capsule_shape(Scene& scene, double radius, double half_length);

void add_ground(Scene& scene);
void add_static_box(Scene& scene, taut_pos centre, double half_x, double half_y, double half_z, Look look);
// Four walls about a square floor of half width `half` [m].
void add_bin(Scene& scene, double half, double height, double thickness);
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

// A capsule from one point to another, its round ends beyond them; its y axis points along.
int add_capsule(Scene& scene, taut_pos from, taut_pos to, double radius, double mass, Look look, int32_t group = 0);
// A square beam likewise, from end to end; unlike a capsule it does not roll.
int add_beam(Scene& scene, taut_pos from, taut_pos to, double half_width, double mass, Look look, int32_t group = 0);

// A joint of two bodies at a world point, as the bodies lie now: its x axis along `axis` on both.
Joint joint_at(const Scene& scene, taut_joint_kind kind, int body_a, int body_b, taut_pos pivot,
               taut_pos axis = {1, 0, 0});
// The same with an axis for each end, the second turned to the first by the shortest way: no twist between them.
Joint joint_at(const Scene& scene, taut_joint_kind kind, int body_a, int body_b, taut_pos pivot, taut_pos axis_a,
               taut_pos axis_b);
// A rod of the length that the two world points are apart.
Joint rod_at(const Scene& scene, int body_a, taut_pos point_a, int body_b, taut_pos point_b);

// A cable along a path, its ends attached to two bodies as they lie now, or to the world.
Cable cable_along(const Scene& scene, taut_cable_kind kind, std::vector<taut_pos> path, int body_0, int body_1,
                  double diameter, double mass_per_metre);

taut_axis_def free_axis();
taut_axis_def strong_motor();  // follows its plan however much hangs on it
taut_axis_def limited_axis(double lower, double upper);
constexpr double degrees(double angle) { return angle * 0.017453292519943295; }

// The same start for the same seed; nothing for seed 0. Chains: turned by up to 30 degrees about the anchor in
// their plane, and velocities that don't fit together; others: small velocities, and offsets of millimetres where no
// joint holds them.
enum class ChainStart { turned, laid_out };
void perturb(Scene& scene, uint64_t seed, ChainStart start = ChainStart::turned);

// A mast and an arm behind the anchor, for the eye only.
void decorate_with_crane(Scene& scene, taut_pos anchor);

}  // namespace scenes
