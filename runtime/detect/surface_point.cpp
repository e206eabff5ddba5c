#include "detect/surface_point.h"

#include <algorithm>

namespace taut {

SurfaceSide side_of(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const SurfaceContact& contact,
                    float sign) {
    SurfaceSide side;
    bool on_surface = false;  // where a lever ends; vertices are within, half the thickness away
    float most = 0;
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const uint32_t node = contact.node[i];
        const float weight = sign * contact.weight[i];
        if (node == kNone || !(weight > 0)) continue;
        const NodeMotion& m = nodes.motion[node];
        const Quat turn = m.q * nodes.before[node].rotation.conjugate();
        const Vec3 lever = i == 0 ? Vec3(turn * contact.lever.cast<double>()) : Vec3(Vec3::Zero());
        on_surface = on_surface || lever != Vec3::Zero();
        side.at += static_cast<double>(weight) * (m.x + lever);
        sum += static_cast<double>(weight);
        if (weight > most) side.node = node;
        most = std::max(most, weight);
    }
    if (sum > 0) side.at /= sum;
    const uint32_t collider = contact.collider[sign > 0 ? 0 : 1];
    if (on_surface || !colliders.ids.live(collider)) return side;
    const double radius = collision::ball_radius(shapes[colliders.record[collider].shape].shape);
    side.at -= static_cast<double>(sign) * radius * contact.normal.cast<double>();
    return side;
}

float closing_speed(const Nodes& nodes, const SurfaceContact& contact) {
    float speed = 0;
    for (int i = 0; i < 4; ++i) {
        if (contact.node[i] == kNone) continue;
        const NodeMotion& m = nodes.motion[contact.node[i]];
        Vec3f v = m.v.cast<float>();
        if (i == 0) v += m.w.cast<float>().cross(contact.lever);
        speed -= contact.weight[i] * contact.normal.dot(v);
    }
    return speed;
}

bool is_awake(const Nodes& nodes, const SurfaceContact& contact) {
    return std::ranges::any_of(contact.node, [&](uint32_t node) {
        return node != kNone && nodes.info[node].kind != NodeKind::fixed && nodes.rest[node] == Rest::awake;
    });
}

}  // namespace taut
