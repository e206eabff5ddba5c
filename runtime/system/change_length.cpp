// From substeps of one length to those of another within a frame.
#include "system/assemble.h"

namespace taut {
namespace {

// Impulses that contacts carry on push as hard as before for another time.
void scale_contact_impulses(System& system, double by) {
    const auto factor = static_cast<float>(by);
    const auto scale = [&](auto& rows) {
        for (auto& lanes : rows)
            for (float& impulse : lanes) impulse *= factor;
    };
    for (const LaneGroup& group : system.contacts.group)
        for (uint32_t k = 0; k < group.points; ++k) scale(group.point[k].impulse);
    for (LaneRolling& rolling : system.contacts.rolling) scale(rolling.impulse);
    for (const RowBlock& block : system.rows.block) {
        if (!block.contact) continue;
        for (int r = 0; r < block.type->rows; ++r) system.rows.impulse[block.row + static_cast<uint32_t>(r)] *= by;
        for (float* impulse : {&block.contact->normal, &block.contact->tangent1, &block.contact->tangent2})
            *impulse *= factor;
    }
}

}  // namespace

void change_length(Team& team, System& system, const Group& group, double h, double frame) {
    store_joint_lanes(team, system);
    scale_contact_impulses(system, h / system.h);
    system.h = h;
    build_joint_lanes(team, system, group, frame);
}

void note_substeps(const Group& group, uint32_t substeps, Pairs& pairs) {
    if (substeps == group.substeps) return;
    for (const Array<uint32_t>* list : {&group.pairs, &group.span_pairs, &group.direct_pairs})
        for (const uint32_t p : *list) pairs.list[pairs.active[p].pair].substeps = static_cast<uint16_t>(substeps);
}

}  // namespace taut
