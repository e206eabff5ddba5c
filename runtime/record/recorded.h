// What an entry point that changes a world begins with, so that the call gets into the world's recording.
#pragma once

#include <atomic>
#include <cstdint>

#include <taut/base.h>

#include "base/result.h"
#include "record/calls.h"

namespace taut {

// Worlds that are recorded now: as long as there are none, a call costs one look at this.
extern constinit std::atomic<uint32_t> recorded_worlds;
inline bool recording() noexcept { return recorded_worlds.load(std::memory_order_relaxed) != 0; }

// Writes a call before it is done, so that one which never returns is in the file too, and its result after it. Calls
// within a call are part of it; movers, which change the world by other calls of the interface, have none.
class Recorded {
public:
    // Of the entry point's own parameters, which outlive this.
    template <class First, class... More>
    Recorded(taut_result (*)(First, More...), Call call, const First& first, const More&... more) noexcept {
        if (!recording()) [[likely]]
            return;
        static_assert(sizeof...(More) < kMostParameters);
        const void** at = at_;
        *at++ = &first;
        ((*at++ = &more), ...);
        begin(call, first.bits);
    }
    ~Recorded() {
        if (slot_ != 0) [[unlikely]]
            end();
    }
    Recorded(const Recorded&) = delete;
    Recorded& operator=(const Recorded&) = delete;

private:
    static constexpr size_t kMostParameters = 8;

    void begin(Call call, uint64_t handle) noexcept;
    void end() noexcept;

    uint32_t slot_ = 0, outer_ = 0;  // slots of worlds, 0: not recorded; of the call around this one
    Call call_{};
    const void* at_[kMostParameters];
};

#define TAUT_RECORD(function, ...) const Recorded recorded(&function, Call::function, __VA_ARGS__)

// A world was changed by a call: where that is none that is being recorded, the recording cannot be replayed, and says
// so.
void note_change(const char* call, uint32_t world) noexcept;

}  // namespace taut
