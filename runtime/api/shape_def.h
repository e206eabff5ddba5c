// What the calls that add shapes have in common.
#pragma once

#include <taut/shape.h>

#include "api/sized.h"

namespace taut {

// def: as this library knows it.
template <class Def>
bool take_shape_def(Check& check, const Def* given, void (*init)(Def*), Def& def, taut_shape* out) {
    return check.pointer("def", given).pointer("out", out) && take_def(check, given, init, def);
}

inline taut_result insert_shape(const Check& check, World& world, collision::Shape shape, taut_shape* out) {
    if (world.shapes.ids.slots() >= Shapes::kInner) return refuse(TAUT_LIMIT, "%s: too many shapes", check.call());
    *out = world.shape_handle(world.shapes.add(std::move(shape)));
    return TAUT_OK;
}

inline taut_result add_shape(const Check& check, taut_world handle, collision::Shape shape, taut_shape* out) {
    return with_world(check.call(), handle, Use::write,
                      [&](World& world) { return insert_shape(check, world, std::move(shape), out); });
}

template <class Def>
void init_shape_def(Def* def, Def defaults) {
    if (!def) return;
    *def = defaults;
    def->struct_size = sizeof *def;
}

}  // namespace taut
