// A font drawn once into a coverage texture.
#pragma once

#include <cstdint>
#include <vector>

namespace render {

constexpr int kFirstGlyph = 32, kGlyphs = 95;  // printable ASCII
constexpr int kGlyphColumns = 16;
constexpr float kGlyphAdvance = 0.83f;  // of DejaVu Sans Mono, of the height of capitals

// Coverage image of all glyphs in cells of equal size, row by row.
struct FontImage {
    int cell_width = 0, cell_height = 0;  // [pixels]
    int width = 0, height = 0;
    float origin_x = 0, origin_y = 0;  // of the pen and the top of capitals inside a cell
    float advance = 0;                 // from one character to the next
    std::vector<uint8_t> coverage;     // width * height, top row first
};

// Capitals are cap_height pixels high. Throws std::runtime_error where the font's file is missing.
FontImage draw_font(float cap_height);

}  // namespace render
