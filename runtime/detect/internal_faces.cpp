#include "detect/internal_faces.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "detect/drop_contacts.h"
#include "detect/lead.h"
#include "detect/reuse.h"
#include "state/levers.h"

namespace taut {
namespace {

// Normals closer than this are one: sine of the angle.
constexpr float kBend = 1e-3f;

const collision::Shape& shape_of(const Detection& of, uint32_t collider) {
    return of.shapes[of.colliders.record[collider].shape].shape;
}

// Whether more than one collider is on a node.
bool is_compound(const Detection& of, uint32_t node) {
    const uint32_t first = of.nodes.info[node].collider;
    return first != kNone && of.colliders.record[first].next != kNone;
}

// A contact as the collider sees it, which bears on a solid.
struct Side {
    const Pair& pair;
    bool solid_is_b;
    double lead;  // in which it was found [s]

    Side(const Pair& p, bool of_a, double time) : pair(p), solid_is_b(of_a), lead(time) {}
    uint32_t collider() const { return solid_is_b ? pair.collider_a() : pair.collider_b(); }
    uint32_t solid() const { return solid_is_b ? pair.collider_b() : pair.collider_a(); }
    Vec3f normal() const { return solid_is_b ? Vec3f(-pair.manifold.normal) : pair.manifold.normal; }
    // On the solid's surface, as it stands [m].
    Vec3 point(const Detection& of, int k) const {
        const Nodes& nodes = of.nodes;
        const Movement a = movement_of(nodes, pair.a, pair.a2), b = movement_of(nodes, pair.b, pair.b2);
        if (pair.then > 0) {
            const Vec3 arm_a = a.x - origin_of_points(of, pair), arm_b = b.x - nodes.origin(pair.b);
            const Levers levers = levers_of(pair, k, arm_a, axles_of(of.pairs, pair, arm_a, arm_b), a, b);
            return solid_is_b ? Vec3(b.x + levers.b.at) : Vec3(a.x + levers.a.at);
        }
        const collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 normal = pair.manifold.normal.cast<double>();
        const Vec3 apart = lead * (b.v - a.v);
        const double half = 0.5 * (static_cast<double>(point.separation) + normal.dot(apart));
        const Vec3 at =
            origin_of_points(of, pair) + point.position.cast<double>() + (solid_is_b ? half : -half) * normal;
        if (lead == 0) return at;
        // They went along with the lighter side; lead.cpp.
        const double mass_a = nodes.mass[pair.a].inv_mass, mass_b = nodes.mass[pair.b].inv_mass;
        const double share_of_b = mass_a + mass_b > 0 ? mass_b / (mass_a + mass_b) : 0;
        return solid_is_b ? Vec3(at - (1 - share_of_b) * apart) : Vec3(at + share_of_b * apart);
    }
};

// How much further a point of one solid gets along the plane's normal than the other, in the time ahead [m].
float growth_of(const Detection& of, const Side& one, const Side& other, const Vec3& at) {
    const auto velocity = [&](const Side& side) {
        const uint32_t node = of.colliders.record[side.solid()].node;
        const NodeMotion& m = of.nodes.motion[node];
        return of.nodes.info[node].kind == NodeKind::fixed ? Vec3(Vec3::Zero()) : Vec3(m.v + m.w.cross(at - m.x));
    };
    const Vec3 apart = velocity(one) - velocity(other);
    return std::max(0.0f, static_cast<float>(of.time * other.normal().cast<double>().dot(apart)));
}

// A contact before the plane of another, in the frame of its solid.
struct Question {
    collision::SolidContact contact;
    collision::Cover cover;

    Question(const Detection& of, const Side& one, const Side& other) {
        const collision::Placement& at = of.pairs.placement[one.solid()];
        const Mat3f back = at.rotation.transpose();
        const auto local = [&](const Vec3& p) { return Vec3f(back * (p - at.position).cast<float>()); };
        contact.normal = back * one.normal();
        contact.count = one.pair.manifold.count;
        for (int k = 0; k < contact.count; ++k) contact.points[k] = local(one.point(of, k));
        cover.normal = back * other.normal();
        cover.offset = -1e30f;
        cover.middle = Vec3f::Zero();
        const int count = other.pair.manifold.count;
        for (int k = 0; k < count; ++k) {
            const Vec3f p = local(other.point(of, k));
            cover.offset = std::max(cover.offset, cover.normal.dot(p));
            cover.middle += p / static_cast<float>(count);
        }
        cover.offset -= growth_of(of, one, other, one.point(of, 0));
        const uint32_t body = one.collider();
        cover.body = local(of.pairs.placement[body].position);
        cover.reach = of.pairs.stance[body].size + contact_margin(of.pairs, body, one.solid());
    }
};

// A contact of a collider with one of several that move as one.
struct Bearing {
    uint32_t active;  // index into Pairs::active
    bool of_a;        // the collider is a's

