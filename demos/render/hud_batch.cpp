#include "hud_batch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "shaders.h"

namespace render {

namespace {

void blend(float (&tint)[4], Colour colour, float alpha) {
    tint[0] = colour.x, tint[1] = colour.y, tint[2] = colour.z, tint[3] = alpha;
}

GLuint upload(const FontImage& image) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, image.width, image.height, 0, GL_RED, GL_UNSIGNED_BYTE,
                 image.coverage.data());
    for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    return texture;
}

}  // namespace

HudBatch::HudBatch(int width, int height)
    : width_(width),
      height_(height),
      scale_(HudCanvas(width, height).scale),
      program_({shaders::kHudVertex}, {shaders::kHudFragment}) {
    glGenVertexArrays(1, &array_);
    glGenBuffers(1, &buffer_);
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    const struct {
        GLint count;
        size_t offset;
    } fields[] = {{2, offsetof(Corner, pixel)},
                  {2, offsetof(Corner, inside)},
                  {4, offsetof(Corner, tint)},
                  {4, offsetof(Corner, form)}};
    for (GLuint i = 0; i < 4; ++i) {
        glEnableVertexAttribArray(i);
        glVertexAttribPointer(i, fields[i].count, GL_FLOAT, GL_FALSE, sizeof(Corner),
                              reinterpret_cast<const void*>(fields[i].offset));
    }
}

HudBatch::~HudBatch() {
    for (Font& font : fonts_) glDeleteTextures(1, &font.texture);
    glDeleteBuffers(1, &buffer_);
    glDeleteVertexArrays(1, &array_);
}

size_t HudBatch::font_of(float cap_height) {
    for (size_t i = 0; i < fonts_.size(); ++i)
        if (fonts_[i].cap_height == cap_height) return i;
    FontImage image = draw_font(std::max(5.0f, cap_height * scale_));
    GLuint texture = upload(image);
    fonts_.push_back({cap_height, std::move(image), texture});
    return fonts_.size() - 1;
}

void HudBatch::add_quad(const Corner (&c)[4]) { corners_.insert(corners_.end(), {c[0], c[1], c[2], c[0], c[2], c[3]}); }

void HudBatch::add_rect(const HudRect& rect) {
    float half[2] = {0.5f * rect.width * scale_, 0.5f * rect.height * scale_};
    float middle[2] = {rect.x * scale_ + half[0], rect.y * scale_ + half[1]};
    Corner corners[4];
    for (int i = 0; i < 4; ++i) {
        float sx = i == 1 || i == 2 ? 1.0f : -1.0f, sy = i >= 2 ? 1.0f : -1.0f;
        // One pixel more on each side, for the soft edge.
        corners[i].inside[0] = sx * (half[0] + 1), corners[i].inside[1] = sy * (half[1] + 1);
        for (int k = 0; k < 2; ++k) corners[i].pixel[k] = middle[k] + corners[i].inside[k];
        blend(corners[i].tint, sx < 0 ? rect.left : rect.right, rect.alpha);
        corners[i].form[0] = half[0], corners[i].form[1] = half[1];
        corners[i].form[2] = rect.radius * scale_, corners[i].form[3] = 0;
    }
    add_quad(corners);
}

void HudBatch::add_text(const HudText& text) {
    const FontImage& font = fonts_[font_of(text.cap_height)].image;
    float pen = std::round(text.x * scale_), top = std::round(text.y * scale_);
    for (char c : text.text) {
        int glyph = c - kFirstGlyph;
        if (glyph < 0 || glyph >= kGlyphs) glyph = '?' - kFirstGlyph;
        Corner corners[4];
        for (int i = 0; i < 4; ++i) {
            float u = i == 1 || i == 2 ? 1.0f : 0.0f, v = i >= 2 ? 1.0f : 0.0f;
            float cell[2] = {static_cast<float>(font.cell_width), static_cast<float>(font.cell_height)};
            corners[i].pixel[0] = std::round(pen) - font.origin_x + u * cell[0];
            corners[i].pixel[1] = top - font.origin_y + v * cell[1];
            corners[i].inside[0] =
                (static_cast<float>(glyph % kGlyphColumns) + u) * cell[0] / static_cast<float>(font.width);
            corners[i].inside[1] =
                (static_cast<float>(glyph / kGlyphColumns) + v) * cell[1] / static_cast<float>(font.height);
            blend(corners[i].tint, text.colour, text.alpha);
            corners[i].form[0] = corners[i].form[1] = corners[i].form[2] = 0, corners[i].form[3] = 1;
        }
        add_quad(corners);
        pen += font.advance;
    }
}

void HudBatch::draw(const DrawList& list) {
    if (list.rects.empty() && list.texts.empty()) return;
    struct Run {
        GLint first;
        GLuint texture;
    };
    corners_.clear();
    std::vector<Run> runs = {{0, 0}};
    for (const HudRect& rect : list.rects) add_rect(rect);
    for (const HudText& text : list.texts) {
        GLuint texture = fonts_[font_of(text.cap_height)].texture;
        if (runs.back().texture != texture) runs.push_back({static_cast<GLint>(corners_.size()), texture});
        add_text(text);
    }
    runs.push_back({static_cast<GLint>(corners_.size()), 0});
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.use();
    program_.set("size", static_cast<float>(width_), static_cast<float>(height_));
    program_.set("glyphs", 0);
    glActiveTexture(GL_TEXTURE0);
    glBindVertexArray(array_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners_.size() * sizeof(Corner)), corners_.data(),
                 GL_STREAM_DRAW);
    for (size_t i = 0; i + 1 < runs.size(); ++i) {
        if (runs[i].texture) glBindTexture(GL_TEXTURE_2D, runs[i].texture);
        glDrawArrays(GL_TRIANGLES, runs[i].first, runs[i + 1].first - runs[i].first);
    }
    glDisable(GL_BLEND);
}

}  // namespace render
