// Rows of kBodies nodes for the motion kernels, at rest at the origin.
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/LU>

#include "integrate/gyroscopic.h"
#include "integrate/motion_kernels.h"
#include "simd/width.h"
#include "state/nodes.h"

namespace taut::test {

struct MotionRig {
    MotionRow motion[kBodies] = {};
    MassRow mass[kBodies] = {};
    PoseRow pose[kBodies] = {};
    PairRow velocity[kBodies] = {}, load[kBodies] = {};
    FoundRow found[kBodies] = {};
    FloatRow shift[kBodies] = {}, sweep_pose[kBodies] = {};
    PairRow start[kBodies] = {};
    SweepRow sweep[kBodies] = {};
    Batch batch{{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2, 3}, kBodies};

    MotionRig() {
        for (MotionRow& row : motion) row.q[3] = 1;
        for (FoundRow& row : found) row.q[3] = 1;
    }
    NodeRows rows() { return {motion, load, pose, velocity, start, found, shift, sweep, sweep_pose}; }
    void set_mass(int i, const NodeMass& m) {
        const Sym3& I = m.inertia;
        const Sym3 J = Sym3::of(I.matrix().inverse());
        mass[i] = {m.mass, m.inv_mass,     {I.xx, I.yy, I.zz, I.xy, I.xz, I.yz}, {J.xx, J.yy, J.zz, J.xy, J.xz, J.yz},
                   {},     m.gravity_scale};
    }
    Bodies predict(const MotionKernels& kernels, double h, Bodies turning, Bodies damped = 0,
                   const Vec3& gravity = Vec3::Zero(), double turn = 0.05) {
        return kernels.predict(rows(), batch, Masses(*this).of,
                               {h, {gravity.x(), gravity.y(), gravity.z()}, turn, gyroscopic_euler}, turning, damped);
    }
    Bodies store(const MotionKernels& kernels, const Keeping& terms, Bodies turning, Bodies slow) {
        return kernels.store(rows(), batch, Masses(*this).of, terms, turning, slow, slow);
    }

private:
    struct Masses {
        const MassRow* of[kBodies];
        explicit Masses(const MotionRig& rig) {
            for (int i = 0; i < kBodies; ++i) of[i] = &rig.mass[rig.batch.node[i]];
        }
    };
};

// Those that this machine runs.
inline std::vector<const MotionKernels*> motion_builds() {
    std::vector<const MotionKernels*> builds = {&kMotionKernelsBase};
    if constexpr (kHasAvx)
        if (widest() >= Width::avx2) builds.push_back(&kMotionKernelsAvx2);
    return builds;
}

inline Vec3 vector_of(const double (&v)[3]) { return Vec3(v[0], v[1], v[2]); }
inline Quat quat_of(const double (&q)[4]) { return Quat(q[3], q[0], q[1], q[2]); }
inline void put(const Vec3& from, double (&to)[3]) { std::copy_n(from.data(), 3, to); }
inline void put(const Quat& from, double (&to)[4]) { std::copy_n(from.coeffs().data(), 4, to); }

}  // namespace taut::test