    // As a number in Pairs::picked.
    explicit Bearing(uint32_t word) : active(word >> 1), of_a(word & 1) {}
    Bearing(uint32_t index, bool a) : active(index), of_a(a) {}
    uint32_t word() const { return active << 1 | uint32_t(of_a); }

    uint32_t collider(const Pairs& pairs) const {
        const NearPair& near = pairs.near[pairs.active[active].near];
        return of_a ? near.collider_a() : near.collider_b();
    }
    // The node of the others; kNone: forces do not move them.
    uint32_t group(const Detection& of) const {
        const uint32_t node = of_a ? of.pairs.active[active].b : of.pairs.active[active].a;
        return moves_by_forces(of.nodes.info[node].kind) ? node : kNone;
    }
};

// Contacts of one collider with what moves as one.
class Run {
public:
    Run(const Detection& of, std::span<uint32_t> bearings) : of_(of), pairs_(of.pairs), run_(bearings) {}

    // Each before those that are deeper, the deepest first. Then before those that are as deep but for the tolerance of
    // clipping, once what deeper ones tell is known. Whether any changed.
    bool open() {
        find_at_one_moment();
        const auto order = [&](uint32_t word) { return std::pair(separation(Bearing(word)), word); };
        std::sort(run_.begin(), run_.end(), [&](uint32_t a, uint32_t b) { return order(a) < order(b); });
        for (size_t i = 1; i < run_.size(); ++i)
            for (size_t j = 0; j < i; ++j) open(Bearing(run_[i]), Bearing(run_[j]));
        const float slack = collision::flush_tolerance(shape_of(of_, Bearing(run_[0]).collider(pairs_)));
        for (size_t i = 0; i < run_.size(); ++i)
            for (size_t j = i + 1; j < run_.size(); ++j) {
                const Bearing one(run_[i]), other(run_[j]);
                if (separation(other) <= separation(one) + slack) open(one, other);
            }
        return any_;
    }

private:
    Pair& pair_of(const Bearing& bearing) const { return pairs_.list[pairs_.active[bearing.active].pair]; }
    NearPair& near_of(const Bearing& bearing) const { return pairs_.near[pairs_.active[bearing.active].near]; }
    void note_change(const Bearing& bearing) {
        pairs_.active[bearing.active].points = static_cast<uint8_t>(pair_of(bearing).manifold.count);
        any_ = true;
    }

    // Where one moves over its surface and is found in a lead time, all are, or none where some cannot.
    void find_at_one_moment() {
        bool leads = false, may_lead = true;
        for (const uint32_t word : run_) {
            const Pair& pair = pair_of(Bearing(word));
            const bool can = pair.part == 0 && pair.then == 0;
            leads = leads || (can && lead_of(of_, pair) > 0);
            may_lead = may_lead && can;
        }
        if (!leads) return;
        lead_ = may_lead ? of_.lead : 0;
        for (const uint32_t word : run_) {
            const Bearing bearing(word);
            Pair& pair = pair_of(bearing);
            if (pair.part != 0 || pair.then != 0 || lead_of(of_, pair) == lead_) continue;
            Finding(of_, false, lead_, near_of(bearing), pair).take_over(of_);
            note_change(bearing);
        }
    }

    // At the moment found, the least of its points.
    float separation(const Bearing& bearing) const {
        const Pair& pair = pair_of(bearing);
        float least = std::numeric_limits<float>::infinity();
        for (int k = 0; k < pair.manifold.count; ++k) least = std::min(least, pair.manifold.points[k].separation);
        if (pair.part != 0 || lead_ == 0) return least;
        const Vec3 velocity = of_.nodes.motion[pair.b].v - of_.nodes.motion[pair.a].v;
        return least + static_cast<float>(lead_ * pair.manifold.normal.cast<double>().dot(velocity));
    }

    // Has a contact go over to open faces, or lose its points, before a deeper one.
    void open(const Bearing& bearing, const Bearing& deeper) {
        Pair& pair = pair_of(bearing);
        const Pair& cover = pair_of(deeper);
        if (pair.key == cover.key || pair.manifold.count == 0 || cover.manifold.count == 0) return;
        const Side one(pair, bearing.of_a, pair.part == 0 ? lead_ : 0),
            other(cover, deeper.of_a, cover.part == 0 ? lead_ : 0);
        const Vec3f normal = one.normal(), up = other.normal();
        if (normal.dot(up) > 0 && normal.cross(up).norm() <= kBend) return;
        const Question question(of_, one, other);
        const collision::Shape &body = shape_of(of_, one.collider()), &solid = shape_of(of_, one.solid());
        if (!collision::is_internal(body, solid, pair.part, question.contact, question.cover)) return;
        // The next frame looks for the axis anew: what touched last it would prefer.
        NearPair& near = near_of(bearing);
        near.kept = false;
        near.cache = {};
        pair.cache = {};
        find_open_points(of_, one.solid_is_b, question.contact, question.cover, pair);
        note_change(bearing);
    }

