// What a picture consists of. The renderer knows nothing of physics: whoever fills this list does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "matrix.h"

namespace render {

// Linear light, each channel in [0, 1].
using Colour = Vec3;

// From the 0xRRGGBB of a colour picker (sRGB) to linear light.
inline Colour from_srgb(uint32_t rgb) {
    auto channel = [](uint32_t byte) {
        float s = static_cast<float>(byte & 255u) / 255.0f;
        return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
    };
    return {channel(rgb >> 16), channel(rgb >> 8), channel(rgb)};
}

struct Camera {
    Vec3 eye{8, 5, 10};
    Vec3 target{0, 1, 0};
    float vertical_fov = 0.7f;  // [rad]
};

// Pictures begin at a hundredth of the distance of what is looked at [m].
inline float near_plane(const Camera& camera) { return 0.01f * length(camera.eye - camera.target); }

// Meshes that always exist; add_mesh() returns further ones.
enum BuiltinMesh : uint32_t {
    kMeshBox,
    kMeshSphere,
    kMeshDot,       // a coarse sphere, for thousands of small ones
    kMeshCylinder,  // of 16 sides, for links and pins
    kMeshDrum,      // a fine one
};

// How an instance is drawn.
enum class Pass : uint8_t {
    solid,    // lit, throws and receives shadows
    ghost,    // lit, seen through, throws none
    overlay,  // unlit, pulled towards the viewer so that points inside touching bodies stay visible
};

// One mesh placed in the world. Builtin meshes (the cylinder along y) reach from -1 to 1.
struct Instance {
    Vec3 position;        // [m]
    Vec3 scale{1, 1, 1};  // half size along each local axis [m]
    Quat rotation;
    Colour colour{0.5f, 0.5f, 0.5f};
    float gloss = 0.25f;  // strength of the highlight, [0, 1]
    uint32_t mesh = kMeshBox;
    Pass pass = Pass::solid;
};

// Corner of a triangle of a surface that changes from picture to picture.
struct SurfaceVertex {
    Vec3 position, normal;
    Colour colour;
    float gloss = 0.1f;
};

// Rectangle or text over the picture, in units of the canvas, y down.
struct HudRect {
    float x = 0, y = 0, width = 0, height = 0, radius = 0;
    Colour left, right;  // blends from left to right
    float alpha = 1;
};
struct HudText {
    float x = 0, y = 0;  // left end, top of capitals
    float cap_height = 11;
    std::string text;
    Colour colour{1, 1, 1};
    float alpha = 1;
};

// The HUD's units: pixels of a 1280x720 picture, enlarged with it, and a little larger in small ones.
struct HudCanvas {
    HudCanvas(int picture_width, int picture_height)
        : scale(std::fmax(0.6f, std::fmin(static_cast<float>(picture_width) / 1280.0f,
                                          static_cast<float>(picture_height) / 720.0f))),
          width(static_cast<float>(picture_width) / scale),
          height(static_cast<float>(picture_height) / scale) {}

    float scale, width, height;
};

struct DrawList {
    Camera camera;
    std::vector<Instance> instances;
    std::vector<SurfaceVertex> surfaces;  // three a triangle, counter-clockwise seen from outside, lit like solids
    std::vector<HudRect> rects;           // below the texts, in order
    std::vector<HudText> texts;

    void clear() {
        instances.clear();
        surfaces.clear();
        rects.clear();
        texts.clear();
    }
};

// What stays for many pictures: the box that the sun's shadow map is fitted to, and the ground.
struct Stage {
    Vec3 low{-10, 0, -10}, high{10, 10, 10};  // [m]
    float ground_height = 0;                  // [m]
    bool ground = true;                       // there is one

    void include(Vec3 a, Vec3 b) {
        low = {std::fmin(low.x, a.x), std::fmin(low.y, a.y), std::fmin(low.z, a.z)};
        high = {std::fmax(high.x, b.x), std::fmax(high.y, b.y), std::fmax(high.z, b.z)};
    }
};

}  // namespace render
