// Contacts of surfaces, into lanes and their forces back.
#include <algorithm>
#include <atomic>

#include "system/assemble.h"

namespace taut {
namespace {

// Whether the first node is not as a particle is: its lever matters, for it turns or may be turned, or has a locked
// axis.
bool turns(const System& system, const SurfaceContact& contact) {
    const SweepNode& node = system.sweep[system.at(contact.node[0])];
    if (node.locked()) return true;
    if (contact.lever == Vec3f::Zero()) return false;
    return node.mass.inv_mass > 0 || Vec3f::Map(node.velocity.w) != Vec3f::Zero();
}

// Of one that is swept from now on; see leave_block() of pairs.
void leave_block(SurfaceContact& contact) {
    if (contact.in_block) contact.force = {};
    contact.in_block = false;
}

void fill_surface_lane(const System& system, const SurfaceContact& contact, SurfaceGroup& g, int lane) {
    const auto h = static_cast<float>(system.scheme.h);
    for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
        const uint32_t at = system.at(contact.node[n]);
        g.node[n][lane] = at;
        g.weight[n][lane] = contact.node[n] == kNone ? 0 : contact.weight[n];
        g.inv_mass[n][lane] = system.sweep[at].mass.inv_mass;
    }
    const Vec3f t1 = tangent_of(contact.normal), t2 = contact.normal.cross(t1);
    for (int i = 0; i < 3; ++i) {
        g.normal[i][lane] = contact.normal[i];
        g.tangent[i][lane] = t1[i];
    }
    g.gap0[lane] = g.gap[lane] = contact.gap;
    g.friction[lane] = contact.friction;
    g.restitution[lane] = contact.restitution;
    g.drive[0][lane] = contact.drive.dot(t1);
    g.drive[1][lane] = contact.drive.dot(t2);
    g.impulse[0][lane] = h * contact.force.normal;
    g.impulse[1][lane] = h * contact.force.tangent1;
    g.impulse[2][lane] = h * contact.force.tangent2;
    g.peak[lane] = 0;
}

void clear_surface_lane(SurfaceGroup& g, int lane) {
    g.contact[lane] = kNoLanes;
    for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
        g.node[n][lane] = 0;
        g.weight[n][lane] = g.inv_mass[n][lane] = 0;
    }
    for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.tangent[i][lane] = g.impulse[i][lane] = 0;
    for (auto* row : {&g.gap0, &g.gap, &g.friction, &g.drive[0], &g.drive[1], &g.peak, &g.restitution})
        (*row)[lane] = 0;
}

// What is special about the group is noted in it and has no room yet.
void fill_surface_group(const System& system, SurfaceContacts& surfaces, std::span<const uint32_t> list,
                        SurfaceGroup& g) {
    bool turning = false, bounces = false;
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
        if (lane >= list.size()) {
            clear_surface_lane(g, static_cast<int>(lane));
            continue;
        }
        SurfaceContact& contact = surfaces.contact[list[lane]];
        g.contact[lane] = list[lane];
        leave_block(contact);
        fill_surface_lane(system, contact, g, static_cast<int>(lane));
        turning = turning || turns(system, contact);
        bounces = bounces || contact.restitution > 0;
    }
    g.turning = turning ? 0 : kNoLanes;
    g.bounces = bounces;
}

void fill_turning(const System& system, const SurfaceContacts& surfaces, const SurfaceGroup& g, SurfaceTurning& t) {
    for (int lane = 0; lane < kLanes; ++lane) {
        const SurfaceContact* contact = g.contact[lane] == kNoLanes ? nullptr : &surfaces.contact[g.contact[lane]];
        const bool has_lever = contact && turns(system, *contact);
        for (int i = 0; i < 3; ++i) {
            t.lever[i][lane] = has_lever ? contact->lever[i] : 0;
            t.skin[i][lane] = has_lever ? contact->skin[i] : 0;
        }
    }
}

// A lane group for each kLanes contacts of a colour; of the overflow colour for each one.
void add_surface_passes(SurfaceLanes& lanes, const Group& group) {
    uint32_t groups = 0;
    for (uint32_t colour = 0; colour < kMaxColours; ++colour) {
        const uint32_t first = group.surface_colour_begin[colour];
        const uint32_t count = group.surface_colour_begin[colour + 1] - first;
        const bool overflow = colour + 1 == kMaxColours;
        const uint32_t width = overflow ? 1 : kLanes;
        if (count == 0) continue;
        const uint32_t begin = groups;
        groups += (count + width - 1) / width;
        lanes.pass.push_back({begin, groups, overflow, first, count});
    }
    reserve_more(lanes.group, groups);
    lanes.group.resize(groups);
}

// act(lane group) for all of them.
template <class Act>
void for_surface_groups(Team& team, SurfaceLanes& lanes, Act&& act) {
    team.for_ranges(size_of(lanes.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) act(i);
    });
}

}  // namespace

