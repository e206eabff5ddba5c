// Contacts between grains, into lanes and their forces back.
#include <algorithm>

#include "constraints/soft_contact.h"
#include "system/assemble.h"

namespace taut {
namespace {

void fill_grain_lane(const System& system, const GrainContact& contact, GrainGroup& g, int lane) {
    const uint32_t a = system.at(contact.a), b = system.at(contact.b);
    const auto h = static_cast<float>(system.scheme.h);
    g.a[lane] = a;
    g.b[lane] = b;
    g.inv_mass[0][lane] = system.sweep[a].mass.inv_mass;
    g.inv_mass[1][lane] = system.sweep[b].mass.inv_mass;
    g.gap0[lane] = g.gap[lane] = contact.separation;
    g.friction[lane] = contact.friction;
    const float push = std::max(contact.force.dot(contact.normal), 0.0f);
    const Vec3f slide = contact.force - push * contact.normal;
    float approach = 0;
    for (int i = 0; i < 3; ++i) {
        g.normal[i][lane] = contact.normal[i];
        g.slide[i][lane] = h * slide[i];
        approach += contact.normal[i] * (system.sweep[b].velocity.v[i] - system.sweep[a].velocity.v[i]);
    }
    g.impulse[lane] = h * push;
    g.hits[lane] = approach < -kHardSpeed ? 1 : 0;
}

void clear_grain_lane(GrainGroup& g, int lane) {
    g.a[lane] = g.b[lane] = 0;
    g.contact[lane] = kNoLanes;
    for (auto* row : {&g.inv_mass[0], &g.inv_mass[1], &g.gap0, &g.gap, &g.friction, &g.hits, &g.impulse})
        (*row)[lane] = 0;
    for (int i = 0; i < 3; ++i) g.normal[i][lane] = g.slide[i][lane] = 0;
}

// A lane group for each kLanes contacts of a colour; of the overflow colour for each one.
void add_passes_of(GrainLanes& lanes, const Group& group) {
    uint32_t groups = 0;
    for (uint32_t colour = 0; colour < kMaxColours; ++colour) {
        const uint32_t count = group.grain_colour_begin[colour + 1] - group.grain_colour_begin[colour];
        const bool overflow = colour + 1 == kMaxColours;
        const uint32_t width = overflow ? 1 : kLanes;
        if (count == 0) continue;
        const uint32_t begin = groups;
        groups += (count + width - 1) / width;
        lanes.pass.push_back({begin, groups, overflow, group.grain_colour_begin[colour], count});
    }
    reserve_more(lanes.group, groups);
    lanes.group.resize(groups);
}

}  // namespace

void build_grain_lanes(Team& team, System& system, const Group& group, const Grains& grains) {
    GrainLanes& lanes = system.grains;
    lanes.group.clear();
    lanes.pass.clear();
    if (group.grains.empty()) return;
    add_passes_of(lanes, group);
    for (const GrainPass& pass : lanes.pass) {
        const uint32_t width = pass.overflow ? 1 : kLanes;
        team.for_ranges(pass.end - pass.begin, kLaneGrain, [&](uint32_t begin, uint32_t end) {
            for (uint32_t i = begin; i < end; ++i) {
                GrainGroup& g = lanes.group[pass.begin + i];
                for (uint32_t lane = 0; lane < kLanes; ++lane) {
                    const uint32_t k = i * width + lane;
                    if (lane >= width || k >= pass.count) {
                        clear_grain_lane(g, static_cast<int>(lane));
                        continue;
                    }
                    g.contact[lane] = group.grains[pass.first + k];
                    fill_grain_lane(system, grains.contact[g.contact[lane]], g, static_cast<int>(lane));
                }
            }
        });
    }
}

void rescale_grain_lanes(System& system, double factor) {
    const auto by = static_cast<float>(factor);
    for (GrainGroup& g : system.grains.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            g.impulse[lane] *= by;
            for (auto& row : g.slide) row[lane] *= by;
        }
}

void store_grain_lanes(Team& team, const System& system, Grains& grains) {
    const float per_h = 1 / static_cast<float>(system.scheme.h);
    team.for_ranges(size_of(system.grains.group), kLaneGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const GrainGroup& g = system.grains.group[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                if (g.contact[lane] == kNoLanes) continue;
                GrainContact& contact = grains.contact[g.contact[lane]];
                for (int k = 0; k < 3; ++k)
                    contact.force[k] = per_h * (g.impulse[lane] * g.normal[k][lane] + g.slide[k][lane]) + 0.0f;
            }
        }
    });
}

}  // namespace taut
