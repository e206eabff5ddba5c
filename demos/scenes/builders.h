// The build functions of all families; catalogue.cpp lists them. n and r are the numbers in the scene's name.
#pragma once

#include "catalogue.h"

namespace scenes {

Scene build_main(double n, double r, const Options& options);

Scene build_boxes2000(double n, double r, const Options& options);
Scene build_pyramid(double n, double r, const Options& options);
Scene build_stack(double n, double r, const Options& options);
Scene build_heavy_on_light(double n, double r, const Options& options);
Scene build_deep_start(double n, double r, const Options& options);
Scene build_hulls(double n, double r, const Options& options);
Scene build_grains(double n, double r, const Options& options);
Scene build_grains_box(double n, double r, const Options& options);
Scene build_shapes(double n, double r, const Options& options);
Scene build_terrain(double n, double r, const Options& options);
Scene build_mesh_drop(double n, double r, const Options& options);

Scene build_chain(double n, double r, const Options& options);
Scene build_swing(double n, double r, const Options& options);
Scene build_chain_over_edge(double n, double r, const Options& options);
Scene build_wrecking_ball(double n, double r, const Options& options);

Scene build_cable(double n, double r, const Options& options);
Scene build_falling_cable(double n, double r, const Options& options);

Scene build_crane(double n, double r, const Options& options);
Scene build_cable_drum(double n, double r, const Options& options);
Scene build_bridge(double n, double r, const Options& options);
Scene build_bridge_breaking(double n, double r, const Options& options);
Scene build_hinges(double n, double r, const Options& options);
Scene build_ragdolls(double n, double r, const Options& options);
Scene build_ragdoll_liana(double n, double r, const Options& options);
Scene build_ferris_wheel(double n, double r, const Options& options);
Scene build_car(double n, double r, const Options& options);
Scene build_gears(double n, double r, const Options& options);
Scene build_tensegrity(double n, double r, const Options& options);
Scene build_net(double n, double r, const Options& options);
Scene build_rain(double n, double r, const Options& options);
Scene build_static_grid(double n, double r, const Options& options);
Scene build_tipping(double n, double r, const Options& options);
Scene build_joint_grid(double n, double r, const Options& options);
Scene build_crowd(double n, double r, const Options& options);
Scene build_washer(double n, double r, const Options& options);
Scene build_convex_mesh(double n, double r, const Options& options);
Scene build_cloth_hang(double n, double r, const Options& options);
Scene build_cloth_row(double n, double r, const Options& options);
Scene build_cloth_load(double n, double r, const Options& options);
Scene build_beam(double n, double r, const Options& options);
Scene build_solid_drop(double n, double r, const Options& options);
Scene build_tangled_cube(double n, double r, const Options& options);
Scene build_cube_stretch(double n, double r, const Options& options);
Scene build_film_ball(double n, double r, const Options& options);
Scene build_film_balls(double n, double r, const Options& options);
Scene build_film_ring(double n, double r, const Options& options);
Scene build_film_hole(double n, double r, const Options& options);
Scene build_film_squeeze(double n, double r, const Options& options);
Scene build_film_stack(double n, double r, const Options& options);
Scene build_film_tori(double n, double r, const Options& options);
Scene build_armadillo(double n, double r, const Options& options);
Scene build_armadillos(double n, double r, const Options& options);
Scene build_cloth_loaded(double n, double r, const Options& options);
Scene build_cloth_fem_beside_links(double n, double r, const Options& options);
Scene build_trampoline(double n, double r, const Options& options);
Scene build_garment(double n, double r, const Options& options);
Scene build_bow(double n, double r, const Options& options);
Scene build_quads(double n, double r, const Options& options);
Scene build_plastic_bar(double n, double r, const Options& options);
Scene build_plastic_bar_n(double n, double r, const Options& options);
Scene build_meshless(double n, double r, const Options& options);
Scene build_tearing_flag(double n, double r, const Options& options);
Scene build_knee(double n, double r, const Options& options);
Scene build_bunnies_on_cloth(double n, double r, const Options& options);
Scene build_dragon_on_stairs(double n, double r, const Options& options);
Scene build_cow_falls(double n, double r, const Options& options);
Scene build_torus_self(double n, double r, const Options& options);
Scene build_soft_pile(double n, double r, const Options& options);
Scene build_soft_pile_n(double n, double r, const Options& options);
Scene build_drape_sphere(double n, double r, const Options& options);
Scene build_cloth_on_sphere(double n, double r, const Options& options);
Scene build_cloth_twist(double n, double r, const Options& options);
Scene build_cloth_fold(double n, double r, const Options& options);
Scene build_flag_in_wind(double n, double r, const Options& options);
Scene build_garment_on_body(double n, double r, const Options& options);
Scene build_ragdoll_on_trampoline(double n, double r, const Options& options);
Scene build_grains_on_cloth(double n, double r, const Options& options);
Scene build_grains_through_mesh(double n, double r, const Options& options);
Scene build_sand_on_table(double n, double r, const Options& options);
Scene build_sack(double n, double r, const Options& options);
Scene build_soft_car(double n, double r, const Options& options);
Scene build_tyre(double n, double r, const Options& options);
Scene build_cloth_file(double n, double r, const Options& options);
Scene build_solid_file(double n, double r, const Options& options);
Scene build_robot(double n, double r, const Options& options);

}  // namespace scenes
