// A camera that keeps a box in its frame. It looks along a fixed direction from as far away as the frame needs.
#pragma once

#include "draw_list.h"

namespace render {

// The middle and the size of the frame follow those of the box as a critically damped spring, solved exactly over each
// step, so that pictures do not depend on their rate. The frame is wider than the ball about the box, of radius r, by
// the slack s = r/4. What accelerates by a gets ahead of the spring by a / w^2: its frequency w = sqrt(g / s) [1/s]
// lets what falls freely use that slack up, and nothing that is slower. Whatever the box does, it is in the frame:
// where the slack does not do, the frame grows with the box at once.
class FollowCamera {
public:
    // first: its direction and field of view stay. gravity [m/s^2]: its size, above 0; aspect: width over height.
    FollowCamera(const Camera& first, float gravity, float aspect);

    // The box after a step of h [s] that follows the last one; the first is framed at once.
    void follow(Vec3 low, Vec3 high, float h);
    Camera camera() const;
    Vec3 middle() const { return {at_[0].value, at_[1].value, at_[2].value}; }
    float radius() const { return radius_; }  // of the frame [m]

private:
    struct Spring {
        float value = 0, rate = 0, target = 0;
        void pull(float to, float frequency, float h);
    };

    Vec3 back_;  // from the middle to the eye
    float fov_, distance_of_radius_, gravity_;
    Spring at_[3], size_;
    float radius_ = 0;
    bool begun_ = false;
};

}  // namespace render
