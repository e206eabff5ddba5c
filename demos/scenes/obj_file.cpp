#include "obj_file.h"

#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

#include "scene.h"
#include "text_file.h"

namespace scenes {

namespace {

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
        if (line.find('\0') != std::string::npos) refuse_file(path, lines.last, "binary data, not an OBJ file");
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
            if (word.empty() || *end != '\0')
                refuse_file(path, lines.last, "a vertex needs three numbers: '" + line + "'");
            if (!std::isfinite(value) || std::fabs(value) > 1e30)
                refuse_file(path, lines.last, "a vertex is not finite: '" + line + "'");
        }
    }
    return lines;
}

std::string one_line(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

tinyobj::ObjReader parse(const std::string& path, Lines& lines) {
    const std::string text = read_text(path);
    lines = scan_lines(path, text);
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    if (!reader.ParseFromString(text, "", config))
        refuse_file(path, lines.first_face, "not a usable OBJ file: " + one_line(reader.Error()));
    return reader;
}

// Vertices by where they are, so that seams of texture or of groups do not part a surface.
struct ByPlace {
    bool operator()(const taut_pos& a, const taut_pos& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

}  // namespace

std::vector<ObjPiece> read_obj(const std::string& path) {
    Lines lines;
    const tinyobj::ObjReader reader = parse(path, lines);
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
                refuse_file(path, piece.line, "a face of '" + piece.name + "' names a vertex that does not exist");
            used.insert(index.vertex_index);
        }
        for (int vertex : used) {
            const auto* v = &vertices[3 * static_cast<size_t>(vertex)];
            piece.points.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
        }
        pieces.push_back(std::move(piece));
    }
    if (pieces.empty()) refuse_file(path, lines.last, "no faces up to the end of the file");
    return pieces;
}

Surface read_surface(const std::string& path) {
    Lines lines;
    const tinyobj::ObjReader reader = parse(path, lines);
    const tinyobj::attrib_t& attributes = reader.GetAttrib();
    Surface surface;
    std::map<taut_pos, uint32_t, ByPlace> place;
    bool textured = !attributes.texcoords.empty();
    const auto vertex = [&](const tinyobj::index_t& index) {
        if (index.vertex_index < 0 || 3 * static_cast<size_t>(index.vertex_index) + 2 >= attributes.vertices.size())
            refuse_file(path, lines.first_face, "a face names a vertex that does not exist");
        const auto* v = &attributes.vertices[3 * static_cast<size_t>(index.vertex_index)];
        const auto [found, is_new] =
            place.emplace(taut_pos{static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])},
                          static_cast<uint32_t>(surface.points.size()));
        if (is_new) {
            surface.points.push_back(found->first);
            const size_t t = 2 * static_cast<size_t>(std::max(index.texcoord_index, 0));
            textured = textured && index.texcoord_index >= 0 && t + 1 < attributes.texcoords.size();
            if (textured)
                for (size_t i = 0; i < 2; ++i) surface.uv.push_back(static_cast<float>(attributes.texcoords[t + i]));
        }
        return found->second;
    };
    for (const tinyobj::shape_t& shape : reader.GetShapes()) {
        size_t first = 0;
        for (const auto size : shape.mesh.num_face_vertices) {
            std::vector<uint32_t> face;
            for (size_t k = 0; k < size; ++k) face.push_back(vertex(shape.mesh.indices[first + k]));
            first += size;
            for (size_t k = 2; k < face.size(); ++k) {
                if (face[0] == face[k - 1] || face[k - 1] == face[k] || face[k] == face[0]) continue;
                surface.triangles.insert(surface.triangles.end(), {face[0], face[k - 1], face[k]});
            }
        }
    }
    if (surface.triangles.empty()) refuse_file(path, lines.last, "no faces up to the end of the file");
    if (!textured) surface.uv.clear();
    return surface;
}

}  // namespace scenes
