#include <taut/record.h>

#include "api/replay.h"
#include "api/sized.h"
#include "record/recorder.h"

using namespace taut;

void taut_record_def_init_sized(taut_record_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_record_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.hashes = TAUT_RECORD_HASH_STEPS;
    });
}

taut_result taut_world_record(taut_world handle, const taut_record_def* given) {
    Check check(__func__);
    taut_record_def def;
    if (!take_def(check, given, taut_record_def_init, def)) return check.result();
    if (!check.choice("hashes", def.hashes, TAUT_RECORD_HASH_CALLS)
             .require(def.write != nullptr, "write is null", TAUT_NULL_POINTER))
        return check.result();
    return with_world(check.call(), handle, Use::alone, [&](World& world) {
        if (is_within_recording(world.id)) return refuse_hold(check.call(), "world", TAUT_LOCKED);
        check.require(!is_recorded(world), "the world is recorded already")
            .require(is_as_created(world), "calls have changed the world, or tried to, since it was created");
        if (!check) return check.result();
        if (!start_recording(world, def))
            return refuse(TAUT_UNSUPPORTED, "%s: write did not take the head of the recording", check.call());
        return TAUT_OK;
    });
}

taut_result taut_world_end_recording(taut_world handle) {
    Check check(__func__);
    return with_world(check.call(), handle, Use::alone, [&](World& world) {
        if (is_within_recording(world.id)) return refuse_hold(check.call(), "world", TAUT_LOCKED);
        if (!check.require(is_recorded(world), "the world is not recorded")) return check.result();
        end_recording(world);
        return TAUT_OK;
    });
}

void taut_replay_def_init_sized(taut_replay_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_replay_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.threads = 1;
    });
}

taut_result taut_replay_open(const taut_replay_def* given, taut_world* out) {
    Check check(__func__);
    taut_replay_def def;
    if (!check.pointer("out", out) || !take_def(check, given, taut_replay_def_init, def)) return check.result();
    if (!check.pointer("bytes", def.bytes)
             .require(!def.hooks.allocate == !def.hooks.free,
                      "hooks.allocate and hooks.free: one is null, expected both or neither"))
        return check.result();
    return contain(check.call(), [&] { return open_replay(check.call(), def, *out); });
}

taut_result taut_replay_next_sized(taut_world world, taut_replay_state* first, uint32_t size) {
    const RecordOut<taut_replay_state> out(first, size);
    Check check("taut_replay_next");
    if (!check.pointer("out", out)) return check.result();
    return contain(check.call(), [&] {
        taut_replay_state state{};
        const taut_result result = next_of_replay(check.call(), world, state);
        if (result == TAUT_OK) *out = state;
        return result;
    });
}
