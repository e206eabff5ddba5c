#include "models/air.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "models/gas.h"

namespace taut {
namespace {

constexpr double kAirTime = 1e4;    // d of drag elements [s]: a step of 0.1 s adds 1e-5 of B
constexpr uint32_t kAirGrain = 64;  // vertices or triangles that a thread takes at a time
constexpr uint32_t kDragNumbers = 12;

void plan_drag(SoftPlan& plan) {
    ElementPlan& element =
        plan.element.emplace_back(*plan.position.get_allocator().memory, kDragElement, SoftPart::drag);
    element.form = ElementForm::energy;
    element.relaxation = kAirTime;
    for (int r = 0; r < 3; ++r) element.compliance[4 * r] = kAirTime;
    const double none[kDragNumbers] = {};
    for (const uint32_t v : plan.soft.surface) element.add({&v, 1}, none, 1);
}

// B of a triangle of this area along its normal, where air passes it at w [kg/s].
Mat3 drag_of(const AirLoad& air, double density, const Vec3& area, const Vec3& w) {
    const double size = area.norm(), speed = w.norm();
    if (!(size > 0 && speed > 0)) return Mat3::Zero();
    const Vec3 normal = area / size;
    const double s = normal.dot(w) / speed;
    if (air.side * s > 0) return Mat3::Zero();  // from within
    Mat3 b = air.lift * normal * normal.transpose();
    b.diagonal().array() += air.drag * std::abs(s) - air.lift * s * s;
    return 0.5 * density * size * speed * b;
}

// G of G^T G = B, upper; what rounding leaves of a pivot is none.
void root_of(const Mat3& b, double* g) {
    constexpr double kRounding = 1e-14;
    const double least = kRounding * b.trace();
    std::fill_n(g, 9, 0.0);
    for (int r = 0; r < 3; ++r) {
        double pivot = b(r, r);
        for (int k = 0; k < r; ++k) pivot -= g[3 * k + r] * g[3 * k + r];
        if (!(pivot > least)) continue;
        const double root = std::sqrt(pivot);
        for (int c = r; c < 3; ++c) {
            double sum = b(r, c);
            for (int k = 0; k < r; ++k) sum -= g[3 * k + r] * g[3 * k + c];
            g[3 * r + c] = sum / root;
        }
    }
}

void find_areas(World& world, const Soft& soft, double time) {
    Array<Vec3>& area = world.softs.area;
    if (area.size() < soft.triangles()) area.resize(soft.triangles());
    const auto at = [&](uint32_t v) { return vertex_at(world, soft, v, time); };
    world.team.for_ranges(soft.triangles(), kAirGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t t = begin; t < end; ++t) {
            const uint32_t* corner = &soft.triangle[3 * size_t{t}];
            const Vec3 x = at(corner[0]);
            area[t] = 0.5 * (at(corner[1]) - x).cross(at(corner[2]) - x);
        }
    });
}

// B of a vertex of the surface.
Mat3 drag_about(const World& world, const Soft& soft, uint32_t i, const Vec3& w) {
    const double density = world.def.air_density;
    Mat3 sum = Mat3::Zero();
    for (uint32_t k = soft.fan_begin[i]; k < soft.fan_begin[i + 1]; ++k)
        sum += drag_of(soft.air, density, world.softs.area[soft.fan[k]], w);
    return sum / 3;
}

// (M + h B) v' = M v* + h B wind.
void drag_alone(System& system, uint32_t at, double mass, const Mat3& b, const Vec3& wind) {
    Velocity& u = system.exact[at];
    const double h = system.scheme.h;
    u.v = (mass * Mat3::Identity() + h * b).llt().solve(mass * u.v + h * b * wind);
    set_sweep_velocity(system.sweep[at].velocity, u);
}

// Rayleigh's damping of masses, at the velocity v_n as the substep begins: v* = v_n/(1 + h a) + h f/M. What rests under
// a load does so as without it.
void damp_masses(World& world, const Soft& soft, uint32_t group) {
    System& system = world.system;
    const double x = system.scheme.h * soft.mass_damping, share = x / (1 + x);
    world.team.for_ranges(soft.vertices(), kAirGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t v = begin; v < end; ++v) {
            const uint32_t node = soft.node[v];
            if (!is_solved_in(world, node, group)) continue;
            const uint32_t at = system.at(node);
            system.exact[at].v -= share * world.nodes.motion[node].v;
            set_sweep_velocity(system.sweep[at].velocity, system.exact[at]);
        }
    });
}

