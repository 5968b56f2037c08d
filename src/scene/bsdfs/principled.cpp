#include "scene/bsdfs/principled.h"

#include "scene/bsdfs/fresnel.h"
#include "scene/warp.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// Of the coat.
constexpr double kCoatIndex = 1.5;
/// Root of what it reflects along the normal.
constexpr double kCoatRoot = (kCoatIndex - 1) / (kCoatIndex + 1);

double mean_of(const Rgb& c) { return (c.x + c.y + c.z) / 3; }

/// The hue of a colour, as light as it can be; white of black.
Rgb hue_of(const Rgb& c) {
    const double most = std::max({c.x, c.y, c.z});
    return most > 0 ? c / most : Rgb(1.0);
}

Rgb mixed(const Rgb& a, const Rgb& b, double share) { return a * (1 - share) + b * share; }

/// Of the light that one reflection by a rough metal does not let go, the share that later ones do (Kulla and Conty
/// 2017, "Revisiting Physically Based Shading at Imageworks", with a Fresnel term for the first reflection, too).
double multiple_reflections(double f0, const GgxAlbedo& mean) {
    const double f = f0 + (1 - f0) / 21;
    return f * f * mean.whole / (1 - f * (1 - mean.whole));
}

} // namespace

PrincipledBsdf::PrincipledBsdf(const PrincipledParameters& p)
    : base_(p.base_color * (1 - p.metallic)), alpha_x_(static_cast<float>(p.alpha_x)),
      alpha_y_(static_cast<float>(p.alpha_y)), coat_alpha_(static_cast<float>(p.coat_alpha)), metallic_(p.metallic),
      dielectric_root_(p.metallic < 1 ? std::sqrt(p.specular) : 0), coat_(p.coat) {
    const Rgb hue = hue_of(p.base_color);
    dielectric_f0_ = shares(mixed(Rgb(1.0), hue, p.specular_tint) * (p.specular * (1 - p.metallic)));
    metal_f0_ = shares(p.base_color * p.metallic);
    sheen_ = shares(mixed(Rgb(1.0), hue, p.sheen_tint) * (p.sheen * (1 - p.metallic)));
    if (p.metallic > 0 && !smooth()) {
        const GgxAlbedo mean = mean_ggx_albedo(mean_alpha(), dielectric_root_);
        Rgb again;
        for (int k = 0; k < 3; ++k) again[k] = p.metallic * multiple_reflections(p.base_color[k], mean);
        metal_ = shares(again);
    }
    find_means();
}

double PrincipledBsdf::sheen_weight() const {
    return std::max({double(sheen_[0]), double(sheen_[1]), double(sheen_[2])});
}

Rgb PrincipledBsdf::gloss_albedo(const GgxAlbedo& gloss) const {
    return rgb(dielectric_f0_) * (gloss.whole - gloss.dielectric) + rgb(metal_f0_) * (gloss.whole - gloss.schlick) +
           Rgb((1 - metallic_) * gloss.dielectric + metallic_ * gloss.schlick);
}

PrincipledBsdf::Layers PrincipledBsdf::layers(double cosine) const {
    Layers at{};
    at.sheen = sheen_weight();
    if (at.sheen > 0) at.sheen *= sheen_albedo(cosine);
    if (coat_ > 0) at.coat = coat_ * ggx_albedo(cosine, coat_alpha_, kCoatRoot).with_dielectric(kCoatRoot * kCoatRoot);
    at.gloss = ggx_albedo(cosine, mean_alpha(), dielectric_root_);
    const double left = (1 - at.sheen) * (1 - at.coat);
    at.base = left * std::max(0.0, 1 - taken_from_base(at.gloss));
    at.metal = left * std::max(0.0, 1 - at.gloss.whole);
    return at;
}

/// By Gauss and Legendre's rule of eight cosines, where no table has them.
void PrincipledBsdf::find_means() {
    if (coat_ == 0 && sheen_weight() == 0) {
        const GgxAlbedo mean = mean_ggx_albedo(mean_alpha(), dielectric_root_);
        base_mean_ = static_cast<float>(1 - taken_from_base(mean));
        metal_mean_ = static_cast<float>(1 - mean.whole);
    } else {
        struct {
            double x, weight;
        } constexpr kNodes[] = {{0.1834346424956498, 0.3626837833783620},
                                {0.5255324099163290, 0.3137066458778873},
                                {0.7966664774136267, 0.2223810344533745},
                                {0.9602898564975363, 0.1012285362903763}};
        double base = 0, metal = 0;
        for (const auto& node : kNodes)
            for (const double cosine : {(1 - node.x) / 2, (1 + node.x) / 2}) {
                const Layers at = layers(cosine);
                base += node.weight * cosine * at.base;
                metal += node.weight * cosine * at.metal;
            }
        base_mean_ = static_cast<float>(base);
        metal_mean_ = static_cast<float>(metal);
    }
    // Where nothing is left to them.
    if (!(base_mean_ > 1e-6f)) base_ = Rgb(0.0), base_mean_ = 1;
    if (!(metal_mean_ > 1e-6f)) metal_ = {}, metal_mean_ = 1;
}

