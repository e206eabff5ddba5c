// Cloths: a triangle mesh and a fabric -> what a soft body of it is made of.
//
// Of links: springs along the edges, as warp, weft or shear by their direction, and across the edges between the two
// vertices on either side. Of triangles: a sheet of St-Venant-Kirchhoff material under plane stress (Green strain),
// bent by the angle between its triangles, or by the quadratic form where it is flat at rest; or under plane strain; or
// of quadrilaterals, which are two triangles each for all but the sheet. Of all, where they are asked for: links along
// the edges that only pull, beyond a strain; tethers (tethers.h).
#pragma once

#include <span>

#include "models/softs.h"
#include "state/mesh_edges.h"

namespace taut {

enum class ClothKind : uint8_t { triangles, links, quads };
enum class SheetStrain : uint8_t { green, corotated };

struct Fabric {
    double area_density = 0;                // [kg/m^2]
    double thickness = 0;                   // [m]
    double stretch_stiffness[2] = {0, 0};   // along warp and weft, of triangles [N/m]
    double shear_stiffness = 0;             // [N/m]
    double poisson = 0;                     // contraction along weft over stretch along warp
    double bending_stiffness = 0;           // [N m]; 0: limp
    double stretch_compliance[2] = {0, 0};  // of each link along warp and weft [m/N]; 0: rigid
    double shear_compliance = 0;            // infinite: no such links
    double bend_compliance = 0;             // likewise
    double tolerance = 0;                   // of the stretch that sweeps leave
    double shortest_substep = 0;            // that they may take for it [s]
    double damping = 0;                     // time d of the stress D (E + d dE/dt) [s]
    double rayleigh = 0;                    // of stiffness [s]
    SheetStrain strain = SheetStrain::green;
    bool plane_strain = false;
    double compression = 1;       // stiffness of pressed links over that of pulled ones
    double strain_limit = 0;      // of edges; infinite: none
    double limit_compliance = 0;  // beyond that, and of tethers [m/N]
    uint32_t tethers = 0;         // of each vertex
    double tether_slack = 0;      // over their length
    double tear_strain = 0;       // 0: it does not tear
};

// A host's mesh, checked: each vertex is on a triangle.
struct ClothMesh {
    std::span<const Vec3> position;  // of vertices [m]
    std::span<const Vec3> rest;      // their rest shape [m]
    std::span<const uint32_t>
        triangle;               // [3] vertices; of quadrilaterals two each, (0, 1, 2) and (0, 2, 3) of its corners
    std::span<const float> uv;  // [2] of each vertex: u grows along the warp; empty: along the first edge
};

// Why a mesh is no cloth; null: it is one.
const char* plan_cloth(const ClothMesh& mesh, ClothKind kind, const Fabric& fabric, JointSolve solve, SoftPlan& plan);

}  // namespace taut
