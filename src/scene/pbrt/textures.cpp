#include "scene/pbrt/textures.h"

#include "scene/load/suggest.h"

#include <fmt/format.h>

namespace keyhole::pbrt {
namespace {

template <class T>
const std::shared_ptr<const T>& look_up(const std::map<std::string, std::shared_ptr<const T>>& table,
                                        const Directive& directive, const Parameter& parameter, std::string_view kind) {
    const std::string& name = parameter.strings.front();
    const auto found = table.find(name);
    if (found != table.end()) return found->second;
    std::vector<std::string_view> names;
    names.reserve(table.size());
    for (const auto& [known, texture] : table) names.push_back(known);
    directive.fail_unknown(
        parameter.position, fmt::format("{} texture '{}'", kind, name),
        fmt::format("found the unknown {} texture '{}', {}", kind, name, expected_one_of(name, names)));
}

UvMapping read_mapping(Parameters& p) {
    const std::string mapping = p.string("mapping", "uv");
    if (mapping != "uv") p.fail(fmt::format("found the mapping '{}', expected uv", mapping));
    return {p.number("uscale", 1), p.number("vscale", 1), p.number("udelta", 0), p.number("vdelta", 0)};
}

void read_encoding(Parameters& p, ImageOptions& options) {
    const std::string encoding = p.string("encoding", "");
    if (encoding == "sRGB") options.encoding = Encoding::srgb;
    if (encoding == "linear") options.encoding = Encoding::linear;
    if (encoding.starts_with("gamma")) {
        options.encoding = Encoding::gamma;
        options.gamma = std::atof(encoding.c_str() + 5);
        if (!(options.gamma > 0)) p.fail(fmt::format("found the encoding '{}', expected a positive gamma", encoding));
    }
    if (!encoding.empty() && options.encoding == Encoding::automatic)
        p.fail(fmt::format("found the encoding '{}', expected sRGB, linear or gamma with a number", encoding));
    if (!p.boolean("gamma", true)) options.encoding = Encoding::linear; // v3
}

Wrap read_wrap(Parameters& p) {
    static const std::map<std::string, Wrap> kWraps{
        {"repeat", Wrap::repeat}, {"black", Wrap::black}, {"clamp", Wrap::clamp}};
    const std::string wrap = p.string("wrap", "repeat");
    const auto found = kWraps.find(wrap);
    if (found == kWraps.end()) p.fail(fmt::format("found the wrap '{}', expected repeat, black or clamp", wrap));
    return found->second;
}

template <class T> std::shared_ptr<const Texture<T>> read_image(Parameters& p) {
    const std::string file = p.string("filename", "");
    if (file.empty()) p.fail("found no 'filename', expected the path of a picture");
    ImageOptions options;
    read_encoding(p, options);
    options.wrap = read_wrap(p);
    const std::string filter = p.string("filter", "bilinear");
    if (filter == "point") options.filter = Filter::nearest;
    options.scale = p.number("scale", 1);
    options.invert = p.boolean("invert", false);
    options.mapping = read_mapping(p);
    p.ignore({"maxanisotropy", "trilinear"}); // what finer filters would take
    try {
        return image_texture<T>(p.context().resolve(file), options);
    } catch (const InputError& e) {
        p.fail(e.what());
    }
}

} // namespace

void TextureTable::define(Parameters& p) {
    const auto& words = p.directive().words;
    if (words[1] == "float")
        numbers_[words[0]] = read<double>(p);
    else if (words[1] == "spectrum" || words[1] == "color") // v3
        colors_[words[0]] = read<Rgb>(p);
    else
        p.fail(fmt::format("found the type '{}' of a texture, expected spectrum or float", words[1]));
    p.warn_of_the_rest();
}

template <> ColorTexture TextureTable::operand<Rgb>(Parameters& p, std::string_view name, double otherwise) const {
    return color(p, name, Rgb(otherwise));
}

template <> FloatTexture TextureTable::operand<double>(Parameters& p, std::string_view name, double otherwise) const {
    return number(p, name, otherwise);
}

template <class T> std::shared_ptr<const Texture<T>> TextureTable::read(Parameters& p) const {
    const std::string& kind = p.directive().words[2];
    if (kind == "constant") return operand<T>(p, "value", 1);
    if (kind == "imagemap") return read_image<T>(p);
    if (kind == "scale") {
        const bool v3 = p.has("tex2");
        auto value = operand<T>(p, v3 ? "tex1" : "tex", 1);
        if (!v3) return scale_texture<T>(std::move(value), number(p, "scale", 1));
        const Parameter* factor = p.find("tex2", {"float", "integer", "texture"});
        if (factor == nullptr || (factor->type == "texture" && !numbers_.contains(factor->strings.front())))
            p.fail("found a spectrum as 'tex2', expected a number or a float texture");
        return scale_texture<T>(std::move(value), number(p, "tex2", 1));
    }
    if (kind == "mix")
        return mix_texture<T>(operand<T>(p, "tex1", 0), operand<T>(p, "tex2", 1), number(p, "amount", 0.5, kShare));
    if (kind == "checkerboard") {
        if (p.integer("dimension", 2, 2, 3) != 2) p.fail("found a checkerboard of 3 dimensions, expected 2");
        p.ignore({"aamode"});
        return checkerboard_texture<T>(operand<T>(p, "tex1", 1), operand<T>(p, "tex2", 0), read_mapping(p));
    }
    p.fail(fmt::format("found the texture '{}', {}", kind,
                       expected_one_of(kind, {"imagemap", "constant", "scale", "mix", "checkerboard"})));
}

ColorTexture TextureTable::color(Parameters& p, std::string_view name, const Rgb& otherwise, SpectrumUse use) const {
    const Parameter* parameter = p.find(name, {"rgb", "spectrum", "texture", "blackbody", "xyz"});
    if (parameter != nullptr && parameter->type == "texture")
        return look_up(colors_, p.directive(), *parameter, "spectrum");
    return constant_texture(p.spectrum(name, otherwise, use));
}

FloatTexture TextureTable::find_number(Parameters& p, std::string_view name, const Bounds& bounds) const {
    const Parameter* parameter = p.find(name, {"float", "integer", "texture"});
    if (parameter == nullptr) return nullptr;
    if (parameter->type == "texture") return look_up(numbers_, p.directive(), *parameter, "float");
    return constant_texture(p.number(name, 0, bounds));
}

FloatTexture TextureTable::number(Parameters& p, std::string_view name, double otherwise, const Bounds& bounds) const {
    FloatTexture texture = find_number(p, name, bounds);
    return texture ? texture : constant_texture(otherwise);
}

} // namespace keyhole::pbrt
