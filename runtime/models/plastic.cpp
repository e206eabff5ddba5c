#include "models/plastic.h"

#include <algorithm>

#include "constraints/singular_values.h"
#include "models/soft_reading.h"

namespace taut {
namespace {

constexpr uint32_t kFlowGrain = 64;  // elements that a thread takes at a time

Mat3 set_of(const Soft& soft, uint32_t element) { return Mat3::Map(&soft.plastic[9 * size_t{element}]); }

// Of Soft::flows: it flowed and was not unloaded since; it began to in the last step.
constexpr uint8_t kFlowed = 1, kBegan = 2;
constexpr double kUnloaded = 0.9;  // of the yield: what is strained by less has been unloaded, and may begin anew

Mat3 deformation_of(const World& world, const Soft& soft, const ElementSet& elements, uint32_t e) {
    const auto nodes = elements.nodes_of(e);
    const auto& motion = world.nodes.motion;
    const double* data = elements.data_of(e);
    Mat3 elastic = Mat3::Zero();
    for (size_t n = 0; n < nodes.size(); ++n)
        elastic += (motion[nodes[n]].x - motion[nodes[0]].x) * Vec3::Map(data + 3 * n).transpose();
    return elastic * set_of(soft, e);
}

// Whether it would flow at so much of its yield.
bool is_loaded(const World& world, const Soft& soft, const ElementSet& elements, uint32_t e) {
    Plasticity less = soft.law;
    less.yield *= kUnloaded;
    less.hardening *= kUnloaded;
    Mat3 set = set_of(soft, e);
    double flowed = soft.flowed[e];
    return flow(deformation_of(world, soft, elements, e), less, world.def.time_step, set, &flowed);
}

// Its gradients g are of the set that it has, F_p^-T times those of its first rest shape. True where it flowed.
bool flow_element(const World& world, Soft& soft, ElementSet& elements, uint32_t e) {
    const auto nodes = elements.nodes_of(e);
    double* data = elements.data_of(e);
    double first[kMaxNodes][3];
    const Mat3 before = set_of(soft, e);
    Mat3 set = before;
    const Mat3 f = deformation_of(world, soft, elements, e);
    if (!flow(f, soft.law, world.def.time_step, set, &soft.flowed[e])) return false;
    for (size_t n = 0; n < nodes.size(); ++n) Vec3::Map(first[n]) = before.transpose() * Vec3::Map(data + 3 * n);
    double gradients[kMaxNodes][3];
    apply_set(set, first, static_cast<int>(nodes.size()), gradients);
    std::copy_n(&gradients[0][0], 3 * nodes.size(), data);
    Mat3::Map(&soft.plastic[9 * size_t{e}]) = set;
    return true;
}

// Of cells of which a Gauss point began to flow, and none went on to.
void tell_yields(World& world, uint32_t index) {
    const Soft& soft = world.softs.record[index];
    for (uint32_t e = 0; e < soft.flows.size(); e += soft.cell_points) {
        const uint8_t* point = &soft.flows[e];
        const auto is = [&](uint8_t state) { return std::find(point, point + soft.cell_points, state); };
        if (is(kBegan) == point + soft.cell_points || is(kFlowed) != point + soft.cell_points) continue;
        const uint32_t cell = e / soft.cell_points;
        world.yielded.push_back({world.solid_handle(index), soft.user_data, cell,
                                 static_cast<float>(cell_state(world, soft, cell).stress),
                                 static_cast<float>(plastic_strain(soft, cell)), world.window.steps});
    }
}

}  // namespace

void flow_solids(World& world) {
    for (uint32_t index = 0; index < world.softs.record.size(); ++index) {
        Soft& soft = world.softs.record[index];
        if (soft.plastic.empty()) continue;
        ElementSet& elements = world.elements.set[soft.sets[0].set];
        world.team.for_ranges(elements.size(), kFlowGrain, [&](uint32_t begin, uint32_t end) {
            for (uint32_t e = begin; e < end; ++e) {
                const auto awake = [&](uint32_t node) { return world.nodes.rest[node] == Rest::awake; };
                uint8_t& state = soft.flows[e];
                if (!std::ranges::any_of(elements.nodes_of(e), awake))
                    state = state != 0 ? kFlowed : 0;
                else if (flow_element(world, soft, elements, e))
                    state = state != 0 ? kFlowed : kBegan;
                else
                    state = state != 0 && is_loaded(world, soft, elements, e) ? kFlowed : 0;
            }
        });
        tell_yields(world, index);
    }
}

double plastic_strain(const Soft& soft, uint32_t cell) {
    if (soft.plastic.empty()) return 0;
    double sum = 0;
    for (uint32_t k = 0; k < soft.cell_points; ++k)
        sum += (singular_values<3>(set_of(soft, cell * soft.cell_points + k)).sigma - Vec3::Ones()).norm();
    return sum / soft.cell_points;
}

}  // namespace taut
