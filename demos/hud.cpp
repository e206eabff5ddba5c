#include "hud.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <vector>

namespace demo {

namespace {

using render::Colour;
using render::from_srgb;

const Colour kPanel = from_srgb(0x10161F), kWhite = from_srgb(0xFFFFFF), kDim = from_srgb(0xAEBBCB);
const Colour kTrack = from_srgb(0x33404F), kGood = from_srgb(0x4FC28B), kBusy = from_srgb(0xF3A712),
             kLate = from_srgb(0xE4572E);
constexpr float kPanelAlpha = 0.88f, kRadius = 8, kMargin = 16, kPadding = 16;
constexpr float kTitle = 15, kText = 10;  // heights of capitals
constexpr float kAdvance = 1.02f;         // width of a character, of its height

[[gnu::format(printf, 1, 2)]] std::string text_of(const char* format, ...) {
    char buffer[160];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    return buffer;
}

// "1 kN"; powers of ten beyond the usual prefixes stay powers of ten.
std::string newtons(int decade) {
    static const char* const prefixes[] = {"", "k", "M", "G"};
    if (decade < 0 || decade > 11) return text_of("1e%d N", decade);
    static const int ones[] = {1, 10, 100};
    return text_of("%d %sN", ones[decade % 3], prefixes[decade / 3]);
}

// "12.3 um", in the unit that suits.
std::string distance_of(double metres) {
    if (metres < 1e-8) return text_of("%.2g nm", metres * 1e9);
    if (metres < 1e-6) return text_of("%.0f nm", metres * 1e9);
    if (metres < 1e-4) return text_of("%.1f um", metres * 1e6);
    if (metres < 0.1) return text_of("%.2f mm", metres * 1e3);
    if (metres < 1e3) return text_of("%.2f m", metres);
    return text_of("%.0e m", metres);
}

}  // namespace

void add_hud(render::DrawList& list, const HudFigures& f) {
    constexpr float kLine = 19;
    float x = kMargin + kPadding, y = kMargin + kPadding;
    std::string counts = text_of("%u bodies  %u joints  %u contacts", f.bodies, f.joints, f.points);
    if (f.broken > 0) counts += text_of("  %zu broken", f.broken);
    const size_t longest = std::max(f.description.size() * 8, counts.size() * static_cast<size_t>(kText));
    float width = std::max(396.0f, static_cast<float>(longest) * kAdvance + 2 * kPadding);
    float height = kTitle + 14 + 8 + 16 + 2 * kLine + 16 + (f.has_joints ? 2 : 1) * kLine + 2 * kPadding - 6;
    list.rects.push_back({kMargin, kMargin, width, height, kRadius, kPanel, kPanel, kPanelAlpha});
    auto line = [&](std::string text, float cap, Colour colour, float step) {
        list.texts.push_back({x, y, cap, std::move(text), colour, 1});
        y += step;
    };
    line(f.scene, kTitle, kWhite, kTitle + 14);
    line(f.description, 8, kDim, 8 + 16);
    line(text_of("frame %u/%u   t = %.2f s", f.frame, f.frames, f.time), kText, kWhite, kLine);
    line(text_of("step %.2f ms of %.2f ms", f.step_ms, f.budget_ms), kText, kWhite, kLine - 2);
    float full = width - 2 * kPadding, share = static_cast<float>(std::clamp(f.step_ms / f.budget_ms, 0.0, 1.0));
    Colour bar = f.step_ms > f.budget_ms ? kLate : f.step_ms > 0.5 * f.budget_ms ? kBusy : kGood;
    list.rects.push_back({x, y, full, 7, 3.5f, kTrack, kTrack, 1});
    list.rects.push_back({x, y, std::max(7.0f, full * share), 7, 3.5f, bar, bar, 1});
    y += 18;
    if (f.has_joints)
        line("joint error " + distance_of(f.joint_error) + ", worst " + distance_of(f.worst_joint_error), kText, kWhite,
             kLine);
    line(counts, kText, kDim, kLine);
}

void add_caption(render::DrawList& list, const Caption& caption, float centre, const render::HudCanvas& canvas) {
    constexpr float kWidth = 330, kHeight = 62;
    const float left = centre - kWidth / 2, top = canvas.height - 2 * kMargin - 66 - kHeight;  // above the legend
    list.rects.push_back({left, top, kWidth, kHeight, kRadius, kPanel, kPanel, kPanelAlpha});
    list.texts.push_back({left + kPadding, top + 14, 11, caption.text, kWhite, 1});
    list.texts.push_back(
        {left + kPadding, top + 38, kText, "joint error " + distance_of(caption.joint_error), kDim, 1});
}

namespace {

constexpr float kLegendWidth = 372, kLegendHeight = 66;

struct Mark {
    float at;  // along the scale, [0, 1]
    std::string label;
};

// A panel with a scale, from blue to red.
void add_scale(render::DrawList& list, float left, float top, const std::string& title,
               const std::vector<Mark>& marks) {
    constexpr float kBar = 12;
    constexpr int kSpans = 15;
    const float x = left + kPadding, full = kLegendWidth - 2 * kPadding;
    list.rects.push_back({left, top, kLegendWidth, kLegendHeight, kRadius, kPanel, kPanel, kPanelAlpha});
    list.texts.push_back({x, top + 12, kText, title, kWhite, 1});
    for (int i = 0; i < kSpans; ++i) {
        const float a = static_cast<float>(i) / kSpans, b = static_cast<float>(i + 1) / kSpans;
        list.rects.push_back({x + a * full - 0.5f, top + 30, (b - a) * full + 1, kBar, 0, TensionScale::ramp(a),
                              TensionScale::ramp(b), 1});
    }
    for (const Mark& mark : marks) {
        const float half = 0.5f * 8 * kAdvance * static_cast<float>(mark.label.size());
        const float from = std::clamp(x + full * mark.at - half, x - 4, x + full + 4 - 2 * half);
        list.texts.push_back({from, top + 49, 8, mark.label, kDim, 1});
    }
}

std::string pascals(double value) {
    if (value >= 1e6) return text_of("%.3g MPa", 1e-6 * value);
    if (value >= 1e3) return text_of("%.3g kPa", 1e-3 * value);
    return text_of("%.3g Pa", value);
}

}  // namespace

void add_soft_legend(render::DrawList& list, const scenes::Scene& scene, const render::HudCanvas& canvas) {
    constexpr int kMarks = 5;
    const float left = canvas.width - kMargin - kLegendWidth;
    float top = canvas.height - kMargin;
    std::vector<std::string> shown;
    const auto show_scale = [&](const char* what, double most, const auto& text) {
        std::vector<Mark> marks;
        for (int i = 0; i < kMarks; ++i)
            marks.push_back({static_cast<float>(i) / (kMarks - 1), text(most * i / (kMarks - 1))});
        const std::string all = what + marks.back().label;
        if (std::find(shown.begin(), shown.end(), all) != shown.end()) return;
        shown.push_back(all);
        top -= kLegendHeight;
        add_scale(list, left, top, what, marks);
        top -= kMargin / 2;
    };
    for (const scenes::Cloth& cloth : scene.cloths)
        if (cloth.look.colours == scenes::SoftColours::strain)
            show_scale("strain", cloth.look.most, [](double v) { return text_of("%.3g %%", 100 * v); });
    for (const scenes::Solid& solid : scene.solids)
        if (solid.look.colours == scenes::SoftColours::stress)
            show_scale("stress, von Mises", solid.look.most, pascals);
    const auto show_label = [&](const scenes::SoftLook& look) {
        constexpr float kHeight = 28;
        if (look.label.empty()) return;
        const Colour colour = from_srgb(look.paint);
        top -= kHeight;
        list.rects.push_back({left, top, kLegendWidth, kHeight, kRadius, kPanel, kPanel, kPanelAlpha});
        if (look.colours == scenes::SoftColours::plain)
            list.rects.push_back({left + kPadding, top + 8, 22, 12, 3, colour, colour, 1});
        list.texts.push_back({left + kPadding + 34, top + 9, kText, look.label, kWhite, 1});
        top -= 4;
    };
    for (size_t i = scene.cloths.size(); i-- > 0;) show_label(scene.cloths[i].look);
    for (size_t i = scene.solids.size(); i-- > 0;) show_label(scene.solids[i].look);
}

void add_tension_legend(render::DrawList& list, const TensionScale& scale, const render::HudCanvas& canvas) {
    const int decades = scale.high_decade() - scale.low_decade(), stride = (decades + 4) / 5;
    std::vector<Mark> marks;
    for (int decade = scale.low_decade(); decade <= scale.high_decade(); decade += stride)
        marks.push_back(
            {static_cast<float>(decade - scale.low_decade()) / static_cast<float>(decades), newtons(decade)});
    add_scale(list, kMargin, canvas.height - kMargin - kLegendHeight, "joint force", marks);
}

}  // namespace demo
