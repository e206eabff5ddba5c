#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/prefetch.h"
#include "detect/approach.h"
#include "state/levers.h"
#include "system/assemble.h"
#include "system/lane_parts.h"

namespace taut {
namespace {

void clear_lane(LanePoint& p, int lane) {
    for (int i = 0; i < 3; ++i) p.ra[i][lane] = p.rb[i][lane] = p.impulse[i][lane] = 0;
    p.gap0[lane] = p.gap[lane] = p.normal_mass[lane] = p.peak[lane] = p.restitution[lane] = 0;
}

// Impulses of substeps of length h [s].
void load(float (&impulse)[3][kLanes], int lane, const ContactForce& force, float h) {
    impulse[0][lane] = h * force.normal;
    impulse[1][lane] = h * force.tangent1;
    impulse[2][lane] = h * force.tangent2;
}

// Of what bears nothing, 0 and not -0, whoever else is in its lanes.
ContactForce force_of(const float (&impulse)[3][kLanes], int lane, float h) {
    return {impulse[0][lane] / h + 0.0f, impulse[1][lane] / h + 0.0f, impulse[2][lane] / h + 0.0f};
}

void fill_lane(LanePoint& p, int lane, const Levers& levers, float separation, float restitution) {
    for (int i = 0; i < 3; ++i) {
        p.ra[i][lane] = static_cast<float>(levers.a.at[i]);
        p.rb[i][lane] = static_cast<float>(levers.b.at[i]);
    }
    p.gap0[lane] = p.gap[lane] = separation;
    p.normal_mass[lane] = 1;  // in use; the kernel puts the mass here
    p.peak[lane] = 0;
    p.restitution[lane] = restitution;
}

// Whether a pair's points need a LaneDrive.
bool is_driven(const Pair& pair) { return pair.driven || pair.sticks_better() || pair.slide_factor < 1; }

// What the surfaces of a pair, if any, make of the friction of its points.
void fill_drive(ContactLanes& lanes, const LaneGroup& g, int lane, const Pair* pair, const Nodes& nodes) {
    for (uint32_t k = 0; k < g.points; ++k) {
        LaneDrive& to = lanes.drive[g.first_drive + k];
        to.speed[0][lane] = to.speed[1][lane] = to.way[0][lane] = to.way[1][lane] = 0;
        to.slid[lane] = to.slides[lane] = 0;
        to.part[lane] = 1;
        to.friction[0][lane] = to.friction[1][lane] = 0;
        if (!pair) continue;
        const Tangents tangents = tangents_of(*pair);
        to.part[lane] = tangents.part;
        to.friction[0][lane] = pair->friction;
        to.friction[1][lane] = pair->most_friction();
        if (static_cast<int>(k) >= pair->manifold.count) continue;
        const Vec3f drive = pair->driven ? pair->drive_at(static_cast<int>(k)) : Vec3f(Vec3f::Zero());
        to.speed[0][lane] = drive.dot(tangents.t1);
        to.speed[1][lane] = tangents.part * drive.dot(tangents.t2);
        if (!pair->sticks_better()) continue;
        const float slip = pair->force[k].slip;
        to.slides[lane] = slip < 0 && slips(nodes, *pair, static_cast<int>(k)) ? 1 : slip;
    }
}

void fill_rolling(LaneRolling& rolling, int lane, const Pair* pair, float h) {
    rolling.arm[0][lane] = pair ? pair->spinning_arm() : 0;
    rolling.arm[1][lane] = pair ? pair->rolling_arm() : 0;
    load(rolling.impulse, lane, pair && pair->twists() ? torque_to_rows(*pair) : ContactForce(), h);
}

Movement movement_of(const Nodes& nodes, uint32_t node) {
    const NodeMotion& m = nodes.motion[node];
    return {m.x, m.v, m.w};
}

// How the two sides of a pair stand and move.
struct PairMovement {
    Movement a, b;
    Vec3 arm_a;
    Axles axles;

