// A tunic of two panels, sewn together at sides and shoulders, on a mannequin that sways.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "builders.h"
#include "parts.h"
#include "pose.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// Vertices of a panel, before its neck is cut.
struct Weave {
    int rows, columns;
};

// Panels touch themselves and the body, not each other, between which it is: at a seam that folds they cross whatever
// pushes them apart.
constexpr int32_t kPanels = -23;

constexpr double kHem = 0.72, kLength = 0.72;       // height of the hem, from there to the shoulders [m]
constexpr double kArmhole = 0.47, kNeck = 0.085;    // sides are sewn up to; half of its opening [m]
constexpr double kShoulders = 0.44, kFlare = 0.05;  // from where the panels close over the shoulders [m]

// Half of a panel's width at a height over the hem [m].
double half_width(double height) {
    if (height < kArmhole) return 0.27 + kFlare * std::pow(1 - height / kArmhole, 2);
    const double t = (height - kArmhole) / (kLength - kArmhole);
    return 0.27 - 0.07 * std::fmin(1, 3 * t);
}

// Where the point of a panel is on the figure: rows are half ellipses as long as the panel is wide, which flatten over
// the shoulders. front: 1 or -1.
taut_pos draped(double across, double height, double front) {
    const double half = half_width(height), round = 2 * half / std::numbers::pi;
    const double t = std::fmax(0, (height - kShoulders) / (kLength - kShoulders));
    const double deep = 0.9 * round * std::sqrt(std::fmax(0, 1 - t * t));
    // Ramanujan's circumference of an ellipse: half of it is 2 half.
    double wide = half;
    for (int i = 0; i < 30; ++i) {
        const double h = std::pow((wide - deep) / (wide + deep), 2);
        const double mean = 1 + 3 * h / (10 + std::sqrt(4 - 3 * h));
        wide = 4 * half / (std::numbers::pi * mean) - deep;
    }
    const double angle = across / half * std::numbers::pi / 2;
    return {wide * std::sin(angle), kHem + height - 0.1 * t * t, front * (deep * std::cos(angle) + 0.002)};
}

// Vertices on the sides and shoulders are the same on both panels.
Cloth panel(const Weave& weave, double front) {
    Cloth cloth = grid_cloth(weave.rows, weave.columns, 1, 1, 0);
    taut_cloth_def_set_fabric(&cloth.def, TAUT_FABRIC_COTTON);
    cloth.def.damping = 0.01f;
    cloth.def.material.friction = 0.4f;
    cloth.uv.clear();
    cloth.points.clear();
    for (int i = 0; i < weave.rows; ++i)
        for (int k = 0; k < weave.columns; ++k) {
            const double height = kLength * i / (weave.rows - 1);
            const double across = half_width(height) * (2.0 * k / (weave.columns - 1) - 1);
            cloth.points.push_back(draped(across, height, front));
            cloth.rest.push_back({across, height, 0});
            cloth.uv.insert(cloth.uv.end(), {static_cast<float>(height), static_cast<float>(across)});
        }
    return cloth;
}

// Without the neck: triangles go of which a corner lies in it, then vertices that none has left. Returns the new
// numbers of vertices, -1 for those that are gone.
std::vector<int> cut_neck(Cloth& cloth) {
    constexpr double kDeep = 0.07;  // [m]
    const auto in_neck = [&](uint32_t v) {
        const double x = cloth.rest[v].x / kNeck, y = (cloth.rest[v].y - kLength) / kDeep;
        return x * x + y * y < 1;
    };
    std::vector<uint32_t> kept;
    for (size_t t = 0; t < cloth.triangles.size(); t += 3) {
        const uint32_t* v = &cloth.triangles[t];
        if (!in_neck(v[0]) && !in_neck(v[1]) && !in_neck(v[2])) kept.insert(kept.end(), v, v + 3);
    }
    std::vector<int> place(cloth.points.size(), -1);
    for (const uint32_t v : kept) place[v] = 0;
    Cloth old = std::move(cloth);
    cloth = old;
    cloth.points.clear();
    cloth.rest.clear();
    cloth.uv.clear();
    for (size_t v = 0; v < place.size(); ++v) {
        if (place[v] < 0) continue;
        place[v] = static_cast<int>(cloth.points.size());
        cloth.points.push_back(old.points[v]);
        cloth.rest.push_back(old.rest[v]);
        cloth.uv.insert(cloth.uv.end(), {old.uv[2 * v], old.uv[2 * v + 1]});
    }
    cloth.triangles.clear();
    for (const uint32_t v : kept) cloth.triangles.push_back(static_cast<uint32_t>(place[v]));
    return place;
}

