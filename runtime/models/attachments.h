// Attachments: made of elements in sets that those of one type and law share, and removed with what they are on.
#pragma once

#include "world.h"

namespace taut {

// The nodes that an attachment's elements are on, those of both ends that do not cancel out; whether any moves.
struct AttachmentReach {
    bool complete = true;  // each element has nodes
    bool moves = false;
};
AttachmentReach reach_of(const World& world, const Attachment& attachment);

// Of kind, ends, law and limits, checked: each element has nodes. Throws std::bad_alloc with nothing changed.
uint32_t add_attachment(World& world, const Attachment& attachment);
// Pairs that it kept apart are found anew. Throws std::bad_alloc with nothing changed.
void remove_attachment(World& world, uint32_t index);
// Where a node of it goes, or its pairs were forgotten: does not throw.
void drop_attachment(World& world, uint32_t index);

// Takes another law; forces stay. Throws std::bad_alloc with nothing changed.
void change_compliance(World& world, uint32_t index, double compliance, double damping);
// What the change does to its distance comes bit by bit over the next step.
void change_length(World& world, uint32_t index, double length);
// Where a node's centre of mass moves by `offset`, body axes [m]: they stay where they are on it.
void shift_attachments(World& world, uint32_t node, const Vec3& offset);

// Drops those of which a node meets the condition.
template <class Condition>
void drop_attachments(World& world, Condition&& condition) {
    if (world.attachments.ids.count() == 0) return;
    for (uint32_t index = 0; index < world.attachments.ids.slots(); ++index)
        if (world.attachments.ids.live(index) && any_end(world.attachments.record[index], condition))
            drop_attachment(world, index);
}

// Pairs of colliders that an attachment's ends have with each other.
inline auto between_ends(const Attachment& attachment) {
    return [&attachment](const PairEnds& pair) {
        for (const uint32_t a : attachment.end[0].nodes())
            for (const uint32_t b : attachment.end[1].nodes())
                if (between_nodes(a, b)(pair)) return true;
        return false;
    };
}

}  // namespace taut
