// A joint's data as its constraint type has them.
#pragma once

#include <cstring>
#include <type_traits>

#include "state/joints.h"

namespace taut {

// Or what they begin with. Eigen's vectors are plain numbers, though not trivially copyable by the letter.
template <class Data>
Data read_data(const Joint& joint) {
    static_assert(sizeof(Data) <= Joint::kDataSize && std::is_trivially_destructible_v<Data>);
    Data data;
    std::memcpy(static_cast<void*>(&data), joint.data, sizeof data);
    return data;
}

template <class Data>
void write_data(Joint& joint, const Data& data) {
    static_assert(sizeof(Data) <= Joint::kDataSize && std::is_trivially_destructible_v<Data>);
    std::memcpy(joint.data, static_cast<const void*>(&data), sizeof data);
}

}  // namespace taut