void sew(Scene& scene, const Weave& weave, const std::vector<int>& place) {
    for (int i = 0; i < weave.rows; ++i)
        for (int k = 0; k < weave.columns; ++k) {
            const bool side = (k == 0 || k == weave.columns - 1) && kLength * i / (weave.rows - 1) < kArmhole;
            const int vertex = place[static_cast<size_t>(i * weave.columns + k)];
            if ((!side && i != weave.rows - 1) || vertex < 0) continue;
            Joint stitch;
            stitch.vertex_a.cloth = 0;
            stitch.vertex_b.cloth = 1;
            stitch.vertex_a.vertex = stitch.vertex_b.vertex = static_cast<uint32_t>(vertex);
            stitch.drawn_radius = 0;
            scene.add_joint(stitch);
        }
}

Motion swaying(int body) {
    Motion sway;
    sway.body = body;
    sway.along = {0.9f, 0, 0.4f};
    sway.track.keys = {{0, 0, 0}};
    sway.track.shake = {0.12, 0.8, 2, 7};
    return sway;
}

// Turns to and fro about an axis through a point.
Motion swinging(int body, taut_vec3 about, taut_pos pivot, double angle, double frequency) {
    Motion swing;
    swing.body = body;
    swing.about = about;
    swing.pivot = pivot;
    swing.track.keys = {{0, 0, 0}};
    swing.track.shake = {angle, frequency, 1, 1e3};
    return swing;
}

// Legs step, arms rise, and all of it turns and shifts.
void walk(Scene& scene, int first) {
    for (const double side : {-1.0, 1.0}) {
        const auto s = static_cast<float>(side);
        const int arm = first + (side < 0 ? 5 : 6), leg = first + (side < 0 ? 7 : 8);
        scene.motions.push_back(swinging(arm, {0.4f * s, 0, s}, {0.17 * side, 1.33, 0}, 0.45, 0.6));
        scene.motions.push_back(swinging(leg, {s, 0, 0}, {0.08 * side, 0.9, 0}, 0.3, 0.6));
    }
    for (int body = first; body < static_cast<int>(scene.bodies.size()); ++body) {
        scene.motions.push_back(swinging(body, {0, 1, 0}, {0, 0, 0}, 0.7, 0.3));
        scene.motions.push_back(swaying(body));
    }
}

// A limb of the mannequin.
struct Limb {
    taut_pos from, to;
    double radius;
};
constexpr Limb kLimbs[] = {
    {{0, 0.95, 0}, {0, 1.22, 0}, 0.125},          // trunk
    {{-0.045, 1.24, 0}, {0.045, 1.24, 0}, 0.11},  // chest
    {{-0.15, 1.33, 0}, {0.15, 1.33, 0}, 0.055},   // shoulders
    {{0, 1.4, 0}, {0, 1.5, 0}, 0.05},             // neck
    {{0, 1.58, 0.01}, {0, 1.65, 0.01}, 0.09},     // head
    {{-0.17, 1.33, 0}, {-0.36, 1.08, 0}, 0.042},  // arms
    {{0.17, 1.33, 0}, {0.36, 1.08, 0}, 0.042},
    {{-0.08, 0.88, 0}, {-0.09, 0.1, 0}, 0.075},  // legs
    {{0.08, 0.88, 0}, {0.09, 0.1, 0}, 0.075},
};

// Moved out of a limb to a distance from it.
taut_pos outside(const Limb& limb, double away, taut_pos p) {
    const taut_pos along = minus(limb.to, limb.from), there = minus(p, limb.from);
    const double square = along.x * along.x + along.y * along.y + along.z * along.z;
    const double t = std::clamp((along.x * there.x + along.y * there.y + along.z * there.z) / square, 0.0, 1.0);
    const taut_pos axis = plus(limb.from, t * along.x, t * along.y, t * along.z);
    const double distance = length(minus(p, axis)), wanted = limb.radius + away;
    return distance >= wanted || distance == 0 ? p : toward(axis, p, wanted);
}

