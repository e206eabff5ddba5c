// Boxes about the ways of all grains are put into cells of a grid, sorted: each size of box, by powers of two, has a
// grid whose cells it fits, so that what meets a box of the same size or a larger one has its middle in the 27 cells
// about its own. Rows of three cells follow each other in the order of keys, and as the seekers go through a grid in
// that order too, the places where their rows begin only ever move on (a hierarchical grid, swept instead of hashed).
#include "detect/grains.h"

#include <bit>
#include <cmath>
#include <limits>

#include "constraints/soft_contact.h"
#include "detect/detect.h"
#include "detect/surfaces.h"

namespace taut {
namespace {

constexpr int kBits = 21;                          // of a cell along an axis
constexpr float kMostCell = (1 << kBits) - 3;      // others are in the last: more are asked, none is missed
constexpr int kFirstLevel = -24, kLastLevel = 24;  // of boxes: others count as of these

// The corner of all grains' middles, and how far from it they reach.
struct Extent {
    Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;

    void add(const Vec3& x) { lo = lo.cwiseMin(x), hi = hi.cwiseMax(x); }
};

int32_t level_of(const Vec3f& size) {
    int exponent = 0;
    std::frexp(size.maxCoeff(), &exponent);
    return std::clamp(exponent, kFirstLevel, kLastLevel);
}

// False: none is awake.
bool list_balls(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, double time_step,
                Grains& grains) {
    Array<GrainBall>& balls = grains.ball;
    balls.clear();
    reserve_more(balls, colliders.grains.size());
    Extent extent;
    bool any_awake = false;
    for (const uint32_t c : colliders.grains) {
        const Collider& collider = colliders.record[c];
        const collision::Shape& shape = shapes[collider.shape].shape;
        GrainBall& ball = balls.emplace_back();
        ball.x = nodes.motion[collider.node].x;
        ball.v = nodes.motion[collider.node].v.cast<float>();
        ball.inv_mass = static_cast<float>(nodes.mass[collider.node].inv_mass);
        ball.radius = collision::ball_radius(shape);
        ball.margin = shapes[collider.shape].margin;
        ball.node = collider.node;
        ball.collider = c;
        extent.add(ball.x);
        any_awake = any_awake || nodes.solved(collider.node);
    }
    const float rounding = 0x1p-21f * static_cast<float>((extent.hi - extent.lo).maxCoeff());
    for (GrainBall& ball : balls) {
        const Vec3f at = (ball.x - extent.lo).cast<float>(), way = static_cast<float>(time_step) * ball.v;
        const Vec3f about = Vec3f::Constant(ball.radius + 0.5f * ball.margin + rounding);
        ball.box = {at + way.cwiseMin(0.0f) - about, at + way.cwiseMax(0.0f) + about};
        ball.level = level_of(ball.box.hi - ball.box.lo);
    }
    return any_awake;
}

uint64_t key_of(const GrainBall& ball, int32_t level) {
    const float per_cell = std::ldexp(1.0f, -level);
    uint64_t key = 0;
    for (int i = 2; i >= 0; --i) {
        const float cell = std::max(0.0f, std::floor(per_cell * 0.5f * (ball.box.lo[i] + ball.box.hi[i])));
        key = key << kBits | (1 + static_cast<uint64_t>(std::min(cell, kMostCell)));
    }
    return key;
}

// By key, and of the same by index: counting, a digit at a time, but for those in which all agree.
void sort_cells(Array<GrainCell>& cells, Array<GrainCell>& spare) {
    constexpr int kDigit = 11;
    uint64_t all = ~uint64_t{0}, any = 0;
    for (const GrainCell& cell : cells) all &= cell.key, any |= cell.key;
    spare.resize(cells.size());
    for (int axis = 0; axis < 3; ++axis)
        for (const int shift : {axis * kBits, axis * kBits + kDigit}) {
            const int width = std::min(kDigit, (axis + 1) * kBits - shift);
            const uint64_t mask = (uint64_t{1} << width) - 1;
            if ((((all ^ any) >> shift) & mask) == 0) continue;
            uint32_t begin[(1 << kDigit) + 1] = {};
            for (const GrainCell& cell : cells) ++begin[((cell.key >> shift) & mask) + 1];
            for (uint32_t d = 0; d < mask; ++d) begin[d + 1] += begin[d];
            for (const GrainCell& cell : cells) spare[begin[(cell.key >> shift) & mask]++] = cell;
            cells.swap(spare);
        }
}

void list_cells(const Array<GrainBall>& balls, int32_t of, int32_t level, Array<GrainCell>& spare, GrainCells& cells) {
    cells.cell.clear();
    cells.box.clear();
    reserve_more(cells.cell, balls.size());
    reserve_more(cells.box, balls.size());
    for (uint32_t i = 0; i < balls.size(); ++i)
        if (balls[i].level == of) cells.cell.push_back({key_of(balls[i], level), i});
    sort_cells(cells.cell, spare);
    for (const GrainCell& cell : cells.cell) cells.box.push_back(balls[cell.ball].box);
}

// A row of three cells beside each seeker's own, of some targets.
class Row {
public:
    Row(int dy, int dz) : offset_((static_cast<int64_t>(dz) << 2 * kBits) + (static_cast<int64_t>(dy) << kBits)) {}