    PairMovement(const Pairs& pairs, const Pair& pair, const Nodes& nodes)
        : a(movement_of(nodes, pair.a)), b(movement_of(nodes, pair.b)), arm_a(a.x - nodes.origin(pair.a)) {
        if (pair.rolls_a || pair.rolls_b) axles = axles_of(pairs, pair, arm_a, b.x - nodes.origin(pair.b));
    }
    Levers levers(const Pair& pair, int k) const { return levers_of(pair, k, arm_a, axles, a, b); }
};

// One pair into one lane of a group; its points into the group's first points.
void fill_pair(LaneGroup& g, int lane, const Pairs& pairs, const Pair& pair, const Nodes& nodes, float h) {
    const Tangents tangents = tangents_of(pair);
    const Vec3f &n = pair.manifold.normal, &t1 = tangents.t1;
    g.friction[lane] = pair.friction;
    g.stiffness[lane] = pair.stiffness;
    g.round[0][lane] = pair.round_a;
    g.round[1][lane] = pair.round_b;
    for (int i = 0; i < 3; ++i) {
        g.normal[i][lane] = n[i];
        g.tangent[i][lane] = t1[i];
    }
    const PairMovement moves(pairs, pair, nodes);
    for (int k = 0; k < pair.manifold.count; ++k) {
        fill_lane(g.point[k], lane, on_ball_paths(pairs, nodes, pair, moves.levers(pair, k)),
                  pair.manifold.points[k].separation, pair.restitution);
        load(g.point[k].impulse, lane, to_rows(pair, pair.force[k]), h);
    }
}

void fill_axes(LaneRolling& to, int lane, const Pairs& pairs, const Pair& pair, const Nodes& nodes) {
    const PairMovement moves(pairs, pair, nodes);
    const Vec3 n = pair.manifold.normal.cast<double>();
    const Vec3 axes[2] = {moves.axles.a.axis, moves.axles.b.axis};
    for (int side = 0; side < 2; ++side) {
        const Vec3 beside = across(axes[side], side == 0 ? n : Vec3(-n));
        for (int i = 0; i < 3; ++i) {
            to.axis[side][i][lane] = static_cast<float>(axes[side][i]);
            to.across[side][i][lane] = static_cast<float>(beside[i]);
        }
    }
    for (int k = 0; k < pair.manifold.count; ++k) {
        const Levers levers = moves.levers(pair, k);
        to.rim[k][0][lane] = static_cast<float>(levers.a.rim);
        to.rim[k][1][lane] = static_cast<float>(levers.b.rim);
    }
}

void clear_pair(LaneGroup& g, int lane) {
    g.friction[lane] = g.round[0][lane] = g.round[1][lane] = 0;
    g.stiffness[lane] = 1;
    for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.tangent[i][lane] = 0;
}

const Pair* pair_of(const LaneGroup& g, int lane, const Pairs& pairs) {
    return g.pair[lane] == kNone ? nullptr : &pairs.list[g.pair[lane]];
}

// Records of pairs lie about in memory, or in the cache of the thread that found them. Asks for the one that comes some
// lanes after this; next: the group after, or null.
void prefetch_pair(const LaneGroup& g, const LaneGroup* next, int lane, const Pairs& pairs) {
    constexpr int kAhead = 4;  // lanes
    const bool here = lane + kAhead < kLanes;
    if (!here && !next) return;
    const Pair* pair = here ? pair_of(g, lane + kAhead, pairs) : pair_of(*next, lane + kAhead - kLanes, pairs);
    if (pair) prefetch(*pair, sizeof(Pair) - Pair::kSought);
}

// The pairs that share_out() chose, into their lanes; next: the group after, or null. What is special about the group
// is noted in it and has no room yet. Returns whether a pair bounces.
bool fill_group(LaneGroup& g, const LaneGroup* next, float h, Pairs& pairs, const Nodes& nodes) {
    bool bounces = false, driven = false, turns = false, round = false, rolls = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        prefetch_pair(g, next, lane, pairs);
        uint32_t filled = 0;
        if (g.pair[lane] != kNone) {
            Pair& pair = pairs.list[g.pair[lane]];
            leave_block(pair);
            fill_pair(g, lane, pairs, pair, nodes, h);
            filled = static_cast<uint32_t>(pair.manifold.count);
            bounces = bounces || pair.restitution > 0;
            driven = driven || is_driven(pair);
            turns = turns || pair.twists();
            round = round || pair.round_a > 0 || pair.round_b > 0;
            rolls = rolls || pair.rolls_a || pair.rolls_b;
        } else {
            clear_pair(g, lane);
        }
        for (uint32_t k = filled; k < g.points; ++k) clear_lane(g.point[k], lane);
    }
    g.is_round = round;
    g.bounces = bounces;
    g.first_drive = driven ? 0 : kNoLanes;
    g.rolling = turns || rolls ? 0 : kNoLanes;
    g.has_axes = rolls;
    return bounces;
}

// Room for what surfaces that drive, hold or direct friction, friction torques and shapes of revolution of the pairs of
// a group need.
void make_special_room(ContactLanes& lanes, LaneGroup& g) {
    if (g.first_drive != kNoLanes) {
        g.first_drive = static_cast<uint32_t>(lanes.drive.size());
        lanes.drive.resize(lanes.drive.size() + g.points);
    }
    if (g.rolling != kNoLanes) {
        g.rolling = static_cast<uint32_t>(lanes.rolling.size());
        lanes.rolling.emplace_back();
    }
}

void fill_special(ContactLanes& lanes, const LaneGroup& g, const Pairs& pairs, const Nodes& nodes, float h) {
    for (int lane = 0; lane < kLanes; ++lane) {
        const Pair* pair = pair_of(g, lane, pairs);
        if (g.first_drive != kNoLanes) fill_drive(lanes, g, lane, pair, nodes);
        if (g.rolling != kNoLanes) fill_rolling(lanes.rolling[g.rolling], lane, pair, h);
        if (g.has_axes && pair) fill_axes(lanes.rolling[g.rolling], lane, pairs, *pair, nodes);
    }
}

bool is_special(const LaneGroup& g) { return g.first_drive != kNoLanes || g.rolling != kNoLanes; }

}  // namespace

