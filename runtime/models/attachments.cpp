#include "models/attachments.h"

#include <algorithm>

#include "constraints/attachment.h"
#include "sleep/wake.h"

namespace taut {
namespace {

// What attachments of one set have in common, but for how soft each is.
struct Law {
    const ElementType* type;
    bool rigid;
    bool pulls;
    double relaxation;  // [s]
    JointSolve solve;
    bool collide_connected;
};

const ElementType& type_of(const Attachment& attachment) {
    const int nodes = static_cast<int>(way_of(attachment, 0).count);
    return attachment.kind == AttachmentKind::distance ? distance_attachment(nodes) : point_attachment(nodes);
}

Law law_of(const Attachment& of) {
    const bool rigid = of.compliance == 0;
    return {&type_of(of), rigid, of.pulls, rigid ? 0 : of.compliance * of.damping, of.solve, of.collide_connected};
}
Law limit_law_of(const Attachment& of) {
    return {&type_of(of), of.limit_compliance == 0, true, 0, of.solve, of.collide_connected};
}

double softness_of(double compliance) { return compliance > 0 ? compliance : 1; }

bool is_of(const ElementSet& set, const Law& law) {
    return set.type == law.type && (set.compliance[0] == 0) == law.rigid && set.pulls == law.pulls &&
           set.relaxation == law.relaxation && set.solve == law.solve && set.collide_connected == law.collide_connected;
}

// The set becomes nobody's where it is empty.
void drop_if_empty(World& world, uint32_t set) {
    if (world.elements.set[set].size() > 0) return;
    world.elements.remove(set);
    auto& sets = world.attachments.sets;
    sets.erase(std::find(sets.begin(), sets.end(), set));
}

// The set of a law, made where there is none, with room for so many more elements. Room in Attachments is reserved.
uint32_t set_of(World& world, const Law& law, uint32_t more) {
    auto& sets = world.attachments.sets;
    const auto found = std::ranges::find_if(sets, [&](uint32_t set) { return is_of(world.elements.set[set], law); });
    const bool is_new = found == sets.end();
    const uint32_t index = is_new ? world.elements.add(*law.type) : *found;
    ElementSet& set = world.elements.set[index];
    if (is_new) {
        sets.push_back(index);
        set.solve = law.solve;
        set.collide_connected = law.collide_connected;
        set.pulls = law.pulls;
        set_compliance(set, law.rigid ? 0.0 : 1.0, law.relaxation);
    }
    try {
        reserve_elements(set, more);
    } catch (...) {
        drop_if_empty(world, index);
        throw;
    }
    return index;
}

// data: of type_of(attachment); length: of a distance.
void write_element(const Attachment& attachment, uint32_t i, double length, double* data) {
    const AttachedWay way = way_of(attachment, i);
    for (uint32_t n = 0; n < way.count; ++n) {
        *data++ = way.term[n].weight;
        Vec3::Map(data) = way.term[n].moment;
        data += 3;
    }
    Vec3::Map(data) = way.rest;
    if (attachment.kind == AttachmentKind::distance) data[3] = length;
}

// A new element at the end of a set that has room.
uint32_t insert_element(World& world, const Attachment& attachment, uint32_t i, ElementSet& set, double compliance,
                        double length) {
    const AttachedWay way = way_of(attachment, i);
    uint32_t node[kMaxNodes];
    for (uint32_t n = 0; n < way.count; ++n) node[n] = way.term[n].node;
    const uint32_t at = set.size();
    world.elements.insert(set, at, {node, way.count}, softness_of(compliance));
    write_element(attachment, i, length, set.data_of(at));
    return at;
}

// Its elements at the end of a set that has room.
void insert_elements(World& world, Attachment& attachment, uint32_t index) {
    ElementSet& set = world.elements.set[index];
    attachment.set = index;
    for (uint32_t i = 0; i < attachment.elements(); ++i) {
        attachment.element[i] = insert_element(world, attachment, i, set, attachment.compliance, attachment.length);
    }
}
void insert_limit(World& world, Attachment& attachment, uint32_t index) {
    attachment.limit_set = index;
    attachment.limit_element =
        insert_element(world, attachment, 0, world.elements.set[index], attachment.limit_compliance, attachment.limit);
}

// Those behind it move up, whatever they are of their attachments.
void erase_element(World& world, uint32_t index, uint32_t gone) {
    world.elements.erase(world.elements.set[index], gone);
    for (Attachment& other : world.attachments.record) {
        for (uint32_t& element : other.element)
            if (other.set == index && element != kNone && element > gone) --element;
        if (other.limit_set == index && other.limit_element > gone) --other.limit_element;
    }
}
void erase_elements(World& world, Attachment& attachment) {
    for (uint32_t i = 0; i < attachment.elements(); ++i)
        erase_element(world, attachment.set, std::exchange(attachment.element[i], kNone));
    attachment.set = kNone;
}
void erase_limit(World& world, Attachment& attachment) {
    const uint32_t set = std::exchange(attachment.limit_set, kNone);
    if (set == kNone) return;
    erase_element(world, set, std::exchange(attachment.limit_element, kNone));
    drop_if_empty(world, set);
}

void wake_ends(World& world, const Attachment& attachment) {
    for_ends(attachment, [&](uint32_t node) { wake(world, node); });
}

}  // namespace

AttachmentReach reach_of(const World& world, const Attachment& attachment) {
    AttachmentReach out;
    for (uint32_t i = 0; i < attachment.elements(); ++i) {
        const AttachedWay way = way_of(attachment, i);
        out.complete = out.complete && way.count > 0;
        for (uint32_t n = 0; n < way.count; ++n)
            out.moves = out.moves || moves_by_forces(world.nodes.info[way.term[n].node].kind);
    }
    return out;
}

uint32_t add_attachment(World& world, const Attachment& attachment) {
    reserve_ended(world.pairs, between_ends(attachment));
    world.attachments.reserve_one();
    // Where both are of one law the second room is for both.
    const uint32_t set = set_of(world, law_of(attachment), attachment.elements() + 1);
    uint32_t limit = kNone;
    try {
        if (attachment.limit > 0) limit = set_of(world, limit_law_of(attachment), 1);
    } catch (...) {
        drop_if_empty(world, set);
        throw;
    }
    const uint32_t index = world.attachments.add(attachment);
    Attachment& made = world.attachments.record[index];
    insert_elements(world, made, set);
    if (limit != kNone) insert_limit(world, made, limit);
    if (!made.collide_connected) forget_pairs(world.pairs, world.nodes, world.colliders, between_ends(made));
    wake_ends(world, made);
    return index;
}

void remove_attachment(World& world, uint32_t index) {
    const Attachment& attachment = world.attachments.record[index];
    if (!attachment.collide_connected)
        forget_pairs(world.pairs, world.nodes, world.colliders, between_ends(attachment));
    drop_attachment(world, index);
}

void drop_attachment(World& world, uint32_t index) {
    Attachment& attachment = world.attachments.record[index];
    wake_ends(world, attachment);
    const uint32_t set = attachment.set;
    erase_limit(world, attachment);
    erase_elements(world, attachment);
    drop_if_empty(world, set);
    world.attachments.remove(index);
}

void change_compliance(World& world, uint32_t index, double compliance, double damping) {
    Attachment changed = world.attachments.record[index];
    changed.compliance = compliance;
    changed.damping = damping;
    const Law law = law_of(changed);
    const uint32_t old = changed.set, rows = static_cast<uint32_t>(law.type->row.rows);
    wake_ends(world, changed);
    if (is_of(world.elements.set[old], law)) {
        for (uint32_t i = 0; i < changed.elements(); ++i)
            world.elements.set[old].softness[changed.element[i]] = softness_of(changed.compliance);
        world.attachments.record[index] = changed;
        return;
    }
    world.attachments.reserve_one();
    const uint32_t set = set_of(world, law, changed.elements());
    double lambda[kAnchorNodes][kMaxRows], drift[kAnchorNodes][kMaxRows];
    uint8_t fresh[kAnchorNodes];
    AxisMemory memory{};  // of one that pulls
    for (uint32_t i = 0; i < changed.elements(); ++i) {
        const ElementSet& from = world.elements.set[old];
        std::copy_n(from.lambda_of(changed.element[i]), rows, lambda[i]);
        std::copy_n(from.drift_of(changed.element[i]), rows, drift[i]);
        fresh[i] = from.fresh[changed.element[i]];
        if (changed.pulls) memory = from.memory[changed.element[i]];
    }
    Attachment& attachment = world.attachments.record[index];
    erase_elements(world, attachment);
    drop_if_empty(world, old);
    attachment.compliance = compliance;
    attachment.damping = damping;
    insert_elements(world, attachment, set);
    for (uint32_t i = 0; i < attachment.elements(); ++i) {
        ElementSet& to = world.elements.set[set];
        std::copy_n(lambda[i], rows, to.lambda_of(attachment.element[i]));
        std::copy_n(drift[i], rows, to.drift_of(attachment.element[i]));
        to.fresh[attachment.element[i]] = fresh[i];
        if (attachment.pulls) to.memory[attachment.element[i]] = memory;
    }
}

void change_length(World& world, uint32_t index, double length) {
    Attachment& attachment = world.attachments.record[index];
    ElementSet& set = world.elements.set[attachment.set];
    const uint32_t e = attachment.element[0];
    wake_ends(world, attachment);
    if (!set.fresh[e]) *set.drift_of(e) += attachment.length - length;
    attachment.length = length;
    write_element(attachment, 0, length, set.data_of(e));
}

void shift_attachments(World& world, uint32_t node, const Vec3& offset) {
    for (uint32_t index = 0; index < world.attachments.ids.slots(); ++index) {
        Attachment& attachment = world.attachments.record[index];
        if (!any_end(attachment, [&](uint32_t end) { return end == node; })) continue;
        for (Anchor& end : attachment.end)
            for (uint32_t n = 0; n < end.count; ++n)
                if (end.node[n] == node) end.point[n] -= offset;
        if (attachment.end[1 - attachment.held_end].node[0] == node)
            for (Vec3& place : attachment.place) place -= offset;
        ElementSet& set = world.elements.set[attachment.set];
        for (uint32_t i = 0; i < attachment.elements(); ++i)
            write_element(attachment, i, attachment.length, set.data_of(attachment.element[i]));
        if (attachment.limit_set != kNone)
            write_element(attachment, 0, attachment.limit,
                          world.elements.set[attachment.limit_set].data_of(attachment.limit_element));
    }
}

}  // namespace taut
