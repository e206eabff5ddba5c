// Which part of a team goes through which run of a list: the one that had most of its elements in hand last. Lists lie
// in the order in which the host made things, while lanes are cut by place: an element that one part finds and another
// solves would move from cache to cache twice a frame. Who goes through what changes no result.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/memory.h"

namespace taut {

class Homes {
public:
    static constexpr uint32_t kRun = 64;  // elements

    explicit Homes(Memory& memory) : votes_(memory), home_(memory) {}

    // Before the list is gone through, now that it has so many elements: votes that were given since the last call
    // count from here on, and new ones are taken. Without any, homes stay, at first even ones. Throws std::bad_alloc
    // before anything changes.
    void settle(uint32_t parts, uint32_t count) {
        const uint32_t runs = parts > 1 ? (count + kRun - 1) / kRun : 0;
        const size_t votes = size_t{parts} * runs;
        if (votes > votes_.size()) reserve_more(votes_, votes - votes_.size());
        if (runs > home_.size()) reserve_more(home_, runs - home_.size());
        if (std::ranges::any_of(votes_, [](uint16_t number) { return number > 0; })) count_votes();
        parts_ = parts;
        runs_ = runs;
        votes_.assign(votes, 0);
        if (home_.empty())
            for (uint32_t run = 0; run < runs_; ++run) home_.push_back(static_cast<uint8_t>(run * parts_ / runs_));
        home_.resize(runs_, home_.empty() ? uint8_t{0} : home_.back());
    }
    // A part has an element in hand. Parts may vote side by side, each for itself.
    void vote(uint32_t part, uint32_t index) {
        if (part < parts_ && index / kRun < runs_) ++votes_[size_t{part} * runs_ + index / kRun];
    }
    // Of an element: the part that has its run.
    uint32_t operator()(uint32_t index) const { return index / kRun < runs_ ? home_[index / kRun] : 0; }

private:
    // For whom nobody votes, the home before goes on.
    void count_votes() {
        home_.clear();
        for (uint32_t run = 0; run < runs_; ++run) {
            uint32_t best = run > 0 ? home_.back() : 0, most = 0;
            for (uint32_t part = 0; part < parts_; ++part)
                if (const uint32_t number = votes_[size_t{part} * runs_ + run]; number > most)
                    best = part, most = number;
            home_.push_back(static_cast<uint8_t>(best));
        }
    }

    uint32_t parts_ = 0, runs_ = 0;
    Array<uint16_t> votes_;  // by part and run
    Array<uint8_t> home_;    // by run
};

}  // namespace taut
