#include "scene/load/gltf/materials.h"

#include "scene/load/gltf/specular_glossiness.h"
#include "scene/load/gltf/textures.h"
#include "scene/material.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace keyhole::gltf {
namespace {

constexpr int kGreen = 1, kBlue = 2, kAlpha = 3;
/// Roughness from which on one sees that a pane isn't clear.
constexpr double kSmoothPane = 0.05;
/// Black would absorb infinitely much.
constexpr double kLeastAttenuation = 1e-6;

/// Reads what one material says.
class Reader {
  public:
    Reader(Document& document, const Json& material, const VertexColors& colors)
        : document_(document), material_(material), metal_(member(material, "pbrMetallicRoughness")),
          glossy_(extension(material, "KHR_materials_pbrSpecularGlossiness")), colors_(colors) {}

    MaterialData read() {
        report_extensions();
        MaterialData data;
        data.material = surface();
        if (material_.contains("normalTexture")) data.material = with_normals(data.material, normals());
        data.emission = emission();
        data.alpha = opacity();
        if (is_solid_glass()) data.inside = medium();
        return data;
    }

  private:
    /// The scale of a normal map is a factor on x and y, which are stored as (x + 1) / 2.
    ColorTexture normals() const {
        const Json& reference = material_["normalTexture"];
        ColorTexture map = picture<Rgb>(document_, reference, Encoding::linear);
        const auto scale = value_or(reference, "scale", 1.0);
        if (scale == 1) return map;
        return computed_texture(
            [scale](const Rgb& c) { return Rgb((c.x - 0.5) * scale + 0.5, (c.y - 0.5) * scale + 0.5, c.z); }, map);
    }

    bool is_solid_glass() const {
        const Json *clear = extension(material_, "KHR_materials_transmission"),
                   *volume = extension(material_, "KHR_materials_volume");
        return clear != nullptr && volume != nullptr && value_or(*clear, "transmissionFactor", 0.0) > 0 &&
               value_or(*volume, "thicknessFactor", 0.0) > 0;
    }

    /// What attenuates light within glass by a colour over a distance; null: nothing.
    std::shared_ptr<const Medium> medium() const {
        const Json& volume = *extension(material_, "KHR_materials_volume");
        const double distance = value_or(volume, "attenuationDistance", 0.0); // not given: infinite
        const Rgb color = color_or(volume, "attenuationColor", Rgb(1.0));
        if (!(distance > 0)) return nullptr;
        Medium medium;
        for (int c = 0; c < 3; ++c)
            medium.absorption[c] = -std::log(std::clamp(color[c], kLeastAttenuation, 1.0)) / distance;
        return is_black(medium.absorption) ? nullptr : std::make_shared<Medium>(medium);
    }

    /// On the reflectance along the normal.
    double specular_factor(const Json& specular) const {
        const Rgb tint = color_or(specular, "specularColorFactor", Rgb(1.0));
        if (tint != Rgb(tint.x) || specular.contains("specularTexture") || specular.contains("specularColorTexture"))
            document_.warn("the hue and the textures of KHR_materials_specular are left out");
        return value_or(specular, "specularFactor", 1.0) * luminance(tint);
    }

    ColorTexture times_vertices(const ColorTexture& base) const {
        if (colors_.color == nullptr) return base;
        return computed_texture([](const Rgb& a, const Rgb& b) { return a * b; }, base, colors_.color);
    }

    MetallicRoughness base_surface() const {
        if (glossy_ != nullptr) {
            document_.warn("KHR_materials_pbrSpecularGlossiness is approximated by metal and plastic");
            return from_specular_glossiness(document_, *glossy_);
        }
        constexpr const char* kBoth = "metallicRoughnessTexture";
        return {color(document_, metal_, "baseColorFactor", "baseColorTexture", 4),
                number(document_, metal_, "metallicFactor", 1, kBoth, kBlue),
                number(document_, metal_, "roughnessFactor", 1, kBoth, kGreen)};
    }

