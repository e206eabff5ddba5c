// Which leaves of Bullet's tree of boxes meet those of others.
#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "collision/lane_kernels.h"

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

inline bool contains(const btDbvtVolume& whole, const btDbvtVolume& part) {
    return are_within(whole.Mins(), part.Mins(), part.Maxs(), whole.Maxs());
}

// Goes through a tree for the boxes of several leaves at once. Breadth first, so that processors work on several nodes
// at once; where more wait than there is room for, one is gone through by itself.
template <class Found>
class Descent {
public:
    Descent(const BoxLanes& boxes, Found& found) : boxes_(boxes), found_(found), meeting_(lane_kernels().meeting) {}

    // Looks at or below a node for what meets some of the boxes, a bit each.
    void begin_at(const btDbvtNode* node, unsigned boxes) {
        const unsigned met = boxes & meeting_(boxes_, node->volume.Mins().m_floats, node->volume.Maxs().m_floats);
        if (end_ - begin_ < kRoom) {
            waiting_[end_ % kRoom] = {node, met};
            end_ += met != 0;
        } else if (met != 0) {
            Descent apart(boxes_, found_);
            apart.begin_at(node, met);
            apart.run();
        }
    }
    // Calls found(boxes, id) for each leaf that some meet.
    void run() {
        while (begin_ < end_) {
            const auto [node, boxes] = waiting_[begin_++ % kRoom];
            if (node->isleaf())
                found_(boxes, uint32_t(node->dataAsInt));
            else
                for (const btDbvtNode* const child : node->childs) begin_at(child, boxes);
        }
    }

private:
    static constexpr uint32_t kRoom = 256;
    struct Waiting {
        const btDbvtNode* node;
        unsigned boxes;  // that meet it
    };

    const BoxLanes& boxes_;
    Found& found_;
    unsigned (*const meeting_)(const BoxLanes&, const float*, const float*);
    Waiting waiting_[kRoom];  // a ring
    uint32_t begin_ = 0, end_ = 0;
};

}  // namespace taut::collision
