// Figures of limbs: tapered capsules whose smooth union is a closed surface.
#pragma once

#include <span>
#include <vector>

#include "obj_file.h"
#include "scene.h"

namespace scenes {

// Those off the plane x = 0 are mirrored by it [m].
struct FigureLimb {
    taut_pos from, to;
    double from_radius, to_radius;
};

// Cubes that a surface is looked for in [m].
struct LimbLattice {
    taut_pos low;
    double spacing;
    int nodes[3];
};
LimbLattice lattice_about(std::span<const FigureLimb> limbs, double spacing);

// The surface of the union, outward, by marching tetrahedra (Doi and Koide 1991).
Surface surface_of_limbs(std::span<const FigureLimb> limbs, const LimbLattice& lattice);

// Mass, centre and inertia about the centre, along the axes, of what a closed surface holds.
struct MassOfSurface {
    double mass = 0;      // [kg]
    taut_pos centre{};    // [m]
    taut_sym3 inertia{};  // [kg m^2]
};
MassOfSurface mass_within(const Surface& surface, double density);

// Creatures made in code, each standing on y = 0 and looking along z.
std::span<const FigureLimb> armadillo_limbs();  // 1 m tall
std::span<const FigureLimb> bunny_limbs();      // 0.95 m tall
std::span<const FigureLimb> cow_limbs();        // 1.4 m tall, 2 m long
std::span<const FigureLimb> dragon_limbs();     // 1.4 m tall, 2.4 m long

// A rigid body of capsules, drawn as the surface of its limbs; as many as asked for share its shapes.
class RigidFigure {
public:
    // tall: of its surface [m].
    RigidFigure(Scene& scene, std::span<const FigureLimb> limbs, double tall, double density);
    // A body with the middle of its mass there [m].
    Body at(taut_pos position, taut_quat rotation, Look look) const;

private:
    std::vector<Part> parts_;
    int drawn_ = -1;
    double mass_ = 0;
    taut_sym3 inertia_{};
};

}  // namespace scenes
