// Contacts of surfaces of soft bodies, but for those of their vertices with shapes, which are pairs.
//
// Against each other: vertices with faces and edges with edges that come within the sum of their radii and the contact
// margin in the frame, as they move now, at the moment when they first do. Against shapes: edges, which are capsules,
// and faces with what stands out of a shape. Of two features that were in touch before the side is known: they are
// pulled back through each other.
#pragma once

#include <span>

#include "collision/collide.h"
#include "detect/pre_solve.h"
#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"
#include "state/softs.h"
#include "threads/team.h"

namespace taut {

enum class Renewed : uint8_t { not_own, own, unmoved };  // moved by forces elsewhere, in the group, by none

struct SurfaceScene {
    const Nodes& nodes;
    const Colliders& colliders;
    const Shapes& shapes;
    Softs& softs;
    const Elements& elements;
    Pairs& pairs;
    const collision::Broadphase& broadphase;
    double time;         // ahead [s]
    double elapsed = 0;  // of the frame [s]; kinematic nodes move at its end
    // Within a frame, by node: whose contacts are found anew. Empty: all.
    std::span<const Renewed> renewed = {};
    double since = 0, step = 0;  // contacts were found last; that comes [s]

    Vec3 place_of(uint32_t node) const {
        const NodeMotion& motion = nodes.motion[node];
        return nodes.info[node].kind == NodeKind::kinematic ? Vec3(motion.x + elapsed * motion.v) : motion.x;
    }
    bool may_renew(uint32_t node) const { return renewed.empty() || renewed[node] != Renewed::not_own; }
};

// Into Pairs::surfaces, with the forces of those that touched before. After update_pairs() of the frame.
void find_surface_contacts(Team& team, const SurfaceScene& scene);

// Parts of the margin. Contacts miss nothing while no vertex is off the way that they were found for by more than the
// first. Then those that are off by more than the second get new ways, on which triangles meet others where these are,
// not where they should be: 2 kStrays + kRenews = 1.
constexpr float kStrays = 0.375f, kRenews = 0.25f;

// Whether what is left of a time ends within a step.
inline bool is_over(float left, double step) { return left < 0.999f * static_cast<float>(step); }

// Whether some vertex is off its way, a time [s] since, or a way ends within a step [s]. motion: of the node of a
// vertex.
template <class MotionOf>
bool have_strayed(const Softs& softs, std::span<const Renewed> renewed, double since, double step, MotionOf&& motion) {
    for (size_t s = 0; s < softs.mesh.size(); ++s) {
        const Soft& soft = softs.record[s];
        const SurfaceMesh& mesh = softs.mesh[s];
        if (mesh.version == 0 || mesh.collider == kNone || !mesh.awake) continue;
        const auto time = static_cast<float>(since);
        if (is_over(mesh.left - time, step) && renewed[soft.node.front()] == Renewed::own) return true;
        const float most = kStrays * kStrays * mesh.margin * mesh.margin;
        for (uint32_t v = 0; v < soft.vertices(); ++v) {
            if (renewed[soft.node[v]] != Renewed::own) continue;
            const Vec3f now = (motion(soft.node[v]).x - mesh.origin).template cast<float>();
            if (!((now - mesh.way[v] - time * mesh.v[v]).squaredNorm() <= most)) return true;
        }
    }
    return false;
}

// Those of the renewed nodes anew, within a frame, as the host's filter has them; all others stay. successor: of each
// before its index now, or kNone.
void renew_surface_contacts(Team& team, const SurfaceScene& scene, const PreSolve& pre_solve,
                            Array<uint32_t>& successor);

}  // namespace taut
