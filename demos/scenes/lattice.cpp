#include "lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

double dot(taut_pos a, taut_pos b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
taut_pos cross(taut_pos a, taut_pos b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
// Six times the volume of a tetrahedron [m^3].
double six_volumes(taut_pos a, taut_pos b, taut_pos c, taut_pos d) {
    return dot(minus(b, a), cross(minus(c, a), minus(d, a)));
}

struct Pieces {
    std::vector<int> of_point;
    int count = 0;
};

// Each edge of a closed surface is gone along once in either direction.
void check_closed(const Surface& surface, const std::string& source) {
    std::map<std::pair<uint32_t, uint32_t>, int> uses;
    for (size_t t = 0; t < surface.triangles.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) ++uses[{surface.triangles[t + k], surface.triangles[t + (k + 1) % 3]}];
    for (const auto& [edge, count] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        if (back != uses.end() && back->second == count) continue;
        const taut_pos& at = surface.points[edge.first];
        throw BadFile(source + ": the surface is not closed: it has an edge with a face on one side alone, from (" +
                      std::to_string(at.x) + ", " + std::to_string(at.y) + ", " + std::to_string(at.z) + ")");
    }
}

Pieces pieces_of(const Surface& surface) {
    std::vector<int> root(surface.points.size());
    for (size_t i = 0; i < root.size(); ++i) root[i] = static_cast<int>(i);
    const auto find = [&](int i) {
        while (root[static_cast<size_t>(i)] != i)
            i = root[static_cast<size_t>(i)] = root[static_cast<size_t>(root[static_cast<size_t>(i)])];
        return i;
    };
    for (size_t t = 0; t < surface.triangles.size(); t += 3)
        for (size_t k = 1; k < 3; ++k) {
            const int a = find(static_cast<int>(surface.triangles[t])),
                      b = find(static_cast<int>(surface.triangles[t + k]));
            root[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
        }
    Pieces pieces;
    std::map<int, int> number;
    for (size_t i = 0; i < root.size(); ++i)
        pieces.of_point.push_back(
            number.emplace(find(static_cast<int>(i)), static_cast<int>(number.size())).first->second);
    pieces.count = static_cast<int>(number.size());
    return pieces;
}

double volume_of(const Surface& surface) {
    double sum = 0;
    for (size_t t = 0; t < surface.triangles.size(); t += 3)
        sum += dot(surface.points[surface.triangles[t]],
                   cross(surface.points[surface.triangles[t + 1]], surface.points[surface.triangles[t + 2]]));
    return sum / 6;
}

// Whether points of a regular grid lie inside: along a line of the grid in y, inside is between the crossings of odd
// and of even number. Lines pass beside vertices and edges that lie on the grid, by an offset that is no fraction of
// it.
class InsideGrid {
public:
    InsideGrid(const Surface& surface, taut_pos low, double spacing, const std::array<int, 3>& size)
        : low_(low), spacing_(spacing), size_(size), crossings_(static_cast<size_t>(size[0]) * size[2]) {
        for (size_t t = 0; t < surface.triangles.size(); t += 3)
            add(surface.points[surface.triangles[t]], surface.points[surface.triangles[t + 1]],
                surface.points[surface.triangles[t + 2]]);
        for (auto& line : crossings_) std::sort(line.begin(), line.end());
    }
    bool at(int i, int j, int k) const {
        const auto& line = crossings_[static_cast<size_t>(i) * size_[2] + k];
        return (std::lower_bound(line.begin(), line.end(), low_.y + spacing_ * (j + 0.5)) - line.begin()) % 2 != 0;
    }

private:
    double x(int i) const { return low_.x + spacing_ * (i + 0.5 + 1.234567e-4); }
    double z(int k) const { return low_.z + spacing_ * (k + 0.5 - 2.718281e-4); }

    void add(taut_pos a, taut_pos b, taut_pos c) {
        const double area = (b.x - a.x) * (c.z - a.z) - (c.x - a.x) * (b.z - a.z);  // twice, as seen along y
        if (area == 0) return;
        const auto first = [&](double from, double low) {
            return static_cast<int>(std::ceil((from - low) / spacing_ - 1));
        };
        const int i0 = std::max(0, first(std::min({a.x, b.x, c.x}), low_.x)),
                  k0 = std::max(0, first(std::min({a.z, b.z, c.z}), low_.z));
        const double x1 = std::max({a.x, b.x, c.x}), z1 = std::max({a.z, b.z, c.z});
        for (int i = i0; i < size_[0] && x(i) <= x1; ++i)
            for (int k = k0; k < size_[2] && z(k) <= z1; ++k) {
                const double u = ((x(i) - a.x) * (c.z - a.z) - (c.x - a.x) * (z(k) - a.z)) / area;
                const double v = ((b.x - a.x) * (z(k) - a.z) - (x(i) - a.x) * (b.z - a.z)) / area;
                if (u < 0 || v < 0 || u + v > 1) continue;
                crossings_[static_cast<size_t>(i) * size_[2] + k].push_back(a.y + u * (b.y - a.y) + v * (c.y - a.y));
            }
    }

    taut_pos low_;
    double spacing_;
    std::array<int, 3> size_;
    std::vector<std::vector<double>> crossings_;  // heights [m], of each line
};

// Cubes that are kept, and which of them hang together by faces.
struct Cubes {
    taut_pos low{};
    double spacing = 1;
    std::array<int, 3> size{};
    std::vector<int> part;  // of each cube, -1: not kept

    size_t index(int i, int j, int k) const { return (static_cast<size_t>(i) * size[1] + j) * size[2] + k; }
    std::array<int, 3> cube_of(taut_pos p) const {
        const auto in = [&](double d, int axis) {
            return std::clamp(static_cast<int>(std::floor(d / spacing)), 0, size[static_cast<size_t>(axis)] - 1);
        };
        return {in(p.x - low.x, 0), in(p.y - low.y, 1), in(p.z - low.z, 2)};
    }
    bool kept(int i, int j, int k) const {
        return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2] && part[index(i, j, k)] >= 0;
    }
    size_t count() const {
        return static_cast<size_t>(std::count_if(part.begin(), part.end(), [](int its) { return its >= 0; }));
    }
    template <class Visit>
    void each(Visit&& visit) const {
        for (int i = 0; i < size[0]; ++i)
            for (int j = 0; j < size[1]; ++j)
                for (int k = 0; k < size[2]; ++k)
                    if (kept(i, j, k)) visit(i, j, k);
    }
    // Visits cubes in growing distance from one, by rings, until a ring with hits and one beyond were seen.
    template <class Visit>
    void around(const std::array<int, 3>& c, Visit&& visit) const {
        const int most = std::max({size[0], size[1], size[2]});
        for (int r = 0, left = most; r <= most && left > 0; ++r, --left)
            for (int i = c[0] - r; i <= c[0] + r; ++i)
                for (int j = c[1] - r; j <= c[1] + r; ++j)
                    for (int k = c[2] - r; k <= c[2] + r; ++k) {
                        if (std::max({std::abs(i - c[0]), std::abs(j - c[1]), std::abs(k - c[2])}) != r) continue;
                        if (!kept(i, j, k)) continue;
                        visit(i, j, k);
                        left = std::min(left, 2);
                    }
    }
};

// Those of which one of eight parts has its middle inside.
Cubes cubes_inside(const Surface& surface, double spacing) {
    const Bounds box = box_about(surface.points);
    Cubes cubes;
    cubes.spacing = spacing;
    const auto cells = [&](double low, double high) {
        return static_cast<int>(std::floor((high - low) / spacing)) + 1;
    };
    cubes.size = {cells(box.low.x, box.high.x), cells(box.low.y, box.high.y), cells(box.low.z, box.high.z)};
    const auto start = [&](double low, double high, int n) { return (low + high) / 2 - spacing * n / 2; };
    cubes.low = {start(box.low.x, box.high.x, cubes.size[0]), start(box.low.y, box.high.y, cubes.size[1]),
                 start(box.low.z, box.high.z, cubes.size[2])};
    const InsideGrid inside(surface, cubes.low, spacing / 2, {2 * cubes.size[0], 2 * cubes.size[1], 2 * cubes.size[2]});
    cubes.part.assign(static_cast<size_t>(cubes.size[0]) * cubes.size[1] * cubes.size[2], -1);
    for (int i = 0; i < 2 * cubes.size[0]; ++i)
        for (int j = 0; j < 2 * cubes.size[1]; ++j)
            for (int k = 0; k < 2 * cubes.size[2]; ++k)
                if (inside.at(i, j, k)) cubes.part[cubes.index(i / 2, j / 2, k / 2)] = 0;
    return cubes;
}

// Of what hangs together by faces only that stays which some piece of the surface has most of its points at: thin ends,
// which the lattice does not reach, move with their piece.
void drop_crumbs(Cubes& cubes, const Surface& surface) {
    int parts = 0;
    std::vector<size_t> stack;
    std::vector<int> part(cubes.part.size(), -1);
    cubes.each([&](int i, int j, int k) {
        if (part[cubes.index(i, j, k)] >= 0) return;
        std::vector<std::array<int, 3>> open = {{i, j, k}};
        part[cubes.index(i, j, k)] = parts;
        while (!open.empty()) {
            const auto c = open.back();
            open.pop_back();
            for (int axis = 0; axis < 3; ++axis)
                for (const int way : {-1, 1}) {
                    auto next = c;
                    next[static_cast<size_t>(axis)] += way;
                    if (!cubes.kept(next[0], next[1], next[2])) continue;
                    int& its = part[cubes.index(next[0], next[1], next[2])];
                    if (its >= 0) continue;
                    its = parts;
                    open.push_back(next);
                }
        }
        ++parts;
    });
    const Pieces pieces = pieces_of(surface);
    std::vector<std::vector<int>> votes(static_cast<size_t>(pieces.count),
                                        std::vector<int>(static_cast<size_t>(parts)));
    for (size_t p = 0; p < surface.points.size(); ++p) {
        bool told = false;
        cubes.around(cubes.cube_of(surface.points[p]), [&](int i, int j, int k) {
            if (!told)
                ++votes[static_cast<size_t>(pieces.of_point[p])][static_cast<size_t>(part[cubes.index(i, j, k)])];
            told = true;
        });
    }
    std::vector<bool> stays(static_cast<size_t>(parts), false);
    for (const auto& of : votes) stays[static_cast<size_t>(std::max_element(of.begin(), of.end()) - of.begin())] = true;
    for (size_t c = 0; c < part.size(); ++c)
        cubes.part[c] = part[c] >= 0 && stays[static_cast<size_t>(part[c])] ? 0 : -1;
}

// Ericson, Real-Time Collision Detection (2005), 5.1.5.
taut_pos closest_on_triangle(taut_pos p, taut_pos a, taut_pos b, taut_pos c) {
    const auto along = [](taut_pos from, taut_pos to, double t) {
        return plus(from, t * (to.x - from.x), t * (to.y - from.y), t * (to.z - from.z));
    };
    const taut_pos ab = minus(b, a), ac = minus(c, a), ap = minus(p, a), bp = minus(p, b), cp = minus(p, c);
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    if (d6 >= 0 && d5 <= d6) return c;
    const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return along(a, b, d1 / (d1 - d3));
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return along(a, c, d2 / (d2 - d6));
    if (va <= 0 && d4 >= d3 && d5 >= d6) return along(b, c, (d4 - d3) / (d4 - d3 + d5 - d6));
    const double v = vb / (va + vb + vc), w = vc / (va + vb + vc);
    return plus(a, v * ab.x + w * ac.x, v * ab.y + w * ac.y, v * ab.z + w * ac.z);
}

taut_pos closest_on(const Surface& surface, taut_pos p) {
    taut_pos best{};
    double least = std::numeric_limits<double>::infinity();
    for (size_t t = 0; t < surface.triangles.size(); t += 3) {
        const taut_pos q =
            closest_on_triangle(p, surface.points[surface.triangles[t]], surface.points[surface.triangles[t + 1]],
                                surface.points[surface.triangles[t + 2]]);
        const taut_pos d = minus(q, p);
        if (dot(d, d) >= least) continue;
        least = dot(d, d);
        best = q;
    }
    return best;
}

// Makes the solid's tetrahedra; tets: first tetrahedron of each kept cube.
struct Filling {
    Solid solid;
    std::unordered_map<size_t, uint32_t> first_cell;
    std::vector<bool> on_boundary;  // of vertices
};

Filling make_cells(const Cubes& cubes) {
    Filling filling;
    taut_solid_def_init(&filling.solid.def);
    const std::array<int, 3> nodes = {cubes.size[0] + 1, cubes.size[1] + 1, cubes.size[2] + 1};
    std::vector<uint32_t> number(static_cast<size_t>(nodes[0]) * nodes[1] * nodes[2], UINT32_MAX);
    std::vector<int> cubes_at;  // each vertex
    cubes.each([&](int i, int j, int k) {
        uint32_t corner[8];
        for (int b = 0; b < 8; ++b) {
            const int x = i + (b & 1), y = j + (b >> 1 & 1), z = k + (b >> 2);
            uint32_t& n = number[(static_cast<size_t>(x) * nodes[1] + y) * nodes[2] + z];
            if (n == UINT32_MAX) {
                n = static_cast<uint32_t>(filling.solid.points.size());
                filling.solid.points.push_back(
                    plus(cubes.low, cubes.spacing * x, cubes.spacing * y, cubes.spacing * z));
                cubes_at.push_back(0);
            }
            ++cubes_at[n];
            corner[b] = n;
        }
        filling.first_cell[cubes.index(i, j, k)] = static_cast<uint32_t>(filling.solid.cells.size() / 4);
        add_five_tets(corner, (i + j + k) % 2 != 0, filling.solid.cells);
    });
    for (const int count : cubes_at) filling.on_boundary.push_back(count < 8);
    return filling;
}

// Draws vertices of the boundary to the surface, by all of the way or by as many quarters of it as leave each cell a
// quarter of its volume at least.
void draw_to_surface(Filling& filling, const Surface& surface) {
    constexpr double kLeast = 0.25;
    Solid& solid = filling.solid;
    std::vector<std::vector<uint32_t>> cells_at(solid.points.size());
    const size_t count = solid.cells.size() / 4;
    std::vector<double> least(count);
    const auto volume = [&](size_t c) {
        const uint32_t* v = &solid.cells[4 * c];
        return six_volumes(solid.points[v[0]], solid.points[v[1]], solid.points[v[2]], solid.points[v[3]]);
    };
    for (size_t c = 0; c < count; ++c) {
        least[c] = kLeast * volume(c);
        for (size_t k = 0; k < 4; ++k) cells_at[solid.cells[4 * c + k]].push_back(static_cast<uint32_t>(c));
    }
    for (size_t v = 0; v < solid.points.size(); ++v) {
        if (!filling.on_boundary[v]) continue;
        const taut_pos start = solid.points[v], way = minus(closest_on(surface, start), start);
        for (int quarters = 4; quarters >= 0; --quarters) {
            solid.points[v] = plus(start, 0.25 * quarters * way.x, 0.25 * quarters * way.y, 0.25 * quarters * way.z);
            if (std::all_of(cells_at[v].begin(), cells_at[v].end(), [&](uint32_t c) { return volume(c) >= least[c]; }))
                break;
        }
    }
}

// Each point by the tetrahedron that it lies in, or whose smallest barycentric coordinate for it is largest.
Skin embed(const Filling& filling, const Cubes& cubes, const Surface& surface) {
    const Solid& solid = filling.solid;
    Skin skin;
    skin.triangles = surface.triangles;
    for (const taut_pos& p : surface.points) {
        double best = -std::numeric_limits<double>::infinity();
        uint32_t corners[4] = {};
        double weights[4] = {};
        cubes.around(cubes.cube_of(p), [&](int i, int j, int k) {
            const uint32_t first = filling.first_cell.at(cubes.index(i, j, k));
            for (uint32_t c = first; c < first + 5; ++c) {
                const uint32_t* v = &solid.cells[4 * static_cast<size_t>(c)];
                const taut_pos x[4] = {solid.points[v[0]], solid.points[v[1]], solid.points[v[2]], solid.points[v[3]]};
                const double all = six_volumes(x[0], x[1], x[2], x[3]);
                const double w[4] = {six_volumes(p, x[1], x[2], x[3]) / all, six_volumes(x[0], p, x[2], x[3]) / all,
                                     six_volumes(x[0], x[1], p, x[3]) / all, six_volumes(x[0], x[1], x[2], p) / all};
                const double worst = std::min({w[0], w[1], w[2], w[3]});
                if (worst <= best) continue;
                best = worst;
                std::copy(v, v + 4, corners);
                std::copy(w, w + 4, weights);
            }
        });
        skin.corners.insert(skin.corners.end(), corners, corners + 4);
        for (const double w : weights) skin.weights.push_back(static_cast<float>(w));
    }
    return skin;
}

}  // namespace

Solid fill_surface(const Surface& given, int cubes, const std::string& source) {
    check_closed(given, source);
    Surface surface = given;
    double volume = volume_of(surface);
    if (volume < 0) {  // inside out
        for (size_t t = 0; t < surface.triangles.size(); t += 3)
            std::swap(surface.triangles[t + 1], surface.triangles[t + 2]);
        volume = -volume;
    }
    const Bounds box = box_about(surface.points);
    const double side = length(minus(box.high, box.low));
    double spacing = std::cbrt(volume / cubes);
    constexpr double kMostAcross = 400;  // cubes along the box's diagonal
    if (!(volume > 0)) throw BadFile(source + ": the surface encloses no volume");
    if (side > kMostAcross * spacing)
        throw BadFile(source + ": the surface is so thin that its " + std::to_string(cubes) +
                      " cubes do not reach across it");
    // Cubes that lie inside in part count as whole ones: larger ones, until there are as many as wished for.
    Cubes inside = cubes_inside(surface, spacing);
    for (int attempt = 0; attempt < 4 && inside.count() > 0; ++attempt) {
        spacing *= std::cbrt(static_cast<double>(inside.count()) / cubes);
        inside = cubes_inside(surface, spacing);
    }
    if (inside.count() == 0) throw BadFile(source + ": no cube of the lattice has a part inside the surface");
    drop_crumbs(inside, surface);
    Filling filling = make_cells(inside);
    draw_to_surface(filling, surface);
    filling.solid.skin = embed(filling, inside, surface);
    return std::move(filling.solid);
}

}  // namespace scenes
