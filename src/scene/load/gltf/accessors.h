// Numbers in the buffers of glTF files.
#pragma once

#include "scene/load/gltf/document.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole::gltf {

/// What an accessor holds: `count` rows of `width` numbers.
template <class T> struct Table {
    std::size_t count = 0, width = 0;
    std::vector<T> values;
};
using NumberTable = Table<float>;

/// Reads accessors of any component type, normalised, interleaved and sparse ones too, and keeps the buffers.
class AccessorReader {
  public:
    explicit AccessorReader(const Document& document) : document_(document) {}

    /// @throws InputError for an accessor that reaches beyond its buffer, and for matrices.
    NumberTable read(std::size_t index) { return read_as<float>(index); }
    /// Of vertices, exactly. @throws InputError as read(), and for what isn't single whole numbers from 0 on.
    std::vector<std::uint32_t> read_indices(std::size_t index);

  private:
    /// Where rows of numbers lie.
    struct Rows {
        std::string_view bytes;
        std::size_t stride = 0;
        int component = 0; ///< its number in glTF
        bool normalized = false;
    };
    Rows rows(const Json& owner, std::size_t width, std::size_t count, const std::string& name);
    std::string_view view(std::size_t index);
    template <class T> Table<T> read_as(std::size_t index);
    template <class T> void replace(const Json& sparse, const Rows& like, Table<T>& table);
    double number(const Rows& rows, std::size_t row, std::size_t column) const;
    std::size_t size_of(int component) const;

    const Document& document_;
    std::map<std::size_t, std::string> buffers_;
};

} // namespace keyhole::gltf
