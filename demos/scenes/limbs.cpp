#include "limbs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

double distance_to(const FigureLimb& limb, taut_pos p) {
    const taut_pos d = minus(limb.to, limb.from), q = minus(p, limb.from);
    const double t =
        std::fmin(std::fmax((d.x * q.x + d.y * q.y + d.z * q.z) / (d.x * d.x + d.y * d.y + d.z * d.z), 0), 1);
    return length(minus(q, {t * d.x, t * d.y, t * d.z})) - (limb.from_radius + t * (limb.to_radius - limb.from_radius));
}

// Below 0 inside [m]. Limbs blend where they are about so near: -k log(sum exp(-d/k)).
double field(std::span<const FigureLimb> limbs, taut_pos p) {
    constexpr double kBlend = 0.012;
    double sum = 0;
    const taut_pos mirrored = {std::fabs(p.x), p.y, p.z};
    for (const FigureLimb& limb : limbs) sum += std::exp(-distance_to(limb, mirrored) / kBlend);
    return -kBlend * std::log(sum);
}

}  // namespace

LimbLattice lattice_about(std::span<const FigureLimb> limbs, double spacing) {
    taut_pos low = {0, 1e9, 1e9}, high = {-1e9, -1e9, -1e9};
    for (const FigureLimb& limb : limbs)
        for (const auto& [p, r] : {std::pair(limb.from, limb.from_radius), std::pair(limb.to, limb.to_radius)}) {
            low = {std::min(low.x, -std::fabs(p.x) - r), std::min(low.y, p.y - r), std::min(low.z, p.z - r)};
            high = {std::max(high.x, std::fabs(p.x) + r), std::max(high.y, p.y + r), std::max(high.z, p.z + r)};
        }
    const double margin = 0.03 + spacing;  // of what blends beyond the limbs
    const auto count = [&](double from, double to) {
        return static_cast<int>(std::ceil((to - from + 2 * margin) / spacing)) + 1;
    };
    return {plus(low, -margin, -margin, -margin),
            spacing,
            {count(low.x, high.x), count(low.y, high.y), count(low.z, high.z)}};
}

