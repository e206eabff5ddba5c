#include <cmath>
#include <span>

#include "state/levers.h"
#include "system/assemble.h"

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
    rolling.arm[0][lane] = pair ? pair->spinning : 0;
    rolling.arm[1][lane] = pair ? pair->rolling : 0;
    const bool turns = pair && pair->turns();
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

// The pairs that add_group chose, into their lanes.
void fill_group(ContactLanes& lanes, LaneGroup& g, const Pairs& pairs, const Nodes& nodes) {
    for (int lane = 0; lane < kLanes; ++lane) {
        uint32_t filled = 0;
        if (g.pair[lane] != kNone) {
            const Pair& pair = pairs.list[g.pair[lane]];
            fill_pair(lanes, g, lane, pair, nodes);
            filled = static_cast<uint32_t>(pair.manifold.count);
        } else {
            g.a[lane] = g.b[lane] = 0;
            g.rolls[0][lane] = g.rolls[1][lane] = 0;
            g.friction[lane] = g.turns[lane] = g.round[0][lane] = g.round[1][lane] = 0;
            for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.tangent[i][lane] = 0;
        }
        for (uint32_t k = filled; k < g.points; ++k) clear_lane(lanes.point[g.first_point + k], lane);
        const Pair* pair = g.pair[lane] == kNone ? nullptr : &pairs.list[g.pair[lane]];
        if (g.first_drive != kNoLanes) fill_drive(lanes, g, lane, pair);
        if (g.rolling != kNoLanes) fill_rolling(lanes.rolling[g.rolling], lane, pair);
    }
}

// Room for at most kLanes active pairs of a colour; the first has the most points.
void add_group(ContactLanes& lanes, const Pairs& pairs, const uint32_t* items, uint32_t count) {
    LaneGroup& g = lanes.group.emplace_back();
    g.first_point = static_cast<uint32_t>(lanes.point.size());
    g.points = pairs.active[items[0]].points;
    lanes.point.resize(lanes.point.size() + g.points);
    bool driven = false, turns = false, round = false;
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
        g.pair[lane] = lane < count ? pairs.active[items[lane]].pair : kNone;
        if (lane >= count) continue;
        const Pair& pair = pairs.list[g.pair[lane]];
        lanes.bounces = lanes.bounces || pair.restitution > 0;
        driven = driven || pair.driven;
        turns = turns || pair.turns();
        round = round || pair.round_a > 0 || pair.round_b > 0;
    }
    g.is_round = round;
    if (driven) {
        g.first_drive = static_cast<uint32_t>(lanes.drive.size());
        lanes.drive.resize(lanes.drive.size() + g.points);
    }
    if (turns) {
        g.rolling = static_cast<uint32_t>(lanes.rolling.size());
        lanes.rolling.emplace_back();
    }
}

// Lane groups of one colour. Pairs with as many points come side by side: few empty places.
void add_colour(ContactLanes& lanes, const Pairs& pairs, std::span<const uint32_t> items, uint32_t width) {
    uint32_t batch[kLanes], filled = 0;
    for (uint32_t points = 4; points >= 1; --points) {
        for (uint32_t item : items) {
            if (pairs.active[item].points != points) continue;
            batch[filled++] = item;
            if (filled < width) continue;
            add_group(lanes, pairs, batch, filled);
            filled = 0;
        }
    }
    if (filled > 0) add_group(lanes, pairs, batch, filled);
    lanes.colour_begin.push_back(static_cast<uint32_t>(lanes.group.size()));
}

// Calls act(pairs, width) for each colour, in order.
template <class Act>
void for_pair_colours(const Group& group, Act&& act) {
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t begin = group.pair_colour_begin[c], end = group.pair_colour_begin[c + 1];
        const uint32_t width = c + 1 == kMaxColours ? 1 : kLanes;  // the overflow colour: one pair at a time
        act(std::span(group.pairs.data() + begin, end - begin), width);
    }
}

