#include <taut/profile.h>

#include "api/sized.h"

using namespace taut;

taut_result taut_world_set_profile_scopes(taut_world handle, taut_profile_scope_fn scope, void* user_data) {
    return with_world(__func__, handle, Use::alone, [&](World& world) {
        world.scopes.set(scope, user_data);
        world.team.tell_scopes(scope ? &world.scopes : nullptr);
        return TAUT_OK;
    });
}

taut_result taut_world_get_profile(taut_world handle, taut_profile* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    if (!check.struct_size(out->struct_size, sizeof *out, alignof(taut_profile))) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        taut_profile profile = world.profile;
        profile.bytes = held_bytes(world);
        give_def(profile, out);
        return TAUT_OK;
    });
}