Surface surface_of_limbs(std::span<const FigureLimb> limbs, const LimbLattice& lattice) {
    const double spacing = lattice.spacing;
    const int(&nodes)[3] = lattice.nodes;
    // Six tetrahedra about the diagonal of each cube: faces of neighbours fit. Corner b at (b & 1, b >> 1 & 1, b >> 2).
    static constexpr int kTets[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                        {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
    const auto place = [&](int i, int j, int k) {
        return taut_pos{lattice.low.x + spacing * i, lattice.low.y + spacing * j, lattice.low.z + spacing * k};
    };
    const auto number = [&](int i, int j, int k) { return (i * nodes[1] + j) * nodes[2] + k; };
    std::vector<double> value(static_cast<size_t>(nodes[0]) * nodes[1] * nodes[2]);
    std::vector<taut_pos> node(value.size());
    for (int i = 0; i < nodes[0]; ++i)
        for (int j = 0; j < nodes[1]; ++j)
            for (int k = 0; k < nodes[2]; ++k) {
                const auto n = static_cast<size_t>(number(i, j, k));
                node[n] = place(i, j, k);
                value[n] = field(limbs, node[n]);
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
    for (int i = 0; i + 1 < nodes[0]; ++i)
        for (int j = 0; j + 1 < nodes[1]; ++j)
            for (int k = 0; k + 1 < nodes[2]; ++k)
                for (const auto& tet : kTets) {
                    int v[4];
                    for (int n = 0; n < 4; ++n)
                        v[n] = number(i + (tet[n] & 1), j + (tet[n] >> 1 & 1), k + (tet[n] >> 2));
                    march(v);
                }
    return surface;
}

MassOfSurface mass_within(const Surface& surface, double density) {
    // Tetrahedra from the origin to each triangle: second moments are V/20 (sum of x x^T of corners + s s^T), s their
    // sum.
    double volume = 0, first[3] = {}, second[3][3] = {};
    for (size_t t = 0; t < surface.triangles.size(); t += 3) {
        double p[3][3], s[3] = {};
        for (size_t k = 0; k < 3; ++k) {
            const taut_pos& v = surface.points[surface.triangles[t + k]];
            p[k][0] = v.x, p[k][1] = v.y, p[k][2] = v.z;
            for (int a = 0; a < 3; ++a) s[a] += p[k][a];
        }
        const double own =
            (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
             p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
            6;
        volume += own;
        for (int a = 0; a < 3; ++a) {
            first[a] += own * s[a] / 4;
            for (int b = 0; b < 3; ++b)
                second[a][b] += own / 20 * (p[0][a] * p[0][b] + p[1][a] * p[1][b] + p[2][a] * p[2][b] + s[a] * s[b]);
        }
    }
    MassOfSurface of;
    of.mass = density * volume;
    of.centre = {first[0] / volume, first[1] / volume, first[2] / volume};
    double m[3][3];
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) m[a][b] = density * (second[a][b] - first[a] * first[b] / volume);
    of.inertia = {static_cast<float>(m[1][1] + m[2][2]), static_cast<float>(m[0][0] + m[2][2]),
                  static_cast<float>(m[0][0] + m[1][1]), static_cast<float>(-m[0][1]),
                  static_cast<float>(-m[0][2]),          static_cast<float>(-m[1][2])};
    return of;
}

RigidFigure::RigidFigure(Scene& scene, std::span<const FigureLimb> limbs, double tall, double density) {
    constexpr double kCells = 40;  // of the drawn surface, along the height
    const LimbLattice rough = lattice_about(limbs, 0.05);
    Surface surface = surface_of_limbs(limbs, lattice_about(limbs, rough.spacing * rough.nodes[1] / kCells));
    double low = 1e9, high = -1e9;
    for (const taut_pos& p : surface.points) low = std::min(low, p.y), high = std::max(high, p.y);
    const double scale = tall / (high - low);
    for (taut_pos& p : surface.points) p = {scale * p.x, scale * p.y, scale * p.z};
    const MassOfSurface of = mass_within(surface, density);
    mass_ = of.mass;
    inertia_ = of.inertia;
    Shape drawn;
    drawn.kind = ShapeKind::mesh;
    for (const taut_pos& p : surface.points) {
        const taut_pos own = minus(p, of.centre);
        drawn.points.push_back({static_cast<float>(own.x), static_cast<float>(own.y), static_cast<float>(own.z)});
    }
    drawn.indices = surface.triangles;
    drawn_ = scene.add_shape(std::move(drawn));
    for (const FigureLimb& limb : limbs)
        for (const double side : {1.0, -1.0}) {
            if (side < 0 && limb.from.x == 0 && limb.to.x == 0) continue;
            const taut_pos from = {side * scale * limb.from.x, scale * limb.from.y, scale * limb.from.z},
                           to = {side * scale * limb.to.x, scale * limb.to.y, scale * limb.to.z};
            Shape capsule;
            capsule.kind = ShapeKind::tapered_capsule;
            capsule.radius = static_cast<float>(scale * limb.from_radius);
            capsule.top_radius = static_cast<float>(scale * limb.to_radius);
            capsule.half_length = static_cast<float>(length(minus(to, from)) / 2);
            const taut_pos at = minus(middle(from, to), of.centre);
            parts_.push_back({scene.add_shape(std::move(capsule)),
                              {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)},
                              turn_from_to({0, 1, 0}, minus(to, from))});
        }
}

Body RigidFigure::at(taut_pos position, taut_quat rotation, Look look) const {
    Body body = crate(-1, position, mass_, look);
    body.rotation = rotation;
    body.inertia = inertia_;
    body.parts = parts_;
    body.drawn = drawn_;
    return body;
}

}  // namespace scenes
