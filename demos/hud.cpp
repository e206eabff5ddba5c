#include "hud.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <vector>

#include "render/font.h"

namespace demo {

namespace {

using render::Colour;
using render::from_srgb;

const Colour kPanel = from_srgb(0x10161F), kWhite = from_srgb(0xFFFFFF), kDim = from_srgb(0xAEBBCB);
const Colour kTrack = from_srgb(0x33404F), kGood = from_srgb(0x4FC28B), kBusy = from_srgb(0xF3A712),
             kLate = from_srgb(0xE4572E);
constexpr float kPanelAlpha = 0.88f, kRadius = 8, kMargin = 16, kPadding = 16;
constexpr float kTitle = 15, kText = 10;  // heights of capitals
constexpr float kAdvance = render::kGlyphAdvance;
constexpr float kSmall = 9;  // height of the smallest capitals

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

// "0.123 mm" in the unit that suits `most`, the largest so far: it does not jump from picture to picture.
std::string distance_of(double metres, double most) {
    if (most < 1e-6) return text_of("%.1f nm", metres * 1e9);
    if (most < 1) return text_of("%.3f mm", metres * 1e3);
    if (most < 1e4) return text_of("%.3f m", metres);
    return text_of("%.2e m", metres);
}

}  // namespace

void add_hud(render::DrawList& list, const HudFigures& f) {
    constexpr float kLine = 19;
    float x = kMargin + kPadding, y = kMargin + kPadding;
    std::string counts = text_of("%u bodies  %u joints  %u contacts", f.bodies, f.joints, f.points);
    if (f.asleep > 0) counts += text_of("  %u asleep", f.asleep);
    if (f.broken > 0) counts += text_of("  %zu broken", f.broken);
    const size_t longest =
        std::max(f.description.size() * static_cast<size_t>(kSmall), counts.size() * static_cast<size_t>(kText));
    float width = std::max(396.0f, static_cast<float>(longest) * kAdvance + 2 * kPadding);
    float height = kTitle + 14 + kSmall + 15 + 2 * kLine + 16 + (f.has_joints ? 2 : 1) * kLine + 2 * kPadding - 6;
    list.rects.push_back({kMargin, kMargin, width, height, kRadius, kPanel, kPanel, kPanelAlpha});
    auto line = [&](std::string text, float cap, Colour colour, float step) {
        list.texts.push_back({x, y, cap, std::move(text), colour, 1});
        y += step;
    };
    line(f.scene, kTitle, kWhite, kTitle + 14);
    line(f.description, kSmall, kDim, kSmall + 15);
    line(f.frames > 0 ? text_of("frame %u/%u   t = %.2f s", f.frame, f.frames, f.time) : text_of("frame %u", f.frame),
         kText, kWhite, kLine);
    line(text_of("step %.2f ms of %.2f ms", f.step_ms, f.budget_ms), kText, kWhite, kLine - 2);
    float full = width - 2 * kPadding, share = static_cast<float>(std::clamp(f.step_ms / f.budget_ms, 0.0, 1.0));
    Colour bar = f.step_ms > f.budget_ms ? kLate : f.step_ms > 0.5 * f.budget_ms ? kBusy : kGood;
    list.rects.push_back({x, y, full, 7, 3.5f, kTrack, kTrack, 1});
    list.rects.push_back({x, y, std::max(7.0f, full * share), 7, 3.5f, bar, bar, 1});
    y += 18;
    if (f.has_joints)
        line("joint error " + distance_of(f.joint_error, f.worst_joint_error) + "  worst " +
                 distance_of(f.worst_joint_error, f.worst_joint_error),
             kText, kWhite, kLine);
    line(counts, kText, kDim, kLine);
}

void add_curves(render::DrawList& list, const std::vector<HudCurve>& curves, uint32_t steps,
                const render::HudCanvas& canvas) {
    constexpr float kWidth = 300, kHeight = 74, kPlot = 32, kStroke = 1.5f;
    constexpr int kColumns = static_cast<int>(kWidth - 2 * kPadding);  // one a unit of the canvas
    const float left = canvas.width - kMargin - kWidth, x = left + kPadding;
    float top = kMargin;
    for (const HudCurve& curve : curves) {
        if (curve.values.empty()) continue;
        const auto [least, most] = std::minmax_element(curve.values.begin(), curve.values.end());
        const float low = curve.from_zero ? std::min(0.0f, *least) : *least, high = std::max(*most, low);
        const float span = high > low ? high - low : 1;
        list.rects.push_back({left, top, kWidth, kHeight, kRadius, kPanel, kPanel, kPanelAlpha});
        list.texts.push_back({x, top + 11, kSmall, curve.label, kWhite, 1});
        const std::string range = text_of("%.4g to %.4g", static_cast<double>(low), static_cast<double>(high));
        list.texts.push_back(
            {x + kColumns - kSmall * kAdvance * static_cast<float>(range.size()), top + 11, kSmall, range, kDim, 1});
        const float base = top + kHeight - 11;
        list.rects.push_back({x, base, kColumns, 1, 0, kTrack, kTrack, 1});
        // Of each column the steps in it, from the least to the largest value, and what joins it to the one before.
        float before = curve.values.front();
        for (int column = 0; column < kColumns; ++column) {
            const size_t from = static_cast<size_t>(column) * steps / kColumns;
            const size_t to = std::max(from + 1, static_cast<size_t>(column + 1) * steps / kColumns);
            if (from >= curve.values.size()) break;
            float lower = before, upper = before;
            for (size_t i = from; i < std::min(to, curve.values.size()); ++i) {
                lower = std::min(lower, curve.values[i]);
                upper = std::max(upper, curve.values[i]);
                before = curve.values[i];
            }
            const float y = base - kPlot * (upper - low) / span, tall = kPlot * (upper - lower) / span + kStroke;
            list.rects.push_back({x + static_cast<float>(column), y - kStroke, 1, tall, 0, kGood, kGood, 1});
        }
        top += kHeight + kMargin / 2;
    }
}

void add_caption(render::DrawList& list, const Caption& caption, float centre, const render::HudCanvas& canvas) {
    constexpr float kWidth = 330, kHeight = 62;
    const float left = centre - kWidth / 2, top = canvas.height - 2 * kMargin - 66 - kHeight;  // above the legend
    list.rects.push_back({left, top, kWidth, kHeight, kRadius, kPanel, kPanel, kPanelAlpha});
    list.texts.push_back({left + kPadding, top + 14, 11, caption.text, kWhite, 1});
    list.texts.push_back(
        {left + kPadding, top + 38, kText, "joint error " + distance_of(caption.joint_error, caption.worst), kDim, 1});
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
    // The ends always have their labels, what lies between them where there is room.
    constexpr float kApart = 8;
    const auto width_of = [](const Mark& mark) { return kSmall * kAdvance * static_cast<float>(mark.label.size()); };
    const auto left_of = [&](const Mark& mark) {
        return std::clamp(x + full * mark.at - 0.5f * width_of(mark), x - 4, x + full + 4 - width_of(mark));
    };
    float free = x - 4;
    const float last = marks.empty() ? 0 : left_of(marks.back());
    for (size_t i = 0; i < marks.size(); ++i) {
        const float from = left_of(marks[i]), to = from + width_of(marks[i]) + kApart;
        if (i + 1 < marks.size() && (from < free || to > last)) continue;
        list.texts.push_back({from, top + 49, kSmall, marks[i].label, kDim, 1});
        free = to;
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