void drag_along(World& world, const Soft& soft, uint32_t group) {
    const taut_vec3 blows = world.def.wind;
    const Vec3 wind(blows.x, blows.y, blows.z);
    const auto of = std::ranges::find(soft.sets, SoftPart::drag, &SoftSet::part);
    ElementSet* set = of == soft.sets.end() ? nullptr : &world.elements.set[of->set];
    world.team.for_ranges(static_cast<uint32_t>(soft.surface.size()), kAirGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const uint32_t node = soft.node[soft.surface[i]];
            if (!is_solved_in(world, node, group)) continue;
            const NodeMotion& m = world.nodes.motion[node];
            const Mat3 b = drag_about(world, soft, i, wind - m.v);
            if (!set) {
                drag_alone(world.system, world.system.at(node), world.nodes.mass[node].mass, b, wind);
                continue;
            }
            double* data = set->data_of(i);
            root_of(b, data);
            Vec3::Map(data + 9) = m.x + kAirTime * wind;
        }
    });
}

}  // namespace

// Those of a group are in the state, at the begin of the substep; kinematic ones are where the frame began.
Vec3 vertex_at(const World& world, const Soft& soft, uint32_t vertex, double time) {
    const uint32_t node = soft.node[vertex];
    const NodeMotion& m = world.nodes.motion[node];
    const bool led = world.nodes.info[node].kind == NodeKind::kinematic && world.nodes.rest[node] == Rest::awake;
    return led ? Vec3(m.x + time * m.v) : m.x;
}

bool is_solved_in(const World& world, uint32_t node, uint32_t group) {
    return world.nodes.solved(node) && world.partition.island_of(node) != kNone &&
           world.partition.group_of(node) == group;
}

void list_surface(Soft& soft, uint32_t vertices) {
    const auto memory = soft.node.get_allocator();
    Array<uint32_t> count(vertices, 0, memory), index(vertices, 0, memory), surface(memory), fan_begin(memory);
    for (const uint32_t v : soft.triangle) ++count[v];
    uint32_t begin = 0;
    for (uint32_t v = 0; v < vertices; ++v) {
        if (count[v] == 0) continue;
        index[v] = static_cast<uint32_t>(surface.size());
        surface.push_back(v);
        fan_begin.push_back(begin);
        begin += count[v];
    }
    fan_begin.push_back(begin);
    Array<uint32_t> fan(begin, 0, memory), next(fan_begin);
    for (uint32_t t = 0; t < soft.triangles(); ++t)
        for (uint32_t k = 0; k < 3; ++k) fan[next[index[soft.triangle[3 * t + k]]]++] = t;
    soft.surface = std::move(surface);
    soft.fan_begin = std::move(fan_begin);
    soft.fan = std::move(fan);
}

const char* plan_air(const AirTraits& traits, SoftPlan& plan) {
    Soft& soft = plan.soft;
    Memory& memory = *plan.position.get_allocator().memory;
    const bool encloses = traits.pressure != 0 || traits.gas;
    const bool closed = soft.kind == SoftKind::solid || is_closed(soft.triangle, memory);
    soft.air.drag = traits.drag;
    soft.air.lift = traits.lift;
    const auto vertices = static_cast<uint32_t>(plan.position.size());
    if (closed) {
        // The side of a flat one is that of its normals.
        const double volume = enclosed_volume(soft, [&](uint32_t v) -> const Vec3& { return plan.position[v]; });
        double size = 0;
        for (uint32_t v = 0; v < vertices; ++v)
            size = std::max(size, (plan.position[v] - plan.position[soft.triangle[0]]).norm());
        constexpr double kRounding = 1e-12;
        const double least = kRounding * size * size * size;
        soft.air.side = volume < -least ? -1 : 1;
        if (encloses) {
            if (traits.swept) return kSweptPressure;
            if (!is_one_piece(soft.triangle, vertices, memory)) return "pressure: the mesh is in several pieces";
            const double within = std::abs(volume) > least ? std::abs(volume) : 0;
            if (const char* fault = set_pressure(soft.air, traits.pressure, within, traits.gas, traits.outside))
                return fault;
        }
    } else if (encloses) {
        return "pressure: the mesh is open";
    }
    if (soft.air.any()) list_surface(soft, vertices);
    if (soft.air.drag > 0 && !traits.swept && soft.tear_strain == 0) plan_drag(plan);
    return nullptr;
}

bool find_loaded_surfaces(World& world, uint32_t group) {
    Softs& softs = world.softs;
    softs.loaded.clear();
    for (uint32_t s = 0; s < softs.record.size(); ++s) {
        const Soft& soft = softs.record[s];
        const auto solved = [&](uint32_t node) { return is_solved_in(world, node, group); };
        if ((soft.air.any() || soft.mass_damping > 0) && std::ranges::any_of(soft.node, solved))
            softs.loaded.push_back(s);
    }
    return !softs.loaded.empty();
}

void load_surfaces(World& world, uint32_t group, double time) {
    for (const uint32_t s : world.softs.loaded) {
        const Soft& soft = world.softs.record[s];
        if (soft.mass_damping > 0) damp_masses(world, soft, group);
        if (!soft.air.any()) continue;
        find_areas(world, soft, time);
        if (soft.air.drag > 0) drag_along(world, soft, group);
        if (soft.air.encloses()) push_by_pressure(world, soft, group, time);
    }
}

}  // namespace taut
