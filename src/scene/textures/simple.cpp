// Textures that need no files.
#include "scene/load/properties.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace keyhole {
namespace {

template <class T> class ConstantTexture final : public Texture<T> {
  public:
    explicit ConstantTexture(const T& value) : value_(value) {}
    T value(const SurfacePoint& /*point*/) const override { return value_; }
    bool is_constant() const override { return true; }

  private:
    T value_;
};

/// pbrt-v3 has 'tex2' for v4's 'scale', and 'tex1' for 'tex'.
template <class T> std::shared_ptr<const Texture<T>> read_scale(Properties& p) {
    const bool v3 = p.has({"", "tex2"});
    auto value = p.operand<T>({"texture", v3 ? "tex1" : "tex"}, 1);
    const Key factor{"factor", v3 ? "tex2" : "scale"};
    p.require(factor);
    return scale_texture<T>(std::move(value), p.number_texture(factor, kFactor, 1));
}

template <class T> std::shared_ptr<const Texture<T>> read_mix(Properties& p) {
    auto a = p.operand<T>({"a", "tex1"}, 0), b = p.operand<T>({"b", "tex2"}, 1);
    return mix_texture<T>(std::move(a), std::move(b), p.number_texture("amount", kShare, 0.5));
}

template <class T> std::shared_ptr<const Texture<T>> read_checkerboard(Properties& p) {
    const double dimension = p.number("dimension", {}, 2);
    if (dimension != 2 && dimension != 3)
        p.fail_at("dimension", fmt::format("found a checkerboard of {} dimensions, expected 2 or 3", dimension));
    p.ignore({"aamode"});
    auto a = p.operand<T>({"a", "tex1"}, 1), b = p.operand<T>({"b", "tex2"}, 0);
    if (dimension == 2) return checkerboard_texture<T>(std::move(a), std::move(b), p.mapping());
    for (const char* key : {"mapping", "repeat", "rotate", "shift"})
        if (p.has({key, ""})) p.fail_at(key, fmt::format("found '{}' beside 3 dimensions, expected 'transform'", key));
    return function_texture<T>([a, b, from_world = p.texture_space("transform")](const SurfacePoint& point) {
        const Imath::V3d place = Imath::V3d(point.p) * from_world;
        const double cubes = std::floor(place.x) + std::floor(place.y) + std::floor(place.z);
        return (std::fmod(cubes, 2) == 0 ? a : b)->value(point);
    });
}

/// |cos| a + (1 - |cos|) b, of the angle between the geometric normal and an axis.
template <class T> std::shared_ptr<const Texture<T>> read_direction_mix(Properties& p) {
    auto a = p.operand<T>({"a", "tex1"}, 0), b = p.operand<T>({"b", "tex2"}, 1);
    const Vec3 axis = p.axis({"direction", "dir"}, {0, 1, 0});
    return function_texture<T>([a, b, axis](const SurfacePoint& point) -> T {
        const double t = std::min(1.0, std::abs(static_cast<double>(point.ng.dot(axis))));
        if (t == 0) return b->value(point);
        if (t == 1) return a->value(point);
        return a->value(point) * t + b->value(point) * (1 - t);
    });
}

/// The finaliser of MurmurHash3.
std::uint64_t scramble(std::uint64_t z) {
    z = (z ^ (z >> 33)) * 0xFF51AFD7ED558CCDULL;
    z = (z ^ (z >> 33)) * 0xC4CEB9FE1A85EC53ULL;
    return z ^ (z >> 33);
}

/// Cells this small can't be seen, and are still some ten times the error of texture coordinates.
constexpr double kCellsPerUv = 65536;

std::uint64_t cell(float x) { return std::bit_cast<std::uint64_t>(std::floor(static_cast<double>(x) * kCellsPerUv)); }

} // namespace

template <class T> TextureKinds<T> simple_kinds() {
    return {{"scale", "a scaled texture", {"texture", "factor"}, read_scale<T>},
            {"mix", "a mix of textures", {"a", "b", "amount"}, read_mix<T>},
            {"checkerboard",
             "a checkerboard",
             {"a", "b", "dimension", "mapping", "transform", "repeat", "rotate", "shift"},
             read_checkerboard<T>},
            {{"direction_mix", "directionmix"}, "a mix by direction", {"a", "b", "direction"}, read_direction_mix<T>},
            {{"", "constant"}, "", {}, [](Properties& p) {
                 return p.operand<T>({"", "value"}, 1);
             }}};
}
template TextureKinds<Rgb> simple_kinds();
template TextureKinds<double> simple_kinds();

