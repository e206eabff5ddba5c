// The sweep of joints, scalar build.
#include "constraints/joint_sweep.inl"

namespace taut {

const JointKernels kJointKernelsScalar = JointSweep<ScalarLanes>::table("scalar");

}  // namespace taut
