#include "solvers/restitution.h"

#include <algorithm>
#include <cmath>

#include "solvers/solver.h"
#include "system/lane_parts.h"
#include "system/operators.h"

namespace taut {
namespace {

constexpr int kMostRounds = 16;   // what closes after these is stopped by the contacts
constexpr int kMostSupports = 8;  // one on the other

// A gap, its rate at the end of the substep, and what of that forces gave.
struct Fall {
    double gap = 0, rate = 0, gained = 0;

    double start() const { return rate - 0.5 * gained; }  // u
    double time(double h) const {
        if (gap <= 0) return 0;
        const double u = start(), root = std::sqrt(std::max(0.0, u * u - 2 * gained / h * gap));
        return root > u ? std::min(h, 2 * gap / (root - u)) : h;
    }
    double squared_speed(double h) const { return start() * start() - 2 * gained / h * std::max(0.0, gap); }
    bool arrives(double h) const { return gap > 0 ? gap + h * rate < 0 : start() < 0; }
};

bool bounces(const Substep& s, double restitution, const Fall& fall) {
    const double least = std::max(s.least_impact(), std::abs(fall.gained));
    return restitution > 0 && fall.arrives(s.system.scheme.h) && fall.squared_speed(s.system.scheme.h) > least * least;
}

Vec3 wide(const float (&p)[3]) { return {p[0], p[1], p[2]}; }
Vec3 column(const float (&p)[3][kLanes], int lane) { return {p[0][lane], p[1][lane], p[2][lane]}; }

class Restitution {
public:
    explicit Restitution(Substep& s)
        : s_(s), sys_(s.system), all_(*s.impacts), impacts_(all_.impact), bodies_(all_.body) {}

    void run() {
        all_.struck.clear();
        all_.strikes.clear();
        if (!sys_.contacts.bounces && !sys_.surfaces.bounces && !any_row_bounces()) return;
        note_forces();
        for (int round = 0; round < kMostRounds && find(); ++round) {
            solve();
            store();
        }
        move_paths();
    }

private:
    bool any_row_bounces() const {
        const auto& block = sys_.rows.block;
        return std::any_of(block.begin() + sys_.rows.joints, block.end(),
                           [](const RowBlock& each) { return each.restitution > 0; });
    }

    // At the substep's begin.
    const NodeMotion& motion(uint32_t at) const {
        return sys_.lent ? sys_.motion[at] : s_.nodes.motion[sys_.node_at[at]];
    }

    void note_forces() {
        const size_t seats = sys_.pose.size();
        all_.flight.assign(seats, {});
        all_.body_of.assign(seats, kNone);
        all_.held.clear();
        for (const uint32_t node : s_.group.nodes) {
            const uint32_t at = sys_.at(node);
            const Vec3& before = motion(at).v;
            for (int i = 0; i < 3; ++i) all_.flight[at].gained[i] = static_cast<float>(sys_.exact[at].v[i] - before[i]);
        }
    }

    // Impacts of a round, cluster by cluster. False: none.
    bool find() {
        impacts_.clear();
        bodies_.clear();
        if (sys_.contacts.bounces) find_in_lanes();
        if (sys_.surfaces.bounces) find_in_surfaces();
        for (uint32_t b = sys_.rows.joints; b < sys_.rows.lasting; ++b) find_in(sys_.rows.block[b]);
        sort_from(0);
        for (Impact& impact : impacts_) prepare(impact);
        std::erase_if(impacts_, [](const Impact& impact) { return !(impact.approach < 0 && impact.k > 0); });
        if (impacts_.empty()) return false;
        find_supports();
        find_clusters();
        return true;
    }

    void sort_from(size_t first) {
        std::sort(impacts_.begin() + static_cast<ptrdiff_t>(first), impacts_.end(), is_before);
    }
    static bool is_before(const Impact& one, const Impact& other) {
        return one.pair != other.pair ? one.pair < other.pair : one.point < other.point;
    }

