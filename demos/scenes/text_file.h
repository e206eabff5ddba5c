// Text files of meshes, read line by line: what is wrong is told with file and line.
#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace scenes {

// Throws BadFile "path:line: why".
[[noreturn]] void refuse_file(const std::string& path, int line, const std::string& why);

// All of a file. Throws BadFile where it cannot be read or is empty.
std::string read_text(const std::string& path);

// The words of a file's lines.
class WordLines {
public:
    // comment: from this character on a line is left out; 0: never.
    WordLines(std::string path, char comment);

    bool next();  // to the next line with words; false at the end
    size_t size() const { return words_.size(); }
    const std::string& operator[](size_t i) const { return words_[i]; }
    // Words as numbers. Throw BadFile where there is no such word, or where it is not one in range.
    double number(size_t i, const char* what) const;                     // finite, within 1e6
    uint64_t count(size_t i, const char* what, uint64_t largest) const;  // from 0
    [[noreturn]] void refuse(const std::string& why) const { refuse_file(path_, line_, why); }
    void need(const char* what);  // next(); a file that ends before it is refused

private:
    std::string path_;
    std::istringstream text_;
    char comment_;
    int line_ = 0;
    std::vector<std::string> words_;
};

}  // namespace scenes
