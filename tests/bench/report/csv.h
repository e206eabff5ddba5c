// CSV files of the report, and lines that tell how far it is.
#pragma once

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace bench {

namespace fs = std::filesystem;

class Csv {
public:
    Csv(const fs::path& path, const char* header) : file_(path), name_(path.filename().string()) {
        file_.precision(6);
        file_ << header << '\n';
    }
    // The file is checked where it ends: a full disk must not pass for a report.
    ~Csv() noexcept(false) {
        file_.close();
        if (!file_ && std::uncaught_exceptions() == 0) throw std::runtime_error("could not write " + name_);
    }
    Csv(const Csv&) = delete;
    Csv& operator=(const Csv&) = delete;

    template <class First, class... Rest>
    void row(const First& first, const Rest&... rest) {
        file_ << first;
        ((file_ << ',' << rest), ...);
        file_ << '\n';
    }

private:
    std::ofstream file_;
    std::string name_;
};

template <class... Values>
void say(const char* format, Values... values) {
    std::fprintf(stderr, format, values...);
}

inline std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

}  // namespace bench
