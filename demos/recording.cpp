#include "recording.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace demo {

std::vector<char> read_recording(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file || bytes.empty()) throw std::runtime_error(path + " cannot be read");
    return bytes;
}

std::string told(const taut_replay_state& state) {
    const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
    char text[400];
    if (state.status == TAUT_REPLAY_DIFFERS) {
        std::snprintf(text, sizeof text,
                      "differs in frame %llu, call %llu, %s, at byte %llu: %s is %llx, recorded as %llx",
                      number(state.frame), number(state.call), state.function, number(state.offset), state.difference,
                      number(state.found), number(state.expected));
        return text;
    }
    std::snprintf(text, sizeof text, "the same: %llu frames, %llu calls", number(state.frame), number(state.call));
    std::string whole = text;
    if (!state.whole)
        whole += std::string("\nthe recording has no end: the last call that is whole in it is ") +
                 (state.function ? state.function : "none");
    return whole;
}

nlohmann::ordered_json json_of(const std::string& file, uint32_t threads, const taut_replay_state& state) {
    nlohmann::ordered_json out;
    out["file"] = file;
    out["threads"] = threads;
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

}  // namespace demo
