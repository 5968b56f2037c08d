// Irradiance computed beforehand at some places (after Christensen 1999, "Faster Photon Map Global Illumination").
#pragma once

#include "core/progress.h"
#include "photonmap/irradiance/surface_lookup_grid.h"
#include "photonmap/piloted_map.h"
#include "sampling/paths/gather_coverage.h"
#include "scene/scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace keyhole {

struct IrradianceOptions {
    int k = 60;                               ///< photons to be expected in an estimate
    float max_radius;                         ///< [m]
    float shrink = 1;                         ///< of regions, as in PhotonQuery
    const SurfacePatches* patches = nullptr;  ///< for the area at edges; null: the disc's. Must outlive the map
    const GatherCoverage* coverage = nullptr; ///< that the map ends at; null: nowhere
    int most_hidden = std::numeric_limits<int>::max(); ///< places that a lookup finds hidden before it gives up
    bool by_length = false;                            ///< whether share_that_reaches() is wanted
    std::size_t grid_bytes = 0;   ///< for lookups without a search; less: IrradianceMap::kGridBytesPerPlace a place
    const Scene* scene = nullptr; ///< for walls that stand on a surface and part it; needs `patches`; null: none do
};

/// Answers with the estimate at the nearest pilot photon on the same piece of surface. Where other surfaces stand on
/// it, photons and estimates that they hide don't count: a floor that goes on beneath a wall would let light through.
/// Immutable and thread-safe once built.
class IrradianceMap {
  public:
    /// Estimates are made at the pilot photons, which must outlive this. `main photons` are only read here.
    IrradianceMap(const PhotonMap& pilots, const PhotonMap& main_photons, const IrradianceOptions& options,
                  const RunContext& context);

    struct Answer {
        Rgb irradiance{0.0};     ///< W/m^2, through the geometric surface
        bool known = false;      ///< false: no pilot photon of this surface within 4 max_radius; irradiance is 0
        std::uint32_t place = 0; ///< index among places()
    };

    /// Irradiance on the side of unit `normal`.
    Answer irradiance(const Vec3& position, const Vec3& normal) const;
    /// The same at a point of the scene. On triangles it takes a fraction of the time: all points of a cell are
    /// answered by the place nearest to its middle (SurfaceLookupGrid).
    Answer irradiance(const SurfacePoint& point, const Vec3& normal) const;

    /// Where irradiance was estimated.
    std::span<const Photon> places() const { return pilots_.photons(); }
    /// Radius of the estimate at place i [m].
    float radius(std::uint32_t i) const { return estimates_[i].radius(); }
    /// Area of the surface in that radius over that of the disc.
    double area_share(std::uint32_t i) const { return estimates_[i].area_share(); }
    /// Whether caustic photons are among those of the estimate at place i (Photon::caustic()).
    bool has_caustics(std::uint32_t i) const { return estimates_[i].has_caustics(); }
    /// Whether it seems to lie in a crevice: its light lies on one side of it, or so little is free above it that the
    /// estimate looks less far than it would for enough photons.
    bool is_in_crevice(std::uint32_t i) const { return estimates_[i].is_in_crevice(); }
    /// Whether the middle of a region is within that radius of it, times `share`, as the region measures: the outer
    /// face of a wall is not near what stands before the inner one.
    bool is_near(std::uint32_t i, const SurfaceRegion& region, float share = 1) const {
        const float reach = share * radius(i);
        return region.distance2(pilots_[i].position()) <= reach * reach;
    }
    /// Of the irradiance at place i, the share of what may take a way to the eye that is longer than the shortest by
    /// `longer` vertices (Photon::spare()), as the estimate's photons have it: noisy. 1 where that isn't known.
    double share_that_reaches(std::uint32_t i, int longer) const {
        if (shares_.empty() || longer <= 0) return 1;
        return shares_[i][static_cast<std::size_t>(std::min(longer, kLongerWays) - 1)] / 255.0;
    }
    /// Whether something may stand there that hides photons in that radius from each other.
    bool obstructed(std::uint32_t i) const { return (estimates_[i].obstructed() & 1) != 0; }

    /// Memory without that of the pilot photons [bytes].
    std::size_t bytes() const {
        return estimates_.capacity() * sizeof(Estimate) + shares_.capacity() * sizeof(Shares) +
               (grid_ ? grid_->bytes() : 0);
    }
    /// Of it, for one pilot photon [bytes].
    static constexpr std::size_t bytes_per_place(bool by_length = false) {
        return sizeof(Estimate) + kGridBytesPerPlace + (by_length ? sizeof(Shares) : 0);
    }
    /// Number of photons that went into an estimate, on average over those that this process made.
    double mean_photons() const { return mean_.photons; }
    /// How many equal ones would be as good, on average over estimates: squared sum of power over sum of squares
    /// (Kish).
    double effective_photons() const { return mean_.effective; }

  private:
    static constexpr std::size_t kGridBytesPerPlace = 6;  ///< for lookups without a search, at least
    using Shares = std::array<std::uint8_t, kLongerWays>; ///< as LongerWays, times 255

    class Estimate {
      public:
        enum Mark : unsigned { caustics = 1, in_crevice = 2 };
        Estimate() = default;
        /// `obstructed`, bit i: something may stand on the region of radius / 2^i.
        /// `marks`: of Mark.
        Estimate(const Rgb& e, unsigned marks, float radius, double area_share, std::uint8_t obstructed)
            : irradiance_(e, marks), obstructed_(obstructed),
              area_share_(static_cast<std::uint8_t>(std::lround(255 * std::clamp(area_share, 0.0, 1.0)))),
              radius_(static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(radius) >> 16)) {}

        Rgb irradiance() const { return irradiance_.decode(); }
        bool has_caustics() const { return (irradiance_.marks() & caustics) != 0; }
        bool is_in_crevice() const { return (irradiance_.marks() & in_crevice) != 0; }
        unsigned obstructed() const { return obstructed_; }
        double area_share() const { return area_share_ / 255.0; }
        /// At most the one given, and at least 127/128 of it [m].
        float radius() const { return std::bit_cast<float>(std::uint32_t{radius_} << 16); }

      private:
        SharedExponentRgb irradiance_;
        std::uint8_t obstructed_ = 0, area_share_ = 0;
        std::uint16_t radius_ = 0; ///< the upper half of a float
    };
    /// The estimate at `place`, or another one where something hides that from the region's middle.
    Answer answer(std::uint32_t place, const SurfaceRegion& region) const;
    SurfaceLookupGrid::Found place_for_cell(const Vec3& middle, const Vec3& normal) const;
    /// Whether something may stand between a place and the middle of a region.
    bool may_be_hidden(std::uint32_t place, const SurfaceRegion& region) const;
    struct Count {
        double photons = 0, effective = 0;
        Count& operator+=(const Count& o) {
            photons += o.photons;
            effective += o.effective;
            return *this;
        }
    };
    /// Fills in place i; returns the number of photons that it is made from.
    Count estimate(std::uint32_t i, const PhotonMap& main_photons, const IrradianceOptions& options);

    const PhotonMap& pilots_;
    std::vector<Estimate> estimates_;
    std::vector<Shares> shares_; // by place; empty where nobody asks
    float max_radius_;
    const Scene* scene_;
    const SurfacePatches* patches_;
    int most_hidden_;
    std::optional<SurfaceLookupGrid> grid_;
    Count mean_;
};

} // namespace keyhole
