// Filters of queries.
#pragma once

#include "host.h"

namespace taut_test {

class QueryValues : protected virtual Host {
protected:
    // A filter; only() points into it.
    struct Filter {
        Filter() { taut_query_filter_init(&def); }
        const taut_query_filter* get() const { return none ? nullptr : &def; }
        void only(taut_collider collider) {
            wanted = collider;
            def.accept = [](taut_body, taut_collider asked, void* one) -> int32_t {
                return static_cast<taut_collider*>(one)->bits == asked.bits;
            };
            def.user_data = &wanted;
        }

        taut_query_filter def;
        taut_collider wanted = {0};
        bool none = false;
    };

    Filter query_filter(size_t w) {
        Filter out;
        out.none = one_in(3);
        spoil(out.def.struct_size);
        out.def.kinds = one_in(2) ? TAUT_QUERY_ALL_KINDS : byte() % (one_in(16) ? 64 : 32);
        if (one_in(8)) out.def.category = word(), out.def.mask = word();
        for (taut_body& body : ignored_bodies_) body = pick_body(w);
        for (taut_collider& collider : ignored_colliders_) collider = pick(colliders_, w);
        if (one_in(8)) out.def.ignored_bodies = ignored_bodies_, out.def.ignored_body_count = byte() % 3;
        if (one_in(8)) out.def.ignored_colliders = ignored_colliders_, out.def.ignored_collider_count = byte() % 3;
        if (one_in(32)) out.def.ignored_body_count = word();
        if (one_in(4)) out.def.accept = accept, out.def.user_data = this;
        return out;
    }

private:
    // Reads from the world, which it may, and answers by the handle, so that it answers alike when it is asked again.
    static int32_t accept(taut_body body, taut_collider collider, void* self) {
        taut_pose at;
        static_cast<QueryValues*>(self)->expect(taut_body_get_pose(body, &at) == TAUT_OK, "a read within a query");
        return (collider.bits * 0x9e3779b97f4a7c15 >> 61) != 0 ? 7 : 0;
    }

    taut_body ignored_bodies_[2] = {};
    taut_collider ignored_colliders_[2] = {};
};

}  // namespace taut_test