Imath::V2d TextureMapping::operator()(const SurfacePoint& point) const {
    if (projection == Projection::uv) return uv(Imath::V2d(point.uv));
    const Imath::V3d p = Imath::V3d(point.p) * from_world;
    if (projection == Projection::planar) return uv({p.x, p.y});
    const double longitude = std::atan2(p.y, p.x); // from -pi to pi
    if (projection == Projection::cylindrical) return uv({(longitude + kPi) / (2 * kPi), p.z});
    const double r = p.length();
    return uv({(longitude < 0 ? longitude + 2 * kPi : longitude) / (2 * kPi),
               r > 0 ? std::acos(std::clamp(p.z / r, -1.0, 1.0)) / kPi : 0.0});
}

ColorTexture constant_texture(const Rgb& value) { return std::make_shared<ConstantTexture<Rgb>>(value); }
FloatTexture constant_texture(double value) { return std::make_shared<ConstantTexture<double>>(value); }

template <class T>
std::shared_ptr<const Texture<T>> scale_texture(std::shared_ptr<const Texture<T>> value, FloatTexture factor) {
    return function_texture<T>(
        [value, factor](const SurfacePoint& point) { return value->value(point) * factor->value(point); }, value,
        factor);
}

template <class T>
std::shared_ptr<const Texture<T>> mix_texture(std::shared_ptr<const Texture<T>> a, std::shared_ptr<const Texture<T>> b,
                                              FloatTexture amount) {
    const auto mixed = [a, b, amount](const SurfacePoint& point) -> T {
        const double t = std::clamp(amount->value(point), 0.0, 1.0);
        if (t == 0) return a->value(point);
        if (t == 1) return b->value(point);
        return a->value(point) * (1 - t) + b->value(point) * t;
    };
    return function_texture<T>(mixed, a, b, amount);
}

template <class T>
std::shared_ptr<const Texture<T>> checkerboard_texture(std::shared_ptr<const Texture<T>> a,
                                                       std::shared_ptr<const Texture<T>> b,
                                                       const TextureMapping& mapping) {
    return function_texture<T>([a, b, mapping](const SurfacePoint& point) {
        const Imath::V2d place = mapping(point);
        const double squares = std::floor(place.x) + std::floor(place.y);
        return (std::fmod(squares, 2) == 0 ? a : b)->value(point);
    });
}

template ColorTexture scale_texture<Rgb>(ColorTexture, FloatTexture);
template FloatTexture scale_texture<double>(FloatTexture, FloatTexture);
template ColorTexture mix_texture<Rgb>(ColorTexture, ColorTexture, FloatTexture);
template FloatTexture mix_texture<double>(FloatTexture, FloatTexture, FloatTexture);
template ColorTexture checkerboard_texture<Rgb>(ColorTexture, ColorTexture, const TextureMapping&);
template FloatTexture checkerboard_texture<double>(FloatTexture, FloatTexture, const TextureMapping&);

double place_hash(const SurfacePoint& point, std::uint32_t salt) {
    const std::uint64_t surface = (static_cast<std::uint64_t>(point.shape) << 32) | point.primitive;
    const std::uint64_t u = scramble(cell(point.uv.x) + 0x9E3779B97F4A7C15ULL * (salt + 1));
    const std::uint64_t v = scramble(cell(point.uv.y) + u);
    return static_cast<double>(scramble(surface + v) >> 11) * 0x1p-53;
}

bool is_opaque(const FloatTexture& alpha, const SurfacePoint& point) {
    if (alpha == nullptr) return true;
    const double a = alpha->value(point);
    // Most pictures of leaves are 0 or 1 but for rounding.
    constexpr double kRounding = 0.5 / 65536;
    if (a >= 1 - kRounding) return true;
    return a > kRounding && place_hash(point, 0) < a;
}

} // namespace keyhole
