// A joint type between frames from one description of its rows, which says through each writer what C, J and K are:
//
//   struct Hinge {
//       template <class Writer, class Frames>
//       static void rows(Writer& out, const Frames& f);
//   };
#pragma once

#include "constraints/frame_lanes.h"
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {

template <class Type, int kRows>
void evaluate_frames(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter out(f, kRows, error, jacobian);
    Type::rows(out, f);
}

template <class Type, int kRows>
void evaluate_frame_lanes(const LaneFrames& frames, const float* const (&pose)[2][kLanes], LaneScalar* error,
                          LaneScalar* jacobian) {
    const FramePairLanes<BaseLanes> f(frames, pose);
    LaneRowWriter<BaseLanes> out(f, kRows, error, jacobian);
    Type::rows(out, f);
}

template <class Type>
void stiffness_of_frames(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(f, lambda, k, part);
    Type::rows(out, f);
    out.finish();
}

// Rows from 3 on are angles.
template <class Type, int kRows>
constexpr ConstraintType frame_joint(const char* name, void (*sample)(uint64_t seed, void* data, Pose* x),
                                     uint8_t unswept = 0) {
    constexpr uint8_t kAngles = (1 << kRows) - (1 << 3);
    return {name,
            kRows,
            2,
            sizeof(JointFrames),
            Bound::free,
            true,
            kAngles,
            evaluate_frames<Type, kRows>,
            stiffness_of_frames<Type>,
            nullptr,
            sample,
            nullptr,
            evaluate_frame_lanes<Type, kRows>,
            unswept};
}

}  // namespace taut
