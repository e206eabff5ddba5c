#include "text_file.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scene.h"

namespace scenes {

void refuse_file(const std::string& path, int line, const std::string& why) {
    throw BadFile(path + ":" + std::to_string(line) + ": " + why);
}

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse_file(path, 1, std::string("cannot be read: ") + std::strerror(errno));
    if (std::filesystem::is_directory(path)) refuse_file(path, 1, "cannot be read: it is a folder");
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (file.bad()) refuse_file(path, 1, "cannot be read: read error");
    if (text.empty()) refuse_file(path, 1, "the file is empty");
    return text;
}

WordLines::WordLines(std::string path, char comment)
    : path_(std::move(path)), text_(read_text(path_)), comment_(comment) {}

bool WordLines::next() {
    for (std::string line; std::getline(text_, line);) {
        ++line_;
        if (line.find('\0') != std::string::npos) refuse("binary data, not a text file");
        if (comment_ != 0) line.resize(std::min(line.size(), line.find(comment_)));
        std::istringstream stream(line);
        words_.clear();
        for (std::string word; stream >> word;) words_.push_back(word);
        if (!words_.empty()) return true;
    }
    words_.clear();
    return false;
}

void WordLines::need(const char* what) {
    if (!next()) refuse(std::string("the file ends before ") + what);
}

double WordLines::number(size_t i, const char* what) const {
    constexpr double kMost = 1e6;
    if (i >= size()) refuse(std::string(what) + " is missing");
    char* end = nullptr;
    const double value = std::strtod(words_[i].c_str(), &end);
    if (*end != '\0') refuse(std::string(what) + " is not a number: '" + words_[i] + "'");
    if (!(std::fabs(value) <= kMost)) refuse(std::string(what) + " is not within 1e6: '" + words_[i] + "'");
    return value;
}

uint64_t WordLines::count(size_t i, const char* what, uint64_t largest) const {
    if (i >= size()) refuse(std::string(what) + " is missing");
    const std::string& word = words_[i];
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value > largest)
        refuse(std::string(what) + " is not a whole number from 0 to " + std::to_string(largest) + ": '" + word + "'");
    return value;
}

}  // namespace scenes
