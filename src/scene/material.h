// Materials: what a surface is made of, asked for a BSDF at a point.
#pragma once

#include "scene/bsdf.h"
#include "scene/texture.h"

#include <memory>

namespace keyhole {

/// Of shapes that say nothing of their own.
struct SurfaceDefaults {
    FloatTexture alpha{}; ///< opacity; null: opaque
    Rgb emission{0.0};    ///< radiance from both sides [W/(m^2 sr)]
};

/// Immutable and thread-safe. Lives as long as its scene.
class Material {
  public:
    virtual ~Material() = default;
    /// Whether bsdf() asks where in its parametrisation a point lies, or which way that runs. Finding out takes longer
    /// than finding the point: see hit_point().
    bool reads_parametrisation() const { return reads_parametrisation_; }
    /// Evaluates all textures; the result stands for itself, but not beyond the material.
    virtual Bsdf bsdf(const SurfacePoint& point) const = 0;
    /// What any BSDF of this material may have; the renderer leaves out what no material needs.
    virtual BsdfTraits traits() const = 0;
    /// Share of the places around a point whose BSDF has a finite part; null where places don't differ in that.
    virtual FloatTexture finite_share() const { return nullptr; }
    /// Word that names the kind, as in scene files.
    virtual const char* kind() const = 0;
    /// What scene files may say in a material although it belongs to the shapes that have it.
    virtual SurfaceDefaults surface() const { return {}; }

  protected:
    explicit Material(bool reads_parametrisation = true) : reads_parametrisation_(reads_parametrisation) {}

  private:
    bool reads_parametrisation_;
};

using MaterialPtr = std::shared_ptr<const Material>;

// In all factories: reflectances and transmittances are clamped to [0,1] and amounts, too; `alpha` is the GGX roughness
// along the tangent (x) and across it (y), not remapped, and smooth up to kSmoothAlpha; `eta` of an interface is the
// refractive index inside, below the surface's outside, over that outside; complex indices (eta, k) of metals are
// relative to the medium outside, for the three primaries. Textures must not be null.
// @throws InputError for an index that is not positive.

MaterialPtr make_black();
MaterialPtr make_diffuse(const Rgb& reflectance);
MaterialPtr make_diffuse(ColorTexture reflectance);
/// Lambertian reflection and transmission. Where the two add up to more than 1 both are scaled down.
MaterialPtr make_diffuse_transmission(ColorTexture reflectance, ColorTexture transmittance);

MaterialPtr make_mirror(const Rgb& reflectance);
MaterialPtr make_conductor(const Rgb& eta, const Rgb& k, FloatTexture alpha_x, FloatTexture alpha_y);
/// The metal of index 1 + i k whose reflectance at normal incidence is the given one.
MaterialPtr make_conductor(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y);

/// Smooth dielectric.
MaterialPtr make_glass(double eta, const Rgb& reflect_tint = Rgb(1.0), const Rgb& transmit_tint = Rgb(1.0));
MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y);
/// With factors on what is reflected and on what goes through.
MaterialPtr make_dielectric(double eta, FloatTexture alpha_x, FloatTexture alpha_y, ColorTexture reflect_tint,
                            ColorTexture transmit_tint);
/// A pane without thickness, with the reflections between its two faces.
MaterialPtr make_thin_dielectric(double eta);
/// With a factor on what goes through.
MaterialPtr make_thin_dielectric(double eta, ColorTexture transmit_tint);
/// No surface at all: light goes straight on.
MaterialPtr make_interface();

/// A dielectric coat over a Lambertian base. `thickness` is the optical depth of the coat along its normal.
MaterialPtr make_coated_diffuse(ColorTexture reflectance, FloatTexture alpha_x, FloatTexture alpha_y, double eta,
                                FloatTexture thickness);

/// The coat of a coated conductor.
struct Coat {
    double eta;
    FloatTexture alpha_x, alpha_y;
    FloatTexture thickness; ///< optical depth along the normal
};
/// A dielectric coat over a metal.
MaterialPtr make_coated_conductor(const Coat& coat, const Rgb& eta, const Rgb& k, FloatTexture alpha_x,
                                  FloatTexture alpha_y);
MaterialPtr make_coated_conductor(const Coat& coat, ColorTexture reflectance, FloatTexture alpha_x,
                                  FloatTexture alpha_y);

/// What PrincipledBsdf is made from, with glass in the place of what is no metal by a share.
struct PrincipledTextures {
    ColorTexture base_color;
    FloatTexture metallic;
    FloatTexture alpha_x, alpha_y;
    FloatTexture specular; ///< reflectance along the normal where it is no metal
    FloatTexture specular_tint;
    FloatTexture transmission; ///< share of glass of index `eta`, tinted by the root of the base colour each way
    FloatTexture clearcoat;    ///< in quarters of a full coat
    FloatTexture clearcoat_alpha;
    FloatTexture sheen, sheen_tint;
    double eta = 1.5;
};
MaterialPtr make_principled(const PrincipledTextures& textures);
/// Those of a white dielectric of index `eta` and a perceptual roughness, the root of alpha.
PrincipledTextures principled_textures(double eta, const FloatTexture& roughness);
/// The GGX alpha of a perceptual roughness.
FloatTexture principled_alpha(const FloatTexture& roughness);

/// At each place either `a` or `b`, chosen by a hash of the place; `amount` is the share of b.
MaterialPtr make_mix(MaterialPtr a, MaterialPtr b, FloatTexture amount);

/// `material` for shapes that have these defaults.
MaterialPtr with_surface(MaterialPtr material, SurfaceDefaults surface);

/// `material` on a surface that is displaced along its shading normal, for shading only (Blinn 1978). `displacement` is
/// in metres.
MaterialPtr with_bump(MaterialPtr material, FloatTexture displacement);

/// `material` with shading normals from a texture: (x + 1, y + 1, z + 1) / 2 along increasing u, across it towards
/// increasing v, and along the surface's own normal.
MaterialPtr with_normals(MaterialPtr material, ColorTexture normals);

} // namespace keyhole
