#include "track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scenes {

namespace {

TrackPoint on_keys(const std::vector<Track::Key>& keys, double time) {
    if (keys.empty()) return {};
    if (time <= keys.front().time) return {keys.front().value, 0};
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time, [](double t, const Track::Key& key) { return t < key.time; });
    const Track::Key& a = *(next - 1);
    if (next == keys.end()) return {a.value + a.rate * (time - a.time), a.rate};
    // Hermite's cubic between two keys.
    const double span = next->time - a.time, s = (time - a.time) / span, rise = next->value - a.value;
    const double da = a.rate * span, db = next->rate * span, c2 = 3 * rise - 2 * da - db, c3 = da + db - 2 * rise;
    return {a.value + s * (da + s * (c2 + s * c3)), (da + s * (2 * c2 + s * 3 * c3)) / span};
}

TrackPoint smooth_step(double s) {
    if (s <= 0) return {0, 0};
    if (s >= 1) return {1, 0};
    return {s * s * (3 - 2 * s), 6 * s * (1 - s)};
}

TrackPoint on_shake(const Track::Shake& shake, double time) {
    if (shake.amplitude == 0 || time <= shake.begin || time >= shake.end) return {};
    const double w = 2 * std::numbers::pi * shake.frequency, t = time - shake.begin;
    const TrackPoint in = smooth_step(t * shake.frequency), out = smooth_step((shake.end - time) * shake.frequency);
    const double swell = in.value * out.value,
                 swell_rate = shake.frequency * (in.rate * out.value - in.value * out.rate);
    return {shake.amplitude * swell * std::sin(w * t),
            shake.amplitude * (swell_rate * std::sin(w * t) + swell * w * std::cos(w * t))};
}

}  // namespace

TrackPoint at(const Track& track, double time) {
    const TrackPoint a = on_keys(track.keys, time), b = on_shake(track.shake, time);
    return {a.value + b.value, a.rate + b.rate};
}

}  // namespace scenes
