// The calls that a recording holds: each function of the interface that changes a world, and taut_world_save, whose
// bytes a restoration brings back. Recorder and player are both made of this list by the parameters of each function.
//
// A function that changes a world owes a line here, and one that begins its definition: TAUT_RECORD(function, its
// parameters). What lacks the second is told by the recording itself (see note_change), what lacks the first does not
// compile. Files name their calls by name: the order here may change.
#pragma once

#include <cstdint>

#define TAUT_RECORDED_CALLS(X)            \
    X(taut_world_add_attachment)          \
    X(taut_attachment_remove)             \
    X(taut_attachment_set_user_data)      \
    X(taut_attachment_set_compliance)     \
    X(taut_attachment_set_length)         \
    X(taut_attachment_set_break)          \
    X(taut_world_add_body)                \
    X(taut_world_add_particle)            \
    X(taut_body_remove)                   \
    X(taut_body_set_user_data)            \
    X(taut_body_set_kind)                 \
    X(taut_body_set_enabled)              \
    X(taut_body_set_name)                 \
    X(taut_body_set_mass)                 \
    X(taut_body_set_damping)              \
    X(taut_body_set_gravity_scale)        \
    X(taut_body_set_max_speed)            \
    X(taut_body_set_locked_axes)          \
    X(taut_body_set_material)             \
    X(taut_body_set_contact_events)       \
    X(taut_body_set_pose)                 \
    X(taut_body_set_velocity)             \
    X(taut_body_move_kinematic)           \
    X(taut_body_set_continuous)           \
    X(taut_body_apply_force)              \
    X(taut_body_apply_force_at)           \
    X(taut_body_apply_impulse)            \
    X(taut_body_apply_impulse_at)         \
    X(taut_body_release)                  \
    X(taut_world_add_cable)               \
    X(taut_cable_remove)                  \
    X(taut_cable_cut)                     \
    X(taut_cable_set_reel_speed)          \
    X(taut_cable_reel)                    \
    X(taut_world_add_cloth)               \
    X(taut_cloth_remove)                  \
    X(taut_cloth_set_contact_events)      \
    X(taut_cloth_set_pre_solve)           \
    X(taut_cloth_pin)                     \
    X(taut_cloth_set_pressure)            \
    X(taut_body_add_collider)             \
    X(taut_collider_remove)               \
    X(taut_body_set_mass_from_colliders)  \
    X(taut_collider_set_user_data)        \
    X(taut_collider_set_shape)            \
    X(taut_collider_set_material)         \
    X(taut_collider_set_friction)         \
    X(taut_collider_set_filter)           \
    X(taut_collider_set_density)          \
    X(taut_collider_set_surface_velocity) \
    X(taut_collider_set_contact_events)   \
    X(taut_collider_set_pre_solve)        \
    X(taut_collider_set_one_way)          \
    X(taut_world_add_ball_joint)          \
    X(taut_world_add_distance_joint)      \
    X(taut_world_add_fixed_joint)         \
    X(taut_world_add_hinge_joint)         \
    X(taut_world_add_slider_joint)        \
    X(taut_world_add_cylindrical_joint)   \
    X(taut_world_add_universal_joint)     \
    X(taut_world_add_cone_twist_joint)    \
    X(taut_world_add_six_dof_joint)       \
    X(taut_world_add_wheel_joint)         \
    X(taut_world_add_gear_joint)          \
    X(taut_world_add_rack_pinion_joint)   \
    X(taut_world_add_pulley_joint)        \
    X(taut_joint_remove)                  \
    X(taut_joint_set_user_data)           \
    X(taut_joint_set_axis)                \
    X(taut_joint_set_target)              \
    X(taut_joint_set_compliance)          \
    X(taut_joint_set_angular_compliance)  \
    X(taut_joint_set_break)               \
    X(taut_joint_set_length)              \
    X(taut_joint_set_ratio)               \
    X(taut_joint_set_housing_frames)      \
    X(taut_joint_set_solve)               \
    X(taut_joint_set_frames)              \
    X(taut_joint_set_enabled)             \
    X(taut_joint_set_collide_connected)   \
    X(taut_world_set_pre_solve)           \
    X(taut_collider_set_sensor)           \
    X(taut_world_add_plane)               \
    X(taut_world_add_box)                 \
    X(taut_world_add_sphere)              \
    X(taut_world_add_capsule)             \
    X(taut_world_add_hull)                \
    X(taut_world_add_cylinder)            \
    X(taut_world_add_cone)                \
    X(taut_world_add_tapered_capsule)     \
    X(taut_world_add_scaled_hull)         \
    X(taut_world_add_mesh)                \
    X(taut_world_add_height_field)        \
    X(taut_world_add_baked)               \
    X(taut_shape_add_scaled)              \
    X(taut_shape_sample_distance)         \
    X(taut_shape_remove)                  \
    X(taut_body_set_awake)                \
    X(taut_body_set_can_sleep)            \
    X(taut_world_wake_box)                \
    X(taut_world_save)                    \
    X(taut_world_restore)                 \
    X(taut_world_add_solid)               \
    X(taut_solid_remove)                  \
    X(taut_solid_set_contact_events)      \
    X(taut_solid_set_pre_solve)           \
    X(taut_solid_pin)                     \
    X(taut_solid_recover)                 \
    X(taut_world_step)                    \
    X(taut_world_advance_sized)           \
    X(taut_world_relax_sized)             \
    X(taut_world_set_time_step)           \
    X(taut_world_set_substeps)            \
    X(taut_world_set_gravity)             \
    X(taut_world_set_wind)                \
    X(taut_world_set_contact_events)      \
    X(taut_world_set_hit_speed)           \
    X(taut_world_set_restitution_threshold)

namespace taut {

// Enumerators have the names of functions.
enum class Call : uint16_t {
#define TAUT_CALL(function) function,
    TAUT_RECORDED_CALLS(TAUT_CALL)
#undef TAUT_CALL
        count
};

// After these the state is another in a way that their arguments do not show: a frame of a recording.
constexpr bool is_step(Call call) {
    return call == Call::taut_world_step || call == Call::taut_world_advance_sized ||
           call == Call::taut_world_relax_sized || call == Call::taut_world_restore;
}

}  // namespace taut
