// Recordings as files, and what became of a replay, as text and JSON.
#pragma once

#include <taut/taut.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace demo {

// All of a file. Throws std::runtime_error if it cannot be read or is empty.
std::vector<char> read_recording(const std::string& path);

// "the same: 60 frames, 75 calls", or where it differs, in a line or two.
std::string told(const taut_replay_state& state);
nlohmann::ordered_json json_of(const std::string& file, uint32_t threads, const taut_replay_state& state);

}  // namespace demo
