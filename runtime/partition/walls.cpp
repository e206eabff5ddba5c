#include "partition/walls.h"

#include <algorithm>
#include <cmath>

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

// 32 horizontal ways, by their components along two axes.
struct Compass {
    Vec3f axis[2];
    std::array<float, 32> x, y;

    explicit Compass(const Vec3f& up) {
        axis[0] = tangent_of(up);
        axis[1] = up.cross(axis[0]);
        for (uint32_t i = 0; i < 8; ++i) {
            const float c = kCosine[i], s = kCosine[8 - i];
            x[i] = c, y[i] = s;
            x[i + 8] = -s, y[i + 8] = c;
            x[i + 16] = -c, y[i + 16] = -s;
            x[i + 24] = s, y[i + 24] = -c;
        }
    }
    // Closes those into which a neighbour reaches; way: to it, horizontal unit vector along the axes.
    template <class Open>
    void close(float way_x, float way_y, Open& open) const {
        for (uint32_t i = 0; i < open.size(); ++i)
            open[i] = x[i] * way_x + y[i] * way_y > kOpen ? uint16_t{0} : open[i];
    }
};

}  // namespace

Walls::Walls(Memory& memory) : body_(memory), open_(memory), upper_(memory), order_(memory), rows_(memory) {}

std::span<const Walls::Row> Walls::find_rows(const TouchGraph& graph, const Adjacency& adjacent, const Nodes& nodes,
                                             const Pairs& pairs, std::span<const uint32_t> standing,
                                             std::span<const uint32_t> bodies, const Vec3f& up) {
    look(graph, adjacent, pairs, standing, up);
    load(graph, adjacent, nodes, standing);
    list_rows(nodes, bodies);
    return rows_;
}

// Who stands on whom, and who is beside whom.
void Walls::look(const TouchGraph& graph, const Adjacency& adjacent, const Pairs& pairs,
                 std::span<const uint32_t> standing, const Vec3f& up) {
    const Compass compass(up);
    body_.resize(graph.moves.size());
    open_.resize(graph.moves.size());
    upper_.resize(graph.touches.size());
    for (const uint32_t node : standing) {
        body_[node] = {};
        body_[node].bond = node;
        open_[node].fill(1);
    }
    for (const uint32_t node : standing)
        for (const uint32_t p : adjacent.of(node)) {
            const auto& [a, b] = graph.touches[p];
            if (node == b && a != kNone) continue;  // by its other end
            const Vec3f& normal = pairs.list[pairs.active[p].pair].manifold.normal;
            const Vec3f way = pairs.active[p].a == node ? normal : Vec3f(-normal);
            const float rise = way.dot(up);
            const uint32_t other = graph.touches[p].other(node);
            upper_[p] = kNone;
            if (std::abs(rise) > kUpright && pairs.active[p].points >= kStands) {
                upper_[p] = rise > 0 ? other : node;
                if (upper_[p] != kNone) ++body_[upper_[p]].bases;
                if (const uint32_t base = base_of(graph, upper_[p], p); base != kNone) ++body_[base].waits_for;
            }
            const float x = way.dot(compass.axis[0]), y = way.dot(compass.axis[1]), beside = std::sqrt(x * x + y * y);
            if (beside <= kSideways) continue;
            compass.close(x / beside, y / beside, open_[node]);
            if (other != kNone) compass.close(-x / beside, -y / beside, open_[other]);
        }
}

// What a body stands on by a touch; kNone: no body, or it does not.
uint32_t Walls::base_of(const TouchGraph& graph, uint32_t node, uint32_t touch) const {
    return node != kNone && upper_[touch] == node ? graph.touches[touch].other(node) : kNone;
}

uint32_t Walls::root_of(uint32_t node) {
    while (body_[node].bond != node) node = body_[node].bond = body_[body_[node].bond].bond;
    return node;
}

// From the top down what bodies bear, from the bottom up their courses.
void Walls::load(const TouchGraph& graph, const Adjacency& adjacent, const Nodes& nodes,
                 std::span<const uint32_t> standing) {
    order_.clear();
    reserve_more(order_, standing.size());
    for (const uint32_t node : standing)
        if (body_[node].waits_for == 0) order_.push_back(node);
    for (size_t i = 0; i < order_.size(); ++i) {
        const uint32_t node = order_[i];
        Body& body = body_[node];
        body.borne += nodes.mass[node].mass;
        if (body.above != kNone)
            for (uint32_t k = 0; k < kWays; ++k)
                open_[node][k] = static_cast<uint16_t>(open_[node][k] + open_[body.above][k]);
        for (const uint32_t p : adjacent.of(node)) {
            const uint32_t base = base_of(graph, node, p);
            if (base == kNone) continue;
            Body& below = body_[base];
            below.borne += body.borne / body.bases;
            if (body.column >= below.column) {
                below.column = body.column + 1;
                below.above = node;
            }
            if (body.bases > 1)
                body_[std::max(root_of(node), root_of(base))].bond = std::min(root_of(node), root_of(base));
            if (--below.waits_for == 0) order_.push_back(base);
        }
    }
    for (size_t i = order_.size(); i-- > 0;)
        for (const uint32_t p : adjacent.of(order_[i]))
            if (const uint32_t base = base_of(graph, order_[i], p); base != kNone)
                body_[order_[i]].course = std::max(body_[order_[i]].course, body_[base].course + 1);
}

bool Walls::may_lean_out(uint32_t node) const {
    const uint32_t column = body_[node].column, least = column - column / kHeld;
    return std::ranges::any_of(open_[node], [&](uint16_t open) { return open >= least; });
}

// Of what is bonded one row a course.
void Walls::list_rows(const Nodes& nodes, std::span<const uint32_t> bodies) {
    for (const uint32_t node : bodies) {
        Body& root = body_[root_of(node)];
        root.courses = std::max(root.courses, body_[node].course);
    }
    uint32_t count = 0;
    for (const uint32_t node : bodies) {
        Body& root = body_[root_of(node)];
        if (root.courses == 0) continue;
        root.first_row = count;
        count += std::exchange(root.courses, 0);
    }
    rows_.clear();
    reserve_more(rows_, count);
    rows_.resize(count);
    for (const uint32_t node : bodies) {
        const Body& body = body_[node];
        if (body.bases == 0 || !may_lean_out(node)) continue;
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
