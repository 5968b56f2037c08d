// Values as bytes, for another process of the same program on a processor of the same kind.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace keyhole {

/// Has members of its own kind that are more than bytes: `parts()` returns a tuple of references to all of them.
template <class T>
concept InParts = requires(T& t) {
    t.parts();
};

/// Nothing but its bytes. Vectors of Imath have copy constructors of their own that copy these, so that
/// std::is_trivially_copyable would be too strict.
template <class T>
concept Plain = !std::is_pointer_v<T> && (std::is_trivially_copyable_v<T> ||
                                          (std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>));

/// Puts values one after the other.
class ByteWriter {
  public:
    template <class T> void put(T& value) {
        if constexpr (InParts<T>)
            std::apply([this](auto&... part) { (put(part), ...); }, value.parts());
        else
            append(&value, 1);
    }
    template <class T> void put(std::vector<T>& values) {
        std::uint64_t n = values.size();
        put(n);
        if constexpr (InParts<T>)
            for (T& value : values) put(value);
        else
            append(values.data(), values.size());
    }
    template <class T> void put(std::optional<T>& value) {
        char there = value ? 1 : 0;
        put(there);
        if (value) put(*value);
    }

    std::vector<char> take() { return std::move(bytes_); }

  private:
    template <class T> void append(const T* values, std::size_t n) {
        static_assert(Plain<T>);
        const auto bytes = std::as_bytes(std::span(values, n));
        const auto* first = reinterpret_cast<const char*>(bytes.data());
        bytes_.insert(bytes_.end(), first, first + bytes.size());
    }

    std::vector<char> bytes_;
};

/// Takes values in the order in which a ByteWriter was given them. The bytes must outlive this, and be whole.
class ByteReader {
  public:
    explicit ByteReader(std::span<const char> bytes) : bytes_(bytes) {}

    template <class T> void get(T& value) {
        if constexpr (InParts<T>)
            std::apply([this](auto&... part) { (get(part), ...); }, value.parts());
        else
            value = next<T>();
    }
    template <class T> void get(std::vector<T>& values) {
        const auto n = next<std::uint64_t>();
        values.clear();
        values.reserve(n);
        for (std::uint64_t i = 0; i < n; ++i) {
            if constexpr (InParts<T>)
                get(values.emplace_back());
            else
                values.push_back(next<T>());
        }
    }
    template <class T> void get(std::optional<T>& value) {
        value.reset();
        if (next<char>() != 0) get(value.emplace());
    }

  private:
    template <class T> T next() {
        static_assert(Plain<T>);
        alignas(T) std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data(), sizeof(T));
        bytes_ = bytes_.subspan(sizeof(T));
        return *reinterpret_cast<const T*>(raw.data());
    }

    std::span<const char> bytes_;
};

} // namespace keyhole
