// Every function of the interface that takes a handle, with arguments that are right but for the handle: what a table
// of handles or a locked world is held against.
#pragma once

#include <functional>
#include <vector>

#include "joint_support.h"

namespace taut_test {

template <class Handle>
struct Call {
    const char* name;
    std::function<taut_result(Handle)> run;
};

inline const taut_pose kIdentity = {{0, 0, 0}, {0, 0, 0, 1}, {0, 0}};
inline const taut_ray kDown = {{0, 5, 0}, {0, -10, 0}, 0};

// What a def needs is in the populated world, which the calls need not be made on.
inline std::vector<Call<taut_world>> world_calls(const Populated& p) {
    return {
        {"taut_world_step", [](taut_world w) { return taut_world_step(w); }},
        {"taut_world_wake_box",
         [](taut_world w) {
             return taut_world_wake_box(w, {-1, -1, -1}, {1, 1, 1});
         }},
        {"taut_world_advance", [](taut_world w) { return taut_world_advance(w, 0, nullptr); }},
        {"taut_world_relax", [](taut_world w) { return taut_world_relax(w, 1, 1, nullptr); }},
        {"taut_world_get_gravity",
         [](taut_world w) {
             taut_vec3 out;
             return taut_world_get_gravity(w, &out);
         }},
        {"taut_world_set_gravity",
         [](taut_world w) {
             return taut_world_set_gravity(w, {0, -1, 0});
         }},
        {"taut_world_get_wind",
         [](taut_world w) {
             taut_vec3 out;
             return taut_world_get_wind(w, &out);
         }},
        {"taut_world_set_wind",
         [](taut_world w) {
             return taut_world_set_wind(w, {0, 1, 0});
         }},
        {"taut_world_get_counts", [](taut_world w) { return taut_world_get_counts(w, nullptr, nullptr, nullptr); }},
        {"taut_world_get_bodies",
         [](taut_world w) {
             static taut_body out[1024];
             uint32_t count;
             return taut_world_get_bodies(w, out, 1024, &count);
         }},
        {"taut_world_get_joints",
         [](taut_world w) {
             static taut_joint out[256];
             uint32_t count;
             return taut_world_get_joints(w, out, 256, &count);
         }},
        {"taut_world_get_shapes",
         [](taut_world w) {
             static taut_shape out[256];
             uint32_t count;
             return taut_world_get_shapes(w, out, 256, &count);
         }},
        {"taut_world_get_bytes",
         [](taut_world w) {
             uint64_t out;
             return taut_world_get_bytes(w, &out);
         }},
        {"taut_world_get_state_hash",
         [](taut_world w) {
             uint64_t out;
             return taut_world_get_state_hash(w, &out);
         }},
        {"taut_world_snapshot_size",
         [](taut_world w) {
             uint64_t out;
             return taut_world_snapshot_size(w, &out);
         }},
        {"taut_world_save",
         [](taut_world w) {
             static unsigned char buffer[1 << 18];
             uint64_t out;
             return taut_world_save(w, buffer, sizeof buffer, &out);
         }},
        {"taut_world_restore", [&p](taut_world w) { return taut_world_restore(w, p.saved.data(), p.saved.size()); }},
        {"taut_world_get_profile",
         [](taut_world w) {
             taut_profile out;
             out.struct_size = sizeof out;
             return taut_world_get_profile(w, &out);
         }},
        {"taut_world_get_events",
         [](taut_world w) {
             taut_events out;
             return taut_world_get_events(w, &out);
         }},
        {"taut_world_set_time_step", [](taut_world w) { return taut_world_set_time_step(w, 0.01f); }},
        {"taut_world_set_substeps", [](taut_world w) { return taut_world_set_substeps(w, 3); }},
        {"taut_world_set_contact_events", [](taut_world w) { return taut_world_set_contact_events(w, 1); }},
        {"taut_world_set_hit_speed", [](taut_world w) { return taut_world_set_hit_speed(w, 2); }},
        {"taut_world_set_restitution_threshold",
         [](taut_world w) { return taut_world_set_restitution_threshold(w, 0.5f); }},
        {"taut_world_set_pre_solve", [](taut_world w) { return taut_world_set_pre_solve(w, nullptr, nullptr); }},
        {"taut_world_get_contacts",
         [](taut_world w) {
             taut_contact out[64];
             uint32_t count;
             return taut_world_get_contacts(w, out, 64, &count);
         }},
        {"taut_world_add_plane",
         [](taut_world w) {
             taut_plane_def def;
             taut_plane_def_init(&def);
             taut_shape out;
             return taut_world_add_plane(w, &def, &out);
         }},
        {"taut_world_add_box",
         [](taut_world w) {
             taut_box_def def;
             taut_box_def_init(&def);
             taut_shape out;
             return taut_world_add_box(w, &def, &out);
         }},
        {"taut_world_add_sphere",
         [](taut_world w) {
             taut_sphere_def def;
             taut_sphere_def_init(&def);
             taut_shape out;
             return taut_world_add_sphere(w, &def, &out);
         }},
        {"taut_world_add_capsule",
         [](taut_world w) {
             taut_capsule_def def;
             taut_capsule_def_init(&def);
             taut_shape out;
             return taut_world_add_capsule(w, &def, &out);
         }},
        {"taut_world_add_cylinder",
         [](taut_world w) {
             taut_cylinder_def def;
             taut_cylinder_def_init(&def);
             taut_shape out;
             return taut_world_add_cylinder(w, &def, &out);
         }},
        {"taut_world_add_cone",
         [](taut_world w) {
             taut_cone_def def;
             taut_cone_def_init(&def);
             taut_shape out;
             return taut_world_add_cone(w, &def, &out);
         }},
        {"taut_world_add_tapered_capsule",
         [](taut_world w) {
             taut_tapered_capsule_def def;
             taut_tapered_capsule_def_init(&def);
             taut_shape out;
             return taut_world_add_tapered_capsule(w, &def, &out);
         }},
        {"taut_world_add_scaled_hull",
         [&p](taut_world w) {
             taut_scaled_hull_def def;
             taut_scaled_hull_def_init(&def);
             def.hull = p.hull;
             taut_shape out;
             return taut_world_add_scaled_hull(w, &def, &out);
         }},
        {"taut_world_add_hull",
         [](taut_world w) {
             const taut_vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
             taut_hull_def def;
             taut_hull_def_init(&def);
             def.points = points;
             def.point_count = 4;
             taut_shape out;
             return taut_world_add_hull(w, &def, &out);
         }},
        {"taut_world_add_mesh",
         [](taut_world w) {
             taut_shape out;
             return make_mesh(w, &out);
         }},
        {"taut_world_add_height_field",
         [](taut_world w) {
             taut_shape out;
             return make_height_field(w, &out);
         }},
        {"taut_world_add_body",
         [&p](taut_world w) {
             const taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0, 50, 0);
             taut_body out;
             return taut_world_add_body(w, &def, &out);
         }},
        {"taut_world_add_particle",
         [](taut_world w) {
             taut_particle_def def;
             taut_particle_def_init(&def);
             taut_body out;
             return taut_world_add_particle(w, &def, &out);
         }},
        {"taut_world_add_ball_joint",
         [&p](taut_world w) {
             taut_ball_joint_def def;
             taut_ball_joint_def_init(&def);
             def.base.body_a = p.crate;
             taut_joint out;
             return taut_world_add_ball_joint(w, &def, &out);
         }},
        {"taut_world_add_distance_joint",
         [&p](taut_world w) {
             taut_distance_joint_def def;
             taut_distance_joint_def_init(&def);
             def.base.body_a = p.crate;
             def.base.frame_b.position = {0, 20, 0};
             taut_joint out;
             return taut_world_add_distance_joint(w, &def, &out);
         }},
        {"taut_world_add_fixed_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_fixed_joint_def, taut_fixed_joint_def_init, taut_world_add_fixed_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_hinge_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_hinge_joint_def, taut_hinge_joint_def_init, taut_world_add_hinge_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_slider_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_slider_joint_def, taut_slider_joint_def_init, taut_world_add_slider_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_universal_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_universal_joint_def, taut_universal_joint_def_init, taut_world_add_universal_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_cylindrical_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_cylindrical_joint_def, taut_cylindrical_joint_def_init,
                               taut_world_add_cylindrical_joint>(w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0),
                                                                 &out);
         }},
        {"taut_world_add_cone_twist_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_cone_twist_joint_def, taut_cone_twist_joint_def_init,
                               taut_world_add_cone_twist_joint>(w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0),
                                                                &out);
         }},
        {"taut_world_add_six_dof_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_six_dof_joint_def, taut_six_dof_joint_def_init, taut_world_add_six_dof_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_wheel_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_wheel_joint_def, taut_wheel_joint_def_init, taut_world_add_wheel_joint>(
                 w, p.crate, {0}, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_gear_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_gear_joint_def, taut_gear_joint_def_init, taut_world_add_gear_joint>(
                 w, p.crate, p.wedge, frame(0, 0, 0), frame(0, 0.5, 0), &out);
         }},
        {"taut_world_add_rack_pinion_joint",
         [&p](taut_world w) {
             taut_joint out;
             return add_framed<taut_rack_pinion_joint_def, taut_rack_pinion_joint_def_init,
                               taut_world_add_rack_pinion_joint>(w, p.crate, p.wedge, frame(0, 0, 0), frame(0, 0.5, 0),
                                                                 &out);
         }},
        {"taut_world_add_pulley_joint",
         [&p](taut_world w) {
             taut_pulley_joint_def def;
             taut_pulley_joint_def_init(&def);
             def.base.body_a = p.crate, def.base.body_b = p.wedge;
             taut_joint out;
             return taut_world_add_pulley_joint(w, &def, &out);
         }},
        {"taut_joint_frames_from_two_axes",
         [&p](taut_world w) {
             taut_frame a, b;
             return taut_joint_frames_from_two_axes(w, p.crate, {0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, &a, &b);
         }},
        {"taut_joint_frames_from_world",
         [&p](taut_world w) {
             taut_frame a, b;
             return taut_joint_frames_from_world(w, p.crate, {0}, {0, 0, 0}, {1, 0, 0}, &a, &b);
         }},
        {"taut_world_get_body_states",
         [&p](taut_world w) {
             taut_pose out;
             return taut_world_get_body_states(w, &p.crate, 1, &out, 0, nullptr, 0, nullptr, 0);
         }},
        {"taut_world_cast_ray",
         [](taut_world w) {
             taut_query_hit out;
             return taut_world_cast_ray(w, &kDown, nullptr, &out);
         }},
        {"taut_world_cast_ray_all",
         [](taut_world w) {
             taut_query_hit out[8];
             uint32_t count;
             return taut_world_cast_ray_all(w, &kDown, nullptr, out, 8, &count);
         }},
        {"taut_world_cast_ray_any",
         [](taut_world w) {
             int32_t out;
             return taut_world_cast_ray_any(w, &kDown, nullptr, &out);
         }},
        {"taut_world_cast_rays",
         [](taut_world w) {
             taut_query_hit out;
             return taut_world_cast_rays(w, &kDown, 1, nullptr, &out);
         }},
        {"taut_world_cast_shape",
         [&p](taut_world w) {
             const taut_shape_cast cast = {p.box, kIdentity, {0, -1, 0}, 0};
             taut_query_hit out;
             return taut_world_cast_shape(w, &cast, nullptr, &out);
         }},
        {"taut_world_cast_shape_all",
         [&p](taut_world w) {
             const taut_shape_cast cast = {p.box, kIdentity, {0, -1, 0}, 0};
             taut_query_hit out[8];
             uint32_t count;
             return taut_world_cast_shape_all(w, &cast, nullptr, out, 8, &count);
         }},
        {"taut_world_cast_shapes",
         [&p](taut_world w) {
             const taut_shape_cast cast = {p.box, kIdentity, {0, -1, 0}, 0};
             taut_query_hit out;
             return taut_world_cast_shapes(w, &cast, 1, nullptr, &out);
         }},
        {"taut_world_overlap_shape",
         [&p](taut_world w) {
             taut_collider out[8];
             uint32_t count;
             return taut_world_overlap_shape(w, p.box, &kIdentity, nullptr, out, 8, &count);
         }},
        {"taut_world_overlap_point",
         [](taut_world w) {
             taut_collider out[8];
             uint32_t count;
             return taut_world_overlap_point(w, {0, 0.5, 0}, nullptr, out, 8, &count);
         }},
        {"taut_world_overlap_box",
         [](taut_world w) {
             taut_collider out[8];
             uint32_t count;
             return taut_world_overlap_box(w, {-1, -1, -1}, {1, 1, 1}, nullptr, out, 8, &count);
         }},
        {"taut_world_cast_ray_surface",
         [](taut_world w) {
             const taut_ray ray{{0, 3, 0}, {0, -4, 0}, 0};
             taut_surface_hit out;
             return taut_world_cast_ray_surface(w, &ray, nullptr, &out);
         }},
        {"taut_world_closest_surface",
         [](taut_world w) {
             taut_surface_hit out;
             return taut_world_closest_surface(w, {0, 0.5, 0}, 10, nullptr, &out);
         }},
        {"taut_world_overlap_surfaces",
         [](taut_world w) {
             taut_surface_hit out[8];
             uint32_t count;
             return taut_world_overlap_surfaces(w, {0, 0.5, 0}, 1, nullptr, out, 8, &count);
         }},
        {"taut_world_nearest_collider",
         [&p](taut_world w) {
             taut_distance out;
             return taut_world_nearest_collider(w, p.box, &kIdentity, 1, nullptr, &out);
         }},
        {"taut_world_get_def",
         [](taut_world w) {
             taut_world_def out;
             return taut_world_get_def(w, &out);
         }},
        {"taut_world_lint",
         [](taut_world w) {
             taut_lint_entry out[64];
             uint32_t count;
             return taut_world_lint(w, out, 64, &count);
         }},
        {"taut_world_destroy", [](taut_world w) { return taut_world_destroy(w); }},
    };
}

