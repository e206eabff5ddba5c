// Command line of taut-demo.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace demo {

struct Options {
    std::string scene = "main";
    std::string mesh;
    bool swept = false;
    bool from_point = false;
    bool line_search = true;
    std::optional<uint32_t> frames;  // else the scene's own number
    uint32_t every = 1;              // draws the last of each so many frames
    uint32_t from = 1;               // draws none before
    std::string out;                 // folder of the PNG frames, empty: none
    std::string video, json;         // files, empty: none
    std::string gltf, csv;           // likewise
    std::string record;              // file of a recording, likewise
    std::string replay;              // the recording that is played in place of a scene, likewise
    int width = 1280, height = 720;
    uint32_t threads = 1;
    uint64_t seed = 0;
    std::optional<uint32_t> substeps;
    std::optional<std::string> solver;
    bool render = true;
    bool hud = true;
    bool contacts = false;
    bool curves = false;
    bool sleep = false;           // what came to rest sleeps, and is drawn darker
    bool follow = false;          // the camera keeps all that moves in its frame
    bool compare = false;         // beside it the same scene without geometric stiffness
    std::optional<bool> tension;  // else on for scenes with joints
};

// Reads the command line. Returns no options when the program is done already (--help, --list, bad arguments),
// with its exit code in *exit_code.
std::optional<Options> read_options(int argc, char** argv, int* exit_code);

}  // namespace demo
