// The kernels that work on boxes, corners and faces side by side: each build against loops over one after the other.
#include "collision/lane_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "collision/hull.h"
#include "collision_oracle.h"
#include "widths.h"

namespace taut::collision {
namespace {

using oracle::Random;

class LaneKernelsOf : public testing::TestWithParam<Width> {
protected:
    void SetUp() override {
        if (GetParam() > widest()) GTEST_SKIP() << "not on this processor";
    }
    const LaneKernels& kernels() const { return *kLaneKernels[size_t(GetParam())]; }
};

// Of so many corners, in so many faces: less than a register's and more than several hold.
std::vector<Shape> hulls(Random& random) {
    std::vector<Shape> all = {oracle::random_shape(ShapeKind::hull, random)};
    for (const int corners : {4, 8, 15, 16, 17, 33, 64}) {
        std::vector<Vec3f> points;
        for (int i = 0; i < corners; ++i) points.push_back(random.unit().cast<float>());
        const Shape hull = oracle::hull(points);
        if (hull.hull) all.push_back(hull);  // not four points in a plane, nearly
    }
    return all;
}

Vec3f vector(Random& random, double size) { return (size * random.unit()).cast<float>(); }

TEST_P(LaneKernelsOf, BoxesMeetWhereNoCoordinateIsApart) {
    Random random(201);
    const auto coordinate = [&] { return float(int(random.uniform(-4, 4))); };  // so that many just touch
    int met = 0;
    for (int round = 0; round < 500; ++round) {
        BoxLanes boxes;
        for (int lane = 0; lane < kLanes; ++lane)
            for (int i = 0; i < 3; ++i) {
                boxes.lo[i][lane] = coordinate();
                boxes.hi[i][lane] = boxes.lo[i][lane] + 2;
            }
        for (float(&lo)[kLanes] : boxes.lo) lo[3] = std::numeric_limits<float>::infinity();
        for (float(&hi)[kLanes] : boxes.hi) hi[3] = -std::numeric_limits<float>::infinity();
        const Vec3f lo(coordinate(), coordinate(), coordinate()), hi = lo + Vec3f::Constant(2);
        const unsigned bits = kernels().meeting(boxes, lo.data(), hi.data());
        for (int lane = 0; lane < kLanes; ++lane) {
            bool meets = true;
            for (int i = 0; i < 3; ++i) meets = meets && boxes.lo[i][lane] <= hi[i] && lo[i] <= boxes.hi[i][lane];
            EXPECT_EQ(bits >> lane & 1, unsigned(meets));
            met += meets;
        }
        EXPECT_EQ(bits >> kLanes, 0u);
        EXPECT_EQ(bits >> 3 & 1, 0u);
    }
    EXPECT_GT(met, 500);
}

// In the order in which the kernels add.
float along(const Vec3f& v, const Vec3f& direction) {
    return v.x() * direction.x() + v.y() * direction.y() + v.z() * direction.z();
}

TEST_P(LaneKernelsOf, CornersReachAndPointsLieOverFacesAsOneByOne) {
    Random random(202);
    for (int round = 0; round < 100; ++round)
        for (const Shape& shape : hulls(random)) {
            const Polytope& hull = shape.hull->view();
            const Vec3f direction = vector(random, 1), p = vector(random, 1.5), q = vector(random, 1.5);
            std::vector<float> reach, over, way;
            for (const Vec3f& v : hull.vertices) reach.push_back(along(v, direction));
            for (const Face& face : hull.faces) {
                over.push_back(along(face.normal, p) - face.offset);
                way.push_back(std::min(over.back(), along(face.normal, q) - face.offset));
            }
            const auto most = [](const std::vector<float>& of) { return std::max_element(of.begin(), of.end()); };
            EXPECT_EQ(kernels().highest(hull.corners, direction.data()), *most(reach));
            EXPECT_EQ(kernels().support(hull.corners, direction.data()), uint32_t(most(reach) - reach.begin()));
            EXPECT_EQ(kernels().outside(hull.planes, p.data()), *most(over));
            EXPECT_EQ(kernels().way_outside(hull.planes, p.data(), q.data()), *most(way));
            alignas(64) float found[column_length(kMaxFaces)];
            EXPECT_EQ(kernels().heights(hull.corners, direction.data(), found), *most(reach));
            EXPECT_TRUE(std::equal(reach.begin(), reach.end(), found));
            EXPECT_EQ(kernels().heights_over(hull.planes, p.data(), found), *most(over));
            EXPECT_TRUE(std::equal(over.begin(), over.end(), found));
        }
}

TEST_P(LaneKernelsOf, ExtentIsOfTheTurnedCorners) {
    Random random(203);
    for (int round = 0; round < 100; ++round)
        for (const Shape& shape : hulls(random)) {
            const Polytope& hull = shape.hull->view();
            const Mat3f rotation = random.rotation();
            float rows[3][3];
            Vec3f lo, hi, least = Vec3f::Constant(1e30f), most = -least;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) rows[i][j] = rotation(i, j);
            for (const Vec3f& v : hull.vertices)
                for (int i = 0; i < 3; ++i) {
                    least[i] = std::min(least[i], along(v, rotation.row(i)));
                    most[i] = std::max(most[i], along(v, rotation.row(i)));
                }
            kernels().extent(hull.corners, rows, lo.data(), hi.data());
            EXPECT_EQ(lo, least);
            EXPECT_EQ(hi, most);
        }
}

// The face that separates most of all, from the first corner that is nearest to it; the same bits from each build.
TEST_P(LaneKernelsOf, BestFaceIsThatOfALoopOverAll) {
    constexpr float kAll = -1e30f, kRounding = 2e-6f;
    Random random(204);
    for (int round = 0; round < 30; ++round) {
        const std::vector<Shape> all = hulls(random);
        for (const Shape& one : all)
            for (const Shape& other : all) {
                const Polytope &a = one.hull->view(), &b = other.hull->view();
                const Mat3f rotation = random.rotation();
                const Vec3f position = vector(random, random.uniform(0, 2.5)), centre = rotation * b.centre + position;
                FaceSearch search;
                search.planes = a.planes;
                search.faces = uint32_t(a.faces.size());
                search.corners = b.corners;
                for (int i = 0; i < 3; ++i) {
                    for (int j = 0; j < 3; ++j) search.rotation[i][j] = rotation(i, j);
                    search.position[i] = position[i];
                    search.centre[i] = centre[i];
                }
                search.radius = b.inner_radius;
                search.least = kAll;
                search.margin = -kAll;
                double most = double(kAll);
                for (const Face& face : a.faces) {
                    double nearest = 1e30;
                    for (const Vec3f& v : b.vertices)
                        nearest = std::min(nearest, double(face.normal.dot(rotation * v + position) - face.offset));
                    most = std::max(most, nearest);
                }
                const FaceFound found = kernels().best_face(search);
                EXPECT_NEAR(double(found.distance), most, double(kRounding));
                const Vec3f corner = rotation * b.vertices[found.corner] + position;
                const Face& face = a.faces[found.face];
                EXPECT_NEAR(face.normal.dot(corner) - face.offset, found.distance, kRounding);
                search.margin = found.distance - 0.01f;  // any beyond will do
                EXPECT_GT(kernels().best_face(search).distance, search.margin);
                search.margin = -kAll;
                search.least = found.distance + kRounding;  // none is asked, or any
                EXPECT_LE(kernels().best_face(search).distance, found.distance);
                search.least = kAll;
                const FaceFound scalar = kLaneKernelsScalar.best_face(search);
                EXPECT_EQ(found.face, scalar.face);
                EXPECT_EQ(found.corner, scalar.corner);
                EXPECT_EQ(found.distance, scalar.distance);
            }
    }
}

std::string name_of(const testing::TestParamInfo<Width>& width) { return kLaneKernels[size_t(width.param)]->build; }

INSTANTIATE_TEST_SUITE_P(Builds, LaneKernelsOf, testing::ValuesIn(widths_here()), name_of);

}  // namespace
}  // namespace taut::collision
