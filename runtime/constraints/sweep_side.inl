// One side of a lane group; for the sweeps that are templates over the lanes (simd/lanes.h).
#pragma once

#include "constraints/contact_lanes.h"
#include "simd/lanes.h"
#include "simd/vec3_lanes.h"

namespace taut {

inline void prefetch_to_write(const void* at) {
#if defined(__x86_64__) || defined(__i386__)
    asm volatile("prefetchw %0" : : "m"(*static_cast<const char*>(at)));  // older processors take it for a nop
#else
    __builtin_prefetch(at, 1);
#endif
}

// Velocities and inverse masses of kLanes nodes.
template <class F>
struct SweepSide {
    using V = Vec3Lanes<F>;

    F velocity[8];  // v xyz, inverse mass along y, w xyz, inverse mass along z
    F inv_mass, xx, yy, zz, xy, xz, yz, inv_mass_x;

    void gather(const uint32_t node[kLanes], const SweepNode* nodes) {
        const float* row[kLanes];
        F mass[8];
        for (int i = 0; i < kLanes; ++i) row[i] = &nodes[node[i]].mass.inv_mass;
        F::transpose(row, mass);
        inv_mass = mass[0];
        xx = mass[1], yy = mass[2], zz = mass[3], xy = mass[4], xz = mass[5], yz = mass[6], inv_mass_x = mass[7];
        for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
        F::transpose(row, velocity);
    }
    // Asks for what gather() will read and scatter() write soon: another core may have changed it last. Whether a node
    // moves its seat tells (0, the world, wraps round); a look at its mass would wait for the line, and fetch it twice.
    static void prefetch(const uint32_t node[kLanes], const SweepNode* nodes, const SweepShift* shifts,
                         uint32_t movers) {
        for (int i = 0; i < kLanes; ++i)
            if (node[i] - 1 < movers) prefetch_to_write(&nodes[node[i]]);
        for (int i = 0; shifts && i < kLanes; ++i) __builtin_prefetch(&shifts[node[i]]);
    }
    // What no impulse moves is not written: groups on other threads read it.
    void scatter(const uint32_t node[kLanes], SweepNode* nodes) const {
        alignas(32) float nowhere[8];
        float* row[kLanes];
        for (int i = 0; i < kLanes; ++i) row[i] = nodes[node[i]].velocity.v;
        const unsigned still = ~F::greater(inv_mass, F::all(0)) & kAllLanes;
        for (unsigned left = still; left != 0; left &= left - 1) row[__builtin_ctz(left)] = nowhere;
        F::transpose_back(velocity, row);
    }
    // 1 where an axis is locked, else 0. Bodies that do not turn at all have no moment that could be tilted.
    F held() const {
        const F zero = F::all(0), one = F::all(1);
        const F moves = least(inv_mass_x, velocity[3], velocity[7]), turns = least(xx, yy, zz);
        const F turns_less = F::if_greater(turns, zero, zero, F::if_greater(most_turn(), zero, one, zero));
        return F::if_greater(inv_mass, moves, one, turns_less);
    }
    F most_turn() const { return F::max(F::max(xx, yy), zz); }
    // p M^-1 q where an axis may be locked.
    F moved(const V& p, const V& q) const {
        return inv_mass_x * (p.x * q.x) + velocity[3] * (p.y * q.y) + velocity[7] * (p.z * q.z);
    }
    V turn(const V& l) const {  // I^-1 l
        return {xx * l.x + xy * l.y + xz * l.z, xy * l.x + yy * l.y + yz * l.z, xz * l.x + yz * l.y + zz * l.z};
    }
    V move() const { return {velocity[0], velocity[1], velocity[2]}; }
    V spin() const { return {velocity[4], velocity[5], velocity[6]}; }
    V at(const V& r) const { return move() + cross(spin(), r); }  // v + w x r
    void add_move(const V& p) {
        velocity[0] = velocity[0] + inv_mass_x * p.x;
        velocity[1] = velocity[1] + velocity[3] * p.y;
        velocity[2] = velocity[2] + velocity[7] * p.z;
    }
    void add_spin(const V& l) {
        const V change = turn(l);
        velocity[4] = velocity[4] + change.x;
        velocity[5] = velocity[5] + change.y;
        velocity[6] = velocity[6] + change.z;
    }
    void subtract_spin(const V& l) {
        const V change = turn(l);
        velocity[4] = velocity[4] - change.x;
        velocity[5] = velocity[5] - change.y;
        velocity[6] = velocity[6] - change.z;
    }
    void add(const V& p, const V& r) {  // an impulse at r
        add_move(p);
        add_spin(cross(r, p));
    }
    void subtract(const V& p, const V& r) {
        velocity[0] = velocity[0] - inv_mass_x * p.x;
        velocity[1] = velocity[1] - velocity[3] * p.y;
        velocity[2] = velocity[2] - velocity[7] * p.z;
        subtract_spin(cross(r, p));
    }

private:
    static F least(const F& a, const F& b, const F& c) {
        const F zero = F::all(0);
        return zero - F::max(F::max(zero - a, zero - b), zero - c);
    }
};

// Of a 2x2 block k, of which locks may leave one direction alone: there the pseudoinverse, k over the square of its
// larger eigenvalue, and nothing where that is below `least`. held: lanes that this is about.
template <class F>
void invert_held(const F& held, const F (&k)[3], const F& largest, const F& least, F (&inverse)[3], F& isotropic) {
    const F zero = F::all(0), one = F::all(1), any = F::if_greater(largest, least, held, zero);
    const F scale = F::if_greater(any, zero, one / F::if_greater(any, zero, largest, one), zero);
    const F flat = k[0] * k[1] - k[2] * k[2], rounding = F::all(kLeastFree) * (largest * largest);
    const F chosen = F::if_greater(any, zero, F::if_greater(flat, rounding, zero, one), held);
    for (int i = 0; i < 3; ++i) inverse[i] = F::if_greater(chosen, zero, scale * (scale * k[i]), inverse[i]);
    isotropic = F::if_greater(held, zero, scale, isotropic);
}

}  // namespace taut
