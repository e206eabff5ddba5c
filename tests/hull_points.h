// Points like those that games make hulls of: buildings, voxels, flat and long pieces, and what modelling leaves
// behind. The same from every C++ library.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace hull_points {

using Point = std::array<float, 3>;
using Points = std::vector<Point>;

enum class Like { cloud, building, voxels, slab, needle, nearly_flat_faces, ramp };
constexpr std::array kAll = {Like::cloud, Like::building, Like::voxels, Like::slab, Like::needle,
                             Like::nearly_flat_faces, Like::ramp};

inline const char* name(Like like) {
    constexpr std::array kNames = {"Cloud", "Building", "Voxels", "Slab", "Needle", "NearlyFlatFaces", "Ramp"};
    return kNames[size_t(like)];
}

class Maker {
public:
    explicit Maker(uint32_t seed) : engine_(seed) {}

    double uniform(double lo, double hi) { return lo + (hi - lo) * double(engine_()) / 4294967296.0; }
    int count(int lo, int hi) { return lo + int(engine_() % uint32_t(hi - lo + 1)); }

    // Some 0.6 m large, thin ones aside; not about the origin.
    Points make(Like like) {
        Points points;
        if (like == Like::cloud) fill(points, {0.1, 0.1, 0.1}, {0.4, 0.4, 0.4}, 60);
        if (like == Like::slab) fill(points, {0.1, 0.002, 0.1}, {0.4, 0.02, 0.4}, 30);
        if (like == Like::needle) fill(points, {0.003, 0.3, 0.003}, {0.02, 0.6, 0.02}, 24);
        if (like == Like::building) add_building(points);
        if (like == Like::voxels) add_voxels(points);
        if (like == Like::nearly_flat_faces) add_nearly_flat_faces(points);
        if (like == Like::ramp) add_ramp(points);
        return points;
    }

private:
    using Triple = std::array<double, 3>;

    static Point point(const Triple& p) { return {float(p[0]), float(p[1]), float(p[2])}; }
    // In order: the arguments of a call have none.
    Triple uniform(const Triple& lo, const Triple& hi) {
        return {uniform(lo[0], hi[0]), uniform(lo[1], hi[1]), uniform(lo[2], hi[2])};
    }
    static Triple minus(const Triple& p) { return {-p[0], -p[1], -p[2]}; }

    void fill(Points& points, const Triple& least, const Triple& most, int at_most) {
        const Triple half = uniform(least, most);
        for (int n = count(8, at_most); n > 0; --n) points.push_back(point(uniform(minus(half), half)));
    }
    // Blocks whose walls are flush, or off by millimetres: sills, plinths, a ground that is not quite level.
    void add_building(Points& points) {
        const auto about = [&](double x) { return x + (count(0, 2) ? 0.0 : uniform(-0.006, 0.006)); };
        const Triple half = uniform({0.15, 0.1, 0.15}, {0.3, 0.25, 0.3});
        for (int block = count(2, 6); block > 0; --block) {
            Triple lo, hi;
            for (size_t k = 0; k < 3; ++k) {
                lo[k] = about(k == 1 || count(0, 1) ? -half[k] : uniform(-half[k], 0));
                hi[k] = about(count(0, 1) ? half[k] : uniform(0, half[k]));
            }
            for (int i = 0; i < 8; ++i)
                points.push_back(point({(i & 1 ? hi : lo)[0], (i & 2 ? hi : lo)[1], (i & 4 ? hi : lo)[2]}));
        }
        for (int sill = count(0, 8); sill > 0; --sill) {
            Triple p = uniform(minus(half), half);
            p[1] = about(-half[1]);
            p[2] = about(std::copysign(half[2], p[2]));
            points.push_back(point(p));
        }
    }
    // Hills of a grid of cells: far more corners than a hull may have.
    void add_voxels(Points& points) {
        const int n = count(6, 16);
        const Triple wave = uniform({0.2, 0.2, 0.2}, {0.6, 0.6, 1});
        const double cell = 0.6 / n, middle = 0.5 * n;
        for (int i = 0; i <= n; ++i) {
            for (int k = 0; k <= n; ++k) {
                const double height = middle * wave[2] * (1 + std::sin(wave[0] * i) * std::cos(wave[1] * k));
                for (const double level : {0.0, std::floor(height)})
                    points.push_back(point({cell * (i - middle), cell * (level - middle), cell * (k - middle)}));
            }
        }
    }
    // A block with points a little outside of its faces and beside its corners, 0.01 to 16 mm.
    void add_nearly_flat_faces(Points& points) {
        const Triple half = uniform({0.1, 0.1, 0.1}, {0.3, 0.3, 0.3});
        const auto off = [&] { return std::copysign(std::pow(10, uniform(-5, -1.8)), uniform(-1, 1)); };
        for (int i = 0; i < 8; ++i) {
            Triple corner;
            for (size_t k = 0; k < 3; ++k) corner[k] = i >> k & 1 ? half[k] : -half[k];
            for (int n = count(1, 2); n > 0; --n) {
                corner[size_t(count(0, 2))] += off();
                points.push_back(point(corner));
            }
        }
        for (int more = count(0, 12); more > 0; --more) {
            Triple p = uniform(minus(half), half);
            const size_t face = size_t(count(0, 2));
            p[face] = std::copysign(half[face], p[face]) + off();
            points.push_back(point(p));
        }
    }

    // A wedge on a floor that falls by millimetres to one short edge: of it triangles are slivers in two planes.
    void add_ramp(Points& points) {
        const Triple half = uniform({0.25, 0.1, 0.15}, {0.35, 0.25, 0.3});
        const Triple edge = uniform({0.004, 0.002, 0}, {0.01, 0.005, 0.4});
        const double low = -half[1] - edge[1], at = edge[2] * half[2];
        points = {point({-half[0], low, at}), point({-half[0] + edge[0], low, at})};
        constexpr std::array<Triple, 5> kRest = {
            {{-0.99, -1, -1}, {0.35, -1, -1.06}, {0.98, -1, -1}, {0.98, -1, 1}, {1, 0.8, -1.05}}};
        for (const Triple& p : kRest) {
            const Triple off = uniform({-0.002, 0, -0.002}, {0.002, 0, 0.002});
            points.push_back(point({p[0] * half[0] + off[0], p[1] * half[1], p[2] * half[2] + off[2]}));
        }
    }

    std::mt19937 engine_;
};

}  // namespace hull_points
