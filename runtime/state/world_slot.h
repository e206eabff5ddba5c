// A slot of the table of worlds: who holds its world, and which generation that is, in one word, so that finding and
// locking are one atomic step. A slot whose generations are used up is retired, so that no handle of a world that is
// gone, nor any into it, can come back to life.
#pragma once

#include <atomic>
#include <cstdint>

namespace taut {

struct World;

// A world's id is slot << 14 | generation; slot 0 is not used and generations begin at 1, so an id is never 0.
constexpr uint32_t kWorldSlots = 1024, kMaxWorldGeneration = 0x3fff;
constexpr uint32_t world_slot_of(uint32_t id) { return id >> 14 & (kWorldSlots - 1); }
constexpr uint32_t make_world_id(uint32_t slot, uint32_t generation) { return slot << 14 | generation; }

class WorldSlot {
public:
    World* world = nullptr;  // written before it lives, read by who holds the slot
    bool changed = false;    // whether anyone has held it for writing; of who holds it alone

    // Takes the slot for a world of its next generation. False where it is taken or retired.
    bool take() noexcept {
        uint32_t state = state_.load(std::memory_order_relaxed);
        if ((state & kTaken) || generation_of(state) == kMaxWorldGeneration) return false;
        return state_.compare_exchange_strong(state, kTaken | of_generation(generation_of(state) + 1),
                                              std::memory_order_acquire, std::memory_order_relaxed);
    }
    // The world was not made. No handle has seen the generation: it is given back.
    void give_back() noexcept { state_.store(of_generation(generation() - 1), std::memory_order_release); }
    void begin_life() noexcept {
        state_.store(kTaken | kLive | of_generation(generation()), std::memory_order_release);
    }
    // Handles are stale from here on, also for callbacks. Of the holder of a write lock, as release() is.
    void end_life() noexcept { state_.fetch_and(~kLive, std::memory_order_relaxed); }
    void release() noexcept { state_.fetch_and(~(kWriter | kTaken), std::memory_order_release); }

    bool lives(uint32_t id) const noexcept { return lives(state_.load(std::memory_order_acquire), id); }
    uint32_t generation() const noexcept { return generation_of(state_.load(std::memory_order_relaxed)); }

    enum class Lock { held, stale, busy };
    Lock lock(uint32_t id, bool write) noexcept {
        uint32_t state = state_.load(std::memory_order_relaxed);
        for (;;) {
            if (!lives(state, id)) return Lock::stale;
            const bool busy =
                write ? (state & (kWriter | kReaders)) != 0 : (state & kWriter) != 0 || (state & kReaders) == kReaders;
            if (busy) return Lock::busy;
            const uint32_t held = write ? state | kWriter : state + 1;
            if (state_.compare_exchange_weak(state, held, std::memory_order_acquire, std::memory_order_relaxed))
                return Lock::held;
        }
    }
    void unlock(bool write) noexcept {
        if (write)
            state_.fetch_and(~kWriter, std::memory_order_release);
        else
            state_.fetch_sub(1, std::memory_order_release);
    }

private:
    // readers 15 bits | writer | taken (a world is being made, lives or is being destroyed) | live | generation 14 bits
    static constexpr uint32_t kReaders = 0x7fff, kWriter = 1u << 15, kTaken = 1u << 16, kLive = 1u << 17;
    static constexpr uint32_t generation_of(uint32_t state) { return state >> 18; }
    static constexpr uint32_t of_generation(uint32_t generation) { return generation << 18; }
    static bool lives(uint32_t state, uint32_t id) {
        return (state & kLive) && generation_of(state) == (id & kMaxWorldGeneration);
    }

    std::atomic<uint32_t> state_{0};
};

}  // namespace taut
