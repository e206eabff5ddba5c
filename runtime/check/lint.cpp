#include "check/lint.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "state/joint_reading.h"

namespace taut {
namespace {

// What is held, and by whom.
constexpr double kBlockMassRatio = 1e4;  // by a direct block: chains stay closed from any start up to here
constexpr double kSweptMassRatio = 10;   // by sweeps: above, a load sinks in or a joint stretches visibly
constexpr double kThinness = 100;  // largest over smallest principal inertia: above, a rod spins up about its axis
constexpr double kSoftLoad = 10;   // of a swept joint: weights of its lighter end
// Below this share of h^2 J W J^T a compliance is lost in what sweeps leave over.
constexpr double kLeastCompliance = 1e-3;
constexpr double kGap = 0.01, kMisalignment = 0.1;  // of joints and stops: what closes without being seen [m], [rad]
constexpr double kNarrowGap = 1e-3, kNarrowAngle = 1e-2;  // room in which a stop is met in every step [m], [rad]
constexpr double kRedundant = 1e-6;                       // share of a row that earlier rows do not hold
// Mechanisms with more rows are not looked at for redundancy: the work grows with the square.
constexpr size_t kMostRows = 1200;

class Lint {
public:
    explicit Lint(World& world)
        : world_(world),
          nodes_(world.nodes),
          joints_(world.joints),
          found_(world.memory),
          parent_(world.memory),
          direct_pairs_(world.memory) {}

    Array<taut_lint_entry> run() {
        connect();
        collect_direct_pairs();
        masses_of_blocks();
        for_joints([&](uint32_t j, const Joint& joint) { mass_ratio_of(j, joint); });
        masses_of_contacts();
        light_between_heavy();
        thin_bodies();
        for_joints([&](uint32_t j, const Joint& joint) { softness_of(j, joint); });
        redundant_rows();
        for_joints([&](uint32_t j, const Joint& joint) { fit_of(j, joint); });
        lint_cables(world_, found_);
        std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
        return std::move(found_);
    }

private:
    bool moves(uint32_t node) const { return node != kNone && moves_by_forces(nodes_.info[node].kind); }
    double mass(uint32_t node) const { return nodes_.mass[node].mass; }
    bool direct(const Joint& joint) const {
        return solvers()[world_.def.solver]->direct && joint.solve != JointSolve::swept;
    }
    double substep() const { return static_cast<double>(world_.def.time_step) / world_.def.substeps; }
    Vec3 gravity() const { return {world_.def.gravity.x, world_.def.gravity.y, world_.def.gravity.z}; }

    // Joints of which at least one end moves.
    template <class Act>
    void for_joints(Act act) {
        for (uint32_t j = 0; j < joints_.record.size(); ++j) {
            const Joint& joint = joints_.record[j];
            if (lightest_of(joint) != kNone) act(j, joint);
        }
    }

    // The lightest of a joint's nodes that move, the first of such; kNone: none moves.
    uint32_t lightest_of(const Joint& joint) const {
        uint32_t light = kNone;
        for (uint32_t node : joint.nodes())
            if (moves(node) && (light == kNone || mass(node) < mass(light))) light = node;
        return light;
    }

    void add(taut_lint_kind kind, uint32_t node, uint32_t joint, double value, double limit) {
        found_.push_back({kind, 0, world_.body_handle(node), world_.joint_handle(joint), static_cast<float>(value),
                          static_cast<float>(limit)});
    }
    void add_above(taut_lint_kind kind, uint32_t node, uint32_t joint, double value, double limit) {
        if (value > limit) add(kind, node, joint, value, limit);
    }

    // ------------------------------------------------------------ masses

    uint32_t find(uint32_t node) {
        while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
        return node;
    }
    void unite(const Joint& joint) {
        uint32_t first = kNone;
        for (uint32_t node : joint.nodes()) {
            if (!moves(node)) continue;
            if (first == kNone) first = node;
            const uint32_t a = find(first), b = find(node);
            if (a != b) parent_[std::max(a, b)] = std::min(a, b);
        }
    }
    // Bodies that directly solved joints connect; roots are the smallest slot.
    void connect() {
        parent_.resize(nodes_.slots());
        std::iota(parent_.begin(), parent_.end(), 0u);
        for_joints([&](uint32_t, const Joint& joint) {
            if (direct(joint)) unite(joint);
        });
    }

