// Numbers in the buffers of glTF files.
#pragma once

#include "scene/load/gltf/document.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole::gltf {

/// What an accessor holds: `count` rows of `width` numbers.
struct NumberTable {
    std::size_t count = 0, width = 0;
    std::vector<float> values;
};

/// Reads accessors of any component type, normalised, interleaved and sparse ones too, and keeps the buffers.
class AccessorReader {
  public:
    explicit AccessorReader(const Document& document) : document_(document) {}

    /// @throws InputError for an accessor that reaches beyond its buffer, and for matrices.
    NumberTable read(std::size_t index);

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
    void replace(const Json& sparse, const Rows& like, NumberTable& table);
    double number(const Rows& rows, std::size_t row, std::size_t column) const;
    std::size_t size_of(int component) const;

    const Document& document_;
    std::map<std::size_t, std::string> buffers_;
};

} // namespace keyhole::gltf
