#include "scene/material.h"
#include "scene/materials/turned.h"

#include <utility>

namespace keyhole {
namespace {

class NormalMappedMaterial final : public Material {
  public:
    NormalMappedMaterial(MaterialPtr material, ColorTexture normals)
        : material_(std::move(material)), normals_(std::move(normals)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return material_->bsdf(mapped(point)); }
    BsdfTraits traits() const override { return material_->traits(); }
    FloatTexture finite_share() const override { return material_->finite_share(); }
    const char* kind() const override { return material_->kind(); }
    SurfaceDefaults surface() const override { return material_->surface(); }

  private:
    SurfacePoint mapped(const SurfacePoint& point) const {
        if (point.tangent == Vec3(0, 0, 0)) return point; // no parametrisation
        const Rgb c = normals_->value(point);
        Vec3 n(Imath::V3d(2 * c.x - 1, 2 * c.y - 1, 2 * c.z - 1));
        if (!(n.z > 0)) return point;
        if (point.dpdv.y < 0) n.y = -n.y; // mirrored texture coordinates
        return turned(point, point.shading_frame().to_world(n.normalized()).normalized());
    }

    MaterialPtr material_;
    ColorTexture normals_;
};

} // namespace

MaterialPtr with_normals(MaterialPtr material, ColorTexture normals) {
    return std::make_shared<NormalMappedMaterial>(std::move(material), std::move(normals));
}

} // namespace keyhole
