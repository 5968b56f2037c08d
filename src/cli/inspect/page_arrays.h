// The arrays of an inspection's page.
#pragma once

#include "cli/inspect/binary_data.h"
#include "methods/inspection/inspection.h"

namespace keyhole {

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
