// Bodies that others press: solved directly with what presses them, in islands that are not too large for that.
#include <algorithm>

#include "partition/movers.h"
#include "partition/partition.h"
#include "partition/weights.h"

namespace taut {
namespace {

constexpr float kPress = 0.5f;  // cosine: a body between two others is pushed by one against the other

// A contact that bears more weights than sweeps hold is taken in as one with a heavy body is. Where one of the two is
// held already a third is enough, lest some of a row be swept. After so many frames, as blows are over sooner: after
// six, boxes of a pile that landed were in blocks, and with half the load all its columns.
constexpr double kBesideHeld = 1.0 / 3;
constexpr uint8_t kPressedFor = 10;  // frames

// How many weights of the lighter body are too much.
double most_weights(uint32_t bodies, bool beside_held) {
    return taut::most_weights(bodies) * (beside_held ? kBesideHeld : 1);
}

// Counts the frames in which a contact bore more than that [N]; whether it did so for a while.
bool bears(Pairs& pairs, ActivePair& active, double most) {
    const int frames = static_cast<double>(active.borne) > most ? std::min(active.loaded + 1, int{kPressedFor}) : 0;
    if (frames != active.loaded) active.loaded = pairs.list[active.pair].loaded = static_cast<uint8_t>(frames);
    return frames == kPressedFor;
}

bool is_heavy_on(const Nodes& nodes, uint32_t heavy, uint32_t light) {
    return nodes.mass[heavy].mass * nodes.mass[light].inv_mass >= static_cast<double>(kHeavyOnLight);
}

}  // namespace

Vec3f Partition::normal_from(const Pairs& pairs, uint32_t node, uint32_t pair) const {
    const Vec3f& normal = pairs.list[pairs.active[pair].pair].manifold.normal;
    return node == graph_.touches[pair].a ? normal : Vec3f(-normal);
}

void Partition::add_press(const Press& press) {
    pressed_[press.pair] = 1;
    reserve_more(presses_, 1);
    presses_.push_back(press);
}

// What a heavy body pushes against something, whatever the heavy one meets besides: stopped by a wall or the ground
// that it meets behind the light one, it would swallow that in sweeps, and be thrown back as they push it out. Of 160
// pebbles under 10 t that fell on them from a metre, 138 were driven into the ground.
// Likewise what anything presses harder than sweeps hold: of five boxes of .2 kg that a motor pushed against a wall
// with 1 kN one went through it.
void Partition::find_pressed(const Nodes& nodes, Pairs& pairs, const PartitionRules& rules) {
    presses_.clear();
    if (small_.empty()) return;
    const double weight = least_gravity(rules);  // of a mass [N/kg]
    std::fill(pressed_.begin(), pressed_.end(), 0);
    note_held(nodes, pairs);
    find_squeezed(nodes, pairs, weight);
    const double least = most_weights(0, true) * lightest_ * weight;
    for (const uint32_t p : small_) {
        const auto& [a, b] = graph_.touches[p];
        const ActivePair& pair = pairs.active[p];
        if (a == kNone || b == kNone || pair.spans()) continue;
        if (!heavy_on_light_ && static_cast<double>(pair.borne) <= least && pair.loaded == 0) continue;
        const uint32_t light = nodes.mass[a].mass < nodes.mass[b].mass ? a : b, heavy = a + b - light;
        const double most = most_weights(island_[island_of_[a]].nodes, core_[a] || core_[b]);
        const bool bore = bears(pairs, pairs.active[p], most * nodes.mass[light].mass * weight);
        const bool loaded = bore && !island_[island_of_[a]].squeezed;
        if (loaded || is_heavy_on(nodes, heavy, light))
            add_press({light, heavy, p, normal_from(pairs, heavy, p), loaded});
    }
    if (presses_.empty()) return;
    push_on(nodes, pairs);
    std::erase_if(presses_, [](const Press& press) { return !press.holds; });
}

// Into core_: whose contacts were solved directly in the last frame, all or some of them.
void Partition::note_held(const Nodes& nodes, const Pairs& pairs) {
    core_.assign(nodes.slots(), 0);
    for (const uint32_t p : small_) {
        if (!pairs.active[p].in_block) continue;
        for (const uint32_t node : {graph_.touches[p].a, graph_.touches[p].b})
            if (node != kNone) core_[node] = kHeld;
    }
}

// What something kinematic drives into may have no room to go: then nothing holds, and sweeps give way.
void Partition::find_squeezed(const Nodes& nodes, Pairs& pairs, double weight) {
    for (Island& island : island_) island.squeezed = false;
    for (const uint32_t p : small_) {
        const auto& [a, b] = graph_.touches[p];
        if (a != kNone && b != kNone) continue;
        const ActivePair& pair = pairs.active[p];
        const uint32_t pushed = a == kNone ? b : a, by = pair.a == pushed ? pair.b : pair.a;
        if (nodes.info[by].kind != NodeKind::kinematic) continue;
        Island& island = island_[island_of_[pushed]];
        const double most = most_weights(island.nodes, core_[pushed]);
        if (bears(pairs, pairs.active[p], most * nodes.mass[pushed].mass * weight)) island.squeezed = true;
    }
}

// And what that pushes on to something that does not yield, through as many others as there are: of a dozen cubes that
// a box shoved to a wall, the first alone were solved with it, and the rest swallowed.
void Partition::push_on(const Nodes& nodes, const Pairs& pairs) {
    const size_t by_heavy = presses_.size();
    auto& meets_hard = core_;  // until blocks are built
    clear_movers(meets_hard);
    for (size_t i = 0; i < presses_.size(); ++i) {  // grows
        const uint32_t light = presses_[i].light;
        const Vec3f along = presses_[i].along;
        for (const uint32_t p : touches_of(light)) {
            if (!(along.dot(normal_from(pairs, light, p)) > kPress)) continue;
            presses_[i].holds = true;
            const uint32_t next = graph_.touches[p].other(light);
            if (next == kNone || is_heavy_on(nodes, next, light))
                meets_hard[light] = 1;
            else if (!pressed_[p] && !pairs.active[p].spans())
                add_press({next, light, p, along});
        }
    }
    for (size_t i = presses_.size(); i-- > by_heavy;) {
        Press& press = presses_[i];
        press.holds = meets_hard[press.light] != 0;
        if (press.holds) meets_hard[press.by] = 1;
    }
}

void Partition::take_pressed() {
    for (const Press& press : presses_) {
        if (!pair_in_block_[press.pair]) pair_in_block_[press.pair] = join_contact(press.light, press.by);
        if (!pair_in_block_[press.pair]) continue;
        core_[press.light] = core_[press.by] = kTaken;
    }
}

}  // namespace taut