    // As far as impacts press on them.
    void find_supports() {
        all_.joined.assign(4 * sys_.contacts.group.size(), 0);
        all_.joined_rows.assign(sys_.rows.block.size(), 0);
        all_.joined_surfaces.assign(sys_.surfaces.group.size(), 0);
        for (int level = 0; level < kMostSupports; ++level) {
            press_impacts(impacts_, bodies_);
            const size_t known = impacts_.size();
            find_supports_in_lanes();
            find_supports_in_surfaces();
            find_supports_in_rows();
            sort_from(known);
            for (size_t i = known; i < impacts_.size(); ++i) prepare(impacts_[i]);
            if (impacts_.size() == known) break;
            sort_from(0);
        }
        for (ImpactBody& body : bodies_) {
            body.u = body.before;
            body.moved.setZero();
        }
        for (Impact& impact : impacts_) std::fill(std::begin(impact.impulse), std::end(impact.impulse), 0.0);
    }

    bool is_struck(uint32_t at) const { return all_.body_of[at] != kNone; }

    void find_supports_in_lanes() {
        const auto& groups = sys_.contacts.group;
        for (size_t i = 0; i < groups.size(); ++i) {
            const LaneGroup& g = groups[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                if (!is_struck(g.a[lane]) && !is_struck(g.b[lane])) continue;
                for (uint32_t k = 0; k < g.points; ++k) {
                    const LanePoint& p = g.point[k];
                    uint16_t& joined = all_.joined[4 * i + k];
                    if (!(p.normal_mass[lane] > 0) || p.restitution[lane] > 0 || (joined >> lane & 1) != 0) continue;
                    add(g, static_cast<int>(k), lane);
                    if (keep_pressed()) joined = static_cast<uint16_t>(joined | 1u << lane);
                }
            }
        }
    }

    void find_supports_in_rows() {
        for (uint32_t b = sys_.rows.joints; b < sys_.rows.block.size(); ++b) {
            const RowBlock& block = sys_.rows.block[b];
            if (block.type->bound != Bound::cone || block.restitution > 0 || all_.joined_rows[b] != 0) continue;
            if (std::none_of(block.node, block.node + block.type->nodes, [&](uint32_t at) { return is_struck(at); }))
                continue;
            add(block);
            if (keep_pressed()) all_.joined_rows[b] = 1;
        }
    }

    void find_supports_in_surfaces() {
        const auto& groups = sys_.surfaces.group;
        for (size_t i = 0; i < groups.size(); ++i) {
            uint16_t& joined = all_.joined_surfaces[i];
            for (int lane = 0; lane < kLanes; ++lane) {
                const SurfaceGroup& g = groups[i];
                if (g.contact[lane] == kNoLanes || g.restitution[lane] > 0 || (joined >> lane & 1) != 0) continue;
                if (std::ranges::none_of(g.node, [&](const auto& seats) { return is_struck(seats[lane]); })) continue;
                add(sys_.surfaces.group[i], lane);
                if (keep_pressed()) joined = static_cast<uint16_t>(joined | 1u << lane);
            }
        }
    }

    // Whether the last one is pressed on, as bodies move now; else it goes.
    bool keep_pressed() {
        const Impact& impact = impacts_.back();
        double gap = impact.gap, rate = 0;
        for (const Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
            const uint32_t body = all_.body_of[side->at];
            const Velocity& u = body == kNone ? sys_.exact[side->at] : bodies_[body].u;
            gap += side->linear[0].dot(wide(all_.flight[side->at].moved));
            rate += side->rate(0, u);
        }
        const bool pressed = rate < -s_.least_impact() && gap + sys_.scheme.h * rate < 0;
        if (!pressed) impacts_.pop_back();
        return pressed;
    }

    void find_clusters() {
        for (const Impact& impact : impacts_) {
            uint32_t first = kNone;
            for (int n = 0; n < impact.sides; ++n)
                if (const uint32_t body = impact.side[n].body; body != kNone)
                    first = first == kNone ? cluster_of(body) : join(first, body);
        }
        for (Impact& impact : impacts_)
            for (int n = 0; n < impact.sides; ++n)
                if (impact.side[n].body != kNone) impact.cluster = cluster_of(impact.side[n].body);
        std::sort(impacts_.begin(), impacts_.end(), [](const Impact& one, const Impact& other) {
            return one.cluster != other.cluster ? one.cluster < other.cluster : is_before(one, other);
        });
    }

