#include "movers/call_parts.h"

#include <cstdio>

#include "api/query_parts.h"

namespace taut {

bool take_filter(Check& check, const taut_query_filter* given, uint32_t most_bodies, uint32_t most_colliders,
                 taut_query_filter& filter) {
    taut_query_filter_init(&filter);
    if (given && !take_def(check.within("def.filter."), given, taut_query_filter_init, filter, "")) return false;
    if (!check_filter(check.within(""), filter)) return false;
    check.within("def.filter.")
        .count("ignored_body_count", filter.ignored_body_count, 0, most_bodies)
        .count("ignored_collider_count", filter.ignored_collider_count, 0, most_colliders)
        .within("");
    return static_cast<bool>(check);
}

taut_result refuse_as(const Check& check, taut_result inner) {
    char text[512];
    std::snprintf(text, sizeof text, "%s", last_error());
    return refuse(inner, "%s: %s", check.call(), text);
}

}  // namespace taut
