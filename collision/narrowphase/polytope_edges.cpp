// The sweep over all pairs of edges of two polytopes.
#include <algorithm>
#include <bit>
#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "collision/narrowphase/polytope_axes.h"

namespace taut::collision {
namespace {

// The vertices of one polytope along a direction of its frame.
struct CornerHeights {
    alignas(64) float of[kMaxVertices];
    float top;

    CornerHeights(const Polytope& polytope, const Vec3f& direction)
        : top(lane_kernels().heights(polytope.corners, direction.data(), of)) {}
    const Vec3f& highest(const Polytope& polytope) const {
        return polytope.vertices[size_t(std::find(of, of + polytope.vertices.size() - 1, top) - of)];
    }
};

// How high a point lies over the faces of a polytope.
struct HeightsOver {
    alignas(64) float of[column_length(kMaxFaces)];

    HeightsOver(const Polytope& polytope, const Vec3f& point) {
        lane_kernels().heights_over(polytope.planes, point.data(), of);
    }
};

// What an edge must do to bear: reach up to a height, and have a face over which a point of the other polytope lies as
// high. Between the normals of two faces that it lies lower under, an edge's normal separates by less.
struct Demand {
    float height, over;
};

// The edges that do; returns how many.
int edges_that_may(const Polytope& polytope, const CornerHeights& heights, const HeightsOver& over,
                   const Demand& demand, uint8_t* index) {
    int count = 0;
    for (size_t e = 0; e < polytope.edges.size(); ++e) {
        const Edge& edge = polytope.edges[e];
        index[count] = uint8_t(e);
        const bool reaches = (heights.of[edge.from] >= demand.height) | (heights.of[edge.to] >= demand.height);
        const bool lies_over = (over.of[edge.left] >= demand.over) | (over.of[edge.right] >= demand.over);
        count += reaches & lies_over;
    }
    return count;
}

constexpr int kPacks = (kMaxEdges + 3) / 4;

// Four vectors side by side.
struct VectorPack {
    Eigen::Array4f x, y, z;

    void put(int lane, const Vec3f& v) { x[lane] = v.x(), y[lane] = v.y(), z[lane] = v.z(); }
    Vec3f at(int lane) const { return {x[lane], y[lane], z[lane]}; }
    Eigen::Array4f dot(const Vec3f& v) const { return x * v.x() + y * v.y() + z * v.z(); }
    VectorPack turned(const Mat3f& r) const {
        return {x * r(0, 0) + y * r(0, 1) + z * r(0, 2), x * r(1, 0) + y * r(1, 1) + z * r(1, 2),
                x * r(2, 0) + y * r(2, 1) + z * r(2, 2)};
    }
};

// Four edges of b in a's frame. Where there are fewer, both normals are 0: such an edge crosses nothing.
struct EdgePack {
    VectorPack from, along;  // from one end to the other
    VectorPack left, right;  // normals of the two faces, negated
};

// Those edges of b that may bear.
struct EdgesOfB {
    int count = 0;
    uint8_t index[4 * kPacks];
    EdgePack packs[kPacks];

    int packs_used() const { return (count + 3) / 4; }
    void gather(const PolytopePair& pair);
};

void EdgesOfB::gather(const PolytopePair& pair) {
    for (int k = 0; k < 4 * packs_used(); ++k) {
        const Edge& edge = pair.b.edges[index[std::min(k, count - 1)]];
        const float bears = k < count ? -1.0f : 0.0f;
        EdgePack& pack = packs[k / 4];
        pack.from.put(k % 4, pair.b.vertices[edge.from]);
        pack.along.put(k % 4, pair.b.direction(edge));
        pack.left.put(k % 4, pair.b.faces[edge.left].normal * bears);
        pack.right.put(k % 4, pair.b.faces[edge.right].normal * bears);
    }
    const Mat3f& r = pair.b_in_a.rotation;
    const Vec3f& p = pair.b_in_a.position;
    for (int i = 0; i < packs_used(); ++i) {
        EdgePack& pack = packs[i];
        pack.from = pack.from.turned(r);
        pack.from.x += p.x(), pack.from.y += p.y(), pack.from.z += p.z();
        for (VectorPack* each : {&pack.along, &pack.left, &pack.right}) *each = each->turned(r);
    }
}

// Of four edges of b, a bit for each whose arc crosses that of an edge of a; see arcs_cross().
unsigned crossing_bits(const Vec3f& along, const Vec3f& left, const Vec3f& right, const EdgePack& b) {
    const Eigen::Array4f c = b.left.dot(along), d = b.right.dot(along);
    const Eigen::Array4f l = b.along.dot(left), r = b.along.dot(right);
    const Eigen::Array4f across_a = c * d, across_b = l * r, apart = c * r;
#if defined(__SSE2__)
    const __m128 zero = _mm_setzero_ps();
    const __m128 both =
        _mm_and_ps(_mm_cmplt_ps(_mm_load_ps(across_a.data()), zero), _mm_cmplt_ps(_mm_load_ps(across_b.data()), zero));
    return unsigned(_mm_movemask_ps(_mm_and_ps(both, _mm_cmpgt_ps(_mm_load_ps(apart.data()), zero))));
#else
    unsigned bits = 0;
    for (int i = 0; i < 4; ++i) bits |= unsigned(across_a[i] < 0 && across_b[i] < 0 && apart[i] > 0) << i;
    return bits;
#endif
}

// Keeps the pair of edges that separates most of those that it is shown.
class MostApart {
public:
    MostApart(const PolytopePair& pair, const EdgesOfB& b) : pair_(pair), b_(b) {}

