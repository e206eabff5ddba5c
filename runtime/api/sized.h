// Structs that programs of older headers hand over or receive. A struct grows at its end alone, so that an older one is
// the beginning of ours: of a shorter def the rest takes its defaults, of what is read the beginning is written. What
// lies inside of another struct does not grow.
#pragma once

#include <cstring>

#include "api/access.h"

namespace taut {

// A def as this library knows it; init: the one that writes its defaults. def.struct_size becomes ours.
template <class Def>
bool take_def(Check& check, const Def* given, void (*init)(Def*), Def& def, const char* name = "def") {
    if (!check.pointer(name, given) || !check.struct_size(given->struct_size, sizeof(Def), alignof(Def))) return false;
    init(&def);
    std::memcpy(static_cast<void*>(&def), given, given->struct_size);
    def.struct_size = sizeof def;
    return true;
}

// To a host that said how long its struct is, in its struct_size; checked before.
template <class Def>
void give_def(const Def& def, Def* out) {
    const uint32_t size = out->struct_size;
    std::memcpy(static_cast<void*>(out), &def, size);
    out->struct_size = size;
}

// To a host whose records are so long.
template <class Record>
void give_record(const Record& record, void* out, size_t size) {
    std::memcpy(out, &record, size);
}

}  // namespace taut
