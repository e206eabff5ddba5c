// Which boxes of Bullet's tree a probe comes by, and in which order it asks them.
#pragma once

#include <algorithm>
#include <cmath>

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include "collision/collide.h"

namespace taut::collision {

// Asks boxes by the slabs between their sides: the probe is between two of them from fraction (lo - from) / along on.
class Slabs {
public:
    explicit Slabs(const Probe& probe) : stays_(probe.along == Vec3::Zero()) {
        constexpr double kParallel = 1e-200;  // such a way crosses no side, and 0 / along is 0
        for (int i = 0; i < 3; ++i)
            inverse_[i] = 1 / (std::fabs(probe.along[i]) > kParallel ? probe.along[i] : kParallel);
    }

    bool meets(const Probe& probe, const btDbvtVolume& volume) const {
        double enter = 0, exit = probe.limit;
        for (int i = 0; i < 3; ++i) {
            const double lo = double(volume.Mins()[i]) - probe.from[i] - probe.hi[i] - probe.reach;
            const double hi = double(volume.Maxs()[i]) - probe.from[i] - probe.lo[i] + probe.reach;
            const double one = lo * inverse_[i], other = hi * inverse_[i];
            enter = std::max(enter, std::min(one, other));
            exit = std::min(exit, std::max(one, other));
        }
        return enter <= exit;
    }

    // Which child to visit first: the one that the way comes by first, or that is nearer.
    int first(const Probe& probe, const btDbvtNode* node) const {
        return order(probe, node->childs[0]) <= order(probe, node->childs[1]) ? 0 : 1;
    }

private:
    double order(const Probe& probe, const btDbvtNode* node) const {
        const btVector3 &lo = node->volume.Mins(), &hi = node->volume.Maxs();
        const Vec3 middle = 0.5 * (Vec3(lo.x(), lo.y(), lo.z()) + Vec3(hi.x(), hi.y(), hi.z())) - probe.from;
        return stays_ ? middle.squaredNorm() : probe.along.dot(middle);
    }

    bool stays_;
    Vec3 inverse_;
};

// Asks which boxes one overlaps that stays where it is; whichever comes first.
class Overlap {
public:
    explicit Overlap(const Probe& probe) : lo_(probe.from + probe.lo), hi_(probe.from + probe.hi) {}

    bool meets(const Probe& probe, const btDbvtVolume& volume) const {
        if (!(probe.limit >= 0)) return false;
        for (int i = 0; i < 3; ++i)
            if (!(double(volume.Mins()[i]) <= hi_[i] && double(volume.Maxs()[i]) >= lo_[i])) return false;
        return true;
    }
    int first(const Probe&, const btDbvtNode*) const { return 0; }

private:
    Vec3 lo_, hi_;
};

}  // namespace taut::collision
