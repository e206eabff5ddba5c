// A figure that stands on two legs and a tail: the surface of a smooth union of tapered capsules, by marching
// tetrahedra (Doi and Koide 1991) on a lattice of cubes.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "pose.h"
#include "soft_files.h"

namespace scenes {

namespace {

struct FigureLimb {
    taut_pos from, to;
    double from_radius, to_radius;
};

// Of one side; those off the middle are mirrored [m].
constexpr FigureLimb kFigureLimbs[] = {
    {{0, 0.45, 0}, {0, 0.64, 0}, 0.17, 0.13},          // trunk
    {{0, 0.42, 0.05}, {0, 0.46, 0.06}, 0.15, 0.14},    // belly
    {{0, 0.78, 0.02}, {0, 0.81, 0.08}, 0.09, 0.08},    // head
    {{0, 0.80, 0.10}, {0, 0.77, 0.22}, 0.055, 0.035},  // snout
    {{0.06, 0.87, 0.01}, {0.12, 1.0, -0.02}, 0.035, 0.022},
    {{0.13, 0.66, 0}, {0.29, 0.58, 0.09}, 0.06, 0.05},
    {{0.29, 0.58, 0.09}, {0.31, 0.75, 0.18}, 0.05, 0.04},
    {{0.31, 0.75, 0.18}, {0.30, 0.83, 0.2}, 0.05, 0.03},
    {{0.09, 0.38, 0.02}, {0.14, 0.21, 0.07}, 0.10, 0.075},
    {{0.14, 0.21, 0.07}, {0.15, 0.06, 0}, 0.065, 0.05},
    {{0.15, 0.045, 0}, {0.17, 0.04, 0.14}, 0.045, 0.038},
    {{0, 0.36, -0.13}, {0, 0.18, -0.3}, 0.075, 0.045},
    {{0, 0.18, -0.3}, {0, 0.08, -0.44}, 0.045, 0.028},
};

double distance_to(const FigureLimb& limb, taut_pos p) {
    const taut_pos d = minus(limb.to, limb.from), q = minus(p, limb.from);
    const double t =
        std::fmin(std::fmax((d.x * q.x + d.y * q.y + d.z * q.z) / (d.x * d.x + d.y * d.y + d.z * d.z), 0), 1);
    return length(minus(q, {t * d.x, t * d.y, t * d.z})) - (limb.from_radius + t * (limb.to_radius - limb.from_radius));
}

// Below 0 inside [m]. Limbs blend where they are about so near: -k log(sum exp(-d/k)).
double field(taut_pos p) {
    constexpr double kBlend = 0.012;
    double sum = 0;
    const taut_pos mirrored = {std::fabs(p.x), p.y, p.z};
    for (const FigureLimb& limb : kFigureLimbs) sum += std::exp(-distance_to(limb, mirrored) / kBlend);
    return -kBlend * std::log(sum);
}

}  // namespace

Surface figure_surface() {
    constexpr double kSpacing = 0.02, kLow[3] = {-0.42, -0.04, -0.52};
    constexpr int kNodes[3] = {43, 56, 42};
    // Six tetrahedra about the diagonal of each cube: faces of neighbours fit. Corner b at (b & 1, b >> 1 & 1, b >> 2).
    static constexpr int kTets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                        {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    const auto place = [&](int i, int j, int k) {
        return taut_pos{kLow[0] + kSpacing * i, kLow[1] + kSpacing * j, kLow[2] + kSpacing * k};
    };
    const auto number = [&](int i, int j, int k) { return (i * kNodes[1] + j) * kNodes[2] + k; };
    std::vector<double> value(static_cast<size_t>(kNodes[0]) * kNodes[1] * kNodes[2]);
    std::vector<taut_pos> node(value.size());
    for (int i = 0; i < kNodes[0]; ++i)
        for (int j = 0; j < kNodes[1]; ++j)
            for (int k = 0; k < kNodes[2]; ++k) {
                const auto n = static_cast<size_t>(number(i, j, k));
                node[n] = place(i, j, k);
                value[n] = field(node[n]);
            }
    Surface surface;
    std::map<std::pair<int, int>, uint32_t> crossing;
    const auto cross = [&](int inside, int outside) {
        const auto [found, is_new] =
            crossing.emplace(std::minmax(inside, outside), static_cast<uint32_t>(surface.points.size()));
        if (is_new) {
            const auto a = static_cast<size_t>(inside), b = static_cast<size_t>(outside);
            const double t = value[a] / (value[a] - value[b]);
            surface.points.push_back(
                plus(node[a], t * (node[b].x - node[a].x), t * (node[b].y - node[a].y), t * (node[b].z - node[a].z)));
        }
        return found->second;
    };
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        surface.triangles.insert(surface.triangles.end(), {a, b, c});
    };
    const auto march = [&](const int(&tet)[4]) {
        // Inner corners first, by an even permutation: the tetrahedron stays the same way round.
        std::array<int, 4> v = {tet[0], tet[1], tet[2], tet[3]};
        const auto in = [&](int n) { return value[static_cast<size_t>(v[static_cast<size_t>(n)])] < 0; };
        const int count = in(0) + in(1) + in(2) + in(3);
        if (count == 0 || count == 4) return;
        const auto reorder = [&](const auto& orders, auto&& fits) {
            const std::array<int, 4> old = v;
            for (const auto& order : orders) {
                for (size_t n = 0; n < 4; ++n) v[n] = old[static_cast<size_t>(order[n])];
                if (fits()) return;
            }
        };
        static constexpr int kFirst[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
        static constexpr int kPair[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                            {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
        if (count == 1) {
            reorder(kFirst, [&] { return in(0); });
            add(cross(v[0], v[1]), cross(v[0], v[2]), cross(v[0], v[3]));
        } else if (count == 3) {
            reorder(kFirst, [&] { return !in(0); });
            add(cross(v[1], v[0]), cross(v[3], v[0]), cross(v[2], v[0]));
        } else {
            reorder(kPair, [&] { return in(0) && in(1); });
            const uint32_t a = cross(v[0], v[2]), b = cross(v[0], v[3]), c = cross(v[1], v[3]), d = cross(v[1], v[2]);
            add(a, b, c);
            add(a, c, d);
        }
    };
    for (int i = 0; i + 1 < kNodes[0]; ++i)
        for (int j = 0; j + 1 < kNodes[1]; ++j)
            for (int k = 0; k + 1 < kNodes[2]; ++k)
                for (const auto& tet : kTets) {
                    int v[4];
                    for (int n = 0; n < 4; ++n)
                        v[n] = number(i + (tet[n] & 1), j + (tet[n] >> 1 & 1), k + (tet[n] >> 2));
                    march(v);
                }
    return surface;
}

}  // namespace scenes
