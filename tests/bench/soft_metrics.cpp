#include "soft_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>

#include "scenes/pose.h"
#include "vector.h"

namespace bench {

namespace {

constexpr uint32_t kEvery = 10;  // steps, that crossings are counted

double six_volumes(Vec a, Vec b, Vec c, Vec d) { return dot(b - a, cross(c - a, d - a)); }

double longest_side(const std::vector<taut_pos>& points) {
    Vec low = of(points.front()), high = low;
    for (const taut_pos& p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

std::set<std::pair<uint32_t, uint32_t>> sides_of(const std::vector<std::array<uint32_t, 3>>& faces) {
    std::set<std::pair<uint32_t, uint32_t>> sides;
    for (const auto& face : faces)
        for (size_t k = 0; k < 3; ++k) sides.insert(std::minmax(face[k], face[(k + 1) % 3]));
    return sides;
}

// Along warp or weft: by less than an eighth of a turn in texture coordinates, as the library counts them.
bool is_thread(const scenes::Cloth& cloth, uint32_t a, uint32_t b) {
    if (cloth.uv.empty()) return true;
    const double u = std::fabs(static_cast<double>(cloth.uv[2 * a] - cloth.uv[2 * b])),
                 v = std::fabs(static_cast<double>(cloth.uv[2 * a + 1] - cloth.uv[2 * b + 1]));
    const double angle = std::atan2(v, u);
    return angle < std::numbers::pi / 8 || angle > 3 * std::numbers::pi / 8;
}

// Faces that one cell alone has.
std::vector<std::array<uint32_t, 3>> boundary_of(const scenes::Solid& solid) {
    static constexpr int kTet[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    static constexpr int kHex[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                       {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    const size_t corners = solid.def.corners;
    std::map<std::vector<uint32_t>, std::pair<int, std::vector<uint32_t>>> uses;  // by sorted vertices
    const auto add = [&](std::vector<uint32_t> face) {
        std::vector<uint32_t> key = face;
        std::sort(key.begin(), key.end());
        auto& use = uses[key];
        ++use.first;
        use.second = std::move(face);
    };
    for (size_t c = 0; c < solid.cells.size(); c += corners) {
        const uint32_t* v = &solid.cells[c];
        if (corners == 4)
            for (const auto& f : kTet) add({v[f[0]], v[f[1]], v[f[2]]});
        else
            for (const auto& f : kHex) add({v[f[0]], v[f[1]], v[f[2]], v[f[3]]});
    }
    std::vector<std::array<uint32_t, 3>> faces;
    for (const auto& [key, use] : uses) {
        const auto& f = use.second;
        if (use.first != 1) continue;
        faces.push_back({f[0], f[1], f[2]});
        if (f.size() == 4) faces.push_back({f[0], f[2], f[3]});
    }
    return faces;
}

void find_sides(SoftShape& shape) {
    for (const auto& [a, b] : sides_of(shape.faces)) shape.sides.push_back({a, b});
}

}  // namespace

SoftShape::SoftShape(const scenes::Cloth& cloth) : mass(cloth.points.size(), 0.0) {
    const std::vector<taut_pos>& rest = cloth.rest.empty() ? cloth.points : cloth.rest;
    for (size_t t = 0; t < cloth.triangles.size(); t += 3)
        faces.push_back({cloth.triangles[t], cloth.triangles[t + 1], cloth.triangles[t + 2]});
    for (size_t q = 0; q < cloth.quads.size(); q += 4) {
        const uint32_t* v = &cloth.quads[q];
        faces.insert(faces.end(), {{v[0], v[1], v[2]}, {v[0], v[2], v[3]}});
    }
    for (const auto& face : faces) {
        const Vec a = of(rest[face[0]]);
        const double area = 0.5 * length(cross(of(rest[face[1]]) - a, of(rest[face[2]]) - a));
        for (const uint32_t v : face) mass[v] += static_cast<double>(cloth.def.area_density) * area / 3;
    }
    find_sides(*this);
    for (const auto& [a, b] : sides)
        if (is_thread(cloth, a, b)) edges.push_back({a, b, length(of(rest[b]) - of(rest[a]))});
    for (const uint32_t v : cloth.pinned) mass[v] = 0;
    size = longest_side(rest);
}

SoftShape::SoftShape(const scenes::Solid& solid) : mass(solid.points.size(), 0.0) {
    const std::vector<taut_pos>& rest = solid.rest.empty() ? solid.points : solid.rest;
    // Three edges of a corner each, right-handed.
    static constexpr uint32_t kCorners[8][4] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
                                                {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}};
    static constexpr uint32_t kParts[5][4] = {{0, 1, 3, 4}, {2, 3, 1, 6}, {5, 4, 6, 1}, {7, 6, 4, 3}, {1, 3, 4, 6}};
    const size_t corners = solid.def.corners;
    for (size_t c = 0; c < solid.cells.size(); c += corners) {
        const uint32_t* v = &solid.cells[c];
        double volume = 0;
        const auto part = [&](const uint32_t(&p)[4]) {
            return std::fabs(six_volumes(of(rest[v[p[0]]]), of(rest[v[p[1]]]), of(rest[v[p[2]]]), of(rest[v[p[3]]]))) /
                   6;
        };
        if (corners == 4) {
            tets.push_back({v[0], v[1], v[2], v[3]});
            volume = part({0, 1, 2, 3});
        } else {
            for (const auto& k : kCorners) tets.push_back({v[k[0]], v[k[1]], v[k[2]], v[k[3]]});
            for (const auto& p : kParts) volume += part(p);
        }
        for (size_t k = 0; k < corners; ++k)
            mass[v[k]] += static_cast<double>(solid.def.density) * volume / static_cast<double>(corners);
    }
    tets_a_cell = corners == 4 ? 1 : 8;
    faces = boundary_of(solid);
    if (corners == TAUT_SOLID_MESHLESS) {  // what its triangles enclose, shared by all its points
        double volume = 0;
        for (size_t t = 0; t < solid.triangles.size(); t += 3) {
            const uint32_t* v = &solid.triangles[t];
            faces.push_back({v[0], v[1], v[2]});
            volume += six_volumes({}, of(rest[v[0]]), of(rest[v[1]]), of(rest[v[2]])) / 6;
        }
        for (double& m : mass) m = static_cast<double>(solid.def.density) * volume / static_cast<double>(mass.size());
    }
    find_sides(*this);
    for (const uint32_t v : solid.pinned) mass[v] = 0;
    size = longest_side(rest);
}

SoftMetrics::SoftMetrics(const scenes::Scene& scene, const Engine& engine, uint32_t steps, double rigid, double mass)
    : scene_(scene), engine_(engine), energy_lost_(std::numeric_limits<double>::quiet_NaN()) {
    const auto second = static_cast<uint32_t>(std::lround(1 / static_cast<double>(scene.world.time_step)));
    one_second_ = second - 1;
    last_second_ = steps > second ? steps - second : 0;
    last_ = steps - 1;
    for (const scenes::Cloth& cloth : scene.cloths) shapes_.emplace_back(cloth);
    for (const scenes::Solid& solid : scene.solids) shapes_.emplace_back(solid);
    states_.resize(shapes_.size());
    for (const scenes::Shape& shape : scene.shapes) depths_.emplace_back(shape, scene.shapes);
    name_points();
    read();
    for (const SoftShape& shape : shapes_) {
        size_ = std::max(size_, shape.size);
        for (const double m : shape.mass) mass += m;
    }
    weight_ = mass * -static_cast<double>(scene.world.gravity.y);
    energy_start_ = energy_most_ = energy() + rigid;
    for (const uint32_t v : scene.roles.tip)
        tip_height_ += scene.solids.front().points[v].y / static_cast<double>(scene.roles.tip.size());
}

void SoftMetrics::read() {
    for (size_t i = 0; i < states_.size(); ++i) {
        if (i < scene_.cloths.size())
            engine_.read_cloth(i, states_[i]);
        else
            engine_.read_solid(i - scene_.cloths.size(), states_[i]);
        for (const taut_pos& p : states_[i].points)
            finite_ = finite_ && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    }
}

// Kinetic and of height [J]: what an engine stores in its elements only it knows.
double SoftMetrics::energy() const {
    double sum = 0;
    const double gravity = -static_cast<double>(scene_.world.gravity.y);
    for (size_t i = 0; i < shapes_.size(); ++i)
        for (size_t v = 0; v < shapes_[i].mass.size(); ++v) {
            const Vec speed = of(states_[i].velocities[v]);
            sum += shapes_[i].mass[v] * (0.5 * dot(speed, speed) + gravity * states_[i].points[v].y);
        }
    return sum;
}

void SoftMetrics::measure_stretch() {
    double sum = 0;
    size_t count = 0;
    end_ = 0;
    for (size_t i = 0; i < scene_.cloths.size(); ++i) {
        const std::vector<taut_pos>& x = states_[i].points;
        for (const SoftShape::Edge& edge : shapes_[i].edges) {
            const double stretch = length(of(x[edge.b]) - of(x[edge.a])) / edge.rest - 1;
            end_ = std::max(end_, stretch);
            sum += stretch;
        }
        count += shapes_[i].edges.size();
    }
    peak_ = std::max(peak_, end_);
    mean_ = count > 0 ? sum / static_cast<double>(count) : 0;
}

// Of vertices, middles of edges and centres of faces.
void SoftMetrics::measure_depth(const std::vector<Motion>& bodies) {
    deep_end_ = 0;
    for (size_t i = 0; i < shapes_.size(); ++i) {
        const std::vector<taut_pos>& x = states_[i].points;
        const auto& faces = shapes_[i].faces;
        std::vector<FaceTree::Box> boxes;
        for (const auto& f : faces) boxes.push_back(FaceTree::box_about(x[f[0]], x[f[1]], x[f[2]]));
        const FaceTree tree(std::move(boxes));
        const auto look_within = [&](const PointDepth& depth, Vec at, taut_quat rotation) {
            const double r = depth.reach();
            const auto look_at = [&](Vec p) {
                deep_end_ = std::max(deep_end_, depth.at(rotate_back(rotation, p - at)));
            };
            tree.each_near({{at.x - r, at.y - r, at.z - r}, {at.x + r, at.y + r, at.z + r}}, [&](uint32_t face) {
                const auto& f = faces[face];
                look_at((of(x[f[0]]) + of(x[f[1]]) + of(x[f[2]])) * (1.0 / 3));
                for (size_t k = 0; k < 3; ++k) {
                    look_at(of(x[f[k]]));
                    look_at((of(x[f[k]]) + of(x[f[(k + 1) % 3]])) * 0.5);
                }
            });
        };
        for (size_t b = 0; b < scene_.bodies.size(); ++b) {
            const Motion& body = bodies[b];
            if (scene_.bodies[b].shape >= 0)
                look_within(depths_[static_cast<size_t>(scene_.bodies[b].shape)], of(body.position), body.rotation);
            for (const scenes::Part& part : scene_.bodies[b].parts)
                look_within(depths_[static_cast<size_t>(part.shape)],
                            of(body.position) + rotate(body.rotation, of(part.position)),
                            scenes::times(body.rotation, part.rotation));
        }
    }
    deep_ = std::max(deep_, deep_end_);
}

// The same number for vertices that a ball joint holds together, another for each other one.
void SoftMetrics::name_points() {
    std::vector<uint32_t> first;
    uint32_t count = 0;
    for (const SoftShape& shape : shapes_) {
        first.push_back(count);
        count += static_cast<uint32_t>(shape.mass.size());
    }
    std::vector<uint32_t> name(count);
    std::iota(name.begin(), name.end(), 0u);
    const auto root = [&](uint32_t v) {
        while (name[v] != v) v = name[v];
        return v;
    };
    const auto place = [&](const scenes::SoftVertex& end) -> std::optional<uint32_t> {
        if (end.cloth >= 0) return first[static_cast<size_t>(end.cloth)] + end.vertex;
        if (end.solid >= 0) return first[scene_.cloths.size() + static_cast<size_t>(end.solid)] + end.vertex;
        return std::nullopt;
    };
    for (const scenes::Joint& joint : scene_.joints) {
        const auto a = place(joint.vertex_a), b = place(joint.vertex_b);
        if (joint.kind == TAUT_JOINT_BALL && a && b) name[std::max(root(*a), root(*b))] = std::min(root(*a), root(*b));
    }
    for (size_t i = 0; i < shapes_.size(); ++i)
        for (uint32_t v = 0; v < shapes_[i].mass.size(); ++v) {
            if (v == 0) ids_.emplace_back();
            ids_.back().push_back(root(first[i] + v));
        }
}

// Of cloths with themselves, and between any two; of solids with themselves apart, as cells that are turned inside out
// cross as well.
void SoftMetrics::measure_crossings() {
    std::vector<Skin> skins;
    for (size_t i = 0; i < shapes_.size(); ++i) skins.push_back({states_[i].points, shapes_[i].faces, ids_[i]});
    const Crossings found = count_crossings(skins);
    pairs_end_ = found.between;
    pairs_own_end_ = 0;
    for (size_t i = 0; i < skins.size(); ++i) (i < scene_.cloths.size() ? pairs_end_ : pairs_own_end_) += found.own[i];
    pairs_ = std::max(pairs_, pairs_end_);
    pairs_own_ = std::max(pairs_own_, pairs_own_end_);
}

void SoftMetrics::measure_cells(uint32_t step) {
    inverted_end_ = 0;
    for (size_t i = 0; i < shapes_.size(); ++i) {
        const std::vector<taut_pos>& x = states_[i].points;
        const auto& tets = shapes_[i].tets;
        for (size_t c = 0; c < tets.size(); c += shapes_[i].tets_a_cell)
            inverted_end_ += std::any_of(
                tets.begin() + static_cast<std::ptrdiff_t>(c),
                tets.begin() + static_cast<std::ptrdiff_t>(c + shapes_[i].tets_a_cell),
                [&](const auto& t) { return !(six_volumes(of(x[t[0]]), of(x[t[1]]), of(x[t[2]]), of(x[t[3]])) > 0); });
    }
    inverted_ = std::max(inverted_, inverted_end_);
    if (inverted_end_ > 0) inverted_until_ = step + 1;
}

void SoftMetrics::after_step(uint32_t step, double rigid, const std::vector<Motion>& bodies) {
    read();
    if (!finite_) return;
    measure_stretch();
    measure_depth(bodies);
    measure_cells(step);
    if (step % kEvery == 0 || step == last_) measure_crossings();
    const double now = energy() + rigid;
    energy_most_ = std::max(energy_most_, now);
    if (step == one_second_) energy_lost_ = (energy_start_ - now) / weight_;
    if (step < last_second_) return;
    for (const SoftState& state : states_)
        for (const taut_vec3& v : state.velocities) {
            rest_sum_ += length(of(v));
            ++rest_count_;
        }
    for (const uint32_t v : scene_.roles.tip) {
        tip_sum_ += (tip_height_ - states_[scene_.cloths.size()].points[v].y) / scene_.roles.tip_sink;
        ++tip_count_;
    }
}

void SoftMetrics::report(nlohmann::ordered_json& json) const {
    size_t vertices = 0, elements = 0;
    for (const scenes::Cloth& cloth : scene_.cloths) {
        vertices += cloth.points.size();
        elements += cloth.triangles.size() / 3 + cloth.quads.size() / 4;
    }
    for (const scenes::Solid& solid : scene_.solids) {
        vertices += solid.points.size();
        if (!solid.cells.empty()) elements += solid.cells.size() / solid.def.corners;
    }
    json["vertices"] = vertices;
    json["elements"] = elements;
    if (!scene_.cloths.empty()) {
        json["peak_pct"] = 100 * peak_;
        json["end_pct"] = 100 * end_;
        json["mean_pct"] = 100 * mean_;
    }
    json["energy_lost_m"] = nullptr;
    if (std::isfinite(energy_lost_)) json["energy_lost_m"] = energy_lost_;
    json["energy_max"] = 1 + (energy_most_ - energy_start_) / (weight_ * size_);
    json["deep_mm"] = 1e3 * deep_;
    json["deep_end_mm"] = 1e3 * deep_end_;
    json["pairs"] = pairs_;
    json["pairs_end"] = pairs_end_;
    if (!scene_.solids.empty()) {
        json["inverted"] = inverted_;
        json["inverted_end"] = inverted_end_;
        json["inverted_until"] = inverted_until_;
        json["pairs_own"] = pairs_own_;
        json["pairs_own_end"] = pairs_own_end_;
    }
    if (!scene_.roles.tip.empty()) json["tip_ratio"] = tip_ratio();
    json["rest_speed"] = rest_count_ > 0 ? rest_sum_ / static_cast<double>(rest_count_) : 0.0;
}

}  // namespace bench
