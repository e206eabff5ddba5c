// Hash of everything that the future of a world depends on, in slot order.
#include "base/hash.h"
#include "world.h"

namespace taut {
namespace {

void add_nodes(Hash& hash, const Nodes& nodes) {
    for (uint32_t i = 0; i < nodes.slots(); ++i) {
        const NodeInfo& info = nodes.info[i];
        if (info.kind == NodeKind::dead) continue;
        const NodeMotion& m = nodes.motion[i];
        hash.add(static_cast<uint64_t>(i) << 8 | static_cast<uint64_t>(info.kind));
        for (const Vec3* v : {&m.x, &m.v, &m.w, &m.slow_v, &m.slow_w}) hash.add(*v);
        hash.add(m.q);
        hash.add(nodes.mass[i].mass);
        hash.add(nodes.mass[i].gravity_scale);
        if (!nodes.info[i].continuous) hash.add(uint64_t{1});
        const NodeLoad none, &applied = nodes.applied.empty() ? none : nodes.applied[i];
        hash.add(applied.force);
        hash.add(applied.torque);
    }
}

// Of hosts whose frames are not steps.
void add_frames(Hash& hash, const Nodes& nodes) {
    for (size_t i = 0; i < nodes.owed.size(); ++i) {
        const NodeLoad& owed = nodes.owed[i];
        if (!owed.any()) continue;
        hash.add(static_cast<uint64_t>(i));
        hash.add(owed.force);
        hash.add(owed.torque);
    }
    for (const KinematicPath& path : nodes.paths) {
        if (!path.follows) continue;
        hash.add(static_cast<uint64_t>(path.node) << 1 | path.asked);
        for (const Vec3* v : {&path.start.position, &path.speed.v, &path.speed.w, &path.target.position}) hash.add(*v);
        hash.add(path.start.rotation);
        hash.add(path.target.rotation);
    }
}

// What most surfaces do not have.
void add_surface(Hash& hash, const ColliderTraits& traits) {
    const taut_material& m = traits.material;
    if (m.friction_rule != TAUT_COMBINE_DEFAULT || m.restitution_rule != TAUT_COMBINE_DEFAULT)
        hash.add(static_cast<uint64_t>(m.friction_rule) << 32 | static_cast<uint64_t>(m.restitution_rule));
    if (m.rolling_friction != 0 || m.spinning_friction != 0) {
        hash.add(m.rolling_friction);
        hash.add(m.spinning_friction);
    }
    if (!traits.driven()) return;
    for (const Vec3f* v : {&traits.surface_velocity, &traits.surface_spin}) hash.add(Vec3(v->cast<double>()));
}

// Of worlds with sleeping alone.
void add_sleep(Hash& hash, const Nodes& nodes) {
    for (uint32_t i = 0; i < nodes.slots(); ++i) {
        if (nodes.info[i].kind == NodeKind::dead) continue;
        const NodeSleep& sleep = nodes.sleep[i];
        hash.add(sleep.quiet);
        hash.add(static_cast<uint64_t>(sleep.next) << 8 | static_cast<uint64_t>(nodes.rest[i]) << 1 | sleep.can_sleep);
    }
}

void add_colliders(Hash& hash, const Colliders& colliders) {
    for (uint32_t i = 0; i < colliders.record.size(); ++i) {
        const Collider& collider = colliders.record[i];
        const ColliderTraits& traits = colliders.traits[i];
        if (collider.node == kNone) continue;
        hash.add(static_cast<uint64_t>(i) << 32 | collider.node);
        hash.add(static_cast<uint64_t>(collider.node_b) << 32 | collider.shape);
        hash.add(collider.position);
        hash.add(collider.rotation);
        hash.add(traits.material.friction);
        hash.add(traits.material.restitution);
        add_surface(hash, traits);
        hash.add(traits.filter.category);
        hash.add(traits.filter.mask);
        hash.add(static_cast<uint64_t>(static_cast<uint32_t>(traits.filter.group)));
        const uint64_t filters = collider.asks & (kAsksPreSolve | kAsksOneWay);
        if (!collider.sensor && filters == 0) continue;
        hash.add(filters << 2 | static_cast<uint64_t>(collider.sensor) << 1 | collider.senses_static);
        hash.add(traits.one_way.cast<double>().eval());
    }
}

void add_axes(Hash& hash, const Joint& joint) {
    for (int r = 0; r < joint.type->rows; ++r) {
        const Axis& axis = joint.axis[r];
        const AxisMemory& memory = joint.memory[r];
        hash.add(static_cast<uint64_t>(axis.mode));
        for (float x : {axis.lower, axis.upper, axis.limit_compliance, axis.limit_damping, axis.stiffness, axis.damping,
                        axis.target, axis.speed, axis.max_force, axis.friction})
            hash.add(x);
        for (float x : {memory.lower, memory.upper, memory.drive, memory.friction, memory.angle}) hash.add(x);
    }
}

void add_joints(Hash& hash, const Joints& joints) {
    for (size_t i = 0; i < joints.record.size(); ++i) {
        const Joint& joint = joints.record[i];
        if (!joint.type) continue;
        hash.add(static_cast<uint64_t>(i));
        for (int r = 0; r < joint.type->rows; ++r) hash.add(joint.lambda[r]);
        for (int r = 0; r < joint.type->rows; ++r) hash.add(joint.drift[r]);
        hash.add(joint.compliance);
        hash.add(joint.damping);
        hash.add(joint.angular_compliance);
        hash.add(joint.angular_damping);
        hash.add(joint.break_force);
        hash.add(joint.break_torque);
        hash.add(static_cast<uint64_t>(joint.solve) << 2 | static_cast<uint64_t>(joint.fresh) << 1 |
                 joint.collide_connected);
        hash.add(static_cast<uint64_t>(joint.loaded));
        hash.add(joint.slow_turn);
        if (!joint.plain) add_axes(hash, joint);
        for (size_t word = 0; word < joint.type->data_size / sizeof(uint64_t); ++word) {
            uint64_t bits;
            std::memcpy(&bits, joint.data + word * sizeof bits, sizeof bits);
            hash.add(bits);
        }
    }
}

void add_cables(Hash& hash, const Cables& cables) {
    for (uint32_t i = 0; i < cables.ids.slots(); ++i) {
        if (!cables.ids.live(i)) continue;
        const Cable& cable = cables.record[i];
        hash.add(static_cast<uint64_t>(i) << 8 | static_cast<uint64_t>(cable.kind));
        for (uint32_t node : cable.node) hash.add(static_cast<uint64_t>(node));
        for (const JointRef& joint : cable.joint) hash.add(static_cast<uint64_t>(joint.slot));
        for (const JointRef& joint : cable.bend) hash.add(static_cast<uint64_t>(joint.slot));
        for (double length : cable.length) hash.add(length);
        for (const CableEnd& end : cable.end) {
            hash.add(static_cast<uint64_t>(end.joint.slot));
            hash.add(static_cast<uint64_t>(end.clamp.slot));
            for (double x : {end.reel_speed, end.wanted_speed, end.acceleration, end.paid, end.owed, end.lost})
                hash.add(x);
        }
        for (double x : {cable.nominal, cable.mass_per_metre, cable.radius, cable.stretch_compliance,
                         cable.stretch_damping, cable.bending_stiffness, cable.bending_damping, cable.gravity_scale})
            hash.add(x);
    }
}

// From which the next steps may take the contact.
void add_found(Hash& hash, const FoundManifold& found, int count) {
    for (int i = 0; i < 4; ++i) hash.add(found.turn.coeffs()[i]);
    for (int i = 0; i < 3; ++i) hash.add(found.origin[i]);
    for (int k = 0; k < count; ++k) hash.add(found.separation[k]);
}

void add_pair(Hash& hash, const NearPair& near, const Pair& pair) {
    if (pair.manifold.count == 0) return;
    hash.add(pair.key);
    if (pair.part != 0) hash.add(static_cast<uint64_t>(pair.part));
    if (pair.asks & (kAsksPreSolve | kAsksOneWay)) hash.add(static_cast<uint64_t>(pair.touching));
    for (uint32_t word : near.cache) hash.add(static_cast<uint64_t>(word));
    for (uint32_t word : pair.cache) hash.add(static_cast<uint64_t>(word));
    if (pair.in_block) hash.add(uint64_t{1});
    if (pair.loaded > 0) hash.add(uint64_t{2} + pair.loaded);
    if (near.kept) add_found(hash, pair.found, pair.manifold.count);
    for (int k = 0; k < pair.manifold.count; ++k) {
        hash.add(static_cast<uint64_t>(pair.manifold.points[k].feature));
        hash.add(pair.force[k].normal);
        hash.add(pair.force[k].tangent1);
        hash.add(pair.force[k].tangent2);
        hash.add(pair.force[k].slip);
    }
    if (!pair.twists()) return;
    for (float x : {pair.torque.normal, pair.torque.tangent1, pair.torque.tangent2, pair.torque.slip, pair.spin_slip})
        hash.add(x);
}

void add_pairs(Hash& hash, const Pairs& pairs) {
    for_near(pairs, [&](const NearPair& near) {
        for_parts(pairs, near, [&](const Pair& pair) { add_pair(hash, near, pair); });
    });
    for (const Stay& stay : pairs.mechanisms.stays) hash.add(static_cast<uint64_t>(stay.root) << 32 | stay.frames);
}

}  // namespace

uint64_t state_hash(const World& world) {
    Hash hash;
    for (float g : {world.def.gravity.x, world.def.gravity.y, world.def.gravity.z}) hash.add(g);
    hash.add(world.def.time_step);
    hash.add(uint64_t{world.def.substeps});
    hash.add(world.spring_substep);
    hash.add(world.accumulator);
    hash.add(world.def.restitution_threshold);
    add_nodes(hash, world.nodes);
    add_frames(hash, world.nodes);
    if (world.def.sleeping) add_sleep(hash, world.nodes);
    add_colliders(hash, world.colliders);
    add_joints(hash, world.joints);
    add_cables(hash, world.cables);
    add_pairs(hash, world.pairs);
    for (const Block& block : world.partition.blocks) {
        hash.add(block.memory.excess_energy);
        hash.add(static_cast<uint64_t>(block.memory.guard_left) << 1 | block.memory.escalated);
        hash.add(uint64_t{block.memory.whips_left} << 8 | block.memory.hit_left);
        hash.add(static_cast<uint64_t>(block.memory.solved));
        hash.add(static_cast<uint64_t>(block.memory.since_trip));
    }
    return hash.value();
}

}  // namespace taut
