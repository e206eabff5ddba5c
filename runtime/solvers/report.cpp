#include "solvers/report.h"

#include <algorithm>
#include <cmath>

#include "constraints/soft_contact.h"
#include "solvers/bounded_row.h"
#include "system/operators.h"

namespace taut {
namespace {

// How far a row gives way, over w times its impulse: y = s h^2 w f = give w p [s].
double give_of(const SweepTerms& t) {
    return static_cast<double>(t.impulse_scale) /
           (static_cast<double>(t.mass_scale) * static_cast<double>(t.bias_rate));
}

double kinetic_energy_of(const NodeMass& mass, const NodeMotion& m) {
    const Vec3 spin = m.q.conjugate() * m.w;  // body axes
    return 0.5 * (mass.mass * m.v.squaredNorm() + spin.dot(mass.inertia.matrix() * spin));
}

// Error and Jacobian of a constraint at the start of the substep, and what it does in it.
class Evaluated {
public:
    Evaluated(const System& system, const RowBlock& block) : system_(system), block_(block), rows_(block.type->rows) {
        Pose x[kMaxNodes];
        for (int n = 0; n < block.type->nodes; ++n) x[n] = system.pose[block.node[n]];
        block.type->evaluate(block.data, x, error_, jacobian_);
    }

    // J v of a node.
    double rate(int r, int n, const Velocity& u) const { return along(jacobian_ + (n * rows_ + r) * kDof, u); }
    double rate(int r, const Array<Velocity>& velocity) const {
        double sum = 0;
        for (int n = 0; n < block_.type->nodes; ++n) sum += rate(r, n, velocity[block_.node[n]]);
        return sum;
    }
    double inverse_mass(int r) const {  // J W J^T
        double sum = 0;
        for (int n = 0; n < block_.type->nodes; ++n)
            sum += inverse_mass_along(system_.sweep[block_.node[n]], jacobian_ + (n * rows_ + r) * kDof);
        return sum;
    }
    // Largest |C(x + h v) - C(x) - h J v| of the first rows that are lengths [m].
    double curved(int first_rows) const {
        Pose x[kMaxNodes];
        double moved[kMaxRows], largest = 0;
        for (int n = 0; n < block_.type->nodes; ++n) {
            const Pose& at = system_.pose[block_.node[n]];
            const Velocity& u = system_.exact[block_.node[n]];
            x[n] = {at.x + system_.scheme.h * u.v, rotation_from_vector(system_.scheme.h * u.w) * at.R};
        }
        block_.type->evaluate(block_.data, x, moved, nullptr);
        for (int r = 0; r < first_rows; ++r)
            if (is_gap(r))
                largest = std::max(largest, std::abs(moved[r] - error_[r] - system_.scheme.h * rate(r, system_.exact)));
        return largest;
    }
    // Whether a row is a length to keep.
    bool is_gap(int r) const { return !block_.angular(r) && block_.locked(r); }

private:
    const System& system_;
    const RowBlock& block_;
    int rows_;
    double error_[kMaxRows], jacobian_[kMaxNodes * kMaxRows * kDof];
};

// Where a row block stands in Rows::block.
struct Place {
    bool joint, direct;
};
Place place_of(const Rows& rows, uint32_t index) {
    return {index < rows.joints, index < rows.direct || index >= rows.lasting};
}

// A swept contact point.
struct SweptPoint {
    Vec3 p = Vec3::Zero();                       // impulses: normal, tangents [N s]
    double gap = 0, mass = 0, tangent_mass = 0;  // [m], [kg]
    bool hits = false;
};

SweptPoint point_of(const System& system, const RowBlock& block, const Evaluated& at) {
    const auto mass = [](double inverse) { return inverse > 0 ? 1 / inverse : 0; };
    return {impulse_of(system, block).head<3>(), system.rows.error[block.row], mass(at.inverse_mass(0)),
            mass(std::max(at.inverse_mass(1), at.inverse_mass(2))), block.hits};
}

// A point of a lane.
struct PointOfLane : SweptPoint {
    Vec3 ra, rb, n, t1, t2;  // t2 as its row counts

