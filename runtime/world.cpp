#include "world.h"

#include <algorithm>
#include <cmath>

namespace taut {

World::World(const taut_world_def& checked_def, uint32_t world_id)
    : memory(checked_def.hooks),
      def(checked_def),
      team(checked_def.hooks, checked_def.threads + checked_def.hooks.worker_count),
      id(world_id),
      nodes(memory),
      shapes(memory),
      colliders(memory),
      joints(memory),
      elements(memory),
      cables(memory),
      softs(memory),
      attachments(memory),
      broadphase(memory),
      pairs(memory),
      sleep(memory),
      sensors(memory),
      partition(memory),
      system(memory),
      scratch(memory),
      watch(memory),
      contact_begin(memory),
      contact_persist(memory),
      contact_end(memory),
      contact_points(memory),
      hits(memory),
      moved(memory),
      quarantined(memory),
      broken(memory),
      detached(memory),
      torn(memory),
      yielded(memory),
      fell_asleep(memory),
      woke(memory),
      moved_before(memory),
      frozen(memory),
      reports(memory),
      impacts(memory),
      undo(memory) {
    last_step = def.time_step;
    spring_substep = first_substep = static_cast<double>(def.time_step) / def.substeps;
    pairs.world = id;
    pairs.asks = static_cast<uint8_t>(def.contact_events);
}

// As many as the def says, or as keep them as short as they were when the time step was another.
uint32_t World::least_substeps() const {
    constexpr double kRounding = 1e-6;
    const double least = std::ceil((1 - kRounding) * static_cast<double>(def.time_step) / spring_substep);
    return std::max(def.substeps, static_cast<uint32_t>(std::min<double>(least, kMaxSubsteps)));
}

taut_body World::body_handle(uint32_t node) const {
    if (node == kNone) return {0};
    return {pack_handle({node, nodes.ids.generation(node), id})};
}

taut_joint World::joint_handle(uint32_t joint) const {
    if (joint == kNone || joints.record[joint].inner) return {0};
    return {pack_handle({joint, joints.ids.generation(joint), id})};
}

static_assert(Shapes::kInner < kMaxSlots);  // both kinds have indices of handles

taut_shape World::shape_handle(uint32_t shape) const {
    if (shape == kNone) return {0};
    return {pack_handle({shape, shapes.generation(shape), id})};
}

taut_collider World::collider_handle(uint32_t collider) const {
    if (collider == kNone) return {0};
    return {pack_handle({collider, colliders.ids.generation(collider), id})};
}

taut_cable World::cable_handle(uint32_t cable) const {
    if (cable == kNone) return {0};
    return {pack_handle({cable, cables.ids.generation(cable), id})};
}

taut_cloth World::cloth_handle(uint32_t soft) const {
    if (soft == kNone || softs.record[soft].kind != SoftKind::cloth) return {0};
    return {pack_handle({soft, softs.ids.generation(soft), id})};
}

taut_solid World::solid_handle(uint32_t soft) const {
    if (soft == kNone || softs.record[soft].kind != SoftKind::solid) return {0};
    return {pack_handle({soft, softs.ids.generation(soft), id})};
}

taut_attachment World::attachment_handle(uint32_t attachment) const {
    if (attachment == kNone) return {0};
    return {pack_handle({attachment, attachments.ids.generation(attachment), id})};
}

}  // namespace taut