    void find_in_lanes() {
        const ContactLanes& lanes = sys_.contacts;
        const LaneView view = sys_.contacts.view();
        Array<uint16_t>& found = all_.found;
        found.resize(4 * lanes.group.size());
        const ImpactTerms terms{static_cast<float>(1 / sys_.scheme.h), static_cast<float>(s_.least_impact())};
        for_lane_parts(s_.team, lanes, [&](uint32_t part) {
            s_.settings.kernels->find_impacts(view, lanes.part[part].begin, lanes.part[part].end, sys_.sweep.data(),
                                              sys_.shift.data(), all_.flight.data(), terms, found.data());
        });
        for (size_t i = 0; i < found.size(); ++i)
            for (unsigned left = found[i]; left != 0; left &= left - 1)
                add(lanes.group[i / 4], static_cast<int>(i % 4), __builtin_ctz(left));
    }

    void add(const LaneGroup& g, int k, int lane) {
        LanePoint& p = g.point[k];
        Impact& impact = impacts_.emplace_back();
        impact.pair = g.pair[lane];
        impact.point = k;
        impact.supports = !(p.restitution[lane] > 0);
        impact.peak = &p.peak[lane];
        impact.pushed = nullptr;
        impact.gap = p.gap[lane];
        impact.restitution = p.restitution[lane];
        impact.friction = g.friction[lane];
        for (int t = 0; t < 2; ++t) {
            const bool driven = g.first_drive != kNoLanes;
            impact.drive[t] = driven ? sys_.contacts.drive[g.first_drive + static_cast<uint32_t>(k)].speed[t][lane] : 0;
        }
        const Vec3 n = column(g.normal, lane), t1 = column(g.tangent, lane), t2 = n.cross(t1);
        const Vec3 row[3] = {n, t1, static_cast<double>(sys_.contacts.part_of(g, lane)) * t2};
        const Vec3 lever[2] = {column(p.ra, lane), column(p.rb, lane)};
        impact.sides = 2;
        for (int i = 0; i < 2; ++i) {
            Impact::Side& side = impact.side[i];
            side.at = i == 0 ? g.a[lane] : g.b[lane];
            for (int r = 0; r < 3; ++r) {
                side.linear[r] = i == 0 ? Vec3(-row[r]) : row[r];
                side.angular[r] = lever[i].cross(side.linear[r]);
            }
        }
    }

    void find_in_surfaces() {
        for (SurfaceGroup& g : sys_.surfaces.group) {
            if (!g.bounces) continue;
            for (int lane = 0; lane < kLanes; ++lane) {
                if (!(g.restitution[lane] > 0)) continue;
                add(g, lane);
                const Impact& impact = impacts_.back();
                Fall fall{impact.gap};
                for (int n = 0; n < impact.sides; ++n)
                    add_to(fall, impact.side[n].at, impact.side[n].linear[0], impact.side[n].angular[0]);
                if (!bounces(s_, impact.restitution, fall)) impacts_.pop_back();
            }
        }
    }

    // With the gap of now: the sweeps measure it later.
    void add(SurfaceGroup& g, int lane) {
        Impact& impact = impacts_.emplace_back();
        impact.pair = kNone;
        impact.point = static_cast<int>(g.contact[lane]);
        impact.supports = !(g.restitution[lane] > 0);
        impact.peak = &g.peak[lane];
        impact.pushed = nullptr;
        impact.restitution = static_cast<double>(g.restitution[lane]);
        impact.friction = static_cast<double>(g.friction[lane]);
        for (int t = 0; t < 2; ++t) impact.drive[t] = static_cast<double>(g.drive[t][lane]);
        const Vec3 n = column(g.normal, lane), t1 = column(g.tangent, lane), row[3] = {n, t1, n.cross(t1)};
        const SurfaceTurning* turning = g.turning == kNoLanes ? nullptr : &sys_.surfaces.turning[g.turning];
        double gap = static_cast<double>(g.gap0[lane]);
        impact.sides = kSurfaceNodes;
        for (uint32_t i = 0; i < kSurfaceNodes; ++i) {
            Impact::Side& side = impact.side[i];
            side.at = g.node[i][lane];
            const auto weight = static_cast<double>(g.weight[i][lane]);
            const bool has_lever = i == 0 && turning;
            const Vec3 lever = has_lever ? column(turning->lever, lane) : Vec3(Vec3::Zero());
            for (int r = 0; r < 3; ++r) {
                side.linear[r] = weight * row[r];
                side.angular[r] = lever.cross(side.linear[r]);
            }
            const SweepShift& shift = sys_.shift[side.at];
            gap += side.linear[0].dot(wide(shift.dx));
            if (!has_lever) continue;
            const Quat turn(static_cast<double>(shift.dq[3]), static_cast<double>(shift.dq[0]),
                            static_cast<double>(shift.dq[1]), static_cast<double>(shift.dq[2]));
            const Vec3 core = lever - column(turning->skin, lane);
            gap += side.linear[0].dot(turn * core - core);
        }
        impact.gap = gap;
    }

