// A running hash of plain values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// FNV-1a (Fowler, Noll, Vo) on 64 bits. For values without padding.
class Hash {
  public:
    template <class T> void add(const T& value) { add_bytes(std::as_bytes(std::span(&value, 1))); }
    template <class T> void add(const std::vector<T>& values) { add_bytes(std::as_bytes(std::span(values))); }
    std::uint64_t value() const { return value_; }

  private:
    void add_bytes(std::span<const std::byte> bytes) {
        for (const std::byte b : bytes) value_ = (value_ ^ static_cast<std::uint64_t>(b)) * 0x100000001B3ULL;
    }
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

} // namespace keyhole
