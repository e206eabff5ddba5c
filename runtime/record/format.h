// A recording's file: a magic word, then records one after the other, the first of which is the head. A record is
//
//     uint32 kind, uint32 size, uint32 check(kind, size), size bytes, uint32 check(bytes)
//
// where a kind is a call's number among the names in the head, or one of the others. A call is followed by the answers
// of host functions within it, and by its result; the last one of a process that died has none.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

#include "base/hash.h"

namespace taut {

constexpr char kRecordMagic[8] = {'T', 'A', 'U', 'T', 'R', 'E', 'C', '\n'};
constexpr uint32_t kRecordVersion = 2;

enum class Record : uint32_t {
    head = 0x80000000,  // version of the format, of the library, the world's def, names of calls
    result,             // taut_result, 1 with a hash, the hash of the state, handles given
    answer,             // of pre_solve: what it said, friction, restitution, colliders asked about
    baked,              // which of BakedDef, the def
    unrecorded,         // name of a call that changed the world and is not in the list of calls
    end                 // the world was destroyed, or is recorded no more
};
enum class BakedDef : uint32_t { hull, mesh, height_field, not_kept };

struct Answer {
    int32_t said;
    float friction, restitution;
    uint64_t collider_a, collider_b;  // as in the recording
};

inline uint32_t check_of(std::span<const std::byte> bytes) {
    Hash hash;
    hash.add(uint64_t{bytes.size()});
    for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
        uint64_t word;
        std::memcpy(&word, bytes.data(), sizeof word);
        hash.add(word);
    }
    uint64_t rest = 0;
    if (!bytes.empty()) std::memcpy(&rest, bytes.data(), bytes.size());
    hash.add(rest);
    return static_cast<uint32_t>(hash.value() ^ hash.value() >> 32);
}

}  // namespace taut
