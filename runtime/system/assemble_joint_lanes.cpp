// Coordinates and Jacobians of swept joints in lanes, and their forces back.
#include <algorithm>

#include "system/assemble.h"

namespace taut {
namespace {

constexpr uint32_t kGrain = 8;  // lane groups that a thread takes at a time

uint32_t size_of(const auto& array) { return static_cast<uint32_t>(array.size()); }

// C and J of types that are evaluated one by one.
void load_rows(System& system, const JointGroup& g, int lane) {
    JointLanes& lanes = system.joints;
    const Rows& rows = system.rows;
    const RowBlock& block = rows.block[g.block[lane]];
    for (uint32_t r = 0; r < g.rows; ++r)
        lanes.coordinate[g.first_row + r].value[lane] = static_cast<float>(rows.error[block.row + r]);
    for (uint32_t e = 0; e < kDof * g.nodes * g.rows; ++e)
        lanes.jacobian[g.first_jacobian + e].value[lane] = static_cast<float>(rows.jacobian[block.jacobian + e]);
}

void evaluate_group(System& system, const JointGroup& g) {
    JointLanes& lanes = system.joints;
    if (g.first_frames == kNoLanes) {
        for (int lane = 0; lane < kLanes; ++lane)
            if (g.block[lane] != kNoLanes) load_rows(system, g, lane);
        return;
    }
    const float* pose[2][kLanes];
    for (int end = 0; end < 2; ++end)
        for (int lane = 0; lane < kLanes; ++lane) pose[end][lane] = system.sweep_pose[g.node[end][lane]].dx;
    LaneScalar value[kMaxRows];
    g.type->evaluate_lanes(lanes.frames[g.first_frames], pose, value, &lanes.jacobian[g.first_jacobian]);
    for (uint32_t r = 0; r < g.rows; ++r)
        std::copy(value[r].value, value[r].value + kLanes, lanes.coordinate[g.first_row + r].value);
}

void store_lane(const System& system, const JointGroup& g, int lane) {
    const JointLanes& lanes = system.joints;
    const RowBlock& block = system.rows.block[g.block[lane]];
    for (uint32_t r = 0; r < g.rows; ++r) {
        block.force[r] = lanes.row[g.first_row + r].impulse[lane] / system.h;
        if (!block.stops_angle(static_cast<int>(r))) continue;
        const double c = lanes.coordinate[g.first_row + r].value[lane];
        block.memory[r].angle = static_cast<float>(angle_between_stops(block.axis[r], block.memory[r], c));
    }
    for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
        const LaneAxis& axis = lanes.axis[a];
        if (axis.force[lane]) *axis.force[lane] = static_cast<float>(axis.impulse[lane] / system.h);
    }
}

}  // namespace

void evaluate_joint_lanes(Team& team, System& system, const JointKernels& kernels) {
    JointLanes& lanes = system.joints;
    team.for_ranges(size_of(lanes.group), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) evaluate_group(system, lanes.group[i]);
        kernels.prepare(lanes.view(), begin, end, system.sweep.data(), static_cast<float>(system.frame_left));
    });
}

void store_joint_lanes(Team& team, const System& system) {
    const JointLanes& lanes = system.joints;
    team.for_ranges(size_of(lanes.group), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes.group[i].block[lane] != kNoLanes) store_lane(system, lanes.group[i], lane);
    });
}

}  // namespace taut
