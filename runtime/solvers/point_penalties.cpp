#include "solvers/point_penalties.h"

#include "constraints/positive_part.h"
#include "solvers/point_contacts.h"

namespace taut {
namespace {

constexpr uint32_t kPenaltyGrain = 128;  // points that a thread takes at a time

// act(meeting, obstacle, level) for each that a free point is within.
template <class Act>
void for_within(const MinimisationMemory& m, uint32_t point, Act&& act) {
    if (m.soft[point] == kNone || !m.free[point]) return;
    const double radius = m.obstacles.radius[m.soft[point]];
    const Vec3& x = m.pose[point].x;
    for (const Meeting& meeting : m.obstacles.of(m.soft[point])) {
        const Obstacle& obstacle = m.obstacles.list[meeting.obstacle];
        if (obstacle.exact() || !obstacle.may_hold(x, radius)) continue;
        const collision::LevelSet level = obstacle.level(x, radius);
        if (level.distance < 0) act(meeting, obstacle, level);
    }
}

}  // namespace

double PointPenalties::evaluate() {
    team_.for_ranges(island_.points, kPenaltyGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t p = island_.first_point + begin; p < island_.first_point + end; ++p) {
            PointPenalty& out = m_.penalty[p];
            out = {};
            for_within(m_, p, [&](const Meeting& meeting, const Obstacle&, const collision::LevelSet& level) {
                const double k = meeting.stiffness, depth = -level.distance;
                out.energy += k * depth * depth * depth;
                out.gradient -= 3 * k * depth * depth * level.gradient;
                out.matrix += 6 * k * depth * level.gradient * level.gradient.transpose() -
                              3 * k * depth * depth * level.curvature;
            });
        }
    });
    double sum = 0;
    for (uint32_t p = island_.first_point; p < island_.first_point + island_.points; ++p) sum += m_.penalty[p].energy;
    return share_ * sum;
}

void PointPenalties::add_gradient(std::span<double> gradient) const {
    for (uint32_t i = 0; i < island_.points; ++i) {
        const uint32_t p = island_.first_point + i;
        if (m_.penalty[p].energy > 0) Vec3::Map(&gradient[3 * i]) += share_ * m_.penalty[p].gradient / m_.scale[p];
    }
}

void PointPenalties::add_matrix(Hessian which, Array<double>& matrix) const {
    for (uint32_t p = island_.first_point; p < island_.first_point + island_.points; ++p) {
        if (!(m_.penalty[p].energy > 0)) continue;
        Mat3 k = share_ * m_.penalty[p].matrix;
        if (which == Hessian::positive) clip_negative<3>(k);
        Eigen::Map<Mat3>(&matrix[9 * size_t{m_.diagonal[p]}]) += k / (m_.scale[p] * m_.scale[p]);
    }
}

void rub_penalties(System& system, MinimisationMemory& m) {
    if (!m.obstacles.penalties) return;
    for (uint32_t p = 0; p < m.seat.size(); ++p)
        for_within(m, p, [&](const Meeting& meeting, const Obstacle& obstacle, const collision::LevelSet& level) {
            const double slope = level.gradient.norm(), depth = -level.distance;
            if (!(slope > 0)) return;
            const Vec3 normal = level.gradient / slope;
            const ObstaclePush push{&obstacle, meeting.friction, normal,
                                    3 * meeting.stiffness * depth * depth * slope * system.scheme.h, -depth};
            rub_point(system, m, p, Mat3::Identity() - normal * normal.transpose(), {&push, 1});
        });
}

}  // namespace taut
