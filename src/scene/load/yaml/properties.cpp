#include "scene/load/yaml/properties.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <type_traits>

namespace keyhole {
namespace {

constexpr NumberRange kIor{"a refractive index", 0.01, 1e4}; // the most reflects 99.96 % at least
constexpr NumberRange kAlpha{"a roughness", 0, 1};

template <class T> std::shared_ptr<const Texture<T>> read_texture(const YamlNode& node, const NumberRange& range);

/// "type", and what else may be in a map.
std::vector<std::string_view> with_type(std::vector<std::string_view> keys) {
    keys.insert(keys.begin(), "type");
    return keys;
}

/// The values of a map.
class YamlProperties final : public Properties {
  public:
    /// @param materials that values may name; may be null where none may.
    /// @param operands range of the textures that others are made from.
    YamlProperties(const YamlNode& node, std::string_view what, const std::vector<std::string_view>& keys,
                   const MaterialTable* materials = nullptr, const NumberRange& operands = {})
        : node_(node), map_(node, what, keys), materials_(materials), operands_(operands) {}

    bool is_pbrt() const override { return false; }
    bool has(Key key) override { return find(key) != nullptr; }
    void require(Key key) override { map_.at(key.yaml); }

    double number(Key key, const NumberRange& range, double otherwise) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_number(*node, range) : otherwise;
    }
    bool boolean(Key key, bool otherwise) override { return map_.boolean(key.yaml, otherwise); }
    std::string choice(Key key, std::string_view what, const std::vector<std::string_view>& choices) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_choice(*node, what, choices) : std::string(choices.front());
    }
    std::string word(Key key) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_string(*node, "a word") : std::string();
    }
    std::string path(Key key, std::string_view what) override {
        return resolve_path(map_.at(key.yaml), fmt::format("the path of {}", what));
    }
    Rgb color(Key key, ColorUse /*use*/, const NumberRange& range, const Rgb& otherwise) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_color(*node, range) : otherwise;
    }
    FloatTexture find_number_texture(Key key, const NumberRange& range) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_texture<double>(*node, range) : nullptr;
    }
    ColorTexture find_color_texture(Key key, const NumberRange& range) override {
        const YamlNode* node = find(key);
        return node != nullptr ? read_texture<Rgb>(*node, range) : nullptr;
    }
    TextureMapping mapping() override {
        const auto pair = [&](std::string_view key, double otherwise) {
            const YamlNode* node = map_.find(key);
            return node != nullptr ? read_numbers(*node, 2, kFactor) : std::vector<double>(2, otherwise);
        };
        const auto repeat = pair("repeat", 1), shift = pair("shift", 0);
        const double turn = number("rotate", {"an angle in degrees", -1e6, 1e6}, 0) * kPi / 180;
        const UvMapping coordinates{repeat[0], repeat[1], shift[0], shift[1], std::cos(turn), std::sin(turn)};
        using enum Projection;
        const std::string word = choice("mapping", "a mapping", {"uv", "planar", "spherical", "cylindrical"});
        if (word == "uv" && has("transform"))
            fail_at("transform", "found 'transform' without 'mapping', expected both");
        if (word == "uv") return {coordinates};
        return {coordinates,
                word == "planar"      ? planar
                : word == "spherical" ? spherical
                                      : cylindrical,
                texture_space("transform")};
    }
    Imath::M44d texture_space(Key to_world) override {
        const YamlNode* node = find(to_world);
        return node != nullptr ? read_transform(*node).inverse() : Imath::M44d();
    }

    double refractive_index(Key key) override { return number(key, kIor, 1.5); }
    Roughness roughness(Key key, RoughnessScale /*scale*/, double otherwise) override {
        const YamlNode* node = find(key);
        if (node == nullptr || node->kind != YamlNode::Kind::list) {
            const FloatTexture both = number_texture(key, kAlpha, otherwise);
            return {both, both};
        }
        if (node->items.size() != 2) fail_expected(*node, "a roughness, or two: along the tangent and across it");
        return {read_texture<double>(*node->items[0], kAlpha), read_texture<double>(*node->items[1], kAlpha)};
    }
    std::vector<MaterialPtr> materials(Key key) override { return {find_material(map_.at(key.yaml), *materials_)}; }

    Vec3 position(Key key) override { return Vec3(read_vec3(map_.at(key.yaml), kCoordinate)); }
    Vec3 direction(Key along, Key from, Key to) override {
        const bool by_places = has(to);
        const YamlNode& aim = to.yaml.empty() ? map_.at(along.yaml) : either(to, along);
        Imath::V3d w = read_vec3(aim, kCoordinate);
        if (by_places) w -= read_vec3(map_.at(from.yaml), kCoordinate);
        if (!(w.length() > 0))
            keyhole::fail(aim, by_places ? fmt::format("found 'to' at the {}, expected another point", from.yaml)
                                         : "found the direction [0, 0, 0], expected one that leads somewhere");
        return Vec3(w.normalized());
    }
    Vec3 axis(Key key, const Vec3& otherwise) override {
        const YamlNode* node = find(key);
        if (node == nullptr) return otherwise;
        const Imath::V3d w = read_vec3(*node, kCoordinate);
        if (!(w.length() > 0)) keyhole::fail(*node, "found the direction [0, 0, 0], expected one with a length");
        return Vec3(w.normalized());
    }
    Imath::M33d rotation(Key key) override {
        const YamlNode* node = find(key);
        const Transform t = node != nullptr ? read_transform(*node) : Transform();
        return {t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2], t[2][0], t[2][1], t[2][2]};
    }
    Rgb light(Key amount, Key total, double per_unit) override {
        if (total.yaml.empty()) return read_color(map_.at(amount.yaml), kLight);
        const Rgb value = read_color(either(amount, total), kLight);
        return has(total) ? value / per_unit : value;
    }

    [[noreturn]] void fail(const std::string& message) const override { keyhole::fail(node_, message); }
    [[noreturn]] void fail_at(Key key, const std::string& message) override {
        const YamlNode* node = find(key);
        keyhole::fail(node != nullptr ? *node : node_, message);
    }

  protected:
    NumberRange operand_range() const override { return operands_; }

  private:
    const YamlNode* find(Key key) const { return key.yaml.empty() ? nullptr : map_.find(key.yaml); }

    /// The one of two values that is given.
    const YamlNode& either(Key a, Key b) const {
        const YamlNode *first = find(a), *second = find(b);
        if ((first == nullptr) == (second == nullptr))
            fail(fmt::format("found {} of '{}' and '{}', expected one", first ? "both" : "neither", a.yaml, b.yaml));
        return first != nullptr ? *first : *second;
    }

    const YamlNode& node_;
    MapReader map_;
    const MaterialTable* materials_;
    NumberRange operands_;
};

