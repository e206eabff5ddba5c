// What scenes are laid out with: plans of motion, figures of limbs.
#include "bench/point_depth.h"
#include "scenes/limbs.h"
#include "scenes/parts.h"
#include "scenes/pose.h"
#include "scenes/running_scene.h"
#include "scenes/soft_meshes.h"

namespace {

using namespace lab;

TEST(PlannedBody, TurnsAboutOnePointThenAboutAnother) {
    scenes::Scene scene = scenes::empty_scene();
    scenes::Body arm = scenes::crate(scenes::cube_shape(scene, 0.2), {1, 2, 0}, 0);
    arm.kind = TAUT_BODY_KINEMATIC;
    const int body = scene.add_body(arm);
    scenes::Motion swing, spin;
    swing.body = spin.body = body;
    swing.about = {0, 0, 1};
    swing.pivot = {0, 2, 0};
    swing.track.keys = {{0, 0, 0}, {0.5, kPi / 2, 0}, {9, kPi / 2, 0}};
    spin.about = {0, 1, 0};
    spin.along = {0, 1, 0};
    spin.pivot = {0, 0, 1};
    spin.track.keys = {{0, 0, 0}, {0.5, kPi, 0}, {9, kPi, 0}};
    scene.motions = {swing, spin};
    RunningScene run(std::move(scene));
    for (int i = 0; i < 40; ++i) run.step();
    // From (1, 2, 0) to (0, 3, 0), then half round (0, ., 1) and up by pi.
    const taut_pose pose = run.world.pose(0);
    EXPECT_NEAR(pose.position.x, 0, 1e-5);
    EXPECT_NEAR(pose.position.y, 3 + kPi, 1e-5);
    EXPECT_NEAR(pose.position.z, 2, 1e-5);
    const taut_pos x = scenes::rotated(pose.rotation, {1, 0, 0}), y = scenes::rotated(pose.rotation, {0, 1, 0});
    EXPECT_NEAR(x.y, 1, 1e-5);
    EXPECT_NEAR(y.x, 1, 1e-5);
}

TEST(PlannedVertices, TurnAgainstEachOther) {
    constexpr int kFrames = 6;
    RunningScene run("cloth_twist");
    for (int i = 0; i < kFrames; ++i) run.step();
    const double angle = kPi * kFrames / 60;  // two turns in four seconds
    for (const scenes::Motion& motion : run.scene.motions) {
        const double turned = static_cast<double>(motion.about.x) * (&motion == &run.scene.motions[0] ? 1 : -1) * angle;
        for (const uint32_t v : motion.vertices) {
            const taut_pos start = run.scene.cloths[0].points[v];
            const Vec now = position(run.world.cloth_vertices[0][v]);
            EXPECT_NEAR(now.x, start.x, 1e-6);
            EXPECT_NEAR(now.y, motion.pivot.y - std::sin(turned) * start.z, 1e-5) << v;
            EXPECT_NEAR(now.z, std::cos(turned) * start.z, 1e-5) << v;
        }
    }
}

TEST(MassWithin, OfABrickIsKnown) {
    constexpr double kA = 0.4, kB = 0.6, kC = 1.0, kDensity = 700;
    scenes::Surface brick;
    for (const double x : {0.0, kA})
        for (const double y : {0.0, kB})
            for (const double z : {0.0, kC}) brick.points.push_back({x + 2, y - 1, z + 0.5});
    brick.triangles = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                       2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
    const scenes::MassOfSurface of = scenes::mass_within(brick, kDensity);
    const double mass = kDensity * kA * kB * kC;
    EXPECT_NEAR(of.mass, mass, 1e-9);
    EXPECT_NEAR(of.centre.x, 2 + kA / 2, 1e-12);
    EXPECT_NEAR(of.centre.y, kB / 2 - 1, 1e-12);
    EXPECT_NEAR(of.centre.z, 0.5 + kC / 2, 1e-12);
    EXPECT_NEAR(of.inertia.xx, mass * (kB * kB + kC * kC) / 12, 1e-4);
    EXPECT_NEAR(of.inertia.yy, mass * (kA * kA + kC * kC) / 12, 1e-4);
    EXPECT_NEAR(of.inertia.zz, mass * (kA * kA + kB * kB) / 12, 1e-4);
    EXPECT_NEAR(of.inertia.xy, 0, 1e-4);
}

// The drawn surface of a rigid figure is that of its capsules, but for where they blend.
TEST(RigidFigure, TouchesWhereItIsDrawn) {
    for (const auto limbs : {scenes::bunny_limbs(), scenes::armadillo_limbs()}) {
        scenes::Scene scene = scenes::empty_scene();
        const scenes::RigidFigure figure(scene, limbs, 1, 1000);
        const scenes::Body body = figure.at({}, {0, 0, 0, 1}, scenes::Look::wood);
        std::vector<bench::PointDepth> depths;
        for (const scenes::Part& part : body.parts)
            depths.emplace_back(scene.shapes[static_cast<size_t>(part.shape)], scene.shapes);
        double furthest = 0, sum = 0;
        const auto& drawn = scene.shapes[static_cast<size_t>(body.drawn)].points;
        for (const taut_vec3& p : drawn) {
            double within = -INFINITY;
            for (size_t i = 0; i < depths.size(); ++i) {
                const scenes::Part& part = body.parts[i];
                const bench::Vec own = bench::of(p) - bench::of(part.position);
                within = std::max(within, depths[i].at(bench::rotate_back(part.rotation, own)));
            }
            furthest = std::max(furthest, std::fabs(within));
            sum += std::fabs(within);
        }
        EXPECT_LT(furthest, 0.04);
        EXPECT_LT(sum / static_cast<double>(drawn.size()), 0.008);
    }
}

TEST(SaggingCloth, KeepsTheLengthOfItsThreads) {
    scenes::Cloth cloth = scenes::grid_cloth(30, 5, 1.9, 0.5, 1.5);
    scenes::sag(cloth, 1.9, 0.6);
    for (uint32_t i = 0; i + 1 < 30; ++i) {
        const double chord = scenes::length(scenes::minus(cloth.points[5 * i + 5], cloth.points[5 * i]));
        EXPECT_NEAR(chord, 1.9 / 29, 1e-4 * 1.9 / 29);
    }
    EXPECT_NEAR(cloth.points.front().y, 1.5, 1e-12);
    EXPECT_NEAR(cloth.points.back().y, 1.5, 1e-12);
    EXPECT_NEAR(cloth.points.back().x, 1.9 / 1.2 * std::sin(0.6), 1e-12);
}

}  // namespace
