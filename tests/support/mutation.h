// Files with mistakes in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>

namespace keyhole::test {

/// Random choices that are the same with every standard library.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : bits_(seed) {}
    /// One of 0 to n - 1; n > 0.
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits_() % n); }
    template <class T> const T& of(std::span<const T> choices) { return choices[below(choices.size())]; }

  private:
    std::mt19937_64 bits_;
};

/// A value for any key: a number that may pass, or one out of bounds, or what isn't a number at all.
const std::string& bad_value(Dice& dice);

/// Text with one or two mistakes: numbers and words replaced, lines lost, doubled or swapped, an end cut off, bytes
/// flipped.
std::string mistaken_text(std::string text, Dice& dice);

/// The same for files that are no text: bytes flipped or lost, an end cut off.
std::string mistaken_bytes(std::string bytes, Dice& dice);

} // namespace keyhole::test
