// Spinning bodies of every shape shot at thin walls and at rough ground, and a count of those that came through.
#pragma once

#include "physics/surface_lab.h"
#include "scenes/random.h"

namespace soak {

// plate: 2 cm; sheet: 2 mm; the others are rough ground with ridges, peaks and pits, seen from above only.
enum class Target { plate, sheet, mesh, height_field };

struct ShotPlan {
    Target target;
    double slowest, fastest;  // [m/s]
    double spin = 200;        // up to [rad/s]
};

// Balls, boxes, thin rods, capsules, cylinders, discs, cones, tapered capsules, lopsided hulls; 3 to 30 cm.
class ShootingRange {
public:
    static constexpr int kKinds = 9;
    static const char* name(int kind);

    ShootingRange(const ShotPlan& plan, uint64_t seed);

    // Fires a body of a kind and steps until it has come to rest or is long gone. Whether its centre of mass came to
    // the far side, by more than the wall is thick.
    bool comes_through(int kind);
    // Throws a trunk with a head and four limbs of two pieces, all turning together; how many of the ten stay on the
    // far side, where they did not get around the rim.
    int limbs_through(taut_joint_solve solve);

private:
    taut_shape shape(int kind);
    lab::Vec velocity();
    std::vector<taut_body> ragdoll(const lab::Vec& at, const lab::Quat& turned, taut_joint_solve solve);
    void tie(taut_body a, taut_body b, const lab::Vec& pivot, taut_joint_solve solve);
    lab::Vec aim();                         // on the target
    lab::Vec centre(taut_body body) const;  // of mass
    bool over_target(const lab::Vec& p) const;
    bool beyond(taut_body body) const;

    ShotPlan plan_;
    scenes::Random random_;
    lab::World world_;
    std::vector<double> heights_;
    taut_shape trunk_{}, head_{}, limb_{};
    double speed_ = 0, reach_ = 0;
};

}  // namespace soak
