// What something kinematic squeezes against something that does not yield, itself or through others. Nothing holds
// then, and impulses grow with the overlap and the speed, not with what bodies weigh: a crate of 20 kg in a lift that
// drives on by 0.4 m bears 480 kN from above and below. Sweeps end a few per cent off such impulses, so that a body was
// thrown aside once it was let go. So what is squeezed gives way: its contacts are so soft that it bears its
// weight's multiple.
#include <algorithm>
#include <limits>

#include "constraints/soft_contact.h"
#include "partition/partition.h"
#include "partition/weights.h"

namespace taut {
namespace {

constexpr float kAhead = 0.5f;  // cosine: what is driven drives what lies ahead of it

bool drives(const Nodes& nodes, uint32_t node) { return nodes.info[node].kind == NodeKind::kinematic; }

// Speed along a direction of what does not yield, at the first point of a pair [m/s].
double speed_along(const Nodes& nodes, uint32_t node, const Pair& pair, const Vec3f& along) {
    if (!drives(nodes, node)) return 0;
    const NodeMotion& m = nodes.motion[node];
    const Vec3 at = nodes.origin(pair.a) + pair.manifold.points[0].position.cast<double>() - m.x;
    return (m.v + m.w.cross(at)).dot(along.cast<double>());
}

// Of the deepest point [m]; below 0 where they do not touch yet.
double overlap_of(const Pair& pair) {
    float least = std::numeric_limits<float>::infinity();
    for (int k = 0; k < pair.manifold.count; ++k) least = std::min(least, pair.manifold.points[k].separation);
    return -static_cast<double>(least);
}

// How far two can overlap before they part on the other side [m]: Pace::thickness is that of half a body.
double room_of(const Pairs& pairs, const Pair& pair) {
    return pairs.pace[pair.collider_a()].thickness + pairs.pace[pair.collider_b()].thickness;
}

// By how much contacts yield to the weight of what they bear [m].
double yield_to_weight(const SweepTerms& terms, const PartitionRules& rules) {
    const auto share = static_cast<double>(terms.mass_scale * terms.bias_rate / terms.impulse_scale);
    return least_gravity(rules) * rules.spring_substep / share;
}

}  // namespace

// Contacts of kinematic nodes, into squeezes_.
void Partition::begin_squeezes(const Nodes& nodes, const Pairs& pairs, double time_step) {
    squeezes_.clear();
    for (uint32_t p = 0; p < graph_.touches.size(); ++p) {
        const auto& [a, b] = graph_.touches[p];
        const ActivePair& active = pairs.active[p];
        if ((a == kNone) == (b == kNone) || active.spans()) continue;
        const uint32_t node = a == kNone ? b : a, by = active.a == node ? active.b : active.a;
        if (!drives(nodes, by)) continue;
        const Pair& pair = pairs.list[active.pair];
        const Vec3f along = -normal_from(pairs, node, p);
        const double lack = overlap_of(pair) + speed_along(nodes, by, pair, along) * time_step;
        reserve_more(squeezes_, 1);
        squeezes_.push_back({by, node, p, kNone, 1, along, lack});
    }
}

// The contacts on the way to the last, so that each yields by its part of what is lacking under so many weights; of all
// ways that lead through a contact, the narrowest counts. Parts are as what is thin can take them; where nothing can,
// what drives goes on alone. Who took more than its part is stiffer: SweepTerms::push bounds how fast each goes back,
// and with the same for all a weight would draw what is squeezed on through one side.
void Partition::soften(const Nodes& nodes, const Squeeze& last, double most, double furthest, Pairs& pairs) {
    if (!(last.lack > most * last.contacts)) return;
    const auto for_way = [&](auto act) {
        for (const Squeeze* at = &last;; at = &squeezes_[at->before]) {
            const uint32_t index = pairs.active[at->pair].pair;
            act(index, std::min(room_of(pairs, pairs.list[index]), last.lack));
            if (at->before == kNone) break;
        }
    };
    double all = 0;
    for_way([&](uint32_t, double room) { all += room; });
    for_way([&](uint32_t index, double room) {
        const Pair& pair = pairs.list[index];
        if (last.lack > all && !drives(nodes, pair.a) && !drives(nodes, pair.b)) return;
        const double part = std::min(1.0, last.lack / all) * room;
        const double taken = 0.5 * (1 + std::max(0.0, overlap_of(pair)) / part);
        float& stiffness = pairs.list[index].stiffness;
        stiffness = std::min(stiffness, static_cast<float>(taken * most / std::min(part, furthest)));
        softened_ = true;
    });
}

// Breadth first from what is kinematic, through each body once, to what does not yield; but for a container itself,
// whose walls leave as much room as before.
void Partition::soften_squeezed(const Nodes& nodes, Pairs& pairs, const PartitionRules& rules) {
    if (softened_)  // which ones is not known: records change places between frames
        for (Pair& pair : pairs.list) pair.stiffness = 1;
    softened_ = false;
    begin_squeezes(nodes, pairs, rules.time_step);
    if (squeezes_.empty()) return;
    const SweepTerms terms = contact_terms(rules.spring_substep);
    const double yield = yield_to_weight(terms, rules);
    const auto furthest = static_cast<double>(terms.push / terms.bias_rate);  // overlap that pushes as more does [m]
    auto& reached = core_;                                                    // until blocks are built
    clear_movers(reached);
    for (uint32_t i = 0; i < squeezes_.size(); ++i) {  // grows
        const Squeeze of = squeezes_[i];
        for (const uint32_t p : touches_of(of.node)) {
            const Vec3f normal = normal_from(pairs, of.node, p);
            if (p == of.pair || pairs.active[p].spans() || !(of.along.dot(normal) > kAhead)) continue;
            const Pair& pair = pairs.list[pairs.active[p].pair];
            const uint32_t next = graph_.touches[p].other(of.node);
            const uint32_t end = pair.a == of.node ? pair.b : pair.a;
            Squeeze to{of.by, next, p, i, of.contacts + 1, of.along, of.lack + overlap_of(pair)};
            if (next == kNone) {
                if (end == of.by) continue;
                to.lack -= speed_along(nodes, end, pair, of.along) * rules.time_step;
                soften(nodes, to, most_weights(island_[island_of_[of.node]].nodes) * yield, furthest, pairs);
            } else if (!reached[next]) {
                reached[next] = 1;
                reserve_more(squeezes_, 1);
                squeezes_.push_back(to);
            }
        }
    }
}

}  // namespace taut