    /// KHR_materials_transmission is a pane without thickness, unless KHR_materials_volume gives it one.
    MaterialPtr surface() const {
        const Json* ior = extension(material_, "KHR_materials_ior");
        const double eta = ior != nullptr ? value_or(*ior, "ior", 1.5) : 1.5;
        const MetallicRoughness base = base_surface();
        PrincipledTextures t = principled_textures(eta, base.roughness);
        t.base_color = times_vertices(base.color);
        t.metallic = base.metallic;
        if (base.specular != nullptr) t.specular = base.specular;
        if (const Json* specular = extension(material_, "KHR_materials_specular"))
            t.specular = scale_texture<double>(t.specular, constant_texture(specular_factor(*specular)));
        if (const Json* coat = extension(material_, "KHR_materials_clearcoat")) {
            t.clearcoat = number(document_, *coat, "clearcoatFactor", 0, "clearcoatTexture", 0);
            t.clearcoat = scale_texture<double>(t.clearcoat, constant_texture(4.0));
            t.clearcoat_alpha = principled_alpha(
                number(document_, *coat, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", kGreen));
        }
        const Json* clear = extension(material_, "KHR_materials_transmission");
        if (clear == nullptr) return make_principled(t);
        const FloatTexture share = number(document_, *clear, "transmissionFactor", 0, "transmissionTexture", 0);
        if (is_solid_glass()) {
            t.transmission = share;
            return make_principled(t);
        }
        if (const auto rough = value_or(metal_, "roughnessFactor", 1.0); rough > kSmoothPane)
            document_.warn(
                fmt::format("panes without thickness are smooth: that of the material '{}' has the roughness {:.2g}",
                            value_or<std::string>(material_, "name", ""), rough));
        return make_mix(make_principled(t), make_thin_dielectric(eta, t.base_color), share);
    }

    SurfaceEmission emission() const {
        const Json* strength = extension(material_, "KHR_materials_emissive_strength");
        const double factor = strength != nullptr ? value_or(*strength, "emissiveStrength", 1.0) : 1.0;
        const Rgb color = color_or(material_, "emissiveFactor", Rgb(0.0));
        if (const double most = std::max({color.x, color.y, color.z}); most > 1)
            document_.warn(fmt::format("found {} as 'emissiveFactor', expected 0 to 1, and the rest as "
                                       "KHR_materials_emissive_strength: it counts as it is",
                                       most));
        SurfaceEmission emission;
        emission.radiance = document_.checked_light(color * factor);
        emission.radiance *= document_.emission_unit();
        emission.two_sided = value_or(material_, "doubleSided", false);
        if (!is_black(emission.radiance) && material_.contains("emissiveTexture"))
            emission.picture = picture<Rgb>(document_, material_["emissiveTexture"], Encoding::srgb);
        return emission;
    }

    FloatTexture opacity() const {
        const auto mode = value_or<std::string>(material_, "alphaMode", "OPAQUE");
        const std::vector<std::string_view> known{"OPAQUE", "MASK", "BLEND"};
        if (std::ranges::find(known, mode) == known.end())
            document_.fail(fmt::format("found the alphaMode '{}', {}", mode, expected_one_of(mode, known)));
        if (mode == "OPAQUE") return nullptr;
        const Json& owner = glossy_ != nullptr ? *glossy_ : metal_;
        const char* const texture = glossy_ != nullptr ? "diffuseTexture" : "baseColorTexture";
        const auto factor =
            value_or(owner, glossy_ != nullptr ? "diffuseFactor" : "baseColorFactor", std::array{1.0, 1.0, 1.0, 1.0});
        FloatTexture alpha = constant_texture(std::clamp(factor[3], 0.0, 1.0));
        if (owner.contains(texture))
            alpha = scale_texture<double>(picture<double>(document_, owner[texture], Encoding::linear, kAlpha), alpha);
        if (colors_.opacity != nullptr) alpha = scale_texture<double>(alpha, colors_.opacity);
        if (mode == "MASK")
            alpha = computed_texture(
                [cutoff = value_or(material_, "alphaCutoff", 0.5)](double a) { return a >= cutoff ? 1.0 : 0.0; },
                alpha);
        return alpha->is_constant() && alpha->value({}) >= 1 ? nullptr : alpha;
    }

    void report_extensions() const {
        constexpr std::array kRead{"KHR_materials_ior",
                                   "KHR_materials_specular",
                                   "KHR_materials_clearcoat",
                                   "KHR_materials_transmission",
                                   "KHR_materials_volume",
                                   "KHR_materials_emissive_strength",
                                   "KHR_materials_pbrSpecularGlossiness"};
        for (const auto& [name, value] : member(material_, "extensions").items())
            if (std::ranges::find(kRead, name) == kRead.end())
                document_.warn(fmt::format("the extension {} is left out", name));
    }

    Document& document_;
    const Json& material_;
    const Json& metal_;
    const Json* glossy_; ///< KHR_materials_pbrSpecularGlossiness, which stands for `metal_`; null: none
    const VertexColors& colors_;
};

} // namespace

MaterialData read_material(Document& document, const Json& material, const VertexColors& colors) {
    return Reader(document, material, colors).read();
}

} // namespace keyhole::gltf
