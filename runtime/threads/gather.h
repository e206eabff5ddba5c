// Lists made side by side, the same for any team: in fixed blocks, each of which one thread goes through.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "base/memory.h"
#include "threads/team.h"

namespace taut {

// Of loops that nobody has in hand: as much for each.
struct Evenly {};

// A range cut into blocks.
class Blocks {
public:
    static constexpr uint32_t kMost = 64;

    explicit Blocks(uint32_t count) : count_(count), length_(std::max(kLeast, (count + kMost - 1) / kMost)) {}

    uint32_t number() const { return (count_ + length_ - 1) / length_; }
    uint32_t begin(uint32_t block) const { return block * length_; }
    uint32_t end(uint32_t block) const { return std::min(begin(block) + length_, count_); }

    // act(block) for all of them; home(index) of the first in each, or Evenly.
    template <class Home, class Act>
    void for_each(Team& team, Home&& home, Act&& act) const {
        const auto some = [&](uint32_t first, uint32_t last) {
            for (uint32_t block = first; block < last; ++block) act(block);
        };
        if constexpr (std::is_same_v<std::remove_cvref_t<Home>, Evenly>)
            team.for_ranges(number(), 1, some);
        else
            team.for_runs(
                number(), 1, 1, [&](uint32_t block) { return home(begin(block)); },
                [&](const Team::Runs& runs) { runs.for_each(some); });
    }

private:
    static constexpr uint32_t kLeast = 64;

    uint32_t count_, length_;
};

// Into picked, in ascending order, the indices below count for which picks(index) holds. Each is asked once.
template <class Picks, class Home = Evenly>
void gather(Team& team, uint32_t count, Array<uint32_t>& picked, Picks&& picks, const Home& home = {}) {
    const Blocks blocks(count);
    uint32_t found[Blocks::kMost];
    picked.resize(count);  // each block picks into its own part
    blocks.for_each(team, home, [&](uint32_t block) {
        uint32_t* const first = picked.data() + blocks.begin(block);
        uint32_t* to = first;
        for (uint32_t i = blocks.begin(block); i < blocks.end(block); ++i) {
            *to = i;  // stays if picked; no branch, for which are is often random
            to += picks(i) ? 1 : 0;
        }
        found[block] = static_cast<uint32_t>(to - first);
    });
    auto kept = picked.begin();
    for (uint32_t block = 0; block < blocks.number(); ++block)
        kept = std::copy_n(picked.begin() + blocks.begin(block), found[block], kept);
    picked.erase(kept, picked.end());
}

// Likewise those of a list for which picks(item) holds, in its order.
template <class Picks>
void gather(Team& team, std::span<const uint32_t> list, Array<uint32_t>& picked, Picks&& picks) {
    gather(team, static_cast<uint32_t>(list.size()), picked, [&](uint32_t i) { return picks(list[i]); });
    for (uint32_t& item : picked) item = list[item];
}

// Into list, in ascending order of the indices below count, length_of(index) elements for each, which write(index, to)
// leaves at `to`.
template <class T, class LengthOf, class Write, class Home = Evenly>
void write_list(Team& team, uint32_t count, Array<T>& list, LengthOf&& length_of, Write&& write,
                const Home& home = {}) {
    const Blocks blocks(count);
    size_t first[Blocks::kMost];
    blocks.for_each(team, home, [&](uint32_t block) {
        first[block] = 0;
        for (uint32_t i = blocks.begin(block); i < blocks.end(block); ++i) first[block] += length_of(i);
    });
    size_t whole = 0;
    for (uint32_t block = 0; block < blocks.number(); ++block) whole += std::exchange(first[block], whole);
    if (whole > list.size()) reserve_more(list, whole - list.size());
    list.resize(whole);
    blocks.for_each(team, home, [&](uint32_t block) {
        T* to = list.data() + first[block];
        for (uint32_t i = blocks.begin(block); i < blocks.end(block); ++i) {
            write(i, to);
            to += length_of(i);
        }
    });
}

// join() of what of(begin, end) says of each block, in their order.
template <class T, class Of, class Join>
T reduce(Team& team, uint32_t count, T none, Of&& of, Join&& join) {
    const Blocks blocks(count);
    T parts[Blocks::kMost];
    blocks.for_each(team, Evenly{}, [&](uint32_t block) { parts[block] = of(blocks.begin(block), blocks.end(block)); });
    for (uint32_t block = 0; block < blocks.number(); ++block) none = join(none, parts[block]);
    return none;
}

}  // namespace taut
