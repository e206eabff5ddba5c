// Which leaves of Bullet's tree of boxes meet those of others.
#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace taut::collision {

// Whether no coordinate of p or of q is above that of its bound. Without branches: of the boxes that a descent asks,
// every other one is met.
#if defined(__SSE2__)
inline bool are_within(const btVector3& p, const btVector3& p_most, const btVector3& q, const btVector3& q_most) {
    const auto within = [](const btVector3& one, const btVector3& most) {
        return _mm_cmple_ps(_mm_loadu_ps(one.m_floats), _mm_loadu_ps(most.m_floats));
    };
    constexpr int kAll = 0b111;  // the fourth number means nothing
    return (_mm_movemask_ps(_mm_and_ps(within(p, p_most), within(q, q_most))) & kAll) == kAll;
}
#else
inline bool are_within(const btVector3& p, const btVector3& p_most, const btVector3& q, const btVector3& q_most) {
    int all = 1;
    for (int i = 0; i < 3; ++i) all &= int(p[i] <= p_most[i]) & int(q[i] <= q_most[i]);
    return all != 0;
}
#endif

inline bool meet(const btDbvtVolume& a, const btDbvtVolume& b) {
    return are_within(a.Mins(), b.Maxs(), b.Mins(), a.Maxs());
}
inline bool contains(const btDbvtVolume& whole, const btDbvtVolume& part) {
    return are_within(whole.Mins(), part.Mins(), part.Maxs(), whole.Maxs());
}

// Goes through what is below some nodes, for the boxes of several leaves at once. Breadth first, so that processors
// work on several nodes at once; where more wait than there is room for, one is gone through by itself.
template <class Found>
class Descent {
public:
    explicit Descent(Found& found) : found_(found) {}

    // Looks for what is at or below a node and meets the box of the leaf that asks.
    void begin_at(const btDbvtNode* node, const btDbvtNode* asks) {
        if (end_ - begin_ < kRoom) {
            waiting_[end_ % kRoom] = {node, asks};
            end_ += meet(node->volume, asks->volume);
        } else if (meet(node->volume, asks->volume)) {
            Descent apart(found_);
            apart.begin_at(node, asks);
            apart.run();
        }
    }
    // Calls found(id that asks, id) for each.
    void run() {
        while (begin_ < end_) {
            const auto [node, asks] = waiting_[begin_++ % kRoom];
            if (node->isleaf())
                found_(uint32_t(asks->dataAsInt), uint32_t(node->dataAsInt));
            else
                for (const btDbvtNode* const child : node->childs) begin_at(child, asks);
        }
    }

private:
    static constexpr uint32_t kRoom = 256;
    struct Waiting {
        const btDbvtNode *node, *asks;
    };

    Found& found_;
    Waiting waiting_[kRoom];  // a ring; whose boxes meet
    uint32_t begin_ = 0, end_ = 0;
};

}  // namespace taut::collision