    PointOfLane(const ContactLanes& lanes, const LaneGroup& g, uint32_t k, int lane) {
        const LanePoint& point = g.point[k];
        const auto load = [lane](const float(&from)[3][kLanes]) {
            return Vec3(static_cast<double>(from[0][lane]), static_cast<double>(from[1][lane]),
                        static_cast<double>(from[2][lane]));
        };
        n = load(g.normal), t1 = load(g.tangent), t2 = static_cast<double>(lanes.part_of(g, lane)) * n.cross(t1);
        ra = load(point.ra), rb = load(point.rb), p = load(point.impulse);
        gap = static_cast<double>(point.gap[lane]);
        mass = static_cast<double>(point.normal_mass[lane]);
        tangent_mass = static_cast<double>(point.isotropic_mass[lane]);
        hits = -point.approach[lane] > kHardSpeed;
    }
    Vec3 impulse() const { return p[0] * n + p[1] * t1 + p[2] * t2; }
};

// By how much one more biased pass over a normal row would change its J v [m/s]; as in constraints/contact_sweep.inl.
double normal_change(const SweptPoint& at, double vn, const SweepTerms& terms) {
    const bool open = at.gap > 0, soft = !open && !at.hits;
    const double bias = open
                            ? at.gap * static_cast<double>(terms.inv_h)
                            : std::max(static_cast<double>(terms.bias_rate) * at.gap, -static_cast<double>(terms.push));
    const double scale = soft ? static_cast<double>(terms.mass_scale) : 1;
    const double kept = soft ? 1 - static_cast<double>(terms.impulse_scale) : 1;
    const double next = std::max(0.0, kept * at.p[0] - scale * at.mass * (vn + bias));
    return at.mass > 0 ? std::abs(next - at.p[0]) / at.mass : 0;  // else nothing yields
}

// Likewise over the tangents, isotropic.
double friction_change(const SweptPoint& at, const Eigen::Vector2d& slip, double friction) {
    const Eigen::Vector2d p(at.p[1], at.p[2]);
    const double most = friction * at.p[0];
    Eigen::Vector2d next = p - at.tangent_mass * slip;
    if (next.norm() > most) next *= most / next.norm();
    return at.tangent_mass > 0 ? (next - p).norm() / at.tangent_mass : 0;
}

// h^2/2 n . w x (w x r) of the levers' cores, which turn; their skins do not (state/levers.h) [m].
double lever_curve(const System& system, const LaneGroup& g, int lane, uint32_t k, const PointOfLane& at) {
    const auto bent = [&](uint32_t seat, const Vec3& lever) {
        const Vec3& w = system.exact[seat].w;
        return at.n.dot(w.cross(w.cross(lever)));
    };
    Vec3 core[2] = {at.ra - static_cast<double>(g.round[0][lane]) * at.n,
                    at.rb + static_cast<double>(g.round[1][lane]) * at.n};
    for (int side = 0; side < 2 && g.has_axes; ++side) {
        const LaneRolling& axles = system.contacts.rolling[g.rolling];
        for (int i = 0; i < 3; ++i)
            core[side][i] -= static_cast<double>(axles.rim[k][side][lane] * axles.across[side][i][lane]);
    }
    return 0.5 * system.scheme.h * system.scheme.h * std::abs(bent(g.b[lane], core[1]) - bent(g.a[lane], core[0]));
}

// act(group, lane, k) for each point of the swept pairs.
template <class Act>
void for_lane_points(const ContactLanes& lanes, Act&& act) {
    for (const LaneGroup& g : lanes.group)
        for (int lane = 0; lane < kLanes; ++lane)
            for (uint32_t k = 0; g.pair[lane] != kNoLanes && k < g.points; ++k)
                if (g.point[k].normal_mass[lane] > 0) act(g, lane, k);
}

// act(joint group, lane, row block) for each swept joint.
template <class Act>
void for_lane_joints(const System& system, Act&& act) {
    for (const JointGroup& g : system.joints.group)
        for (int lane = 0; lane < kLanes; ++lane)
            if (g.block[lane] != kNoLanes) act(g, lane, system.rows.block[g.block[lane]]);
}

Eigen::Vector2d drive_of(const ContactLanes& lanes, const LaneGroup& g, int lane, uint32_t k) {
    if (g.first_drive == kNoLanes) return Eigen::Vector2d::Zero();
    const LaneDrive& drive = lanes.drive[g.first_drive + k];
    return Eigen::Vector2f(drive.speed[0][lane], drive.speed[1][lane]).cast<double>();
}

Vec3 velocity_at(const Velocity& u, const Vec3& lever) { return u.v + u.w.cross(lever); }

// c p of a row of a swept joint [m/s].
double yielding_of(const JointLanes& lanes, const JointGroup& g, int lane, uint32_t r) {
    double sum = 0;
    for (uint32_t k = 0; g.first_compliance != kNoLanes && k < g.held; ++k)
        sum += static_cast<double>(
            lanes.compliance[g.first_compliance + (r > k ? triangle(r, k) : triangle(k, r))].value[lane] *
            lanes.row[g.first_row + k].impulse[lane]);
    return sum;
}

}  // namespace

// One substep of the reports, as its rows are gone through.
struct SolveReports::Measure {
    SolveReports& to;
    const Measured& m;
    const System& system = m.system;
    SweepTerms contact = contact_terms(m.system.scheme.h, m.system.stretch),
               joint = joint_terms(m.system.scheme.h, m.system.stretch);

