// Pulley: a rope over two sheaves of a housing, of which b's side runs through `ratio` falls.
//   C = |p_a - s_a| + ratio |p_b - s_b| - length   [m]
// Each side is a distance (distance.cpp); lambda < 0 is tension, that of a's side.
#include "constraints/pulley.h"

#include "constraints/coupled_pair.h"
#include "constraints/distance.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct Pulley {
    using Data = PulleyData;

    static double weight(const Data& data, int side) { return side == 0 ? 1 : data.ratio; }
    static double rest(const Data& data) { return data.length; }
    static DistanceData rope(const Data& data, int side) {
        return {data.anchors.guide(side), data.anchors.of(side), 0};
    }
    static double evaluate(const Data& data, int side, const Pose* x, double* j) {
        const DistanceData distance = rope(data, side);
        double length;
        kDistance.evaluate(&distance, x, &length, j);
        return length;
    }
    static void stiffness(const Data& data, int side, const Pose* x, double lambda, Curvature part, double* k) {
        const DistanceData distance = rope(data, side);
        kDistance.stiffness(&distance, x, &lambda, part, k);
    }
};

void sample_pulley(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& pulley = *static_cast<PulleyData*>(data);
    pulley.anchors = {random.vector(), random.vector(), random.vector(), random.vector()};
    pulley.ratio = random.between(0.3, 3);
    pulley.length = 0.5 + random.unit();
    random.poses(x, 3);
}

}  // namespace

constinit const ConstraintType kPulley = coupled_type<Pulley>("pulley", 0, sample_pulley);

}  // namespace taut
