// A scalar row of a block whose impulse has bounds: a contact's normal or tangents, a stop, a drive, friction.
//   s J v + c mu = goal,  c > 0
// Because of c it is folded into the nodes, A += J^T J / c, so that a round of the active set changes no pattern.
#pragma once

#include <cstdint>

#include "constraints/constraint.h"
#include "constraints/contact.h"

namespace taut {

struct BoundedRow {
    enum class Kind : uint8_t {
        push,     // mu >= 0, on only while it pushes
        tangent,  // of friction: those after a lead share a bound, |mu| within limit * the impulses of its loads
        box,      // |mu| <= limit, known where it is at its limit
    };

    Kind kind = Kind::push;
    bool on = false;           // part of the system
    bool speculative = false;  // of a gap that may close: goal is to touch, not to rest
    bool physical = false;     // c and target are meant as they are
    int8_t at_limit = 0;       // of a box: -1, 1: mu is that limit; 0: the row holds
    uint8_t row = 0;           // within its row block
    uint32_t block = 0;        // in Rows::block
    uint8_t nodes = 0;
    uint8_t begin = 0;                 // 3 where its Jacobian has angular entries alone
    uint32_t place[kMaxNodes] = {};    // of each node in the block, or UINT32_MAX: its velocity is known
    const double* jacobian = nullptr;  // of the first node; 6 entries, those of the next node `stride` further
    uint32_t stride = 0;
    double known = 0;           // s J v of the nodes whose velocity is known [m/s]
    double sign = 1;            // of J
    double gap = 0;             // of a push [m or rad]
    double bounce = 0;          // of a push: speed at which it leaves once it was hit, 0: none [m/s]
    double k = 0;               // J W J^T [1/kg]
    double least = 0;           // c while the row holds
    double c = 0;               // c now
    double target = 0;          // with the push that undoes an overlap [m/s]
    double relaxed_target = 0;  // without
    double goal = 0;            // of this solve
    double limit = 0;           // of a box [N s]; of tangents the coefficient of friction, or an arm [m]
    double mu = 0;              // [N s]
    double solved = 0;          // s J v of the last round's solution
    double rate = 0;            // s J v of the iterate, see ActiveSet::advance
    double held = 0;            // mu that balances the iterate
    double short_rate = 0;      // of the iterate against the last solution, once the rounds are over
    double short_mu = 0;        // likewise
    uint32_t width = 0;         // of a lead, the first tangent of a friction: how many tangents it has; else 0
    uint32_t load = 0;          // of a lead: the first of the pushes that bound it, in the rows of the block,
    uint32_t loads = 0;         // and how many there are, kContactRows apart
    float* slip = nullptr;      // of tangents, carried: c of a sliding contact; 0: it sticks; -1: new
    float* force = nullptr;     // carried, of axis rows [N]
};

}  // namespace taut