    const Detection& of_;
    Pairs& pairs_;
    const std::span<uint32_t> run_;
    double lead_ = 0;
    bool any_ = false;
};

// Whether any body has several colliders.
// Calls act(bearing) for the sides of a contact that may bear on several colliders that move as one. Balls of vertices
// make up no solid, though held: what is within their surface detect/surface_cone.h knows.
template <class Act>
void for_bearings(const Detection& of, bool compounds, uint32_t index, Act&& act) {
    const ActivePair& active = of.pairs.active[index];
    if (of.nodes.info[active.a].soft != kNone || of.nodes.info[active.b].soft != kNone) return;
    const bool a_moves = moves_by_forces(of.nodes.info[active.a].kind),
               b_moves = moves_by_forces(of.nodes.info[active.b].kind);
    if (b_moves ? compounds && is_compound(of, active.b) : a_moves) act(Bearing(index, true));
    if (a_moves ? compounds && is_compound(of, active.a) : b_moves) act(Bearing(index, false));
}

bool is_convex(const Detection& of, uint32_t collider) {
    const collision::ShapeKind kind = shape_of(of, collider).kind;
    return kind != collision::ShapeKind::plane && kind != collision::ShapeKind::surface;
}

// Goes through Pairs::picked, the bearings that may come in runs. Whether any contact changed.
bool open_runs(const Detection& of) {
    Pairs& pairs = of.pairs;
    const auto key_of = [&](uint32_t word) {
        const Bearing bearing(word);
        return std::tuple(bearing.collider(pairs), bearing.group(of), word);
    };
    std::sort(pairs.picked.begin(), pairs.picked.end(), [&](uint32_t a, uint32_t b) { return key_of(a) < key_of(b); });
    const auto same = [&](uint32_t a, uint32_t b) {
        const Bearing one(a), other(b);
        return one.collider(pairs) == other.collider(pairs) && one.group(of) == other.group(of);
    };
    bool any = false;
    for (size_t begin = 0, end = 0; begin < pairs.picked.size(); begin = end) {
        while (end < pairs.picked.size() && same(pairs.picked[begin], pairs.picked[end])) ++end;
        if (end - begin < 2 || !is_convex(of, Bearing(pairs.picked[begin]).collider(pairs))) continue;
        any = Run(of, std::span(pairs.picked).subspan(begin, end - begin)).open() || any;
    }
    return any;
}

}  // namespace

void open_internal_faces(const Detection& of) {
    Pairs& pairs = of.pairs;
    const auto count = static_cast<uint32_t>(pairs.active.size());
    pairs.bearings.resize(of.colliders.record.size());  // how many contacts each collider has, up to two
    const bool compounds = of.colliders.chained > 0;
    for (uint32_t i = 0; i < count; ++i)
        for_bearings(of, compounds, i, [&](const Bearing& bearing) { pairs.bearings[bearing.collider(pairs)] = 0; });
    bool any = false;
    for (uint32_t i = 0; i < count; ++i)
        for_bearings(of, compounds, i, [&](const Bearing& bearing) {
            uint8_t& mark = pairs.bearings[bearing.collider(pairs)];
            any = any || mark == 1;
            if (mark < 2) ++mark;
        });
    if (!any) return;
    pairs.picked.clear();
    for (uint32_t i = 0; i < count; ++i)
        for_bearings(of, compounds, i, [&](const Bearing& bearing) {
            if (pairs.bearings[bearing.collider(pairs)] < 2) return;
            reserve_more(pairs.picked, 1);
            pairs.picked.push_back(bearing.word());
        });
    if (!open_runs(of)) return;
    drop_contacts(of.nodes, of.colliders, pairs,
                  [](const ActivePair& active, const NearPair&) { return active.points == 0; });
}

void open_internal_faces_again(const Detection& of, std::span<const uint32_t> active_pairs) {
    of.pairs.picked.clear();
    for (const uint32_t index : active_pairs)
        for_bearings(of, true, index, [&](const Bearing& bearing) {
            reserve_more(of.pairs.picked, 1);
            of.pairs.picked.push_back(bearing.word());
        });
    if (of.pairs.picked.size() > 1) open_runs(of);
}

}  // namespace taut
