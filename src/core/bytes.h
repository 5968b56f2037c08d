// Values as bytes and back: in files, and for another process. Numbers are as they are in memory.
#pragma once

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <string>
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
concept Plain =
    !InParts<T> && !std::is_pointer_v<T> &&
    (std::is_trivially_copyable_v<T> || (std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>));

/// The bytes of `n` values in memory.
template <Plain T> std::span<const char> bytes_of(const T* values, std::size_t n = 1) {
    return {reinterpret_cast<const char*>(values), n * sizeof(T)};
}
template <Plain T> std::span<char> bytes_of(T* values, std::size_t n = 1) {
    return {reinterpret_cast<char*>(values), n * sizeof(T)};
}

/// Puts values one after the other. Vectors, texts and maps are led by their size, of 8 bytes; what may be missing by a
/// byte that says whether it is there.
class ByteWriter {
  public:
    template <class T> void put(const T& value) {
        if constexpr (InParts<T>)
            std::apply([this](const auto&... part) { (put(part), ...); }, const_cast<T&>(value).parts());
        else
            append(&value, 1);
    }
    template <class T> void put(const std::vector<T>& values) {
        put(std::uint64_t{values.size()});
        if constexpr (Plain<T>)
            append(values.data(), values.size());
        else
            for (const T& value : values) put(value);
    }
    void put(const std::string& text) {
        put(std::uint64_t{text.size()});
        append(text.data(), text.size());
    }
    template <class Key, class T> void put(const std::map<Key, T>& values) {
        put(std::uint64_t{values.size()});
        for (const auto& [key, value] : values) put(key), put(value);
    }
    template <class T> void put(const std::optional<T>& value) {
        put(static_cast<char>(value ? 1 : 0));
        if (value) put(*value);
    }
    /// Values without their number.
    template <class T> void append(const T* values, std::size_t n) {
        const auto bytes = bytes_of(values, n);
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    std::vector<char> take() { return std::move(bytes_); }

  private:
    std::vector<char> bytes_;
};

/// Takes values in the order in which a ByteWriter was given them. The bytes must outlive this.
/// @throws InputError where they end too early.
class ByteReader {
  public:
    explicit ByteReader(std::span<const char> bytes) : bytes_(bytes) {}

    template <class T> void get(T& value) {
        if constexpr (InParts<T>)
            std::apply([this](auto&... part) { (get(part), ...); }, value.parts());
        else
            value = copy<T>(next(1, sizeof(T)));
    }
    template <class T> void get(std::vector<T>& values) {
        const auto n = get<std::uint64_t>();
        values.clear();
        if constexpr (Plain<T>) {
            const char* from = next(n, sizeof(T));
            values.reserve(n);
            for (std::size_t i = 0; i < n; ++i) values.push_back(copy<T>(from + i * sizeof(T)));
        } else {
            for (std::uint64_t i = 0; i < n; ++i) get(values.emplace_back());
        }
    }
    void get(std::string& text) {
        const auto n = get<std::uint64_t>();
        text.assign(next(n, 1), n);
    }
    template <class Key, class T> void get(std::map<Key, T>& values) {
        values.clear();
        for (auto n = get<std::uint64_t>(); n > 0; --n) {
            Key key = get<Key>();
            get(values[std::move(key)]);
        }
    }
    template <class T> void get(std::optional<T>& value) {
        value.reset();
        if (get<char>() != 0) get(value.emplace());
    }
    template <class T> T get() {
        T value{};
        get(value);
        return value;
    }
    bool at_end() const { return bytes_.empty(); }

  private:
    const char* next(std::uint64_t n, std::size_t size) {
        if (n > bytes_.size() / size) throw InputError("found fewer bytes than were announced: the data are damaged");
        const char* at = bytes_.data();
        bytes_ = bytes_.subspan(n * size);
        return at;
    }
    template <Plain T> static T copy(const char* from) {
        alignas(T) std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), from, sizeof(T));
        return *reinterpret_cast<const T*>(raw.data());
    }

    std::span<const char> bytes_;
};

/// FNV-1a (Fowler, Noll, Vo) on 64 bits, by words of 8 bytes. For values without padding.
class Hash {
  public:
    template <class T> void add(const T& value) { add_bytes(std::as_bytes(std::span(&value, 1))); }
    template <class T> void add(const std::vector<T>& values) { add_bytes(std::as_bytes(std::span(values))); }
    void add(std::string_view text) { add_bytes(std::as_bytes(std::span(text))); }
    std::uint64_t value() const { return value_; }

  private:
    void add_bytes(std::span<const std::byte> bytes) {
        for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), sizeof(std::uint64_t)))) {
            std::uint64_t word = 0;
            std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
            value_ = (value_ ^ word) * 0x100000001B3ULL;
            value_ ^= value_ >> 32; // a product moves bits upwards alone
        }
    }
    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

} // namespace keyhole
