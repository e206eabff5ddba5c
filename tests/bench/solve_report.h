// taut-bench --report FILE: what the solves of each island and substep left, beside what the rules decided for it, as
// CSV. A line for each island with rows and substep; columns as kReportHelp says.
#pragma once

#include <taut/taut.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace bench {

extern const char* const kReportHelp;

class SolveReportFile {
public:
    // Throws std::runtime_error where it cannot be written.
    explicit SolveReportFile(const std::string& path);
    // Of the last step of a world whose def asks for reports.
    void add(taut_world world, uint32_t frame);

private:
    std::string path_;
    std::ofstream out_;
};

}  // namespace bench