void build_lanes(Team& team, System& system, const Group& group, Pairs& pairs, const Nodes& nodes,
                 const ContactKernels& kernels) {
    ContactLanes& lanes = system.contacts;
    const auto h = static_cast<float>(system.scheme.h);
    lanes.drive.clear();
    lanes.rolling.clear();
    share_out(team, system, pairs, group);
    const auto prepare = [&](uint32_t g) { kernels.prepare(lanes.view(), g, g + 1, system.sweep.data()); };
    std::atomic<bool> bounces{false}, special{false};
    for_lane_parts(team, lanes, [&](uint32_t part) {
        const uint32_t begin = lanes.part[part].begin, end = lanes.part[part].end;
        for (uint32_t i = begin; i < end; ++i) {
            LaneGroup& g = lanes.group[i];
            if (fill_group(g, i + 1 < end ? &g + 1 : nullptr, h, pairs, nodes))
                bounces.store(true, std::memory_order_relaxed);
            if (is_special(g))
                special.store(true, std::memory_order_relaxed);
            else
                prepare(i);
        }
    });
    lanes.bounces = bounces;
    if (!special) return;
    for (LaneGroup& g : lanes.group) make_special_room(lanes, g);
    for_lane_parts(team, lanes, [&](uint32_t part) {
        for (uint32_t i = lanes.part[part].begin; i < lanes.part[part].end; ++i) {
            if (!is_special(lanes.group[i])) continue;
            fill_special(lanes, lanes.group[i], pairs, nodes, h);
            prepare(i);
        }
    });
}