// The kind of body that each call works on is in the comment; a stale handle fails before that matters.
inline std::vector<Call<taut_body>> body_calls() {
    return {
        {"taut_body_get_awake",
         [](taut_body b) {
             uint32_t out;
             return taut_body_get_awake(b, &out);
         }},
        {"taut_body_set_awake", [](taut_body b) { return taut_body_set_awake(b, 1); }},
        {"taut_body_get_can_sleep",
         [](taut_body b) {
             uint32_t out;
             return taut_body_get_can_sleep(b, &out);
         }},
        {"taut_body_set_can_sleep", [](taut_body b) { return taut_body_set_can_sleep(b, 1); }},
        {"taut_body_set_continuous", [](taut_body b) { return taut_body_set_continuous(b, 1); }},
        {"taut_body_get_continuous",
         [](taut_body b) {
             uint32_t out = 0;
             return taut_body_get_continuous(b, &out);
         }},
        {"taut_body_release", [](taut_body b) { return taut_body_release(b); }},
        {"taut_body_get_quarantine",
         [](taut_body b) {
             taut_quarantine_reason out;
             return taut_body_get_quarantine(b, &out);
         }},
        {"taut_body_get_kind",
         [](taut_body b) {
             taut_body_kind out;
             return taut_body_get_kind(b, &out);
         }},
        {"taut_body_get_user_data",
         [](taut_body b) {
             uint64_t out;
             return taut_body_get_user_data(b, &out);
         }},
        {"taut_body_set_user_data", [](taut_body b) { return taut_body_set_user_data(b, 7); }},
        {"taut_body_get_mass",
         [](taut_body b) {
             float mass;
             taut_vec3 centre;
             taut_sym3 inertia;
             return taut_body_get_mass(b, &mass, &centre, &inertia);
         }},
        {"taut_body_get_material",
         [](taut_body b) {
             taut_material out;
             return taut_body_get_material(b, &out);
         }},
        {"taut_body_set_material",
         [](taut_body b) {
             taut_material material = {};
             material.friction = 0.5f;
             return taut_body_set_material(b, &material);
         }},
        {"taut_body_set_contact_events", [](taut_body b) { return taut_body_set_contact_events(b, 3); }},
        {"taut_body_get_pose",
         [](taut_body b) {
             taut_pose out;
             return taut_body_get_pose(b, &out);
         }},
        {"taut_body_set_pose", [](taut_body b) { return taut_body_set_pose(b, &kIdentity); }},
        {"taut_body_set_enabled", [](taut_body b) { return taut_body_set_enabled(b, 1); }},
        {"taut_body_get_enabled",
         [](taut_body b) {
             uint32_t out;
             return taut_body_get_enabled(b, &out);
         }},
        {"taut_body_set_name", [](taut_body b) { return taut_body_set_name(b, "body"); }},
        {"taut_body_get_name",
         [](taut_body b) {
             char out[TAUT_BODY_NAME_SIZE];
             uint32_t count;
             return taut_body_get_name(b, out, sizeof out, &count);
         }},
        {"taut_body_set_damping", [](taut_body b) { return taut_body_set_damping(b, 1, 0); }},
        {"taut_body_get_damping", [](taut_body b) { return taut_body_get_damping(b, nullptr, nullptr); }},
        {"taut_body_set_locked_axes", [](taut_body b) { return taut_body_set_locked_axes(b, TAUT_LOCK_X); }},
        {"taut_body_get_locked_axes",
         [](taut_body b) {
             uint32_t out;
             return taut_body_get_locked_axes(b, &out);
         }},
        {"taut_body_set_gravity_scale", [](taut_body b) { return taut_body_set_gravity_scale(b, 1); }},
        {"taut_body_get_gravity_scale",
         [](taut_body b) {
             float out;
             return taut_body_get_gravity_scale(b, &out);
         }},
        {"taut_body_set_max_speed", [](taut_body b) { return taut_body_set_max_speed(b, 100, 0); }},
        {"taut_body_get_max_speed", [](taut_body b) { return taut_body_get_max_speed(b, nullptr, nullptr); }},
        {"taut_body_set_mass",
         [](taut_body b) {
             return taut_body_set_mass(b, 1, {0, 0, 0}, {0, 0, 0, 0, 0, 0});
         }},
        {"taut_body_get_world_point",
         [](taut_body b) {
             taut_pos out;
             return taut_body_get_world_point(b, {1, 0, 0}, &out);
         }},
        {"taut_body_get_local_point",
         [](taut_body b) {
             taut_vec3 out;
             return taut_body_get_local_point(b, {1, 0, 0}, &out);
         }},
        {"taut_body_get_world_vector",
         [](taut_body b) {
             taut_vec3 out;
             return taut_body_get_world_vector(b, {1, 0, 0}, &out);
         }},
        {"taut_body_get_local_vector",
         [](taut_body b) {
             taut_vec3 out;
             return taut_body_get_local_vector(b, {1, 0, 0}, &out);
         }},
        {"taut_body_get_point_velocity",
         [](taut_body b) {
             taut_vec3 out;
             return taut_body_get_point_velocity(b, {1, 0, 0}, &out);
         }},
        {"taut_body_get_bounds",
         [](taut_body b) {
             taut_pos low, high;
             return taut_body_get_bounds(b, &low, &high);
         }},
        {"taut_body_get_joints",
         [](taut_body b) {
             taut_joint out[64];
             uint32_t count;
             return taut_body_get_joints(b, out, 64, &count);
         }},
        {"taut_body_get_contacts",
         [](taut_body b) {
             static taut_contact out[256];
             uint32_t count;
             return taut_body_get_contacts(b, out, 256, &count);
         }},
        {"taut_body_get_render_pose",
         [](taut_body b) {
             taut_pose out;
             return taut_body_get_render_pose(b, &out);
         }},
        {"taut_body_get_velocity", [](taut_body b) { return taut_body_get_velocity(b, nullptr, nullptr); }},
        {"taut_body_set_velocity",
         [](taut_body b) {
             return taut_body_set_velocity(b, {1, 0, 0}, {0, 0, 0});
         }},
        {"taut_body_move_kinematic", [](taut_body b) { return taut_body_move_kinematic(b, &kIdentity); }},
        {"taut_body_apply_force",
         [](taut_body b) {
             return taut_body_apply_force(b, {1, 0, 0}, {0, 0, 0});
         }},
        {"taut_body_apply_force_at",
         [](taut_body b) {
             return taut_body_apply_force_at(b, {1, 0, 0}, {0, 0, 0});
         }},
        {"taut_body_apply_impulse",
         [](taut_body b) {
             return taut_body_apply_impulse(b, {1, 0, 0}, {0, 0, 0});
         }},
        {"taut_body_apply_impulse_at",
         [](taut_body b) {
             return taut_body_apply_impulse_at(b, {1, 0, 0}, {0, 0, 0});
         }},
        {"taut_body_get_colliders",
         [](taut_body b) {
             taut_collider out[8];
             uint32_t count;
             return taut_body_get_colliders(b, out, 8, &count);
         }},
        {"taut_body_set_mass_from_colliders", [](taut_body b) { return taut_body_set_mass_from_colliders(b); }},
        {"taut_body_add_collider",
         [](taut_body b) {
             taut_collider_def def;
             taut_collider_def_init(&def);
             taut_collider out;
             return taut_body_add_collider(b, &def, &out);
         }},
        {"taut_body_remove", [](taut_body b) { return taut_body_remove(b); }},
    };
}

