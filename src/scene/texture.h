// Textures: values that vary over a surface.
#pragma once

#include "core/vec.h"
#include "scene/surface_point.h"

#include <Imath/ImathMatrix.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace keyhole {

// Where in a texture a point of a surface lies.

/// Scales texture coordinates, then turns them about the origin, then shifts them.
struct UvMapping {
    double su = 1, sv = 1, du = 0, dv = 0;
    double cosine = 1, sine = 0; ///< of the turn, anticlockwise where u is right and v is up

    Imath::V2d operator()(const Imath::V2d& uv) const {
        const double u = su * uv.x, v = sv * uv.y;
        return {cosine * u - sine * v + du, sine * u + cosine * v + dv};
    }
};

/// What texture coordinates are taken from, with (x, y, z) the place in the space of the texture.
enum class Projection {
    uv,          ///< the parametrisation of the shape
    planar,      ///< (x, y)
    spherical,   ///< longitude about z from +x over 2 pi, and angle from +z over pi, as on spheres
    cylindrical, ///< longitude about z from -x over 2 pi, and z
};

struct TextureMapping {
    UvMapping uv{};
    Projection projection = Projection::uv;
    Imath::M44d from_world{}; ///< to the space of the texture, for row vectors

    Imath::V2d operator()(const SurfacePoint& point) const;
};

/// Immutable and thread-safe.
template <class T> class Texture {
  public:
    virtual ~Texture() = default;
    virtual T value(const SurfacePoint& point) const = 0;
    /// True where value() is the same everywhere.
    virtual bool is_constant() const { return false; }
};

using ColorTexture = std::shared_ptr<const Texture<Rgb>>;
using FloatTexture = std::shared_ptr<const Texture<double>>;

ColorTexture constant_texture(const Rgb& value);
FloatTexture constant_texture(double value);

/// What stands in an image file.
enum class Encoding {
    automatic, ///< sRGB for integers, linear for floats
    linear,
    srgb,
    gamma, ///< value^gamma
};

/// What lies outside [0,1]^2 of an image.
enum class Wrap { repeat, black, clamp };

enum class Filter { bilinear, nearest };

struct ImageOptions {
    Encoding encoding = Encoding::automatic; ///< floats are linear whatever this says
    double gamma = 2.2;                      ///< for Encoding::gamma
    Wrap wrap = Wrap::repeat;
    Filter filter = Filter::bilinear;
    double scale = 1;    ///< factor on the value
    bool invert = false; ///< 1 - value, after the scale
    int channel = -1;    ///< of three, the one that is the value; 3: alpha, always linear; -1: the mean of the three
    TextureMapping mapping{};
};

/// A picture, its first row at v = 1. The mean of the channels, or one of them, where T is double. A file named several
/// times is decoded and kept once: 1 byte a channel for 8-bit files, 2 for 16-bit ones, 4 for floats, alpha apart.
/// @throws InputError for a file that can't be read.
template <class T>
std::shared_ptr<const Texture<T>> image_texture(const std::string& path, const ImageOptions& options);

/// value times factor.
template <class T>
std::shared_ptr<const Texture<T>> scale_texture(std::shared_ptr<const Texture<T>> value, FloatTexture factor);

/// (1 - amount) a + amount b.
template <class T>
std::shared_ptr<const Texture<T>> mix_texture(std::shared_ptr<const Texture<T>> a, std::shared_ptr<const Texture<T>> b,
                                              FloatTexture amount);

/// Unit squares of `a` (that at the origin) and `b` in turn.
template <class T>
std::shared_ptr<const Texture<T>> checkerboard_texture(std::shared_ptr<const Texture<T>> a,
                                                       std::shared_ptr<const Texture<T>> b,
                                                       const TextureMapping& mapping);

/// An image in memory, for what a scene tells about itself.
struct LoadedImage {
    std::string path;
    int width = 0, height = 0, channels = 0;
    std::size_t bytes = 0;
    std::uint64_t hash = 0; ///< of what it shows
};

/// The images that textures hold at the moment, by path.
std::vector<LoadedImage> loaded_images();
/// Gives an image whose file lasts no longer than loading another name than its path.
void name_image(const std::string& path, const std::string& name);

/// The pictures that emitters hold at the moment: those that note_picture() returned and somebody keeps.
std::vector<LoadedImage> loaded_pictures();
std::shared_ptr<const LoadedImage> note_picture(LoadedImage picture);

/// A number in [0,1) that belongs to a place: the same however a ray came there, unrelated to that of places more than
/// about 2^-16 in texture coordinates away, and to that of the same place for another `salt`.
double place_hash(const SurfacePoint& point, std::uint32_t salt);

/// Whether a surface with opacity `alpha` (null: opaque) is there at `point`, whose shape and primitive are filled in.
/// Below 0.5/65536 never, above its complement always; in between as a fine screen with that share of matter, which
/// looks the same from every ray.
bool is_opaque(const FloatTexture& alpha, const SurfacePoint& point);

} // namespace keyhole
