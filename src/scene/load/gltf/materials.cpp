#include "scene/load/gltf/materials.h"

#include "scene/material.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole::gltf {
namespace {

constexpr int kNearest = 9728, kClamp = 33071, kMirrored = 33648;
constexpr int kGreen = 1, kBlue = 2, kAlpha = 3;
/// Roughness from which on one sees that a pane isn't clear.
constexpr double kSmoothPane = 0.05;

/// KHR_texture_transform, which counts v down from the first row, as a mapping that counts it up.
UvMapping mapping_of(const Json& transform) {
    const auto scale = value_or(transform, "scale", std::array{1.0, 1.0}),
               offset = value_or(transform, "offset", std::array{0.0, 0.0});
    const double turn = value_or(transform, "rotation", 0.0);
    UvMapping m;
    m.su = scale[0];
    m.sv = scale[1];
    m.cosine = std::cos(turn);
    m.sine = std::sin(turn);
    m.du = offset[0] + scale[1] * m.sine;
    m.dv = 1 - offset[1] - scale[1] * m.cosine;
    return m;
}

/// Reads what one material says.
class Reader {
  public:
    Reader(Document& document, const Json& material)
        : document_(document), material_(material), metal_(member(material, "pbrMetallicRoughness")) {}

    MaterialData read() {
        report_extensions();
        MaterialData data;
        data.material = surface();
        if (material_.contains("normalTexture")) {
            const Json& normals = material_["normalTexture"];
            if (value_or(normals, "scale", 1.0) != 1) document_.warn("the scale of normal maps is left out");
            data.material = with_normals(data.material, picture<Rgb>(normals, Encoding::linear));
        }
        data.emission = emission();
        data.alpha = opacity();
        return data;
    }

  private:
    template <class T>
    std::shared_ptr<const Texture<T>> picture(const Json& reference, Encoding encoding, int channel = -1) const {
        const Json& texture = document_.entry("textures", reference.at("index").get<std::size_t>());
        if (!texture.contains("source"))
            document_.fail("found a texture of a format that isn't read, expected PNG or JPEG");
        ImageOptions options;
        options.encoding = encoding;
        options.channel = channel;
        auto set = value_or(reference, "texCoord", 0);
        if (const Json* transform = extension(reference, "KHR_texture_transform")) {
            options.mapping.uv = mapping_of(*transform);
            set = value_or(*transform, "texCoord", set);
        }
        if (set != 0) document_.warn("textures use the first set of coordinates instead of another one");
        if (texture.contains("sampler"))
            read_sampler(document_.entry("samplers", texture["sampler"].get<std::size_t>()), options);
        return image_texture<T>(document_.image_file(texture["source"].get<std::size_t>()), options);
    }

    void read_sampler(const Json& sampler, ImageOptions& options) const {
        const int s = value_or(sampler, "wrapS", 0), t = value_or(sampler, "wrapT", 0);
        if (s == kMirrored || t == kMirrored || (s == kClamp) != (t == kClamp))
            document_.warn("textures that are mirrored, or repeated in one direction, are repeated");
        if (s == kClamp && t == kClamp) options.wrap = Wrap::clamp;
        if (value_or(sampler, "magFilter", 0) == kNearest) options.filter = Filter::nearest;
    }

    /// A colour, perhaps times a texture.
    ColorTexture color(const Json& object, const char* factor, const char* texture) const {
        const Rgb tint = color_or(object, factor, Rgb(1.0));
        if (!object.contains(texture)) return constant_texture(tint);
        const ColorTexture image = picture<Rgb>(object[texture], Encoding::srgb);
        if (tint == Rgb(1.0)) return image;
        return function_texture<Rgb>([image, tint](const SurfacePoint& point) { return image->value(point) * tint; });
    }

    /// A number, perhaps times a channel of a texture.
    FloatTexture number(const Json& object, const char* factor, double otherwise, const char* texture,
                        int channel) const {
        const FloatTexture value = constant_texture(value_or(object, factor, otherwise));
        if (!object.contains(texture)) return value;
        return scale_texture<double>(picture<double>(object[texture], Encoding::linear, channel), value);
    }

