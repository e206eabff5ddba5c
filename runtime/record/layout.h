// What the interface's structs consist of, for recordings: for each one list of its fields, layout(visitor, struct). It
// binds all fields by name, so that a new one does not compile until it stands here. Visitors are in codec.h. Each
// takes numbers, enumerations, handles, arrays of these, and structs with a list; sized(struct) is true where a struct
// that says its own size may be read, up to that; array(pointer, count, most) takes the content of a host's array,
// which no call reads where it has more elements than that.
#pragma once

#include <cstdint>

#include <taut/taut.h>

#include "base/describe.h"

namespace taut {

template <class V, Like<taut_pos> T>
void layout(V& visit, T& of) {
    auto& [x, y, z] = of;
    visit(x, y, z);
}
template <class V, Like<taut_vec3> T>
void layout(V& visit, T& of) {
    auto& [x, y, z] = of;
    visit(x, y, z);
}
template <class V, Like<taut_quat> T>
void layout(V& visit, T& of) {
    auto& [x, y, z, w] = of;
    visit(x, y, z, w);
}
template <class V, Like<taut_sym3> T>
void layout(V& visit, T& of) {
    auto& [xx, yy, zz, xy, xz, yz] = of;
    visit(xx, yy, zz, xy, xz, yz);
}
template <class V, Like<taut_pose> T>
void layout(V& visit, T& of) {
    auto& [position, rotation, reserved] = of;
    visit(position, rotation, reserved);
}
template <class V, Like<taut_frame> T>
void layout(V& visit, T& of) {
    auto& [position, rotation] = of;
    visit(position, rotation);
}
template <class V, Like<taut_material> T>
void layout(V& visit, T& of) {
    auto& [friction, restitution, friction_rule, restitution_rule, rolling_friction, spinning_friction] = of;
    visit(friction, restitution, friction_rule, restitution_rule, rolling_friction, spinning_friction);
}
template <class V, Like<taut_friction> T>
void layout(V& visit, T& of) {
    auto& [static_friction, slide_factor, slide_direction, reserved] = of;
    visit(static_friction, slide_factor, slide_direction, reserved);
}
template <class V, Like<taut_filter> T>
void layout(V& visit, T& of) {
    auto& [category, mask, group, reserved] = of;
    visit(category, mask, group, reserved);
}

// ---------------------------------------------------------------- worlds

// Results do not depend on threads, and hooks are the host's own.
template <class V, Like<taut_world_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, solver, gravity, time_step, substeps, fixed_substeps, sweeps, geometric_stiffness,
           velocity_filter, max_catch_up, threads, hooks, sleeping, sleep_speed, sleep_time, contact_events, hit_speed,
           continuous, max_bodies, max_colliders, max_joints, max_contacts, adaptive_damping, restitution_threshold,
           stepping, stabilisation, relaxation, friction_model, momentum, fixed_step, scheme, newmark_beta,
           newmark_gamma, report, air_density, air_pressure, wind, minimise_tolerance, line_search,
           contact_stabilisation, velocity_gain] = of;
    if (const auto whole = visit.sized(of)) {
        visit(solver, gravity, time_step, substeps, fixed_substeps, sweeps, geometric_stiffness, velocity_filter,
              max_catch_up, sleeping, sleep_speed, sleep_time, contact_events, hit_speed, continuous, max_bodies,
              max_colliders, max_joints, max_contacts, adaptive_damping, restitution_threshold, stepping, stabilisation,
              relaxation, friction_model, momentum, fixed_step, scheme, newmark_beta, newmark_gamma, report,
              air_density, air_pressure, wind, minimise_tolerance, line_search, contact_stabilisation, velocity_gain);
    }
}

// ---------------------------------------------------------------- shapes

template <class V, Like<taut_plane_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, normal] = of;
    if (const auto whole = visit.sized(of)) visit(normal);
}
template <class V, Like<taut_box_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, half_extents] = of;
    if (const auto whole = visit.sized(of)) visit(half_extents);
}
template <class V, Like<taut_sphere_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, radius] = of;
    if (const auto whole = visit.sized(of)) visit(radius);
}
template <class V, Like<taut_capsule_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, radius, half_length] = of;
    if (const auto whole = visit.sized(of)) visit(radius, half_length);
}
template <class V, Like<taut_cylinder_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, radius, half_length] = of;
    if (const auto whole = visit.sized(of)) visit(radius, half_length);
}
template <class V, Like<taut_cone_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, radius, half_length] = of;
    if (const auto whole = visit.sized(of)) visit(radius, half_length);
}
template <class V, Like<taut_tapered_capsule_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, bottom_radius, top_radius, half_length] = of;
    if (const auto whole = visit.sized(of)) visit(bottom_radius, top_radius, half_length);
}
template <class V, Like<taut_scaled_hull_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, hull, scale] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, hull, scale);
}
template <class V, Like<taut_hull_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, point_count, points] = of;
    if (const auto whole = visit.sized(of)) {
        visit(point_count);
        visit.array(points, point_count, UINT32_MAX);
    }
}
template <class V, Like<taut_mesh_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, vertex_count, vertices, indices, triangle_count, two_sided] = of;
    if (const auto whole = visit.sized(of)) {
        visit(vertex_count, triangle_count, two_sided);
        visit.array(vertices, vertex_count, UINT32_MAX);
        visit.array(indices, 3 * uint64_t{triangle_count}, 3 * uint64_t{TAUT_MESH_MAX_TRIANGLES});
    }
}
template <class V, Like<taut_height_field_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, rows, columns, row_spacing, column_spacing, reserved, heights] = of;
    if (const auto whole = visit.sized(of)) {
        visit(rows, columns, row_spacing, column_spacing, reserved);
        constexpr uint64_t kMost = TAUT_HEIGHT_FIELD_MAX_SIDE;
        const bool fits = rows <= kMost && columns <= kMost;
        visit.array(heights, uint64_t{rows} * columns, fits ? kMost * kMost : 0);
    }
}