void build_surface_lanes(Team& team, System& system, const Group& group, SurfaceContacts& surfaces,
                         const SurfaceKernels& kernels) {
    SurfaceLanes& lanes = system.surfaces;
    lanes.group.clear();
    lanes.turning.clear();
    lanes.pass.clear();
    lanes.bounces = false;
    if (group.surfaces.empty()) return;
    add_surface_passes(lanes, group);
    for (const SurfacePass& pass : lanes.pass) {
        const uint32_t width = pass.overflow ? 1 : kLanes;
        const std::span list(&group.surfaces[pass.first], pass.count);
        team.for_ranges(pass.end - pass.begin, kLaneGrain, [&](uint32_t begin, uint32_t end) {
            for (uint32_t i = begin; i < end; ++i)
                fill_surface_group(system, surfaces, list.subspan(i * width, std::min(width, pass.count - i * width)),
                                   lanes.group[pass.begin + i]);
        });
    }
    uint32_t turning = 0;
    for (SurfaceGroup& g : lanes.group) {
        if (g.turning != kNoLanes) g.turning = turning++;
        lanes.bounces = lanes.bounces || g.bounces;
    }
    reserve_more(lanes.turning, turning);
    lanes.turning.resize(turning);
    for_surface_groups(team, lanes, [&](uint32_t i) {
        const SurfaceGroup& g = lanes.group[i];
        if (g.turning != kNoLanes) fill_turning(system, surfaces, g, lanes.turning[g.turning]);
        kernels.prepare(lanes.view(), i, i + 1, system.sweep.data());
    });
}

void turn_surface_lanes(Team& team, System& system, const SurfaceKernels& kernels) {
    SurfaceLanes& lanes = system.surfaces;
    if (lanes.turning.empty()) return;
    for_surface_groups(team, lanes, [&](uint32_t i) {
        const SurfaceGroup& g = lanes.group[i];
        if (g.turning == kNoLanes) return;
        alignas(64) float turned[kLanes];
        bool any = false;
        for (int lane = 0; lane < kLanes; ++lane) {
            const bool did = system.turned[g.node[0][lane]] != 0;
            turned[lane] = did;
            any = any || did;
        }
        if (any) kernels.turn(lanes.view(), i, turned, system.shift.data(), system.sweep.data());
    });
}

void rescale_surface_lanes(System& system, double factor) {
    const auto by = static_cast<float>(factor);
    for (SurfaceGroup& g : system.surfaces.group)
        for (auto& row : g.impulse)
            for (float& impulse : row) impulse *= by;
}

void store_surface_lanes(Team& team, const System& system, SurfaceContacts& surfaces) {
    const float per_h = 1 / static_cast<float>(system.scheme.h);
    team.for_ranges(size_of(system.surfaces.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const SurfaceGroup& g = system.surfaces.group[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                if (g.contact[lane] == kNoLanes) continue;
                surfaces.contact[g.contact[lane]].force = {per_h * g.impulse[0][lane] + 0.0f,
                                                           per_h * g.impulse[1][lane] + 0.0f,
                                                           per_h * g.impulse[2][lane] + 0.0f};
            }
        }
    });
}

// By which a gap has grown since the begin of the frame.
static float gap_moved(const System& system, const SurfaceContact& contact, const SurfaceGroup& g, int lane) {
    Vec3f moved = Vec3f::Zero();
    for (uint32_t n = 0; n < kSurfaceNodes; ++n)
        moved += g.weight[n][lane] * Vec3f::Map(system.shift[g.node[n][lane]].dx);
    if (turns(system, contact)) {
        const float(&dq)[4] = system.shift[g.node[0][lane]].dq;
        const Vec3f core = contact.lever - contact.skin, q(dq[0], dq[1], dq[2]), across = q.cross(core);
        moved += g.weight[0][lane] * 2 * (dq[3] * across + q.cross(across));
    }
    return moved.dot(contact.normal);
}

void store_surface_hits(const System& system, SurfaceContacts& surfaces, std::span<SurfaceHit> hits) {
    for (const SurfaceGroup& g : system.surfaces.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.contact[lane] == kNoLanes) continue;
            SurfaceContact& contact = surfaces.contact[g.contact[lane]];
            hits[g.contact[lane]] = {g.peak[lane], g.approach[lane]};
            contact.gap = g.gap0[lane] + gap_moved(system, contact, g, lane);
        }
}

// Gaps go on from where nodes are now, though what moves them is counted from the begin of the frame on.
void load_surface_hits(System& system, const SurfaceContacts& surfaces, std::span<const SurfaceHit> hits) {
    for (SurfaceGroup& g : system.surfaces.group) {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.contact[lane] == kNoLanes) continue;
            const SurfaceContact& contact = surfaces.contact[g.contact[lane]];
            if (const SurfaceHit& hit = hits[g.contact[lane]]; hit.peak > 0) {
                g.peak[lane] = hit.peak;
                g.approach[lane] = hit.approach;
            }
            g.gap0[lane] -= gap_moved(system, contact, g, lane);
        }
    }
}

}  // namespace taut
