#include "publish/contact_watch.h"

#include <algorithm>

namespace taut {
namespace {

// The new point that takes over an old one: of the same feature, else the nearest.
int successor(const WatchedPair& watched, int old, const collision::Manifold& now) {
    int nearest = 0;
    for (int k = 0; k < now.count; ++k) {
        if (now.points[k].feature == watched.feature[old]) return k;
        const auto distance = [&](int i) { return (now.points[i].position - watched.position[old]).squaredNorm(); };
        if (distance(k) < distance(nearest)) nearest = k;
    }
    return nearest;
}

// Blocks find their contacts anew in each substep: the sums go to the points that are there now.
void follow_points(const collision::Manifold& now, WatchedPair& watched) {
    if (now.count == 0) return;
    const WatchedPair old = watched;
    watched.count = now.count;
    for (int k = 0; k < now.count; ++k) {
        watched.feature[k] = now.points[k].feature;
        watched.position[k] = now.points[k].position;
        watched.normal[k] = 0;
        watched.friction[k].setZero();
    }
    for (int i = 0; i < old.count; ++i) {
        const int k = successor(old, i, now);
        watched.normal[k] += old.normal[i];
        watched.friction[k] += old.friction[i];
    }
}

// Of the last substep [N s]: normal, tangent 1, tangent 2.
Vec3f impulse_of(const WatchedPair& watched, const System& system, const Pair& pair, int k) {
    const ContactForce& force = pair.force[k];
    if (watched.lane_group == kNone)
        return static_cast<float>(system.scheme.h) * Vec3f(force.normal, force.tangent1, force.tangent2);
    const ContactLanes& lanes = system.contacts;
    const LanePoint& p = lanes.group[watched.lane_group].point[k];
    return {p.impulse[0][watched.lane], p.impulse[1][watched.lane], p.impulse[2][watched.lane]};
}

}  // namespace

WatchedPair* find_watched(ContactWatch& watch, uint32_t pair) {
    const auto at = std::lower_bound(watch.pairs.begin(), watch.pairs.end(), pair,
                                     [](const WatchedPair& each, uint32_t index) { return each.pair < index; });
    return at != watch.pairs.end() && at->pair == pair ? &*at : nullptr;
}

void watch_contacts(const Nodes& nodes, const Pairs& pairs, ContactWatch& watch) {
    watch.pairs.clear();
    for (const ActivePair& active : pairs.active) {
        if (!(active.asks & kAsksWatch)) continue;
        WatchedPair& watched = watch.pairs.emplace_back();
        watched.pair = active.pair;
        watched.before = relative_motion(nodes, pairs.list[active.pair]);
    }
    std::sort(watch.pairs.begin(), watch.pairs.end(),
              [](const WatchedPair& one, const WatchedPair& other) { return one.pair < other.pair; });
}

void watch_group(const Group& group, const System& system, const Pairs& pairs, ContactWatch& watch) {
    watch.current.clear();
    if (watch.pairs.empty()) return;
    for (const Array<uint32_t>* list : {&group.pairs, &group.span_pairs, &group.direct_pairs})
        for (const uint32_t active : *list)
            if (const WatchedPair* watched = find_watched(watch, pairs.active[active].pair))
                watch.current.push_back(static_cast<uint32_t>(watched - watch.pairs.data()));
    const auto& lanes = system.contacts.group;
    for (uint32_t g = 0; g < lanes.size(); ++g) {
        for (uint32_t lane = 0; lane < kLanes; ++lane) {
            if (lanes[g].pair[lane] == kNone) continue;
            WatchedPair* watched = find_watched(watch, lanes[g].pair[lane]);
            if (!watched) continue;
            watched->lane_group = g;
            watched->lane = lane;
        }
    }
}

void gather_impulses(const System& system, const Impacts& impacts, const Pairs& pairs, ContactWatch& watch) {
    for (const uint32_t index : watch.current) {
        WatchedPair& watched = watch.pairs[index];
        const Pair& pair = pairs.list[watched.pair];
        follow_points(pair.manifold, watched);
        const Vec3f n = pair.manifold.normal, t1 = tangent_of(n), t2 = n.cross(t1);
        for (int k = 0; k < pair.manifold.count; ++k) {
            const Vec3f impulse = impulse_of(watched, system, pair, k);
            watched.normal[k] += impulse[0];
            watched.friction[k] += impulse[1] * t1 + impulse[2] * t2;
        }
    }
    for (const Impacts::Strike& strike : impacts.strikes) {
        WatchedPair* watched = find_watched(watch, strike.pair);
        if (!watched) continue;
        const Vec3f n = pairs.list[strike.pair].manifold.normal, t1 = tangent_of(n), t2 = n.cross(t1);
        watched->normal[strike.point] += strike.impulse[0];
        watched->friction[strike.point] += strike.impulse[1] * t1 + strike.impulse[2] * t2;
    }
}

}  // namespace taut
