#include <taut/profile.h>

#include "api/access.h"

using namespace taut;

taut_result taut_world_get_profile(taut_world handle, taut_profile* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    if (!check.struct_size(out->struct_size, sizeof *out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *out = world.profile;
        out->struct_size = sizeof *out;
        out->bytes = held_bytes(world);
        return TAUT_OK;
    });
}
