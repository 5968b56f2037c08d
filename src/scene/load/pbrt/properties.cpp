#include "scene/load/pbrt/properties.h"

#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole::pbrt {
namespace {

constexpr Bounds kRoughness{0, 1e3};
constexpr Bounds kIndex{0.05, 20};

/// The alpha of a roughness (Pharr, Jakob and Humphreys 2023, 9.6.1; for v3 2016, 8.4.2).
double alpha_of(double roughness, RoughnessScale scale) {
    if (scale == RoughnessScale::pbrt_v4) return std::sqrt(roughness);
    const double x = std::log(std::max(roughness, 1e-3));
    return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

FloatTexture alpha_texture(const FloatTexture& roughness, RoughnessScale scale) {
    return computed_texture([scale](double r) { return alpha_of(std::max(0.0, r), scale); }, roughness);
}

/// The parameters of a directive.
class PbrtProperties final : public Properties {
  public:
    PbrtProperties(Parameters& parameters, const Library& library, const Transform& to_world = {}, double exposure = 1)
        : p_(parameters), library_(library), to_world_(to_world), exposure_(exposure) {}

    bool is_pbrt() const override { return true; }
    bool has(Key key) override { return !key.pbrt.empty() && p_.has(key.pbrt); }
    void require(Key /*key*/) override {}

    double number(Key key, const NumberRange& range, double otherwise) override {
        return key.pbrt.empty() ? otherwise : p_.number(key.pbrt, otherwise, range);
    }
    bool boolean(Key key, bool otherwise) override { return p_.boolean(key.pbrt, otherwise); }
    std::string choice(Key key, std::string_view /*what*/, const std::vector<std::string_view>& choices) override {
        std::string chosen = p_.string(key.pbrt, std::string(choices.front()));
        if (std::ranges::find(choices, chosen) == choices.end())
            fail(fmt::format("found the {} '{}', {}", key.pbrt, chosen, expected_one_of(chosen, choices)));
        return chosen;
    }
    std::string word(Key key) override { return p_.string(key.pbrt, ""); }
    std::string path(Key key, std::string_view what) override {
        const std::string file = word(key);
        if (file.empty()) fail(fmt::format("found no '{}', expected the path of {}", key.pbrt, what));
        return p_.context().resolve(file);
    }
    Rgb color(Key key, ColorUse use, const NumberRange& /*range*/, const Rgb& otherwise) override {
        return key.pbrt.empty() ? otherwise : p_.spectrum(key.pbrt, otherwise, use);
    }
    FloatTexture find_number_texture(Key key, const NumberRange& range) override {
        return key.pbrt.empty() ? nullptr : find_number(std::string(key.pbrt), range);
    }
    ColorTexture find_color_texture(Key key, const NumberRange& /*range*/) override {
        return find_color(key, ColorUse::reflectance);
    }
    ColorTexture find_unbounded_texture(Key key) override { return find_color(key, ColorUse::index); }
    TextureMapping mapping() override {
        const std::string word = choice({"", "mapping"}, "", {"uv", "planar", "spherical", "cylindrical"});
        const double du = p_.number("udelta", 0), dv = p_.number("vdelta", 0);
        if (word == "uv") return {{p_.number("uscale", 1), p_.number("vscale", 1), du, dv}};
        const Imath::M44d from_world = texture_space("");
        if (word == "cylindrical") return {{}, Projection::cylindrical, from_world};
        // The angle from the pole comes first: mirrored and turned by a right angle.
        if (word == "spherical") return {{1, -1, 0, 0, 0, 1}, Projection::spherical, from_world};
        const Imath::V3d v1 = p_.point("v1", {1, 0, 0}), v2 = p_.point("v2", {0, 1, 0});
        const Imath::M44d along(v1.x, v2.x, 0, 0, v1.y, v2.y, 0, 0, v1.z, v2.z, 0, 0, 0, 0, 0, 1);
        return {{1, 1, du, dv}, Projection::planar, from_world * along};
    }
    Imath::M44d texture_space(Key /*to_world*/) override { return to_world_.inverse(); }

    double refractive_index(Key key) override {
        const Parameter* eta = p_.find(key.pbrt, {"float", "integer", "spectrum", "rgb"});
        if (eta == nullptr || (eta->type != "spectrum" && eta->type != "rgb")) return p_.number(key.pbrt, 1.5, kIndex);
        const Rgb n = p_.spectrum(key.pbrt, Rgb(0.0), ColorUse::index);
        if (n.x != n.y || n.x != n.z)
            warn("dispersion", "one refractive index, halfway between red and green, stands for all colours");
        const double middle = (n.x + n.y) / 2;
        if (!(middle >= kIndex.least && middle <= kIndex.most))
            p_.directive().fail(*eta, fmt::format("found {} as '{}', expected an index from {} to {}", middle, key.pbrt,
                                                  kIndex.least, kIndex.most));
        return middle;
    }
    /// A `prefix.roughness`, with `prefix.uroughness` and `prefix.vroughness` in its place.
    Roughness roughness(Key key, RoughnessScale scale, double otherwise) override {
        const std::string name(key.pbrt), prefix = name.substr(0, name.rfind("roughness"));
        FloatTexture both = find_number(name, kRoughness);
        if (!both) both = constant_texture(otherwise);
        FloatTexture x = find_number(prefix + "uroughness", kRoughness);
        FloatTexture y = find_number(prefix + "vroughness", kRoughness);
        if (!x) x = both;
        if (!y) y = both;
        const Roughness rough = p_.boolean("remaproughness", true)
                                    ? Roughness{alpha_texture(x, scale), alpha_texture(y, scale)}
                                    : Roughness{x, y};
        for (const FloatTexture& alpha : {rough.x, rough.y})
            if (alpha->is_constant() && alpha->value({}) > 1)
                warn("roughness",
                     fmt::format("found a '{}' of a surface rougher than alpha 1: it counts as that", name));
        return rough;
    }
    std::vector<MaterialPtr> materials(Key key) override {
        std::vector<MaterialPtr> all;
        if (const Parameter* names = p_.find(key.pbrt, {"string"}))
            for (const std::string& name : names->strings)
                all.push_back(p_.directive().look_up(library_.materials, "material", name).material);
        return all;
    }

    Vec3 position(Key key) override { return Vec3(p_.point(key.pbrt, Imath::V3d(0.0)) * to_world_); }
    Vec3 direction(Key /*along*/, Key from, Key to) override {
        Imath::V3d w;
        to_world_.multDirMatrix(p_.point(to.pbrt, Imath::V3d(0, 0, 1)) - p_.point(from.pbrt, Imath::V3d(0.0)), w);
        if (!(w.length() > 0)) fail("found 'from' and 'to' at one place, expected two");
        return Vec3(w.normalized());
    }
    Vec3 axis(Key key, const Vec3& otherwise) override {
        Imath::V3d w;
        to_world_.multDirMatrix(p_.point(key.pbrt, Imath::V3d(otherwise)), w);
        if (!(w.length() > 0)) fail(fmt::format("found no direction as '{}', expected one with a length", key.pbrt));
        return Vec3(w.normalized());
    }
    /// Without its scale, as directions have none.
    Imath::M33d rotation(Key /*key*/) override {
        Imath::M33d m;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) m[i][j] = to_world_[i][j];
        return m * (1 / std::cbrt(std::abs(m.determinant())));
    }
    /// v3's scale may be a spectrum. A total that is not positive counts as not given, as in pbrt.
    Rgb light(Key amount, Key total, double per_unit) override {
        const Rgb unit = p_.spectrum(amount.pbrt, Rgb(1.0), ColorUse::light);
        const Parameter* scale = p_.find("scale", {"float", "integer", "rgb", "spectrum"});
        const bool colored = scale != nullptr && (scale->type == "rgb" || scale->type == "spectrum");
        const Rgb light = colored ? unit * p_.spectrum("scale", Rgb(1.0), ColorUse::light) * exposure_
                                  : unit * (p_.number("scale", 1, kLight) * exposure_);
        const double target = number(total, {}, -1);
        return target > 0 ? light * (target / per_unit) : light;
    }

    [[noreturn]] void fail(const std::string& message) const override { p_.fail(message); }
    [[noreturn]] void fail_at(Key /*key*/, const std::string& message) override { p_.fail(message); }
    void warn(const std::string& kind, const std::string& message) override { p_.warn(kind, message); }
    void ignore(std::initializer_list<std::string_view> names) override { p_.ignore(names); }

  private:
    ColorTexture find_color(Key key, ColorUse use) {
        if (!has(key)) return nullptr;
        const Parameter* parameter = p_.find(key.pbrt, {"rgb", "spectrum", "texture", "blackbody", "xyz"});
        if (parameter->type != "texture") return constant_texture(p_.spectrum(key.pbrt, Rgb(0.0), use));
        return p_.directive().look_up(library_.colors, "spectrum texture", parameter->strings.front(), *parameter);
    }
    FloatTexture find_number(const std::string& name, const Bounds& bounds) {
        const Parameter* parameter = p_.find(name, {"float", "integer", "texture"});
        if (parameter == nullptr) return nullptr;
        if (parameter->type != "texture") return constant_texture(p_.number(name, 0, bounds));
        return p_.directive().look_up(library_.numbers, "float texture", parameter->strings.front(), *parameter);
    }

    Parameters& p_;
    const Library& library_;
    Transform to_world_;
    double exposure_;
};

/// What the kind of that name makes of `p`.
template <class Made, class Read>
Made read_kind(Parameters& p, std::string_view what, const std::string& name, const std::vector<Kind<Made>>& kinds,
               Read&& read) {
    const Kind<Made>* kind = find_kind(kinds, &Key::pbrt, name);
    if (kind == nullptr)
        p.fail(fmt::format("found the {} '{}', {}", what, name, expected_one_of(name, names_of(kinds, &Key::pbrt))));
    try {
        return read(*kind);
    } catch (const InputError& e) {
        // Those of the thing itself know no position.
        if (std::string_view(e.what()).find(p.directive().position.file) == std::string_view::npos) p.fail(e.what());
        throw;
    }
}

template <class T>
std::shared_ptr<const Texture<T>> read_texture(Parameters& p, const Library& library, const Transform& to_world) {
    PbrtProperties properties(p, library, to_world);
    return read_kind(p, "texture", p.directive().words[2], texture_kinds<T>(),
                     [&](const auto& kind) { return kind.read(properties); });
}

} // namespace

