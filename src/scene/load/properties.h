// What a scene file says of one material, emitter or texture, whatever the format of the file. The source file that
// owns a kind reads its values by their names in either format, and says where the formats differ by design.
#pragma once

#include "core/error.h"
#include "scene/emitter.h"
#include "scene/shape.h"

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// Numbers allowed at a place, and what a number there is called in messages, with its article.
struct NumberRange {
    std::string_view what = "a number";
    double minimum = -std::numeric_limits<double>::max();
    double maximum = std::numeric_limits<double>::max();
    bool above_minimum = false; ///< the minimum itself is out
    bool below_maximum = false; ///< the maximum itself is out
};

/// Keeps cubes of lengths within a float.
constexpr NumberRange kCoordinate{"a coordinate", -1e12, 1e12};
constexpr NumberRange kLength{"a length", 1e-12, 1e12};
constexpr NumberRange kReflectance{"a reflectance", 0, 1};
constexpr NumberRange kShare{"a share", 0, 1};
constexpr NumberRange kNormal{"a coordinate of a normal map", 0, 1};
constexpr NumberRange kNotNegative{"a number", 0, 1e12};
constexpr NumberRange kFactor{"a factor", -1e12, 1e12};
constexpr NumberRange kLight{"an amount of light", 0, 1e30};

/// Name of a value or of a kind in our scene files and in pbrt's; empty: the format has none.
struct Key {
    constexpr Key(const char* both) : yaml(both), pbrt(both) {}
    constexpr Key(const char* in_yaml, const char* in_pbrt) : yaml(in_yaml), pbrt(in_pbrt) {}

    std::string_view yaml, pbrt;
};

/// What a colour stands for decides how a spectrum becomes three numbers.
enum class ColorUse {
    reflectance, ///< as seen under daylight (D65), from 0 to 1
    light,       ///< its colour, with luminance 1 as pbrt-v4 scales every light that isn't given as RGB
    index,       ///< refractive index or absorption: its value at the wavelengths of the primaries
};

/// GGX alphas along the tangent and across it.
struct Roughness {
    FloatTexture x, y;
};

/// How a roughness in pbrt's files becomes an alpha, unless they say that it is one.
enum class RoughnessScale { pbrt_v3, pbrt_v4 };

/// Values by their names. What is not given is `otherwise`. All functions throw InputError, with the position of the
/// value, where it is of the wrong type or out of range. Ranges are those of our files: pbrt's allow what pbrt does.
class Properties {
  public:
    virtual ~Properties() = default;

    virtual bool is_pbrt() const = 0;
    virtual bool has(Key key) = 0;
    /// Our files must give this; those of pbrt, which has a default for everything, need not.
    virtual void require(Key key) = 0;

    virtual double number(Key key, const NumberRange& range, double otherwise) = 0;
    virtual bool boolean(Key key, bool otherwise) = 0;
    /// One of `choices`, the first of which is the default; `what` it is, as in "a filter".
    virtual std::string choice(Key key, std::string_view what, const std::vector<std::string_view>& choices) = 0;
    /// A word that stands for itself; empty where it is not given.
    virtual std::string word(Key key) = 0;
    /// A file that must be named, relative to the one that names it; `what` it holds, as in "an image".
    virtual std::string path(Key key, std::string_view what) = 0;
    virtual Rgb color(Key key, ColorUse use, const NumberRange& range, const Rgb& otherwise) = 0;

    /// Null where it is not given.
    virtual FloatTexture find_number_texture(Key key, const NumberRange& range) = 0;
    virtual ColorTexture find_color_texture(Key key, const NumberRange& range) = 0;
    /// Of coefficients of media, which may be above 1; null where it is not given. Our files have none.
    virtual ColorTexture find_unbounded_texture(Key /*key*/) { return nullptr; }
    FloatTexture number_texture(Key key, const NumberRange& range, double otherwise) {
        FloatTexture texture = find_number_texture(key, range);
        return texture ? texture : constant_texture(otherwise);
    }
    ColorTexture color_texture(Key key, double otherwise, const NumberRange& range = kReflectance) {
        ColorTexture texture = find_color_texture(key, range);
        return texture ? texture : constant_texture(Rgb(otherwise));
    }
    /// A texture that one of the same type is made from, within the range of that.
    template <class T> std::shared_ptr<const Texture<T>> operand(Key key, double otherwise) {
        require(key);
        if constexpr (std::is_same_v<T, Rgb>)
            return color_texture(key, otherwise, operand_range());
        else
            return number_texture(key, operand_range(), otherwise);
    }
    virtual TextureMapping mapping() = 0;
    /// From the world to the space of a texture, which `to_world` places there in our files, and in pbrt's the current
    /// transform.
    virtual Imath::M44d texture_space(Key to_world) = 0;
    /// Whether a texture that is read stands for directions, as kNormal says: integers are linear then.
    bool is_normal() const { return operand_range().what == kNormal.what; }

