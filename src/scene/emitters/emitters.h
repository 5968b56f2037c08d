// The emitters there are. World space throughout; lengths in metres.
#pragma once

#include "scene/emitter.h"
#include "scene/emitters/emission_profile.h"
#include "scene/emitters/sphere_map.h"
#include "scene/shape.h"

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace keyhole {

struct LoadedImage;

/// Emission from the surface of `shape`, whose `emission` is set; points are uniform by area, directions follow the
/// power. Of an invisible light no ray finds any. `shape` must outlive the emitter; `index` is its place in the scene.
/// @throws InputError for a shape without area.
std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, std::uint32_t index);

/// Whether an emitter is one that no ray can hit: an invisible light, a point, a single direction. Its light is seen on
/// what scatters it; the eye looks through the lamp itself, in whatever way its paths are made. Where sub-paths from
/// the light are joined to the eye, a point in view would else be a pixel of any brightness, which no walk from the eye
/// finds.
inline bool is_invisible(const Emitter& emitter) { return emitter.is_delta(); }

/// Light from one point, the same in all directions.
/// @param intensity radiant intensity in W/sr; its power is 4 pi times that.
std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Rgb& intensity);

/// Light from one point into a cone, fading towards its edge: between the angles `full` and `edge` from the axis the
/// intensity falls from 1 to 0 with the cosine.
struct SpotParameters {
    Vec3 position{0, 0, 0};
    Vec3 axis{0, 0, -1};      ///< unit; the middle of the cone
    Rgb intensity{1.0};       ///< radiant intensity on the axis, W/sr
    double full_degrees = 25; ///< full intensity up to here; at most `edge_degrees`
    double edge_degrees = 30; ///< dark from here on; above 0, at most 180
    SpotFade fade = SpotFade::smooth;
};

/// Power over intensity on the axis [sr].
double spot_solid_angle(const SpotParameters& parameters);

/// Directions are drawn in proportion to the intensity.
/// @throws InputError for angles out of order.
std::unique_ptr<Emitter> make_spot_emitter(const SpotParameters& parameters);

/// Light from one direction, everywhere alike: the sun.
/// @param w unit direction in which it travels.
/// @param irradiance in W/m^2 on a plane across `w`. Its power is that times the cross-section of the scene's sphere.
/// @param degrees angle across its disc, below 180; 0: one direction only, which no ray can meet. With a disc it is an
/// environment.
std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance, double degrees = 0);

/// The same radiance [W/(m^2 sr)] from every direction; directions are uniform on the sphere.
std::unique_ptr<Emitter> make_constant_environment(const Rgb& radiance);

/// Several environments as one, since a ray that misses everything meets them all: their radiances add up, and
/// directions come from a mixture of their densities by power.
std::unique_ptr<Emitter> make_environment_sum(std::vector<std::unique_ptr<Emitter>> environments);

/// Radiance from each direction.
struct EnvironmentImage {
    int width = 0, height = 0;  ///< an octahedral picture is square
    std::vector<Vec3> radiance; ///< [W/(m^2 sr)] row by row from the top; each pixel is constant
    SphereLayout layout = SphereLayout::lat_long;
    std::shared_ptr<const LoadedImage> file{}; ///< that it comes from, as scenes tell about themselves

    /// Index of the pixel at a place of the picture.
    std::size_t pixel_at(const Vec2d& place) const {
        const auto cell = [](double x, int n) {
            return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
        };
        return cell(place.y, height) * static_cast<std::size_t>(width) + cell(place.x, width);
    }
    /// The place at (u, v) of pixel i, each in [0,1).
    Vec2d place_in(std::size_t i, double u, double v) const {
        const auto row = static_cast<std::size_t>(width);
        return {(static_cast<double>(i % row) + u) / width, (static_cast<double>(i / row) + v) / height};
    }
};

/// Reads the pixels of an image file: floats as radiance, integers as sRGB.
/// @throws InputError for a file that can't be read, and for radiance that is negative or not finite.
EnvironmentImage read_environment_image(const std::string& path, SphereLayout layout);

/// The light of `image` times `scale`. Directions are drawn in proportion to the luminance of the pixels, uniform
/// within one: density and radiance have their steps at the same places.
/// @param to_world turns the directions of the picture into the world's; a rotation, mirrored or not.
/// @throws InputError for a picture that is black or of the wrong shape, and for other transforms.
std::unique_ptr<Emitter> make_image_environment(EnvironmentImage image, const Rgb& scale, const Imath::M33d& to_world);

/// Where a light with a picture stands, and which way the picture lies.
struct PictureFrame {
    Vec3 position{0, 0, 0};
    Imath::M33d to_world{}; ///< a rotation, mirrored or not, for row vectors
};

/// Light from one point with the intensity [W/sr] that `image` times `scale` has in each direction: a luminaire as it
/// was measured. Directions are drawn in proportion to it.
/// @throws InputError for a picture that is black or of the wrong shape, and for other transforms.
std::unique_ptr<Emitter> make_goniometric_emitter(EnvironmentImage image, const PictureFrame& frame, const Rgb& scale);

/// A projector: light from one point with the intensity [W/sr] that `image` times `scale` has where a direction meets
/// its plane, before the light along +z. The first row is up, +y; nothing is cast outside.
/// @param fov_degrees full angle along the picture's shorter side, below 180.
/// @throws InputError as make_goniometric_emitter().
std::unique_ptr<Emitter> make_projection_emitter(EnvironmentImage image, double fov_degrees, const PictureFrame& frame,
                                                 const Rgb& scale);

} // namespace keyhole
