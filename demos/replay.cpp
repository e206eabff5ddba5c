// taut-replay: plays a recording (taut/record.h) and tells the first frame that differs.
#include <taut/taut.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "recording.h"

namespace {

enum ExitCode { kSame = 0, kDiffers = 1, kNoRecording = 2 };

struct Options {
    std::string file, json;
    uint32_t threads = 1;
};

void print_log(taut_log_level level, const char* text, void*) {
    if (level != TAUT_LOG_INFO) std::fprintf(stderr, "taut: %s\n", text);
}

int play(const Options& options) {
    const std::vector<char> bytes = demo::read_recording(options.file);
    taut_replay_def def;
    taut_replay_def_init(&def);
    def.bytes = bytes.data();
    def.size = bytes.size();
    def.threads = options.threads;
    def.hooks.log = print_log;
    taut_world world{};
    taut_replay_state state{};
    taut_result result = taut_replay_open(&def, &world);
    while (result == TAUT_OK && state.status == TAUT_REPLAY_STEPPED) result = taut_replay_next(world, &state);
    if (result != TAUT_OK) std::fprintf(stderr, "taut-replay: %s: %s\n", options.file.c_str(), taut_last_error());
    if (world.bits != 0) taut_world_destroy(world);
    if (result != TAUT_OK) return kNoRecording;
    std::printf("%s\n", demo::told(state).c_str());
    if (!options.json.empty()) {
        std::ofstream out(options.json);
        if (!(out << demo::json_of(options.file, options.threads, state).dump(2) << '\n' << std::flush)) {
            std::fprintf(stderr, "taut-replay: %s cannot be written\n", options.json.c_str());
            return kNoRecording;
        }
    }
    return state.status == TAUT_REPLAY_ENDED ? kSame : kDiffers;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app{
        "Plays a recording of a Taut world and tells the first frame that differs.\n"
        "Exit codes: 0 the same, 1 it differs, 2 bad arguments, no recording, or one that cannot be played."};
    app.add_option("file", options.file, "recording, as taut_world_record wrote it")->required();
    app.add_option("--threads", options.threads, "threads of a step")->check(CLI::Range(1, 64));
    app.add_option("--json", options.json, "also write what came out to this file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error, std::cout, std::cerr) == 0 ? kSame : kNoRecording;
    }
    try {
        return play(options);
    } catch (const std::runtime_error& error) {
        std::fprintf(stderr, "taut-replay: %s\n", error.what());
        return kNoRecording;
    }
}
