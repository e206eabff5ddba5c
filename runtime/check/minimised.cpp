#include "check/minimised.h"

#include <algorithm>

#include "models/soft_reading.h"

namespace taut {
namespace {

bool may_touch(const World& world, uint32_t node) {
    bool any = false;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        const taut_filter& filter = world.colliders.traits[c].filter;
        any = any || (!world.colliders.record[c].sensor && (filter.mask != 0 || filter.group > 0));
    });
    return any;
}

// Whether some collider of a node that may be met has no level set, or is met from one side only.
const char* why_no_obstacle(const World& world, uint32_t node) {
    const char* why = nullptr;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        const Collider& collider = world.colliders.record[c];
        if (collider.sensor || world.colliders.traits[c].filter.mask == 0) return;
        if (!collision::has_level_set(world.shapes[collider.shape].shape))
            why =
                "a mesh or height field that may be touched and has no distances sampled: "
                "taut_shape_sample_distance";
        if (world.colliders.traits[c].one_way != Vec3f::Zero())
            why = "a collider of one way: TAUT_SOLVER_MINIMISATION keeps out on all sides";
    });
    return why;
}

// Whether vertices can be within it.
bool has_inside(const World& world, const Soft& soft) {
    return soft.kind == SoftKind::solid && !is_meshless(world, soft);
}

// Whether surfaces meet of which none has an inside.
const char* why_no_surfaces(const World& world) {
    constexpr const char* kWhy =
        "surfaces that may touch each other, or themselves, without cells: TAUT_SOLVER_MINIMISATION knows who is "
        "within cells of solids";
    for (const Soft& one : world.softs.record) {
        const uint32_t a = one.node.empty() ? kNone : collider_of(world.nodes, one);
        if (a == kNone || has_inside(world, one)) continue;
        if (one.self) return kWhy;
        for (const Soft& other : world.softs.record) {
            const uint32_t b = other.node.empty() || &one == &other ? kNone : collider_of(world.nodes, other);
            if (b != kNone && !has_inside(world, other) &&
                filters_agree(world.colliders.traits[a].filter, world.colliders.traits[b].filter))
                return kWhy;
        }
    }
    return nullptr;
}

}  // namespace

const char* why_not_minimised(const World& world) {
    if (!solvers()[world.def.solver]->energies) return nullptr;
    if (world.joints.ids.count() > 0) return "joints: TAUT_SOLVER_MINIMISATION takes none";
    for (uint32_t node = 0; node < world.nodes.slots(); ++node) {
        const NodeKind kind = world.nodes.info[node].kind;
        if (kind == NodeKind::dynamic) return "a rigid dynamic body: TAUT_SOLVER_MINIMISATION takes none";
        if (kind == NodeKind::particle && world.nodes.info[node].soft == kNone && may_touch(world, node))
            return "a particle or cable that may touch (filter.mask is not 0): TAUT_SOLVER_MINIMISATION has contacts "
                   "of cloths and solids alone";
        if (kind == NodeKind::fixed || kind == NodeKind::kinematic)
            if (const char* why = why_no_obstacle(world, node)) return why;
    }
    if (const char* why = why_no_surfaces(world)) return why;
    for (const ElementSet& set : world.elements.set) {
        if (!set.type || set.size() == 0) continue;
        if (set.type->freedoms != 3) return "attachments: TAUT_SOLVER_MINIMISATION takes none";
        if (!(set.stiffness[0] > 0)) return "a compliance of 0: TAUT_SOLVER_MINIMISATION takes what gives way";
    }
    return nullptr;
}

const char* why_not_relaxed(World& world) {
    if (!solvers()[world.def.solver]->energies) return "the world's solver is not TAUT_SOLVER_MINIMISATION";
    if (const char* why = why_not_minimised(world)) return why;
    const Nodes& nodes = world.nodes;
    Array<uint32_t> parent(world.memory);
    Array<uint8_t> held(nodes.slots(), uint8_t{0}, world.memory);
    for (uint32_t node = 0; node < nodes.slots(); ++node) {
        parent.push_back(node);
        held[node] = nodes.info[node].kind != NodeKind::particle;
    }
    const auto root_of = [&](uint32_t node) {
        while (parent[node] != node) node = parent[node] = parent[parent[node]];
        return node;
    };
    for_each_element(world.elements, [&](const ElementSet&, uint32_t, std::span<const uint32_t> ends) {
        const uint32_t first = root_of(ends[0]);
        for (const uint32_t node : ends) {
            const uint32_t other = root_of(node);
            held[first] |= held[other];
            parent[other] = first;
        }
    });
    const taut_vec3& g = world.def.gravity;
    for (uint32_t node = 0; node < nodes.slots(); ++node) {
        if (held[root_of(node)]) continue;
        const bool falls = nodes.mass[node].gravity_scale != 0 && (g.x != 0 || g.y != 0 || g.z != 0);
        if (falls || (node < nodes.applied.size() && nodes.applied[node].any()))
            return "something that nothing holds, with a force on it, has no rest";
    }
    return nullptr;
}

}  // namespace taut