    /// On the reflectance along the normal.
    double specular_factor(const Json& specular) const {
        const Rgb tint = color_or(specular, "specularColorFactor", Rgb(1.0));
        if (tint != Rgb(tint.x) || specular.contains("specularTexture") || specular.contains("specularColorTexture"))
            document_.warn("the hue and the textures of KHR_materials_specular are left out");
        return value_or(specular, "specularFactor", 1.0) * luminance(tint);
    }

    /// KHR_materials_transmission is a pane without thickness, unless KHR_materials_volume says otherwise.
    MaterialPtr surface() const {
        constexpr const char* kBoth = "metallicRoughnessTexture";
        const Json* ior = extension(material_, "KHR_materials_ior");
        const double eta = ior != nullptr ? value_or(*ior, "ior", 1.5) : 1.5;
        PrincipledTextures t = principled_textures(eta, number(metal_, "roughnessFactor", 1, kBoth, kGreen));
        t.base_color = color(metal_, "baseColorFactor", "baseColorTexture");
        t.metallic = number(metal_, "metallicFactor", 1, kBoth, kBlue);
        if (const Json* specular = extension(material_, "KHR_materials_specular"))
            t.specular = scale_texture<double>(t.specular, constant_texture(specular_factor(*specular)));
        if (const Json* coat = extension(material_, "KHR_materials_clearcoat")) {
            t.clearcoat = number(*coat, "clearcoatFactor", 0, "clearcoatTexture", 0);
            t.clearcoat = scale_texture<double>(t.clearcoat, constant_texture(4.0));
            t.clearcoat_alpha =
                principled_alpha(number(*coat, "clearcoatRoughnessFactor", 0, "clearcoatRoughnessTexture", kGreen));
        }
        const Json* clear = extension(material_, "KHR_materials_transmission");
        if (clear == nullptr) return make_principled(t);
        const FloatTexture share = number(*clear, "transmissionFactor", 0, "transmissionTexture", 0);
        if (extension(material_, "KHR_materials_volume") != nullptr) {
            document_.warn("volumes absorb by the colour of their surface alone");
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
        SurfaceEmission emission;
        emission.radiance = document_.checked_light(color_or(material_, "emissiveFactor", Rgb(0.0)) * factor);
        emission.two_sided = value_or(material_, "doubleSided", false);
        if (!is_black(emission.radiance) && material_.contains("emissiveTexture"))
            emission.picture = picture<Rgb>(material_["emissiveTexture"], Encoding::srgb);
        return emission;
    }

    FloatTexture opacity() const {
        const auto mode = value_or<std::string>(material_, "alphaMode", "OPAQUE");
        if (mode == "OPAQUE") return nullptr;
        const auto factor = value_or(metal_, "baseColorFactor", std::vector<double>{1, 1, 1, 1});
        FloatTexture alpha = constant_texture(factor.size() == 4 ? std::clamp(factor[3], 0.0, 1.0) : 1.0);
        if (metal_.contains("baseColorTexture"))
            alpha = scale_texture<double>(picture<double>(metal_["baseColorTexture"], Encoding::linear, kAlpha), alpha);
        if (mode == "MASK")
            alpha = computed_texture(
                [cutoff = value_or(material_, "alphaCutoff", 0.5)](double a) { return a >= cutoff ? 1.0 : 0.0; },
                alpha);
        return alpha->is_constant() && alpha->value({}) >= 1 ? nullptr : alpha;
    }

    void report_extensions() const {
        constexpr std::array kRead{"KHR_materials_ior",       "KHR_materials_specular",
                                   "KHR_materials_clearcoat", "KHR_materials_transmission",
                                   "KHR_materials_volume",    "KHR_materials_emissive_strength"};
        for (const auto& [name, value] : member(material_, "extensions").items())
            if (std::ranges::find(kRead, name) == kRead.end())
                document_.warn(fmt::format("the extension {} is left out", name));
    }

    Document& document_;
    const Json& material_;
    const Json& metal_;
};

} // namespace

MaterialData read_material(Document& document, const Json& material) { return Reader(document, material).read(); }

} // namespace keyhole::gltf
