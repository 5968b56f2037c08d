// What gather rays may take over from the places of an irradiance map besides indirect light.
#pragma once

#include "core/progress.h"
#include "gather/direct_light.h"
#include "photonmap/photon.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// Direct light at the places of an irradiance map. Immutable and thread-safe once built.
class DirectIrradianceCache {
  public:
    /// `places` are those of the irradiance map, and must outlive this. Of clear glass on the way to emitters at most
    /// `most_faces` are looked through.
    DirectIrradianceCache(const Scene& scene, std::span<const Photon> places, int most_faces, std::uint64_t seed,
                          const RunContext& context);

    /// Irradiance that emitters bring to `position`, near place i [W/m^2]; none where it may change too fast for
    /// another place's.
    std::optional<Rgb> direct(std::uint32_t i, const Vec3& position) const;

    std::size_t bytes() const { return entries_.capacity() * sizeof(Entry); }
    /// Of it, for one place [bytes].
    static constexpr std::size_t bytes_per_place() { return sizeof(Entry); }

  private:
    struct Entry {
        SharedExponentRgb direct;
        float reach = 0; ///< [m]
    };
    Entry at(const Scene& scene, std::uint32_t i, const LightSamples& samples, std::uint64_t seed) const;

    std::span<const Photon> places_;
    std::vector<Entry> entries_;
};

} // namespace keyhole
