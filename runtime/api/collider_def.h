// Colliders from their defs, as bodies, particles and the calls of collider.h make them.
#pragma once

#include "api/access.h"

namespace taut {

constexpr taut_material kDefaultMaterial{0.5f, 0, TAUT_COMBINE_DEFAULT, TAUT_COMBINE_DEFAULT, 0, 0};
constexpr taut_filter kDefaultFilter{1, UINT64_MAX, 0, 0};

// What a refusal calls the fields of a material.
struct MaterialNames {
    const char *friction, *restitution, *friction_rule, *restitution_rule, *rolling_friction, *spinning_friction;
};
constexpr MaterialNames kMaterialAlone{"friction",         "restitution",      "friction_rule",
                                       "restitution_rule", "rolling_friction", "spinning_friction"};
constexpr MaterialNames kMaterialInDef{"material.friction",         "material.restitution",
                                       "material.friction_rule",    "material.restitution_rule",
                                       "material.rolling_friction", "material.spinning_friction"};

Check& check_material(Check& check, const MaterialNames& names, const taut_material& material);
// Flags and contact events of a collider, in the def that holds them.
Check& check_asks(Check& check, const char* flags_field, uint32_t flags, uint32_t contact_events);
Check& check_collider_def(Check& check, const taut_collider_def& def);

// The collider that a checked def asks for on a body of this kind, but for its node; its shape is looked up.
taut_result make_collider(Check& check, const World& world, NodeKind kind, const taut_collider_def& def,
                          ColliderPlan& out);

}  // namespace taut
