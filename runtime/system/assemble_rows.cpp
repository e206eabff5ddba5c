#include <algorithm>
#include <cmath>
#include <utility>

#include "constraints/soft_contact.h"
#include "state/levers.h"
#include "system/assemble.h"
#include "system/operators.h"

namespace taut {
namespace {

RowBlock& add_block(System& system, const ConstraintType& type, bool in_lanes = false) {
    Rows& rows = system.rows;
    RowBlock block{};
    block.type = &type;
    block.in_lanes = in_lanes;
    block.row = static_cast<uint32_t>(rows.error.size());
    block.jacobian = static_cast<uint32_t>(rows.jacobian.size());
    rows.error.resize(rows.error.size() + type.rows, 0.0);
    rows.impulse.resize(rows.error.size(), 0.0);
    if (!block.evaluated_in_lanes())
        rows.jacobian.resize(rows.jacobian.size() + static_cast<size_t>(type.rows * type.nodes * kDof), 0.0);
    rows.block.push_back(block);
    return rows.block.back();
}

void add_joint(System& system, Joint& joint, bool in_lanes) {
    RowBlock& block = add_block(system, *joint.type, in_lanes);
    block.data = joint.data;
    block.force = joint.lambda;
    block.drift = joint.drift;
    block.slow_turn = &joint.slow_turn;
    for (int i = 0; i < joint.type->nodes; ++i) block.node[i] = system.at(joint.node[i]);
    block.compliance[0] = joint.compliance;
    block.compliance[1] = joint.angular_compliance;
    block.compliance_block = joint.type->compliance ? joint.type->compliance(joint.data) : nullptr;
    if (block.compliance_block) block.compliance[0] = 1;
    block.relaxation[0] = block.compliance_block ? joint.damping : joint.compliance * joint.damping;
    block.relaxation[1] = joint.angular_compliance * joint.angular_damping;
    block.axis = joint.plain ? nullptr : joint.axis;
    block.memory = joint.memory;
    block.fresh = joint.fresh;
    joint.fresh = false;
    if (joint.type->follow)
        system.rows.followed.push_back({static_cast<uint32_t>(system.rows.block.size()) - 1, joint.data});
}

void add_element(System& system, ElementSet& set, uint32_t e, bool in_lanes) {
    const ConstraintType& type = set.type->row;
    const uint32_t first = static_cast<uint32_t>(system.rows.element_node.size());
    for (const uint32_t node : set.nodes_of(e)) system.rows.element_node.push_back(system.at(node));
    system.rows.element.push_back(e);
    RowBlock& block = add_block(system, type, in_lanes);
    block.data = set.data_of(e);
    block.force = set.lambda_of(e);
    block.drift = set.drift_of(e);
    block.slow_turn = set.slow_turn.empty() ? nullptr : &set.slow_turn[e];
    std::copy_n(&system.rows.element_node[first], type.nodes, block.node);
    block.compliance_block = set.coupled ? set.compliance : nullptr;
    block.compliance[0] = block.compliance[1] = set.softness[e] * (set.coupled ? 1 : set.compliance[0]);
    block.relaxation[0] = block.relaxation[1] = set.relaxation;
    if (set.pulls) {
        block.axis = &set.stop;
        block.memory = &set.memory[e];
        block.stop_softness = set.softness[e];
    }
    block.batched = true;
    block.fresh = set.fresh[e] != 0;
    set.fresh[e] = 0;
}

// Elements in this order, those of one set that follow each other in runs of at most so many.
void add_elements(System& system, Elements& elements, std::span<const ElementRef> list, bool in_lanes) {
    constexpr uint32_t kMostOfRun = 64;
    Rows& rows = system.rows;
    uint32_t set = kNone;
    for (const ElementRef& ref : list) {
        ElementSet& of = elements.set[ref.set];
        if (ref.set != set || rows.run.back().count == kMostOfRun)
            rows.run.push_back({of.type, of.data.data(), static_cast<uint32_t>(rows.block.size()), 0,
                                static_cast<uint32_t>(rows.element.size()),
                                static_cast<uint32_t>(rows.element_node.size())});
        set = ref.set;
        add_element(system, of, ref.element, in_lanes);
        ++rows.run.back().count;
    }
}

// The same for those without rows.
void add_energies(System& system, Elements& elements, std::span<const ElementRef> list) {
    Rows& rows = system.rows;
    uint32_t set = kNone;
    for (const ElementRef& ref : list) {
        if (std::exchange(set, ref.set) != ref.set)
            rows.elastic.push_back({&elements.set[set], 0, static_cast<uint32_t>(rows.element.size()),
                                    static_cast<uint32_t>(rows.element_node.size())});
        rows.element.push_back(ref.element);
        for (const uint32_t node : elements.set[set].nodes_of(ref.element))
            rows.element_node.push_back(system.at(node));
        ++rows.elastic.back().count;
    }
}

void add_elastic(System& system, Elements& elements, Block& block) {
    Rows& rows = system.rows;
    block.first_elastic_run = static_cast<uint32_t>(rows.elastic.size());
    add_energies(system, elements, block.elastic);
    block.elastic_runs = static_cast<uint32_t>(rows.elastic.size()) - block.first_elastic_run;
}

// Of a contact point, world axes.
Vec3 position_of(const System& system, const Nodes& nodes, const Pair& pair, int k) {
    const Pose& a = system.pose[system.at(pair.a)];
    return a.x - a.R * nodes.mass[pair.a].centre + pair.manifold.points[k].position.cast<double>();
}

// Rows n, t1 and the second tangent, as much as it counts.
Mat3 basis_of(const Pair& pair, const Tangents& tangents) {
    const Vec3f &n = pair.manifold.normal, t2 = tangents.part * tangents.t2;
    Mat3 basis;
    basis << n.cast<double>().transpose(), tangents.t1.cast<double>().transpose(), t2.cast<double>().transpose();
    return basis;
}
Mat3 basis_of(const Pair& pair) { return basis_of(pair, tangents_of(pair)); }

// Effective anchors and offset of a contact point, so that C is the gap and zero slip at the present poses.
ContactData contact_data(const System& system, const Nodes& nodes, const Pairs& pairs, const Pair& pair, int k) {
    const Pose& a = system.pose[system.at(pair.a)];
    const Pose& b = system.pose[system.at(pair.b)];
    const NodeMotion &ma = nodes.motion[pair.a], &mb = nodes.motion[pair.b];
    const Vec3 arm_a = a.R * nodes.mass[pair.a].centre, arm_b = b.R * nodes.mass[pair.b].centre;
    const Axles axles = axles_of(pairs, pair, arm_a, arm_b);
    const Levers levers =
        on_ball_paths(pairs, nodes, pair, levers_of(pair, k, arm_a, axles, {a.x, ma.v, ma.w}, {b.x, mb.v, mb.w}));
    ContactData data;
    data.anchor_a = a.R.transpose() * levers.a.core();
    data.anchor_b = b.R.transpose() * levers.b.core();
    data.skin_a = levers.a.skin;
    data.skin_b = levers.b.skin;
    data.basis = basis_of(pair);
    const Vec3 apart = b.x + levers.b.at - a.x - levers.a.at;  // of the point on b against that on a
    data.offset = Vec3(pair.manifold.points[k].separation, 0, 0) - data.basis * apart;
    return data;
}

// Where between two nodes a point is: 0 at the first, 1 at the second.
double share_along(const Vec3& from, const Vec3& to, const Vec3& point) {
    const Vec3 d = to - from;
    return std::clamp((point - from).dot(d) / std::max(d.squaredNorm(), 1e-24), 0.0, 1.0);
}

// Where the points are now that are to meet later, on either side.
void find_meeting_points(const System& system, const Nodes& nodes, const Pair& pair, int k, Vec3 (&point)[2]) {
    const auto side = [&](uint32_t node, uint32_t other) {
        Movement m = movement_of(nodes, node, other);
        if (other == kNone) m.x = system.pose[system.at(node)].x;
        return m;
    };
    const Movement a = side(pair.a, pair.a2), b = side(pair.b, pair.b2);
    const Pose& first = system.pose[system.at(pair.a)];
    const Vec3 arm = pair.a2 == kNone ? Vec3(first.R * nodes.mass[pair.a].centre) : Vec3(a.x - first.x);
    const Levers levers = levers_of(pair, k, arm, {}, a, b);
    point[0] = a.x + levers.a.at;
    point[1] = b.x + levers.b.at;
}

// The same where a side spans two nodes: particles, whose points are on the line between them.
SpanContactData span_contact_data(const System& system, const Nodes& nodes, const Pair& pair, int k) {
    Vec3 point[2];
    point[0] = point[1] = position_of(system, nodes, pair, k);
    if (pair.then > 0) find_meeting_points(system, nodes, pair, k, point);
    const uint32_t side[2][2] = {{pair.a, pair.a2}, {pair.b, pair.b2}};
    SpanContactData data;
    Vec3 apart = Vec3::Zero();
    for (int s = 0; s < 2; ++s) {
        const double sign = s == 0 ? -1 : 1;
        const Vec3& at = point[s];
        const Pose& one = system.pose[system.at(side[s][0])];
        if (side[s][1] == kNone) {
            data.weight[s] = sign;
            data.anchor[s] = one.R.transpose() * (at - one.x);
            apart += sign * at;
        } else {
            const Pose& other = system.pose[system.at(side[s][1])];
            const double t = share_along(one.x, other.x, at);
            data.weight[s] = sign * (1 - t);
            data.weight[s + 2] = sign * t;
            apart += sign * (one.x + t * (other.x - one.x));
        }
    }
    data.basis = basis_of(pair);
    data.offset = Vec3(pair.manifold.points[k].separation, 0, 0) - data.basis * apart;
    return data;
}

// lever: from its centre of mass, world axes [m].
Vec3 velocity_at(const System& system, uint32_t node, const Vec3& lever) {
    const Velocity& u = system.exact[node];
    return u.v + u.w.cross(lever);
}

// How a point was approached before the frame's forces; apart: velocity of b's point against a's.
void note_approach(const Vec3& apart, const Vec3& normal, RowBlock& block) {
    block.hits = -apart.dot(normal) > kHardSpeed;
}

// What a contact carries on as its rows have it, and back.
ContactForce carried_of(const RowBlock& block) {
    if (!block.surface_pair) return *block.contact;
    const PairRecord& pair = *block.surface_pair;
    return block.type->bound == Bound::load ? torque_to_rows(pair) : to_rows(pair, *block.contact);
}
ContactForce carried_from(const RowBlock& block, const ContactForce& rows) {
    if (!block.surface_pair) return rows;
    const PairRecord& pair = *block.surface_pair;
    return block.type->bound == Bound::load ? torque_from_rows(pair, rows) : from_rows(pair, rows);
}

void load(System& system, const RowBlock& block) {
    double* const impulse = &system.rows.impulse[block.row];
    const ContactForce force = carried_of(block);
    impulse[0] = system.scheme.h * static_cast<double>(force.normal);
    impulse[1] = system.scheme.h * static_cast<double>(force.tangent1);
    impulse[2] = system.scheme.h * static_cast<double>(force.tangent2);
}

// What a block of rows carries over.
void carry(System& system, RowBlock& block, ContactForce& force) {
    block.contact = &force;
    load(system, block);
}

RowBlock& add_point(System& system, const Pair& pair, const ContactData& data) {
    RowBlock& block = add_block(system, kContact);
    block.data = &data;
    block.node[0] = system.at(pair.a);
    block.node[1] = system.at(pair.b);
    const Pose &a = system.pose[block.node[0]], &b = system.pose[block.node[1]];
    const Vec3 apart = velocity_at(system, block.node[1], b.R * data.anchor_b + data.skin_b) -
                       velocity_at(system, block.node[0], a.R * data.anchor_a + data.skin_a);
    note_approach(apart, data.basis.row(0), block);
    return block;
}

RowBlock& add_span(System& system, const uint32_t (&nodes)[kMaxEnds], const SpanContactData& data) {
    RowBlock& block = add_block(system, kSpanContact);
    block.data = &data;
    Vec3 apart = Vec3::Zero();
    for (int n = 0; n < kMaxEnds; ++n) {
        block.node[n] = system.at(nodes[n]);
        const Vec3 core = system.pose[block.node[n]].R * data.anchor[n], lever = n == 0 ? Vec3(core + data.skin) : core;
        apart += data.weight[n] * velocity_at(system, block.node[n], lever);
    }
    note_approach(apart, data.basis.row(0), block);
    return block;
}

RowBlock& add_point(System& system, const Pair& pair, const SpanContactData& data) {
    const uint32_t nodes[kMaxEnds] = {pair.a, pair.b, pair.a2, pair.b2};
    return add_span(system, nodes, data);
}

// What moving surfaces drive the tangents of a contact point to.
void set_drive(const Pair& pair, int k, RowBlock& block) {
    if (!pair.driven) return;
    const Tangents tangents = tangents_of(pair);
    const Vec3f speed = pair.drive_at(k);
    block.drive[0] = speed.dot(tangents.t1);
    block.drive[1] = tangents.part * speed.dot(tangents.t2);
}

// Friction torques of a pair whose points' rows begin at `points`.
void add_rolling(System& system, Pair& pair, uint32_t points) {
    RowBlock& block = add_block(system, kRolling);
    RollingData& data = system.rows.rolling_data.emplace_back();
    data.basis = basis_of(pair, torque_tangents_of(pair));
    block.data = &data;
    block.node[0] = system.at(pair.a);
    block.node[1] = system.at(pair.b);
    block.arm[0] = pair.spinning;
    block.arm[1] = pair.rolling;
    block.loaded = points;
    block.loads = static_cast<uint32_t>(pair.manifold.count);
    block.spin_slip = &pair.spin_slip;
    block.surface_pair = &pair;
    carry(system, block, pair.torque);
}

// Rows of the points of some active pairs; room for their data is reserved.
void add_contacts(System& system, std::span<const uint32_t> active_pairs, Pairs& pairs, const Nodes& nodes) {
    Rows& rows = system.rows;
    for (uint32_t p : active_pairs) {
        Pair& pair = pairs.list[pairs.active[p].pair];
        const uint32_t points = static_cast<uint32_t>(rows.error.size());
        for (int k = 0; k < pair.manifold.count; ++k) {
            RowBlock& block =
                pairs.active[p].spans()
                    ? add_point(system, pair, rows.span_data.emplace_back(span_contact_data(system, nodes, pair, k)))
                    : add_point(system, pair, rows.data.emplace_back(contact_data(system, nodes, pairs, pair, k)));
            block.surface_pair = &pair;
            block.friction = pair.friction;
            block.restitution = pair.restitution;
            block.pair = pairs.active[p].pair;
            block.point = static_cast<uint8_t>(k);
            set_drive(pair, k, block);
            block.pushed = &pair.pushed;
            carry(system, block, pair.force[k]);
        }
        if (pair.turns() && pair.manifold.count > 0) add_rolling(system, pair, points);
    }
}

// Effective anchors and offset of a contact of surfaces, so that C is the gap and zero slip at the present poses. Its
// plane, weights and lever are those of the frame, the lever turned with its body since.
SpanContactData span_contact_data(const System& system, const Nodes& nodes, const SurfaceContact& contact) {
    SpanContactData data;
    const Vec3f n = contact.normal, t1 = tangent_of(n), t2 = n.cross(t1);
    data.basis << n.cast<double>().transpose(), t1.cast<double>().transpose(), t2.cast<double>().transpose();
    Vec3 moved = Vec3::Zero(), apart = Vec3::Zero();  // sum w_i of what p_i moved since it was found, and of p_i
    for (int i = 0; i < kMaxEnds; ++i) {
        if (contact.node[i] == kNone) continue;
        data.weight[i] = static_cast<double>(contact.weight[i]);
        const uint32_t at = system.at(contact.node[i]);
        moved += data.weight[i] * (system.pose[at].x - system.found[at].x);
        apart += data.weight[i] * system.pose[at].x;
    }
    if (contact.node[0] != kNone && contact.lever != Vec3f::Zero()) {
        const Mat3& R = system.pose[system.at(contact.node[0])].R;
        const Vec3 core = (contact.lever - contact.skin).cast<double>();
        data.anchor[0] = nodes.before[contact.node[0]].rotation.conjugate() * core;
        data.skin = contact.skin.cast<double>();
        moved += data.weight[0] * (R * data.anchor[0] - core);
        apart += data.weight[0] * (R * data.anchor[0] + data.skin);
    }
    const Vec3 gap(static_cast<double>(contact.gap) + data.basis.row(0).dot(moved), 0, 0);
    data.offset = gap - data.basis * apart;
    return data;
}

void add_surface_contact(System& system, const Nodes& nodes, uint32_t index, SurfaceContacts& surfaces) {
    SurfaceContact& contact = surfaces.contact[index];
    const SpanContactData& data = system.rows.span_data.emplace_back(span_contact_data(system, nodes, contact));
    RowBlock& block = add_span(system, contact.node, data);
    block.friction = static_cast<double>(contact.friction);
    block.restitution = static_cast<double>(contact.restitution);
    block.drive[0] = data.basis.row(1).dot(contact.drive.cast<double>());
    block.drive[1] = data.basis.row(2).dot(contact.drive.cast<double>());
    block.pair = kNone;
    block.surface = index;
    carry(system, block, contact.force);
}

void add_surface_contacts(System& system, std::span<const uint32_t> list, SurfaceContacts& surfaces,
                          const Nodes& nodes) {
    for (const uint32_t index : list) add_surface_contact(system, nodes, index, surfaces);
}

void poses_of(const System& system, const RowBlock& block, Pose* poses) {
    for (int i = 0; i < block.type->nodes; ++i) poses[i] = system.pose[block.node[i]];
}

// Addresses of contact data must not move while rows are added.
template <class Data>
void reserve_room(Array<Data>& data, size_t most) {
    data.clear();
    data.reserve(most);
}

// Of arrays by seat, those that only nodes in blocks use.
void make_room_for_blocks(System& system) {
    const size_t count = system.pose.size();
    for (Array<Velocity>* each : {&system.free, &system.kept, &system.correction}) each->resize(count);
    system.inertia.resize(count);
}

// Of pairs that come as rows, at the beginning of a frame.
void begin_rows(std::span<const uint32_t> active_pairs, Pairs& pairs) {
    for (uint32_t p : active_pairs) pairs.list[pairs.active[p].pair].pushed = false;
}

}  // namespace

void build_rows(System& system, const Group& group, Array<Block>& blocks, Joints& joints, Elements& elements,
                Pairs& pairs, const Nodes& nodes, bool contacts_as_rows, bool energies) {
    Rows& rows = system.rows;
    rows.block.clear();
    rows.followed.clear();
    rows.run.clear();
    rows.elastic.clear();
    rows.element.clear();
    rows.element_node.clear();
    rows.error.clear();
    rows.impulse.clear();
    rows.jacobian.clear();
    if (!group.blocks.empty()) make_room_for_blocks(system);
    for (uint32_t b : group.blocks) {
        blocks[b].first_row_block = static_cast<uint32_t>(rows.block.size());
        blocks[b].contact_count = 0;
        for (uint32_t i = 0; i < blocks[b].nodes.size(); ++i) {
            const uint32_t at = system.at(blocks[b].nodes[i]);
            system.in_block[at] = 1;
            system.place[at] = i;
        }
        for (uint32_t j : blocks[b].joints) add_joint(system, joints.record[j], false);
        add_elements(system, elements, blocks[b].elements, false);
        add_elastic(system, elements, blocks[b]);
    }
    rows.direct = static_cast<uint32_t>(rows.block.size());
    for (uint32_t j : group.joints) add_joint(system, joints.record[j], !contacts_as_rows);
    if (energies) {
        rows.sorted.assign(group.elements.begin(), group.elements.end());
        std::ranges::sort(rows.sorted, {}, [](const ElementRef& ref) { return uint64_t{ref.set} << 32 | ref.element; });
        add_energies(system, elements, rows.sorted);
    } else {
        add_elements(system, elements, group.elements, !contacts_as_rows);
    }
    rows.joints = static_cast<uint32_t>(rows.block.size());
    constexpr size_t kPoints = 4;
    const size_t whole = (contacts_as_rows ? group.pairs.size() : 0) + group.direct_pairs.size();
    const size_t surfaces = (contacts_as_rows ? group.surfaces.size() : 0) + group.direct_surfaces.size();
    reserve_room(rows.data, kPoints * whole);
    reserve_room(rows.span_data, kPoints * (group.span_pairs.size() + group.direct_pairs.size()) + surfaces);
    reserve_room(rows.rolling_data, whole);
    for (const Array<uint32_t>* as_rows : {&group.pairs, &group.span_pairs, &group.direct_pairs})
        if (contacts_as_rows || as_rows != &group.pairs) begin_rows(*as_rows, pairs);
    if (contacts_as_rows) add_contacts(system, group.pairs, pairs, nodes);
    for (const uint32_t p : group.span_pairs) leave_block(pairs.list[pairs.active[p].pair]);
    for (const uint32_t p : group.direct_pairs) pairs.list[pairs.active[p].pair].in_block = true;
    for (const uint32_t k : group.direct_surfaces) pairs.surfaces.contact[k].in_block = true;
    add_contacts(system, group.span_pairs, pairs, nodes);
    if (contacts_as_rows) add_surface_contacts(system, group.surfaces, pairs.surfaces, nodes);
    rows.lasting = static_cast<uint32_t>(rows.block.size());
    rows.lasting_spans = static_cast<uint32_t>(rows.span_data.size());
}

void build_block_contacts(System& system, const Group& group, Array<Block>& blocks, Pairs& pairs, const Nodes& nodes) {
    if (group.direct_pairs.empty() && group.direct_surfaces.empty()) return;
    Rows& rows = system.rows;
    const bool none = rows.block.size() == rows.lasting;
    rows.error.resize(none ? rows.error.size() : rows.block[rows.lasting].row);
    rows.impulse.resize(rows.error.size());
    rows.jacobian.resize(none ? rows.jacobian.size() : rows.block[rows.lasting].jacobian);
    rows.block.resize(rows.lasting);
    rows.data.clear();  // a solver that takes all contacts as rows has no blocks
    rows.rolling_data.clear();
    rows.span_data.resize(rows.lasting_spans);
    for (uint32_t b : group.blocks) {
        blocks[b].first_contact = static_cast<uint32_t>(rows.block.size());
        add_contacts(system, blocks[b].pairs, pairs, nodes);
        add_surface_contacts(system, blocks[b].surfaces, pairs.surfaces, nodes);
        blocks[b].contact_count = static_cast<uint32_t>(rows.block.size()) - blocks[b].first_contact;
    }
}

namespace {

void evaluate(System& system, const RowBlock& block, const Pose* poses) {
    block.type->evaluate(block.data, poses, &system.rows.error[block.row], &system.rows.jacobian[block.jacobian]);
}

// What a joint or element carries on, and its error for what of its drift has come.
void begin_substep(System& system, const RowBlock& block, double frame_left, double frame) {
    if (block.in_lanes) return;
    for (int r = 0; r < block.type->rows; ++r) {
        const uint32_t row = block.row + static_cast<uint32_t>(r);
        system.rows.impulse[row] = system.scheme.impulse(block.force[r]);
        // Damping acts on how fast C changes, drift included.
        const double damped = relaxation_of(block, r) / frame;
        double& error = system.rows.error[row];
        error += (damped - frame_left) * block.drift[r];
        if (!block.stops_angle(r)) continue;
        error = angle_between_stops(block.axis[r], block.memory[r], error);
        block.memory[r].angle = static_cast<float>(error);
    }
}

void evaluate_run(System& system, const ElementRun& run) {
    Rows& rows = system.rows;
    const RowBlock& first = rows.block[run.first];
    run.type->evaluate(
        {run.count, &rows.element_node[run.node], &rows.element[run.element], run.data, system.pose.data()},
        &rows.error[first.row], &rows.jacobian[first.jacobian], kDof);
}

}  // namespace

void evaluate_rows(Team& team, System& system, double frame_left, double frame) {
    constexpr uint32_t kGrain = 64;  // joints, about 10 us
    system.frame_left = frame_left;
    system.frame = frame;
    Rows& rows = system.rows;
    team.for_ranges(rows.joints, kGrain, [&](uint32_t begin, uint32_t end) {
        Pose poses[kMaxNodes];
        for (uint32_t i = begin; i < end; ++i) {
            const RowBlock& block = rows.block[i];
            if (block.evaluated_in_lanes() || block.batched) continue;
            poses_of(system, block, poses);
            evaluate(system, block, poses);
            begin_substep(system, block, frame_left, frame);
        }
    });
    team.for_ranges(static_cast<uint32_t>(rows.run.size()), 1, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const ElementRun& run = rows.run[i];
            evaluate_run(system, run);
            for (uint32_t b = run.first; b < run.first + run.count; ++b)
                begin_substep(system, rows.block[b], frame_left, frame);
        }
    });
    size_t next_rolling = 0;  // their data are in the order of their blocks
    for (size_t i = rows.joints; i < rows.block.size(); ++i) {
        Pose poses[kMaxNodes];
        poses_of(system, rows.block[i], poses);
        if (rows.block[i].type->bound == Bound::load) rows.rolling_data[next_rolling++].align(poses);
        evaluate(system, rows.block[i], poses);
    }
}

