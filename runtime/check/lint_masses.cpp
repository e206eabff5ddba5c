// Mass ratios within blocks, over joints and over contacts.
#include <utility>

#include "check/lint_context.h"

namespace taut {
namespace {

// What is held, and by whom.
constexpr double kBlockMassRatio = 1e4;  // by a direct block: chains stay closed from any start up to here
constexpr double kSweptMassRatio = 10;   // by sweeps: above, a load sinks in or a joint stretches visibly

class MassLint {
public:
    explicit MassLint(const LintContext& context)
        : context_(context), nodes_(context.nodes), block_(context), direct_pairs_(context.memory) {
        context_.for_joints([&](uint32_t, const Joint& joint) {
            if (context_.direct(joint)) block_.unite(joint);
        });
        context_.for_attachments([&](uint32_t, const Attachment& attachment) {
            if (context_.direct(attachment)) block_.unite(attachment);
        });
        collect_direct_pairs();
    }

    void run() {
        blocks();
        swept_joints();
        contacts();
        light_between_heavy();
    }

private:
    bool moves(uint32_t node) const { return context_.moves(node); }
    double mass(uint32_t node) const { return context_.mass(node); }

    // Contacts that the last step solved within blocks.
    void collect_direct_pairs() {
        const Partition& partition = context_.world.partition;
        const auto& active = context_.world.pairs.active;
        for (uint32_t g = 0; g < partition.group_count; ++g) {
            for (uint32_t p : partition.groups[g].direct_pairs) {
                if (p >= active.size()) continue;  // of a step that ran out of memory
                direct_pairs_.push_back(pair_key(active[p].a, active[p].b));
            }
        }
        std::sort(direct_pairs_.begin(), direct_pairs_.end());
    }
    bool direct(const Pair& pair) const {
        return std::binary_search(direct_pairs_.begin(), direct_pairs_.end(), pair_key(pair.a, pair.b));
    }

    void blocks() {
        Array<uint32_t> light(nodes_.slots(), kNone, context_.memory), heavy(light);  // by root
        for (uint32_t node = 0; node < nodes_.slots(); ++node) {
            if (!moves(node)) continue;
            const uint32_t root = block_.root_of(node);
            if (light[root] == kNone || mass(node) < mass(light[root])) light[root] = node;
            if (heavy[root] == kNone || mass(node) > mass(heavy[root])) heavy[root] = node;
        }
        for (uint32_t root = 0; root < light.size(); ++root) {
            if (light[root] == kNone) continue;
            context_.add_above(TAUT_LINT_BLOCK_MASS_RATIO, light[root], kNone, mass(heavy[root]) / mass(light[root]),
                               kBlockMassRatio);
        }
    }

    void swept_joints() {
        context_.for_joints([&](uint32_t j, const Joint& joint) {
            if (context_.direct(joint)) return;
            const uint32_t light = context_.lightest_of(joint);
            double heaviest = 0;
            for (uint32_t node : joint.nodes())
                if (moves(node)) heaviest = std::max(heaviest, mass(node));
            context_.add_above(TAUT_LINT_JOINT_MASS_RATIO, light, j, heaviest / mass(light), kSweptMassRatio);
        });
    }

    // A body on a lighter one, against gravity; without gravity nothing rests.
    void contacts() {
        for_awake_pairs(context_.world.pairs, [&](const Pair& pair) {
            uint32_t light = pair.a, heavy = pair.b;
            if (!pair.touching || !moves(light) || !moves(heavy)) return;
            if (mass(light) > mass(heavy)) std::swap(light, heavy);
            if ((nodes_.motion[heavy].x - nodes_.motion[light].x).dot(context_.gravity()) >= 0) return;
            context_.add_above(TAUT_LINT_CONTACT_MASS_RATIO, light, kNone, mass(heavy) / mass(light),
                               direct(pair) ? kBlockMassRatio : kSweptMassRatio);
        });
    }

    struct Neighbours {
        double first = 0, second = 0;  // the two heaviest [kg]
        bool swept = false;            // one of them by a swept joint or contact
    };
    void meet(Array<Neighbours>& around, uint32_t a, uint32_t b, bool swept) const {
        if (!moves(a) || !moves(b)) return;
        for (const auto& [node, other] : {std::pair(a, b), std::pair(b, a)}) {
            Neighbours& n = around[node];
            if (mass(other) <= kSweptMassRatio * mass(node)) continue;
            n.second = std::max(n.second, std::min(n.first, mass(other)));
            n.first = std::max(n.first, mass(other));
            n.swept = n.swept || swept;
        }
    }
    void light_between_heavy() {
        Array<Neighbours> around(nodes_.slots(), Neighbours{}, context_.memory);
        context_.for_joints([&](uint32_t, const Joint& joint) {
            const auto ends = joint.nodes();
            for (size_t b = 0; b < ends.size(); ++b)
                for (size_t a = 0; a < b; ++a) meet(around, ends[a], ends[b], !context_.direct(joint));
        });
        for_awake_pairs(context_.world.pairs, [&](const Pair& pair) {
            if (pair.touching) meet(around, pair.a, pair.b, !direct(pair));
        });
        for (uint32_t node = 0; node < nodes_.slots(); ++node) {
            const Neighbours& n = around[node];
            if (n.second == 0) continue;
            context_.add_above(TAUT_LINT_LIGHT_BETWEEN_HEAVY, node, kNone, n.second / mass(node),
                               n.swept ? kSweptMassRatio : kBlockMassRatio);
        }
    }

    const LintContext& context_;
    const Nodes& nodes_;
    Connected block_;               // by joints that are solved directly
    Array<uint64_t> direct_pairs_;  // keys, sorted
};

}  // namespace

void lint_masses(const LintContext& context) { MassLint(context).run(); }

}  // namespace taut
