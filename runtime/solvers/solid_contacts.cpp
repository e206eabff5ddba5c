#include "solvers/solid_contacts.h"

#include <algorithm>
#include <cmath>

#include "constraints/point_penalty.h"
#include "constraints/positive_part.h"
#include "system/system.h"

namespace taut {
namespace {

constexpr uint32_t kWithinGrain = 32;  // vertices that a thread takes at a time
constexpr uint32_t kPairGrain = 64;    // pairs, likewise

using Square12 = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>;

// Whether a point is within a tetrahedron, whichever way round that is.
bool is_within(const Vec3& point, const Vec3 (&corner)[4]) {
    Mat3 edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = corner[k + 1] - corner[0];
    const double volume = edges.determinant();
    if (volume == 0) return false;
    const Vec3 from = point - corner[0];
    double rest = 1;
    for (int k = 0; k < 3; ++k) {
        const double part = edges.col((k + 1) % 3).cross(edges.col((k + 2) % 3)).dot(from) / volume;
        if (!(part >= 0)) return false;
        rest -= part;
    }
    return rest >= 0;
}

}  // namespace

SolidContacts::SolidContacts(Team& team, const EnergyIsland& island, MinimisationMemory& memory, double share)
    : team_(team), island_(island), m_(memory), share_(share), first_pair_(m_.pair.size()) {
    m_.within.clear();
    if (!m_.obstacles.between.empty()) list_vertices();
}

// What meets is of one island, as it is tied; what is held as a whole is of none.
bool SolidContacts::is_own(const SoftShape& shape) const {
    if (!shape.tied || shape.vertex.empty()) return false;
    const uint32_t point = m_.point_of_node[shape.vertex.front()];
    return point != kNone && point - island_.first_point < island_.points;
}

// Each vertex once for each body that it may be within.
void SolidContacts::list_vertices() {
    for (const SoftShape& shape : m_.obstacles.softs) {
        if (shape.meetings == 0 || !is_own(shape)) continue;
        any_ = true;
        for (const uint32_t vertex : shape.vertex)
            for (uint32_t k = shape.first; k < shape.first + shape.meetings; ++k)
                if (is_own(m_.obstacles.softs[m_.obstacles.between[k].other])) m_.within.push_back({vertex, k, kNone});
    }
}

void SolidContacts::refit() {
    const auto box_of = [&](const Array<uint32_t>& node, uint32_t corners) {
        return [this, &node, corners](uint32_t i) {
            collision::ItemBox box;
            for (uint32_t k = 0; k < corners; ++k) box.add(place(node[corners * size_t{i} + k]));
            return box;
        };
    };
    team_.for_ranges(static_cast<uint32_t>(m_.obstacles.softs.size()), 1, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            SoftShape& shape = m_.obstacles.softs[i];
            if (!is_own(shape)) continue;
            shape.surface.refit(box_of(shape.triangle, 3));
            shape.cells.refit(box_of(shape.cell, 4));
        }
    });
}

// Of a vertex that is within a cell of the other and not of that itself, the nearest triangle of the surface.
uint32_t SolidContacts::find_exit(uint32_t vertex, const SoftShape& other) const {
    const Vec3& at = place(vertex);
    bool within = false;
    const auto test = [&](uint32_t cell) {
        const uint32_t* const node = &other.cell[4 * size_t{cell}];
        if (std::find(node, node + 4, vertex) != node + 4) return true;
        const Vec3 corner[4] = {place(node[0]), place(node[1]), place(node[2]), place(node[3])};
        within = is_within(at, corner);
        return !within;
    };
    if (!other.cells.items() || !other.cells.box().holds(at)) return kNone;
    other.cells.for_holding(at, test);
    if (!within) return kNone;
    return other.surface.nearest(at, [&](uint32_t triangle) {
        const uint32_t* const node = &other.triangle[3 * size_t{triangle}];
        if (std::find(node, node + 3, vertex) != node + 3) return std::numeric_limits<double>::infinity();
        const Vec3 corner[3] = {place(node[0]), place(node[1]), place(node[2])};
        const TrianglePoint nearest = nearest_on_triangle(at, corner);
        Vec3 apart = at;
        for (int k = 0; k < 3; ++k) apart -= nearest.weight[k] * corner[k];
        return apart.squaredNorm();
    });
}

void SolidContacts::find_within() {
    team_.for_ranges(static_cast<uint32_t>(m_.within.size()), kWithinGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            VertexWithin& each = m_.within[i];
            each.triangle = find_exit(each.vertex, m_.obstacles.softs[m_.obstacles.between[each.meeting].other]);
        }
    });
}

void SolidContacts::list_pairs() {
    m_.pair.resize(first_pair_);
    for (const VertexWithin& each : m_.within) {
        if (each.triangle == kNone) continue;
        const SoftShape& other = m_.obstacles.softs[m_.obstacles.between[each.meeting].other];
        PenaltyPair pair{each.meeting, {each.vertex}, {}, {}};
        std::copy_n(&other.triangle[3 * size_t{each.triangle}], 3, pair.node + 1);
        for (int i = 0; i < 4; ++i) pair.point[i] = m_.point_of_node[pair.node[i]];
        m_.pair.push_back(pair);
    }
}

double SolidContacts::evaluate() {
    refit();
    find_within();
    list_pairs();
    team_.for_ranges(pairs(), kPairGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            PenaltyPair& pair = pair_at(i);
            const Vec3 corner[3] = {place(pair.node[1]), place(pair.node[2]), place(pair.node[3])};
            pair.terms = point_penalty(m_.obstacles.between[pair.meeting].stiffness, place(pair.node[0]), corner);
        }
    });
    double sum = 0;
    for (uint32_t i = 0; i < pairs(); ++i) sum += pair_at(i).terms.energy;
    return share_ * sum;
}

