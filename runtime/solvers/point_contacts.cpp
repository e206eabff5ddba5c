#include "solvers/point_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constraints/positive_part.h"

namespace taut {
namespace {

constexpr uint32_t kTouchGrain = 128;  // points that a thread takes at a time

using Normals = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostWays>;
using Weights = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostWays, 1>;
using Gram = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostWays, kMostWays>;

// w of least squares |N w - g|; of normals that depend on each other, in equal parts.
Weights solve_for(const Normals& normals, const Weights& right) {
    constexpr double kOfGram = 1e-12;
    Gram gram = normals.transpose() * normals;
    gram.diagonal().array() += kOfGram;
    return gram.ldlt().solve(right);
}

// Of normals, those that push: mu >= 0 with N^T N mu = right. What would pull most is let go until nothing does.
struct Pushing {
    uint32_t count;
    uint32_t of[kMostWays];
    Normals normals;
    Weights push;
};
Pushing pushing(const Normals& normals, const Weights& right) {
    Pushing out{static_cast<uint32_t>(normals.cols()), {0, 1, 2}, {}, {}};
    static_assert(kMostWays == 3);
    while (true) {
        out.normals.resize(3, out.count);
        out.push.resize(out.count);
        if (out.count == 0) return out;
        Weights own(out.count);
        for (uint32_t i = 0; i < out.count; ++i) {
            out.normals.col(i) = normals.col(out.of[i]);
            own[i] = right[out.of[i]];
        }
        out.push = solve_for(out.normals, own);
        Eigen::Index least;
        if (!(out.push.minCoeff(&least) < 0)) return out;
        std::copy(out.of + least + 1, out.of + out.count, out.of + least);
        --out.count;
    }
}

// 1 - N N^T of the space that normals span.
Mat3 across(const Normals& normals) {
    Mat3 out = Mat3::Identity();
    for (Eigen::Index i = 0; i < normals.cols(); ++i) {
        constexpr double kDependent = 1e-6;  // sine of an angle: what rounding leaves of one that is spanned already
        const Vec3 rest = out * normals.col(i);
        const double size = rest.norm();
        if (size > kDependent) out -= rest * rest.transpose() / (size * size);
    }
    return out;
}

// -sum mu d2phi/dx2
Mat3 bend_of(const PointHold& hold, Hessian which) {
    Mat3 out = -hold.curve;
    if (which == Hessian::positive) clip_negative<3>(out);
    return out;
}

}  // namespace

PointContacts::PointContacts(Team& team, const EnergyIsland& island, MinimisationMemory& memory)
    : team_(team), island_(island), m_(memory), first_hold_(m_.hold.size()) {
    if (!m_.obstacles.any()) return;
    for (uint32_t p = island.first_point; p < island.first_point + island.points; ++p) {
        m_.hold_of[p] = kNone;
        any_ = any_ || !meetings_of(p).empty();
    }
}

std::span<const Meeting> PointContacts::meetings_of(uint32_t point) const {
    const uint32_t soft = m_.soft[point];
    return soft == kNone || !m_.free[point] ? std::span<const Meeting>() : m_.obstacles.of(soft);
}

// ---------------------------------------------------------------- projection

uint32_t PointContacts::deepest(const PointTouch& touch, std::span<const Meeting> meetings, double radius,
                                const Vec3& x) const {
    uint32_t found = kNone;
    double depth = 0;
    for (uint32_t i = 0; i < meetings.size(); ++i) {
        const Obstacle& obstacle = m_.obstacles.list[meetings[i].obstacle];
        if (!obstacle.exact() || !obstacle.may_hold(x, radius) || touch.has(i)) continue;
        const double distance = obstacle.level(x, radius).distance;
        if (distance < depth) found = i, depth = distance;
    }
    return found;
}

// x - N (N^T N)^-1 phi, and its derivative. On one surface phi is a distance, which that takes to 0; on several as long
// as it falls: by squares, until rounding is left, or surfaces that do not meet are at their least.
void PointContacts::take_out(PointTouch& touch, std::span<const Meeting> meetings, double radius, Vec3& x) const {
    touch.pull.setIdentity();
    for (double left = std::numeric_limits<double>::infinity();;) {
        Normals normals(3, touch.count);
        Weights distance(touch.count);
        Mat3 curvature[kMostWays];
        double square = 0;
        for (uint32_t i = 0; i < touch.count; ++i) {
            const collision::LevelSet level = m_.obstacles.list[meetings[touch.way[i]].obstacle].level(x, radius);
            normals.col(i) = level.gradient;
            distance[i] = level.distance;
            square += level.distance * level.distance;
            curvature[i] = level.curvature;
        }
        if (!(square < left)) return;
        left = square;
        const Weights weight = solve_for(normals, distance);
        Mat3 pull = across(normals);
        for (uint32_t i = 0; i < touch.count; ++i) pull -= weight[i] * curvature[i];
        x -= normals * weight;
        touch.pull = pull * touch.pull;
        if (touch.count == 1) return;
    }
}

void PointContacts::project_point(uint32_t p) {
    const std::span<const Meeting> meetings = meetings_of(p);
    PointTouch& touch = m_.touch[p];
    touch.count = 0;
    if (meetings.empty()) return;
    const double radius = m_.obstacles.radius[m_.soft[p]];
    const Vec3 from = m_.pose[p].x;
    if (m_.hold_of[p] != kNone) {
        const PointHold& hold = m_.hold[m_.hold_of[p]];
        for (uint32_t i = 0; i < hold.count; ++i) touch.way[touch.count++] = hold.way[i];
        take_out(touch, meetings, radius, m_.pose[p].x);
    }
    while (touch.count < kMostWays) {
        const uint32_t way = deepest(touch, meetings, radius, m_.pose[p].x);
        if (way == kNone) break;
        touch.way[touch.count++] = way;
        m_.pose[p].x = from;
        take_out(touch, meetings, radius, m_.pose[p].x);
    }
}

void PointContacts::project() {
    team_.for_ranges(island_.points, kTouchGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) project_point(island_.first_point + i);
    });
}

