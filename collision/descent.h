// Which leaves of Bullet's tree of boxes meet those of others.
#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "collision/lane_kernels.h"

namespace taut::collision {

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
