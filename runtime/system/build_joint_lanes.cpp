// What a frame keeps of swept joints, into lanes: who is where, softness, stops and drives, frames, impulses.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include "constraints/ball.h"
#include "constraints/joint_frames.h"
#include "constraints/soft_contact.h"
#include "system/assemble.h"
#include "system/axis_rows.h"

namespace taut {
namespace {

// AxisRow::part of a row, in the order in which they are swept. The last has its way: what drives against a stop, or
// rubs, is not stronger than it is, however strong.
constexpr uint32_t kParts = 4, kOrder[kParts] = {2, kRubbing, 0, 1};
// A stop that nothing reaches within a substep at this speed, and that does not push, is left out [m/s or rad/s]; not
// one that a drive may reach, which makes any speed.
constexpr double kReach = 50;

// A drive's stiffness is at most what h^2 K = 1/(2 J W J^T) gives, 27 Hz for the ends' turning alone at 240 substeps a
// second: stiffer ones are as much weaker, damping and all. One sweep a substep does not bring such drives of a chain
// together, and what is missing comes back with the warm start (measured: of 20 dolls with drives of 60 Hz to targets
// beyond their stops 20 burst, now none; of half of that stiffness none either, but drives of 10 Hz would be weaker).
constexpr double kDriveSoftness = 2;

constexpr double kMost = kUnlimited;

// visit(row, AxisRow) for each stop, drive and friction of a block that is swept, with drives at their target.
template <class Visit>
void for_each_axis(const RowBlock& block, const Scheme& scheme, Visit visit) {
    if (!block.axis) return;
    for (int r = 0; r < block.type->rows; ++r) {
        const auto row = static_cast<uint32_t>(r);
        if (!block.type->swept(row)) continue;
        const Axis& along = block.axis[r];
        const double target = block.angular(r) ? target_angle(along, along.target) : along.target;
        for_each_axis_row(block, r, target, scheme, [&](const AxisRow& axis) { visit(row, axis); });
    }
}

// Places for what some lane has along a row.
void add_axes(System& system, JointGroup& g, std::span<const uint32_t> blocks) {
    JointLanes& lanes = system.joints;
    bool has[kMaxRows][kParts] = {};
    for (uint32_t b : blocks)
        for_each_axis(system.rows.block[b], system.scheme,
                      [&](uint32_t r, const AxisRow& axis) { has[r][axis.part] = true; });
    g.first_axis = lanes.axis.taken();
    for (uint32_t r = 0; r < g.rows; ++r) {
        for (const uint32_t part : kOrder) {
            if (!has[r][part]) continue;
            LaneAxis& axis = lanes.axis[lanes.axis.take(1)];
            axis.row = r;
            axis.part = part;
        }
    }
    g.axes = lanes.axis.taken() - g.first_axis;
    lanes.law.take(g.axes);
}

// Places for at most kLanes joints of a colour and type; fill_group() clears them.
void add_group(System& system, std::span<const uint32_t> blocks) {
    JointLanes& lanes = system.joints;
    const auto& all = system.rows.block;
    const ConstraintType& type = *all[blocks[0]].type;
    JointGroup& g = lanes.group.emplace_back();
    g.type = &type;
    g.nodes = static_cast<uint32_t>(type.nodes);
    g.rows = g.first_turn = static_cast<uint32_t>(type.rows);
    g.held = 0;
    for (uint32_t b : blocks) g.held = std::max(g.held, static_cast<uint32_t>(all[b].held()));
    if (type.evaluate_lanes) g.first_turn = std::min(g.rows, static_cast<uint32_t>(std::countr_zero(type.angular)));
    g.first_row = lanes.row.take(g.rows);
    lanes.coordinate.take(g.rows);
    g.first_jacobian = lanes.jacobian.take(kDof * g.nodes * g.rows);
    g.first_factor = lanes.factor.take(triangle(g.rows, 0));
    auto elastic = [&](uint32_t b) {
        bool any = false;
        for (int r = 0; r < type.rows; ++r) any = any || (all[b].locked(r) && all[b].elastic(r));
        return any;
    };
    const bool any_elastic = std::any_of(blocks.begin(), blocks.end(), elastic);
    g.first_compliance = any_elastic ? lanes.compliance.take(triangle(g.rows, 0)) : kNoLanes;
    lanes.stiffness[lanes.stiffness.take(1)] = {};
    g.first_frames = type.evaluate_lanes ? lanes.frames.take(1) : kNoLanes;
    add_axes(system, g, blocks);
    std::fill(g.block, g.block + kLanes, kNoLanes);
    std::copy(blocks.begin(), blocks.end(), g.block);
}

// Lane groups of the row blocks [begin, end) of one colour: joints of a type side by side, types as they first occur.
void add_colour(System& system, uint32_t begin, uint32_t end, uint32_t width) {
    const auto& all = system.rows.block;
    for (uint32_t first = begin; first < end; ++first) {
        const ConstraintType* type = all[first].type;
        if (std::any_of(all.begin() + begin, all.begin() + first, [&](const RowBlock& b) { return b.type == type; }))
            continue;
        uint32_t batch[kLanes], filled = 0;
        for (uint32_t b = first; b < end; ++b) {
            if (all[b].type != type) continue;
            batch[filled++] = b;
            if (filled < width) continue;
            add_group(system, {batch, filled});
            filled = 0;
        }
        if (filled > 0) add_group(system, {batch, filled});
    }
    system.joints.colour_begin.push_back(size_of(system.joints.group));
}

struct Times {
    Scheme scheme;
    double frame;  // [s]
    SweepTerms soft;
};

// How soft a locked row is.
void fill_compliance(System& system, const JointGroup& g, uint32_t r, int lane, const RowBlock& block) {
    const int i = static_cast<int>(r);
    const double scale = system.scheme.row_compliance(relaxation_of(block, i));
    const auto compliance = [&](uint32_t column) -> float& {
        return system.joints.compliance[g.first_compliance + triangle(r, column)].value[lane];
    };
    if (!block.compliance_block)
        compliance(r) = static_cast<float>(scale * block.compliance[block.angular(i)]);
    else
        for (uint32_t k = 0; k <= r; ++k)
            compliance(k) = static_cast<float>(scale * block.compliance[0] * block.compliance_block[r * g.rows + k]);
}

// Which rows of a lane are locked, and what they carry.
void fill_rows(System& system, const JointGroup& g, int lane, const RowBlock& block, const Times& times) {
    JointLanes& lanes = system.joints;
    for (uint32_t r = 0; r < g.rows; ++r) {
        const int i = static_cast<int>(r);
        const bool locked = block.locked(i), rigid = locked && !block.elastic(i);
        LaneRow& row = lanes.row[g.first_row + r];
        row.locked[lane] = locked ? 1 : 0;
        row.impulse[lane] =
            locked || block.type->swept(r) ? static_cast<float>(times.scheme.impulse(block.force[r])) : 0;
        LaneCoordinate& c = lanes.coordinate[g.first_row + r];
        c.drift[lane] = static_cast<float>(block.drift[r]);
        if (!locked || rigid) continue;
        c.rate[lane] = static_cast<float>(times.scheme.row_rate(relaxation_of(block, i)));
        c.damped_drift[lane] = static_cast<float>(relaxation_of(block, i) / times.frame * block.drift[r]);
        fill_compliance(system, g, r, lane, block);
    }
}

// C is between near -+ half a turn.
void fill_turn(LaneAxisLaw& law, int lane, bool angular, double near, double at) {
    constexpr double kTurn = 2 * 3.14159265358979323846;
    const bool turns = angular && std::isfinite(near);
    // C itself is within half a turn of 0.
    const double whole = turns && std::abs(near) > 0.5 * kTurn ? kTurn * std::round(near / kTurn) : 0;
    law.turn[lane] = static_cast<float>(turns ? kTurn : 0);
    law.near[lane] = static_cast<float>(turns ? near - whole : 0);
    law.at[lane] = static_cast<float>(at - whole);
}

void fill_axis_stop(LaneAxisLaw& law, int lane, const AxisRow& stop, const Axis& axis, const AxisMemory& memory,
                    bool angular, const Times& times) {
    const double relaxation = double(axis.limit_compliance) * axis.limit_damping;
    const auto yielding = static_cast<float>(times.scheme.row_rate(relaxation));
    fill_turn(law, lane, angular, reading_middle(axis, memory), stop.sign > 0 ? axis.lower : axis.upper);
    law.open[lane] = times.soft.inv_h;
    law.closed[lane] = stop.physical ? yielding : times.soft.bias_rate;
    law.relaxed[lane] = stop.physical ? yielding : 0;
    law.push[lane] = stop.physical ? static_cast<float>(kMost) : times.soft.push;
    law.reach[lane] = static_cast<float>(is_driven(axis) ? kMost : kReach * times.scheme.h);
}

// A drive at its target, or friction.
void fill_axis_drive(LaneAxisLaw& law, int lane, const AxisRow& drive, const Axis& axis, const AxisMemory& memory,
                     bool angular, const Times& times) {
    const auto rate = static_cast<float>(times.scheme.impulse(drive.compliance * axis.stiffness));
    const bool between = axis.mode == AxisMode::limited && std::isfinite(axis.lower) && std::isfinite(axis.upper);
    const double target = between && angular ? target_angle(axis, axis.target) : axis.target;
    fill_turn(law, lane, angular, between ? reading_middle(axis, memory) : target, target);
    law.base[lane] = static_cast<float>(drive.target);
    law.open[lane] = law.closed[lane] = law.relaxed[lane] = rate;
    law.push[lane] = law.reach[lane] = static_cast<float>(kMost);
    law.softness[lane] = static_cast<float>(kDriveSoftness * times.scheme.h) * rate;
}

void fill_axes(System& system, const JointGroup& g, int lane, const RowBlock& block, const Times& times) {
    JointLanes& lanes = system.joints;
    for_each_axis(block, times.scheme, [&](uint32_t r, const AxisRow& axis) {
        uint32_t at = g.first_axis;
        while (lanes.axis[at].row != r || lanes.axis[at].part != axis.part) ++at;
        LaneAxis& out = lanes.axis[at];
        out.sign[lane] = static_cast<float>(axis.sign);
        out.most[lane] = static_cast<float>(std::min(axis.limit, kMost));
        out.least[lane] = axis.stop ? 0 : -out.most[lane];
        out.impulse[lane] = static_cast<float>(times.scheme.impulse(*axis.force));
        out.force[lane] = axis.force;
        LaneAxisLaw& law = lanes.law[at];
        law.filled[lane] = 1;
        law.compliance[lane] = static_cast<float>(axis.compliance);
        law.friction[lane] = out.most[lane];
        const auto fill = axis.stop ? fill_axis_stop : fill_axis_drive;
        fill(law, lane, axis, block.axis[r], block.memory[r], block.angular(static_cast<int>(r)), times);
    });
}

// Angles with stops that were not read yet: lanes say which half of their range they are in once a frame.
void read_angles(const System& system, const RowBlock& block) {
    double value[kMaxRows];
    bool is_read = false;
    for (int r = 0; r < block.type->rows; ++r) {
        if (!block.stops_angle(r) || std::isfinite(block.memory[r].angle)) continue;
        Pose poses[kMaxNodes];
        for (int n = 0; n < block.type->nodes; ++n) poses[n] = system.pose[block.node[n]];
        if (!std::exchange(is_read, true)) block.type->evaluate(block.data, poses, value, nullptr);
        block.memory[r].angle = static_cast<float>(angle_between_stops(block.axis[r], block.memory[r], value[r]));
    }
}

bool stays(const System& system, uint32_t node) {
    const SweepVelocity& u = system.sweep[node].velocity;
    const auto still = [](float x) { return x == 0; };
    return system.sweep[node].mass.inv_mass == 0 && std::all_of(u.v, u.v + 3, still) &&
           std::all_of(u.w, u.w + 3, still);
}

void fill_frames(const System& system, LaneFrames& out, int lane, const RowBlock& block) {
    static_assert(offsetof(BallData, anchor_b) == offsetof(JointFrames, anchor_b));
    const auto& joint = *static_cast<const BallData*>(block.data);  // frames begin as it does
    Vec3 apart = Vec3::Zero();
    for (int end = 0; end < 2; ++end) {
        const Vec3& x = system.found[block.node[end]].x;  // poses of kinematic nodes are of another substep
        const Vec3& anchor = end == 0 ? joint.anchor_a : joint.anchor_b;
        const bool still = stays(system, block.node[end]);
        apart += (end == 0 ? -1 : 1) * Vec3(still ? x + system.pose[block.node[end]].R * anchor : x);
        for (int k = 0; k < 3; ++k) out.anchor[end][k][lane] = still ? 0 : static_cast<float>(anchor[k]);
    }
    if (block.type->angular != 0) {
        const auto& frames = *static_cast<const JointFrames*>(block.data);
        for (int k = 0; k < 4; ++k) {
            out.frame[0][k][lane] = static_cast<float>(frames.frame_a.coeffs()[k]);
            out.frame[1][k][lane] = static_cast<float>(frames.frame_b.coeffs()[k]);
        }
    }
    for (int k = 0; k < 3; ++k) out.apart[k][lane] = static_cast<float>(apart[k]);
}

// Whatever is not filled: empty lanes move nothing.
void clear_group(JointLanes& lanes, const JointGroup& g) {
    std::fill_n(&lanes.row[g.first_row], g.rows, LaneRow{});
    std::fill_n(&lanes.coordinate[g.first_row], g.rows, LaneCoordinate{});
    for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
        LaneAxis& axis = lanes.axis[a];
        const uint32_t row = axis.row, part = axis.part;
        axis = {};
        axis.row = row;
        axis.part = part;
        lanes.law[a] = {};
    }
    if (g.first_compliance != kNoLanes)
        std::fill_n(&lanes.compliance[g.first_compliance], triangle(g.rows, 0), LaneScalar{});
    if (g.first_frames == kNoLanes) {
        std::fill_n(&lanes.jacobian[g.first_jacobian], kDof * g.nodes * g.rows, LaneScalar{});
        return;
    }
    LaneFrames& frames = lanes.frames[g.first_frames];
    frames = {};
    for (auto& each : frames.frame) std::fill(each[3], each[3] + kLanes, 1.0f);
}

void fill_group(System& system, JointGroup& g, const Times& times) {
    JointLanes& lanes = system.joints;
    clear_group(lanes, g);
    for (int lane = 0; lane < kLanes; ++lane) {
        if (g.block[lane] == kNoLanes) continue;
        const RowBlock& block = system.rows.block[g.block[lane]];
        for (uint32_t n = 0; n < g.nodes; ++n) g.node[n][lane] = block.node[n];
        read_angles(system, block);
        fill_rows(system, g, lane, block, times);
        fill_axes(system, g, lane, block, times);
        if (g.first_frames != kNoLanes) fill_frames(system, lanes.frames[g.first_frames], lane, block);
    }
}

}  // namespace