void PointContacts::pull_back(std::span<double> gradient) const {
    for (uint32_t i = 0; i < island_.points; ++i) {
        const PointTouch& touch = m_.touch[island_.first_point + i];
        if (touch.count == 0) continue;
        Eigen::Map<Vec3> g(&gradient[3 * i]);
        g = (touch.pull.transpose() * g).eval();
    }
}

// ---------------------------------------------------------------- what is held

// Least squares of g = N mu with mu >= 0.
void PointContacts::hold_point(uint32_t p, Vec3& gradient) {
    const std::span<const Meeting> meetings = meetings_of(p);
    const PointTouch& touch = m_.touch[p];
    const double radius = m_.obstacles.radius[m_.soft[p]];
    Normals normals(3, touch.count);
    Mat3 curvature[kMostWays];
    for (uint32_t i = 0; i < touch.count; ++i) {
        const collision::LevelSet level =
            m_.obstacles.list[meetings[touch.way[i]].obstacle].level(m_.pose[p].x, radius);
        normals.col(i) = level.gradient;
        curvature[i] = level.curvature;
    }
    const Pushing found = pushing(normals, normals.transpose() * gradient);
    if (found.count == 0) return;
    PointHold hold{p, found.count, {}, {}, {}, across(found.normals), Mat3::Zero()};
    for (uint32_t i = 0; i < found.count; ++i) {
        hold.way[i] = touch.way[found.of[i]];
        hold.normal[i] = found.normals.col(i);
        hold.push[i] = found.push[i];
        hold.curve += found.push[i] / m_.scale[p] * curvature[found.of[i]];
    }
    gradient = hold.along * gradient;
    m_.hold_of[p] = static_cast<uint32_t>(m_.hold.size());
    m_.hold.push_back(hold);
}

void PointContacts::hold(std::span<double> gradient) {
    release();
    for (uint32_t i = 0; i < island_.points; ++i) {
        const uint32_t p = island_.first_point + i;
        if (m_.touch[p].count == 0) continue;
        Vec3 g = Vec3::Map(&gradient[3 * i]);
        hold_point(p, g);
        Vec3::Map(&gradient[3 * i]) = g;
    }
}

void PointContacts::release() {
    m_.hold.resize(first_hold_);
    if (any_) std::fill_n(m_.hold_of.begin() + island_.first_point, island_.points, kNone);
}

