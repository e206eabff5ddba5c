// Six struts that touch nowhere, held apart by 24 ropes under tension, dropped.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

Scene build_tensegrity(double, double, const Options& options) {
    constexpr double kHalf = 1.0, kMass = 20, kHalfWidth = 0.05, kHeight = 3.4, kShorter = 0.97;
    constexpr double kCompliance = 1.2e-5, kDamping = 300;
    Scene scene = empty_scene();
    add_ground(scene);
    // Two struts along each axis, half their length apart. The whole is turned so that it lands on an edge.
    const taut_quat turned = times(turn({0, 0, 1}, 0.5), turn({1, 0, 0}, 0.35));
    struct End {
        int strut;
        taut_pos point;  // in the frame of the whole
    };
    std::vector<End> ends;
    auto world = [&](taut_pos p) {
        const taut_pos q = rotated(turned, p);
        return plus(q, 0, kHeight, 0);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (double off : {-kHalf / 2, kHalf / 2}) {
            auto point = [&](double along) {
                double c[3] = {0, 0, 0};
                c[axis] = along;
                c[(axis + 1) % 3] = off;
                return taut_pos{c[0], c[1], c[2]};
            };
            const int strut = add_beam(scene, world(point(-kHalf)), world(point(kHalf)), kHalfWidth, kMass, Look::wood);
            scene.roles.pile.push_back(strut);
            ends.push_back({strut, point(-kHalf)});
            ends.push_back({strut, point(kHalf)});
        }
    const double rope = std::sqrt(1.5) * kHalf;  // an end's four nearest neighbours are this far
    for (size_t i = 0; i < ends.size(); ++i)
        for (size_t j = i + 1; j < ends.size(); ++j) {
            if (std::fabs(length(minus(ends[i].point, ends[j].point)) - rope) > 1e-6) continue;
            Joint joint = rod_at(scene, ends[i].strut, world(ends[i].point), ends[j].strut, world(ends[j].point));
            joint.max_length = static_cast<float>(kShorter * rope);
            joint.compliance = static_cast<float>(kCompliance);
            joint.damping = static_cast<float>(kDamping);
            scene.add_joint(joint);
        }
    scene.forces = ForceScale{2, 4};
    perturb(scene, options.seed);
    scene.camera = {{2.7, 2.6, 5.6}, {-0.1, 1.75, 0}, 42};
    scene.stage = {{-4, 0, -4}, {4, 5, 4}};
    return scene;
}

}  // namespace scenes
