#include "scene/material.h"
#include "scene/materials/turned.h"

namespace keyhole {
namespace {

/// Width of the differences, in texture coordinates: about a texel of a fine image.
constexpr float kStep = 5e-4f;

class BumpedMaterial final : public Material {
  public:
    BumpedMaterial(MaterialPtr material, FloatTexture displacement)
        : material_(std::move(material)), displacement_(std::move(displacement)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return material_->bsdf(bumped(point)); }
    BsdfTraits traits() const override { return material_->traits(); }
    FloatTexture finite_share() const override { return material_->finite_share(); }
    const char* kind() const override { return material_->kind(); }
    SurfaceDefaults surface() const override { return material_->surface(); }

  private:
    /// Textures may ask for texture coordinates, or for the place.
    double slope(SurfacePoint point, const Vec2& direction, const Vec3& tangent) const {
        const Vec2 uv = point.uv;
        const Vec3 p = point.p;
        point.uv = uv + direction * (kStep / 2);
        point.p = p + tangent * (kStep / 2);
        const double ahead = displacement_->value(point);
        point.uv = uv - direction * (kStep / 2);
        point.p = p - tangent * (kStep / 2);
        return (ahead - displacement_->value(point)) / kStep;
    }

    /// The surface p(u,v) + d(u,v) ns has the tangents dp/du + dd/du ns and dp/dv + dd/dv ns, where the surface bends
    /// little within the displacement.
    SurfacePoint bumped(const SurfacePoint& point) const {
        const Frame frame = point.shading_frame();
        const double du = slope(point, {1, 0}, frame.s * point.dpdu),
                     dv = slope(point, {0, 1}, frame.to_world(Vec3(point.dpdv.x, point.dpdv.y, 0)));
        const Imath::V3d along_u(point.dpdu, 0, du), along_v(point.dpdv.x, point.dpdv.y, dv);
        Imath::V3d n = along_u.cross(along_v);
        if (n.z < 0) n = -n; // mirrored texture coordinates
        n.normalize();
        if (!(n.z > 0)) return point; // no parametrisation
        return turned(point, frame.to_world(Vec3(n)).normalized());
    }

    MaterialPtr material_;
    FloatTexture displacement_;
};

} // namespace

MaterialPtr with_bump(MaterialPtr material, FloatTexture displacement) {
    if (displacement->is_constant()) return material;
    return std::make_shared<BumpedMaterial>(std::move(material), std::move(displacement));
}

} // namespace keyhole
