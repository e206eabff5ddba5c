// Impacts of a substep, as restitution finds and solves them (solvers/restitution.h).
#pragma once

#include "system/operators.h"

namespace taut {

struct ImpactBody {
    uint32_t at;       // seat
    uint32_t cluster;  // of bodies whose impacts are solved at once: the first of them, by index
    double moves;      // 1: its path may begin elsewhere; 0: joints hold it
    double time;       // before its first impact of the round [s]
    Velocity before;   // the round, at the end of the substep
    Velocity u;        // likewise, now
    Vec3 moved;        // where its path begins, in this round [m]
};

struct Impact {  // rows: normal, tangent 1, tangent 2
    struct Side {
        uint32_t at;                 // seat
        uint32_t body;               // kNone: it does not yield
        Vec3 linear[3], angular[3];  // J
        Velocity response[3];        // W J^T

        double rate(int row, const Velocity& u) const { return along(linear[row], angular[row], u); }  // J u
    };

    uint32_t pair;  // index into Pairs::list; of surfaces kNone
    int point;      // of it; of surfaces the index into SurfaceContacts::contact
    bool supports;  // without restitution
    float* peak;    // of a point in lanes: its largest normal impulse; else null
    bool* pushed;   // of a row: its pair's; else null
    Side side[kMaxEnds];
    int sides;
    double gap;  // at the start of the substep [m]
    double restitution, friction;
    double drive[2];        // what friction drives the tangents to [m/s]
    uint32_t cluster;       // of its bodies
    double time;            // before it [s]
    double known[3];        // of the rates at that time: what impulses do not change [m/s]
    double approach;        // of the normal, negative [m/s]
    double stopped, spent;  // likewise and the impulse, once compression is over
    double k, k_across;     // J W J^T of the normal, the larger eigenvalue of the tangents' [1/kg]
    double impulse[3];      // [N s]
};

struct Impacts {
    struct Struck {  // a node whose path impacts moved
        uint32_t node;
        float dx[3];  // of its shift before [m]
    };
    struct Strike {     // an impact
        uint32_t pair;  // index into Pairs::list; of surfaces kNone
        int point;
        float impulse[3];  // normal, tangent 1, tangent 2 [N s]
    };

    explicit Impacts(Memory& memory)
        : flight(memory),
          struck(memory),
          strikes(memory),
          impact(memory),
          body(memory),
          body_of(memory),
          held(memory),
          found(memory),
          joined(memory),
          joined_rows(memory),
          joined_surfaces(memory) {}

    // of the last substep of a group
    Array<SweepFlight> flight;  // by seat; where something may bounce
    Array<Struck> struck;
    Array<Strike> strikes;

    // of a round
    Array<Impact> impact;  // cluster by cluster, in the order of pairs and points
    Array<ImpactBody> body;
    Array<uint32_t> body_of;          // by seat: index into body, or kNone
    Array<uint8_t> held;              // by seat: 1: joints hold it; empty: not looked for yet
    Array<uint16_t> found;            // of four points of each lane group: a bit for each lane with an impact
    Array<uint16_t> joined;           // likewise: that supports one
    Array<uint8_t> joined_rows;       // by row block: 1: it supports one
    Array<uint16_t> joined_surfaces;  // of each of their lane groups a bit for each lane: likewise
};

}  // namespace taut
