// Defaults of the structs that lie within others and have no struct_size.
#include <taut/attachment.h>
#include <taut/body.h>
#include <taut/collider.h>
#include <taut/joint.h>
#include <taut/query.h>

#include <cmath>

#include "api/collider_def.h"

namespace {

template <class Value>
void give_value(Value* out, const Value& value) {
    if (out) *out = value;
}

}  // namespace

void taut_hooks_init(taut_hooks* hooks) { give_value(hooks, {}); }
void taut_pose_init(taut_pose* pose) { give_value(pose, {{}, taut::kUnturned, {}}); }
void taut_material_init(taut_material* material) { give_value(material, taut::kDefaultMaterial); }
void taut_filter_init(taut_filter* filter) { give_value(filter, taut::kDefaultFilter); }
void taut_friction_init(taut_friction* friction) { give_value(friction, {}); }
void taut_frame_init(taut_frame* frame) { give_value(frame, {{}, taut::kUnturned}); }
void taut_drive_init(taut_drive* drive) { give_value(drive, {0, 0, 0, 0, 0, 1, INFINITY}); }
void taut_joint_base_init(taut_joint_base* base) {
    taut_joint_base own{};
    own.frame_a.rotation = own.frame_b.rotation = taut::kUnturned;
    own.solve = TAUT_JOINT_SOLVE_BY_LOAD;
    give_value(base, own);
}
void taut_anchor_init(taut_anchor* anchor) { give_value(anchor, {}); }
void taut_ray_init(taut_ray* ray) { give_value(ray, {}); }
void taut_shape_cast_init(taut_shape_cast* cast) { give_value(cast, {{}, {{}, taut::kUnturned, {}}, {}, 0}); }
