// Which contacts of a body that lies on one solid are with faces of the next that it cannot meet, and what is left.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collision/internal_face.h"
#include "collision_oracle.h"

namespace taut::collision {
namespace {

// A body on the floor y <= 0, x <= 0, before a solid at the origin.
struct Scene {
    Shape body, solid;
    Vec3 at;

    Placement body_at() const { return {at, Mat3f::Identity()}; }
    static Placement solid_at() { return {Vec3::Zero(), Mat3f::Identity()}; }
    Cover cover() const {
        const Vec3f middle = at.cast<float>();
        return {Vec3f::UnitY(), 0, Vec3f(std::min(middle.x(), -0.01f), 0, middle.z()), middle, 1};
    }
    // What collide() says of the two, as the solid has it.
    SolidContact footing() const {
        PairCache cache;
        Manifold found;
        collide(solid, solid_at(), body, body_at(), 0.3f, cache, found);
        SolidContact out{found.normal, found.count, {}};
        for (int k = 0; k < found.count; ++k)
            out.points[k] = found.points[k].position - 0.5f * found.points[k].separation * found.normal;
        return out;
    }
    bool is_internal() const { return collision::is_internal(body, solid, 0, footing(), cover()); }
    Manifold open() const {
        Manifold out;
        collide_open(body, body_at(), solid, solid_at(), footing(), cover(), false, 0.3f, out);
        return out;
    }
};

// Half-space x >= 0 below the profile of heights over x, as a hull: heights at x = 0 and x = 2.
Shape block(float near, float far, float bevel = 0) {
    std::vector<Vec3f> points;
    for (const float z : {-2.0f, 2.0f}) {
        for (const Vec3f& p : {Vec3f(bevel, near, z), Vec3f(2, far, z), Vec3f(2, -1, z), Vec3f(0, -1, z)})
            points.push_back(p);
        if (bevel > 0) points.push_back(Vec3f(0, near - bevel, z));
    }
    return oracle::hull(points);
}

Shape cube() { return oracle::box(0.3f, 0.3f, 0.3f); }

TEST(InternalFace, SideOfALevelTile) {
    const Shape tile = block(0, 0);
    for (const double gap : {0.1, 0.02, 5e-5}) {
        const Scene scene{cube(), tile, {-0.3 - gap, 0.3 - 1e-4, 0}};
        ASSERT_GT(scene.footing().count, 0) << gap;
        EXPECT_NEAR(scene.footing().normal.x(), -1, 1e-6) << gap;
        EXPECT_TRUE(scene.is_internal()) << gap;
    }
    EXPECT_EQ((Scene{cube(), tile, {-0.35, 0.3 - 1e-4, 0}}).open().count, 0);
    // A little of it over the tile is borne from above.
    const Manifold over = Scene{cube(), tile, {-0.3 + 5e-5, 0.3 - 1e-4, 0}}.open();
    ASSERT_GT(over.count, 0);
    EXPECT_NEAR(over.normal.y(), 1, 1e-6);
    EXPECT_NEAR(over.points[0].separation, -1e-4, 1e-6);
}

TEST(InternalFace, EdgeOfALevelTileUnderABall) {
    const Scene scene{oracle::sphere(0.3f), block(0, 0), {-0.1, 0.3 - 1e-4, 0.2}};
    ASSERT_EQ(scene.footing().count, 1);
    EXPECT_LT(scene.footing().normal.x(), -0.2f);
    EXPECT_TRUE(scene.is_internal());
    EXPECT_EQ(scene.open().count, 0);
}

TEST(InternalFace, NoneWhereATileStandsOut) {
    for (const float height : {0.002f, 0.005f, 0.05f, 2.0f}) {
        EXPECT_FALSE((Scene{cube(), block(height, height), {-0.32, 0.3 - 1e-4, 0}}).is_internal()) << height;
        EXPECT_FALSE((Scene{oracle::sphere(0.3f), block(height, height), {-0.25, 0.3, 0}}).is_internal()) << height;
    }
}

// Before a ramp whose foot is level with the floor the contact is with its slope, as far as that is from the body.
TEST(InternalFace, FootOfARampLeavesItsSlope) {
    for (const float rise : {0.2f, 0.6f, 1.5f}) {
        const Scene scene{cube(), block(0, rise), {-0.36, 0.3 - 1e-4, 0}};
        ASSERT_TRUE(scene.is_internal()) << rise;
        const Manifold open = scene.open();
        ASSERT_GT(open.count, 0) << rise;
        const double angle = std::atan(double(rise) / 2);
        EXPECT_NEAR(open.normal.x(), -std::sin(angle), 1e-5) << rise;
        EXPECT_NEAR(open.normal.y(), std::cos(angle), 1e-5) << rise;
        float least = 1;
        for (int k = 0; k < open.count; ++k) least = std::min(least, open.points[k].separation);
        EXPECT_NEAR(least, 0.06 * std::sin(angle) - 1e-4 * std::cos(angle), 1e-5) << rise;
    }
}

// A bevel that ends at the floor's height is met from above.
TEST(InternalFace, BevelBelowTheFloorIsMetFromAbove) {
    const Scene scene{cube(), block(0, 0, 0.05f), {-0.28, 0.3 - 1e-4, 0}};
    ASSERT_GT(scene.footing().count, 0);
    EXPECT_TRUE(scene.is_internal());
    const Manifold open = scene.open();
    for (int k = 0; k < open.count; ++k) EXPECT_GT(open.points[k].separation, -2e-4);
    if (open.count > 0) {
        EXPECT_NEAR(open.normal.y(), 1, 1e-6);
    }
}

// A floor that falls away is met at its ridge along any normal between the two faces.
TEST(InternalFace, NoneAtARidge) {
    const Scene scene{oracle::sphere(0.3f), block(0, -1), {0.05, 0.296, 0}};
    ASSERT_EQ(scene.footing().count, 1);
    EXPECT_FALSE(scene.is_internal());
}

// The lowest edge of a body at the foot of a wall.
TEST(InternalFace, WallIsNone) {
    const Shape wall = block(2, 2);
    const Mat3f lean = Eigen::AngleAxisf(0.4f, Vec3f::UnitZ()).toRotationMatrix();
    PairCache cache;
    Manifold found;
    const Vec3 at(-0.45, 0.39, 0);
    collide(wall, Scene::solid_at(), cube(), {at, lean}, 0.2f, cache, found);
    ASSERT_GT(found.count, 0);
    SolidContact footing{found.normal, found.count, {}};
    for (int k = 0; k < found.count; ++k)
        footing.points[k] = found.points[k].position - 0.5f * found.points[k].separation * found.normal;
    const Cover cover{Vec3f::UnitY(), 0, {-0.4f, 0, 0}, at.cast<float>(), 1};
    EXPECT_FALSE(is_internal(cube(), wall, 0, footing, cover));
}

}  // namespace
}  // namespace taut::collision
