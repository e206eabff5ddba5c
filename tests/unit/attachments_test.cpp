// The way between two anchors, and the nearest points of triangles and tetrahedra.
#include <gtest/gtest.h>

#include <random>

#include "check/validate.h"
#include "constraints/attachment.h"
#include "models/soft_points.h"
#include "state/attachments.h"

namespace taut::test {
namespace {

Anchor anchor_of(std::initializer_list<uint32_t> nodes, std::initializer_list<double> weights, const Vec3& point) {
    Anchor out;
    for (const uint32_t node : nodes) out.node[out.count++] = node;
    std::ranges::copy(weights, out.weight.begin());
    for (uint32_t n = 0; n < out.count; ++n) out.point[n] = (n + 1.0) * point;
    return out;
}

TEST(AttachedWay, IsFromTheFirstAnchorToTheSecond) {
    const Vec3 point(1, 2, 3);
    const AttachedWay way = way_between(anchor_of({4, 7}, {0.25, 0.75}, point), anchor_of({9}, {1}, -point));
    ASSERT_EQ(way.count, 3u);
    EXPECT_EQ(way.term[0].node, 4u);
    EXPECT_EQ(way.term[0].weight, -0.25);
    EXPECT_EQ(way.term[1].moment, Vec3(-1.5 * point));
    EXPECT_EQ(way.term[2].weight, 1);
    EXPECT_EQ(way.term[2].moment, Vec3(-point));
    EXPECT_EQ(way.rest, Vec3(Vec3::Zero()));
}

TEST(AttachedWay, CountsANodeOfBothOnceAndLeavesOutWhatCancels) {
    const Vec3 none = Vec3::Zero();
    const AttachedWay way =
        way_between(anchor_of({1, 2, 3}, {0.5, 0.25, 0.25}, none), anchor_of({3, 2, 5}, {0.5, 0.25, 0.25}, none));
    ASSERT_EQ(way.count, 3u);
    EXPECT_EQ(way.term[0].node, 1u);
    EXPECT_EQ(way.term[1].node, 3u);
    EXPECT_EQ(way.term[1].weight, 0.25);
    EXPECT_EQ(way.term[2].node, 5u);
    EXPECT_EQ(way_between(anchor_of({1}, {1}, none), anchor_of({1}, {1}, none)).count, 0u);
    Anchor nail;
    nail.point[0] = {1, 2, 3};
    EXPECT_EQ(way_between(nail, anchor_of({1}, {1}, none)).rest, Vec3(-1, -2, -3));
}

// No other point of the simplex is nearer; within it nothing is left.
template <int N, class Find>
void expect_nearest(Find&& find) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto vector = [&] { return Vec3(number(random), number(random), number(random)); };
    for (int sample = 0; sample < 300; ++sample) {
        Vec3 x[N];
        for (Vec3& each : x) each = vector();
        const Vec3 to = 1.5 * vector();
        double weight[N], sum = 0;
        find(x, to, weight);
        Vec3 at = Vec3::Zero();
        for (int n = 0; n < N; ++n) {
            EXPECT_GE(weight[n], 0);
            sum += weight[n];
            at += weight[n] * x[n];
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        // Optimal where no corner lies further towards the point than what was found.
        for (const Vec3& corner : x) EXPECT_LE((to - at).dot(corner - at), 1e-9);
    }
}
TEST(NearestPoint, OfATriangle) { expect_nearest<3>(nearest_of_triangle); }
TEST(NearestPoint, OfATetrahedron) { expect_nearest<4>(nearest_of_tetrahedron); }

TEST(NearestPoint, OfWhatIsFlatIsOnIt) {
    const Vec3 line[] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, flat[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    double three[3], four[4];
    nearest_of_triangle(line, {0.4, 1, 0}, three);
    EXPECT_NEAR(three[1] + 2 * three[2], 0.4, 1e-12);
    nearest_of_tetrahedron(flat, {0.9, 0.8, 3}, four);
    EXPECT_NEAR(four[1] + four[3], 0.9, 1e-12);
    EXPECT_NEAR(four[2] + four[3], 0.8, 1e-12);
}

TEST(ValidateAttachments, HaveElementsOnTheirNodes) {
    Memory memory{taut_hooks{}};
    Elements elements(memory);
    Attachments attachments(memory);
    const uint32_t set = elements.add(point_attachment(2)), nodes[] = {3, 5};
    reserve_elements(elements.set[set], 1);
    elements.insert(elements.set[set], 0, nodes, 1);
    Attachment attachment;
    attachment.end[0] = anchor_of({3}, {1}, Vec3::Zero());
    attachment.end[1] = anchor_of({5}, {1}, Vec3::Zero());
    attachment.set = set;
    attachment.element[0] = 0;
    attachments.reserve_one();
    const uint32_t index = attachments.add(attachment);
    EXPECT_FALSE(validate_attachments(attachments, elements));
    attachments.record[index].end[1].node[0] = 6;
    EXPECT_STREQ(validate_attachments(attachments, elements)->invariant, "elements of an attachment are on its nodes");
    attachments.record[index].element[0] = 1;
    EXPECT_STREQ(validate_attachments(attachments, elements)->invariant, "attachments have elements");
}

}  // namespace
}  // namespace taut::test