inline std::vector<Call<taut_shape>> shape_calls() {
    return {
        {"taut_shape_get_mass_properties",
         [](taut_shape s) {
             taut_mass_properties out;
             return taut_shape_get_mass_properties(s, 1000, &out);
         }},
        {"taut_shape_get_kind",
         [](taut_shape s) {
             taut_shape_kind out;
             return taut_shape_get_kind(s, &out);
         }},
        {"taut_shape_get_bounds",
         [](taut_shape s) {
             taut_vec3 low, high;
             return taut_shape_get_bounds(s, &low, &high);
         }},
        {"taut_shape_get_triangles",
         [](taut_shape s) {
             taut_vec3 out[400];
             uint32_t count;
             return taut_shape_get_triangles(s, out, 400, &count);
         }},
        {"taut_shape_add_scaled",
         [](taut_shape s) {
             taut_shape out;
             return taut_shape_add_scaled(s, {2, 1, 1}, &out);
         }},
        {"taut_shape_get_mesh_info",
         [](taut_shape s) {
             taut_mesh_info out;
             return taut_shape_get_mesh_info(s, &out);
         }},
        {"taut_shape_remove", [](taut_shape s) { return taut_shape_remove(s); }},
    };
}

inline std::vector<Call<taut_collider>> collider_calls(const Populated& p) {
    return {
        {"taut_collider_get_def",
         [](taut_collider c) {
             taut_collider_def out;
             return taut_collider_get_def(c, &out);
         }},
        {"taut_collider_get_body",
         [](taut_collider c) {
             taut_body out;
             return taut_collider_get_body(c, &out);
         }},
        {"taut_collider_get_bounds",
         [](taut_collider c) {
             taut_pos low, high;
             return taut_collider_get_bounds(c, &low, &high);
         }},
        {"taut_collider_cast_ray",
         [](taut_collider c) {
             taut_query_hit out;
             return taut_collider_cast_ray(c, &kDown, &out);
         }},
        {"taut_collider_overlap_point",
         [](taut_collider c) {
             int32_t out;
             return taut_collider_overlap_point(c, {0, 3, 0}, &out);
         }},
        {"taut_collider_get_user_data",
         [](taut_collider c) {
             uint64_t out;
             return taut_collider_get_user_data(c, &out);
         }},
        {"taut_collider_closest_point",
         [](taut_collider c) {
             taut_distance out;
             return taut_collider_closest_point(c, {0, 3, 0}, &out);
         }},
        {"taut_collider_distance",
         [](taut_collider c) {
             taut_distance out;
             return taut_collider_distance(c, c, &out);
         }},
        {"taut_collider_set_user_data", [](taut_collider c) { return taut_collider_set_user_data(c, 7); }},
        {"taut_collider_set_shape",
         [box = p.box](taut_collider c) {
             return taut_collider_set_shape(c, box, {0, 0, 0}, {0, 0, 0, 1});
         }},
        {"taut_collider_set_material",
         [](taut_collider c) {
             taut_material material = {};
             material.friction = 0.5f;
             return taut_collider_set_material(c, &material);
         }},
        {"taut_collider_set_filter",
         [](taut_collider c) {
             const taut_filter filter = {1, 1, 0, 0};
             return taut_collider_set_filter(c, &filter);
         }},
        {"taut_collider_set_contact_events", [](taut_collider c) { return taut_collider_set_contact_events(c, 15); }},
        {"taut_collider_set_pre_solve", [](taut_collider c) { return taut_collider_set_pre_solve(c, 1); }},
        {"taut_collider_set_one_way",
         [](taut_collider c) {
             return taut_collider_set_one_way(c, {0, 1, 0});
         }},
        {"taut_collider_set_sensor", [](taut_collider c) { return taut_collider_set_sensor(c, 1); }},
        {"taut_collider_get_overlaps",
         [](taut_collider c) {
             taut_collider out[16];
             uint32_t count;
             return taut_collider_get_overlaps(c, out, 16, &count);
         }},
        {"taut_collider_set_density", [](taut_collider c) { return taut_collider_set_density(c, 10); }},
        {"taut_collider_set_surface_velocity",
         [](taut_collider c) {
             return taut_collider_set_surface_velocity(c, {1, 0, 0}, {0, 2, 0});
         }},
        {"taut_collider_get_surface_velocity",
         [](taut_collider c) {
             taut_vec3 velocity, spin;
             return taut_collider_get_surface_velocity(c, &velocity, &spin);
         }},
        {"taut_collider_remove", [](taut_collider c) { return taut_collider_remove(c); }},
    };
}