    virtual double refractive_index(Key key) = 0;
    /// A number or texture for both directions, or one for each.
    virtual Roughness roughness(Key key, RoughnessScale scale = RoughnessScale::pbrt_v4, double otherwise = 0) = 0;
    /// The materials that are named, or in our files described in place.
    virtual std::vector<MaterialPtr> materials(Key key) = 0;

    /// World space.
    virtual Vec3 position(Key key) = 0;
    /// Unit direction in world space, given as such, or by two places.
    virtual Vec3 direction(Key along, Key from, Key to) = 0;
    /// Unit vector in world space.
    virtual Vec3 axis(Key key, const Vec3& otherwise) = 0;
    /// Turns directions of a picture into the world's.
    virtual Imath::M33d rotation(Key key) = 0;
    /// An amount of light, as such or by a total that is `per_unit` times that, as power is 4 pi times the intensity of
    /// a point. In pbrt's files the total scales the colour.
    virtual Rgb light(Key amount, Key total, double per_unit) = 0;

    [[noreturn]] virtual void fail(const std::string& message) const = 0;
    /// With the position of a value.
    [[noreturn]] virtual void fail_at(Key key, const std::string& message) = 0;
    /// Calls `make`, whose errors know no position: they get that of `key`.
    template <class Make> auto make_at(Key key, Make&& make) -> decltype(make()) {
        try {
            return make();
        } catch (const InputError& e) {
            fail_at(key, e.what());
            throw; // not reached, which the compiler does not see
        }
    }
    /// Warns once for each `kind`. Only what other programs wrote is read otherwise than it was meant.
    virtual void warn(const std::string& /*kind*/, const std::string& /*message*/) {}
    /// pbrt's names that change nothing here, and are no mistake.
    virtual void ignore(std::initializer_list<std::string_view> /*names*/) {}

  protected:
    virtual NumberRange operand_range() const { return {}; }
};

/// A kind of material, emitter or texture, as its owner lists it.
template <class Made> struct Kind {
    Key name;                           ///< of the type, in both formats
    std::string_view what;              ///< in messages, with its article
    std::vector<std::string_view> keys; ///< that our scene files may give, in the order of messages
    Made (*read)(Properties&);
};
using EmitterPtr = std::unique_ptr<Emitter>; // null for one that is black
using MaterialKinds = std::vector<Kind<MaterialPtr>>;
using EmitterKinds = std::vector<Kind<EmitterPtr>>;
template <class T> using TextureKinds = std::vector<Kind<std::shared_ptr<const Texture<T>>>>;

// All kinds: each folder's kinds.cpp lists its files.
const MaterialKinds& material_kinds();
const EmitterKinds& emitter_kinds();
template <class T> const TextureKinds<T>& texture_kinds();

/// Lists one behind the other.
template <class Made> std::vector<Kind<Made>> joined(std::initializer_list<std::vector<Kind<Made>>> lists) {
    std::vector<Kind<Made>> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

/// Names in one format, `&Key::yaml` or `&Key::pbrt`.
template <class Made>
std::vector<std::string_view> names_of(const std::vector<Kind<Made>>& kinds, std::string_view Key::*format) {
    std::vector<std::string_view> names;
    for (const auto& kind : kinds)
        if (!(kind.name.*format).empty()) names.push_back(kind.name.*format);
    std::ranges::sort(names);
    return names;
}
/// The kind of that name; null: there is none.
template <class Made>
const Kind<Made>* find_kind(const std::vector<Kind<Made>>& kinds, std::string_view Key::*format,
                            std::string_view name) {
    const auto found = std::ranges::find_if(kinds, [&](const auto& kind) { return kind.name.*format == name; });
    return found != kinds.end() && !name.empty() ? &*found : nullptr;
}

/// A material with the bumps that each may have.
MaterialPtr read_material(const Kind<MaterialPtr>& kind, Properties& p);

/// What an area light says of the shapes that have it.
struct AreaLight {
    Rgb radiance{0.0}; ///< [W/(m^2 sr)]; where power is given its colour
    bool two_sided = false;
    double power = 0;       ///< [W], factor on that colour; 0: radiance says it all
    ColorTexture picture{}; ///< factor on the radiance; null: 1
    EmissionProfile profile{};
};
AreaLight read_area_light(Properties& p);
/// Of a shape with that area; null where nothing is emitted.
std::unique_ptr<SurfaceEmission> emission_of(const AreaLight& light, double area);

} // namespace keyhole
