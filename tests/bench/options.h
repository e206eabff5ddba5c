// What taut-bench is asked on its command line.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace bench {

enum ExitCode { kFine = 0, kRunFailed = 1, kBadArguments = 2 };

struct Options {
    std::string scene, engine = "taut";
    std::optional<uint32_t> steps, substeps;
    double rate = 60;  // steps a second
    std::optional<std::string> solver;
    uint32_t threads = 1;
    uint64_t seed = 0;
    bool geometric_stiffness = true;
    bool adaptive_damping = false;
    bool sleep = false;
    bool cold = false;
    uint32_t warm_up = 0;
    double spike_limit = 0;
    uint32_t runs = 1;
    std::string beside;
    double ratio_limit = 0;
    std::string report;
    std::string mesh;
    bool swept = false;
    bool from_point = false;
    bool line_search = true;
};

// Nothing: *exit_code says with what to end. Throws scenes::BadScene for what contradicts itself.
std::optional<Options> read_options(int argc, char** argv, int* exit_code);

}  // namespace bench
