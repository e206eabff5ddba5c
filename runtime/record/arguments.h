// The parameters of a call, from its function's type: written, read back and handed to it.
#pragma once

#include <string_view>
#include <tuple>
#include <utility>

#include "record/codec.h"

namespace taut {

template <auto function>
struct Arguments;
template <class... P, taut_result (*function)(P...)>
struct Arguments<function> {
    // at: addresses of the arguments.
    static void encode(Encoder& encoder, const void* const* at) {
        [&]<size_t... i>(std::index_sequence<i...>) { (visit_parameter(encoder, *static_cast<const P*>(at[i])), ...); }
        (std::index_sequence_for<P...>());
    }
    // The handles that it gave.
    static void encode_given(Encoder& encoder, const void* const* at) {
        [&]<size_t... i>(std::index_sequence<i...>) {
            (for_given([&](const auto& handle) { encoder.one(handle); }, *static_cast<const P*>(at[i])), ...);
        }
        (std::index_sequence_for<P...>());
    }

    // Calls with what decoder reads, at act(handle) of those that were given. False: that is not the arguments.
    template <class Act>
    static bool call(Decoder& decoder, bool is_sized, taut_result& result, Act&& act) {
        std::tuple<P...> values{};
        std::apply([&](P&... each) { (visit_parameter(decoder, each), ...); }, values);
        if (!decoder.is_done()) return false;
        // The last one is the size of what it writes.
        if constexpr (std::is_same_v<std::tuple_element_t<sizeof...(P) - 1, std::tuple<P...>>, uint32_t>)
            if (is_sized && std::get<sizeof...(P) - 1>(values) > Decoder::kMostOut) return false;
        result = std::apply(function, values);
        if (result == TAUT_OK) std::apply([&](const P&... each) { (for_given(act, each), ...); }, values);
        return true;
    }
};

constexpr bool is_sized(std::string_view function) { return function.ends_with("_sized"); }

}  // namespace taut