void load_contact_rows(System& system) {
    for (const RowBlock& block : system.rows.block)
        if (block.contact) load(system, block);
}

void store_contact_rows(const System& system) {
    for (const RowBlock& block : system.rows.block) {
        if (!block.contact) continue;
        const double* mu = &system.rows.impulse[block.row];
        if (block.pushed && mu[0] > 0) *block.pushed = true;
        const auto force = [&](int row) { return static_cast<float>(mu[row] / system.scheme.h); };
        *block.contact = carried_from(block, {force(0), force(1), force(2), block.contact->slip});
    }
}

double row_residual(System& system, const JointKernels& kernels) {
    const auto groups = static_cast<uint32_t>(system.joints.group.size());
    double largest = kernels.residual(system.joints.view(), 0, groups, system.sweep.data());
    for (const RowBlock& block : system.rows.block) {
        if (block.type->bound != Bound::free || block.in_lanes) continue;
        RowVector r = error_rate_of(system, block) + compliance_of(block, system.scheme) * impulse_of(system, block);
        r += rates(system, block, [&](uint32_t node) { return vector_of(system.exact[node]); });
        for (int i = 0; i < block.type->rows; ++i)
            if (block.locked(i)) largest = std::max(largest, std::abs(r[i]));
    }
    return largest;
}

}  // namespace taut