    // Of the first of these seats that forces move; null: none, a quarantined body on a fixed one.
    IslandReport* report(std::span<const uint32_t> seats) const {
        for (const uint32_t seat : seats) {
            const uint32_t node = system.node_at[seat];
            const uint32_t island = node == kNone ? kNone : m.partition.island_of(node);
            if (island != kNone) return &to.open_[island];
        }
        return nullptr;
    }
    IslandReport* report(const RowBlock& block) const {
        return report({block.node, static_cast<size_t>(block.type->nodes)});
    }
    IslandReport* report(const LaneGroup& g, int lane) const {
        const uint32_t seats[] = {g.a[lane], g.b[lane]};
        return report(seats);
    }

    void residual_of_points() const {
        for_lane_points(system.contacts, [&](const LaneGroup& g, int lane, uint32_t k) {
            IslandReport* const out = report(g, lane);
            if (!out) return;
            const PointOfLane at(system.contacts, g, k, lane);
            const Vec3 v = velocity_at(system.exact[g.b[lane]], at.rb) - velocity_at(system.exact[g.a[lane]], at.ra);
            const Eigen::Vector2d slip =
                Eigen::Vector2d(at.t1.dot(v), at.t2.dot(v)) - drive_of(system.contacts, g, lane, k);
            const auto friction = static_cast<double>(system.contacts.friction_now(g, k, lane));
            const double change =
                std::max(normal_change(at, at.n.dot(v), contact), friction_change(at, slip, friction));
            out->residual = std::max(out->residual, system.scheme.h * change);
            if (at.p[0] > 0) out->linearisation = std::max(out->linearisation, lever_curve(system, g, lane, k, at));
        });
    }
    void residual_of_swept_joints() const {
        const JointLanes& lanes = system.joints;
        for_lane_joints(system, [&](const JointGroup& g, int lane, const RowBlock& block) {
            IslandReport* const out = report(block);
            if (!out) return;
            const Evaluated at(system, block);
            for (uint32_t r = 0; r < g.held; ++r) {
                const LaneRow& row = lanes.row[g.first_row + r];
                const int i = static_cast<int>(r);
                if (!at.is_gap(i)) continue;
                const double left =
                    at.rate(i, system.exact) - static_cast<double>(row.bias[lane]) + yielding_of(lanes, g, lane, r);
                out->residual = std::max(out->residual, system.scheme.h * std::abs(left));
            }
            out->linearisation = std::max(out->linearisation, at.curved(block.type->rows));
        });
    }
    void residual_of_rows() const {
        for (uint32_t i = 0; i < system.rows.block.size(); ++i) {
            const RowBlock& block = system.rows.block[i];
            IslandReport* const out = report(block);
            if (!out || block.in_lanes || block.type->bound == Bound::load) continue;
            const Evaluated at(system, block);
            const Place place = place_of(system.rows, i);
            if (place.joint || !place.direct) {
                const double left = place.joint ? left_of_joint(block, at) : left_of_contact(block, at);
                out->residual = std::max(out->residual, system.scheme.h * left);
            }
            if (place.joint || system.rows.impulse[block.row] > 0)
                out->linearisation = std::max(out->linearisation, at.curved(place.joint ? block.type->rows : 1));
        }
    }
    // Largest |J v + c mu - target| of the rows to keep [m/s].
    double left_of_joint(const RowBlock& block, const Evaluated& at) const {
        const RowVector rest =
            error_rate_of(system, block) + compliance_of(block, system.scheme) * impulse_of(system, block);
        double largest = 0;
        for (int r = 0; r < block.type->rows; ++r)
            if (at.is_gap(r)) largest = std::max(largest, std::abs(rest[r] + at.rate(r, system.exact)));
        return largest;
    }
    double left_of_contact(const RowBlock& block, const Evaluated& at) const {
        const SweptPoint point = point_of(system, block, at);
        const Eigen::Vector2d slip(at.rate(1, system.exact) - block.drive[0],
                                   at.rate(2, system.exact) - block.drive[1]);
        return std::max(normal_change(point, at.rate(0, system.exact), contact),
                        friction_change(point, slip, block.friction));
    }

