// Materials as functions from surface points to models.
#pragma once

#include "scene/material.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace keyhole {

/// A material whose model is `model(point)`.
template <class F> class FunctionMaterial final : public Material {
  public:
    FunctionMaterial(const char* kind, const BsdfTraits& traits, F model, bool reads_parametrisation)
        : Material(reads_parametrisation), kind_(kind), traits_(traits), model_(std::move(model)) {}
    Bsdf bsdf(const SurfacePoint& point) const override { return {point, model_(point)}; }
    BsdfTraits traits() const override { return traits_; }
    const char* kind() const override { return kind_; }

  private:
    const char* kind_;
    BsdfTraits traits_;
    F model_;
};

/// Whether a model looks the same whichever way its frame is turned. Rough ones may not.
inline bool is_isotropic(const Bsdf::Model& model) {
    return std::visit(
        []<class M>(const M& m) {
            if constexpr (std::is_same_v<M, PrincipledBsdf>) return m.is_isotropic();
            return std::is_same_v<M, BlackBsdf> || std::is_same_v<M, DiffuseBsdf> ||
                   std::is_same_v<M, DiffuseTransmissionBsdf> || std::is_same_v<M, MirrorBsdf> ||
                   std::is_same_v<M, ConductorBsdf> || std::is_same_v<M, GlassBsdf> ||
                   std::is_same_v<M, ThinDielectricBsdf> || std::is_same_v<M, InterfaceBsdf>;
        },
        model);
}

/// A material whose model is `model(point)`. Where all `textures` are constant, the model is found once; else it may be
/// anything that `traits` say.
template <class F, class... Textures>
MaterialPtr make_material(const char* kind, const BsdfTraits& traits, F model, const Textures&... textures) {
    if (!(textures->is_constant() && ...))
        return std::make_shared<FunctionMaterial<F>>(kind, traits, std::move(model), true);
    const Bsdf::Model same = model(SurfacePoint());
    // The model may point into what the closure that made it holds.
    const auto uniform = [same, maker = std::move(model)](const SurfacePoint& /*point*/) -> const Bsdf::Model& {
        return same;
    };
    return std::make_shared<FunctionMaterial<decltype(uniform)>>(kind, Bsdf(SurfacePoint(), same).traits(), uniform,
                                                                 !is_isotropic(same));
}

inline double clamp01(double x) { return x > 0 ? std::min(x, 1.0) : 0.0; } // what is not a number: 0
inline Rgb clamp01(const Rgb& c) { return {clamp01(c.x), clamp01(c.y), clamp01(c.z)}; }

/// Roughness of a surface; none where it is smooth.
struct Alpha {
    float x, y;
};
inline std::optional<Alpha> rough_at(const FloatTexture& alpha_x, const FloatTexture& alpha_y,
                                     const SurfacePoint& point) {
    const double x = alpha_x->value(point), y = alpha_y->value(point);
    if (!(std::max(x, y) > kSmoothAlpha)) return std::nullopt;
    // A lobe without width in one direction only would have no finite density.
    return Alpha{static_cast<float>(std::clamp(x, kSmoothAlpha / 10, 1.0)),
                 static_cast<float>(std::clamp(y, kSmoothAlpha / 10, 1.0))};
}

/// The metal of index 1 + i k with this reflectance at normal incidence.
inline ComplexIndex index_of_reflectance(const Rgb& reflectance) {
    Rgb k;
    for (int c = 0; c < 3; ++c) {
        const double r = std::clamp(reflectance[c], 0.0, 0.9999);
        k[c] = 2 * std::sqrt(r / (1 - r));
    }
    return {Rgb(1.0), k};
}

} // namespace keyhole
