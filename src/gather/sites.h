// What gather rays may take over from the places of an irradiance map besides indirect light.
#pragma once

#include "core/progress.h"
#include "photonmap/photon_map.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

struct SiteOptions {
    int k;                  ///< photons in an estimate of the irradiance map
    float max_radius;       ///< of it [m]
    int direct_samples = 4; ///< of emitters, at each place
    std::uint64_t seed = 1;
};

/// Direct light, and how far estimates look, at the places of an irradiance map. Immutable and thread-safe once built.
class Sites {
  public:
    /// `places` are those of the irradiance map over `photons`, and must outlive this.
    Sites(const Scene& scene, const PhotonMap& photons, std::span<const Photon> places, const SiteOptions& options,
          const RunContext& context);

    /// Irradiance that emitters bring to `position`, near place i [W/m^2]; none where it may change too fast for
    /// another place's.
    std::optional<Rgb> direct(std::uint32_t i, const Vec3& position) const;

    /// Radius of the estimate at place i [m]. 0 in scenes with mirrors or smooth glass: there rays that are traced on
    /// from a near place would lose its caustics, which only a ray that happens to run into the emitter could find.
    float radius(std::uint32_t i) const { return sites_[i].radius; }

    std::size_t bytes() const { return sites_.capacity() * sizeof(Entry); }

  private:
    struct Entry {
        SharedExponentRgb direct;
        float reach = 0, radius = 0; ///< [m]
    };
    Entry at(const Scene& scene, const PhotonMap& photons, std::uint32_t i, const SiteOptions& options) const;

    std::span<const Photon> places_;
    std::vector<Entry> sites_;
};

} // namespace keyhole
