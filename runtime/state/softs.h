// Soft bodies: which nodes and element sets a host's cloth or solid is made of, and its surface.
#pragma once

#include "constraints/plasticity.h"
#include "state/colliders.h"
#include "state/elements.h"
#include "state/surface_mesh.h"

namespace taut {

enum class SoftKind : uint8_t { cloth, solid };

// What the elements of a set do, for what reads them.
enum class SoftPart : uint8_t {
    stretch,  // along links, or within triangles or cells, in the order in which the host gave these
    shear,
    bend,
    bound,   // what a part of a thread never exceeds
    limit,   // of a cloth: along its edges, beyond the strain that it bears
    tether,  // of a cloth: from vertices to pinned ones
    drag,    // of the air, at each vertex of the surface
};

struct SoftSet {
    uint32_t set = kNone;
    SoftPart part = SoftPart::stretch;
};
template <class Visitor, Like<SoftSet> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [set, part] = of;
    TAUT_FIELDS(visitor, set, part);
}

// What air does to the triangles of a surface.
struct AirLoad {
    double drag = 0, lift = 0;  // coefficients; lift is at most drag
    int8_t side = 0;            // 0: air meets both sides of a triangle; 1: the one its normal points to; -1: the other
    double pressure = 0;        // within over that of the world's air, where it stays as it is [Pa]
    double gas = 0;             // else p V of what is within [J]; 0: there is none

    bool encloses() const { return pressure != 0 || gas > 0; }
    bool any() const { return drag > 0 || encloses(); }
};
template <class Visitor, Like<AirLoad> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [drag, lift, side, pressure, gas] = of;
    TAUT_FIELDS(visitor, drag, lift, side, pressure, gas);
}

template <class Visitor, Like<Plasticity> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [yield, creep, limit, hardening] = of;
    TAUT_FIELDS(visitor, yield, creep, limit, hardening);
}

struct Soft {
    explicit Soft(Memory& memory)
        : node(memory),
          mass(memory),
          triangle(memory),
          rest(memory),
          sets(memory),
          surface(memory),
          fan_begin(memory),
          fan(memory),
          plastic(memory),
          flowed(memory),
          flows(memory),
          corner(memory) {}

    SoftKind kind = SoftKind::cloth;
    Array<uint32_t> node;      // of each vertex
    Array<double> mass;        // of each vertex, pinned ones too [kg]
    Array<uint32_t> triangle;  // [3], vertices: the cloth, or the boundary of the solid, outward
    Array<double> rest;        // of each triangle of a cloth, [3][2]: dN/dX of its corners [1/m]; F = sum x_n rest_n^T
    Array<SoftSet> sets;
    uint32_t cell_points = 1;  // of a solid: elements of its set of stretch for each cell
    uint32_t shape = kNone;    // of each vertex; kNone: it touches nothing
    double gravity_scale = 1;
    double mass_damping = 0;  // share of a vertex's momentum that goes in a second [1/s]
    AirLoad air;
    // Where air may act: vertices on triangles, ascending, and of each of them its triangles.
    Array<uint32_t> surface, fan_begin, fan;
    Plasticity law{};       // of a solid that yields
    Array<double> plastic;  // of each element of stretch its set F_p, [3][3]; empty: it does not yield
    Array<double> flowed;   // of each, or empty likewise: strain that has flowed, in all [1]
    Array<uint8_t> flows;   // of each, or empty likewise: whether it flowed and was not unloaded since
    bool self = false;      // touches itself
    uint64_t user_data = 0;
    uint64_t mesh_version = 0;  // changes with its triangles, and is no other's in this world
    // Of a cloth.
    uint32_t tethers = 0;     // of each vertex, to so many pinned ones; models/tethers.h
    double tether_slack = 0;  // over their length along the cloth
    double tear_strain = 0;   // edges with more open; 0: none
    Array<uint32_t> corner;  // of one that tears: of its elements, set by set but for tethers, what each of their nodes
                             // is: corner k of triangle t as 3 t + k

    uint32_t vertices() const { return static_cast<uint32_t>(node.size()); }
    uint32_t triangles() const { return static_cast<uint32_t>(triangle.size() / 3); }
};
template <class Visitor, Like<Soft> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [kind, node, mass, triangle, rest, sets, cell_points, shape, gravity_scale, mass_damping, air, surface,
           fan_begin, fan, law, plastic, flowed, flows, self, user_data, mesh_version, tethers, tether_slack,
           tear_strain, corner] = of;
    TAUT_FIELDS(visitor, kind, node, mass, triangle, rest, sets, cell_points, shape, gravity_scale, mass_damping, air,
                surface, fan_begin, fan, law, plastic, flowed, flows, self, tethers, tether_slack, tear_strain, corner);
    TAUT_ASIDE(visitor, user_data, mesh_version);
}

struct Softs {
    explicit Softs(Memory& memory)
        : ids(memory), record(memory), loaded(memory), area(memory), mesh(memory), listed(memory) {}

    // Throws std::bad_alloc with nothing changed.
    uint32_t add(Soft&& soft) {
        ids.reserve_one();
        if (record.capacity() == record.size()) record.reserve(2 * record.size() + 4);
        const uint32_t index = ids.create();
        if (index == record.size())
            record.push_back(std::move(soft));
        else
            record[index] = std::move(soft);
        record[index].mesh_version = ++version;
        return index;
    }
    void remove(uint32_t index) {
        record[index] = Soft(*record[index].node.get_allocator().memory);
        ids.destroy(index);
    }

    IdPool ids;
    Array<Soft> record;

    // Scratch of the group being solved: those that air or damping of masses acts on, and areas of the triangles of
    // one, [m^2] along their normals.
    Array<uint32_t> loaded;
    Array<Vec3> area;

    uint64_t version = 0;  // the last that a mesh got
    // Scratch of find_surface_contacts(): by slot, and those that have something to touch, ascending.
    Array<SurfaceMesh> mesh;
    Array<uint32_t> listed;
};
template <class Visitor, Like<Softs> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, record, loaded, area, version, mesh, listed] = of;  // loaded and area: within a substep; mesh: derived
    TAUT_ASIDE(visitor, ids, version);
    TAUT_ROWS(visitor, ids, record);
}

// The collider that events name for all of a soft body: that of its first vertex with one; kNone: it touches nothing.
inline uint32_t collider_of(const Nodes& nodes, const Soft& soft) {
    for (const uint32_t node : soft.node)
        if (nodes.info[node].collider != kNone) return nodes.info[node].collider;
    return kNone;
}
// A collider, or that of all of the soft body that it is on.
inline uint32_t told_collider(const Nodes& nodes, const Softs& softs, const Colliders& colliders, uint32_t collider) {
    const uint32_t soft = nodes.info[colliders.record[collider].node].soft;
    return soft == kNone ? collider : collider_of(nodes, softs.record[soft]);
}

// Whether it is a vertex of a soft body with a surface, whose contacts with other such are in SurfaceContacts.
inline bool is_surface_vertex(const Nodes& nodes, const Softs& softs, uint32_t node) {
    const uint32_t soft = nodes.info[node].soft;
    return soft != kNone && !softs.record[soft].triangle.empty();
}

}  // namespace taut
