// Direct solve of blocks, with the contacts that touch them; all other contacts by coloured sweeps around it.
//
// K is formed from the force lambda of the last substep. Where the stiffness of a joint outgrew that by more than steps
// bear, the block is solved once more with K(old) + K(new), which is never too soft; a block's first substep is solved
// twice, with K(new).
// A block that gains energy is solved without s and twice for a while: see energy_guard.cpp.
#include <algorithm>

#include "base/clock.h"
#include "solvers/block_solve.h"
#include "solvers/projected_gauss_seidel.h"

namespace taut {
namespace {

constexpr double kSettleMassRatio = 100;  // see block_solve.cpp
constexpr uint8_t kWhipsFrames = 60;      // a block that turned too far is apart from calm ones for so long

// The velocity that the sweeps left on a node of a block, relative to the one they were given: contact impulses.
void add_contact_changes(Substep& s, const Block& block) {
    for (uint32_t node : block.nodes) {
        const uint32_t i = s.system.at(node);
        const SweepVelocity& u = s.system.sweep[i].velocity;
        const Velocity& given = s.system.exact[i];
        Velocity& free = s.system.free[i];
        for (int k = 0; k < 3; ++k) {
            free.v[k] += static_cast<double>(u.v[k] - static_cast<float>(given.v[k]));
            free.w[k] += static_cast<double>(u.w[k] - static_cast<float>(given.w[k]));
        }
    }
}

// What sweeps changed, onto the solution.
void take_from_sweeps(Substep& s, const Block& block) {
    copy_velocities(s.system, block, s.system.exact, s.system.free);
    add_contact_changes(s, block);
    copy_velocities(s.system, block, s.system.free, s.system.exact);
}

void give_to_sweeps(Substep& s, const Block& block) {
    for (uint32_t node : block.nodes) {
        const uint32_t i = s.system.at(node);
        set_sweep_velocity(s.system.sweep[i].velocity, s.system.exact[i]);
    }
}

void move_freely(Substep& s, const Block& block) { copy_velocities(s.system, block, s.system.free, s.system.exact); }

bool has_sweeps(const Substep& s) {
    return !s.system.contacts.group.empty() || !s.group.joints.empty() || !s.group.elements.empty() ||
           !s.group.fused.empty() || !s.group.span_pairs.empty() || !s.group.grains.empty() ||
           !s.group.surfaces.empty();
}

void finish(Substep& s, Block& block, BlockSolve& solve) {
    block.turn = block.passing ? 0 : static_cast<float>(solve.largest_turn());
    if (static_cast<double>(block.turn) > s.most_turn)
        block.memory.whips_left = kWhipsFrames;
    else
        solve.finish();
}

void note_turn(Substep& s) {
    for (uint32_t b : s.group.blocks)
        if (!s.blocks[b].failed) s.turn = std::max(s.turn, static_cast<double>(s.blocks[b].turn));
}

// act(block) for each block of the group, several at once: blocks share no moving node.
template <class Act>
void for_blocks(Substep& s, Act&& act) {
    constexpr size_t kGrain = 32;  // nodes that a thread takes at a time, some 20 us
    size_t nodes = 0;
    for (uint32_t b : s.group.blocks) nodes += s.blocks[b].nodes.size();
    const size_t blocks = s.group.blocks.size(), grain = 1 + kGrain * blocks / std::max<size_t>(1, nodes);
    s.team.for_ranges(static_cast<uint32_t>(blocks), static_cast<uint32_t>(grain), [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) act(s.blocks[s.group.blocks[i]]);
    });
}

// What may allocate, one block after the other: the pattern of the matrix and the list of bounded rows.
void gather(Substep& s) {
    s.scratch.bounded.clear();
    for (uint32_t b : s.group.blocks) {
        Block& block = s.blocks[b];
        copy_velocities(s.system, block, s.system.exact, s.system.free);
        add_contact_changes(s, block);
        BlockSolve solve(s, block);
        solve.analyse();
        solve.foresee();
        solve.find_gases();
        solve.gather_rows();
    }
}

void solve_blocks(Substep& s) {
    const bool alone = !has_sweeps(s);
    warm_start_sweeps(s);
    Stopwatch watch;
    gather(s);
    for_blocks(s, [&](Block& block) {
        BlockSolve solve(s, block);
        block.failed = !solve.solve_first();
        if (block.failed) {
            ++s.report.failures;
            move_freely(s, block);
        }
        give_to_sweeps(s, block);
        if (alone && !block.failed) finish(s, block, solve);
    });
    s.report.direct_us += watch.lap();
    sweep_biased(s);
    if (alone) return note_turn(s);
    watch.lap();
    for_blocks(s, [&](Block& block) {
        if (block.failed) return;
        BlockSolve solve(s, block);
        add_contact_changes(s, block);
        solve.solve_again();
        give_to_sweeps(s, block);
        finish(s, block, solve);
    });
    note_turn(s);
    s.report.direct_us += watch.lap();
}

void settle_blocks(Substep& s) {
    for_blocks(s, [&](Block& block) {
        block.corrected =
            !block.failed && !block.tower && block.mass_ratio <= kSettleMassRatio && BlockSolve(s, block).settle();
    });
}

void relax_blocks(Substep& s) {
    for (uint32_t b : s.group.blocks) {
        Block& block = s.blocks[b];
        if (block.bounded_count == 0 || block.failed) continue;
        copy_velocities(s.system, block, s.system.kept, s.system.exact);
        give_to_sweeps(s, block);
    }
    if (!has_sweeps(s)) return;
    sweep_relaxed(s);
    for (uint32_t b : s.group.blocks) take_from_sweeps(s, s.blocks[b]);  // joints stay as solved
}

}  // namespace

const Solver kBlockLdlt{"block_ldlt", true, true, solve_blocks, settle_blocks, relax_blocks};

}  // namespace taut
