// Coordinates and Jacobians of swept joints in lanes, and their forces back.
#include <algorithm>
#include <cmath>

#include "constraints/soft_contact.h"
#include "system/assemble.h"

namespace taut {
namespace {

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

// visit(seat, K) for the moving ends of all joints.
template <class Visit>
void for_each_end(const System& system, Visit visit) {
    const JointLanes& lanes = system.joints;
    for (uint32_t i = 0; i < lanes.group.size(); ++i) {
        const JointGroup& g = lanes.group[i];
        for (uint32_t n = 0; n < g.nodes && n < 2; ++n)
            for (int lane = 0; lane < kLanes; ++lane)
                if (g.block[lane] != kNoLanes) visit(g.node[n][lane], lanes.stiffness[i].of[n][lane]);
    }
}

// (I + h^2 K') w = I w* + h^2 K' s with K' = k |I^-1| I, which is not less than k in any direction; |I^-1| by its
// largest sum of a row. s: the low-passed spin.
void stiffen(System& system, const Nodes& nodes, uint32_t at, float k, bool filters) {
    SweepNode& node = system.sweep[at];
    if (system.in_block[at] || node.mass.inv_mass == 0) return;
    float(&i)[6] = node.mass.inv_inertia;
    for (float& each : i) each /= system.joint_share[at];  // of the last substep
    const float xy = std::abs(i[3]), xz = std::abs(i[4]), yz = std::abs(i[5]);
    const float most = std::max({i[0] + xy + xz, i[1] + xy + yz, i[2] + xz + yz});
    const auto h = static_cast<float>(system.scheme.h), act = static_cast<float>(system.scheme.act);
    const float share = 1 / (1 + h * act * k * most);
    system.joint_share[at] = share;
    for (float& each : i) each *= share;
    const uint32_t from = system.node_at[at];
    const Vec3& slow = system.lent ? system.motion[at].slow_w : nodes.motion[from].slow_w;
    for (int a = 0; a < 3; ++a) {
        const float spared = filters ? static_cast<float>(slow[a]) : 0.0f;
        node.velocity.w[a] = spared + share * (node.velocity.w[a] - spared) + 0.0f;
    }
}

void store_lane(const System& system, const JointGroup& g, int lane) {
    const JointLanes& lanes = system.joints;
    const RowBlock& block = system.rows.block[g.block[lane]];
    for (uint32_t r = 0; r < g.rows; ++r) {
        block.force[r] = lanes.row[g.first_row + r].impulse[lane] / system.scheme.act;
        if (!block.stops_angle(static_cast<int>(r))) continue;
        const double c = lanes.coordinate[g.first_row + r].value[lane];
        block.memory[r].angle = static_cast<float>(angle_between_stops(block.axis[r], block.memory[r], c));
    }
    for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
        const LaneAxis& axis = lanes.axis[a];
        if (axis.force[lane]) *axis.force[lane] = static_cast<float>(axis.impulse[lane] / system.scheme.act);
    }
}

}  // namespace

void evaluate_joint_lanes(Team& team, System& system) {
    team.for_ranges(size_of(system.joints.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) evaluate_group(system, system.joints.group[i]);
    });
}

void stiffen_joints(Team& team, System& system, const Nodes& nodes, const JointKernels& kernels, bool filters) {
    JointLanes& lanes = system.joints;
    if (lanes.group.empty()) return;
    const auto act = static_cast<float>(system.scheme.act);
    team.for_ranges(size_of(lanes.group), kLaneGrain,
                    [&](uint32_t begin, uint32_t end) { kernels.stiffen(lanes.view(), begin, end, act); });
    grow_to(lanes.node_stiffness, system.sweep.size());
    for_each_end(system, [&](uint32_t at, float) { lanes.node_stiffness[at] = 0; });
    for_each_end(system, [&](uint32_t at, float k) { lanes.node_stiffness[at] += k; });
    for_each_end(system, [&](uint32_t at, float) {
        if (lanes.node_stiffness[at] >= 0) stiffen(system, nodes, at, lanes.node_stiffness[at], filters);
        lanes.node_stiffness[at] = -1;
    });
}

void prepare_joint_lanes(Team& team, System& system, const JointKernels& kernels) {
    JointLanes& lanes = system.joints;
    const SweepTerms terms = joint_terms(system.scheme.h, system.stretch);
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        kernels.prepare(lanes.view(), begin, end, system.sweep.data(), static_cast<float>(system.frame_left), terms);
    });
}

void store_joint_lanes(Team& team, const System& system) {
    const JointLanes& lanes = system.joints;
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes.group[i].block[lane] != kNoLanes) store_lane(system, lanes.group[i], lane);
    });
}

}  // namespace taut
