// Gear, and rack with pinion: what b does in the housing is ratio times what a does there.
//   C = q_b - ratio q_a - rest
// q of an angle: the twist about X from the housing's frame to the body's (frame_rows.h), counted over whole turns;
// q of a slide: (p_b - p_h) . X_h. C is 0 where they meshed. The twist's gradient (X_h + X)/(1 + X_h . X) is that of a
// joint of constant velocity: a shaft that leans in the housing, as a steered wheel's, is driven evenly.
//
// Poses tell an angle up to whole turns. Each substep it is followed to the turn that is nearest to the last angle plus
// its gradient times the turns that the nodes made, which may be of any size, so that nothing adds up over the turns.
#include "constraints/gear.h"

#include "constraints/axis.h"
#include "constraints/coupled_pair.h"
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct AngleOfPair {
    template <class Writer>
    static void row(Writer& out) {
        out.twist(0);
    }
    static constexpr int kRows = 1;
};

// A slide comes with those across it, which carry nothing.
struct SlideOfPair {
    template <class Writer>
    static void row(Writer& out) {
        out.slides();
    }
    static constexpr int kRows = 3;
};

JointFrames frames_of(const GearData& data, int side) {
    return {data.anchors.guide(side), data.anchors.of(side), data.housing_frame[side], data.frame[side]};
}

template <class Row>
double evaluate_pair(const GearData& data, int side, const Pose* x, double* j) {
    const JointFrames frames = frames_of(data, side);
    const FramePair f(&frames, x);
    double value[Row::kRows], rows[2 * Row::kRows * kDof];
    RowWriter out(f, Row::kRows, value, j ? rows : nullptr);
    Row::row(out);
    for (int node = 0; j && node < 2; ++node) std::copy_n(rows + node * Row::kRows * kDof, kDof, j + node * kDof);
    return value[0];
}

template <class Row>
void stiffness_of_pair(const GearData& data, int side, const Pose* x, double lambda, Curvature part, double* k) {
    const JointFrames frames = frames_of(data, side);
    const FramePair f(&frames, x);
    const double force[3] = {lambda, 0, 0};
    StiffnessWriter out(f, force, k, part);
    Row::row(out);
    out.finish();
}

template <class RowOfB>
struct Gear {
    using Data = GearData;
    static constexpr bool kSlides = RowOfB::kRows > 1;

    static bool is_angle(int side) { return side == 0 || !kSlides; }
    static double weight(const Data& data, int side) { return side == 0 ? -data.ratio : 1; }
    static double rest(const Data& data) { return data.rest; }

    static double evaluate(const Data& data, int side, const Pose* x, double* j) {
        if (!is_angle(side)) return evaluate_pair<RowOfB>(data, side, x, j);
        return nearest_turn(evaluate_pair<AngleOfPair>(data, side, x, j), data.value[side]);
    }
    static void stiffness(const Data& data, int side, const Pose* x, double lambda, Curvature part, double* k) {
        is_angle(side) ? stiffness_of_pair<AngleOfPair>(data, side, x, lambda, part, k)
                       : stiffness_of_pair<RowOfB>(data, side, x, lambda, part, k);
    }

    static void restart(void* to, const Pose* x) {
        Data& data = *static_cast<Data*>(to);
        for (int side = 0; side < 2; ++side) {
            const Pose pair[2] = {x[2], x[side]};
            data.value[side] = 0;
            data.value[side] = evaluate(data, side, pair, nullptr);
        }
        data.rest = data.value[1] - data.ratio * data.value[0];
    }
    static void follow(void* to, const Pose* x, const Vec3* turned) {
        Data& data = *static_cast<Data*>(to);
        for (int side = 0; side < 2; ++side) {
            if (!is_angle(side)) continue;
            const Pose pair[2] = {x[2], x[side]};
            double j[2 * kDof];
            const double read = evaluate_pair<AngleOfPair>(data, side, pair, j);
            const double change = Vec3::Map(j + 3).dot(turned[2]) + Vec3::Map(j + kDof + 3).dot(turned[side]);
            data.value[side] = nearest_turn(read, data.value[side] + change);
        }
    }
};

template <class RowOfB>
void sample_gear(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& gear = *static_cast<GearData*>(data);
    gear = {};
    random.poses(x, 3);
    for (int side = 0; side < 2; ++side) {
        JointFrames frames;
        Pose pair[2];
        const double swing = random.between(0.2, 1.5), direction = random.between(-3, 3);
        sample_frames(random, swing_after_twist(swing, direction, random.between(-2.7, 2.7)), &frames, pair);
        (side == 0 ? gear.anchors.a : gear.anchors.b) = frames.anchor_b;
        (side == 0 ? gear.anchors.guide_a : gear.anchors.apart) = frames.anchor_a;
        gear.housing_frame[side] = frames.frame_a;
        gear.frame[side] = frames.frame_b;
        x[side].R = x[2].R * pair[0].R.transpose() * pair[1].R;
    }
    gear.ratio = random.between(0.3, 3);
    Gear<RowOfB>::restart(data, x);
    gear.rest += random.between(-1, 1);  // not where they meshed
}

template <class RowOfB>
constexpr ConstraintType gear_type(const char* name) {
    ConstraintType type = coupled_type<Gear<RowOfB>>(name, RowOfB::kRows > 1 ? 0 : 1, sample_gear<RowOfB>);
    type.restart = Gear<RowOfB>::restart;
    type.follow = Gear<RowOfB>::follow;
    return type;
}

}  // namespace

constinit const ConstraintType kGear = gear_type<AngleOfPair>("gear");
constinit const ConstraintType kRackPinion = gear_type<SlideOfPair>("rack_pinion");

}  // namespace taut
