// Features of two surfaces, or of one with itself, that may come near in a time: corners with faces, edges with edges,
// and edges that go through faces. By boxes of leaves and triangles, then by distances, in lanes; ranges of leaves at
// once, so that what is found has no order.
#pragma once

#include <span>

#include "state/softs.h"
#include "state/surface_contacts.h"
#include "threads/team.h"

namespace taut {

// Two surfaces in the frame of the first.
struct SurfaceSides {
    const Soft* soft[2];
    const SurfaceMesh* mesh[2];
    uint32_t index[2];
    Vec3f apart;                       // from the first's origin to the second's [m]
    std::span<const uint64_t> joined;  // pair_key() of nodes that joints hold together, ascending

    bool is_one() const { return index[0] == index[1]; }
    const uint32_t* corners(int side, uint32_t t) const { return &soft[side]->triangle[3 * size_t{t}]; }
    Vec3f place(int side, uint32_t vertex) const {
        return side == 0 ? mesh[0]->x[vertex] : Vec3f(apart + mesh[1]->x[vertex]);
    }
};

// Of one surface the radii of two features that touch count as no more than this part of their shortest edge.
constexpr float kOfEdge = 0.5f;

// Of those that come within their radii [m] and a margin [m] in a time [s], each pair once, where contacts of one of
// their triangles are found anew. Those of flat neighbours do not meet.
void find_near_features(Team& team, const SurfaceSides& sides, float both, float margin, float time,
                        SurfaceContacts& out);

}  // namespace taut
