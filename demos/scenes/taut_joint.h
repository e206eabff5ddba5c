// A scene's joints through Taut's C API.
#pragma once

#include "scene.h"

namespace scenes {

// housing: null unless the kind has one.
taut_result add_joint(taut_world world, const Joint& joint, taut_body a, taut_body b, taut_body housing, uint64_t index,
                      taut_joint* out);

}  // namespace scenes