BsdfTraits PrincipledBsdf::traits() const {
    const bool diffuse = !is_black(base_), glossy = !is_black(rgb(metal_)) || sheen_weight() > 0 ||
                                                    (has_gloss() && !smooth()) || (coat_ > 0 && !smooth_coat());
    return {.finite = diffuse || glossy,
            .delta = delta_ && ((has_gloss() && smooth()) || (coat_ > 0 && smooth_coat())),
            .diffuse = diffuse,
            .glossy = glossy};
}

Rgb PrincipledBsdf::diffuse_reflectance(const Vec3& to_eye) const {
    return Rgb(base_) * (layers(upper(to_eye).z).base * kInvPi);
}

double PrincipledBsdf::diffuse_weight(const Vec3& to_light) const {
    return layers(upper(to_light).z).base / base_mean_;
}

PrincipledBsdf PrincipledBsdf::glossy_part() const {
    PrincipledBsdf part = *this;
    part.base_ = Rgb(0.0);
    part.delta_ = false;
    return part;
}

PrincipledBsdf PrincipledBsdf::widened(double alpha) const {
    PrincipledBsdf wide = *this;
    if (!is_black(base_)) return wide; // for what the layers above leave to it depends on their roughness
    wide.alpha_x_ = widened_alpha(alpha_x_, alpha);
    wide.alpha_y_ = widened_alpha(alpha_y_, alpha);
    wide.coat_alpha_ = widened_alpha(coat_alpha_, alpha);
    const bool same = wide.alpha_x_ == alpha_x_ && wide.alpha_y_ == alpha_y_ && wide.coat_alpha_ == coat_alpha_;
    if (!same && !is_black(rgb(metal_))) wide.find_means();
    return wide;
}

/// Of what is not a delta lobe.
double PrincipledBsdf::glossy_albedo(const Vec3& from) const {
    const double cosine = upper(from).z;
    const Layers at = layers(cosine);
    double sum = mean_of(rgb(metal_)) * at.metal;
    if (!smooth_coat()) sum += (1 - at.sheen) * at.coat;
    if (!smooth()) sum += (1 - at.sheen) * (1 - at.coat) * mean_of(gloss_albedo(at.gloss));
    if (at.sheen > 0) sum += mean_of(rgb(sheen_)) * sheen_albedo(cosine);
    return sum;
}

double PrincipledBsdf::glossy_probability(const Vec3& from) const {
    const double glossy = glossy_albedo(from), base = mean_of(Rgb(base_)) * layers(upper(from).z).base;
    return glossy + base > 0 ? glossy / (glossy + base) : 1;
}

Rgb PrincipledBsdf::albedo(const Vec3& to_eye) const {
    const double cosine = upper(to_eye).z;
    const Layers at = layers(cosine);
    Rgb sum = diffuse_albedo(at);
    if (!smooth_coat()) sum += Rgb((1 - at.sheen) * at.coat);
    if (!smooth()) sum += gloss_albedo(at.gloss) * ((1 - at.sheen) * (1 - at.coat));
    if (at.sheen > 0) sum += rgb(sheen_) * sheen_albedo(cosine);
    return {std::min(sum.x, 1.0), std::min(sum.y, 1.0), std::min(sum.z, 1.0)}; // numbers of 16 bits are rounded
}

Rgb PrincipledBsdf::sheen_part(double cosine_to_half) const { return rgb(sheen_) * schlick_weight(cosine_to_half); }

Rgb PrincipledBsdf::glossy_value(const LocalVec& i, const LocalVec& o, const Layers& at_i, const Layers& at_o) const {
    const LocalVec h = half_vector(i, o);
    const double c = std::min(1.0, o.dot(h)), below = 1 - std::max(at_i.sheen, at_o.sheen);
    Rgb f(0.0);
    if (!smooth())
        f = gloss_albedo(ggx_albedo(c, 0, dielectric_root_)) *
            (ggx().reflection(i, o, h) * (1 - std::max(at_i.coat, at_o.coat)));
    if (coat_ > 0 && !smooth_coat())
        f += Rgb(coat_ * fresnel_dielectric(c, kCoatIndex).reflectance * coat_ggx().reflection(i, o, h));
    return f * below + sheen_part(c);
}

