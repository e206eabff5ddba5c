// Element sets: the elements of one type and material that something of the host's is made of (a cable, a cloth, a
// solid), as columns. What an element costs is its columns alone, and what goes through joints does not meet it. The
// owner names elements by their index, and moves them where it puts some in or takes some out.
//
// An element gives way as C lambda' = -error, with C = softness * the set's compliance (eq. 21 of Tournier et al.
// 2015): the compliance is that of a unit of the material, softness is how many of them lie in a row (metres of a
// cable) or one over how many lie side by side (square metres of cloth). Those of a set that pulls do so while C > 0
// alone, lambda <= 0: as rows they are a stop at 0 (constraints/axis.h).
#pragma once

#include <span>

#include "base/id_pool.h"
#include "constraints/element.h"
#include "state/joints.h"

namespace taut {

// How a direct solve takes the elements of a set.
enum class ElementForm : uint8_t {
    rows,    // with multipliers: any compliance, 0 included
    folded,  // the same system without the multipliers, J^T J / c within the nodes' blocks: elastic ones alone
    energy,  // a step of Newton's method on W = 1/2 C^T D C within the nodes' blocks: lambda is -D C, and not kept
};

constexpr uint32_t kMostStages = 16;

struct ElementSet {
    explicit ElementSet(Memory& m)
        : node(m), data(m), softness(m), lambda(m), drift(m), slow_turn(m), loaded(m), need(m), fresh(m), memory(m) {}

    const ElementType* type = nullptr;  // null: dead slot
    ElementForm form = ElementForm::rows;
    JointSolve solve = JointSolve::direct;
    // Swept at the positions that the sweep moves them to, by the type's fused sweep in lanes (element_lanes.h), in the
    // order of stages; else, and by solvers without lanes, as linearised rows.
    bool fused = false;
    uint8_t stage = 0;     // below kMostStages
    double tolerance = 0;  // of a fused sweep's yield, a strain, for which its islands take substeps; 0: the world's
    double yield = 0;      // of substeps of one second, as it was of late: that of substeps h is h^2 of it [1/s^2]
    double least_yield = 0, most_yield = 0;  // that it may fall and, in this frame, grow to
    bool collide_connected = false;
    bool pulls = false;                           // of one row; said before its compliance and elements
    bool coupled = false;                         // the compliance is no multiple of 1
    double compliance[kMaxRows * kMaxRows] = {};  // [rows][rows], symmetric, positive definite or 0: rigid
    double stiffness[kMaxRows * kMaxRows] = {};   // its inverse; 0 where it is rigid
    double relaxation = 0;                        // damping over stiffness: time d of scheme.h [s]
    double rayleigh = 0;                          // the part of that which also damps what K resists [s]
    Axis stop;                                    // of a set that pulls, for a softness of 1
    uint64_t serial = 0;                          // tells sets of one slot apart
    uint64_t version = 0;                         // grows with each change of which elements there are, and on what

    // by element; dead ones have kNone for all of their nodes
    Array<uint32_t> node;      // [nodes]
    Array<double> data;        // [numbers]
    Array<double> softness;    // [1]
    Array<double> lambda;      // [rows], force of the last substep [N, N m]
    Array<double> drift;       // [rows], of C since the last step, by a change of length; see Joint
    Array<Vec3> slow_turn;     // low-passed angular velocity of the line [rad/s]; of types with one, else empty
    Array<uint8_t> loaded;     // frames under or since a load beyond what contacts in sweeps hold; partition.h
    Array<float> need;         // of a direct solve [s]; partition/needs.h
    Array<uint8_t> fresh;      // not solved yet: lambda means nothing
    Array<AxisMemory> memory;  // of a set that pulls, else empty

