// Which steps the world's events are of: those since a host read them last.
#pragma once

#include <atomic>
#include <cstdint>

namespace taut {

struct EventWindow {
    uint32_t steps = 0;             // taken since then, but for those dropped
    uint32_t dropped_steps = 0;     // whose events waited too long
    uint32_t dropped_contacts = 0;  // in all of them: taut_profile::dropped_contacts
    // The host read them, and the next call that steps or advances forgets them. Any thread may read, between steps.
    mutable std::atomic<bool> read = false;
};

}  // namespace taut