// ---------------------------------------------------------------- bodies

template <class V, Like<taut_collider_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, density, shape, position, rotation, material, filter, user_data, flags, contact_events, one_way,
           reserved, friction] = of;
    if (const auto whole = visit.sized(of))
        visit(density, shape, position, rotation, material, filter, user_data, flags, contact_events, one_way, reserved,
              friction);
}
template <class V, Like<taut_body_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, kind, position, rotation, linear_velocity, angular_velocity, shape, material, filter, density,
           mass, centre_of_mass, inertia, gravity_scale, collider_count, user_data, colliders, collider_flags,
           contact_events, linear_damping, angular_damping, max_linear_speed, max_angular_speed, locked_axes] = of;
    if (const auto whole = visit.sized(of)) {
        visit(kind, position, rotation, linear_velocity, angular_velocity, shape, material, filter, density, mass,
              centre_of_mass, inertia, gravity_scale, collider_count, user_data, collider_flags, contact_events,
              linear_damping, angular_damping, max_linear_speed, max_angular_speed, locked_axes);
        visit.defs(colliders, collider_count);
    }
}
template <class V, Like<taut_particle_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, mass, position, velocity, gravity_scale, user_data, shape, material, filter, collider_flags,
           contact_events, damping, max_speed] = of;
    if (const auto whole = visit.sized(of)) {
        visit(mass, position, velocity, gravity_scale, user_data, shape, material, filter, collider_flags,
              contact_events, damping, max_speed);
    }
}

// ---------------------------------------------------------------- joints and attachments

template <class V, Like<taut_drive> T>
void layout(V& visit, T& of) {
    auto& [target, speed, stiffness, damping, frequency, damping_ratio, max_force] = of;
    visit(target, speed, stiffness, damping, frequency, damping_ratio, max_force);
}
template <class V, Like<taut_axis_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, mode, lower, upper, stop_compliance, stop_damping, drive, friction] = of;
    if (const auto whole = visit.sized(of)) visit(mode, lower, upper, stop_compliance, stop_damping, drive, friction);
}
template <class V, Like<taut_joint_base> T>
void layout(V& visit, T& of) {
    auto& [body_a, body_b, frame_a, frame_b, compliance, damping, angular_compliance, angular_damping, break_force,
           break_torque, solve, collide_connected, user_data, reserved] = of;
    visit(body_a, body_b, frame_a, frame_b, compliance, damping, angular_compliance, angular_damping, break_force,
          break_torque, solve, collide_connected, user_data, reserved);
}
template <class V, Like<taut_ball_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base);
}
template <class V, Like<taut_distance_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, length, base, min_length, max_length, frequency, damping_ratio, drive, friction] = of;
    if (const auto whole = visit.sized(of))
        visit(length, base, min_length, max_length, frequency, damping_ratio, drive, friction);
}
template <class V, Like<taut_fixed_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base);
}
template <class V, Like<taut_hinge_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, angle] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, angle);
}
template <class V, Like<taut_slider_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, slide] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, slide);
}
template <class V, Like<taut_cylindrical_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, slide, angle] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, slide, angle);
}
template <class V, Like<taut_universal_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, angle_a, angle_b] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, angle_a, angle_b);
}
template <class V, Like<taut_cone_twist_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, swing, twist] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, swing, twist);
}
template <class V, Like<taut_six_dof_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, axes] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, axes);
}
template <class V, Like<taut_wheel_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, reserved, base, suspension, steering, spin] = of;
    if (const auto whole = visit.sized(of)) visit(reserved, base, suspension, steering, spin);
}
template <class V, Like<taut_gear_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, ratio, base, housing, housing_frame_a, housing_frame_b] = of;
    if (const auto whole = visit.sized(of)) visit(ratio, base, housing, housing_frame_a, housing_frame_b);
}
template <class V, Like<taut_rack_pinion_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, ratio, base, housing, housing_frame_a, housing_frame_b] = of;
    if (const auto whole = visit.sized(of)) visit(ratio, base, housing, housing_frame_a, housing_frame_b);
}
template <class V, Like<taut_pulley_joint_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, rigid, base, housing, housing_frame_a, housing_frame_b, ratio, length] = of;
    if (const auto whole = visit.sized(of))
        visit(rigid, base, housing, housing_frame_a, housing_frame_b, ratio, length);
}
template <class V, Like<taut_anchor> T>
void layout(V& visit, T& of) {
    auto& [count, reserved, bodies, points, weights] = of;
    visit(count, reserved, bodies, points, weights);
}
template <class V, Like<taut_attachment_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, kind, a, b, length, compliance, damping, break_force, break_torque, collide_connected, solve,
           pulls, limit, limit_compliance, user_data] = of;
    if (const auto whole = visit.sized(of)) {
        visit(kind, a, b, length, compliance, damping, break_force, break_torque, collide_connected, solve, pulls,
              limit, limit_compliance, user_data);
    }
}