    uint32_t size() const { return static_cast<uint32_t>(softness.size()); }
    std::span<const uint32_t> nodes_of(uint32_t element) const {
        const auto count = static_cast<uint32_t>(type->row.nodes);
        return {&node[size_t{element} * count], count};
    }
    bool lives(uint32_t element) const {
        return node[size_t{element} * static_cast<uint32_t>(type->row.nodes)] != kNone;
    }
    double* data_of(uint32_t element) { return data.data() + size_t{element} * static_cast<uint32_t>(type->numbers); }
    const double* data_of(uint32_t element) const { return const_cast<ElementSet*>(this)->data_of(element); }
    double* lambda_of(uint32_t element) { return &lambda[size_t{element} * static_cast<uint32_t>(type->row.rows)]; }
    const double* lambda_of(uint32_t element) const { return const_cast<ElementSet*>(this)->lambda_of(element); }
    double* drift_of(uint32_t element) { return &drift[size_t{element} * static_cast<uint32_t>(type->row.rows)]; }
    const double* drift_of(uint32_t element) const { return const_cast<ElementSet*>(this)->drift_of(element); }
};
template <class Visitor, Like<ElementSet> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [type, form, solve, fused, stage, tolerance, yield, least_yield, most_yield, collide_connected, pulls,
           coupled, compliance, stiffness, relaxation, rayleigh, stop, serial, version, node, data, softness, lambda,
           drift, slow_turn, loaded, need, fresh, memory] = of;
    TAUT_FIELDS(visitor, type, form, solve, fused, stage, tolerance, yield, least_yield, most_yield, collide_connected,
                pulls, coupled, compliance, stiffness, relaxation, rayleigh, stop, node, data, softness, lambda, drift,
                slow_turn, loaded, need, fresh, memory);
    TAUT_ASIDE(visitor, serial, version);
}

// [rows][rows] of a unit of the material [m/N per unit], with its damping over its stiffness [s].
void set_compliance(ElementSet& set, std::span<const double> compliance, double relaxation);
// The same for each row and no coupling.
void set_compliance(ElementSet& set, double compliance, double relaxation);

// Room for more elements, so that insert() cannot throw.
void reserve_elements(ElementSet& set, uint32_t more);

struct ElementRef {
    uint32_t set, element;
};

struct Elements {
    explicit Elements(Memory& memory) : ids(memory), set(memory) {}

    // An empty set. Throws std::bad_alloc with nothing changed.
    uint32_t add(const ElementType& type);
    void remove(uint32_t index);

    // A new element before another one, or after the last; with lambda 0. Room is reserved.
    void insert(ElementSet& of, uint32_t at, std::span<const uint32_t> nodes, double softness);
    void erase(ElementSet& of, uint32_t element);
    void tie(ElementSet& of, uint32_t element, std::span<const uint32_t> nodes);
    // It is there, and does nothing.
    void kill(ElementSet& of, uint32_t element);

    uint32_t count() const;  // of all live elements

    IdPool ids;
    Array<ElementSet> set;
    uint64_t version = 1;  // grows whenever the graph of elements changes

private:
    void note(ElementSet& of) { of.version = ++version; }
};
template <class Visitor, Like<Elements> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [ids, set, version] = of;
    TAUT_ASIDE(visitor, ids, version);
    TAUT_ROWS(visitor, ids, set);
}

// Once a frame of so long [s], after the choice of substeps, of which the world takes so many at least. Yields go
// slowly, as what was taut may soon be so again. They also grow slowly: shorter substeps are as a stiffer material, and
// what is stretched would gain energy.
void age_yields(Elements& elements, double time, uint32_t substeps);

// act(set, element, nodes) for each live element.
template <class Of, class Act>
void for_each_element(Of& elements, Act&& act) {
    for (auto& set : elements.set)
        for (uint32_t e = 0; set.type && e < set.size(); ++e)
            if (set.lives(e)) act(set, e, set.nodes_of(e));
}

// act(nodes) for all that ties nodes together: joints, then elements. A null end of a joint is kNone.
template <class Act>
void for_each_tie(const Joints& joints, const Elements& elements, Act&& act) {
    for (const Joint& joint : joints.record)
        if (joint.works()) act(joint.nodes());
    for_each_element(elements, [&](const ElementSet&, uint32_t, std::span<const uint32_t> nodes) { act(nodes); });
}

}  // namespace taut