    void add_yield(IslandReport& out, bool direct, bool is_contact, double yield, double margin) const {
        double& largest = direct ? out.direct_yield : out.yield;
        largest = std::max(largest, yield);
        if (yield > 0)
            to.rows.push_back(
                {out.island, out.substep, direct, is_contact, static_cast<float>(yield), static_cast<float>(margin)});
    }
    double margin_of(uint32_t pair) const {
        if (pair == kNone) return 0;  // of surfaces
        const Pair& of = m.pairs.list[pair];
        return static_cast<double>(
            std::min(m.pairs.travel[of.collider_a()].margin, m.pairs.travel[of.collider_b()].margin));
    }
    void yield_of_points() const {
        const double give = give_of(contact);
        for_lane_points(system.contacts, [&](const LaneGroup& g, int lane, uint32_t k) {
            IslandReport* const out = report(g, lane);
            if (!out) return;
            out->rows += kContactRows;
            const LanePoint& p = g.point[k];
            const auto soft = static_cast<double>(p.impulse[0][lane]) / static_cast<double>(p.normal_mass[lane]);
            add_yield(*out, false, true, give * soft, margin_of(g.pair[lane]));
        });
    }
    void yield_of_rows() const {
        for (uint32_t i = 0; i < system.rows.block.size(); ++i) {
            const RowBlock& block = system.rows.block[i];
            IslandReport* const out = report(block);
            if (!out || block.in_lanes || block.type->bound == Bound::load) continue;
            const Place place = place_of(system.rows, i);
            const Evaluated at(system, block);
            const double give = give_of(place.joint ? joint : contact);
            double yield = 0;
            uint32_t count = place.joint ? 0 : kContactRows;
            for (int r = 0; r < (place.joint ? block.type->rows : 1); ++r) {
                if (place.joint && block.locked(r)) ++count;
                if (!at.is_gap(r) || block.elastic(r)) continue;
                yield = std::max(yield, give * at.inverse_mass(r) *
                                            std::abs(system.rows.impulse[block.row + static_cast<uint32_t>(r)]));
            }
            out->rows += count;
            if (place.direct) out->direct_rows += count;
            add_yield(*out, place.direct, !place.joint, yield, place.joint ? 0 : margin_of(block.pair));
        }
    }
    void yield_of_swept_joints() const {
        const double give = give_of(joint);
        for_lane_joints(system, [&](const JointGroup& g, int lane, const RowBlock& block) {
            IslandReport* const out = report(block);
            if (!out) return;
            double yield = 0;
            for (uint32_t r = 0; r < g.rows; ++r) {
                const int i = static_cast<int>(r);
                if (!block.locked(i)) continue;
                ++out->rows;
                const LaneRow& row = system.joints.row[g.first_row + r];
                if (!block.angular(i) && !block.elastic(i))
                    yield = std::max(yield, give * static_cast<double>(row.own[lane]) *
                                                std::abs(static_cast<double>(row.impulse[lane])));
            }
            add_yield(*out, false, false, yield, 0);
        });
    }

