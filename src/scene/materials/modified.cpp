// Materials that are another one but for the surface, or for the shading normal.
#include "scene/material.h"

#include <utility>

namespace keyhole {
namespace {

class ModifiedMaterial : public Material {
  public:
    ModifiedMaterial(MaterialPtr material, bool reads_parametrisation)
        : Material(reads_parametrisation), material_(std::move(material)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return material_->bsdf(point); }
    BsdfTraits traits() const override { return material_->traits(); }
    FloatTexture finite_share() const override { return material_->finite_share(); }
    const char* kind() const override { return material_->kind(); }
    SurfaceDefaults surface() const override { return material_->surface(); }

  private:
    MaterialPtr material_;
};

class SurfaceMaterial final : public ModifiedMaterial {
  public:
    SurfaceMaterial(const MaterialPtr& material, SurfaceDefaults surface)
        : ModifiedMaterial(material, material->reads_parametrisation()), surface_(std::move(surface)) {}

    SurfaceDefaults surface() const override { return surface_; }

  private:
    SurfaceDefaults surface_;
};

/// `point` with the shading normal `ns`, unit; as it is where that lies below the surface.
SurfacePoint turned(const SurfacePoint& point, const Vec3& ns) {
    if (!(ns.dot(point.ng) > 0)) return point;
    const Frame frame = point.shading_frame();
    SurfacePoint out = point;
    out.ns = ns;
    out.tangent = (frame.s - ns * ns.dot(frame.s)).normalized();
    return out;
}

class NormalMappedMaterial final : public ModifiedMaterial {
  public:
    NormalMappedMaterial(MaterialPtr material, ColorTexture normals)
        : ModifiedMaterial(std::move(material), true), normals_(std::move(normals)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return ModifiedMaterial::bsdf(mapped(point)); }

  private:
    SurfacePoint mapped(const SurfacePoint& point) const {
        if (point.tangent == Vec3(0, 0, 0)) return point; // no parametrisation
        const Rgb c = normals_->value(point);
        Vec3 n(Imath::V3d(2 * c.x - 1, 2 * c.y - 1, 2 * c.z - 1));
        if (!(n.z > 0)) return point;
        if (point.dpdv.y < 0) n.y = -n.y; // mirrored texture coordinates
        return turned(point, point.shading_frame().to_world(n.normalized()).normalized());
    }

    ColorTexture normals_;
};

/// Width of the differences, in texture coordinates: about a texel of a fine image.
constexpr float kStep = 5e-4f;

class BumpedMaterial final : public ModifiedMaterial {
  public:
    BumpedMaterial(MaterialPtr material, FloatTexture displacement)
        : ModifiedMaterial(std::move(material), true), displacement_(std::move(displacement)) {}

    Bsdf bsdf(const SurfacePoint& point) const override { return ModifiedMaterial::bsdf(bumped(point)); }

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

    FloatTexture displacement_;
};

} // namespace

MaterialPtr with_surface(MaterialPtr material, SurfaceDefaults surface) {
    return std::make_shared<SurfaceMaterial>(std::move(material), std::move(surface));
}

MaterialPtr with_normals(MaterialPtr material, ColorTexture normals) {
    return std::make_shared<NormalMappedMaterial>(std::move(material), std::move(normals));
}

MaterialPtr with_bump(MaterialPtr material, FloatTexture displacement) {
    if (displacement->is_constant()) return material;
    return std::make_shared<BumpedMaterial>(std::move(material), std::move(displacement));
}

} // namespace keyhole
