// The camera of taut-demo that follows: what it follows is in the picture, and its way does not depend on the rate.
#include "render/follow_camera.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace {

using render::Camera;
using render::FollowCamera;
using render::Vec3;

constexpr float kGravity = 9.81f, kAspect = 16.0f / 9;
const Camera kFirst = {{6, 4, 9}, {0, 1, 0}, 0.66f};
const Vec3 kHalf = {1.6f, 0.8f, 0.7f};  // of the box that is followed [m]

// Largest coordinate of a box's corners in the picture, whose borders are at 1.
float outermost(const Camera& camera, Vec3 low, Vec3 high) {
    const render::ViewAxes axes = render::view_axes(normalised(camera.target - camera.eye));
    const float up = std::tan(0.5f * camera.vertical_fov);
    float most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p =
            Vec3{corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z} - camera.eye;
        const float depth = -dot(axes.back, p);
        if (!(depth > 0)) return INFINITY;
        most = std::max(
            {most, std::fabs(dot(axes.up, p)) / (up * depth), std::fabs(dot(axes.right, p)) / (up * kAspect * depth)});
    }
    return most;
}

class FollowAt : public testing::TestWithParam<int> {
protected:
    // Follows a box about a point that goes by a law for some seconds; looks at each step.
    void run(const std::function<Vec3(double)>& middle, double seconds,
             const std::function<void(const FollowCamera&, Vec3)>& look) const {
        FollowCamera camera(kFirst, kGravity, kAspect);
        for (int step = 0; step <= std::lround(seconds * GetParam()); ++step) {
            const Vec3 at = middle(static_cast<double>(step) / GetParam());
            camera.follow(at - kHalf, at + kHalf, 1.0f / static_cast<float>(GetParam()));
            look(camera, at);
        }
    }
};

Vec3 along(double x, double y = 0) { return {static_cast<float>(x), static_cast<float>(y), 0}; }

TEST_P(FollowAt, WhatGoesEvenlyIsInTheMiddle) {
    Vec3 off{};
    run([](double t) { return along(30 * t, 2); }, 6, [&](const FollowCamera& c, Vec3 at) { off = c.middle() - at; });
    EXPECT_LT(length(off), 1e-3f);
}

// a / w^2 with w^2 = g / s, s a quarter of the ball's radius.
TEST_P(FollowAt, WhatFallsGetsAheadByTheSlack) {
    Vec3 off{};
    run([](double t) { return along(0, -0.5 * kGravity * t * t); }, 6,
        [&](const FollowCamera& c, Vec3 at) { off = c.middle() - at; });
    EXPECT_NEAR(off.y, 0.25f * length(kHalf), 0.01f * length(kHalf));
}

// Whatever moves it: even, thrown back and forth, jumping by ten times its size.
TEST_P(FollowAt, TheBoxIsAlwaysInThePicture) {
    const std::vector<std::function<Vec3(double)>> laws = {
        [](double t) { return along(30 * t); },
        [](double t) { return along(4 * std::sin(9 * t), 2 * std::cos(5 * t)); },
        [](double t) { return along(20 * std::floor(t)); },
    };
    for (size_t i = 0; i < laws.size(); ++i)
        run(laws[i], 4, [&](const FollowCamera& c, Vec3 at) {
            ASSERT_LE(outermost(c.camera(), at - kHalf, at + kHalf), 1.0f) << "law " << i;
        });
}

// Where it grows and shrinks, too; and it does not stay far off.
TEST(FollowCamera, FramesWhatGrowsAndComesBack) {
    FollowCamera camera(kFirst, kGravity, kAspect);
    const auto follow = [&](float size) {
        camera.follow(kHalf * -size, kHalf * size, 1.0f / 60);
        EXPECT_LE(outermost(camera.camera(), kHalf * -size, kHalf * size), 1.0f) << size;
    };
    follow(1);
    const float before = length(camera.camera().eye);
    for (int i = 0; i < 60; ++i) follow(1 + 0.3f * static_cast<float>(i));
    for (int i = 0; i < 600; ++i) follow(1);
    EXPECT_NEAR(length(camera.camera().eye), before, 1e-2f * before);
    // From the direction that it was given.
    EXPECT_LT(length(normalised(camera.camera().eye - camera.camera().target) - normalised(kFirst.eye - kFirst.target)),
              1e-4f);
}

// The way of the camera is solved exactly between steps: where the target goes evenly its pace does not matter.
TEST(FollowCamera, GoesTheSameWayAtEveryRate) {
    const auto middle_after = [](int rate) {
        FollowCamera camera(kFirst, kGravity, kAspect);
        for (int step = 0; step <= rate; ++step) {  // still, then suddenly on its way
            const Vec3 at = along(8 * std::max(0.0, static_cast<double>(step) / rate - 0.5));
            camera.follow(at - kHalf, at + kHalf, 1.0f / static_cast<float>(rate));
        }
        return camera.middle();
    };
    for (const int rate : {60, 120, 240}) EXPECT_LT(length(middle_after(rate) - middle_after(30)), 1e-3f) << rate;
}

INSTANTIATE_TEST_SUITE_P(Rates, FollowAt, testing::Values(30, 60, 120, 240));

}  // namespace