    // Contacts that the last step solved within blocks.
    void collect_direct_pairs() {
        const Partition& partition = world_.partition;
        for (uint32_t g = 0; g < partition.group_count; ++g) {
            for (uint32_t p : partition.groups[g].direct_pairs) {
                if (p >= world_.pairs.active.size()) continue;  // of a step that ran out of memory
                const ActivePair& pair = world_.pairs.active[p];
                direct_pairs_.push_back(pair_key(pair.a, pair.b));
            }
        }
        std::sort(direct_pairs_.begin(), direct_pairs_.end());
    }
    bool direct(const Pair& pair) const {
        return std::binary_search(direct_pairs_.begin(), direct_pairs_.end(), pair_key(pair.a, pair.b));
    }

    void masses_of_blocks() {
        Array<uint32_t> light(parent_.size(), kNone, world_.memory), heavy(light);
        for (uint32_t node = 0; node < nodes_.slots(); ++node) {
            if (!moves(node)) continue;
            const uint32_t root = find(node);
            if (light[root] == kNone || mass(node) < mass(light[root])) light[root] = node;
            if (heavy[root] == kNone || mass(node) > mass(heavy[root])) heavy[root] = node;
        }
        for (uint32_t root = 0; root < light.size(); ++root) {
            if (light[root] == kNone) continue;
            add_above(TAUT_LINT_BLOCK_MASS_RATIO, light[root], kNone, mass(heavy[root]) / mass(light[root]),
                      kBlockMassRatio);
        }
    }

    void mass_ratio_of(uint32_t j, const Joint& joint) {
        if (direct(joint)) return;
        const uint32_t light = lightest_of(joint);
        double heaviest = 0;
        for (uint32_t node : joint.nodes())
            if (moves(node)) heaviest = std::max(heaviest, mass(node));
        add_above(TAUT_LINT_JOINT_MASS_RATIO, light, j, heaviest / mass(light), kSweptMassRatio);
    }

    // A body on a lighter one, against gravity; without gravity nothing rests.
    void masses_of_contacts() {
        for_awake_pairs(world_.pairs, [&](const Pair& pair) {
            uint32_t light = pair.a, heavy = pair.b;
            if (!pair.touching || !moves(light) || !moves(heavy)) return;
            if (mass(light) > mass(heavy)) std::swap(light, heavy);
            if ((nodes_.motion[heavy].x - nodes_.motion[light].x).dot(gravity()) >= 0) return;
            add_above(TAUT_LINT_CONTACT_MASS_RATIO, light, kNone, mass(heavy) / mass(light),
                      direct(pair) ? kBlockMassRatio : kSweptMassRatio);
        });
    }

    struct Neighbours {
        double first = 0, second = 0;  // the two heaviest [kg]
        bool swept = false;            // one of them by a swept joint or contact
    };
    void light_between_heavy() {
        Array<Neighbours> around(nodes_.slots(), Neighbours{}, world_.memory);
        const auto meet = [&](uint32_t a, uint32_t b, bool swept) {
            if (!moves(a) || !moves(b)) return;
            for (const auto& [node, other] : {std::pair(a, b), std::pair(b, a)}) {
                Neighbours& n = around[node];
                if (mass(other) <= kSweptMassRatio * mass(node)) continue;
                n.second = std::max(n.second, std::min(n.first, mass(other)));
                n.first = std::max(n.first, mass(other));
                n.swept = n.swept || swept;
            }
        };
        for_joints([&](uint32_t, const Joint& joint) {
            const auto ends = joint.nodes();
            for (size_t b = 0; b < ends.size(); ++b)
                for (size_t a = 0; a < b; ++a) meet(ends[a], ends[b], !direct(joint));
        });
        for_awake_pairs(world_.pairs, [&](const Pair& pair) {
            if (pair.touching) meet(pair.a, pair.b, !direct(pair));
        });
        for (uint32_t node = 0; node < nodes_.slots(); ++node) {
            const Neighbours& n = around[node];
            if (n.second == 0) continue;
            add_above(TAUT_LINT_LIGHT_BETWEEN_HEAVY, node, kNone, n.second / mass(node),
                      n.swept ? kSweptMassRatio : kBlockMassRatio);
        }
    }

