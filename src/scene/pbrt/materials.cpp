#include "scene/pbrt/materials.h"

#include "scene/load/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole::pbrt {
namespace {

const Rgb kCopperEta{0.2004377, 0.9240334, 1.1022120}, kCopperK{3.9129485, 2.4528477, 2.1421880};
constexpr Bounds kRoughness{0, 1e3};
constexpr Bounds kIndex{0.05, 20};

/// v4's alpha of a roughness (Pharr, Jakob and Humphreys 2023, 9.6.1).
double remap_v4(double roughness) { return std::sqrt(roughness); }

/// v3's (Pharr, Jakob and Humphreys 2016, 8.4.2).
double remap_v3(double roughness) {
    const double x = std::log(std::max(roughness, 1e-3));
    return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

using Remap = double (*)(double);

/// The alpha of a textured roughness.
class RemappedTexture final : public Texture<double> {
  public:
    RemappedTexture(FloatTexture roughness, Remap remap) : roughness_(std::move(roughness)), remap_(remap) {}
    double value(const SurfacePoint& point) const override { return remap_(std::max(0.0, roughness_->value(point))); }

  private:
    FloatTexture roughness_;
    Remap remap_;
};

FloatTexture remapped(FloatTexture roughness, Remap remap) {
    if (!roughness->is_constant()) return std::make_shared<RemappedTexture>(std::move(roughness), remap);
    return constant_texture(remap(roughness->value({})));
}

struct Roughness {
    FloatTexture x, y; ///< GGX alphas
};

/// What the readers of the kinds see.
struct Source {
    Parameters& p;
    const TextureTable& textures;
    const MaterialTable& materials;

    ColorTexture color(std::string_view name, double otherwise) const {
        return textures.color(p, name, Rgb(otherwise));
    }

    Roughness roughness(const std::string& prefix, double otherwise, Remap remap) const {
        const FloatTexture both = textures.number(p, prefix + "roughness", otherwise, kRoughness);
        FloatTexture x = textures.find_number(p, prefix + "uroughness", kRoughness);
        FloatTexture y = textures.find_number(p, prefix + "vroughness", kRoughness);
        if (!x) x = both;
        if (!y) y = both;
        if (p.boolean("remaproughness", true)) return {remapped(x, remap), remapped(y, remap)};
        return {x, y};
    }

    double index(std::string_view name, double otherwise) const {
        const Parameter* eta = p.find(name, {"float", "integer", "spectrum", "rgb"});
        if (eta == nullptr || (eta->type != "spectrum" && eta->type != "rgb")) return p.number(name, otherwise, kIndex);
        const Rgb n = p.spectrum(name, Rgb(otherwise), SpectrumUse::index);
        if (n.x != n.y || n.x != n.z)
            p.warn("dispersion", "one refractive index, halfway between red and green, stands for all colours");
        const double middle = (n.x + n.y) / 2;
        if (!(middle >= kIndex.least && middle <= kIndex.most))
            p.directive().fail(*eta, fmt::format("found {} as '{}', expected an index from {} to {}", middle, name,
                                                 kIndex.least, kIndex.most));
        return middle;
    }

    Rgb metal(std::string_view name, const Rgb& otherwise) const {
        return p.spectrum(name, otherwise, SpectrumUse::index);
    }

    void warn_of_scattering_coat() const {
        const ColorTexture albedo = textures.color(p, "albedo", Rgb(0.0));
        if (!albedo->is_constant() || !is_black(albedo->value({})))
            p.warn("coat albedo", "the coat scatters nothing: 'albedo' and 'g' are ignored");
        p.ignore({"g", "maxdepth", "nsamples"});
    }
};

MaterialPtr diffuse(const Source& s) { return make_diffuse(s.color("reflectance", 0.5)); }

MaterialPtr dielectric(const Source& s) {
    const Roughness r = s.roughness("", 0, remap_v4);
    return make_dielectric(s.index("eta", 1.5), r.x, r.y);
}

MaterialPtr thin_dielectric(const Source& s) { return make_thin_dielectric(s.index("eta", 1.5)); }

MaterialPtr conductor(const Source& s) {
    const Roughness r = s.roughness("", 0, remap_v4);
    if (!s.p.has("reflectance")) return make_conductor(s.metal("eta", kCopperEta), s.metal("k", kCopperK), r.x, r.y);
    if (s.p.has("eta") || s.p.has("k")) s.p.fail("found both 'reflectance' and 'eta' or 'k', expected one of them");
    return make_conductor(s.color("reflectance", 0.5), r.x, r.y);
}

MaterialPtr coated_diffuse(const Source& s) {
    const Roughness r = s.roughness("", 0, remap_v4);
    s.warn_of_scattering_coat();
    return make_coated_diffuse(s.color("reflectance", 0.5), r.x, r.y, s.index("eta", 1.5),
                               s.textures.number(s.p, "thickness", 0.01, kNotNegative));
}

MaterialPtr coated_conductor(const Source& s) {
    const Roughness outer = s.roughness("interface.", 0, remap_v4), inner = s.roughness("conductor.", 0, remap_v4);
    s.warn_of_scattering_coat();
    const Coat coat{s.index("interface.eta", 1.5), outer.x, outer.y,
                    s.textures.number(s.p, "thickness", 0.01, kNotNegative)};
    if (s.p.has("reflectance")) return make_coated_conductor(coat, s.color("reflectance", 0.5), inner.x, inner.y);
    return make_coated_conductor(coat, s.metal("conductor.eta", kCopperEta), s.metal("conductor.k", kCopperK), inner.x,
                                 inner.y);
}

ColorTexture scaled(ColorTexture value, double factor) {
    return factor == 1 ? value : scale_texture<Rgb>(std::move(value), constant_texture(factor));
}

MaterialPtr diffuse_transmission(const Source& s) {
    const double scale = s.p.number("scale", 1, kNotNegative);
    return make_diffuse_transmission(scaled(s.color("reflectance", 0.25), scale),
                                     scaled(s.color("transmittance", 0.25), scale));
}

MaterialPtr mix(const Source& s) {
    const FloatTexture amount = s.textures.number(s.p, "amount", 0.5, kShare);
    const Parameter* names = s.p.find("materials", {"string"});
    if (names != nullptr) {
        if (names->strings.size() != 2)
            s.p.fail(fmt::format("found {} 'materials', expected 2", names->strings.size()));
        return make_mix(s.materials.look_up(names->strings[0], s.p.directive()).material,
                        s.materials.look_up(names->strings[1], s.p.directive()).material, amount);
    }
    const std::string first = s.p.string("namedmaterial1", ""), second = s.p.string("namedmaterial2", ""); // v3
    if (first.empty() || second.empty()) s.p.fail("found no 'materials', expected the names of two");
    // v3's amount is the share of the first.
    return make_mix(s.materials.look_up(second, s.p.directive()).material,
                    s.materials.look_up(first, s.p.directive()).material, amount);
}

MaterialPtr interface(const Source&) { return make_interface(); }

// v3's kinds.

MaterialPtr matte(const Source& s) {
    if (s.p.number("sigma", 0, kNotNegative) > 0) s.p.warn("sigma", "'sigma' is ignored: the surface is Lambertian");
    return make_diffuse(s.color("Kd", 0.5));
}

MaterialPtr mirror(const Source& s) { return make_mirror(s.p.spectrum("Kr", Rgb(0.9), SpectrumUse::reflectance)); }

MaterialPtr glass(const Source& s) {
    const Roughness r = s.roughness("", 0, remap_v3);
    const double eta = s.p.has("index") ? s.index("index", 1.5) : s.index("eta", 1.5);
    if (s.p.has("uroughness") || s.p.has("vroughness")) return make_dielectric(eta, r.x, r.y);
    return make_glass(eta, s.p.spectrum("Kr", Rgb(1.0), SpectrumUse::reflectance),
                      s.p.spectrum("Kt", Rgb(1.0), SpectrumUse::reflectance));
}

MaterialPtr metal(const Source& s) {
    const Roughness r = s.roughness("", 0.01, remap_v3);
    return make_conductor(s.metal("eta", kCopperEta), s.metal("k", kCopperK), r.x, r.y);
}

/// The nearest of v4's for plastic, substrate and uber: a coat of the same roughness, whose reflection follows from its
/// index instead of Ks.
MaterialPtr coated(const Source& s, double kd, std::string_view kind) {
    const Roughness r = s.roughness("", 0.1, remap_v3);
    s.p.ignore({"Ks", "Kr", "Kt", "opacity", "index"});
    s.p.warn("v3 " + std::string(kind), fmt::format("the material '{}' of pbrt-v3 becomes a coateddiffuse", kind));
    return make_coated_diffuse(s.color("Kd", kd), r.x, r.y, s.index("eta", 1.5), constant_texture(0.0));
}

MaterialPtr plastic(const Source& s) { return coated(s, 0.25, "plastic"); }
MaterialPtr substrate(const Source& s) { return coated(s, 0.5, "substrate"); }
MaterialPtr uber(const Source& s) { return coated(s, 0.25, "uber"); }

MaterialPtr translucent(const Source& s) {
    const ColorTexture kd = s.color("Kd", 0.25);
    const Rgb reflect = s.p.spectrum("reflect", Rgb(0.5), SpectrumUse::reflectance);
    const Rgb transmit = s.p.spectrum("transmit", Rgb(0.5), SpectrumUse::reflectance);
    s.p.ignore({"Ks", "roughness", "remaproughness"});
    s.p.warn("v3 translucent", "the material 'translucent' of pbrt-v3 becomes a diffusetransmission");
    return make_diffuse_transmission(scaled(kd, luminance(reflect)), scaled(kd, luminance(transmit)));
}

using Reader = MaterialPtr (*)(const Source&);
const std::map<std::string_view, Reader>& readers() {
    static const std::map<std::string_view, Reader> table{{"diffuse", diffuse},
                                                          {"dielectric", dielectric},
                                                          {"thindielectric", thin_dielectric},
                                                          {"conductor", conductor},
                                                          {"coateddiffuse", coated_diffuse},
                                                          {"coatedconductor", coated_conductor},
                                                          {"diffusetransmission", diffuse_transmission},
                                                          {"mix", mix},
                                                          {"interface", interface},
                                                          {"", interface},
                                                          {"none", interface},
                                                          {"matte", matte},
                                                          {"mirror", mirror},
                                                          {"glass", glass},
                                                          {"metal", metal},
                                                          {"plastic", plastic},
                                                          {"substrate", substrate},
                                                          {"uber", uber},
                                                          {"translucent", translucent}};
    return table;
}

} // namespace

MaterialEntry MaterialTable::read(const std::string& type, Parameters& p, const TextureTable& textures) const {
    const auto reader = readers().find(type);
    if (reader == readers().end()) {
        std::vector<std::string_view> names;
        for (const auto& [name, function] : readers())
            if (!name.empty()) names.push_back(name);
        p.fail(fmt::format("found the material '{}', {}", type, expected_one_of(type, names)));
    }
    MaterialEntry entry;
    try {
        entry.material = reader->second({p, textures, *this});
    } catch (const InputError& e) {
        // Those of the material itself know no position.
        if (std::string_view(e.what()).find(p.directive().position.file) == std::string_view::npos) p.fail(e.what());
        throw;
    }
    entry.is_interface = reader->second == interface;
    // A mix doesn't tell whether its parts are textured.
    entry.is_textured =
        reader->second == mix || std::any_of(p.directive().parameters.begin(), p.directive().parameters.end(),
                                             [](const Parameter& q) { return q.type == "texture"; });
    if (p.find("normalmap", {"string"}) != nullptr)
        p.warn("normalmap", "'normalmap' is ignored: the surface keeps its shading normals");
    const std::string_view bump = p.has("displacement") ? "displacement" : "bumpmap"; // v3
    if (FloatTexture displacement = textures.find_number(p, bump, {}))
        if (!displacement->is_constant()) entry.material = with_bump(entry.material, std::move(displacement));
    p.warn_of_the_rest();
    return entry;
}

void MaterialTable::define(Parameters& p, const TextureTable& textures) {
    const Parameter* type = p.find("type", {"string"});
    if (type == nullptr) p.fail("found no 'type', expected the kind of the material");
    named_[p.directive().words[0]] = read(type->strings.front(), p, textures);
}

const MaterialEntry& MaterialTable::look_up(const std::string& name, const Directive& user) const {
    const auto found = named_.find(name);
    if (found != named_.end()) return found->second;
    std::vector<std::string_view> names;
    for (const auto& [known, entry] : named_) names.push_back(known);
    user.fail_unknown(user.position, fmt::format("material '{}'", name),
                      fmt::format("found the unknown material '{}', {}", name, expected_one_of(name, names)));
}

} // namespace keyhole::pbrt
