// Stroke font of our own, drawn once into a coverage texture.
#pragma once

#include <cstdint>
#include <vector>

namespace render {

constexpr int kFirstGlyph = 32, kGlyphs = 95;  // printable ASCII
constexpr int kGlyphColumns = 16;

// Coverage image of all glyphs in cells of equal size, row by row.
struct FontImage {
    int cell_width = 0, cell_height = 0;  // [pixels]
    int width = 0, height = 0;
    float origin_x = 0, origin_y = 0;  // of the glyph's left end and top of capitals inside its cell
    float advance = 0;                 // from one character to the next
    std::vector<uint8_t> coverage;     // width * height, top row first
};

// Capitals are cap_height pixels high.
FontImage draw_font(float cap_height);

}  // namespace render