    void find_in(const RowBlock& block) {
        if (!(block.restitution > 0)) return;
        Fall fall{sys_.rows.error[block.row]};
        for (int n = 0; n < block.type->nodes; ++n) {
            const double* j = row_of(sys_, block, n, 0);
            add_to(fall, block.node[n], Vec3::Map(j), Vec3::Map(j + 3));
        }
        if (bounces(s_, block.restitution, fall)) add(block);
    }

    void add(const RowBlock& block) {
        Impact& impact = impacts_.emplace_back();
        impact.pair = block.pair;
        impact.point = block.pair == kNone ? static_cast<int>(block.surface) : block.point;
        impact.supports = !(block.restitution > 0);
        impact.peak = nullptr;
        impact.pushed = block.pushed;
        impact.gap = sys_.rows.error[block.row];
        impact.restitution = block.restitution;
        impact.friction = block.friction;
        for (int t = 0; t < 2; ++t) impact.drive[t] = block.drive[t];
        impact.sides = block.type->nodes;
        for (int n = 0; n < impact.sides; ++n) {
            impact.side[n].at = block.node[n];
            for (int r = 0; r < 3; ++r) {
                const double* j = row_of(sys_, block, n, r);
                impact.side[n].linear[r] = Vec3::Map(j);
                impact.side[n].angular[r] = Vec3::Map(j + 3);
            }
        }
    }

    void add_to(Fall& fall, uint32_t at, const Vec3& linear, const Vec3& angular) const {
        const SweepFlight& flight = all_.flight[at];
        fall.gap += linear.dot(wide(flight.moved));
        fall.gained += linear.dot(wide(flight.gained));
        fall.rate += along(linear, angular, sys_.exact[at]);
    }

    // When and how fast its points meet, and what an impulse does to them.
    void prepare(Impact& impact) {
        Fall fall{impact.gap};
        bool moves = false;
        double first = sys_.scheme.h;  // of its bodies' impacts
        for (Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
            add_to(fall, side->at, side->linear[0], side->angular[0]);
            side->body = body_at(side->at);
            if (side->body == kNone) continue;
            moves = moves || bodies_[side->body].moves > 0;
            first = std::min(first, bodies_[side->body].time);
        }
        impact.time = !moves ? 0 : impact.supports ? first : fall.time(sys_.scheme.h);
        align(impact);
        Mat3 k = Mat3::Zero();
        for (int r = 0; r < 3; ++r) {
            impact.impulse[r] = impact.known[r] = 0;
            for (int n = 0; n < impact.sides; ++n) add_side(impact, impact.side[n], r, k);
        }
        impact.k = yields(impact, 0, k(0, 0));
        impact.k_across = yields(impact, 1, 0.5 * (k(1, 1) + k(2, 2)) + hypotenuse(0.5 * (k(1, 1) - k(2, 2)), k(1, 2)));
        impact.approach = impact.known[0];
        for (const Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
            if (side->body == kNone) continue;
            ImpactBody& body = bodies_[side->body];
            body.time = std::min(body.time, impact.time);
            impact.approach += side->rate(0, body.before);
        }
        if (!moves && fall.gap > 0)
            impact.restitution = restitution_above(impact, fall.gained / sys_.scheme.h * fall.gap);
    }

