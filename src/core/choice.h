// Settings that are one of a few words. An enum has, beside its definition, words_of(): a word for each of its values
// in their order. Scene files, the command line and reports use the words, everything else the values.
#pragma once

#include <algorithm>
#include <optional>
#include <string_view>
#include <type_traits>

namespace keyhole {

template <class E>
concept Choice = std::is_enum_v<E> && requires(E e) {
    words_of(e);
};

template <Choice E> constexpr std::string_view word_of(E value) {
    return words_of(value)[static_cast<std::size_t>(value)];
}

/// The value that a word stands for; none: it is no word for any.
template <Choice E> constexpr std::optional<E> choice_of(std::string_view word) {
    const auto words = words_of(E{});
    const auto found = std::ranges::find(words, word);
    return found == words.end() ? std::nullopt : std::optional(static_cast<E>(found - words.begin()));
}

} // namespace keyhole