void SolidContacts::add_gradient(std::span<double> gradient) const {
    for (uint32_t i = 0; i < pairs(); ++i) {
        const PenaltyPair& pair = pair_at(i);
        for (int k = 0; k < 4; ++k)
            if (m_.free[pair.point[k]])
                Vec3::Map(&gradient[3 * size_t{pair.point[k] - island_.first_point}]) +=
                    share_ * pair.terms.gradient[k] / m_.scale[pair.point[k]];
    }
}

void SolidContacts::linearise(Hessian which) {
    m_.pair_matrix.resize(144 * size_t{pairs()});
    team_.for_ranges(pairs(), kPairGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const PenaltyPair& pair = pair_at(i);
            const Vec3 corner[3] = {place(pair.node[1]), place(pair.node[2]), place(pair.node[3])};
            double* const out = &m_.pair_matrix[144 * size_t{i}];
            point_penalty_hessian(m_.obstacles.between[pair.meeting].stiffness, place(pair.node[0]), corner, out);
            Eigen::Map<Square12> matrix(out);
            matrix *= share_;
            if (which == Hessian::positive) {
                Eigen::Matrix<double, 12, 12> positive = matrix;
                clip_negative<12>(positive);
                matrix = positive;
            }
            for (int k = 0; k < 4; ++k) {
                const uint32_t p = pair.point[k];
                const double scale = m_.free[p] ? 1 / m_.scale[p] : 0;
                matrix.middleRows<3>(3 * k) *= scale;
                matrix.middleCols<3>(3 * k) *= scale;
                if (!m_.hold_of.empty() && m_.hold_of[p] != kNone) {
                    const Mat3& along = m_.hold[m_.hold_of[p]].along;
                    matrix.middleRows<3>(3 * k) = (along * matrix.middleRows<3>(3 * k)).eval();
                    matrix.middleCols<3>(3 * k) = (matrix.middleCols<3>(3 * k) * along).eval();
                }
            }
        }
    });
}

void SolidContacts::add_diagonal(std::span<Mat3> blocks) const {
    for (uint32_t i = 0; i < pairs(); ++i) {
        const auto matrix = Square12::Map(&m_.pair_matrix[144 * size_t{i}]);
        for (int k = 0; k < 4; ++k)
            blocks[pair_at(i).point[k] - island_.first_point] += matrix.block<3, 3>(3 * k, 3 * k);
    }
}

void SolidContacts::add_product(const double* d, double* out) const {
    for (uint32_t i = 0; i < pairs(); ++i) {
        const PenaltyPair& pair = pair_at(i);
        Eigen::Matrix<double, 12, 1> way;
        const auto at = [&](int k) { return 3 * size_t{pair.point[k] - island_.first_point}; };
        for (int k = 0; k < 4; ++k) way.segment<3>(3 * k) = Vec3::Map(d + at(k));
        const Eigen::Matrix<double, 12, 1> image = Square12::Map(&m_.pair_matrix[144 * size_t{i}]) * way;
        for (int k = 0; k < 4; ++k) Vec3::Map(out + at(k)) += image.segment<3>(3 * k);
    }
}

// ---------------------------------------------------------------- friction

// j takes what the four slide by, v = sum w_i v_i across the normal: m v with 1/m = sum w_i^2/m_i, within the cone.
void rub_solids(System& system, MinimisationMemory& m) {
    const double h = system.scheme.h;
    for (const PenaltyPair& pair : m.pair) {
        const SoftMeeting& meeting = m.obstacles.between[pair.meeting];
        const Vec3 corner[3] = {m.pose[pair.point[1]].x, m.pose[pair.point[2]].x, m.pose[pair.point[3]].x};
        const Vec3& at = m.pose[pair.point[0]].x;
        const TrianglePoint nearest = nearest_on_triangle(at, corner);
        const Vec3 force = -pair.terms.gradient[0];
        const double push = force.norm();
        if (!(push > 0)) continue;
        const Vec3 normal = force / push;
        double weight[4] = {1, -nearest.weight[0], -nearest.weight[1], -nearest.weight[2]}, inverse[4], mobility = 0;
        Vec3 before = Vec3::Zero(), slide = Vec3::Zero();
        Vec3 apart = at;
        for (int k = 0; k < 4; ++k) {
            const uint32_t p = pair.point[k], seat = m.seat[p];
            inverse[k] = m.free[p] ? 1 / (m.scale[p] * m.scale[p] * system.scheme.stiffness()) : 0;
            mobility += weight[k] * weight[k] * inverse[k];
            slide += weight[k] * system.exact[seat].v;
            before += weight[k] * system.start[seat].v;
            if (k > 0) apart += weight[k] * m.pose[p].x;
        }
        if (!(mobility > 0)) continue;
        slide -= normal.dot(slide) * normal;
        const double speed = slide.norm();
        const Vec3 rubbed = speed > 0 ? Vec3(-std::min(meeting.friction * push * h, speed / mobility) / speed * slide)
                                      : Vec3(Vec3::Zero());
        for (int k = 0; k < 4; ++k) system.exact[m.seat[pair.point[k]]].v += weight[k] * inverse[k] * rubbed;
        PointPush told{pair.node[0],
                       kNone,
                       {pair.node[1], pair.node[2], pair.node[3]},
                       {},
                       Vec3::Zero(),
                       normal,
                       -apart.norm(),
                       push * h,
                       rubbed,
                       -normal.dot(before)};
        for (int k = 0; k < 3; ++k) told.weight[k] = static_cast<float>(nearest.weight[k]);
        m.obstacles.push.push_back(told);
    }
}

}  // namespace taut
