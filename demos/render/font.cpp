#include "font.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace render {

namespace {

// Strokes of each glyph from ' ' on. A point is two digits: x 0..4, y 0 (top of capitals), 2 (top of small
// letters), 6 (base line), 8 (descenders). Points make a line, '|' lifts the pen; a line that starts with '~'
// is rounded, with 'o' rounded and closed. One point alone is a dot.
constexpr std::string_view kStrokes[kGlyphs] = {
    "", "2024|2626", "1011|3031", "1115|3135|0242|0444", "~4130100112334445361605|2007", "4006|o00111001|o35463635",
    "~46130210203122050616264 4", "2021", "~30111536", "~10313516", "2125|0244|0442", "2125|0343", "2617", "1333",
    "2626", "4006",
    // digits
    "o1030414536160501", "012026|1636", "~01103041420633|0646", "~01103041423323|~233344453616 05", "36300444",
    "4000 03|~03123243453616 05", "~312010010516364544331304", "004016", "o1302011030414233|o1304051636454433",
    "~152636454130100102133342",
    // : ; < = > ? @
    "2323|2626", "2323|2617", "410345", "0242|0444", "014305", "~0110304142232 4|2626",
    "~3423121324344445|~3424|~44413010010516 36",
    // capitals
    "062046|1434", "0006|~0030414 23303|~033344453606", "~4130100105163645", "0006|~00204244260 6", "40000646|0333",
    "400006|0333", "~4130100105163645|454323", "0006|4046|0343", "1030|2026|1636", "~4045361605", "0006|400346",
    "000646", "0600234046", "06004640", "o1030414536160501", "0600|~0030414 23303", "o1030414536160501|2446",
    "0600|~003041423303|2346", "~413010010213334445361605", "0040|2026", "~000516364540", "002640", "0016233640",
    "0046|4006", "002340|2326", "00400646",
    // [ \ ] ^ _ `
    "30101636", "0046", "10303616", "022042", "0747", "1021",
    // small letters
    "o1232434536160503|4246", "0006|o1232434536160503", "~4332120305163645", "o1232434536160503|4046",
    "0444|~44433212030516 3645", "~4030202124|2426|1242", "o1232434536160503|~42463818 07", "0006|~0412324346",
    "2226|2020", "~32373818|3030", "0006|420446|1346", "~20253646", "0206|~0412222426|~24223 24446|4446",
    "0206|~0412324346", "o1232434536160503", "0208|o1232434536160503", "4248|o1232434536160503", "0206|~04123242",
    "~433212031434453616 05", "~20253646|1242", "~0205163645|4246", "022642", "0216243642", "0246|4206",
    "0226|42260818", "02420646",
    // { | } ~
    "~3020211303|~0313252636|1303", "2027", "~1020213343|~4333252616|3343", "~0413334 2"};

struct Point {
    float x, y;
};

// Two rounds of corner cutting; an open line keeps its ends.
std::vector<Point> rounded(std::vector<Point> line, bool closed) {
    for (int round = 0; round < 3; ++round) {
        std::vector<Point> next;
        if (!closed) next.push_back(line.front());
        size_t spans = closed ? line.size() : line.size() - 1;
        for (size_t i = 0; i < spans; ++i) {
            Point a = line[i], b = line[(i + 1) % line.size()];
            next.push_back({0.75f * a.x + 0.25f * b.x, 0.75f * a.y + 0.25f * b.y});
            next.push_back({0.25f * a.x + 0.75f * b.x, 0.25f * a.y + 0.75f * b.y});
        }
        if (!closed) next.push_back(line.back());
        line = std::move(next);
    }
    if (closed) line.push_back(line.front());
    return line;
}

std::vector<std::vector<Point>> lines_of(std::string_view strokes) {
    std::vector<std::vector<Point>> lines;
    while (!strokes.empty()) {
        std::string_view part = strokes.substr(0, strokes.find('|'));
        strokes.remove_prefix(std::min(strokes.size(), part.size() + 1));
        char style = part.empty() ? ' ' : part.front();
        std::vector<float> digits;
        for (char c : part)
            if (c >= '0' && c <= '9') digits.push_back(static_cast<float>(c - '0'));
        std::vector<Point> line;
        for (size_t i = 0; i + 1 < digits.size(); i += 2) line.push_back({digits[i], digits[i + 1]});
        if (line.size() > 2 && (style == '~' || style == 'o')) line = rounded(std::move(line), style == 'o');
        if (!line.empty()) lines.push_back(std::move(line));
    }
    return lines;
}

float distance_to_segment(Point p, Point a, Point b) {
    Point d = {b.x - a.x, b.y - a.y}, r = {p.x - a.x, p.y - a.y};
    float t = std::clamp((d.x * r.x + d.y * r.y) / std::max(d.x * d.x + d.y * d.y, 1e-6f), 0.0f, 1.0f);
    return std::hypot(r.x - t * d.x, r.y - t * d.y);
}

float distance_to_glyph(Point p, const std::vector<std::vector<Point>>& lines) {
    float best = 1e9f;
    for (const auto& line : lines) {
        // A dot is drawn a little fatter than a stroke.
        if (line.size() == 1) best = std::min(best, distance_to_segment(p, line[0], line[0]) - 0.25f);
        for (size_t i = 0; i + 1 < line.size(); ++i)
            best = std::min(best, distance_to_segment(p, line[i], line[i + 1]));
    }
    return best;
}

}  // namespace

FontImage draw_font(float cap_height) {
    FontImage image;
    float unit = cap_height / 6.0f;                     // pixels of one grid step
    float half_stroke = std::max(0.42f * unit, 0.62f);  // [pixels]
    float margin = std::ceil(half_stroke + 1.0f);
    image.origin_x = image.origin_y = margin;
    image.advance = std::round(5.9f * unit);
    image.cell_width = static_cast<int>(std::ceil(4 * unit + 2 * margin));
    image.cell_height = static_cast<int>(std::ceil(8 * unit + 2 * margin));
    image.width = image.cell_width * kGlyphColumns;
    image.height = image.cell_height * ((kGlyphs + kGlyphColumns - 1) / kGlyphColumns);
    image.coverage.assign(static_cast<size_t>(image.width) * static_cast<size_t>(image.height), 0);
    for (int glyph = 0; glyph < kGlyphs; ++glyph) {
        auto lines = lines_of(kStrokes[glyph]);
        int left = glyph % kGlyphColumns * image.cell_width, top = glyph / kGlyphColumns * image.cell_height;
        for (int y = 0; y < image.cell_height; ++y)
            for (int x = 0; x < image.cell_width; ++x) {
                Point p = {(static_cast<float>(x) + 0.5f - margin) / unit,
                           (static_cast<float>(y) + 0.5f - margin) / unit};
                float coverage = std::clamp(half_stroke + 0.5f - distance_to_glyph(p, lines) * unit, 0.0f, 1.0f);
                image.coverage[static_cast<size_t>((top + y) * image.width + left + x)] =
                    static_cast<uint8_t>(std::lround(255.0f * coverage));
            }
    }
    return image;
}

}  // namespace render
