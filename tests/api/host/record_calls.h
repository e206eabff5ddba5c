// Calls of record.h.
#pragma once

#include "host.h"
#include "recording.h"

namespace taut_test {

class RecordCalls : protected virtual Host {
protected:
    void record_new(size_t w) override {
        recordings_[w].bytes.clear();
        if (one_in(4)) record(w);
    }
    // Of a world that is not as created.
    void record_any() {
        const size_t w = pick_world();
        record(w);
        if (one_in(16) && !created_)
            run("taut_world_end_recording", [&] { return taut_world_end_recording(worlds_[w]); });
        const uint32_t keep = one_in(16) ? word() | 1 : 1;
        run("taut_bake_keep_defs", [&] { return taut_bake_keep_defs(keep); });
    }

    // What an own world was recorded to be, as it is or damaged.
    void replay_any() {
        const std::vector<unsigned char> bytes = short_recording();
        taut_replay_def def;
        taut_replay_def_init(&def);
        spoil(def.struct_size);
        def.threads = one_in(16) ? byte() : 1;
        def.bytes = one_in(32) ? nullptr : bytes.data();
        def.size = bytes.size();
        taut_world world = {0};
        if (!run("taut_replay_open", [&] { return taut_replay_open(&def, &world); })) return;
        taut_replay_state state{};
        const taut_world played = one_in(8) ? worlds_[pick_world()] : world;
        while (run("taut_replay_next", [&] { return taut_replay_next(played, &state); }) &&
               state.status == TAUT_REPLAY_STEPPED) {
        }
        expect(state.frame <= 3, "frames that are not recorded");
        expect(taut_world_destroy(world) == TAUT_OK, "a replay that does not end");
    }

private:
    void record(size_t w) {
        taut_record_def def = recordings_[w].def(static_cast<taut_record_hashes>(byte() % (one_in(16) ? 4 : 3)));
        spoil(def.struct_size);
        if (one_in(16)) def.write = nullptr;
        run("taut_world_record", [&] { return taut_world_record(worlds_[w], &def); });
    }
    std::vector<unsigned char> short_recording() {
        taut_world_def def;
        taut_world_def_init(&def);
        taut_world world = {0};
        Recording recording;
        const taut_record_def how = recording.def(TAUT_RECORD_HASH_CALLS);
        if (taut_world_create(&def, &world) != TAUT_OK || taut_world_record(world, &how) != TAUT_OK)
            expect(false, taut_last_error());
        taut_particle_def particle;
        taut_particle_def_init(&particle);
        particle.position = pos(10);
        taut_body body = {0};
        taut_world_add_particle(world, &particle, &body);
        for (int i = 0; i < 3; ++i) taut_world_step(world);
        taut_world_destroy(world);
        std::vector<unsigned char>& bytes = recording.bytes;
        if (one_in(4)) bytes.resize(word() % bytes.size());
        if (one_in(4) && !bytes.empty()) bytes[word() % bytes.size()] ^= static_cast<unsigned char>(1 << byte() % 8);
        if (bytes.empty()) bytes.push_back(0);
        return bytes;
    }

    Recording recordings_[2];
};

}  // namespace taut_test
