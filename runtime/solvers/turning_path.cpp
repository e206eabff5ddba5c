#include "solvers/turning_path.h"

#include <Eigen/Cholesky>

namespace taut {
namespace {

constexpr uint32_t kPathGrain = 256;  // points that a thread takes at a time

}  // namespace

Vec3 TurningPath::position(std::span<const double> z, uint32_t i) const {
    const uint32_t p = island_.first_point + i;
    return m_.begin[p] + Vec3::Map(&z[3 * size_t{i}]) / m_.scale[p];
}

void TurningPath::begin(std::span<const double> z, std::span<const double> d) {
    if (island_.pieces == 0) return;
    const std::span<PieceTurn> turns(&m_.turn[island_.first_piece], island_.pieces);
    std::ranges::fill(turns, PieceTurn{});
    const auto for_turning = [&](auto&& act) {
        for (uint32_t i = 0; i < island_.points; ++i)
            if (const uint32_t piece = m_.piece[island_.first_point + i]; piece != kNone)
                act(i, m_.scale[island_.first_point + i], m_.turn[piece]);
    };
    for_turning([&](uint32_t i, double s, PieceTurn& turn) {
        turn.mass += s * s;
        turn.centre += s * s * position(z, i);
        turn.velocity += s * Vec3::Map(&d[3 * size_t{i}]);
    });
    for (PieceTurn& turn : turns) {
        turn.centre /= turn.mass;
        turn.velocity /= turn.mass;
    }
    for_turning([&](uint32_t i, double s, PieceTurn& turn) {
        const Vec3 r = position(z, i) - turn.centre;
        turn.angular += s * r.cross(Vec3::Map(&d[3 * size_t{i}]));
        turn.inertia += s * s * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    });
    for (PieceTurn& turn : turns) turn.angular = turn.inertia.ldlt().solve(turn.angular).eval();
}

void TurningPath::follow(std::span<const double> z, std::span<const double> d, double part, std::span<double> place,
                         std::span<double> way) const {
    for (PieceTurn& turn : std::span(m_.turn).subspan(island_.first_piece, island_.pieces))
        turn.turned = rotation_from_vector(part * turn.angular).toRotationMatrix();
    team_.for_ranges(island_.points, kPathGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const Vec3 from = Vec3::Map(&z[3 * size_t{i}]), along = Vec3::Map(&d[3 * size_t{i}]);
            Eigen::Map<Vec3> to(&place[3 * size_t{i}]), on(&way[3 * size_t{i}]);
            const uint32_t p = island_.first_point + i;
            if (m_.piece[p] == kNone) {
                to = from + part * along;
                on = along;
                continue;
            }
            const PieceTurn& turn = m_.turn[m_.piece[p]];
            const double s = m_.scale[p];
            const Vec3 r = position(z, i) - turn.centre, e = along / s - turn.velocity - turn.angular.cross(r);
            const Vec3 arm = turn.turned * (r + part * e);
            to = s * (turn.centre + part * turn.velocity + arm - m_.begin[p]);
            on = s * (turn.velocity + turn.angular.cross(arm) + turn.turned * e);
        }
    });
}

}  // namespace taut