    // Joints turn a thin body about its thin axis with next to no inertia.
    void thin_bodies() {
        Array<uint8_t> jointed(nodes_.slots(), uint8_t{0}, world_.memory);
        for_joints([&](uint32_t, const Joint& joint) {
            for (uint32_t node : joint.nodes())
                if (node != kNone) jointed[node] = 1;
        });
        for (uint32_t node = 0; node < nodes_.slots(); ++node) {
            if (!jointed[node] || nodes_.info[node].kind != NodeKind::dynamic) continue;
            const Vec3 principal = principal_of(nodes_.mass[node].inertia.matrix());
            add_above(TAUT_LINT_THIN_INERTIA, node, kNone, principal.maxCoeff() / principal.minCoeff(), kThinness);
        }
    }
    // Eigenvalues by Jacobi's rotations, largest element first; a few rounds reach rounding.
    static Vec3 principal_of(Mat3 m) {
        for (int round = 0; round < 24; ++round) {
            int p = 0, q = 1;
            for (const auto& [i, j] : {std::pair(0, 2), std::pair(1, 2)})
                if (std::abs(m(i, j)) > std::abs(m(p, q))) p = i, q = j;
            if (!(std::abs(m(p, q)) > 1e-15 * m.trace())) break;
            const double half = 0.5 * (m(q, q) - m(p, p)) / m(p, q);
            const double t = (half >= 0 ? 1 : -1) / (std::abs(half) + std::sqrt(half * half + 1));
            const double c = 1 / std::sqrt(t * t + 1), s = t * c;
            Mat3 turn = Mat3::Identity();
            turn(p, p) = turn(q, q) = c;
            turn(p, q) = s, turn(q, p) = -s;
            m = (turn.transpose() * m * turn).eval();
        }
        return m.diagonal();
    }

    // ------------------------------------------------------------ swept joints

    void softness_of(uint32_t j, const Joint& joint) {
        if (direct(joint)) return;
        const JointReading reading = read_joint(nodes_, joint);
        const uint32_t light = lightest_of(joint);
        const double weight = mass(light) * gravity().norm();
        if (weight > 0)
            add_above(TAUT_LINT_SOFT_LOAD, light, j, wrench_of(joint, reading).force.norm() / weight, kSoftLoad);

        double least = kLeastCompliance;
        for (int row = 0; row < joint.type->rows; ++row) {
            if (!is_locked(joint, row)) continue;
            const double c = is_angle(joint, row) ? joint.angular_compliance : joint.compliance;
            const double inverse_mass = inverse_mass_of(nodes_, joint, reading, row);
            if (c > 0 && inverse_mass > 0) least = std::min(least, c / (substep() * substep() * inverse_mass));
        }
        if (least < kLeastCompliance) add(TAUT_LINT_SOFT_COMPLIANCE, kNone, j, least, kLeastCompliance);
    }

    // ------------------------------------------------------------ loops

    bool rigid(const Joint& joint, int row) const {
        return is_locked(joint, row) && (is_angle(joint, row) ? joint.angular_compliance : joint.compliance) == 0;
    }

