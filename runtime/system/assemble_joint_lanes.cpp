// Rows of swept joints into lanes and back.
#include <algorithm>
#include <span>

#include "system/assemble.h"
#include "system/axis_rows.h"
#include "system/soft_contact.h"

namespace taut {
namespace {

constexpr uint32_t kParts = 4;  // of AxisRow::part
constexpr uint32_t kGrain = 8;  // lane groups that a thread takes at a time

// A stop that nothing reaches within a substep at this speed, and that does not push, is left out [m/s or rad/s].
constexpr double kReach = 50;

uint32_t size_of(const auto& array) { return static_cast<uint32_t>(array.size()); }

// visit(row, AxisRow) for each stop, drive and friction of a block.
template <class Visit>
void for_each_axis(const System& system, const RowBlock& block, Visit visit) {
    if (!block.axis) return;
    for (int r = 0; r < block.type->rows; ++r) {
        const uint32_t row = static_cast<uint32_t>(r);
        for_each_axis_row(block, r, system.rows.error[block.row + row], system.h,
                          [&](const AxisRow& axis) { visit(row, axis); });
    }
}

// Places for what some lane has along a row.
void add_axes(System& system, JointGroup& g, std::span<const uint32_t> blocks) {
    JointLanes& lanes = system.joints;
    bool has[kMaxRows][kParts] = {};
    for (uint32_t b : blocks)
        for_each_axis(system, system.rows.block[b], [&](uint32_t r, const AxisRow& axis) { has[r][axis.part] = true; });
    g.first_axis = size_of(lanes.axis);
    for (uint32_t r = 0; r < g.rows; ++r) {
        for (uint32_t part = 0; part < kParts; ++part) {
            if (!has[r][part]) continue;
            LaneAxis& axis = lanes.axis.emplace_back();
            axis.row = r;
            axis.part = part;
        }
    }
    g.axes = size_of(lanes.axis) - g.first_axis;
}

// Which rows of a lane are locked and how soft they are.
void fill_rows(System& system, const JointGroup& g, int lane, const RowBlock& block) {
    JointLanes& lanes = system.joints;
    for (uint32_t r = 0; r < g.rows; ++r) {
        const int i = static_cast<int>(r);
        LaneRow& row = lanes.row[g.first_row + r];
        row.locked[lane] = block.locked(i) ? 1 : 0;
        row.rigid[lane] = block.locked(i) && !block.elastic(i) ? 1 : 0;
        if (!block.locked(i) || !block.elastic(i)) continue;
        const double scale = row_terms(block, i, system.h).scale;
        auto compliance = [&](uint32_t c) -> float& {
            return lanes.compliance[g.first_compliance + triangle(r, c)].value[lane];
        };
        if (!block.compliance_block)
            compliance(r) = static_cast<float>(scale * block.compliance[block.angular(i)]);
        else
            for (uint32_t c = 0; c <= r; ++c)
                compliance(c) = static_cast<float>(scale * block.compliance_block[r * g.rows + c]);
    }
}

// Room for at most kLanes joints of a colour and type.
void add_group(System& system, std::span<const uint32_t> blocks) {
    JointLanes& lanes = system.joints;
    const auto& all = system.rows.block;
    const ConstraintType& type = *all[blocks[0]].type;
    JointGroup& g = lanes.group.emplace_back();
    g = {};
    g.nodes = static_cast<uint32_t>(type.nodes);
    g.rows = static_cast<uint32_t>(type.rows);
    g.first_row = size_of(lanes.row);
    g.first_jacobian = size_of(lanes.jacobian);
    g.first_factor = size_of(lanes.factor);
    g.first_compliance = kNoLanes;
    lanes.row.resize(lanes.row.size() + g.rows, LaneRow{});
    lanes.jacobian.resize(lanes.jacobian.size() + kDof * g.nodes * g.rows, LaneScalar{});
    lanes.factor.resize(lanes.factor.size() + triangle(g.rows, 0));
    auto elastic = [&](uint32_t b) {
        bool any = false;
        for (int r = 0; r < type.rows; ++r) any = any || (all[b].locked(r) && all[b].elastic(r));
        return any;
    };
    if (std::any_of(blocks.begin(), blocks.end(), elastic)) {
        g.first_compliance = size_of(lanes.compliance);
        lanes.compliance.resize(lanes.compliance.size() + triangle(g.rows, 0), LaneScalar{});
    }
    add_axes(system, g, blocks);
    std::fill(g.block, g.block + kLanes, kNoLanes);
    for (size_t lane = 0; lane < blocks.size(); ++lane) {
        g.block[lane] = blocks[lane];
        for (uint32_t n = 0; n < g.nodes; ++n) g.node[n][lane] = all[blocks[lane]].node[n];
        fill_rows(system, g, static_cast<int>(lane), all[blocks[lane]]);
    }
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

void load_axis(LaneAxis& out, int lane, const AxisRow& axis, double h, const SweepTerms& soft) {
    if (axis.stop && *axis.force == 0 && axis.gap > kReach * h) return;
    const bool pushes = axis.stop && !axis.physical && axis.gap <= 0;
    const double target = pushes ? std::min<double>(soft.push, -soft.bias_rate * axis.gap) : axis.target;
    constexpr double kMost = 1e30;  // as a float
    out.sign[lane] = static_cast<float>(axis.sign);
    out.mass[lane] = 1;  // in use; the kernel puts the mass here
    out.compliance[lane] = static_cast<float>(axis.compliance);
    out.target[lane] = static_cast<float>(target);
    out.relaxed_target[lane] = static_cast<float>(axis.relaxed_target);
    out.most[lane] = static_cast<float>(std::min(axis.limit, kMost));
    out.least[lane] = axis.stop ? 0 : -out.most[lane];
    out.impulse[lane] = static_cast<float>(h * *axis.force);
    out.force[lane] = axis.force;
    out.used = 1;
}

void load_lane(System& system, const JointGroup& g, int lane, const SweepTerms& soft) {
    JointLanes& lanes = system.joints;
    const Rows& rows = system.rows;
    const RowBlock& block = rows.block[g.block[lane]];
    for (uint32_t r = 0; r < g.rows; ++r) {
        LaneRow& row = lanes.row[g.first_row + r];
        row.impulse[lane] = static_cast<float>(rows.impulse[block.row + r]);
        const double rate = row.rigid[lane] > 0 ? soft.bias_rate : row_terms(block, static_cast<int>(r), system.h).rate;
        row.bias[lane] = row.locked[lane] > 0 ? static_cast<float>(-rate * rows.error[block.row + r]) : 0;
    }
    for (uint32_t e = 0; e < kDof * g.nodes * g.rows; ++e)
        lanes.jacobian[g.first_jacobian + e].value[lane] = static_cast<float>(rows.jacobian[block.jacobian + e]);
    for_each_axis(system, block, [&](uint32_t r, const AxisRow& axis) {
        LaneAxis* at = &lanes.axis[g.first_axis];
        while (at->row != r || at->part != axis.part) ++at;
        load_axis(*at, lane, axis, system.h, soft);
    });
}

void clear(LaneAxis& axis) {
    for (auto* lanes : {&axis.sign, &axis.mass, &axis.compliance, &axis.target, &axis.relaxed_target, &axis.least,
                        &axis.most, &axis.impulse})
        std::fill(*lanes, *lanes + kLanes, 0.0f);
    std::fill(axis.force, axis.force + kLanes, nullptr);
    axis.used = 0;
}

void store_lane(System& system, const JointGroup& g, int lane) {
    const JointLanes& lanes = system.joints;
    const RowBlock& block = system.rows.block[g.block[lane]];
    for (uint32_t r = 0; r < g.rows; ++r) {
        const double impulse = lanes.row[g.first_row + r].impulse[lane];
        system.rows.impulse[block.row + r] = impulse;
        block.force[r] = impulse / system.h;
    }
    for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) {
        const LaneAxis& axis = lanes.axis[a];
        if (axis.force[lane]) *axis.force[lane] = static_cast<float>(axis.impulse[lane] / system.h);
    }
}

}  // namespace

void build_joint_lanes(System& system, const Group& group) {
    JointLanes& lanes = system.joints;
    lanes.group.clear();
    lanes.row.clear();
    lanes.axis.clear();
    lanes.jacobian.clear();
    lanes.factor.clear();
    lanes.compliance.clear();
    lanes.colour_begin.assign(1, 0);
    const uint32_t first = system.rows.direct;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t width = c + 1 == kMaxColours ? 1 : kLanes;  // the overflow colour: one joint at a time
        add_colour(system, first + group.joint_colour_begin[c], first + group.joint_colour_begin[c + 1], width);
    }
}

void load_joint_lanes(Team& team, System& system, const JointKernels& kernels) {
    JointLanes& lanes = system.joints;
    const SweepTerms soft = joint_terms(system.h);
    team.for_ranges(size_of(lanes.group), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const JointGroup& g = lanes.group[i];
            for (uint32_t a = g.first_axis; a < g.first_axis + g.axes; ++a) clear(lanes.axis[a]);
            for (int lane = 0; lane < kLanes; ++lane)
                if (g.block[lane] != kNoLanes) load_lane(system, g, lane, soft);
        }
        kernels.prepare(lanes.view(), begin, end, system.inverse_mass.data());
    });
}

void store_joint_lanes(Team& team, System& system) {
    const JointLanes& lanes = system.joints;
    team.for_ranges(size_of(lanes.group), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i)
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes.group[i].block[lane] != kNoLanes) store_lane(system, lanes.group[i], lane);
    });
}

}  // namespace taut
