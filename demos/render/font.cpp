// Glyphs of DejaVu Sans Mono by FreeType. All are as wide, so that figures do not move as they change.
#include "font.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace render {

namespace {

constexpr float kCapHeight = 0.729f;    // of DejaVu Sans Mono, of its size
constexpr int kBelow = 3, kMargin = 1;  // a descender's share of the size is 1 / kBelow at most; pixels about a glyph

using Library = std::unique_ptr<std::remove_pointer_t<FT_Library>, FT_Error (*)(FT_Library)>;
using Face = std::unique_ptr<std::remove_pointer_t<FT_Face>, FT_Error (*)(FT_Face)>;

Library open_library() {
    FT_Library library = nullptr;
    if (FT_Init_FreeType(&library) != 0) throw std::runtime_error("FreeType does not start");
    return {library, FT_Done_FreeType};
}

Face open_face(const Library& library) {
    FT_Face face = nullptr;
    if (FT_New_Face(library.get(), TAUT_DEMO_FONT, 0, &face) != 0)
        throw std::runtime_error(std::string("cannot read the font ") + TAUT_DEMO_FONT +
                                 " (Debian: fonts-dejavu-core)");
    return {face, FT_Done_Face};
}

}  // namespace

FontImage draw_font(float cap_height) {
    const Library library = open_library();
    const Face face = open_face(library);
    const float size = cap_height / kCapHeight;  // [pixels]
    if (FT_Set_Char_Size(face.get(), 0, static_cast<FT_F26Dot6>(std::lround(64 * size)), 72, 72) != 0)
        throw std::runtime_error("FreeType does not take the size of the font");
    FontImage image;
    const int tall = static_cast<int>(std::ceil(size)), wide = static_cast<int>(std::ceil(cap_height));
    const int above = tall - static_cast<int>(cap_height);  // brackets reach over capitals
    image.origin_x = kMargin;
    image.origin_y = static_cast<float>(kMargin + above);
    image.advance = kGlyphAdvance * cap_height;
    image.cell_width = wide + 2 * kMargin;
    image.cell_height = tall + tall / kBelow + 2 * kMargin;
    image.width = image.cell_width * kGlyphColumns;
    image.height = image.cell_height * ((kGlyphs + kGlyphColumns - 1) / kGlyphColumns);
    image.coverage.assign(static_cast<size_t>(image.width) * static_cast<size_t>(image.height), 0);
    const int base = kMargin + above + static_cast<int>(std::lround(cap_height));
    for (int glyph = 0; glyph < kGlyphs; ++glyph) {
        if (FT_Load_Char(face.get(), static_cast<FT_ULong>(kFirstGlyph + glyph),
                         FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0)
            throw std::runtime_error("FreeType does not draw a character");
        const FT_GlyphSlot drawn = face->glyph;
        const int left = glyph % kGlyphColumns * image.cell_width, top = glyph / kGlyphColumns * image.cell_height;
        for (int y = 0; y < static_cast<int>(drawn->bitmap.rows); ++y)
            for (int x = 0; x < static_cast<int>(drawn->bitmap.width); ++x) {
                const int column = kMargin + drawn->bitmap_left + x, row = base - drawn->bitmap_top + y;
                if (column < 0 || column >= image.cell_width || row < 0 || row >= image.cell_height) continue;
                image.coverage[static_cast<size_t>((top + row) * image.width + left + column)] =
                    drawn->bitmap.buffer[y * drawn->bitmap.pitch + x];
            }
    }
    return image;
}

}  // namespace render
