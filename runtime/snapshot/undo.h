// What a step that fails leaves: the world as it was, bit by bit. A step fails where the host has no memory for it, so
// the state is noted before steps that may need some: those of a world that took memory since its last step began, as
// while it is built and grows. Steps of a warm world take none, and note nothing: the first one after some that does
// need memory, and gets none, leaves a world that is consistent, part of the way on.
#pragma once

#include <cstdint>

#include "base/memory.h"

namespace taut {

struct World;

class Undo {
public:
    explicit Undo(Memory& memory) : memory_(memory) {}
    ~Undo() { forget(); }
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;

    // Before a step. Throws std::bad_alloc with nothing changed. The room of a note stays until a step needs none.
    void note(World& world);
    // After one that failed; nothing happens where nothing was noted.
    void restore(World& world) noexcept;

private:
    struct Note;
    void forget() noexcept;

    Memory& memory_;
    Note* note_ = nullptr;
    bool noted_ = false;  // in this step
    uint64_t calls_ = 0;  // of memory, as the last step began
};

}  // namespace taut
