#include "obj_file.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "scene.h"

namespace scenes {

namespace {

[[noreturn]] void refuse(const std::string& path, int line, const std::string& why) {
    throw BadFile(path + ":" + std::to_string(line) + ": " + why);
}

// What the loader doesn't tell: the line of each piece and of each vertex that is no number.
struct Lines {
    std::map<std::string, int> of_piece;
    int first_face = 0, last = 0;
};

Lines scan_lines(const std::string& path, const std::string& text) {
    Lines lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        ++lines.last;
        if (line.find('\0') != std::string::npos) refuse(path, lines.last, "binary data, not an OBJ file");
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "o" || key == "g") {
            std::string name;
            std::getline(words >> std::ws, name);
            while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back()))) name.pop_back();
            lines.of_piece.try_emplace(name, lines.last);
        }
        if (key == "f" && lines.first_face == 0) lines.first_face = lines.last;
        if (key != "v") continue;
        for (int axis = 0; axis < 3; ++axis) {
            std::string word;
            words >> word;
            char* end = nullptr;
            double value = std::strtod(word.c_str(), &end);
            if (word.empty() || *end != '\0') refuse(path, lines.last, "a vertex needs three numbers: '" + line + "'");
            if (!std::isfinite(value) || std::fabs(value) > 1e30)
                refuse(path, lines.last, "a vertex is not finite: '" + line + "'");
        }
    }
    return lines;
}

std::string read_text(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse(path, 1, std::string("cannot be read: ") + std::strerror(errno));
    if (std::filesystem::is_directory(path)) refuse(path, 1, "cannot be read: it is a folder");
    std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (file.bad()) refuse(path, 1, "cannot be read: read error");
    return text;
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

}  // namespace

std::vector<ObjPiece> read_obj(const std::string& path) {
    std::string text = read_text(path);
    if (text.empty()) refuse(path, 1, "the file is empty");
    Lines lines = scan_lines(path, text);
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    if (!reader.ParseFromString(text, "", config))
        refuse(path, lines.first_face, "not a usable OBJ file: " + one_line(reader.Error()));
    const std::vector<tinyobj::real_t>& vertices = reader.GetAttrib().vertices;
    std::vector<ObjPiece> pieces;
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        if (shape.mesh.indices.empty()) continue;
        ObjPiece piece;
        piece.name = shape.name;
        auto line = lines.of_piece.find(shape.name);
        piece.line = line == lines.of_piece.end() ? lines.first_face : line->second;
        std::set<int> used;
        for (const tinyobj::index_t& index : shape.mesh.indices) {
            if (index.vertex_index < 0 || 3 * static_cast<size_t>(index.vertex_index) + 2 >= vertices.size())
                refuse(path, piece.line, "a face of '" + piece.name + "' names a vertex that does not exist");
            used.insert(index.vertex_index);
        }
        for (int vertex : used) {
            const auto* v = &vertices[3 * static_cast<size_t>(vertex)];
            piece.points.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
        }
        pieces.push_back(std::move(piece));
    }
    if (pieces.empty()) refuse(path, lines.last, "no faces up to the end of the file");
    return pieces;
}

}  // namespace scenes