// The start of both panels, fitted: edges as long as in the pattern, seams closed, outside of the body, each panel on
// its side of it; by sweeps of projections (Jakobsen 2001). What draped() says is stretched by half over the shoulders,
// and let go so the tunic would fling itself about.
void fit(Scene& scene) {
    constexpr int kRounds = 600;
    struct Edge {
        Cloth* cloth;
        uint32_t a, b;
        double rest;
    };
    std::vector<Edge> edges;
    std::vector<bool> sewn(scene.cloths[0].points.size(), false);
    for (const Joint& stitch : scene.joints) sewn[stitch.vertex_a.vertex] = true;
    for (Cloth& cloth : scene.cloths) {
        std::set<std::pair<uint32_t, uint32_t>> seen;
        for (size_t t = 0; t < cloth.triangles.size(); ++t) {
            const uint32_t v = cloth.triangles[t], next = cloth.triangles[t % 3 == 2 ? t - 2 : t + 1];
            const auto [a, b] = std::minmax(v, next);
            if (seen.emplace(a, b).second) edges.push_back({&cloth, a, b, length(minus(cloth.rest[b], cloth.rest[a]))});
        }
    }
    const double away = static_cast<double>(scene.cloths[0].def.thickness);
    for (int round = 0; round < kRounds; ++round) {
        for (const Edge& edge : edges) {
            taut_pos &a = edge.cloth->points[edge.a], &b = edge.cloth->points[edge.b];
            const taut_pos centre = middle(a, b), half = minus(b, centre);
            const double scale = edge.rest / (2 * length(half));
            a = plus(centre, -scale * half.x, -scale * half.y, -scale * half.z);
            b = plus(centre, scale * half.x, scale * half.y, scale * half.z);
        }
        for (size_t v = 0; v < sewn.size(); ++v) {
            taut_pos &front = scene.cloths[0].points[v], &back = scene.cloths[1].points[v];
            if (sewn[v]) front = back = middle(front, back);
            front.z = sewn[v] ? front.z : std::fmax(front.z, away);
            back.z = sewn[v] ? back.z : std::fmin(back.z, -away);
            for (const Limb& limb : kLimbs) front = outside(limb, away, front), back = outside(limb, away, back);
        }
    }
}

// Returns its first body; all follow in the order of the limbs.
int add_mannequin(Scene& scene) {
    for (const Limb& limb : kLimbs) {
        const int body = add_capsule(scene, limb.from, limb.to, limb.radius, 0, Look::wood);
        scene.bodies[static_cast<size_t>(body)].kind = TAUT_BODY_KINEMATIC;
    }
    return static_cast<int>(scene.bodies.size() - std::size(kLimbs));
}

// The tunic on its mannequin, which does not move yet; columns: vertices across a panel.
Scene dressed(int columns, int& mannequin) {
    const Weave weave = {columns * 34 / 25, columns};
    Scene scene = soft_hall(1.6);
    add_ground(scene);
    std::vector<int> place;
    for (const double front : {1.0, -1.0}) {
        Cloth cloth = panel(weave, front);
        place = cut_neck(cloth);
        if (front < 0)
            for (size_t t = 0; t < cloth.triangles.size(); t += 3)
                std::swap(cloth.triangles[t], cloth.triangles[t + 1]);
        cloth.look.most = 0.05;
        cloth.def.self_collision = 1;
        cloth.def.filter.group = kPanels;
        scene.add_cloth(std::move(cloth));
    }
    sew(scene, weave, place);
    fit(scene);
    mannequin = add_mannequin(scene);
    scene.camera = {{0.75, 1.5, 2.3}, {-0.3, 0.95, 0}, 38};
    scene.forces = ForceScale{-2, 2};
    scene.stage = {{-1.5, 0, -1.5}, {1.5, 2, 1.5}};
    return scene;
}

}  // namespace

// n vertices across a panel.
Scene build_garment(double n, double, const Options& options) {
    int first = 0;
    Scene scene = dressed(std::max(5, static_cast<int>(n)), first);
    for (int body = first; body < static_cast<int>(scene.bodies.size()); ++body) scene.motions.push_back(swaying(body));
    perturb(scene, options.seed);
    return scene;
}

// The same on a body that steps and turns.
Scene build_garment_on_body(double, double, const Options& options) {
    int first = 0;
    Scene scene = dressed(15, first);
    walk(scene, first);
    for (Cloth& cloth : scene.cloths) {
        cloth.look.colours = SoftColours::plain;
        cloth.look.paint = 0x3D7EBF;
    }
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
