#include "follow_camera.h"

#include <algorithm>
#include <cmath>

namespace render {

namespace {

constexpr float kSlack = 0.25f;        // of the ball's radius
constexpr float kLeastRadius = 1e-3f;  // of a ball [m]: the least size of a shape

}  // namespace

FollowCamera::FollowCamera(const Camera& first, float gravity, float aspect)
    : back_(normalised(first.eye - first.target)), fov_(first.vertical_fov), gravity_(gravity) {
    // A ball touches the planes of the narrower field of view where it is R / sin(half of that) away.
    const float across = std::atan(std::tan(0.5f * fov_) * aspect);
    distance_of_radius_ = 1 / std::sin(std::min(0.5f * fov_, across));
}

// e = value - target obeys e'' + 2 w e' + w^2 e = 0 while the target goes on evenly.
void FollowCamera::Spring::pull(float to, float frequency, float h) {
    const float target_rate = (to - target) / h, e = value - target, e_rate = rate - target_rate;
    const float k = e_rate + frequency * e, decay = std::exp(-frequency * h);
    target = to;
    value = to + (e + k * h) * decay;
    rate = target_rate + (e_rate - frequency * k * h) * decay;
}

void FollowCamera::follow(Vec3 low, Vec3 high, float h) {
    const Vec3 middle = (low + high) * 0.5f;
    const float ball = std::max(0.5f * length(high - low), kLeastRadius), wanted = (1 + kSlack) * ball;
    const float to[3] = {middle.x, middle.y, middle.z};
    if (!begun_) {
        for (int i = 0; i < 3; ++i) at_[i] = {to[i], 0, to[i]};
        size_ = {wanted, 0, wanted};
        begun_ = true;
    }
    const float frequency = std::sqrt(gravity_ / (kSlack * ball));
    for (int i = 0; i < 3; ++i) at_[i].pull(to[i], frequency, h);
    size_.pull(wanted, frequency, h);
    radius_ = std::max(size_.value, length(middle - this->middle()) + ball);
}

Camera FollowCamera::camera() const { return {middle() + back_ * (radius_ * distance_of_radius_), middle(), fov_}; }

}  // namespace render
