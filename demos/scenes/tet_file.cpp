#include "tet_file.h"

#include <taut/deformable.h>

#include <algorithm>
#include <filesystem>
#include <unordered_map>

#include "scene.h"
#include "text_file.h"

namespace scenes {

namespace {

constexpr uint64_t kMostNumber = 1'000'000'000'000;  // of a point in a file

// Points by the numbers that a file gives them.
class Numbered {
public:
    void add(const WordLines& lines, uint64_t number, taut_pos point) {
        if (!place_.emplace(number, static_cast<uint32_t>(points_.size())).second)
            lines.refuse("a second point with the number " + std::to_string(number));
        if (points_.size() >= TAUT_DEFORMABLE_MAX) lines.refuse("more points than a solid may have");
        points_.push_back(point);
    }
    uint32_t place(const WordLines& lines, uint64_t number) const {
        const auto found = place_.find(number);
        if (found == place_.end()) lines.refuse("no point has the number " + std::to_string(number));
        return found->second;
    }
    size_t size() const { return points_.size(); }
    std::vector<taut_pos> points() && { return std::move(points_); }

private:
    std::vector<taut_pos> points_;
    std::unordered_map<uint64_t, uint32_t> place_;
};

taut_pos position(const WordLines& lines, size_t first) {
    return {lines.number(first, "x"), lines.number(first + 1, "y"), lines.number(first + 2, "z")};
}

// Drops points that no cell uses, and turns tetrahedra the right way round.
CellMesh tidy(std::vector<taut_pos> points, std::vector<uint32_t> cells, uint32_t corners) {
    CellMesh mesh;
    mesh.corners = corners;
    std::vector<uint32_t> place(points.size(), UINT32_MAX);
    for (const uint32_t vertex : cells) place[vertex] = 0;
    for (size_t i = 0; i < points.size(); ++i) {
        if (place[i] != 0) continue;
        place[i] = static_cast<uint32_t>(mesh.points.size());
        mesh.points.push_back(points[i]);
    }
    mesh.cells = std::move(cells);
    for (uint32_t& vertex : mesh.cells) vertex = place[vertex];
    for (size_t c = 0; corners == 4 && c < mesh.cells.size(); c += 4) {
        const taut_pos &o = mesh.points[mesh.cells[c]], &a = mesh.points[mesh.cells[c + 1]],
                       &b = mesh.points[mesh.cells[c + 2]], &d = mesh.points[mesh.cells[c + 3]];
        const double ax = a.x - o.x, ay = a.y - o.y, az = a.z - o.z, bx = b.x - o.x, by = b.y - o.y, bz = b.z - o.z,
                     dx = d.x - o.x, dy = d.y - o.y, dz = d.z - o.z;
        const double volume = ax * (by * dz - bz * dy) + ay * (bz * dx - bx * dz) + az * (bx * dy - by * dx);
        if (volume < 0) std::swap(mesh.cells[c + 2], mesh.cells[c + 3]);
    }
    return mesh;
}

// $Nodes of version 2: how many, then number x y z each. Of version 4: blocks, how many, least and largest number; each
// block's head with its size, its numbers, then its points.
void read_gmsh_nodes(WordLines& lines, int version, Numbered& nodes) {
    lines.need("the number of nodes");
    const uint64_t blocks = version == 4 ? lines.count(0, "number of blocks", TAUT_DEFORMABLE_MAX) : 1;
    const uint64_t all = lines.count(version == 4 ? 1 : 0, "number of nodes", TAUT_DEFORMABLE_MAX);
    std::vector<uint64_t> numbers;
    for (uint64_t block = 0; block < blocks; ++block) {
        uint64_t size = all;
        if (version == 4) {
            lines.need("the head of a block of nodes");
            size = lines.count(3, "size of a block", all);
            numbers.clear();
            for (uint64_t i = 0; i < size; ++i) {
                lines.need("the numbers of all nodes");
                numbers.push_back(lines.count(0, "number of a node", kMostNumber));
            }
        }
        for (uint64_t i = 0; i < size; ++i) {
            lines.need("all nodes");
            const uint64_t number = version == 4 ? numbers[i] : lines.count(0, "number of a node", kMostNumber);
            nodes.add(lines, number, position(lines, version == 4 ? 0 : 1));
        }
    }
    if (nodes.size() != all)
        lines.refuse("there are " + std::to_string(nodes.size()) + " nodes, not " + std::to_string(all));
}

// $Elements of version 2: number type tags... nodes...; of version 4: blocks with a type each, then number nodes...
void read_gmsh_elements(WordLines& lines, int version, const Numbered& nodes, std::vector<uint32_t> (&cells)[2]) {
    constexpr uint64_t kTetrahedron = 4, kHexahedron = 5, kMostType = 1000, kMost = 16 * TAUT_DEFORMABLE_MAX;
    lines.need("the number of elements");
    const uint64_t blocks = version == 4 ? lines.count(0, "number of blocks", TAUT_DEFORMABLE_MAX) : 1;
    const uint64_t all = lines.count(version == 4 ? 1 : 0, "number of elements", kMost);
    for (uint64_t block = 0; block < blocks; ++block) {
        uint64_t size = all, type = 0;
        if (version == 4) {
            lines.need("the head of a block of elements");
            type = lines.count(2, "type of a block's elements", kMostType);
            size = lines.count(3, "size of a block", all);
        }
        for (uint64_t i = 0; i < size; ++i) {
            lines.need("all elements");
            size_t first = 1;
            if (version != 4) {
                type = lines.count(1, "type of an element", kMostType);
                first = 3 + lines.count(2, "number of an element's tags", 1000);
            }
            if (type != kTetrahedron && type != kHexahedron) continue;
            const size_t corners = type == kTetrahedron ? 4 : 8;
            for (size_t k = 0; k < corners; ++k)
                cells[type == kHexahedron].push_back(
                    nodes.place(lines, lines.count(first + k, "node of an element", kMostNumber)));
        }
    }
}

}  // namespace

CellMesh read_tetgen(const std::string& path) {
    const std::filesystem::path stem = std::filesystem::path(path).replace_extension();
    WordLines lines(stem.string() + ".node", '#');
    lines.need("the number of points");
    const uint64_t count = lines.count(0, "number of points", TAUT_DEFORMABLE_MAX);
    if (lines.size() > 1 && lines.count(1, "dimension", 3) != 3) lines.refuse("points must have three coordinates");
    Numbered nodes;
    for (uint64_t i = 0; i < count; ++i) {
        lines.need("all points");
        const uint64_t number = lines.count(0, "number of a point", kMostNumber);
        nodes.add(lines, number, position(lines, 1));
    }
    WordLines elements(stem.string() + ".ele", '#');
    elements.need("the number of tetrahedra");
    const uint64_t tets = elements.count(0, "number of tetrahedra", TAUT_DEFORMABLE_MAX);
    if (elements.size() > 1 && elements.count(1, "nodes of a tetrahedron", 10) < 4)
        elements.refuse("a tetrahedron needs four nodes");
    if (tets == 0) elements.refuse("there are no tetrahedra");
    std::vector<uint32_t> cells;
    for (uint64_t i = 0; i < tets; ++i) {
        elements.need("all tetrahedra");
        for (size_t k = 1; k <= 4; ++k)
            cells.push_back(nodes.place(elements, elements.count(k, "node of a tetrahedron", kMostNumber)));
    }
    return tidy(std::move(nodes).points(), std::move(cells), 4);
}

CellMesh read_gmsh(const std::string& path) {
    WordLines lines(path, 0);
    Numbered nodes;
    std::vector<uint32_t> cells[2];  // tetrahedra, hexahedra
    int version = 0;
    while (lines.next()) {
        const std::string section = lines[0];
        if (section[0] != '$') lines.refuse("a section was expected, not '" + section + "'");
        if (section == "$MeshFormat") {
            lines.need("the format's version");
            const double number = lines.number(0, "version");
            if (lines.count(1, "kind of file", 1) != 0) lines.refuse("a binary file; save it as ASCII");
            if (number != 4.1 && !(number >= 2 && number < 3)) lines.refuse("version " + lines[0] + ", not 2 or 4.1");
            version = number == 4.1 ? 4 : 2;
        } else if (version == 0) {
            lines.refuse("not a Gmsh file: it does not begin with $MeshFormat");
        } else if (section == "$Nodes") {
            read_gmsh_nodes(lines, version, nodes);
        } else if (section == "$Elements") {
            read_gmsh_elements(lines, version, nodes, cells);
        }
        const std::string end = "$End" + section.substr(1);
        do lines.need(end.c_str());
        while (lines[0] != end && (section != "$Nodes" && section != "$Elements"));
        if (lines[0] != end) lines.refuse("more lines than " + section + " tells");
    }
    if (cells[0].empty() && cells[1].empty()) lines.refuse("there are neither tetrahedra nor hexahedra");
    if (!cells[0].empty() && !cells[1].empty()) lines.refuse("both tetrahedra and hexahedra; a solid is of one kind");
    const bool hexahedra = cells[0].empty();
    return tidy(std::move(nodes).points(), std::move(cells[hexahedra]), hexahedra ? 8 : 4);
}

}  // namespace scenes
