// What shows a shape: the lines of its edges and the triangles of its faces, in its own frame. A round shape is a
// profile that turns about y: its lines are circles where the profile bends, and four meridians.
#pragma once

#include "collision/collide.h"

namespace taut::collision {

class LineSink {
public:
    virtual void take(const Vec3f& from, const Vec3f& to) = 0;

protected:
    ~LineSink() = default;
};

// near: of surfaces, triangles whose boxes do not meet it are left out. A plane is a square of 20 m and its normal.
void outline(const Shape& shape, const Box& near, LineSink& lines);
void triangles_of(const Shape& shape, const Box& near, PointSink& points);

}  // namespace taut::collision
