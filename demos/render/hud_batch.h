// Turns the HUD's rectangles and texts into triangles and draws them.
#pragma once

#include <epoxy/gl.h>

#include <vector>

#include "draw_list.h"
#include "font.h"
#include "program.h"

namespace render {

class HudBatch {
public:
    HudBatch(int width, int height);
    ~HudBatch();
    HudBatch(const HudBatch&) = delete;
    HudBatch& operator=(const HudBatch&) = delete;

    void draw(const DrawList& list);

private:
    struct Corner {
        float pixel[2], inside[2], tint[4], form[4];
    };
    void add_rect(const HudRect& rect);
    void add_text(const HudText& text);
    void add_quad(const Corner (&corners)[4]);

    int width_, height_;
    float scale_;  // pixels of a unit of the canvas
    Program program_;
    GLuint array_ = 0, buffer_ = 0;
    struct Font {
        float cap_height;
        FontImage image;
        GLuint texture;
    };
    size_t font_of(float cap_height);

    std::vector<Font> fonts_;
    std::vector<Corner> corners_;
};

}  // namespace render