void build_joint_lanes(Team& team, System& system, const Group& group, double frame) {
    JointLanes& lanes = system.joints;
    lanes.group.clear();
    lanes.row.clear();
    lanes.coordinate.clear();
    lanes.axis.clear();
    lanes.law.clear();
    lanes.frames.clear();
    lanes.jacobian.clear();
    lanes.factor.clear();
    lanes.compliance.clear();
    lanes.stiffness.clear();
    lanes.colour_begin.assign(1, 0);
    const uint32_t first = system.rows.direct;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t width = c + 1 == kMaxColours ? 1 : kLanes;  // the overflow colour: one joint at a time
        add_colour(system, first + group.joint_colour_begin[c], first + group.joint_colour_begin[c + 1], width);
    }
    const uint32_t elements = first + size_of(group.joints);
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t width = c + 1 == kMaxColours ? 1 : kLanes;
        add_colour(system, elements + group.element_colour_begin[c], elements + group.element_colour_begin[c + 1],
                   width);
    }
    for (uint32_t i = first; i < system.rows.joints; ++i)
        for (int n = 0; n < system.rows.block[i].type->nodes; ++n) system.filtered[system.rows.block[i].node[n]] = 1;
    const Times times{system.scheme, frame, joint_terms(system.scheme.h, system.stretch)};
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) fill_group(system, lanes.group[i], times);
    });
}

}  // namespace taut
