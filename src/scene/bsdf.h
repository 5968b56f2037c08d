// A BSDF at a point: one of a closed set of models, with its shading frame. A value, so that paths can be copied.
#pragma once

#include "core/rng.h"
#include "scene/bsdfs/coated.h"
#include "scene/bsdfs/conductor.h"
#include "scene/bsdfs/dielectric.h"
#include "scene/bsdfs/diffuse.h"
#include "scene/bsdfs/phase.h"
#include "scene/bsdfs/principled.h"
#include "scene/scattering.h"
#include "scene/surface_point.h"

#include <variant>

namespace keyhole {

/// Scattering that absorbs everything: vertices without a surface have this.
struct BlackBsdf {
    static constexpr BsdfTraits traits() { return {}; }
    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    static std::optional<BsdfSample> sample(const Vec3& /*from*/, double, double, double) { return std::nullopt; }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
};

/// A model in its shading frame. All directions are unit, in world space, and point away from the surface.
/// To add a model: a file in bsdfs/ with these five members, and its name here. One with a
/// finite part has albedo(). One with a diffuse part has
/// diffuse_reflectance() and diffuse_weight() besides; if it has a glossy part as well, also glossy_part(),
/// glossy_albedo() and glossy_probability(). One whose rough lobes may be wider has widened().
class Bsdf {
  public:
    using Model = std::variant<BlackBsdf, DiffuseBsdf, DiffuseTransmissionBsdf, MirrorBsdf, ConductorBsdf,
                               RoughConductorBsdf, GlassBsdf, RoughDielectricBsdf, ThinDielectricBsdf, InterfaceBsdf,
                               CoatedDiffuseBsdf, CoatedConductorBsdf, PrincipledBsdf, PhaseBsdf>;

  private:
    /// std::visit(), with the commonest model inlined: the others are behind a table of functions.
    template <class F> auto visit(F&& f) const {
        if (const auto* diffuse = std::get_if<DiffuseBsdf>(&model_)) return f(*diffuse);
        return std::visit(f, model_);
    }

  public:
    Bsdf() = default;
    Bsdf(const Frame& frame, const Model& model) : frame_(frame), model_(model) {}
    /// x of the model is along the point's tangent.
    Bsdf(const SurfacePoint& point, const Model& model) : frame_(point.shading_frame()), model_(model) {}

    const Model& model() const { return model_; }
    const Vec3& shading_normal() const { return frame_.n; }

    BsdfTraits traits() const {
        return visit([](const auto& m) -> BsdfTraits { return m.traits(); });
    }

    /// Finite part f(to_light -> to_eye) [1/sr], for radiance; without a cosine.
    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const {
        return visit([&](const auto& m) { return m.eval(frame_.to_local(to_light), frame_.to_local(to_eye)); });
    }

    /// Density per solid angle with which sample() draws `to` by its finite part, having come along `from`.
    double pdf(const Vec3& from, const Vec3& to) const {
        return visit([&](const auto& m) -> double { return m.pdf(frame_.to_local(from), frame_.to_local(to)); });
    }

    /// eval(), and pdf() either way.
    struct Finite {
        Rgb value;
        double pdf_to_light, pdf_to_eye;
    };
    Finite finite(const Vec3& to_light, const Vec3& to_eye) const {
        return visit([light = frame_.to_local(to_light), eye = frame_.to_local(to_eye)](const auto& m) -> Finite {
            return {m.eval(light, eye), m.pdf(eye, light), m.pdf(light, eye)};
        });
    }

    /// Draws a direction for a path that came along `from`, from either end. None: absorbed.
    std::optional<BsdfSample> sample(const Vec3& from, SampleSource& source) const {
        const auto [u0, u1, u2] = source.take<3>();
        auto s = visit(
            [&, u0 = u0, u1 = u1, u2 = u2](const auto& m) { return m.sample(frame_.to_local(from), u0, u1, u2); });
        if (s) s->to = frame_.to_world(s->to);
        return s;
    }