// ---------------------------------------------------------------- cables, cloths and solids

template <class V, Like<taut_cable_end_def> T>
void layout(V& visit, T& of) {
    auto& [attached, clamped, body, anchor] = of;
    visit(attached, clamped, body, anchor);
}
template <class V, Like<taut_cable_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, kind, end, points, point_count, segment_count, segment_length, length, diameter, mass_per_metre,
           stretch_compliance, stretch_damping, bending_stiffness, bending_damping, material, filter, self_collision,
           gravity_scale, user_data] = of;
    if (const auto whole = visit.sized(of)) {
        visit(kind, end, point_count, segment_count, segment_length, length, diameter, mass_per_metre,
              stretch_compliance, stretch_damping, bending_stiffness, bending_damping, material, filter, self_collision,
              gravity_scale, user_data);
        visit.array(points, point_count, TAUT_CABLE_MAX_SEGMENTS + 1);
    }
}
template <class V, Like<taut_cloth_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, kind, points, rest, point_count, triangle_count, triangles, quads, quad_count, strain,
           plane_strain, uv, area_density, thickness, stretch_stiffness, shear_stiffness, poisson_ratio,
           bending_stiffness, stretch_compliance, shear_compliance, bend_compliance, damping, mass_damping,
           stiffness_damping, compression, strain_limit, limit_compliance, tethers, tether_slack, tear_strain, air_drag,
           air_lift, pressure, gas, gravity_scale, solve, stretch_tolerance, material, self_collision, filter,
           user_data] = of;
    if (const auto whole = visit.sized(of)) {
        visit(kind, point_count, triangle_count, quad_count, strain, plane_strain, area_density, thickness,
              stretch_stiffness, shear_stiffness, poisson_ratio, bending_stiffness, stretch_compliance,
              shear_compliance, bend_compliance, damping, mass_damping, stiffness_damping, compression, strain_limit,
              limit_compliance, tethers, tether_slack, tear_strain, air_drag, air_lift, pressure, gas, gravity_scale,
              solve, stretch_tolerance, material, self_collision, filter, user_data);
        constexpr uint64_t kMost = TAUT_DEFORMABLE_MAX;
        visit.array(points, point_count, kMost);
        visit.array(rest, point_count, kMost);
        visit.array(triangles, 3 * uint64_t{triangle_count}, 3 * kMost);
        visit.array(quads, 4 * uint64_t{quad_count}, 4 * kMost);
        visit.array(uv, 2 * uint64_t{point_count}, 2 * kMost);
    }
}
template <class V, Like<taut_solid_def> T>
void layout(V& visit, T& of) {
    auto& [struct_size, material, points, rest, point_count, cell_count, cells, corners, sample_count, samples,
           sample_volumes, triangles, triangle_count, neighbour_radius, density, young_modulus, poisson_ratio, damping,
           mass_damping, stiffness_damping, thickness, air_drag, air_lift, yield_stress, creep, hardening,
           plastic_limit, orthotropic, gravity_scale, solve, surface, self_collision, filter, user_data] = of;
    if (const auto whole = visit.sized(of)) {
        auto& [young_moduli, poisson_ratios, shear_moduli, axes, axes_of_cells] = orthotropic;
        visit(material, point_count, cell_count, corners, sample_count, triangle_count, neighbour_radius, density,
              young_modulus, poisson_ratio, damping, mass_damping, stiffness_damping, thickness, air_drag, air_lift,
              yield_stress, creep, hardening, plastic_limit, young_moduli, poisson_ratios, shear_moduli, axes,
              gravity_scale, solve, surface, self_collision, filter, user_data);
        constexpr uint64_t kMost = TAUT_DEFORMABLE_MAX;
        visit.array(points, point_count, kMost);
        visit.array(rest, point_count, kMost);
        visit.array(cells, uint64_t{cell_count} * corners, corners <= 8 ? kMost * corners : 0);
        visit.array(samples, sample_count, kMost);
        visit.array(sample_volumes, sample_count, kMost);
        visit.array(triangles, 3 * uint64_t{triangle_count}, 3 * kMost);
        visit.array(axes_of_cells, cell_count, kMost);
    }
}

}  // namespace taut
