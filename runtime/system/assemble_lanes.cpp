#include <algorithm>
#include <atomic>
#include <cmath>

#include "state/levers.h"
#include "system/assemble.h"
#include "system/colour_stages.h"

namespace taut {
namespace {

void clear_lane(LanePoint& p, int lane) {
    for (int i = 0; i < 3; ++i) p.ra[i][lane] = p.rb[i][lane] = p.impulse[i][lane] = 0;
    p.gap0[lane] = p.gap[lane] = p.normal_mass[lane] = p.peak[lane] = p.restitution[lane] = 0;
}

void fill_lane(LanePoint& p, int lane, const Levers& levers, float separation, const Impulse& impulse,
               float restitution) {
    for (int i = 0; i < 3; ++i) {
        p.ra[i][lane] = static_cast<float>(levers.a[i]);
        p.rb[i][lane] = static_cast<float>(levers.b[i]);
    }
    p.gap0[lane] = p.gap[lane] = separation;
    p.normal_mass[lane] = 1;  // in use; the kernel puts the mass here
    p.impulse[0][lane] = impulse.normal;
    p.impulse[1][lane] = impulse.tangent1;
    p.impulse[2][lane] = impulse.tangent2;
    p.peak[lane] = 0;
    p.restitution[lane] = restitution;
}

// What the moving surfaces of a pair, if any, drive its points to.
void fill_drive(ContactLanes& lanes, const LaneGroup& g, int lane, const Pair* pair) {
    for (uint32_t k = 0; k < g.points; ++k) {
        float(&speed)[2][kLanes] = lanes.drive[g.first_drive + k].speed;
        speed[0][lane] = speed[1][lane] = 0;
        if (!pair || !pair->driven || static_cast<int>(k) >= pair->manifold.count) continue;
        const Vec3f t1 = tangent_of(pair->manifold.normal), drive = pair->drive_at(static_cast<int>(k));
        speed[0][lane] = drive.dot(t1);
        speed[1][lane] = drive.dot(pair->manifold.normal.cross(t1));
    }
}

void fill_rolling(LaneRolling& rolling, int lane, const Pair* pair) {
    rolling.arm[0][lane] = pair ? pair->spinning_arm() : 0;
    rolling.arm[1][lane] = pair ? pair->rolling_arm() : 0;
    const bool turns = pair && pair->twists();
    rolling.impulse[0][lane] = turns ? pair->turning.normal : 0;
    rolling.impulse[1][lane] = turns ? pair->turning.tangent1 : 0;
    rolling.impulse[2][lane] = turns ? pair->turning.tangent2 : 0;
}

Movement movement_of(const Nodes& nodes, uint32_t node) {
    const NodeMotion& m = nodes.motion[node];
    return {m.x, m.v, m.w};
}

// One pair into one lane of a group; its points into the group's first points.
void fill_pair(ContactLanes& lanes, LaneGroup& g, int lane, const Pair& pair, const Nodes& nodes) {
    const Vec3f n = pair.manifold.normal, t1 = tangent_of(n);
    g.a[lane] = pair.a + 1;
    g.b[lane] = pair.b + 1;
    g.friction[lane] = pair.friction;
    g.turns[lane] = 0;
    g.rolls[0][lane] = pair.rolls_a;
    g.rolls[1][lane] = pair.rolls_b;
    g.round[0][lane] = pair.round_a;
    g.round[1][lane] = pair.round_b;
    for (int i = 0; i < 3; ++i) {
        g.normal[i][lane] = n[i];
        g.tangent[i][lane] = t1[i];
    }
    const Movement a = movement_of(nodes, pair.a), b = movement_of(nodes, pair.b);
    const Vec3 arm_a = a.x - nodes.origin(pair.a);
    for (int k = 0; k < pair.manifold.count; ++k)
        fill_lane(lanes.point[g.first_point + static_cast<uint32_t>(k)], lane, levers_of(pair, k, arm_a, a, b),
                  pair.manifold.points[k].separation, pair.impulse[k], pair.restitution);
}

void clear_pair(LaneGroup& g, int lane) {
    g.a[lane] = g.b[lane] = 0;
    g.rolls[0][lane] = g.rolls[1][lane] = 0;
    g.friction[lane] = g.turns[lane] = g.round[0][lane] = g.round[1][lane] = 0;
    for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.tangent[i][lane] = 0;
}

const Pair* pair_of(const LaneGroup& g, int lane, const Pairs& pairs) {
    return g.pair[lane] == kNone ? nullptr : &pairs.list[g.pair[lane]];
}

// Records of pairs lie about in memory, or in the cache of the thread that found them.
void prefetch_pair(const LaneGroup* g, int lane, const Pairs& pairs) {
    constexpr size_t kCacheLine = 64;
    const Pair* pair = g ? pair_of(*g, lane, pairs) : nullptr;
    for (size_t at = 0; pair && at < sizeof(Pair); at += kCacheLine)
        __builtin_prefetch(reinterpret_cast<const char*>(pair) + at);
}

struct Special {  // what few groups have
    bool bounces = false, driven = false, turns = false;
};

// The pairs that add_colour chose, into their lanes. next: the group after, or null.
Special fill_group(ContactLanes& lanes, LaneGroup& g, const LaneGroup* next, const Pairs& pairs, const Nodes& nodes) {
    constexpr int kAhead = 4;  // pairs
    Special special;
    bool round = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        const bool here = lane + kAhead < kLanes;
        prefetch_pair(here ? &g : next, here ? lane + kAhead : lane + kAhead - kLanes, pairs);
        uint32_t filled = 0;
        if (const Pair* pair = pair_of(g, lane, pairs)) {
            fill_pair(lanes, g, lane, *pair, nodes);
            filled = static_cast<uint32_t>(pair->manifold.count);
            special.bounces = special.bounces || pair->restitution > 0;
            special.driven = special.driven || pair->driven;
            special.turns = special.turns || pair->twists();
            round = round || pair->round_a > 0 || pair->round_b > 0;
        } else {
            clear_pair(g, lane);
        }
        for (uint32_t k = filled; k < g.points; ++k) clear_lane(lanes.point[g.first_point + k], lane);
    }
    g.is_round = round;
    return special;
}

// Room for what moving surfaces and friction torques of the pairs of a group need, and that.
void fill_special(ContactLanes& lanes, LaneGroup& g, const Pairs& pairs) {
    bool driven = false, turns = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        const Pair* pair = pair_of(g, lane, pairs);
        driven = driven || (pair && pair->driven);
        turns = turns || (pair && pair->twists());
    }
    if (driven) {
        g.first_drive = static_cast<uint32_t>(lanes.drive.size());
        lanes.drive.resize(lanes.drive.size() + g.points);
    }
    if (turns) {
        g.rolling = static_cast<uint32_t>(lanes.rolling.size());
        lanes.rolling.emplace_back();
    }
    for (int lane = 0; lane < kLanes; ++lane) {
        const Pair* pair = pair_of(g, lane, pairs);
        if (driven) fill_drive(lanes, g, lane, pair);
        if (turns) fill_rolling(lanes.rolling[g.rolling], lane, pair);
    }
}