namespace {

// Notes which lanes turned; false: none.
bool note_turns(const LaneGroup& g, const System& system, LaneTurns& turns) {
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        const bool a = system.turned[g.a[lane]] != 0, b = system.turned[g.b[lane]] != 0;
        turns.turned[0][lane] = a;
        turns.turned[1][lane] = b;
        any = any || a || b;
    }
    return any;
}

// A node's rotation counts from here on, if its levers turned with it.
void turn_from_here(System& system, uint32_t node) {
    const uint32_t at = system.at(node);
    if (!system.turned[at]) return;
    float(&dq)[4] = system.shift[at].dq;
    dq[0] = dq[1] = dq[2] = 0;
    dq[3] = 1;
}

}  // namespace

void turn_lanes(Team& team, System& system, const Group& group, const ContactKernels& kernels) {
    ContactLanes& lanes = system.contacts;
    const auto turn = [&](const LanePart& part) {
        LaneTurns turns;
        for (uint32_t g = part.begin; g < part.end; ++g)
            if (note_turns(lanes.group[g], system, turns))
                kernels.turn(lanes.view(), g, turns, system.shift.data(), system.sweep.data());
    };
    const auto count = static_cast<uint32_t>(group.nodes.size());
    const auto begin_of = [&](uint32_t part) { return begin_of_part(part, lanes.parts, count); };
    constexpr uint32_t kAfter[] = {0, 1};  // nodes once the lanes of all parts have seen how they turned
    for_parts(team, lanes, kAfter, [&](uint32_t stage, uint32_t part) {
        if (stage == 0)
            lanes.for_colours(part, [&](uint32_t i) { turn(lanes.part[i]); });
        else
            for (uint32_t i = begin_of(part); i < begin_of(part + 1); ++i) turn_from_here(system, group.nodes[i]);
    });
}

namespace {

// Calls act(group, lane, pair) for all lanes in use, their records asked for ahead.
template <class Act>
void for_pairs_in_lanes(Team& team, const ContactLanes& lanes, const Pairs& pairs, const Act& act) {
    for_lane_parts(team, lanes, [&](uint32_t part) {
        const uint32_t end = lanes.part[part].end;
        for (uint32_t i = lanes.part[part].begin; i < end; ++i) {
            const LaneGroup& g = lanes.group[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                prefetch_pair(g, i + 1 < end ? &g + 1 : nullptr, lane, pairs);
                if (g.pair[lane] != kNone) act(g, lane, g.pair[lane]);
            }
        }
    });
}

}  // namespace

void load_lanes(Team& team, System& system, const Pairs& pairs) {
    ContactLanes& lanes = system.contacts;
    const auto h = static_cast<float>(system.scheme.h);
    for_pairs_in_lanes(team, lanes, pairs, [&](const LaneGroup& g, int lane, uint32_t index) {
        const Pair& pair = pairs.list[index];
        for (int k = 0; k < pair.manifold.count; ++k) load(g.point[k].impulse, lane, to_rows(pair, pair.force[k]), h);
        if (pair.twists()) load(lanes.rolling[g.rolling].impulse, lane, torque_to_rows(pair), h);
    });
}

void store_lanes(Team& team, const System& system, Pairs& pairs) {
    const ContactLanes& lanes = system.contacts;
    const auto h = static_cast<float>(system.scheme.h);
    for_pairs_in_lanes(team, lanes, pairs, [&](const LaneGroup& g, int lane, uint32_t index) {
        Pair& pair = pairs.list[index];
        pair.pushed = false;
        for (int k = 0; k < pair.manifold.count; ++k) {
            const LanePoint& p = g.point[k];
            pair.pushed = pair.pushed || p.peak[lane] > 0;
            pair.force[k] = from_rows(pair, force_of(p.impulse, lane, h));
            if (pair.sticks_better()) pair.force[k].slip = lanes.drive[g.first_drive + k].slides[lane];
        }
        if (!pair.twists()) return;
        pair.torque = torque_from_rows(pair, force_of(lanes.rolling[g.rolling].impulse, lane, h));
        pair.spin_slip = -1;
    });
}

}  // namespace taut
