// Which leaves of Bullet's tree of boxes meet a box.
#pragma once

#include <cstdint>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

namespace taut::collision {

// Without branches: of the boxes that a descent asks, every other one is met.
inline bool meet(const btDbvtVolume& a, const btDbvtVolume& b) {
    const btVector3 &a_lo = a.Mins(), &a_hi = a.Maxs(), &b_lo = b.Mins(), &b_hi = b.Maxs();
    const int x = int(a_lo.x() <= b_hi.x()) & int(b_lo.x() <= a_hi.x());
    const int y = int(a_lo.y() <= b_hi.y()) & int(b_lo.y() <= a_hi.y());
    const int z = int(a_lo.z() <= b_hi.z()) & int(b_lo.z() <= a_hi.z());
    return (x & y & z) != 0;
}

// Goes through what is below some nodes. Breadth first, so that processors work on several nodes at once; where more
// wait than there is room for, one is gone through by itself.
template <class Found>
class Descent {
public:
    Descent(const btDbvtVolume& volume, Found& found) : volume_(volume), found_(found) {}

    void begin_at(const btDbvtNode* node) {
        if (end_ - begin_ < kRoom) {
            waiting_[end_ % kRoom] = node;
            end_ += meet(node->volume, volume_);
        } else if (meet(node->volume, volume_)) {
            Descent apart(volume_, found_);
            apart.begin_at(node);
            apart.run();
        }
    }
    // Calls found(id) for each.
    void run() {
        while (begin_ < end_) {
            const btDbvtNode* const node = waiting_[begin_++ % kRoom];
            if (node->isleaf())
                found_(uint32_t(node->dataAsInt));
            else
                for (const btDbvtNode* const child : node->childs) begin_at(child);
        }
    }

private:
    static constexpr uint32_t kRoom = 128;

    const btDbvtVolume& volume_;
    Found& found_;
    const btDbvtNode* waiting_[kRoom];  // a ring; whose boxes meet it
    uint32_t begin_ = 0, end_ = 0;
};

}  // namespace taut::collision