    // k of a row, or 0 where locked axes leave rounding alone.
    double yields(const Impact& impact, int r, double k) const {
        double whole = 0;
        bool held = false;
        for (const Impact::Side* side = impact.side; side < impact.side + impact.sides; ++side) {
            if (side->body == kNone) continue;
            NodeVector j;
            j << side->linear[r], side->angular[r];
            whole += unlocked_along(sys_.sweep[side->at], j.data());
            held = held || sys_.sweep[side->at].held();
        }
        return held && !(k > static_cast<double>(kLeastFree) * whole) ? 0 : k;
    }

    // Levers are of when the contact was found, and its sides have moved on since or have a way to go until they meet:
    // with ends that are apart, angular momentum comes from nothing. As they meet, forces of a row act on one line. The
    // side whose centre of mass is further from the normal takes more of the change, so that it turns no ball.
    void align(Impact& impact) const {
        if (impact.sides != 2) return;  // of particles, which do not turn
        Impact::Side *const a = impact.side, *const b = a + 1;
        if (a->body == kNone || b->body == kNone) return;
        const Vec3 end_a = place_at(*a, impact.time) + lever_of(*a), end_b = place_at(*b, impact.time) + lever_of(*b);
        const double arm_a = arm_of(*a), arm_b = arm_of(*b);
        if (!(arm_a + arm_b > 0)) return;
        shift_lever(*a, arm_a / (arm_a + arm_b) * (end_b - end_a));
        shift_lever(*b, arm_b / (arm_a + arm_b) * (end_a - end_b));
    }
    static void shift_lever(Impact::Side& side, const Vec3& by) {
        for (int r = 0; r < 3; ++r) side.angular[r] += by.cross(side.linear[r]);
    }
    // Square of how far the normal is from the centre of mass, and a thousandth of the lever, so that two balls take
    // half each and not what rounding leaves them; of what does not turn, 0 [m^2].
    double arm_of(const Impact::Side& side) const {
        constexpr double kLeastArm = 1e-3;  // of the lever: floats lose 1e-7
        const uint32_t node = sys_.node_at[side.at];
        const bool turns = s_.nodes.mass[node].inv_inertia.xx > 0 && !s_.nodes.locks_of(node).all_angular();
        return turns ? side.angular[0].squaredNorm() + kLeastArm * kLeastArm * lever_of(side).squaredNorm() : 0;
    }
    // Where its path takes a side.
    Vec3 place_at(const Impact::Side& side, double time) const {
        const ImpactBody& body = bodies_[side.body];
        return motion(side.at).x + wide(all_.flight[side.at].moved) + body.moves * time * body.before.v;
    }
    // r of the moments r x l about three axes l at right angles: sum of l x (r x l) = 2 r.
    static Vec3 lever_of(const Impact::Side& side) {
        Vec3 sum = Vec3::Zero();
        for (int r = 0; r < 3; ++r) sum += side.linear[r].cross(side.angular[r]);
        return 0.5 * sum;
    }

    // Of what leaves above the surface: so that it has e^2 of its energy there. work: of forces on the way [m^2/s^2].
    static double restitution_above(const Impact& impact, double work) {
        const double e = impact.restitution, squared = impact.approach * impact.approach;
        const double after = std::max(0.0, e * e * (squared - 2 * work) + 2 * work);
        return std::min(1.0, std::sqrt(after / std::max(squared, 1e-30)));
    }

    void add_side(Impact& impact, Impact::Side& side, int r, Mat3& k) const {
        if (side.body == kNone) {
            impact.known[r] += side.rate(r, sys_.exact[side.at]);
            return;
        }
        const double before = bodies_[side.body].moves * impact.time / sys_.scheme.h;
        impact.known[r] -= (0.5 - before) * side.linear[r].dot(wide(all_.flight[side.at].gained));
        const uint32_t node = sys_.node_at[side.at];
        side.response[r].v = s_.nodes.move_by(node, side.linear[r]);
        side.response[r].w =
            s_.nodes.spin_by(node, sys_.pose[side.at].R, side.angular[r]);  // those of sweeps may be old
        for (int c = 0; c <= r; ++c) k(c, r) += side.rate(c, side.response[r]);
    }

