// What a track says at a time.
#pragma once

#include "scene.h"

namespace scenes {

struct TrackPoint {
    double value = 0, rate = 0;  // [unit], [unit/s]
};

TrackPoint at(const Track& track, double time);

}  // namespace scenes