// A colour's lane groups of at least k points are those that its pairs of as many fill, the last one in part.
void reserve_lanes(ContactLanes& lanes, const Pairs& pairs, const Group& group) {
    size_t groups = 0, points = 0;
    for_pair_colours(group, [&](std::span<const uint32_t> items, uint32_t width) {
        size_t at_least[5] = {};
        for (uint32_t item : items)
            for (uint32_t k = 1; k <= pairs.active[item].points; ++k) ++at_least[k];
        for (uint32_t k = 1; k <= 4; ++k) points += (at_least[k] + width - 1) / width;
        groups += (items.size() + width - 1) / width;
    });
    reserve_more(lanes.group, groups);
    reserve_more(lanes.point, points);
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
    lanes.bounces = false;
    lanes.colour_begin.assign(1, 0);
    reserve_lanes(lanes, pairs, group);
    for_pair_colours(group,
                     [&](std::span<const uint32_t> items, uint32_t width) { add_colour(lanes, pairs, items, width); });
    team.for_ranges(static_cast<uint32_t>(lanes.group.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t g = begin; g < end; ++g) fill_group(lanes, lanes.group[g], pairs, nodes);
        kernels.prepare(lanes.view(), begin, end, system.velocity.data(), system.inverse_mass.data());
    });
}

namespace {

// One side's levers with its body: what turns is the core; the gap since detection goes on from the new lever.
void turn_side(const Quat& turn, const Vec3f& skin, bool rolls, float (&r)[3][kLanes], int lane, const Vec3f& normal,
               float sign, LanePoint& p) {
    const Vec3f core = Vec3f(r[0][lane], r[1][lane], r[2][lane]) - skin;
    const Vec3f turned = turn.cast<float>() * core;
    for (int i = 0; i < 3 && !rolls; ++i) r[i][lane] = turned[i] + skin[i];
    p.gap0[lane] += sign * normal.dot(turned - core);
}

// An impulse that fitted the levers and masses of the last substep throws a thin body about where these have changed:
// beyond this share of the mass along the normal it is not carried on (measured: of thin spinning cylinders that
// hit a wall at 100 m/s one in four gained energy, up to 6 times).
constexpr float kOtherMass = 0.2f;

// What was hit already keeps the approach speed that it had.
void renew_masses(ContactLanes& lanes, uint32_t group, const System& system, const ContactKernels& kernels) {
    const LaneGroup& g = lanes.group[group];
    float approach[4][kLanes], mass[4][kLanes];
    for (uint32_t k = 0; k < g.points; ++k) {
        LanePoint& p = lanes.point[g.first_point + k];
        for (int lane = 0; lane < kLanes; ++lane) {
            approach[k][lane] = p.approach[lane];
            mass[k][lane] = p.normal_mass[lane];
            p.normal_mass[lane] = mass[k][lane] > 0 ? 1 : 0;  // in use
        }
    }
    kernels.prepare(lanes.view(), group, group + 1, system.velocity.data(), system.inverse_mass.data());
    for (uint32_t k = 0; k < g.points; ++k) {
        LanePoint& p = lanes.point[g.first_point + k];
        for (int lane = 0; lane < kLanes; ++lane) {
            if (p.peak[lane] > 0) p.approach[lane] = approach[k][lane];
            if (std::abs(p.normal_mass[lane] - mass[k][lane]) <= kOtherMass * mass[k][lane]) continue;
            for (auto& impulse : p.impulse) impulse[lane] = 0;
        }
    }
}

bool turn_group(ContactLanes& lanes, LaneGroup& g, const System& system) {
    bool any = false;
    for (int lane = 0; lane < kLanes; ++lane) {
        const uint32_t a = g.a[lane], b = g.b[lane];
        if (!system.turned[a] && !system.turned[b]) continue;
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
        if (!pair.turns()) return;
        const float(&turning)[3][kLanes] = lanes.rolling[g.rolling].impulse;
        pair.turning = {turning[0][lane], turning[1][lane], turning[2][lane]};
        pair.spin_slip = -1;
    };
    team.for_ranges(static_cast<uint32_t>(lanes.group.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t g = begin; g < end; ++g)
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes.group[g].pair[lane] != kNone) store(lanes.group[g], lane);
    });
}

}  // namespace taut
