// What a step that fails leaves: the world as it was, bit by bit. The state is noted before a step that may fail, which
// costs about a tenth of it: where the host is asked before contacts are solved, and where memory was taken since the
// last step began, as it is while scenes grow. Steps of a warm world take none.
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

    // Before a step. Throws std::bad_alloc with nothing changed.
    void note(World& world);
    // After one that went well, and after one that failed: where nothing was noted, that stays as the step left it.
    void keep(const World& world) noexcept;
    void restore(World& world) noexcept;

private:
    struct Note;
    void forget() noexcept;

    Memory& memory_;
    Note* note_ = nullptr;
    bool noted_ = false;  // this step
    uint64_t calls_ = 0;  // of memory, as the last step began
};

}  // namespace taut
