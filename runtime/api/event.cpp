#include <taut/event.h>

#include "api/contacts.h"
#include "api/sized.h"

using namespace taut;

taut_result taut_world_get_events_sized(taut_world handle, taut_events* first, uint32_t size) {
    const RecordOut<taut_events> out(first, size);
    Check check("taut_world_get_events");
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        world.window.read = true;
        const auto length = [](const auto& array) { return static_cast<uint32_t>(array.size()); };
        *out = {world.contact_begin.data(),
                world.contact_end.data(),
                world.moved.data(),
                world.quarantined.data(),
                length(world.contact_begin),
                length(world.contact_end),
                length(world.moved),
                length(world.quarantined),
                world.broken.data(),
                length(world.broken),
                world.window.steps,
                world.contact_persist.data(),
                world.hits.data(),
                world.contact_points.data(),
                world.sensors.enter.data(),
                world.sensors.leave.data(),
                length(world.contact_persist),
                length(world.hits),
                length(world.contact_points),
                length(world.sensors.enter),
                length(world.sensors.leave),
                world.window.dropped_steps,
                world.fell_asleep.data(),
                world.woke.data(),
                length(world.fell_asleep),
                length(world.woke),
                world.window.dropped_contacts,
                length(world.torn),
                world.detached.data(),
                world.torn.data(),
                length(world.detached),
                length(world.yielded),
                world.yielded.data()};
        return TAUT_OK;
    });
}

namespace {

// Whether a contact is told: all, or those of one body.
bool has(const taut_contact& contact, taut_body of) {
    return contact.body_a.bits == of.bits || contact.body_b.bits == of.bits;
}

}  // namespace

taut_result taut_world_get_contacts_sized(taut_world handle, taut_contact* first, uint32_t capacity, uint32_t* count,
                                          uint32_t size) {
    const RecordOut<taut_contact> contacts(first, size);
    Check check("taut_world_get_contacts");
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        const uint32_t needed = count_contacts(world);
        if (needed > capacity) {
            *count = needed;
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        }
        if (needed > 0 && !check.pointer("contacts", contacts)) return check.result();
        *count = needed;
        uint32_t next = 0;
        for_contacts(world, kNone, [&](const taut_contact& contact) { contacts[next++] = contact; });
        return TAUT_OK;
    });
}

taut_result taut_body_get_contacts_sized(taut_body handle, taut_contact* first, uint32_t capacity, uint32_t* count,
                                         uint32_t size) {
    const RecordOut<taut_contact> contacts(first, size);
    Check check("taut_body_get_contacts");
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        uint32_t needed = 0, next = 0;
        for_contacts(world, node, [&](const taut_contact& contact) { needed += has(contact, handle); });
        *count = needed;
        if (needed > capacity)
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        if (needed > 0 && !check.pointer("contacts", contacts)) return check.result();
        for_contacts(world, node, [&](const taut_contact& contact) {
            if (has(contact, handle)) contacts[next++] = contact;
        });
        return TAUT_OK;
    });
}