void PointContacts::restrict(Hessian which, Array<double>& matrix) const {
    if (m_.hold.size() == first_hold_) return;
    team_.for_ranges(island_.points, kTouchGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t p = island_.first_point + begin; p < island_.first_point + end; ++p) {
            const PointHold* const row = m_.hold_of[p] == kNone ? nullptr : &m_.hold[m_.hold_of[p]];
            for (uint32_t b = m_.row_begin[p]; b < m_.row_begin[p + 1]; ++b) {
                const uint32_t q = m_.column[b];
                Eigen::Map<Mat3> a(&matrix[9 * size_t{b}]);
                if (row && p == q) a += bend_of(*row, which);
                if (row) a = (row->along * a).eval();
                if (m_.hold_of[q] != kNone) a = (a * m_.hold[m_.hold_of[q]].along).eval();
                if (row && p == q) a += Mat3::Identity() - row->along;
            }
        }
    });
}

// ---------------------------------------------------------------- friction

void rub_point(System& system, MinimisationMemory& m, uint32_t point, const Mat3& along,
               std::span<const ObstaclePush> pushes) {
    const uint32_t seat = m.seat[point];
    const double mass = m.scale[point] * m.scale[point] * system.scheme.stiffness();
    const auto count = static_cast<double>(pushes.size());
    Vec3& v = system.exact[seat].v;
    const Vec3& place = m.pose[point].x;
    double most = 0;
    Vec3 driven = Vec3::Zero();
    for (const ObstaclePush& push : pushes) {
        most += push.friction * push.impulse;
        driven += push.obstacle->velocity_at(place) / count;
    }
    const Vec3 slide = along * (v - driven);
    const double speed = slide.norm();
    const Vec3 rubbed = speed > 0 ? Vec3(-std::min(most, mass * speed) / speed * slide) : Vec3(Vec3::Zero());
    v += rubbed / mass;
    for (const ObstaclePush& push : pushes) {
        const Obstacle& of = *push.obstacle;
        m.obstacles.push.push_back({system.node_at[seat],
                                    of.collider,
                                    {of.node, kNone, kNone},
                                    {1, 0, 0},
                                    place - of.centre,
                                    push.normal,
                                    push.gap,
                                    push.impulse,
                                    rubbed / count,
                                    push.normal.dot(of.velocity_at(place) - system.start[seat].v)});
    }
}

// Impulses of what holds a point [N s]. Of one step those of u, t mu. Else v' is to have the obstacle's velocity along
// each normal, and they are what that takes: as in implicit Euler contacts do not bounce, and bear what weighs on them.
void stop_point(System& system, const MinimisationMemory& m, const PointHold& hold, ObstaclePush* pushes) {
    const double scale = m.scale[hold.point], mass = scale * scale * system.scheme.stiffness();
    const auto impulse_in_u = [&](uint32_t i) { return scale * hold.push[i] * system.scheme.act; };
    if (system.scheme.is_one_step()) {
        for (uint32_t i = 0; i < hold.count; ++i) pushes[i].impulse = impulse_in_u(i);
        return;
    }
    Vec3& v = system.exact[m.seat[hold.point]].v;
    Normals normals(3, hold.count);
    for (uint32_t i = 0; i < hold.count; ++i) {
        normals.col(i) = hold.normal[i];
        v -= impulse_in_u(i) / mass * hold.normal[i];
    }
    Weights missing(hold.count);
    for (uint32_t i = 0; i < hold.count; ++i)
        missing[i] = hold.normal[i].dot(pushes[i].obstacle->velocity_at(m.pose[hold.point].x) - v);
    const Pushing found = pushing(normals, missing);
    v += found.normals * found.push;
    for (uint32_t i = 0; i < found.count; ++i) pushes[found.of[i]].impulse = mass * found.push[i];
}

void rub_points(System& system, MinimisationMemory& m) {
    for (const PointHold& hold : m.hold) {
        ObstaclePush pushes[kMostWays];
        for (uint32_t i = 0; i < hold.count; ++i) {
            const Meeting& meeting = m.obstacles.of(m.soft[hold.point])[hold.way[i]];
            pushes[i] = {&m.obstacles.list[meeting.obstacle], meeting.friction, hold.normal[i], 0, 0};
        }
        stop_point(system, m, hold, pushes);
        rub_point(system, m, hold.point, hold.along, {pushes, hold.count});
    }
}

}  // namespace taut
