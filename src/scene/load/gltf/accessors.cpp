#include "scene/load/gltf/accessors.h"

#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

namespace keyhole::gltf {
namespace {

/// Sizes of the component types from the first on; one of them doesn't exist.
constexpr int kFirstComponent = 5120;
constexpr std::array<std::size_t, 7> kSizes{1, 1, 2, 2, 0, 4, 4};
constexpr std::array<const char*, 5> kTypes{"", "SCALAR", "VEC2", "VEC3", "VEC4"};

template <class T> double number_at(const char* place, bool normalized) {
    T x{};
    std::memcpy(&x, place, sizeof x);
    if constexpr (std::is_integral_v<T>)
        if (normalized) return std::max(static_cast<double>(x) / std::numeric_limits<T>::max(), -1.0);
    return static_cast<double>(x);
}

} // namespace

std::size_t AccessorReader::size_of(int component) const {
    const int kind = component - kFirstComponent;
    const std::size_t size = kind >= 0 && kind < static_cast<int>(kSizes.size()) ? kSizes[kind] : 0;
    if (size == 0) document_.fail(fmt::format("found the component type {}, expected one of 5120 to 5126", component));
    return size;
}

std::string_view AccessorReader::view(std::size_t index) {
    const std::size_t buffer = document_.buffer_of_view(index);
    if (document_.is_binary(buffer)) return document_.view_within(document_.binary(), index);
    const auto [known, fresh] = buffers_.try_emplace(buffer);
    if (fresh) known->second = document_.buffer_bytes(buffer);
    return document_.view_within(known->second, index);
}

/// @param owner names the view, perhaps with an offset and a component type of its own
AccessorReader::Rows AccessorReader::rows(const Json& owner, std::size_t width, std::size_t count,
                                          const std::string& name) {
    Rows rows;
    const auto index = owner.at("bufferView").get<std::size_t>();
    rows.bytes = view(index);
    rows.component = owner.at("componentType").get<int>();
    rows.normalized = value_or(owner, "normalized", false);
    const std::size_t size = width * size_of(rows.component);
    rows.stride = value_or(document_.entry("bufferViews", index), "byteStride", size);
    const auto offset = value_or<std::size_t>(owner, "byteOffset", 0), all = rows.bytes.size();
    const bool fits =
        offset <= all &&
        (count == 0 || (all - offset >= size && rows.stride > 0 && count - 1 <= (all - offset - size) / rows.stride));
    if (!fits) document_.fail(fmt::format("found {} beyond its view of {} bytes", name, all));
    rows.bytes.remove_prefix(offset);
    return rows;
}

double AccessorReader::number(const Rows& rows, std::size_t row, std::size_t column) const {
    const char* place = rows.bytes.data() + row * rows.stride + column * size_of(rows.component);
    switch (rows.component) {
    case 5120:
        return number_at<std::int8_t>(place, rows.normalized);
    case 5121:
        return number_at<std::uint8_t>(place, rows.normalized);
    case 5122:
        return number_at<std::int16_t>(place, rows.normalized);
    case 5123:
        return number_at<std::uint16_t>(place, rows.normalized);
    case 5125:
        return number_at<std::uint32_t>(place, rows.normalized);
    default:
        return number_at<float>(place, false);
    }
}

/// Puts the rows of the sparse part in their places.
template <class T> void AccessorReader::replace(const Json& sparse, const Rows& like, Table<T>& table) {
    const auto count = sparse.at("count").get<std::size_t>();
    const Rows places = rows(sparse.at("indices"), 1, count, "indices of a sparse accessor");
    Json values = sparse.at("values");
    values["componentType"] = like.component;
    values["normalized"] = like.normalized;
    const Rows from = rows(values, table.width, count, "values of a sparse accessor");
    for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<std::size_t>(number(places, i, 0));
        if (row >= table.count)
            document_.fail(fmt::format("found entry {} replaced, expected one of {}", row, table.count));
        for (std::size_t c = 0; c < table.width; ++c)
            table.values[row * table.width + c] = static_cast<T>(number(from, i, c));
    }
}

template <class T> Table<T> AccessorReader::read_as(std::size_t index) {
    const Json& accessor = document_.entry("accessors", index);
    Table<T> table;
    const auto type = accessor.at("type").get<std::string>();
    const auto* const known = std::ranges::find(kTypes, type);
    if (type.empty() || known == kTypes.end())
        document_.fail(fmt::format("found the type '{}' of accessor {}, expected numbers or vectors", type, index));
    table.width = static_cast<std::size_t>(known - kTypes.begin());
    table.count = accessor.at("count").get<std::size_t>();
    const std::string name = fmt::format("accessor {}", index);
    if (table.count > 3 * kMaxMeshTriangles)
        document_.fail(
            fmt::format("found {} with {} entries, expected at most {}", name, table.count, 3 * kMaxMeshTriangles));
    Rows from;
    from.component = accessor.at("componentType").get<int>();
    from.normalized = value_or(accessor, "normalized", false);
    const bool listed = accessor.contains("bufferView"); // otherwise all are zero
    if (listed) from = rows(accessor, table.width, table.count, name);
    table.values.resize(table.count * table.width);
    for (std::size_t i = 0; listed && i < table.count; ++i)
        for (std::size_t c = 0; c < table.width; ++c)
            table.values[i * table.width + c] = static_cast<T>(number(from, i, c));
    if (const auto sparse = accessor.find("sparse"); sparse != accessor.end()) replace(*sparse, from, table);
    return table;
}

std::vector<std::uint32_t> AccessorReader::read_indices(std::size_t index) {
    const Json& accessor = document_.entry("accessors", index);
    const auto type = accessor.at("type").get<std::string>();
    if (type != "SCALAR") document_.fail(fmt::format("found indices of the type '{}', expected SCALAR", type));
    constexpr std::array kWhole{5121, 5123, 5125};
    const auto component = accessor.at("componentType").get<int>();
    if (std::ranges::find(kWhole, component) == kWhole.end())
        document_.fail(
            fmt::format("found indices of the component type {}, expected one of 5121, 5123, 5125", component));
    return read_as<std::uint32_t>(index).values;
}

template Table<float> AccessorReader::read_as<float>(std::size_t);

} // namespace keyhole::gltf