    // met(ball) for the targets in it whose boxes meet, from `least` of them on. Seekers come in the order of keys.
    template <class Met>
    void seek(const GrainCells& targets, uint64_t key, const GrainBox& box, size_t least, Met&& met) {
        const uint64_t middle = key + static_cast<uint64_t>(offset_);
        const size_t count = targets.cell.size();
        while (begin_ < count && targets.cell[begin_].key < middle - 1) ++begin_;
        while (end_ < count && targets.cell[end_].key <= middle + 1) ++end_;
        for (size_t t = std::max(begin_, least); t < end_; ++t)
            if (box.meets(targets.box[t])) met(targets.cell[t].ball);
    }

private:
    int64_t offset_;
    size_t begin_ = 0, end_ = 0;
};

// Calls met(ball, ball) once for each two of a level whose boxes meet.
template <class Met>
void seek_within(const GrainCells& cells, Met&& met) {
    Row rows[] = {{0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};  // half of those about a cell
    for (size_t k = 0; k < cells.cell.size(); ++k) {
        const auto [key, ball] = cells.cell[k];
        for (Row& row : rows)
            row.seek(cells, key, cells.box[k], k + 1, [&, one = ball](uint32_t other) { met(one, other); });
    }
}

// The same for one of a level with one of a larger.
template <class Met>
void seek_among(const GrainCells& seekers, const GrainCells& targets, Met&& met) {
    Row rows[] = {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {0, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}};
    for (size_t k = 0; k < seekers.cell.size(); ++k) {
        const auto [key, ball] = seekers.cell[k];
        for (Row& row : rows)
            row.seek(targets, key, seekers.box[k], 0, [&, one = ball](uint32_t other) { met(one, other); });
    }
}

template <class Met>
void for_meeting(Grains& grains, Met&& met) {
    uint64_t levels = 0;  // that balls have, a bit each
    for (const GrainBall& ball : grains.ball) levels |= uint64_t{1} << (ball.level - kFirstLevel);
    for (uint64_t larger = levels; larger != 0; larger &= larger - 1) {
        const int32_t level = std::countr_zero(larger) + kFirstLevel;
        list_cells(grains.ball, level, level, grains.spare, grains.targets);
        seek_within(grains.targets, met);
        for (uint64_t smaller = levels & ((larger & ~(larger - 1)) - 1); smaller != 0; smaller &= smaller - 1) {
            list_cells(grains.ball, std::countr_zero(smaller) + kFirstLevel, level, grains.spare, grains.seekers);
            seek_among(grains.seekers, grains.targets, met);
        }
    }
}

// The contacts before, by node a; those of nodes that are gone are left out.
class Before {
public:
    Before(Grains& grains, uint32_t nodes) : first_(grains.first), memory_(grains.before) {
        const Array<GrainContact>& contacts = grains.contact;
        leave_out(grains.gone, nodes, grains.contact);
        first_.assign(nodes + 1, 0);
        memory_.clear();
        reserve_more(memory_, contacts.size());
        memory_.resize(contacts.size());
        for (const GrainContact& contact : contacts) ++first_[contact.a];
        for (uint32_t node = 0; node < nodes; ++node) first_[node + 1] += first_[node];
        for (auto i = static_cast<uint32_t>(contacts.size()); i-- > 0;) {
            const GrainContact& contact = contacts[i];
            memory_[--first_[contact.a]] = {contact.b, i, contact.friction, contact.strain, contact.force};
        }
    }
    const GrainMemory* find(uint32_t a, uint32_t b) const {
        for (uint32_t k = first_[a]; k < first_[a + 1]; ++k)
            if (memory_[k].b == b) return &memory_[k];
        return nullptr;
    }

private:
    void leave_out(Array<uint32_t>& gone, uint32_t nodes, Array<GrainContact>& contacts) {
        if (gone.empty()) return;
        first_.assign(nodes, 0);
        for (const uint32_t node : gone) first_[node] = 1;
        std::erase_if(contacts, [&](const GrainContact& contact) { return first_[contact.a] || first_[contact.b]; });
        gone.clear();
    }

    Array<uint32_t>& first_;
    Array<GrainMemory>& memory_;
};

// When two that close in on each other first touch, or come nearest within a time, as they move now [s].
float meeting_time(const Vec3f& apart, const Vec3f& parting, float both, float time) {
    const float closing = -apart.dot(parting), squared = parting.squaredNorm(),
                beyond = apart.squaredNorm() - both * both;
    if (!(closing > 0 && beyond > 0)) return 0;
    const float under = closing * closing - squared * beyond;
    return std::min(time, under > 0 ? beyond / (closing + std::sqrt(under)) : closing / squared);
}

// Whether two touch in the frame, as they move now: with the normal of where they do. Along it they are as far apart as
// they come nearer until then.
bool touch(const GrainBall& a, const GrainBall& b, float time_step, GrainContact& contact) {
    const Vec3f apart = (b.x - a.x).cast<float>(), parting = b.v - a.v;
    const float both = a.radius + b.radius, time = meeting_time(apart, parting, both, time_step);
    const Vec3f then = time > 0 ? Vec3f(apart + time * parting) : apart;
    const float distance = then.norm();
    if (!(distance - both < std::min(a.margin, b.margin))) return false;
    contact.a = a.node;
    contact.b = b.node;
    contact.normal = distance > 0 ? Vec3f((1 / distance) * then) : Vec3f(Vec3f::UnitY());
    contact.separation = time > 0 ? contact.normal.dot(apart) - both : distance - both;
    contact.force = Vec3f::Zero();
    return true;
}

// The yield of a swept contact under its force, .4 h^2 w |f| (soft_contact.h), in parts of the contact margin.
float strain_of(const GrainBall& a, const GrainBall& b, const GrainContact& contact) {
    return kContactYield * (a.inv_mass + b.inv_mass) * std::max(contact.force.dot(contact.normal), 0.0f) /
           std::min(a.margin, b.margin);
}

// What is made of it where it was more. A load that softer contacts let down swings to twice its weight: so much is
// kept, or substeps that grow with the force and shrink with it would keep it swinging for ever.
float held(float strain, float was, float fading) {
    return std::max(strain, std::min(was, std::max(2 * strain, fading * was)));
}

// What filters, joints and surfaces say of two that touch. False: they do not collide.
bool meet(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const GrainBall& a, const GrainBall& b,
          GrainContact& contact) {
    contact.friction = friction_of(colliders.traits[a.collider].material, colliders.traits[b.collider].material);
    return may_collide(nodes, colliders, pairs, {pair_key(a.collider, b.collider), a.node, b.node});
}

}  // namespace

void find_grain_contacts(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         double time_step) {
    Grains& grains = pairs.grains;
    if (colliders.grains.empty() && grains.contact.empty()) return;
    if (!list_balls(nodes, colliders, shapes, time_step, grains) && !colliders.grains.empty()) return;
    const Before before(grains, nodes.slots());
    const size_t were = grains.contact.size();
    grains.contact.clear();
    const uint64_t rules = colliders.version + pairs.joined_version;
    const bool same_rules = std::exchange(grains.rules, rules) == rules;
    const float fading = 1 / (1 + static_cast<float>(time_step / kYieldMemory));
    bool same = true;
    for_meeting(grains, [&](uint32_t one, uint32_t other) {
        const GrainBall *a = &grains.ball[one], *b = &grains.ball[other];
        if (b->node < a->node) std::swap(a, b);
        GrainContact contact;
        if (!touch(*a, *b, static_cast<float>(time_step), contact)) return;
        const GrainMemory* was = before.find(a->node, b->node);
        if (was) {
            contact.force = was->force;
            contact.friction = was->friction;
        }
        if ((!was || !same_rules) && !meet(nodes, colliders, pairs, *a, *b, contact)) return;
        contact.strain = strain_of(*a, *b, contact);
        if (was) contact.strain = held(contact.strain, was->strain, fading);
        same = same && was && was->index == grains.contact.size();
        grains.contact.push_back(contact);
    });
    grains.version += same && grains.contact.size() == were ? 0 : 1;
}

}  // namespace taut
