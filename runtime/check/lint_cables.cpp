#include <utility>

#include "check/lint_context.h"
#include "models/cable.h"

namespace taut {
namespace {

constexpr double kMostBend = 0.5236;  // between two segments on something round: above 30 degrees it is a corner [rad]
constexpr double kLeastSlimness = 1;  // length of a segment over the cable's diameter: below, it is a ball
constexpr double kMostStrain = 0.1;   // a cable that gives more is not one that hardly stretches

bool is_round(collision::ShapeKind kind) {
    using collision::ShapeKind;
    return kind == ShapeKind::sphere || kind == ShapeKind::capsule || kind == ShapeKind::cylinder;
}

// Angle between the segments before and after an inner point [rad].
double bend_at_point(const World& world, const Cable& cable, uint32_t point) {
    const Vec3 a = cable_point(world, cable, point) - cable_point(world, cable, point - 1);
    const Vec3 b = cable_point(world, cable, point + 1) - cable_point(world, cable, point);
    return angle_of(a.cross(b).norm(), a.dot(b));
}

class CableLint {
public:
    explicit CableLint(const LintContext& context)
        : context_(context), world_(context.world), on_round_(context.nodes.slots(), uint8_t{0}, context.memory) {}

    void run() {
        mark_what_is_on_round();
        for (uint32_t index = 0; index < world_.cables.ids.slots(); ++index) {
            if (!world_.cables.ids.live(index)) continue;
            const Cable& cable = world_.cables.record[index];
            sharpest_bend(cable);
            shortest_segment(cable);
            largest_strain(cable);
        }
    }

private:
    // Nodes whose segment touched a sphere, a capsule or a cylinder in the last step, other than a cable's.
    void mark_what_is_on_round() {
        for_awake_pairs(world_.pairs, [&](const Pair& pair) {
            if (!pair.touching) return;
            for (const auto& [mine, other] :
                 {std::pair(pair.a, pair.collider_b()), std::pair(pair.b, pair.collider_a())}) {
                const Collider& collider = world_.colliders.record[other];
                if (world_.nodes.info[mine].cable == kNone || world_.nodes.info[collider.node].cable != kNone) continue;
                if (is_round(world_.shapes[collider.shape].shape.kind)) on_round_[mine] = 1;
            }
        });
    }

    // Between two segments, one of which lies on something round.
    void sharpest_bend(const Cable& cable) {
        double most = 0;
        uint32_t at = 0;
        for (uint32_t point = 1; point < cable.segments(); ++point) {
            if (!on_round_[cable.node[point - 1]] && !on_round_[cable.node[point]]) continue;
            if (!is_whole(world_, cable, point - 1)) continue;
            const double bend = bend_at_point(world_, cable, point);
            if (bend > most) most = bend, at = point;
        }
        context_.add_above(TAUT_LINT_CABLE_COARSE, cable.node[at], kNone, most, kMostBend);
    }

    // The nominal one: those at the ends are short while they are reeled.
    void shortest_segment(const Cable& cable) {
        const double slimness = cable.nominal / (2 * cable.radius);
        if (slimness < kLeastSlimness)
            context_.add(TAUT_LINT_CABLE_SHORT_SEGMENTS, cable.node[0], kNone, slimness, kLeastSlimness);
    }

    void largest_strain(const Cable& cable) {
        double most = 0;
        uint32_t at = 0;
        for (uint32_t segment = 0; segment < cable.segments(); ++segment) {
            const double strain = cable.stretch_compliance * cable_tension(world_, cable, segment);
            if (strain > most) most = strain, at = segment;
        }
        context_.add_above(TAUT_LINT_CABLE_STRAIN, cable.node[at], kNone, most, kMostStrain);
    }

    const LintContext& context_;
    const World& world_;
    Array<uint8_t> on_round_;  // of nodes
};

}  // namespace

void lint_cables(const LintContext& context) { CableLint(context).run(); }

}  // namespace taut
