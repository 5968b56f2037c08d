#include "scene/material.h"

namespace keyhole {
namespace {

/// A material whose BSDF is the same everywhere.
template <class Model> class UniformMaterial final : public Material {
  public:
    UniformMaterial(const char* kind, const Model& model) : kind_(kind), model_(model) {}
    Bsdf bsdf(const SurfacePoint& point) const override { return {point, model_}; }
    BsdfTraits traits() const override { return model_.traits(); }
    const char* kind() const override { return kind_; }

  private:
    const char* kind_;
    Model model_;
};

} // namespace

std::shared_ptr<const Material> make_diffuse(const Rgb& reflectance) {
    return std::make_shared<UniformMaterial<DiffuseBsdf>>("diffuse", DiffuseBsdf{reflectance});
}

std::shared_ptr<const Material> make_mirror(const Rgb& reflectance) {
    return std::make_shared<UniformMaterial<MirrorBsdf>>("mirror", MirrorBsdf{reflectance});
}

std::shared_ptr<const Material> make_glass(double eta, const Rgb& reflect_tint, const Rgb& transmit_tint) {
    return std::make_shared<UniformMaterial<GlassBsdf>>("glass", GlassBsdf{eta, reflect_tint, transmit_tint});
}

} // namespace keyhole