/// The kind that a map says it is of; `what` it is one of, as in "a material".
template <class Made>
const Kind<Made>& kind_of(const YamlNode& node, std::string_view what, const std::vector<Kind<Made>>& kinds) {
    return *find_kind(kinds, &Key::yaml, read_type(node, what, names_of(kinds, &Key::yaml)));
}

template <class T> std::shared_ptr<const Texture<T>> read_texture(const YamlNode& node, const NumberRange& range) {
    if (node.kind == YamlNode::Kind::map) {
        const auto& kind = kind_of(node, "a texture", texture_kinds<T>());
        YamlProperties p(node, kind.what, with_type(kind.keys), nullptr, range);
        return kind.read(p);
    }
    if constexpr (std::is_same_v<T, Rgb>)
        return constant_texture(read_color(node, range));
    else
        return constant_texture(read_number(node, range));
}

constexpr double kSingular = 1e-12; // far above rounding in doubles, far below what floats could show

Transform read_scale(const YamlNode& node) {
    const NumberRange range{"a scale factor", -1e12, 1e12};
    const Imath::V3d s =
        node.kind == YamlNode::Kind::list ? read_vec3(node, range) : Imath::V3d(read_number(node, range));
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(s[axis]) < kSingular)
            fail(node, fmt::format("found a singular transform (scale {:g}), expected factors other than 0", s[axis]));
    Transform t;
    t.setScale(s);
    return t;
}

Transform read_rotation(const YamlNode& node) {
    const auto n = read_numbers(node, 4, kCoordinate);
    const Imath::V3d axis(n[1], n[2], n[3]);
    if (!(axis.length() > 0)) fail(node, "found the rotation axis [0, 0, 0], expected one with a direction");
    Transform t;
    t.setAxisAngle(axis.normalized(), n[0] * kPi / 180);
    return t;
}

Transform read_matrix(const YamlNode& node) {
    const auto n = read_numbers(node, 16, kCoordinate);
    if (n[12] != 0 || n[13] != 0 || n[14] != 0 || n[15] != 1)
        fail(*node.items[12], "found a projective matrix, expected 0, 0, 0, 1 as its last row");
    Transform t;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) t[column][row] = n[static_cast<std::size_t>(4 * row + column)];
    if (regularity(t) < kSingular) fail(node, "found a singular matrix, expected one that can be inverted");
    return t;
}

Transform read_step(const YamlNode& node) {
    const MapReader map(node, "a transform", {"scale", "rotate", "translate", "matrix"});
    if (node.entries.size() != 1)
        fail(node, fmt::format("found {} transforms in one map, expected one (list several in their order)",
                               node.entries.size()));
    if (const YamlNode* scale = map.find("scale")) return read_scale(*scale);
    if (const YamlNode* rotate = map.find("rotate")) return read_rotation(*rotate);
    if (const YamlNode* matrix = map.find("matrix")) return read_matrix(*matrix);
    Transform t;
    t.setTranslation(read_vec3(map.at("translate"), kCoordinate));
    return t;
}

} // namespace

MaterialPtr read_material(const YamlNode& node, const MaterialTable& table) {
    const auto& kind = kind_of(node, "a material", material_kinds());
    YamlProperties p(node, kind.what, with_type(kind.keys), &table);
    return read_material(kind, p);
}

MaterialPtr find_material(const YamlNode& node, const MaterialTable& table) {
    return node.kind == YamlNode::Kind::map ? read_material(node, table) : table.resolve(node);
}

EmitterPtr read_emitter(const YamlNode& node) {
    const auto& kind = kind_of(node, "an emitter", emitter_kinds());
    YamlProperties p(node, kind.what, with_type(kind.keys));
    return kind.read(p);
}

std::unique_ptr<SurfaceEmission> read_emission(const YamlNode& node, double area) {
    YamlProperties p(node, "an emission", {"radiance", "power", "two_sided", "texture", "spread", "angle", "falloff"});
    return emission_of(read_area_light(p), area);
}

FloatTexture read_float_texture(const YamlNode& node, const NumberRange& range) {
    return read_texture<double>(node, range);
}

std::string resolve_path(const YamlNode& node, std::string_view expected) {
    const std::filesystem::path path = read_string(node, expected);
    return (std::filesystem::path(*node.file).parent_path() / path).lexically_normal().string();
}

Transform read_transform(const YamlNode& node) {
    if (node.kind == YamlNode::Kind::map) return read_step(node);
    Transform all;
    for (const auto& step : read_list(node, "transforms")) all = all * read_step(*step);
    if (!(regularity(all) > kSingular)) fail(node, "found a singular transform, expected one that can be inverted");
    return all;
}

} // namespace keyhole
