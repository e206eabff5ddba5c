#include "models/plastic.h"

#include <algorithm>

#include "constraints/singular_values.h"

namespace taut {
namespace {

constexpr uint32_t kFlowGrain = 64;  // elements that a thread takes at a time

Mat3 set_of(const Soft& soft, uint32_t element) { return Mat3::Map(&soft.plastic[9 * size_t{element}]); }

// Its gradients g are of the set that it has, F_p^-T times those of its first rest shape.
void flow_element(const World& world, Soft& soft, ElementSet& elements, uint32_t e) {
    const auto nodes = elements.nodes_of(e);
    const auto& motion = world.nodes.motion;
    double* data = elements.data_of(e);
    double first[kMaxNodes][3];
    Mat3 elastic = Mat3::Zero();
    for (size_t n = 0; n < nodes.size(); ++n)
        elastic += (motion[nodes[n]].x - motion[nodes[0]].x) * Vec3::Map(data + 3 * n).transpose();
    const Mat3 before = set_of(soft, e);
    Mat3 set = before;
    if (!flow(elastic * before, soft.law, world.def.time_step, set)) return;
    for (size_t n = 0; n < nodes.size(); ++n) Vec3::Map(first[n]) = before.transpose() * Vec3::Map(data + 3 * n);
    double gradients[kMaxNodes][3];
    apply_set(set, first, static_cast<int>(nodes.size()), gradients);
    std::copy_n(&gradients[0][0], 3 * nodes.size(), data);
    Mat3::Map(&soft.plastic[9 * size_t{e}]) = set;
}

}  // namespace

void flow_solids(World& world) {
    for (Soft& soft : world.softs.record) {
        if (soft.plastic.empty()) continue;
        ElementSet& elements = world.elements.set[soft.sets[0].set];
        world.team.for_ranges(elements.size(), kFlowGrain, [&](uint32_t begin, uint32_t end) {
            for (uint32_t e = begin; e < end; ++e) {
                const auto awake = [&](uint32_t node) { return world.nodes.rest[node] == Rest::awake; };
                if (std::ranges::any_of(elements.nodes_of(e), awake)) flow_element(world, soft, elements, e);
            }
        });
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