    // Kinetic energy, times a sign, onto the islands of the group's nodes.
    void add_kinetic(double sign) const {
        for (const uint32_t node : m.group.nodes)
            to.open_[m.partition.island_of(node)].energy +=
                sign * kinetic_energy_of(m.nodes.mass[node], m.nodes.motion[node]);
    }
    // Work of gravity and loads over the way that the positions went.
    void take_work_of_forces() const {
        for (const uint32_t node : m.group.nodes) {
            const uint32_t seat = system.at(node);
            const NodeMass& mass = m.nodes.mass[node];
            const NodeLoad& load = m.nodes.load_of(node);
            const Vec3 force = mass.mass * mass.gravity_scale * m.gravity + load.force;
            const double work = force.dot(m.nodes.motion[node].x - system.pose[seat].x) +
                                system.scheme.h * load.torque.dot(to.mean_[seat].w);
            to.open_[m.partition.island_of(node)].energy -= work;
        }
    }
    // What kinematic bodies, springs, drives and stops give along a joint's rows.
    void take_work_of_joint(const RowBlock& block, const double* impulse) const {
        IslandReport* const out = report(block);
        if (!out) return;
        const Evaluated at(system, block);
        for (int r = 0; r < block.type->rows; ++r) {
            const bool ideal = block.locked(r) && !block.elastic(r);
            for (int n = 0; n < block.type->nodes; ++n) {
                const uint32_t seat = block.node[n];
                if (is_moved(seat) != ideal)
                    out->energy -= (ideal ? -1 : 1) * impulse[r] * at.rate(r, n, to.mean_[seat]);
            }
        }
    }
    // Whether forces move it.
    bool is_moved(uint32_t seat) const {
        const uint32_t node = system.node_at[seat];
        return node != kNone && m.nodes.solved(node);
    }
    void take_work_of_points() const {
        for_lane_points(system.contacts, [&](const LaneGroup& g, int lane, uint32_t k) {
            IslandReport* const out = report(g, lane);
            if (!out) return;
            const PointOfLane at(system.contacts, g, k, lane);
            const Vec3 p = at.impulse();
            if (!is_moved(g.a[lane])) out->energy -= p.dot(velocity_at(to.mean_[g.a[lane]], at.ra));
            if (!is_moved(g.b[lane])) out->energy += p.dot(velocity_at(to.mean_[g.b[lane]], at.rb));
            out->energy -= at.p.tail<2>().dot(drive_of(system.contacts, g, lane, k));
        });
    }
    void take_work_of_rows() const {
        for (uint32_t i = 0; i < system.rows.block.size(); ++i) {
            const RowBlock& block = system.rows.block[i];
            if (!block.in_lanes) take_work_of_joint(block, &system.rows.impulse[block.row]);
        }
        for_lane_joints(system, [&](const JointGroup& g, int lane, const RowBlock& block) {
            double impulse[kMaxRows];
            for (uint32_t r = 0; r < g.rows; ++r)
                impulse[r] = static_cast<double>(system.joints.row[g.first_row + r].impulse[lane]);
            take_work_of_joint(block, impulse);
        });
    }
};

void SolveReports::begin_step(const Partition& partition, const Joints& joints, const Elements& elements) {
    islands.clear();
    rows.clear();
    partition.find_reasons(joints, elements, reasons_);
    open_.assign(partition.islands, {});
}

void SolveReports::begin(const Measured& m) {
    before_.resize(m.system.node_at.size());
    for (const uint32_t node : m.group.nodes) {
        const uint32_t island = m.partition.island_of(node);
        open_[island] = {};
        open_[island].reasons = reasons_[island];
    }
    for (const uint32_t node : m.group.nodes) {
        IslandReport& out = open_[m.partition.island_of(node)];
        out.island = m.partition.island_of(node);
        out.substep = m.substep;
        out.substeps = m.group.substeps;
        out.sweeps = m.group.sweeps;
        out.h = m.system.scheme.h;
        ++out.bodies;
        before_[m.system.at(node)] = {m.nodes.motion[node].v, m.nodes.motion[node].w};
    }
    Measure{*this, m}.add_kinetic(-1);
}

void SolveReports::solved(const Measured& m) {
    const Measure measure{*this, m};
    measure.residual_of_points();
    measure.residual_of_swept_joints();
    measure.residual_of_rows();
}

void SolveReports::end(const Measured& m) {
    mean_.assign(m.system.node_at.size(), {});
    for (const uint32_t node : m.group.nodes) {
        const uint32_t seat = m.system.at(node);
        const NodeMotion& now = m.nodes.motion[node];
        mean_[seat] = {0.5 * (before_[seat].v + now.v), 0.5 * (before_[seat].w + now.w)};
    }
    for (const uint32_t node : m.system.kinematic)
        mean_[m.system.at(node)] = {m.nodes.motion[node].v, m.nodes.motion[node].w};
    const Measure measure{*this, m};
    measure.yield_of_points();
    measure.yield_of_rows();
    measure.yield_of_swept_joints();
    measure.add_kinetic(1);
    measure.take_work_of_forces();
    measure.take_work_of_points();
    measure.take_work_of_rows();
    for (const uint32_t node : m.group.nodes) {
        IslandReport& out = open_[m.partition.island_of(node)];
        if (out.rows > 0) islands.push_back(std::exchange(out, {}));
    }
}

}  // namespace taut
