// Recordings of the tests: kept in memory, played again, and left as files where something is wrong with them.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <taut/taut.h>

namespace taut_test {

struct Recording {
    std::vector<unsigned char> bytes;
    size_t most = SIZE_MAX;  // bytes that it takes

    taut_record_def def(taut_record_hashes hashes = TAUT_RECORD_HASH_STEPS) {
        taut_record_def out;
        taut_record_def_init(&out);
        out.hashes = hashes;
        out.user_data = this;
        out.write = [](const void* from, uint64_t size, void* self) -> int32_t {
            Recording& own = *static_cast<Recording*>(self);
            if (own.bytes.size() + size > own.most) return 0;
            const auto* const first = static_cast<const unsigned char*>(from);
            own.bytes.insert(own.bytes.end(), first, first + size);
            return 1;
        };
        return out;
    }
    // Where a bug report finds it.
    std::string leave(const std::string& name) const {
        const std::string path = name + ".taut";
        if (std::FILE* file = std::fopen(path.c_str(), "wb")) {
            std::fwrite(bytes.data(), 1, bytes.size(), file);
            std::fclose(file);
        }
        return path;
    }
};

// Recordings of worlds as files PREFIX_0.taut and so on, written at once, so that they outlive the process.
class RecordingFiles {
public:
    explicit RecordingFiles(std::string prefix) : prefix_(std::move(prefix)) {}
    ~RecordingFiles() {
        for (std::FILE* file : files_) std::fclose(file);
    }
    RecordingFiles(const RecordingFiles&) = delete;
    RecordingFiles& operator=(const RecordingFiles&) = delete;

    bool add(taut_world world) {
        std::FILE* const file = std::fopen((prefix_ + "_" + std::to_string(files_.size()) + ".taut").c_str(), "wb");
        if (!file) return false;
        files_.push_back(file);
        taut_record_def def;
        taut_record_def_init(&def);
        def.hashes = TAUT_RECORD_HASH_CALLS;
        def.user_data = file;
        def.write = [](const void* from, uint64_t size, void* to) -> int32_t {
            std::FILE* const out = static_cast<std::FILE*>(to);
            return std::fwrite(from, 1, size, out) == size && std::fflush(out) == 0;
        };
        return taut_world_record(world, &def) == TAUT_OK;
    }

private:
    std::string prefix_;
    std::vector<std::FILE*> files_;
};

// A world that plays bytes, which outlive it.
class Replay {
public:
    explicit Replay(const std::vector<unsigned char>& bytes, uint32_t threads = 1) {
        taut_replay_def def;
        taut_replay_def_init(&def);
        def.bytes = bytes.data();
        def.size = bytes.size();
        def.threads = threads;
        result = taut_replay_open(&def, &world);
    }
    ~Replay() {
        if (world.bits != 0) taut_world_destroy(world);
    }
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    // One frame. False: there is none more.
    bool next() {
        if (result == TAUT_OK) result = taut_replay_next(world, &state);
        return result == TAUT_OK && state.status == TAUT_REPLAY_STEPPED;
    }
    Replay& play() {
        while (next()) {
        }
        return *this;
    }
    bool is_same() const { return result == TAUT_OK && state.status == TAUT_REPLAY_ENDED; }
    // What is to be said about it.
    std::string text() const {
        if (result != TAUT_OK) return taut_last_error();
        char out[300];
        std::snprintf(out, sizeof out, "%s in frame %llu, call %llu, %s: recorded %llx, found %llx",
                      state.difference ? state.difference : "nothing differs",
                      static_cast<unsigned long long>(state.frame), static_cast<unsigned long long>(state.call),
                      state.function ? state.function : "", static_cast<unsigned long long>(state.expected),
                      static_cast<unsigned long long>(state.found));
        return out;
    }

    taut_world world{};
    taut_result result = TAUT_OK;
    taut_replay_state state{};
};

}  // namespace taut_test
