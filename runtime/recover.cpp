#include "recover.h"

#include <algorithm>
#include <iterator>

#include "integrate/integrate.h"
#include "models/bodies.h"
#include "models/soft_reading.h"
#include "solvers/minimisation.h"
#include "system/assemble.h"
#include "system/reached.h"

namespace taut {
namespace {

// What moves of it and its cells, alone.
void list_alone(const World& world, const Soft& soft, Group& group) {
    for (const uint32_t node : soft.node)
        if (moves_by_forces(world.nodes.info[node].kind)) group.nodes.push_back(node);
    for (const SoftSet& of : soft.sets) {
        if (of.part != SoftPart::stretch) continue;
        for (uint32_t e = 0; e < world.elements.set[of.set].size(); ++e) group.elements.push_back({of.set, e});
    }
}

// Its rest without external forces, as the velocities in System::exact that lead there within h.
void relax_alone(World& world, const Soft& soft, Partition& alone, uint32_t most_steps) {
    System& system = world.system;
    Group& group = alone.groups[0];
    world.nodes.list_active();
    system.reached.clear();
    std::ranges::copy_if(soft.node, std::back_inserter(system.reached),
                         [&](uint32_t node) { return stands_by(world.nodes, node); });
    begin_frame(world.team, system, alone, world.nodes, true);
    system.scheme = {};
    system.scheme.set_length(world.def.time_step);
    system.frame_left = 0;
    build_rows(system, group, alone.blocks, world.joints, world.elements, world.pairs, world.nodes, false, true);
    for (const uint32_t node : soft.node) system.exact[system.at(node)] = system.start[system.at(node)] = {};
    const double h = system.scheme.h;  // in which forces that are left would move it by less than that
    Relaxation relaxation{world.def.minimise_tolerance / (h * h), most_steps};
    const MinimisationSettings minimisation{0, true, &relaxation};
    SolverSettings settings{};
    settings.minimisation = &minimisation;
    SolverReport report;
    Substep substep{world.team, system, group, alone.blocks, world.nodes, settings, report, world.scratch, true};
    kMinimisation.solve(substep);
}

}  // namespace

uint32_t inverted_cells(const World& world, const Soft& soft) {
    uint32_t count = 0;
    for (uint32_t cell = 0; cell < cells_of(world, soft); ++cell)
        count += cell_state(world, soft, cell).volume > 0 ? 0 : 1;
    return count;
}

void recover(World& world, const Soft& soft, uint32_t most_steps) {
    Partition alone(world.memory);
    alone.groups.emplace_back(world.memory);
    alone.group_count = 1;
    const Group& group = alone.groups[0];
    list_alone(world, soft, alone.groups[0]);
    if (group.nodes.empty()) return;
    relax_alone(world, soft, alone, most_steps);
    const auto mean = [&](auto&& velocity_of) {
        double mass = 0;
        Vec3 momentum = Vec3::Zero();
        for (const uint32_t node : group.nodes) {
            mass += world.nodes.mass[node].mass;
            momentum += world.nodes.mass[node].mass * velocity_of(node);
        }
        return Vec3(momentum / mass);
    };
    const auto way_of = [&](uint32_t node) { return world.system.exact[world.system.at(node)].v; };
    const bool free = group.nodes.size() == soft.node.size();
    const Vec3 velocity = mean([&](uint32_t node) { return world.nodes.motion[node].v; });
    const Vec3 strayed = free ? mean(way_of) : Vec3(Vec3::Zero());
    for (const uint32_t node : group.nodes) {
        NodeMotion& motion = world.nodes.motion[node];
        motion.x += world.system.scheme.h * (way_of(node) - strayed);
        set_velocity(motion, velocity, Vec3::Zero());
        if (!world.nodes.history.empty()) world.nodes.history[node] = {};
        world.nodes.before[node] = origin_pose(world, node);
        refresh_boxes(world, node);
    }
}

}  // namespace taut
