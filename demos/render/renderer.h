// Draws a DrawList into memory: sun with a filtered shadow map, sky light, ground grid, fog, text.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "draw_list.h"
#include "mesh.h"

namespace render {

struct RendererOptions {
    int width = 1280, height = 720;
    int samples = 4;
    int shadow_size = 2048;
};

// One picture, rows from the top, three bytes a pixel (sRGB).
struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

class Renderer {
public:
    // Throws NoEglDevice, or std::runtime_error with the driver's words.
    explicit Renderer(const RendererOptions& options);
    ~Renderer();

    // Lines that tell what draws: renderer, version, samples, software or not.
    std::string description() const;
    std::string gl_renderer() const;
    int samples() const;
    bool software() const;

    uint32_t add_mesh(const std::vector<Vertex>& mesh);
    void set_stage(const Stage& stage);
    const Picture& draw(const DrawList& list);

private:
    struct Inside;
    std::unique_ptr<Inside> inside_;
};

}  // namespace render
