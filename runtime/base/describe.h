// What of a world there is to hash, count, save, restore and compare: for each struct of the state one list of its
// fields, describe(visitor, struct), which stands below the struct. A list binds all fields by name,
//
//     auto& [x, q, v] = of;             a new field does not compile until it is named here,
//     TAUT_FIELDS(visitor, x, q);       and then is in a list,
//     TAUT_ASIDE(visitor, v);           or left out for a reason that is said there.
//
// Visitors are in snapshot/. Each takes numbers, enumerations, vectors, arrays of these and all that has a list.
#pragma once

#include <concepts>
#include <cstddef>
#include <type_traits>

// Fields from which what comes next follows, and which are equal in worlds where that is.
#define TAUT_FIELDS(visitor, ...) (visitor).fields(#__VA_ARGS__, __VA_ARGS__)
// Fields that are saved, but do not count for the hash: which of the same things it is (generations, serials), and
// what the host is told.
#define TAUT_ASIDE(visitor, ...) (visitor).aside(#__VA_ARGS__, __VA_ARGS__)
// A list that is saved, and counts for the hash where it is not empty.
#define TAUT_RARE(visitor, list) (visitor).rare(#list, list)
// Of each live slot of an IdPool, which was listed before, its element in each of these columns: arrays or
// SharedValues, by slot.
#define TAUT_ROWS(visitor, ids, ...) (visitor).rows(#__VA_ARGS__, ids, __VA_ARGS__)

namespace taut {

// A struct, or a const one.
template <class T, class Struct>
concept Like = std::same_as<std::remove_const_t<T>, Struct>;

// To, const where From is.
template <class From, class To>
using copy_const_t = std::conditional_t<std::is_const_v<From>, const To, To>;

// Some plain bytes, as many as are in use.
template <class Byte>
struct Bytes {
    Byte* first;
    size_t count;
};
template <class Byte>
Bytes(Byte*, size_t) -> Bytes<Byte>;

// A column that is empty as long as all of its elements are as made.
template <class Array>
struct OrNone {
    Array& array;
};
template <class Array>
OrNone(Array&) -> OrNone<Array>;

}  // namespace taut
