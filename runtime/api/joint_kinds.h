// The kinds of joints: which constraint type each is and which of its rows are the host's axes. A new kind is its
// constraint type, a line in joint_kinds.cpp, a def in joint.h and a line in joint_add.cpp.
#pragma once

#include <taut/joint.h>

#include <span>

#include "state/joints.h"

namespace taut {

struct JointAxis {
    int row = 0;
    bool swing = false;  // a coordinate that is never negative: has an upper stop alone
    int around = -1;     // of a swing: the row of its direction, which its friction and damping hold too
};

struct JointKind {
    taut_joint_kind kind;
    const ConstraintType* type;
    bool framed;  // it sits on frames, not on points, and no end is a particle
    // Ends on a third node; data are GearData or begin with HousedAnchors. Else they are JointFrames, or begin with
    // JointAnchors.
    bool housed;
    std::span<const JointAxis> axes;
};

// Whether some row is an angle, which compliance, damping and break_torque of angles are about, and whether some is
// not.
inline bool holds_angles(const JointKind& kind) { return kind.type->angular != 0; }
inline bool holds_points(const JointKind& kind) { return kind.type->angular != (1 << kind.type->rows) - 1; }

const JointKind& joint_kind(taut_joint_kind kind);
const JointKind& kind_of(const Joint& joint);

}  // namespace taut