uint32_t width_of(uint32_t colour) { return colour + 1 == kMaxColours ? 1 : kLanes; }  // overflow: one pair at a time

// Lane groups of one colour, whose pairs come with the most points first, so that there are few empty places; in the
// order of the place of their middle pair.
void add_colour(ContactLanes& lanes, const Pairs& pairs, const Group& group, uint32_t colour) {
    const uint32_t width = width_of(colour);
    const uint32_t begin = group.pair_colour_begin[colour], end = group.pair_colour_begin[colour + 1];
    const uint32_t count = (end - begin + width - 1) / width, first = static_cast<uint32_t>(lanes.group.size());
    const auto last_of = [&](uint32_t i) { return std::min(begin + (i + 1) * width, end); };
    const auto place_of = [&](uint32_t i) { return group.pair_place[(begin + i * width + last_of(i)) / 2]; };
    uint32_t next[kSlices + 1] = {};
    for (uint32_t i = 0; i < count; ++i) ++next[place_of(i) + 1u];
    for (uint32_t p = 0; p < kSlices; ++p) next[p + 1] += next[p];
    lanes.group.resize(first + count);
    for (uint32_t i = 0; i < count; ++i) {
        LaneGroup& g = lanes.group[first + next[place_of(i)]++];
        const uint32_t* item = &group.pairs[begin + i * width];
        const uint32_t filled = last_of(i) - (begin + i * width);
        g.points = pairs.active[*item].points;
        for (uint32_t lane = 0; lane < kLanes; ++lane)
            g.pair[lane] = lane < filled ? pairs.active[item[lane]].pair : kNone;
    }
    for (uint32_t k = 0; k < lanes.parts; ++k)
        lanes.part.push_back({first + k * count / lanes.parts, first + (k + 1) * count / lanes.parts});
}

