// The arrays of an inspection's page.
#pragma once

#include "methods/inspection/inspection.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// Arrays one after the other, each at a multiple of 4 bytes, little-endian; the page inflates them into typed arrays.
class BinaryData {
  public:
    void add(std::string_view name, std::span<const float> values) { add(name, "Float32Array", values); }
    void add(std::string_view name, std::span<const std::uint32_t> values) { add(name, "Uint32Array", values); }
    void add(std::string_view name, std::span<const std::int32_t> values) { add(name, "Int32Array", values); }
    void add(std::string_view name, std::span<const std::uint16_t> values) { add(name, "Uint16Array", values); }
    void add(std::string_view name, std::span<const std::int16_t> values) { add(name, "Int16Array", values); }
    void add(std::string_view name, std::span<const std::uint8_t> values) { add(name, "Uint8Array", values); }
    void add(std::string_view name, std::span<const std::int8_t> values) { add(name, "Int8Array", values); }

    /// {"arrays": {name: [type, offset, length]}, "deflated": base64 of zlib's format}
    nlohmann::ordered_json json() const;

  private:
    template <class T> void add(std::string_view name, const char* type, std::span<const T> values) {
        directory_[std::string(name)] = {type, bytes_.size(), values.size()};
        bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
    }

    nlohmann::ordered_json directory_ = nlohmann::ordered_json::object();
    std::string bytes_;
};

/// Places in 16 bits a coordinate: 0 is `lower`, 65535 `upper`.
struct PlaceCode {
    Vec3 lower, upper;

    void encode(const Vec3& p, std::vector<std::uint16_t>& to) const;
    nlohmann::ordered_json json() const;
};

/// Puts all of it into `data`. `surface` is for what lies on surfaces, `air` for the ends of lines that may lead out of
/// the scene: what is infinitely far away is drawn `far` [m] away.
void add_arrays(const Inspection& inspection, const PlaceCode& surface, const PlaceCode& air, float far,
                BinaryData& data);

} // namespace keyhole