    // Rows of a mechanism in slot order, each with what the earlier ones leave of it (Gram and Schmidt, twice for
    // rounding); a row of which nothing is left is held already. Trees have none.
    void redundant_rows() {
        Memory& memory = world_.memory;
        Array<uint32_t> root_of(joints_.record.size(), kNone, memory), order(memory);
        for_joints([&](uint32_t j, const Joint& joint) {
            root_of[j] = component_of(joint);
            order.push_back(j);
        });
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return root_of[a] < root_of[b]; });
        for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
            while (end < order.size() && root_of[order[end]] == root_of[order[begin]]) ++end;
            look_for_loops({order.data() + begin, end - begin});
        }
    }
    // Here soft joints count as well.
    uint32_t component_of(const Joint& joint) {
        if (!all_connected_) {
            all_connected_ = true;
            for_joints([&](uint32_t, const Joint& one) { unite(one); });
        }
        return find(lightest_of(joint));
    }

    void look_for_loops(std::span<const uint32_t> joints) {
        Memory& memory = world_.memory;
        Array<uint32_t> nodes(memory);
        size_t rows = 0;
        bool grounded = false;
        for (uint32_t j : joints) {
            const Joint& joint = joints_.record[j];
            for (uint32_t node : joint.nodes())
                if (moves(node))
                    nodes.push_back(node);
                else
                    grounded = true;
            for (int row = 0; row < joint.type->rows; ++row) rows += rigid(joint, row);
        }
        std::sort(nodes.begin(), nodes.end());
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
        const size_t tree = nodes.size() - !grounded;  // joints of a tree; the ground is a node of it
        if (joints.size() <= tree || rows > kMostRows) return;

        const size_t width = nodes.size() * kDof;
        Array<double> basis(memory);
        basis.reserve(std::min(rows, width) * width);
        Array<double> left(width, 0.0, memory);
        for (uint32_t j : joints) {
            const Joint& joint = joints_.record[j];
            const JointReading reading = read_joint(nodes_, joint);
            uint32_t held = 0;
            for (int row = 0; row < joint.type->rows; ++row) {
                if (!rigid(joint, row)) continue;
                std::fill(left.begin(), left.end(), 0.0);
                for (int end = 0; end < joint.type->nodes; ++end) {
                    if (!moves(joint.node[end])) continue;
                    const auto at = std::lower_bound(nodes.begin(), nodes.end(), joint.node[end]);
                    const double* from = reading.jacobian + (end * joint.type->rows + row) * kDof;
                    const int columns = nodes_.info[joint.node[end]].kind == NodeKind::particle ? 3 : kDof;
                    std::copy(from, from + columns, left.begin() + (at - nodes.begin()) * kDof);
                }
                held += !extend(basis, left);
            }
            if (held == 0) continue;
            add(TAUT_LINT_REDUNDANT_ROWS, moves(joint.node[1]) ? joint.node[1] : joint.node[0], j, held, 0);
        }
    }
    // Adds what the basis leaves of a row to it, as a unit vector; false if that is next to nothing.
    static bool extend(Array<double>& basis, Array<double>& row) {
        const auto length = static_cast<Eigen::Index>(row.size());
        Eigen::Map<Eigen::VectorXd> left(row.data(), length);
        const double whole = left.norm();
        if (!(whole > 0)) return true;
        for (int pass = 0; pass < 2; ++pass) {
            for (size_t at = 0; at < basis.size(); at += row.size()) {
                const Eigen::Map<const Eigen::VectorXd> unit(basis.data() + at, length);
                left -= unit.dot(left) * unit;
            }
        }
        const double rest = left.norm();
        if (!(rest > kRedundant * whole)) return false;
        left /= rest;
        basis.insert(basis.end(), row.begin(), row.end());
        return true;
    }

    // ------------------------------------------------------------ present poses

    void fit_of(uint32_t j, const Joint& joint) {
        const JointReading reading = read_joint(nodes_, joint);
        double off[2] = {}, overrun[2] = {}, room[2] = {1e300, 1e300};
        for (int row = 0; row < joint.type->rows; ++row) {
            const Axis& axis = joint.axis[row];
            const bool angle = is_angle(joint, row);
            if (rigid(joint, row)) off[angle] += reading.value[row] * reading.value[row];
            if (axis.mode != AxisMode::limited) continue;
            if (axis.limit_compliance == 0)
                overrun[angle] = std::max(overrun[angle], overrun_of(joint, reading.value, row));
            room[angle] = std::min(room[angle], static_cast<double>(axis.upper) - axis.lower);
        }
        constexpr struct {
            taut_lint_kind apart, overrun, narrow;
            double far, least_room;
        } kUnit[2] = {{TAUT_LINT_JOINT_APART, TAUT_LINT_STOP_OVERRUN, TAUT_LINT_NARROW_STOPS, kGap, kNarrowGap},
                      {TAUT_LINT_JOINT_MISALIGNED, TAUT_LINT_STOP_OVERRUN_ANGLE, TAUT_LINT_NARROW_STOPS_ANGLE,
                       kMisalignment, kNarrowAngle}};
        for (int angle = 0; angle < 2; ++angle) {
            const auto& unit = kUnit[angle];
            add_above(unit.apart, kNone, j, std::sqrt(off[angle]), unit.far);
            add_above(unit.overrun, kNone, j, overrun[angle], unit.far);
            if (room[angle] < unit.least_room) add(unit.narrow, kNone, j, room[angle], unit.least_room);
        }
    }

    World& world_;
    const Nodes& nodes_;
    const Joints& joints_;
    Array<taut_lint_entry> found_;
    Array<uint32_t> parent_;        // union-find over slots
    Array<uint64_t> direct_pairs_;  // keys, sorted
    bool all_connected_ = false;
};

}  // namespace

Array<taut_lint_entry> lint(World& world) { return Lint(world).run(); }

}  // namespace taut
