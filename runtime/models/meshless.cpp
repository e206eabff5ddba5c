#include "models/meshless.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace taut {
namespace {

constexpr uint32_t kAbout = 64;    // vertices about one that its octants are made of, at most
constexpr double kOnPlane = 1e-6;  // of the radius: what is so near to an octant's side is in both
// det M over that of equal moments of the same sum, below which an octant is flat: that of a brick 5 times as wide
// either way as it is thick is 0.036. Vertices on a rough side would else make a thin layer outside of it.
constexpr double kFlatOctant = 0.05;

// Second moments about the mean of some vertices.
struct Moments {
    Vec3 mean = Vec3::Zero();
    Mat3 m = Mat3::Zero();

    Moments(std::span<const Vec3> rest, const uint32_t* vertex, uint32_t count) {
        for (uint32_t n = 0; n < count; ++n) mean += (rest[vertex[n]] - rest[vertex[0]]) / count;
        mean += rest[vertex[0]];
        for (uint32_t n = 0; n < count; ++n) {
            const Vec3 d = rest[vertex[n]] - mean;
            m += d * d.transpose() / count;
        }
    }
    bool is_flat() const {
        const double equal = m.trace() / 3;
        return !(m.determinant() > kFlatOctant * equal * equal * equal);
    }
};

// Of the vertices about one at x, sorted by distance.
void add_sample_of_octant(std::span<const Vec3> rest, const Vec3& x, int octant, std::span<const Neighbour> about,
                          double radius, Array<Sample>& out) {
    struct Member {
        double extent;  // largest coordinate from x
        uint32_t order, point;
    };
    Member group[kAbout];
    uint32_t count = 0;
    for (const Neighbour& each : about) {
        const Vec3 d = rest[each.point] - x;
        bool within = true;
        for (int axis = 0; axis < 3; ++axis)
            within = within && (octant >> axis & 1 ? -d[axis] : d[axis]) >= -kOnPlane * radius;
        if (within) group[count] = {d.cwiseAbs().maxCoeff(), count, each.point}, ++count;
    }
    std::sort(group, group + count, [](const Member& a, const Member& b) {
        return a.extent < b.extent || (a.extent == b.extent && a.order < b.order);
    });
    count = std::min(count, kSampleNodes);
    if (count < 4) return;
    uint32_t vertex[kSampleNodes];
    for (uint32_t n = 0; n < count; ++n) vertex[n] = group[n].point;
    const Moments of(rest, vertex, count);
    if (of.is_flat()) return;
    Sample sample{0.5 * (x + of.mean), std::sqrt(of.m.determinant()), 0};
    for (uint32_t n = 0; n < count; ++n) sample.reach = std::max(sample.reach, (rest[vertex[n]] - sample.at).norm());
    out.push_back(sample);
}

}  // namespace

SampleNodes nodes_of_sample(const Neighbours& neighbours, const Vec3& at, double reach) {
    Neighbour near[kSampleNodes + 1];
    const uint32_t found = neighbours.nearest(at, kSampleNodes + 1, std::numeric_limits<double>::infinity(), near);
    double squared = reach * reach;
    if (found > kSampleNodes) squared = std::min(squared, near[kSampleNodes].squared);
    SampleNodes out{};
    for (uint32_t n = 0; n < kSampleNodes; ++n) {
        out.vertex[n] = near[n].point;
        const double left = squared > 0 ? std::max(0.0, 1 - near[n].squared / squared) : 0;
        out.weight[n] = left * left;
    }
    return out;
}

double usual_radius(std::span<const Vec3> rest, const Neighbours& neighbours) {
    constexpr uint32_t kSixth = 7;  // itself is the first
    double sum = 0;
    for (const Vec3& x : rest) {
        Neighbour near[kSixth];
        const uint32_t found = neighbours.nearest(x, kSixth, std::numeric_limits<double>::infinity(), near);
        sum += std::sqrt(near[found - 1].squared);
    }
    return 2 * sum / static_cast<double>(rest.size());
}

void make_samples(std::span<const Vec3> rest, const Neighbours& neighbours, double radius, Array<Sample>& out) {
    for (const Vec3& x : rest) {
        Neighbour near[kAbout];
        const uint32_t about = neighbours.nearest(x, kAbout, radius, near);
        for (int octant = 0; octant < 8; ++octant) add_sample_of_octant(rest, x, octant, {near, about}, radius, out);
    }
}

}  // namespace taut
