// One model for most of what things are made of.
#pragma once

#include "scene/bsdfs/glossy_albedo.h"
#include "scene/bsdfs/microfacet.h"
#include "scene/scattering.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace keyhole {

/// What a PrincipledBsdf is made from. All but `alpha`s are in [0,1].
struct PrincipledParameters {
    Rgb base_color{0.8};
    double metallic = 0;
    double alpha_x = 0.25, alpha_y = 0.25; ///< of the base's gloss; both 0: smooth
    double specular = 0.04;                ///< reflectance along the normal where it is no metal
    double specular_tint = 0;              ///< of that towards the base colour
    double coat = 0;                       ///< weight of a dielectric layer of index 1.5 on it
    double coat_alpha = 0;
    double sheen = 0;
    double sheen_tint = 0;
};

/// A metal mixed with a diffuse base under a dielectric, below a coat, below a sheen, after Burley 2012 ("Physically
/// Based Shading at Disney"), reflecting no more than it gets and the same both ways:
///
/// - Gloss is GGX. The dielectric's share of it, and the coat, have the Fresnel term of their index, which is of
///   `specular` (1 + sqrt(specular)) / (1 - sqrt(specular)): as Cycles, and where Burley has Schlick's approximation.
///   Metal's share has the latter (Schlick 1994), which follows metals within a few percent, as Burley and glTF have
///   it. A tint colours what is reflected along the normal, not along the surface.
/// - The diffuse base gets what its dielectric does not reflect: base (1 - A(i)) (1 - A(o)) / (pi (1 - mean A)), A
///   being the albedo of all that lies above (Kelemen and Szirmay-Kalos 2001). `base_color` is thus what is seen,
///   darkening by reflections inside the dielectric (Saunderson 1942) included.
/// - Light that a rough metal reflects several times comes back in the same form (Kulla and Conty 2017).
/// - What lies below coat and sheen as gloss does is scaled by 1 - max(A(i), A(o)) of theirs, which is exact where the
///   gloss is narrow.
///
/// Smooth layers are one delta lobe. The same from both sides.
class PrincipledBsdf {
  public:
    explicit PrincipledBsdf(const PrincipledParameters& parameters);

    BsdfTraits traits() const;
    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
    Rgb albedo(const Vec3& to_eye) const;

    /// The diffuse base follows from irradiance alone, but for the weight of each direction: what is left to it there
    /// over the mean of that. Metal's later reflections and the sheen count as glossy.
    Rgb diffuse_reflectance(const Vec3& to_eye) const;
    double diffuse_weight(const Vec3& to_light) const;
    /// All but the base and delta lobes.
    PrincipledBsdf glossy_part() const;
    PrincipledBsdf widened(double alpha) const;
    double glossy_albedo(const Vec3& from) const;
    double glossy_probability(const Vec3& from) const;

    /// Whether it looks the same however it is turned around its normal.
    bool is_isotropic() const { return alpha_x_ == alpha_y_; }

  private:
    /// A number in [0,1] in little space: every vertex of every path holds some of these.
    class Share {
      public:
        Share() = default;
        // NOLINTNEXTLINE(bugprone-incorrect-roundings): not negative; a call for each would be slow
        Share(double x) : bits_(static_cast<std::uint16_t>(x * 65535 + 0.5)) {}
        operator double() const { return bits_ * (1 / 65535.0); }

      private:
        std::uint16_t bits_ = 0;
    };
    using Shares = std::array<Share, 3>;
    static Shares shares(const Rgb& c) { return {c.x, c.y, c.z}; }
    static Rgb rgb(const Shares& s) { return {s[0], s[1], s[2]}; }

    /// Seen along one direction.
    struct Layers {
        double sheen, coat; ///< albedos by themselves, grey
        GgxAlbedo gloss;    ///< by itself
        double base, metal; ///< what all layers above leave to the diffuse base, and to what metal scatters on
    };
    /// Probabilities of the lobes; `cosine` is the one that diffuse parts are sampled by.
    struct Choice {
        double coat = 0, gloss = 0, cosine = 0;
    };

    bool smooth() const { return alpha_x_ == 0; }
    bool smooth_coat() const { return coat_alpha_ == 0; }
    bool has_gloss() const { return metallic_ > 0 || dielectric_root_ > 0; }
    Ggx ggx() const { return {alpha_x_, alpha_y_}; }
    Ggx coat_ggx() const { return {coat_alpha_, coat_alpha_}; }
    double mean_alpha() const { return keyhole::mean_alpha(alpha_x_, alpha_y_); }
    double sheen_weight() const;
    /// What the dielectric reflects of the light to the diffuse base, itself untinted.
    double taken_from_base(const GgxAlbedo& gloss) const {
        return gloss.with_dielectric(dielectric_root_ * dielectric_root_);
    }
    /// Albedo of the gloss by itself; the Fresnel term where it is that of a smooth surface.
    Rgb gloss_albedo(const GgxAlbedo& gloss) const;
    Layers layers(double cosine) const;
    void find_means();
    Choice choice(double cosine, const Layers& at) const;

    Rgb sheen_part(double cosine_to_half) const;
    Rgb glossy_value(const LocalVec& i, const LocalVec& o, const Layers& at_i, const Layers& at_o) const;
    Rgb diffuse_part(const Layers& at_i, const Layers& at_o) const;
    /// Integral of diffuse_part() times the light's cosine over all lights above.
    Rgb diffuse_albedo(const Layers& at_o) const;

    StoredRgb base_;                       // albedo of what is left to it, by its share
    float base_mean_ = 1, metal_mean_ = 1; // of Layers::base and ::metal, by projected solid angle
    float alpha_x_, alpha_y_, coat_alpha_;
    Shares metal_;                     // as base_, of what metal scatters on
    Shares dielectric_f0_, metal_f0_;  // gloss along the normal, by their shares
    Shares sheen_;                     // its colour
    Share metallic_, dielectric_root_; // the latter of the reflectance, without a tint
    Share coat_;
    bool delta_ = true; // whether smooth layers are followed
};

} // namespace keyhole
