// A BSDF at a point: one of a closed set of models, with its shading frame. A value, so that paths can be copied.
#pragma once

#include "core/rng.h"
#include "scene/bsdfs/coated_conductor.h"
#include "scene/bsdfs/coated_diffuse.h"
#include "scene/bsdfs/conductor.h"
#include "scene/bsdfs/dielectric.h"
#include "scene/bsdfs/diffuse.h"
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
/// To add a model: a file in bsdfs/ with these five members, and its name here.
class Bsdf {
  public:
    using Model = std::variant<BlackBsdf, DiffuseBsdf, DiffuseTransmissionBsdf, MirrorBsdf, ConductorBsdf,
                               RoughConductorBsdf, GlassBsdf, RoughDielectricBsdf, ThinDielectricBsdf, InterfaceBsdf,
                               CoatedDiffuseBsdf, CoatedConductorBsdf, PrincipledBsdf>;

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

  private:
    Frame frame_;
    Model model_;
};

// Every vertex of a path holds one, and paths are copied in the innermost loop.
static_assert(std::is_trivially_copyable_v<Bsdf::Model> && sizeof(Bsdf) <= 112);

} // namespace keyhole