    bool is_held(uint32_t at) {
        Array<uint8_t>& held = all_.held;
        if (held.empty()) {
            held.assign(sys_.pose.size(), 0);
            for (uint32_t b = 0; b < sys_.rows.joints; ++b)
                for (int n = 0; n < sys_.rows.block[b].type->nodes; ++n) held[sys_.rows.block[b].node[n]] = 1;
        }
        return held[at] != 0 || sys_.in_block[at] != 0;
    }

    uint32_t body_at(uint32_t at) {
        if (!(sys_.sweep[at].mass.inv_mass > 0)) return kNone;
        uint32_t& index = all_.body_of[at];
        if (index == kNone) {
            index = static_cast<uint32_t>(bodies_.size());
            const Velocity& u = sys_.exact[at];
            bodies_.push_back({at, index, is_held(at) ? 0.0 : 1.0, sys_.scheme.h, u, u, Vec3::Zero()});
        }
        return index;
    }

    uint32_t cluster_of(uint32_t body) {
        while (bodies_[body].cluster != body) body = bodies_[body].cluster = bodies_[bodies_[body].cluster].cluster;
        return body;
    }
    uint32_t join(uint32_t one, uint32_t other) {
        one = cluster_of(one), other = cluster_of(other);
        const uint32_t first = std::min(one, other);
        bodies_[std::max(one, other)].cluster = first;
        return first;
    }

    void solve() {
        for (size_t begin = 0, end = 0; begin < impacts_.size(); begin = end) {
            while (end < impacts_.size() && impacts_[end].cluster == impacts_[begin].cluster) ++end;
            solve_impacts({&impacts_[begin], end - begin}, bodies_);
        }
    }

    void store() {
        for (const ImpactBody& body : bodies_) {
            all_.body_of[body.at] = kNone;
            sys_.exact[body.at] = body.u;
            set_sweep_velocity(sys_.sweep[body.at].velocity, body.u);
            float(&moved)[3] = all_.flight[body.at].moved;
            for (int i = 0; i < 3; ++i) moved[i] += static_cast<float>(body.moved[i]);
        }
        for (const Impact& impact : impacts_) {
            if (!(impact.impulse[0] > 0)) continue;
            all_.strikes.push_back({impact.pair,
                                    impact.point,
                                    {static_cast<float>(impact.impulse[0]), static_cast<float>(impact.impulse[1]),
                                     static_cast<float>(impact.impulse[2])}});
            if (impact.peak) *impact.peak = std::max(*impact.peak, static_cast<float>(impact.impulse[0]));
            if (impact.pushed) *impact.pushed = true;
        }
    }

    // What contacts see of where paths begin; bodies follow in commit_strikes().
    void move_paths() {
        for (const uint32_t node : s_.group.nodes) {
            const uint32_t at = sys_.at(node);
            const float(&moved)[3] = all_.flight[at].moved;
            if (moved[0] == 0 && moved[1] == 0 && moved[2] == 0) continue;
            float(&dx)[3] = sys_.shift[at].dx;
            all_.struck.push_back({node, {dx[0], dx[1], dx[2]}});
            for (int i = 0; i < 3; ++i) dx[i] += moved[i];
        }
        if (all_.struck.empty()) return;
        for (uint32_t b = sys_.rows.joints; b < sys_.rows.block.size(); ++b) {
            const RowBlock& block = sys_.rows.block[b];
            if (block.type->bound != Bound::cone) continue;
            for (int n = 0; n < block.type->nodes; ++n)
                sys_.rows.error[block.row] +=
                    Vec3::Map(row_of(sys_, block, n, 0)).dot(wide(all_.flight[block.node[n]].moved));
        }
    }

    Substep& s_;
    System& sys_;
    Impacts& all_;
    Array<Impact>& impacts_;
    Array<ImpactBody>& bodies_;
};

}  // namespace

void restitute(Substep& s) { Restitution(s).run(); }

// At the surface, and as fast as the parabola through it: the rest of the substep is lost, and no energy.
double rebound(const Substep& s, double restitution, double gap, double rate, double gained) {
    const Fall fall{gap, rate, gained};
    if (!bounces(s, restitution, fall)) return 0;
    return std::max(0.0, restitution * std::sqrt(fall.squared_speed(s.system.scheme.h)) - 0.5 * gained);
}

}  // namespace taut
