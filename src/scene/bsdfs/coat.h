// What coated surfaces have in common: how much light a dielectric interface lets through.
#pragma once

#include "scene/bsdfs/microfacet.h"

#include <array>
#include <memory>

namespace keyhole {

/// A dielectric interface whose roughness varies, seen from outside. Roughness is that of an isotropic interface here;
/// anisotropic ones take the geometric mean. Immutable; shared by all coats of one index.
class CoatInterface {
  public:
    /// The interface of index `eta` (inside over outside), from a cache. @throws InputError unless eta > 0.
    static std::shared_ptr<const CoatInterface> of(double eta);

    explicit CoatInterface(double eta);

    double eta() const { return eta_; }
    /// Fraction of light along a direction with this |cos| that reflects, met by one facet. Fresnel's for alpha 0.
    double reflectance(double cos_i, double alpha) const;
    /// The same for light that goes through. What is missing from 1 would need several facets, and is lost.
    double transmittance(double cos_i, double alpha) const;
    /// |cos| inside of light that comes along |cos| outside; 0 under total reflection.
    double refracted(double cos_i) const;
    /// exp(-thickness / refracted |cos|): what an absorbing coat leaves on one way.
    double attenuation(double cos_i, double thickness) const;
    /// What gets through of light that is the same from everywhere above, an absorbing coat on the way once: the mean
    /// of transmittance() times attenuation() over the hemisphere, by cosine. From a table, within 1e-3.
    double mean_through(double alpha, double thickness) const;
    /// Fraction of diffuse light from below that comes back down, on the way through the coat twice.
    double internal_reflectance(double alpha, double thickness) const;

  private:
    static constexpr std::size_t kAlphas = 17, kCosines = 33, kNodes = 32, kClear = 33;
    using Table = std::array<std::array<float, kCosines>, kAlphas>; // by alpha, then by the root of the cosine
    void fill_mean_through();
    static double look_up(const Table& table, double cos_i, double alpha);

    double eta_;
    Table reflectance_, transmittance_;
    std::array<float, kAlphas> internal_;                         // internal reflectance for diffuse light
    std::array<std::array<float, kClear>, kAlphas> mean_through_; // by alpha, then by exp(-thickness)
    std::array<float, kNodes> internal_share_; // of the smooth interface's internal reflection, by cosine
};

} // namespace keyhole
