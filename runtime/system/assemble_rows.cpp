#include <algorithm>
#include <cmath>

#include "system/assemble.h"
#include "system/row_algebra.h"
#include "system/soft_contact.h"

namespace taut {
namespace {

RowBlock& add_block(System& system, const ConstraintType& type) {
    Rows& rows = system.rows;
    RowBlock block{};
    block.type = &type;
    block.row = static_cast<uint32_t>(rows.error.size());
    block.jacobian = static_cast<uint32_t>(rows.jacobian.size());
    rows.error.resize(rows.error.size() + type.rows, 0.0);
    rows.impulse.resize(rows.error.size(), 0.0);
    rows.jacobian.resize(rows.jacobian.size() + static_cast<size_t>(type.rows * type.nodes * kDof), 0.0);
    rows.block.push_back(block);
    return rows.block.back();
}

void add_joint(System& system, Joint& joint) {
    RowBlock& block = add_block(system, *joint.type);
    block.data = joint.data;
    block.force = joint.lambda;
    block.drift = joint.drift;
    block.slow_turn = &joint.slow_turn;
    for (int i = 0; i < 2; ++i) block.node[i] = joint.node[i] + 1;  // kNone becomes the world, 0
    block.compliance[0] = joint.compliance;
    block.compliance[1] = joint.angular_compliance;
    block.compliance_block = joint.type->compliance ? joint.type->compliance(joint.data) : nullptr;
    block.relaxation[0] = block.compliance_block ? joint.damping : joint.compliance * joint.damping;
    block.relaxation[1] = joint.angular_compliance * joint.angular_damping;
    block.axis = joint.plain ? nullptr : joint.axis;
    block.memory = joint.memory;
    block.fresh = joint.fresh;
    joint.fresh = false;
}

// Effective anchors and offset of a contact point, so that C is the gap and zero slip at the present poses.
ContactData contact_data(const System& system, const Nodes& nodes, const Pair& pair, int k) {
    const collision::ContactPoint& point = pair.manifold.points[k];
    const Pose& a = system.pose[pair.a + 1];
    const Pose& b = system.pose[pair.b + 1];
    const Vec3 at = a.x - a.R * nodes.mass[pair.a].centre + point.position.cast<double>();
    const Vec3f n = pair.manifold.normal, t1 = tangent_of(n), t2 = n.cross(t1);
    ContactData data;
    data.anchor_a = a.R.transpose() * (at - a.x);
    data.anchor_b = b.R.transpose() * (at - b.x);
    data.basis << n.cast<double>().transpose(), t1.cast<double>().transpose(), t2.cast<double>().transpose();
    data.offset = Vec3(point.separation, 0, 0);
    return data;
}

// Restitution times the speed of approach before the frame's forces, where that is fast enough to bounce.
double bounce_speed(const System& system, const Pair& pair, const ContactData& point, double restitution) {
    auto velocity_at = [&](uint32_t node, const Vec3& anchor) {
        const Velocity& u = system.exact[node + 1];
        return Vec3(u.v + u.w.cross(system.pose[node + 1].R * anchor));
    };
    const Vec3 apart = velocity_at(pair.b, point.anchor_b) - velocity_at(pair.a, point.anchor_a);
    const double approach = -apart.dot(point.basis.row(0));
    return approach > kBounceSpeed ? restitution * approach : 0.0;
}

// Rows of the points of some active pairs; room for their data is reserved.
void add_contacts(System& system, std::span<const uint32_t> active_pairs, Pairs& pairs, const Nodes& nodes) {
    Rows& rows = system.rows;
    for (uint32_t p : active_pairs) {
        Pair& pair = pairs.list[pairs.active[p].pair];
        for (int k = 0; k < pair.manifold.count; ++k) {
            rows.data.push_back(contact_data(system, nodes, pair, k));
            RowBlock& block = add_block(system, kContact);
            block.data = &rows.data.back();
            block.node[0] = pair.a + 1;
            block.node[1] = pair.b + 1;
            block.friction = pair.friction;
            block.bounce = bounce_speed(system, pair, rows.data.back(), pair.restitution);
            block.contact = &pair.impulse[k];
            rows.impulse[block.row] = block.contact->normal;
            rows.impulse[block.row + 1] = block.contact->tangent1;
            rows.impulse[block.row + 2] = block.contact->tangent2;
        }
    }
}

// Addresses of contact data must not move while rows are added.
void reserve_contacts(System& system, std::span<const uint32_t> active_pairs) {
    constexpr size_t kPoints = 4;
    system.rows.data.clear();
    system.rows.data.reserve(kPoints * active_pairs.size());
}

}  // namespace

void build_rows(System& system, const Group& group, Array<Block>& blocks, Joints& joints, Pairs& pairs,
                const Nodes& nodes, bool contacts_as_rows) {
    Rows& rows = system.rows;
    rows.block.clear();
    rows.error.clear();
    rows.impulse.clear();
    rows.jacobian.clear();
    for (uint32_t b : group.blocks) {
        blocks[b].first_row_block = static_cast<uint32_t>(rows.block.size());
        blocks[b].contact_count = 0;
        for (uint32_t i = 0; i < blocks[b].nodes.size(); ++i) {
            system.in_block[blocks[b].nodes[i] + 1] = 1;
            system.place[blocks[b].nodes[i] + 1] = i;
        }
        for (uint32_t j : blocks[b].joints) add_joint(system, joints.record[j]);
    }
    for (uint32_t j : group.joints) add_joint(system, joints.record[j]);
    rows.joints = static_cast<uint32_t>(rows.block.size());
    if (!contacts_as_rows) return;
    reserve_contacts(system, group.pairs);
    add_contacts(system, group.pairs, pairs, nodes);
}

void build_block_contacts(System& system, const Group& group, Array<Block>& blocks, Pairs& pairs, const Nodes& nodes) {
    if (group.direct_pairs.empty()) return;
    Rows& rows = system.rows;
    const bool none = rows.block.size() == rows.joints;
    rows.error.resize(none ? rows.error.size() : rows.block[rows.joints].row);
    rows.impulse.resize(rows.error.size());
    rows.jacobian.resize(none ? rows.jacobian.size() : rows.block[rows.joints].jacobian);
    rows.block.resize(rows.joints);
    reserve_contacts(system, group.direct_pairs);
    for (uint32_t b : group.blocks) {
        blocks[b].first_contact = static_cast<uint32_t>(rows.block.size());
        add_contacts(system, blocks[b].pairs, pairs, nodes);
        blocks[b].contact_count = static_cast<uint32_t>(rows.block.size()) - blocks[b].first_contact;
    }
}

void evaluate_rows(System& system, double frame_left, double frame) {
    system.frame_left = frame_left;
    Rows& rows = system.rows;
    for (const RowBlock& block : rows.block) {
        Pose poses[kMaxNodes];
        for (int i = 0; i < block.type->nodes; ++i) poses[i] = system.pose[block.node[i]];
        block.type->evaluate(block.data, poses, &rows.error[block.row], &rows.jacobian[block.jacobian]);
        if (!block.force) continue;
        for (int r = 0; r < block.type->rows; ++r) {
            rows.impulse[block.row + r] = system.h * block.force[r];
            // Damping acts on how fast C changes, drift included.
            const double damped = block.relaxation[block.compliance_block ? 0 : block.angular(r)] / frame;
            rows.error[block.row + r] += (damped - frame_left) * block.drift[r];
        }
    }
}

void store_contact_rows(const System& system) {
    for (const RowBlock& block : system.rows.block) {
        if (!block.contact) continue;
        const double* mu = &system.rows.impulse[block.row];
        block.contact->normal = static_cast<float>(mu[0]);
        block.contact->tangent1 = static_cast<float>(mu[1]);
        block.contact->tangent2 = static_cast<float>(mu[2]);
    }
}

double row_residual(const System& system) {
    double largest = 0;
    for (const RowBlock& block : system.rows.block) {
        if (block.type->bound != Bound::free) continue;
        RowVector r = error_rate_of(system, block) + compliance_of(block, system.h) * impulse_of(system, block);
        for (int n = 0; n < block.type->nodes; ++n) {
            NodeVector u;
            u << system.exact[block.node[n]].v, system.exact[block.node[n]].w;
            r += jacobian_of(system, block, n) * u;
        }
        largest = std::max(largest, r.cwiseAbs().maxCoeff());
    }
    return largest;
}

}  // namespace taut
