// taut-replay: plays a recording (taut/record.h) and tells the first frame that differs.
#include <taut/taut.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

enum ExitCode { kSame = 0, kDiffers = 1, kNoRecording = 2 };

struct Options {
    std::string file, json;
    uint32_t threads = 1;
};

void print_log(taut_log_level level, const char* text, void*) {
    if (level != TAUT_LOG_INFO) std::fprintf(stderr, "taut: %s\n", text);
}

nlohmann::ordered_json json_of(const Options& options, const taut_replay_state& state) {
    nlohmann::ordered_json out;
    out["file"] = options.file;
    out["threads"] = options.threads;
    out["same"] = state.status == TAUT_REPLAY_ENDED;
    out["whole"] = state.whole != 0;
    out["frames"] = state.frame;
    out["calls"] = state.call;
    if (state.function) out["last_call"] = state.function;
    if (state.status != TAUT_REPLAY_DIFFERS) return out;
    out["difference"] = state.difference;
    out["byte"] = state.offset;
    out["recorded"] = state.expected;
    out["found"] = state.found;
    return out;
}

void print(const taut_replay_state& state) {
    const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
    if (state.status == TAUT_REPLAY_DIFFERS) {
        std::printf("differs in frame %llu, call %llu, %s, at byte %llu: %s is %llx, recorded as %llx\n",
                    number(state.frame), number(state.call), state.function, number(state.offset), state.difference,
                    number(state.found), number(state.expected));
        return;
    }
    std::printf("the same: %llu frames, %llu calls\n", number(state.frame), number(state.call));
    if (!state.whole)
        std::printf("the recording has no end: the last call that is whole in it is %s\n",
                    state.function ? state.function : "none");
}

int play(const Options& options) {
    std::ifstream file(options.file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file || bytes.empty()) {
        std::fprintf(stderr, "taut-replay: %s cannot be read\n", options.file.c_str());
        return kNoRecording;
    }
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
    print(state);
    if (!options.json.empty()) {
        std::ofstream out(options.json);
        if (!(out << json_of(options, state).dump(2) << '\n' << std::flush)) {
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
    return play(options);
}