// The points of the groups that a thread works on lie together, colour after colour: processors fetch ahead of what is
// read, and would take what another thread writes.
void place_points(ContactLanes& lanes) {
    uint32_t points = 0;
    for (uint32_t k = 0; k < lanes.parts; ++k)
        for (uint32_t i = k; i < lanes.part.size(); i += lanes.parts)
            for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g) {
                lanes.group[g].first_point = points;
                points += lanes.group[g].points;
            }
    lanes.point.resize(points);
}

// A colour's lane groups of at least k points are those that its pairs of as many fill, the last one in part.
void reserve_lanes(ContactLanes& lanes, const Pairs& pairs, const Group& group) {
    size_t groups = 0, points = 0;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t width = width_of(c);
        for (uint32_t i = group.pair_colour_begin[c]; i < group.pair_colour_begin[c + 1]; i += width, ++groups)
            points += pairs.active[group.pairs[i]].points;
    }
    const auto reserve = [](auto& empty, size_t needed) {
        if (needed > empty.capacity()) empty.reserve(with_slack(needed));
    };
    reserve(lanes.group, groups);
    reserve(lanes.point, points);
}

constexpr uint32_t kGrain = 16;  // lane groups that a thread takes at a time

}  // namespace

void build_lanes(Team& team, System& system, const Group& group, const Pairs& pairs, const Nodes& nodes,
                 const ContactKernels& kernels) {
    ContactLanes& lanes = system.contacts;
    lanes.group.clear();
    lanes.point.clear();
    lanes.drive.clear();
    lanes.rolling.clear();
    lanes.part.clear();
    lanes.parts = team.size();
    reserve_lanes(lanes, pairs, group);
    for (uint32_t c = 0; c < kMaxColours; ++c) add_colour(lanes, pairs, group, c);
    place_points(lanes);
    const auto prepare = [&](uint32_t g) {
        kernels.prepare(lanes.view(), g, g + 1, system.velocity.data(), system.inverse_mass.data());
    };
    std::atomic<bool> bounces{false}, special{false};
    for_lane_parts(team, lanes, [&](uint32_t part) {
        const uint32_t begin = lanes.part[part].begin, end = lanes.part[part].end;
        for (uint32_t i = begin; i < end; ++i) {
            const Special has =
                fill_group(lanes, lanes.group[i], i + 1 < end ? &lanes.group[i + 1] : nullptr, pairs, nodes);
            if (has.bounces) bounces.store(true, std::memory_order_relaxed);
            if (has.driven || has.turns)
                special.store(true, std::memory_order_relaxed);
            else
                prepare(i);
        }
    });
    lanes.bounces = bounces;
    if (!special) return;
    for (uint32_t i = 0; i < lanes.group.size(); ++i) fill_special(lanes, lanes.group[i], pairs);
    for_lane_parts(team, lanes, [&](uint32_t part) {
        for (uint32_t i = lanes.part[part].begin; i < lanes.part[part].end; ++i)
            if (lanes.group[i].first_drive != kNoLanes || lanes.group[i].rolling != kNoLanes) prepare(i);
    });
}

