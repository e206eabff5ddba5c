// A world's state as bytes, and back into the same world. A header tells what they are; then come the shapes that the
// state stands on, and the state as its lists tell it (base/describe.h), field by field without gaps.
#pragma once

#include <cstddef>
#include <span>

#include "world.h"

namespace taut {

// Of the state alone, without header and shapes, and with elements of lists as their bytes: for this process.
size_t note_size(const World& world);
void save_note(const World& world, std::byte* to);
size_t snapshot_size(const World& world);
// Into as many bytes as snapshot_size() says.
void save(const World& world, std::span<std::byte> to);
// TAUT_OK, or refused with nothing changed, in the name of a call. Throws std::bad_alloc with nothing changed.
taut_result restore(const char* call, World& world, std::span<const std::byte> from);

}  // namespace taut
