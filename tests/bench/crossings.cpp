#include "crossings.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "vector.h"

namespace bench {

namespace {

double signed_volume(Vec a, Vec b, Vec c, Vec d) { return dot(b - a, cross(c - a, d - a)); }

// Heights of a triangle's corners over the plane of another, times twice the area of that.
std::array<double, 3> heights(const std::array<Vec, 3>& of, const std::array<Vec, 3>& over) {
    const Vec normal = cross(over[1] - over[0], over[2] - over[0]);
    return {dot(of[0] - over[0], normal), dot(of[1] - over[0], normal), dot(of[2] - over[0], normal)};
}

bool on_one_side(const std::array<double, 3>& h) {
    return (h[0] >= 0 && h[1] >= 0 && h[2] >= 0) || (h[0] <= 0 && h[1] <= 0 && h[2] <= 0);
}

// Whether an edge of a, which has an end on each side of t's plane, passes through the inside of t.
bool pierces(const std::array<Vec, 3>& a, const std::array<double, 3>& height, const std::array<Vec, 3>& t) {
    for (size_t k = 0; k < 3; ++k) {
        const size_t next = (k + 1) % 3;
        if (!((height[k] > 0 && height[next] < 0) || (height[k] < 0 && height[next] > 0))) continue;
        const Vec p = a[k], q = a[next];
        const double u = signed_volume(p, q, t[0], t[1]), v = signed_volume(p, q, t[1], t[2]),
                     w = signed_volume(p, q, t[2], t[0]);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0)) return true;
    }
    return false;
}

struct Face {
    uint32_t skin;
    std::array<uint32_t, 3> ids;
    std::array<Vec, 3> at;
};

bool share_a_point(const Face& a, const Face& b, bool by_ids) {
    if (a.skin != b.skin && !by_ids) return false;
    for (const uint32_t i : a.ids)
        for (const uint32_t k : b.ids)
            if (i == k) return true;
    return false;
}

bool cross_faces(const std::array<Vec, 3>& a, const std::array<Vec, 3>& b) {
    const auto of_a = heights(a, b);
    if (on_one_side(of_a)) return false;
    const auto of_b = heights(b, a);
    return !on_one_side(of_b) && (pierces(a, of_a, b) || pierces(b, of_b, a));
}

}  // namespace

bool cross_each_other(const std::array<taut_pos, 3>& a, const std::array<taut_pos, 3>& b) {
    return cross_faces({of(a[0]), of(a[1]), of(a[2])}, {of(b[0]), of(b[1]), of(b[2])});
}

FaceTree::Box FaceTree::box_about(const taut_pos& a, const taut_pos& b, const taut_pos& c) {
    return {{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y}), std::min({a.z, b.z, c.z})},
            {std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y}), std::max({a.z, b.z, c.z})}};
}

bool FaceTree::meet(const Box& a, const Box& b) {
    for (int k = 0; k < 3; ++k)
        if (!(a.low[k] <= b.high[k] && b.low[k] <= a.high[k])) return false;
    return true;
}

FaceTree::FaceTree(std::vector<Box> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(boxes_.size());
    if (!boxes_.empty()) build(0, static_cast<uint32_t>(boxes_.size()));
}

uint32_t FaceTree::build(uint32_t first, uint32_t count) {
    constexpr uint32_t kLeaf = 4;
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Box box = {{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
    for (uint32_t i = first; i < first + count; ++i)
        for (int k = 0; k < 3; ++k) {
            box.low[k] = std::min(box.low[k], boxes_[order_[i]].low[k]);
            box.high[k] = std::max(box.high[k], boxes_[order_[i]].high[k]);
        }
    const auto at = static_cast<uint32_t>(nodes_.size());
    nodes_.push_back({box, first, count, 0});
    if (count <= kLeaf) return at;
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (box.high[k] - box.low[k] > box.high[axis] - box.low[axis]) axis = k;
    const uint32_t half = count / 2;
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + half, begin + count, [&](uint32_t i, uint32_t k) {
        return boxes_[i].low[axis] + boxes_[i].high[axis] < boxes_[k].low[axis] + boxes_[k].high[axis];
    });
    build(first, half);
    const uint32_t second = build(first + half, count - half);
    nodes_[at].child = second;
    return at;
}

Crossings count_crossings(std::span<const Skin> skins) {
    Crossings found;
    found.own.assign(skins.size(), 0);
    std::vector<Face> faces;
    std::vector<FaceTree::Box> boxes;
    bool by_ids = false;
    for (uint32_t s = 0; s < skins.size(); ++s) {
        const Skin& skin = skins[s];
        by_ids = by_ids || !skin.ids.empty();
        for (const auto& f : skin.faces) {
            const taut_pos &a = skin.points[f[0]], &b = skin.points[f[1]], &c = skin.points[f[2]];
            boxes.push_back(FaceTree::box_about(a, b, c));
            Face face = {s, f, {of(a), of(b), of(c)}};
            for (uint32_t& id : face.ids) id = skin.ids.empty() ? id : skin.ids[id];
            faces.push_back(face);
        }
    }
    const FaceTree tree(boxes);
    for (uint32_t i = 0; i < faces.size(); ++i)
        tree.each_near(boxes[i], [&](uint32_t k) {
            if (k <= i || share_a_point(faces[i], faces[k], by_ids) || !cross_faces(faces[i].at, faces[k].at)) return;
            if (faces[i].skin == faces[k].skin)
                ++found.own[faces[i].skin];
            else
                ++found.between;
        });
    return found;
}

}  // namespace bench