namespace {

// One side's levers with its body: what turns is the core; the gap since detection goes on from the new lever.
void turn_side(const Quatf& turn, const Vec3f& skin, bool rolls, float (&r)[3][kLanes], int lane, const Vec3f& normal,
               float sign, LanePoint& p) {
    const Vec3f core = Vec3f(r[0][lane], r[1][lane], r[2][lane]) - skin;
    const Vec3f turned = turn * core;
    for (int i = 0; i < 3 && !rolls; ++i) r[i][lane] = turned[i] + skin[i];
    p.gap0[lane] += sign * normal.dot(turned - core);
}

// An impulse that fitted the levers and masses of the last substep throws a thin body about where these have changed:
// beyond this share of the mass along the normal it is not carried on (measured: of thin spinning cylinders that
// hit a wall at 100 m/s one in four gained energy, up to 6 times).
constexpr float kOtherMass = 0.2f;

bool turned(const System& system, const LaneGroup& g, int lane) {
    return system.turned[g.a[lane]] || system.turned[g.b[lane]];
}

// What prepare() wrote for a lane, as it was before.
void keep_lane(LanePoint& p, const LanePoint& before, int lane) {
    p.normal_mass[lane] = before.normal_mass[lane];
    p.isotropic_mass[lane] = before.isotropic_mass[lane];
    for (int i = 0; i < 3; ++i) p.friction_mass[i][lane] = before.friction_mass[i][lane];
    for (int i = 0; i < 2; ++i) p.coupling[i][lane] = before.coupling[i][lane];
    p.approach[lane] = before.approach[lane];
}

void keep_lane(LaneRolling& r, const LaneRolling& before, int lane) {
    r.spin_mass[lane] = before.spin_mass[lane];
    r.isotropic_mass[lane] = before.isotropic_mass[lane];
    for (int i = 0; i < 3; ++i) r.roll_mass[i][lane] = before.roll_mass[i][lane];
}

// What was hit already keeps the approach speed that it had.
void renew_lane(LanePoint& p, const LanePoint& before, int lane) {
    const float mass = before.normal_mass[lane];
    if (p.peak[lane] > 0) p.approach[lane] = before.approach[lane];
    if (std::abs(p.normal_mass[lane] - mass) <= kOtherMass * mass) return;
    for (auto& impulse : p.impulse) impulse[lane] = 0;
}

// Of the lanes that turned: nothing depends on who else is in a group.
void renew_masses(ContactLanes& lanes, uint32_t group, const System& system, const ContactKernels& kernels) {
    const LaneGroup& g = lanes.group[group];
    LanePoint before[4];
    LaneRolling rolling;
    if (g.rolling != kNoLanes) rolling = lanes.rolling[g.rolling];
    for (uint32_t k = 0; k < g.points; ++k) {
        LanePoint& p = lanes.point[g.first_point + k];
        before[k] = p;
        for (int lane = 0; lane < kLanes; ++lane) p.normal_mass[lane] = p.normal_mass[lane] > 0 ? 1 : 0;  // in use
    }
    kernels.prepare(lanes.view(), group, group + 1, system.velocity.data(), system.inverse_mass.data());
    for (int lane = 0; lane < kLanes; ++lane) {
        const bool renewed = turned(system, g, lane);
        if (!renewed && g.rolling != kNoLanes) keep_lane(lanes.rolling[g.rolling], rolling, lane);
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = lanes.point[g.first_point + k];
            if (renewed)
                renew_lane(p, before[k], lane);
            else
                keep_lane(p, before[k], lane);
        }
    }
}

bool turn_group(ContactLanes& lanes, LaneGroup& g, const System& system) {
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        const uint32_t a = g.a[lane], b = g.b[lane];
        if (!turned(system, g, lane)) continue;
        any = true;
        g.turns[lane] = 1;
        g.any_turns = 1;
        const Vec3f n(g.normal[0][lane], g.normal[1][lane], g.normal[2][lane]);
        for (uint32_t k = 0; k < g.points; ++k) {
            LanePoint& p = lanes.point[g.first_point + k];
            if (system.turned[a])
                turn_side(system.turn[a], g.round[0][lane] * n, g.rolls[0][lane] != 0, p.ra, lane, n, -1, p);
            if (system.turned[b])
                turn_side(system.turn[b], -g.round[1][lane] * n, g.rolls[1][lane] != 0, p.rb, lane, n, 1, p);
        }
    }
    return any;
}

}  // namespace

void turn_lanes(Team& team, System& system, const ContactKernels& kernels) {
    ContactLanes& lanes = system.contacts;
    team.for_ranges(static_cast<uint32_t>(lanes.group.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t g = begin; g < end; ++g)
            if (turn_group(lanes, lanes.group[g], system)) renew_masses(lanes, g, system, kernels);
    });
}

void store_lanes(Team& team, const System& system, Pairs& pairs) {
    const ContactLanes& lanes = system.contacts;
    const auto store = [&](const LaneGroup& g, int lane) {
        Pair& pair = pairs.list[g.pair[lane]];
        for (int k = 0; k < pair.manifold.count; ++k) {
            const LanePoint& p = lanes.point[g.first_point + static_cast<uint32_t>(k)];
            pair.impulse[k] = {p.impulse[0][lane], p.impulse[1][lane], p.impulse[2][lane]};
        }
        if (!pair.twists()) return;
        const float(&turning)[3][kLanes] = lanes.rolling[g.rolling].impulse;
        pair.turning = {turning[0][lane], turning[1][lane], turning[2][lane]};
        pair.spin_slip = -1;
    };
    for_lane_parts(team, lanes, [&](uint32_t part) {
        for (uint32_t g = lanes.part[part].begin; g < lanes.part[part].end; ++g)
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes.group[g].pair[lane] != kNone) store(lanes.group[g], lane);
    });
}

}  // namespace taut