    // The edges of b from a place on that have a bit. Most edges of a cross at most two: those two are noted without a
    // branch, which would be mispredicted.
    void note(uint8_t edge_of_a, int place, uint64_t bits) {
        for (int i = 0; i < 2; ++i) {
            put(edge_of_a, place, bits | uint64_t{1} << 63);
            count_ += bits != 0;
            bits &= bits - 1;
        }
        for (; bits != 0; bits &= bits - 1) {
            if (count_ == kMost) settle();
            put(edge_of_a, place, bits);
            ++count_;
        }
        if (count_ + 2 > kMost) settle();
    }
    // Looks at those noted since: many at once, for none waits for another. The first of equals wins.
    void settle() {
        for (int i = 0; i < count_; ++i) {
            const Edge& edge = pair_.a.edges[hits_[i].a];
            const EdgePack& pack = b_.packs[hits_[i].b / 4];
            const int lane = hits_[i].b % 4;
            const Vec3f across = edge_normal(pair_.a, edge, pack.along.at(lane));
            const float apart = across.dot(pack.from.at(lane) - pair_.a.vertices[edge.from]);
            const float distance = across.squaredNorm() > 0 ? apart : -1e30f;
            best_ = distance > distance_ ? hits_[i] : best_;
            distance_ = distance > distance_ ? distance : distance_;
        }
        count_ = 0;
    }
    Separation best() const {
        if (distance_ == -1e30f) return {};
        return {{AxisKind::edges, best_.a, b_.index[best_.b]}, distance_, 0};
    }

private:
    struct Hit {
        uint8_t a, b;
    };
    static constexpr int kMost = 32;

    void put(uint8_t edge_of_a, int place, uint64_t bits) {
        hits_[count_] = {edge_of_a, uint8_t(place + std::countr_zero(bits))};
    }

    const PolytopePair& pair_;
    const EdgesOfB& b_;
    int count_ = 0;
    Hit hits_[kMost];
    Hit best_ = {0, 0};
    float distance_ = -1e30f;
};

}  // namespace

// If an edge pair bears the least overlap d <= depth, its nearest points lie on the edges, d apart and both within
// the two polytopes' overlap along normal grown by d.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float least) {
    const CornerHeights up_a(pair.a, normal);
    const CornerHeights down_b(pair.b, pair.b_in_a.rotation.transpose() * -normal);
    const float middle = normal.dot(pair.b_in_a.position), under = std::min(least, 0.0f);
    uint8_t own[kMaxEdges];
    const HeightsOver over_a(pair.a, pair.b_in_a * down_b.highest(pair.b));
    const int count = edges_that_may(pair.a, up_a, over_a, {middle - down_b.top - depth, under}, own);
    EdgesOfB b;
    const HeightsOver over_b(pair.b, pair.a_in_b * up_a.highest(pair.a));
    b.count = edges_that_may(pair.b, down_b, over_b, {middle - up_a.top - depth, under}, b.index);
    if (count == 0 || b.count == 0) return {};
    b.gather(pair);
    MostApart most(pair, b);
    for (int e = 0; e < count; ++e) {
        const Edge& edge = pair.a.edges[own[e]];
        const Vec3f along = pair.a.direction(edge);
        const Vec3f &left = pair.a.faces[edge.left].normal, &right = pair.a.faces[edge.right].normal;
        for (int begin = 0; begin < b.packs_used(); begin += 16) {
            uint64_t bits = 0;
            const int packs = std::min(b.packs_used() - begin, 16);
            for (int i = 0; i < packs; ++i)
                bits |= uint64_t(crossing_bits(along, left, right, b.packs[begin + i])) << 4 * i;
            most.note(own[e], 4 * begin, bits);
        }
    }
    most.settle();
    return most.best();
}

}  // namespace taut::collision