    /// The delta lobe of kind `event` seen from `from`; none where the model has none or it carries nothing.
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        auto d = visit([&](const auto& m) { return m.delta(frame_.to_local(from), event); });
        if (d) d->to = frame_.to_world(d->to);
        return d;
    }

    /// Directional albedo of the finite part, within some percent: of light that is the same from everywhere, what it
    /// sends to the eye, reflected or through the surface. Smooth in `to_eye`. A medium's is its scattering
    /// coefficient.
    Rgb albedo(const Vec3& to_eye) const {
        return visit([&]<class M>(const M& m) {
            if constexpr (requires { m.albedo(to_eye); })
                return m.albedo(frame_.to_local(to_eye));
            else
                return Rgb(0.0);
        });
    }

    // The finite part is f = r(to_eye) w(to_light) + a glossy part. Where light is the same from everywhere, the
    // diffuse part reflects r times the irradiance E; elsewhere r times the integral of w L cos, which lies between the
    // least w and the largest times E (docs/gather.md).

    /// r: what the diffuse part reflects towards `to_eye` of each unit of irradiance [1/sr]; 0 where there is none.
    Rgb diffuse_reflectance(const Vec3& to_eye) const {
        return visit([&]<class M>(const M& m) {
            if constexpr (kIsPartlyDiffuse<M>)
                return m.diffuse_reflectance(frame_.to_local(to_eye));
            else
                return Rgb(0.0);
        });
    }

    /// w: the weight of light from `to_light` in that. Its mean over the hemisphere, by cosine, is 1.
    double diffuse_weight(const Vec3& to_light) const {
        return visit([&]<class M>(const M& m) -> double {
            if constexpr (kIsPartlyDiffuse<M>)
                return m.diffuse_weight(frame_.to_local(to_light));
            else
                return 1;
        });
    }

    /// What is left without the diffuse part: a BSDF with eval(), pdf(), sample() and delta() of its own.
    Bsdf glossy_part() const {
        return {frame_, visit([]<class M>(const M& m) -> Model {
                    if constexpr (kIsPartlyGlossy<M>)
                        return m.glossy_part();
                    else if constexpr (kIsPartlyDiffuse<M>)
                        return BlackBsdf{};
                    else
                        return m;
                })};
    }

    /// The same with no lobe of rough metal, or of a rough coat without its base, narrower than `alpha`: it reflects as
    /// much, nearly, in a wider cone. All others are left as they are: what a diffuse base gets depends on the coat's
    /// roughness, and wider lobes of ground glass and coated metal would lose light.
    Bsdf widened(double alpha) const {
        return {frame_, visit([alpha]<class M>(const M& m) -> Model {
                    if constexpr (requires { m.widened(alpha); })
                        return m.widened(alpha);
                    else
                        return m;
                })};
    }

    /// Fraction of the light along `from` that the glossy part reflects, nearly; 1 for models that are nothing else.
    double glossy_albedo(const Vec3& from) const {
        return visit([&]<class M>(const M& m) -> double {
            if constexpr (kIsPartlyGlossy<M>)
                return m.glossy_albedo(frame_.to_local(from));
            else
                return kIsPartlyDiffuse<M> ? 0 : 1;
        });
    }

    /// Probability that sample(), having come along `from`, draws from the glossy part what it draws from the finite
    /// one: pdf() is that of the two parts, mixed so.
    double glossy_probability(const Vec3& from) const {
        return visit([&]<class M>(const M& m) -> double {
            if constexpr (kIsPartlyGlossy<M>)
                return m.glossy_probability(frame_.to_local(from));
            else
                return kIsPartlyDiffuse<M> ? 0 : 1;
        });
    }

  private:
    template <class M> static constexpr bool kIsPartlyDiffuse = requires(const M& m, const Vec3& w) {
        m.diffuse_reflectance(w);
    };
    template <class M> static constexpr bool kIsPartlyGlossy = requires(const M& m) { m.glossy_part(); };

    Frame frame_;
    Model model_;
};

// Every vertex of a path holds one, and paths are copied in the innermost loop.
static_assert(std::is_trivially_copyable_v<Bsdf::Model> && sizeof(Bsdf) <= 112);

} // namespace keyhole
