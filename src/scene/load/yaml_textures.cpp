#include "scene/load/yaml_textures.h"

#include "scene/load/yaml_primitives.h"

namespace keyhole {
namespace {

constexpr NumberRange kFactor{"a factor", -1e12, 1e12};
constexpr NumberRange kGamma{"a gamma", 0.01, 100};
constexpr NumberRange kShare{"a share", 0, 1};

template <class T> std::shared_ptr<const Texture<T>> read_texture(const YamlNode& node, const NumberRange& range);

UvMapping read_mapping(const MapReader& map) {
    UvMapping m;
    const auto pair = [&](std::string_view key, double& u, double& v) {
        const YamlNode* node = map.find(key);
        if (node == nullptr) return;
        const auto numbers = read_numbers(*node, 2, kFactor);
        u = numbers[0];
        v = numbers[1];
    };
    pair("repeat", m.su, m.sv);
    pair("shift", m.du, m.dv);
    return m;
}

ImageOptions read_image_options(const MapReader& map) {
    ImageOptions o;
    if (const YamlNode* node = map.find("encoding"); node != nullptr) {
        const std::string word = read_choice(*node, "an encoding", {"automatic", "srgb", "linear", "gamma"});
        o.encoding = word == "srgb"     ? Encoding::srgb
                     : word == "linear" ? Encoding::linear
                     : word == "gamma"  ? Encoding::gamma
                                        : Encoding::automatic;
    }
    o.gamma = map.number("gamma", kGamma, o.gamma);
    if (const YamlNode* node = map.find("wrap"); node != nullptr) {
        const std::string word = read_choice(*node, "a way to wrap", {"repeat", "black", "clamp"});
        o.wrap = word == "black" ? Wrap::black : word == "clamp" ? Wrap::clamp : Wrap::repeat;
    }
    if (const YamlNode* node = map.find("filter"); node != nullptr)
        o.filter =
            read_choice(*node, "a filter", {"bilinear", "nearest"}) == "nearest" ? Filter::nearest : Filter::bilinear;
    o.scale = map.number("scale", kFactor, o.scale);
    o.invert = map.boolean("invert", false);
    o.mapping = read_mapping(map);
    return o;
}

template <class T> std::shared_ptr<const Texture<T>> read_image(const YamlNode& node, const NumberRange& /*range*/) {
    const MapReader map(node, "an image",
                        {"type", "file", "encoding", "gamma", "wrap", "filter", "scale", "invert", "repeat", "shift"});
    const YamlNode& file = map.at("file");
    const ImageOptions options = read_image_options(map);
    try {
        return image_texture<T>(resolve_path(file, "the path of an image"), options);
    } catch (const InputError& e) {
        fail(file, e.what());
    }
}

template <class T> std::shared_ptr<const Texture<T>> read_checkerboard(const YamlNode& node, const NumberRange& range) {
    const MapReader map(node, "a checkerboard", {"type", "a", "b", "repeat", "shift"});
    return checkerboard_texture<T>(read_texture<T>(map.at("a"), range), read_texture<T>(map.at("b"), range),
                                   read_mapping(map));
}

template <class T> std::shared_ptr<const Texture<T>> read_scale(const YamlNode& node, const NumberRange& range) {
    const MapReader map(node, "a scaled texture", {"type", "texture", "factor"});
    return scale_texture<T>(read_texture<T>(map.at("texture"), range), read_float_texture(map.at("factor"), kFactor));
}

template <class T> std::shared_ptr<const Texture<T>> read_mix(const YamlNode& node, const NumberRange& range) {
    const MapReader map(node, "a mix of textures", {"type", "a", "b", "amount"});
    return mix_texture<T>(read_texture<T>(map.at("a"), range), read_texture<T>(map.at("b"), range),
                          float_texture(map, "amount", kShare, 0.5));
}

template <class T> std::shared_ptr<const Texture<T>> read_texture(const YamlNode& node, const NumberRange& range) {
    if (node.kind == YamlNode::Kind::map) {
        const std::string type = read_type(node, "a texture", {"checkerboard", "image", "mix", "scale"});
        if (type == "image") return read_image<T>(node, range);
        if (type == "checkerboard") return read_checkerboard<T>(node, range);
        return type == "scale" ? read_scale<T>(node, range) : read_mix<T>(node, range);
    }
    if constexpr (std::is_same_v<T, Rgb>)
        return constant_texture(read_color(node, range));
    else
        return constant_texture(read_number(node, range));
}

} // namespace

ColorTexture read_color_texture(const YamlNode& node, const NumberRange& range) {
    return read_texture<Rgb>(node, range);
}

FloatTexture read_float_texture(const YamlNode& node, const NumberRange& range) {
    return read_texture<double>(node, range);
}

ColorTexture color_texture(const MapReader& map, std::string_view key, const NumberRange& range, const Rgb& otherwise) {
    const YamlNode* node = map.find(key);
    return node != nullptr ? read_color_texture(*node, range) : constant_texture(otherwise);
}

FloatTexture float_texture(const MapReader& map, std::string_view key, const NumberRange& range, double otherwise) {
    const YamlNode* node = map.find(key);
    return node != nullptr ? read_float_texture(*node, range) : constant_texture(otherwise);
}

} // namespace keyhole