void define_texture(Parameters& p, Library& library, const Transform& to_world) {
    const auto& words = p.directive().words;
    if (words[1] == "float")
        library.numbers[words[0]] = read_texture<double>(p, library, to_world);
    else if (words[1] == "spectrum" || words[1] == "color") // v3
        library.colors[words[0]] = read_texture<Rgb>(p, library, to_world);
    else
        p.fail(fmt::format("found the type '{}' of a texture, expected spectrum or float", words[1]));
    p.warn_of_the_rest();
}

MaterialEntry read_material(const std::string& type, Parameters& p, const Library& library) {
    PbrtProperties properties(p, library);
    const std::string name = type.empty() ? "none" : type;
    MaterialEntry entry;
    entry.material = read_kind(p, "material", name, material_kinds(),
                               [&](const auto& kind) { return keyhole::read_material(kind, properties); });
    entry.is_interface = name == "none" || name == "interface";
    // A mix doesn't tell whether its parts are textured.
    entry.is_textured = name == "mix" || std::ranges::any_of(p.directive().parameters,
                                                             [](const Parameter& q) { return q.type == "texture"; });
    entry.is_textured |= p.has("normalmap");
    p.warn_of_the_rest();
    return entry;
}

void define_material(Parameters& p, Library& library) {
    const Parameter* type = p.find("type", {"string"});
    if (type == nullptr) p.fail("found no 'type', expected the kind of the material");
    library.materials[p.directive().words[0]] = read_material(type->strings.front(), p, library);
}

EmitterPtr read_light(Parameters& p, const Library& library, const Transform& to_world, double exposure) {
    PbrtProperties properties(p, library, to_world, exposure);
    EmitterPtr light = read_kind(p, "light", p.directive().words[0], emitter_kinds(),
                                 [&](const auto& kind) { return kind.read(properties); });
    p.ignore({"samples", "nsamples"});
    p.warn_of_the_rest();
    return light;
}

AreaLight read_area_light(Parameters& p, const Library& library, double exposure) {
    const std::string& kind = p.directive().words[0];
    if (kind != "diffuse" && kind != "area") // the latter: v3
        p.fail(fmt::format("found the area light '{}', expected diffuse", kind));
    PbrtProperties properties(p, library, {}, exposure);
    const AreaLight light = keyhole::read_area_light(properties);
    p.ignore({"samples", "nsamples"});
    p.warn_of_the_rest();
    return light;
}

FloatTexture find_number_texture(Parameters& p, const Library& library, const char* name, const NumberRange& range) {
    return PbrtProperties(p, library).find_number_texture({"", name}, range);
}

} // namespace keyhole::pbrt
