#include "scene/load/gltf/textures.h"

#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

namespace keyhole::gltf {
namespace {

constexpr int kNearest = 9728, kClamp = 33071, kMirrored = 33648;

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

/// The image of a texture. Extensions offer it in other formats; what every reader of glTF knows goes first.
std::size_t source_of(const Document& document, const Json& texture) {
    if (texture.contains("source")) return texture["source"].get<std::size_t>();
    const Json* webp = extension(texture, "EXT_texture_webp");
    if (webp != nullptr && webp->contains("source")) return (*webp)["source"].get<std::size_t>();
    std::string names;
    for (const auto& [name, value] : member(texture, "extensions").items()) names += " of " + name;
    document.fail(fmt::format("found a texture{} without another source, expected PNG, JPEG or WebP: export it with "
                              "one of them",
                              names));
}

void read_sampler(const Document& document, const Json& sampler, ImageOptions& options) {
    const int s = value_or(sampler, "wrapS", 0), t = value_or(sampler, "wrapT", 0);
    if (s == kMirrored || t == kMirrored || (s == kClamp) != (t == kClamp))
        document.warn("textures that are mirrored, or repeated in one direction, are repeated");
    if (s == kClamp && t == kClamp) options.wrap = Wrap::clamp;
    if (value_or(sampler, "magFilter", 0) == kNearest) options.filter = Filter::nearest;
}

} // namespace

template <class T>
std::shared_ptr<const Texture<T>> picture(Document& document, const Json& reference, Encoding encoding, int channel) {
    const Json& texture = document.entry("textures", reference.at("index").get<std::size_t>());
    ImageOptions options;
    options.encoding = encoding;
    options.channel = channel;
    auto set = value_or(reference, "texCoord", 0);
    if (const Json* transform = extension(reference, "KHR_texture_transform")) {
        options.mapping.uv = mapping_of(*transform);
        set = value_or(*transform, "texCoord", set);
    }
    if (set != 0) document.warn("textures use the first set of coordinates instead of another one");
    if (texture.contains("sampler"))
        read_sampler(document, document.entry("samplers", texture["sampler"].get<std::size_t>()), options);
    const std::size_t source = source_of(document, texture);
    const std::string file = document.image_file(source);
    try {
        return image_texture<T>(file, options);
    } catch (const InputError& e) {
        document.fail_of_image(source, file, e.what());
    }
}

template std::shared_ptr<const Texture<Rgb>> picture<Rgb>(Document&, const Json&, Encoding, int);
template std::shared_ptr<const Texture<double>> picture<double>(Document&, const Json&, Encoding, int);

ColorTexture color(Document& document, const Json& object, const char* factor, const char* texture,
                   std::size_t numbers) {
    Rgb tint = color_or(object, factor, Rgb(1.0), numbers);
    for (int c = 0; c < 3; ++c) tint[c] = document.checked_share(tint[c], factor);
    if (!object.contains(texture)) return constant_texture(tint);
    ColorTexture image = picture<Rgb>(document, object[texture], Encoding::srgb);
    if (tint == Rgb(1.0)) return image;
    return function_texture<Rgb>([image, tint](const SurfacePoint& point) { return image->value(point) * tint; });
}

FloatTexture number(Document& document, const Json& object, const char* factor, double otherwise, const char* texture,
                    int channel) {
    FloatTexture value = constant_texture(document.checked_share(value_or(object, factor, otherwise), factor));
    if (!object.contains(texture)) return value;
    return scale_texture<double>(picture<double>(document, object[texture], Encoding::linear, channel), value);
}

} // namespace keyhole::gltf
