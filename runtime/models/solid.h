// Solids: a mesh of tetrahedra or hexahedra, or samples between vertices without one (meshless.h), and a material ->
// what a soft body of it is made of, with its boundary.
#pragma once

#include <limits>
#include <span>

#include "constraints/material.h"
#include "models/meshless.h"
#include "models/softs.h"

namespace taut {

// In the order of taut_solid_material.
enum class SolidMaterial : uint8_t { neo_hookean, st_venant_kirchhoff, corotated, fixed_corotated, orthotropic };

struct Solid {
    SolidMaterial material = SolidMaterial::neo_hookean;
    Isotropic elastic{};
    OrthotropicSolid axial{};                                       // of an orthotropic one
    double density = 0;                                             // [kg/m^3]
    double damping = 0;                                             // time d of the stress D (E + d dE/dt) [s]
    double rayleigh = 0;                                            // of stiffness [s]
    double yield_stress = std::numeric_limits<double>::infinity();  // in simple tension [Pa]; infinite: it never flows
    double hardening = 0;                                           // stress over plastic strain in that [Pa]
    Plasticity law{};  // but for yield and hardening, which follow from these
};

// A host's mesh, checked; without a mesh at least 8 vertices.
struct SolidMesh {
    std::span<const Vec3> position;   // of vertices [m]
    std::span<const Vec3> rest;       // their rest shape [m]
    std::span<const uint32_t> cell;   // [corners] vertices
    uint32_t corners = 4;             // 4: tetrahedra, 8: hexahedra, as shape_functions.h orders them; 0: meshless
    std::span<const Quat> axes = {};  // of the material, to the rest shape: of each cell, of all, or none
    // Without a mesh.
    std::span<const Sample> sample = {};      // none: they are made
    std::span<const uint32_t> triangle = {};  // [3] vertices of the boundary, or none
    double radius = 0;                        // of neighbours [m]; 0: the usual one
};

// Why a mesh is no solid; null: it is one. Where that is a cell's or sample's fault, this is its index.
const char* plan_solid(const SolidMesh& mesh, const Solid& solid, JointSolve solve, SoftPlan& plan, uint32_t& cell);

// Triangles of the boundary, outward, of faces that one cell alone has.
void find_boundary(std::span<const uint32_t> cells, uint32_t corners, Array<uint32_t>& out);

}  // namespace taut
