#include "publish/contact_watch.h"

#include <algorithm>

#include "detect/surface_point.h"

namespace taut {
namespace {

constexpr uint32_t kWatchGrain = 64;  // contacts that a thread takes at a time

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
        watched.push[k].setZero();
        watched.friction[k].setZero();
    }
    for (int i = 0; i < old.count; ++i) {
        const int k = successor(old, i, now);
        watched.push[k] += old.push[i];
        watched.friction[k] += old.friction[i];
    }
}

// Of the last substep, of its rows [N s]: normal, tangent 1, tangent 2.
Vec3f impulse_of(const WatchedPair& watched, const System& system, const Pair& pair, int k) {
    const ContactForce force = to_rows(pair, pair.force[k]);
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
        const Vec3f n = pair.manifold.normal;
        const Tangents tangents = tangents_of(pair);
        for (int k = 0; k < pair.manifold.count; ++k) {
            const Vec3f impulse = impulse_of(watched, system, pair, k);
            watched.push[k] += impulse[0] * n;
            watched.friction[k] += friction_of(tangents, impulse[1], impulse[2]);
        }
    }
    for (const Impacts::Strike& strike : impacts.strikes) {
        WatchedPair* watched = find_watched(watch, strike.pair);
        if (!watched) continue;
        const Pair& pair = pairs.list[strike.pair];
        watched->push[strike.point] += strike.impulse[0] * pair.manifold.normal;
        watched->friction[strike.point] += friction_of(tangents_of(pair), strike.impulse[1], strike.impulse[2]);
    }
}

namespace {

// Of a substep [N s]: normal, tangent 1, tangent 2.
void add_impulse(SurfaceContact& contact, float normal, float tangent1, float tangent2) {
    if (!(normal > 0)) return;
    const Vec3f t1 = tangent_of(contact.normal), t2 = contact.normal.cross(t1);
    contact.pushed += normal;
    contact.push += normal * contact.normal;
    contact.rubbed += tangent1 * t1 + tangent2 * t2;
}

}  // namespace

void watch_surfaces(Team& team, const Nodes& nodes, const Colliders& colliders, Pairs& pairs) {
    Array<SurfaceContact>& contacts = pairs.surfaces.contact;
    const auto asks = [&](uint32_t collider) {
        return colliders.ids.live(collider) ? colliders.record[collider].asks : uint8_t{0};
    };
    team.for_ranges(static_cast<uint32_t>(contacts.size()), kWatchGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            SurfaceContact& contact = contacts[i];
            contact.pushed = 0;
            contact.push = contact.rubbed = Vec3f::Zero();
            const uint32_t asked = pairs.asks | asks(contact.collider[0]) | asks(contact.collider[1]);
            contact.approach = asked & kAsksWatch ? closing_speed(nodes, contact) : 0;
        }
    });
}

void gather_surface_impulses(Team& team, const System& system, const Impacts& impacts, SurfaceContacts& surfaces) {
    if (surfaces.contact.empty()) return;
    const auto& lanes = system.surfaces.group;
    team.for_ranges(static_cast<uint32_t>(lanes.size()), kWatchGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t g = begin; g < end; ++g)
            for (uint32_t lane = 0; lane < kLanes; ++lane)
                if (lanes[g].contact[lane] != kNoLanes)
                    add_impulse(surfaces.contact[lanes[g].contact[lane]], lanes[g].impulse[0][lane],
                                lanes[g].impulse[1][lane], lanes[g].impulse[2][lane]);
    });
    const auto h = static_cast<float>(system.scheme.h);
    for (const RowBlock& block : system.rows.block) {
        if (!block.contact || block.pair != kNone) continue;
        const ContactForce& force = *block.contact;
        add_impulse(surfaces.contact[block.surface], h * force.normal, h * force.tangent1, h * force.tangent2);
    }
    for (const Impacts::Strike& strike : impacts.strikes)
        if (strike.pair == kNone)
            add_impulse(surfaces.contact[static_cast<uint32_t>(strike.point)], strike.impulse[0], strike.impulse[1],
                        strike.impulse[2]);
}

}  // namespace taut
