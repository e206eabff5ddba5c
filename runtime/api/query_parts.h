// What the calls of query.h share: the filter, the shape that a query takes along, answers into a host's array.
#pragma once

#include <taut/query.h>

#include "api/sized.h"
#include "queries/queries.h"

namespace taut {

Check& check_ray(Check& check, const taut_ray& ray);
Check& check_translation(Check& check, const taut_vec3& translation);
Check& check_filter(Check& check, const taut_query_filter& filter);
taut_result find_ignored(const char* call, const World& world, const taut_query_filter& filter);
// The shape that a query takes along.
taut_result find_convex(Check& check, const World& world, taut_shape handle, const collision::Shape*& out);
collision::Placement to_placement(const taut_pose& pose);

// act(Sight) with the arguments checked, the world held and the filter, null for all, resolved.
template <class Act>
taut_result ask(Check& check, taut_world handle, const taut_query_filter* filter, Act&& act) {
    taut_query_filter used;
    taut_query_filter_init(&used);
    if (filter && !take_def(check.within("filter."), filter, taut_query_filter_init, used, "")) return check.result();
    if (!check_filter(check, used)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        const taut_result found = find_ignored(check.call(), world, used);
        return found == TAUT_OK ? act(Sight(world, used)) : found;
    });
}

// By fraction, then by slot, which the upper bits of a handle are.
inline bool before(const taut_query_hit& a, const taut_query_hit& b) {
    return a.fraction < b.fraction || (a.fraction == b.fraction && a.collider.bits < b.collider.bits);
}
inline bool before(const taut_collider& a, const taut_collider& b) { return a.bits < b.bits; }
inline bool before(const taut_surface_hit& a, const taut_surface_hit& b) {
    const uint64_t of_a = a.cloth.bits | a.solid.bits, of_b = b.cloth.bits | b.solid.bits;  // one of them is 0
    return of_a < of_b || (of_a == of_b && a.triangle < b.triangle);
}

// Keeps as many as there is room for, and counts all.
template <class Item, class Place>
struct Shelf final : Sink<Item> {
    Shelf(const Place& array, uint32_t most) : items(array), room(most) {}
    void take(const Item& item) override {
        if (count < room) items[count] = item;
        ++count;
    }
    Place items;
    uint32_t room;
    uint32_t count = 0;
};

// The answers of gather(Sink&), sorted, into an array that is written only if it holds all. They wait on the stack; if
// they are too many for that, gather runs again.
template <class Item, class Gather>
taut_result collect(Check& check, const char* field, const RecordOut<Item>& out, uint32_t capacity, uint32_t* count,
                    Gather&& gather) {
    constexpr uint32_t kFew = 64;
    const auto less = [](const Item& a, const Item& b) { return before(a, b); };
    Item few[kFew];
    Shelf<Item, Item*> found(few, kFew);
    gather(found);
    *count = found.count;
    if (found.count > capacity) {
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, found.count);
    }
    if (found.count == 0) return TAUT_OK;
    if (!check.pointer(field, out)) return check.result();
    if (found.count <= kFew) {
        std::sort(few, few + found.count, less);
        for (uint32_t i = 0; i < found.count; ++i) out[i] = few[i];
    } else {
        Shelf<Item, RecordOut<Item>> again(out, found.count);
        gather(again);
        *count = std::min(found.count, again.count);  // a host's accept may have changed its mind
        out.sort(*count, less);
    }
    return TAUT_OK;
}

}  // namespace taut
