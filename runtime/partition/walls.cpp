#include "partition/walls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "partition/footing.h"

namespace taut {
namespace {

constexpr uint8_t kStands = 3;     // points of a contact that bears a tilt
constexpr float kUpright = 0.5f;   // cosine to the vertical of one that bears weight
constexpr float kSideways = 0.5f;  // sine to it of one with a neighbour beside
constexpr float kOpen = 0.2f;      // sine that a neighbour may reach into a way that is open
constexpr uint32_t kHeld = 4;      // one in so many of a column may have a neighbour there

// cos(i pi / 16), to a right angle.
constexpr float kCosine[] = {
    1, 0.98078528f, 0.92387953f, 0.83146961f, 0.70710678f, 0.55557023f, 0.38268343f, 0.19509032f, 0};

}  // namespace

// Horizontal ways, by their components along two axes.
struct Walls::Compass {
    Vec3f axis[2];
    std::array<float, kWays> x, y;

    explicit Compass(const Vec3f& up) : axis{tangent_of(up), up.cross(tangent_of(up))} {
        for (uint32_t i = 0; i < kWays / 4; ++i) {
            const float c = kCosine[i], s = kCosine[kWays / 4 - i];
            x[i] = c, y[i] = s;
            x[i + kWays / 4] = -s, y[i + kWays / 4] = c;
            x[i + kWays / 2] = -c, y[i + kWays / 2] = -s;
            x[i + 3 * kWays / 4] = s, y[i + 3 * kWays / 4] = -c;
        }
    }
    // Closes those into which a neighbour reaches, on the way (x, y) of unit length.
    void close(float way_x, float way_y, Open& open) const {
        for (uint32_t i = 0; i < kWays; ++i) open[i] = x[i] * way_x + y[i] * way_y > kOpen ? uint16_t{0} : open[i];
    }
};

Walls::Walls(Memory& memory) : body_(memory), open_(memory), upper_(memory), order_(memory), rows_(memory) {}

std::span<const Walls::Row> Walls::find_rows(const Site& site, std::span<const uint32_t> of) {
    begin(site);
    const Compass compass(site.up);
    for (const uint32_t node : site.bodies)
        for (const uint32_t p : site.adjacent.of(node)) {
            const auto& [a, b] = site.graph.touches[p];
            if (node == a || a == kNone) look(site, compass, node, p);  // once each
        }
    bear(site);
    lay_courses(site);
    list_rows(site.nodes, of);
    return rows_;
}

void Walls::begin(const Site& site) {
    body_.resize(site.graph.moves.size());
    open_.resize(site.graph.moves.size());
    upper_.resize(site.graph.touches.size());
    for (const uint32_t node : site.bodies) {
        body_[node] = {};
        body_[node].bond = node;
        open_[node].fill(1);
    }
}

// By a touch: which end stands on the other, or that they are beside each other.
void Walls::look(const Site& site, const Compass& compass, uint32_t node, uint32_t touch) {
    const ActivePair& pair = site.pairs.active[touch];
    const Vec3f& normal = site.pairs.list[pair.pair].manifold.normal;
    const Vec3f way = pair.a == node ? normal : Vec3f(-normal);
    const uint32_t other = site.graph.touches[touch].other(node);
    const float rise = way.dot(site.up);
    upper_[touch] = kNone;
    if (std::abs(rise) > kUpright && pair.points >= kStands) {
        const uint32_t upper = upper_[touch] = rise > 0 ? other : node;
        if (upper != kNone) ++body_[upper].bases;
        if (const uint32_t base = base_of(site, upper, touch); base != kNone) ++body_[base].waits_for;
    }
    const float x = way.dot(compass.axis[0]), y = way.dot(compass.axis[1]), beside = std::sqrt(x * x + y * y);
    if (beside <= kSideways) return;
    compass.close(x / beside, y / beside, open_[node]);
    if (other != kNone) compass.close(-x / beside, -y / beside, open_[other]);
}

// What a body stands on by a touch; kNone: no body, or it does not.
uint32_t Walls::base_of(const Site& site, uint32_t node, uint32_t touch) const {
    return node != kNone && upper_[touch] == node ? site.graph.touches[touch].other(node) : kNone;
}

uint32_t Walls::root_of(uint32_t node) {
    while (body_[node].bond != node) node = body_[node].bond = body_[body_[node].bond].bond;
    return node;
}

// From the top down.
void Walls::bear(const Site& site) {
    order_.clear();
    reserve_more(order_, site.bodies.size());
    for (const uint32_t node : site.bodies)
        if (body_[node].waits_for == 0) order_.push_back(node);
    for (size_t i = 0; i < order_.size(); ++i) {
        const uint32_t node = order_[i];
        body_[node].borne += site.nodes.mass[node].mass;
        if (const uint32_t above = body_[node].above; above != kNone)
            for (uint32_t k = 0; k < kWays; ++k)
                open_[node][k] = static_cast<uint16_t>(open_[node][k] + open_[above][k]);
        for (const uint32_t p : site.adjacent.of(node))
            if (const uint32_t base = base_of(site, node, p); base != kNone) put_on(base, node);
    }
}

void Walls::put_on(uint32_t base, uint32_t upper) {
    const Body& body = body_[upper];
    Body& below = body_[base];
    below.borne += body.borne / body.bases;
    if (body.column >= below.column) {
        below.column = body.column + 1;
        below.above = upper;
    }
    if (body.bases > 1) {
        const uint32_t one = root_of(upper), other = root_of(base);
        body_[std::max(one, other)].bond = std::min(one, other);
    }
    if (--below.waits_for == 0) order_.push_back(base);
}

// From the bottom up.
void Walls::lay_courses(const Site& site) {
    for (size_t i = order_.size(); i-- > 0;)
        for (const uint32_t p : site.adjacent.of(order_[i])) {
            const uint32_t base = base_of(site, order_[i], p);
            uint32_t& course = body_[order_[i]].course;
            if (base != kNone) course = std::max(course, body_[base].course + 1);
        }
}

bool Walls::may_lean_out(const Body& body, const Open& open) {
    const uint32_t least = body.column - body.column / kHeld;
    return std::ranges::any_of(open, [&](uint16_t bodies) { return bodies >= least; });
}

// Of what is bonded with these one row a course; returns how many.
uint32_t Walls::make_room(std::span<const uint32_t> of) {
    for (const uint32_t node : of) {
        Body& root = body_[root_of(node)];
        root.courses = std::max(root.courses, body_[node].course);
    }
    uint32_t count = 0;
    for (const uint32_t node : of) {
        Body& root = body_[root_of(node)];
        if (root.courses == 0) continue;
        root.first_row = count;
        count += std::exchange(root.courses, 0);
    }
    return count;
}

void Walls::list_rows(const Nodes& nodes, std::span<const uint32_t> of) {
    const uint32_t count = make_room(of);
    rows_.clear();
    reserve_more(rows_, count);
    rows_.resize(count);
    for (const uint32_t node : of) {
        const Body& body = body_[node];
        if (body.bases == 0 || !may_lean_out(body, open_[node])) continue;
        Row& row = rows_[body_[root_of(node)].first_row + body.course - 1];
        const double own = footing(nodes.mass[node]);
        row.footing = row.node == kNone ? own : std::min(row.footing, own);
        row.node = node;
        row.borne += body.borne;
        row.mass += nodes.mass[node].mass;
        row.column = std::max(row.column, body.column);
        row.bonded = row.bonded || (body.above != kNone && body_[body.above].bases > 1);
    }
    std::erase_if(rows_, [](const Row& row) { return row.node == kNone; });
}

}  // namespace taut
