#include "peer.h"

#include <array>
#include <cstring>
#include <numbers>

namespace bench {

namespace {

double volume_of(const scenes::Shape& shape) {
    double r = static_cast<double>(shape.radius);
    if (shape.kind == scenes::ShapeKind::box)
        return 8.0 * static_cast<double>(shape.half_extents.x) * static_cast<double>(shape.half_extents.y) *
               static_cast<double>(shape.half_extents.z);
    double ball = 4.0 / 3.0 * std::numbers::pi * r * r * r;
    return shape.kind == scenes::ShapeKind::sphere
               ? ball
               : ball + 2 * std::numbers::pi * r * r * static_cast<double>(shape.half_length);
}

}  // namespace

double mass_of(const scenes::Scene& scene, const scenes::Body& body) {
    if (body.mass > 0) return static_cast<double>(body.mass);
    return static_cast<double>(body.density) * volume_of(scene.shapes[static_cast<size_t>(body.shape)]);
}

uint64_t hash_of_motions(const Engine& engine, size_t bodies) {
    uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a over poses and velocities
    for (size_t i = 0; i < bodies; ++i) {
        Motion m = engine.motion(i);
        std::array<float, 13> values = {static_cast<float>(m.position.x),
                                        static_cast<float>(m.position.y),
                                        static_cast<float>(m.position.z),
                                        m.rotation.x,
                                        m.rotation.y,
                                        m.rotation.z,
                                        m.rotation.w,
                                        m.linear_velocity.x,
                                        m.linear_velocity.y,
                                        m.linear_velocity.z,
                                        m.angular_velocity.x,
                                        m.angular_velocity.y,
                                        m.angular_velocity.z};
        std::array<unsigned char, sizeof values> bytes;
        std::memcpy(bytes.data(), values.data(), bytes.size());
        for (unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
    }
    return hash;
}

}  // namespace bench
