// Soft bodies: a host's mesh of vertices -> particles, each with a sphere, and sets of elements.
//
// cloth.h and solid.h plan what a soft body is made of; here it is made, pinned and removed, whatever that is.
#pragma once

#include <span>

#include "world.h"

namespace taut {

// Elements that one set is to have.
struct ElementPlan {
    ElementPlan(Memory& memory, const ElementType& of, SoftPart does)
        : type(&of), part(does), vertex(memory), data(memory), softness(memory), corner(memory) {}

    void add(std::span<const uint32_t> vertices, std::span<const double> numbers, double soft,
             std::span<const uint32_t> corners = {}) {
        corner.insert(corner.end(), corners.begin(), corners.end());
        vertex.insert(vertex.end(), vertices.begin(), vertices.end());
        data.insert(data.end(), numbers.begin(), numbers.end());
        softness.push_back(soft);
    }

    const ElementType* type;
    SoftPart part;
    ElementForm form = ElementForm::rows;
    JointSolve solve = JointSolve::direct;
    uint8_t stage = 0;      // of its fused sweep, where it is swept
    double tolerance = 0;   // likewise
    bool resolved = false;  // likewise: its substeps are short against its stiffness, where they may be
    bool pulls = false;
    double compliance[kMaxRows * kMaxRows] = {};  // [rows][rows] of a unit of the material [m/N per unit]
    double relaxation = 0;                        // [s]
    double rayleigh = 0;                          // beside it, of stiffness [s]
    Array<uint32_t> vertex;                       // [elements][nodes]
    Array<double> data;                           // [elements][numbers]
    Array<double> softness;                       // [elements]
    Array<uint32_t> corner;                       // [elements][nodes], as of Soft; of a cloth
};

struct SoftPlan {
    explicit SoftPlan(Memory& memory) : soft(memory), position(memory), element(memory), traits{} {}

    Soft soft;             // node, sets, shape and corner are ignored
    Array<Vec3> position;  // of each vertex [m]
    Array<ElementPlan> element;
    double radius = 0;      // of the sphere about each vertex [m]; 0: it touches nothing
    ColliderTraits traits;  // of these
};

// Of an element's rows: by how much they would yield to what they carry within a substep of one second, J W J^T lambda,
// and the square of how fast they swing, J W J^T D [1/s^2]; of each the most.
struct Swing {
    double yield = 0, rate = 0;
};
Swing swing_of(const ConstraintType& row, const double* stiffness, const double* data, double softness, const Pose* x,
               const double* inverse_mass);

// At rest. Throws std::bad_alloc with nothing changed.
uint32_t add_soft(World& world, const SoftPlan& plan);
// With every joint and attachment on it. Throws std::bad_alloc with nothing changed.
void remove_soft(World& world, uint32_t index);

// A pinned vertex is a kinematic node: it moves as the host says, and tethers lead to it. Throws std::bad_alloc with
// nothing changed.
void pin_vertex(World& world, const Soft& soft, uint32_t vertex, bool pinned);
bool is_pinned(const World& world, const Soft& soft, uint32_t vertex);

}  // namespace taut