Rgb PrincipledBsdf::diffuse_part(const Layers& at_i, const Layers& at_o) const {
    return Rgb(base_) * (at_i.base * at_o.base * kInvPi / base_mean_) +
           rgb(metal_) * (at_i.metal * at_o.metal * kInvPi / metal_mean_);
}

Rgb PrincipledBsdf::diffuse_albedo(const Layers& at_o) const {
    return Rgb(base_) * at_o.base + rgb(metal_) * at_o.metal;
}

/// In proportion to the light that each lobe reflects, nearly.
PrincipledBsdf::Choice PrincipledBsdf::choice(double cosine, const Layers& at) const {
    Choice p;
    p.coat = (1 - at.sheen) * at.coat;
    p.gloss = (1 - at.sheen) * (1 - at.coat) * mean_of(gloss_albedo(at.gloss));
    p.cosine = mean_of(diffuse_albedo(at));
    if (at.sheen > 0) p.cosine += mean_of(rgb(sheen_)) * sheen_albedo(cosine);
    if (!delta_ && smooth_coat()) p.coat = 0;
    if (!delta_ && smooth()) p.gloss = 0;
    const double all = p.coat + p.gloss + p.cosine;
    return all > 0 ? Choice{p.coat / all, p.gloss / all, p.cosine / all} : Choice{};
}

Rgb PrincipledBsdf::eval(const Vec3& to_light, const Vec3& to_eye) const {
    if (!(to_light.z * to_eye.z > 0)) return Rgb(0.0);
    const LocalVec i = upper(to_light), o = upper(to_eye);
    const Layers at_i = layers(i.z), at_o = layers(o.z);
    return diffuse_part(at_i, at_o) + glossy_value(i, o, at_i, at_o);
}

double PrincipledBsdf::pdf(const Vec3& from, const Vec3& to) const {
    if (!(from.z * to.z > 0)) return 0;
    const LocalVec w = upper(from), v = upper(to);
    const Choice p = choice(w.z, layers(w.z));
    double sum = p.cosine * v.z * kInvPi;
    if (!smooth()) sum += p.gloss * ggx().reflection_pdf(w, v);
    if (p.coat > 0 && !smooth_coat()) sum += p.coat * coat_ggx().reflection_pdf(w, v);
    return sum;
}

std::optional<BsdfSample> PrincipledBsdf::sample(const Vec3& from, double u0, double u1, double u2) const {
    if (from.z == 0) return std::nullopt;
    const LocalVec w = upper(from);
    const Choice p = choice(w.z, layers(w.z));
    if (!(p.coat + p.gloss + p.cosine > 0)) return std::nullopt;
    std::optional<LocalVec> up;
    if (u2 < p.cosine) {
        up = LocalVec(cosine_hemisphere(u0, u1));
    } else {
        const bool coat = u2 < p.cosine + p.coat;
        if (coat ? smooth_coat() : smooth()) {
            const auto lobe = delta(from, Event::reflect);
            if (!lobe) return std::nullopt;
            return BsdfSample{lobe->to, Event::reflect, lobe->probability};
        }
        up = (coat ? coat_ggx() : ggx()).sample_reflection(w, u0, u1);
    }
    if (!up) return std::nullopt;
    const Vec3 to = on_side_of(from, *up);
    return finite_sample(to, pdf(from, to));
}

std::optional<DeltaScatter> PrincipledBsdf::delta(const Vec3& from, Event event) const {
    if (event != Event::reflect || from.z == 0) return std::nullopt;
    const LocalVec w = upper(from);
    const Layers at = layers(w.z);
    const Choice p = choice(w.z, at);
    const double probability = (smooth_coat() ? p.coat : 0) + (smooth() ? p.gloss : 0);
    if (!(probability > 0)) return std::nullopt;
    Rgb coefficient(0.0);
    if (smooth_coat()) coefficient += Rgb(at.coat);
    if (smooth()) coefficient += gloss_albedo(at.gloss) * (1 - at.coat);
    return DeltaScatter{mirrored(from), coefficient * (1 - at.sheen), probability, 1.0};
}

} // namespace keyhole