inline std::vector<Call<taut_joint>> joint_calls() {
    return {
        {"taut_joint_get_kind",
         [](taut_joint j) {
             taut_joint_kind out;
             return taut_joint_get_kind(j, &out);
         }},
        {"taut_joint_get_user_data",
         [](taut_joint j) {
             uint64_t out;
             return taut_joint_get_user_data(j, &out);
         }},
        {"taut_joint_get_bodies",
         [](taut_joint j) {
             taut_body a, b;
             return taut_joint_get_bodies(j, &a, &b);
         }},
        {"taut_joint_get_anchors",
         [](taut_joint j) {
             taut_pos a, b;
             return taut_joint_get_anchors(j, &a, &b);
         }},
        {"taut_joint_get_force",
         [](taut_joint j) {
             taut_vec3 out;
             return taut_joint_get_force(j, &out);
         }},
        {"taut_joint_get_error",
         [](taut_joint j) {
             float out;
             return taut_joint_get_error(j, &out);
         }},
        {"taut_joint_set_compliance", [](taut_joint j) { return taut_joint_set_compliance(j, 1e-6f, 0); }},
        {"taut_joint_set_length", [](taut_joint j) { return taut_joint_set_length(j, 2); }},
        {"taut_joint_set_user_data", [](taut_joint j) { return taut_joint_set_user_data(j, 7); }},
        {"taut_joint_get_frames",
         [](taut_joint j) {
             taut_frame a, b;
             return taut_joint_get_frames(j, &a, &b);
         }},
        {"taut_joint_set_frames",
         [](taut_joint j) {
             const taut_frame a = frame(0, 0, 0), b = frame(0, 1, 0);
             return taut_joint_set_frames(j, &a, &b);
         }},
        {"taut_joint_get_housing",
         [](taut_joint j) {
             taut_body out;
             return taut_joint_get_housing(j, &out);
         }},
        {"taut_joint_get_housing_frames",
         [](taut_joint j) {
             taut_frame a, b;
             return taut_joint_get_housing_frames(j, &a, &b);
         }},
        {"taut_joint_set_housing_frames",
         [](taut_joint j) {
             const taut_frame a = frame(0, 0, 0), b = frame(0, 1, 0);
             return taut_joint_set_housing_frames(j, &a, &b);
         }},
        {"taut_joint_get_ratio",
         [](taut_joint j) {
             float out;
             return taut_joint_get_ratio(j, &out);
         }},
        {"taut_joint_set_ratio", [](taut_joint j) { return taut_joint_set_ratio(j, 2); }},
        {"taut_joint_get_length",
         [](taut_joint j) {
             float out;
             return taut_joint_get_length(j, &out);
         }},
        {"taut_joint_get_torque",
         [](taut_joint j) {
             taut_vec3 out;
             return taut_joint_get_torque(j, &out);
         }},
        {"taut_joint_get_angular_error",
         [](taut_joint j) {
             float out;
             return taut_joint_get_angular_error(j, &out);
         }},
        {"taut_joint_get_axis_count",
         [](taut_joint j) {
             uint32_t out;
             return taut_joint_get_axis_count(j, &out);
         }},
        {"taut_joint_get_coordinates", [](taut_joint j) { return taut_joint_get_coordinates(j, 0, nullptr, nullptr); }},
        {"taut_joint_get_axis_forces",
         [](taut_joint j) {
             taut_axis_forces out;
             return taut_joint_get_axis_forces(j, 0, &out);
         }},
        {"taut_joint_get_axis",
         [](taut_joint j) {
             taut_axis_def out;
             return taut_joint_get_axis(j, 0, &out);
         }},
        {"taut_joint_set_axis",
         [](taut_joint j) {
             const taut_axis_def def = axis_def(TAUT_AXIS_LOCKED);
             return taut_joint_set_axis(j, 0, &def);
         }},
        {"taut_joint_set_target", [](taut_joint j) { return taut_joint_set_target(j, 0, 0, 0); }},
        {"taut_joint_set_angular_compliance", [](taut_joint j) { return taut_joint_set_angular_compliance(j, 0, 0); }},
        {"taut_joint_set_break", [](taut_joint j) { return taut_joint_set_break(j, 1e9f, 0); }},
        {"taut_joint_set_solve", [](taut_joint j) { return taut_joint_set_solve(j, TAUT_JOINT_SOLVE_SOFT); }},
        {"taut_joint_set_enabled", [](taut_joint j) { return taut_joint_set_enabled(j, 1); }},
        {"taut_joint_get_enabled",
         [](taut_joint j) {
             uint32_t out;
             return taut_joint_get_enabled(j, &out);
         }},
        {"taut_joint_set_collide_connected", [](taut_joint j) { return taut_joint_set_collide_connected(j, 1); }},
        {"taut_joint_remove", [](taut_joint j) { return taut_joint_remove(j); }},
    };
}

}  // namespace taut_test
