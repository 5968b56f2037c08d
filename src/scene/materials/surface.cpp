// Materials that say something of the shapes that have them.
#include "scene/material.h"

#include <utility>

namespace keyhole {
namespace {

class SurfaceMaterial final : public Material {
  public:
    SurfaceMaterial(MaterialPtr material, SurfaceDefaults surface)
        : Material(material->reads_parametrisation()), material_(std::move(material)), surface_(std::move(surface)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return material_->bsdf(point); }
    BsdfTraits traits() const override { return material_->traits(); }
    FloatTexture finite_share() const override { return material_->finite_share(); }
    const char* kind() const override { return material_->kind(); }
    SurfaceDefaults surface() const override { return surface_; }

  private:
    MaterialPtr material_;
    SurfaceDefaults surface_;
};

} // namespace

MaterialPtr with_surface(MaterialPtr material, SurfaceDefaults surface) {
    return std::make_shared<SurfaceMaterial>(std::move(material), std::move(surface));
}

} // namespace keyhole
