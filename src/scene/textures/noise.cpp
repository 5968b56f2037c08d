// Textures from gradient noise in space: Perlin, "Improving Noise", SIGGRAPH 2002; sums of octaves as in pbrt-v4's.
#include "scene/load/properties.h"
#include "scene/textures/function_texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace keyhole {
namespace {

/// Perlin's permutation of 0 to 255.
constexpr std::array<std::uint8_t, 256> kPermutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

/// The dot product of (x, y, z) with one of the edges' directions of a cube, which the corner (i, j, k) chooses.
double gradient(std::int64_t i, std::int64_t j, std::int64_t k, double x, double y, double z) {
    const auto permuted = [](std::int64_t n) { return std::int64_t{kPermutation[static_cast<std::size_t>(n & 255)]}; };
    const std::int64_t h = permuted(permuted(permuted(i) + j) + k) & 15;
    const double u = h < 8 || h == 12 || h == 13 ? x : y; // 12 to 15: those of pbrt, not of Perlin
    const double v = h < 4 || h == 12 || h == 13 ? y : z;
    return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

double noise(const Imath::V3d& p) {
    const auto split = [](double x, std::int64_t& cell) {
        const double floor = std::floor(std::fmod(x, 0x1p30));
        cell = static_cast<std::int64_t>(floor);
        return std::fmod(x, 0x1p30) - floor;
    };
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    std::int64_t i = 0, j = 0, k = 0;
    const double x = split(p.x, i), y = split(p.y, j), z = split(p.z, k);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int a = corner & 1, b = (corner >> 1) & 1, c = corner >> 2;
        const double weight =
            (a != 0 ? fade(x) : 1 - fade(x)) * (b != 0 ? fade(y) : 1 - fade(y)) * (c != 0 ? fade(z) : 1 - fade(z));
        sum += weight * gradient(i + a, j + b, k + c, x - a, y - b, z - c);
    }
    return sum;
}

struct Octaves {
    int count = 8;
    double roughness = 0.5; ///< of each octave over the last
};

/// Not filtered: octaves finer than a pixel are left to its samples.
template <class F> double sum_of_octaves(Imath::V3d p, const Octaves& octaves, const F& f) {
    double sum = 0, amplitude = 1;
    for (int i = 0; i < octaves.count; ++i, p *= 1.99, amplitude *= octaves.roughness) sum += amplitude * f(noise(p));
    return sum;
}
double fractal_noise(const Imath::V3d& p, const Octaves& octaves) {
    return sum_of_octaves(p, octaves, [](double n) { return n; });
}

/// Waves on water in a wind of varying strength.
double waves(const Imath::V3d& p) { return std::abs(fractal_noise(p * 0.1, {3, 0.5})) * fractal_noise(p, {6, 0.5}); }

/// Stripes along y, bent by noise; colours along a spline.
Rgb marble(Imath::V3d p, const Octaves& octaves, double scale, double variation) {
    static const Rgb base(0.58, 0.58, 0.6);
    static const std::array<Rgb, 9> colors{
        base, base, base, Rgb(0.5), Rgb(0.6, 0.59, 0.58), base, base, Rgb(0.2, 0.2, 0.33), base};
    constexpr int kSegments = static_cast<int>(colors.size()) - 3;
    p *= scale;
    const double wave = std::sin(p.y + variation * fractal_noise(p, octaves));
    const double t = std::isfinite(wave) ? 0.5 + 0.5 * wave : 0.5; // noise beyond all numbers
    const int first = std::clamp(static_cast<int>(t * kSegments), 0, kSegments - 1);
    const double s = t * kSegments - first, r = 1 - s;
    const auto at = [&](int i) { return colors[static_cast<std::size_t>(first + i)]; };
    return (at(0) * (r * r * r) + at(1) * (3 * r * r * s) + at(2) * (3 * r * s * s) + at(3) * (s * s * s)) * 1.5;
}

/// A value that is a function of the place in the space of the texture.
template <class T, class F> std::shared_ptr<const Texture<T>> solid(Properties& p, F f) {
    return function_texture<T>([f, from_world = p.texture_space("transform")](const SurfacePoint& point) {
        return T(f(Imath::V3d(point.p) * from_world));
    });
}

Octaves read_octaves(Properties& p) {
    constexpr NumberRange kCount{"a number of octaves", 1, 64};
    Octaves o;
    o.count = static_cast<int>(p.number("octaves", kCount, o.count));
    o.roughness = p.number("roughness", kFactor, o.roughness);
    return o;
}

template <class T> std::shared_ptr<const Texture<T>> read_fractal(Properties& p) {
    return solid<T>(p, [o = read_octaves(p)](const Imath::V3d& x) { return fractal_noise(x, o); });
}
template <class T> std::shared_ptr<const Texture<T>> read_wrinkled(Properties& p) {
    return solid<T>(p, [o = read_octaves(p)](const Imath::V3d& x) {
        return sum_of_octaves(x, o, [](double n) { return std::abs(n); });
    });
}
template <class T> std::shared_ptr<const Texture<T>> read_windy(Properties& p) {
    return solid<T>(p, [](const Imath::V3d& x) { return waves(x); });
}
template <class T> std::shared_ptr<const Texture<T>> read_marble(Properties& p) {
    const Octaves o = read_octaves(p);
    const double scale = p.number("scale", kFactor, 1), variation = p.number("variation", kFactor, 0.2);
    return solid<T>(p, [=](const Imath::V3d& x) {
        const Rgb color = marble(x, o, scale, variation);
        if constexpr (std::is_same_v<T, Rgb>)
            return color;
        else
            return (color.x + color.y + color.z) / 3;
    });
}

} // namespace

template <class T> TextureKinds<T> noise_kinds() {
    return {{"fbm", "fractal noise", {"octaves", "roughness", "transform"}, read_fractal<T>},
            {"wrinkled", "wrinkles", {"octaves", "roughness", "transform"}, read_wrinkled<T>},
            {"windy", "waves", {"transform"}, read_windy<T>},
            {"marble", "marble", {"octaves", "roughness", "scale", "variation", "transform"}, read_marble<T>}};
}
template TextureKinds<Rgb> noise_kinds();
template TextureKinds<double> noise_kinds();

} // namespace keyhole
