// Materials: what a surface is made of, asked for a BSDF at a point.
#pragma once

#include "scene/bsdf.h"

#include <memory>

namespace keyhole {

/// Immutable and thread-safe. Lives as long as its scene.
class Material {
  public:
    virtual ~Material() = default;
    virtual Bsdf bsdf(const SurfacePoint& point) const = 0;
    /// What any BSDF of this material may have; the renderer leaves out what no material needs.
    virtual BsdfTraits traits() const = 0;
    /// Word that names the kind, as in scene files.
    virtual const char* kind() const = 0;
};

std::shared_ptr<const Material> make_diffuse(const Rgb& reflectance);
std::shared_ptr<const Material> make_mirror(const Rgb& reflectance);
/// Smooth dielectric; `eta` is the inner refractive index over the outer one.
std::shared_ptr<const Material> make_glass(double eta, const Rgb& reflect_tint = Rgb(1.0),
                                           const Rgb& transmit_tint = Rgb(1.0));

} // namespace keyhole
