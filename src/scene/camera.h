// The camera: maps points of the image window to rays, and back.
#pragma once

#include "core/vec.h"
#include "scene/surface_point.h"

#include <Imath/ImathVec.h>

#include <optional>

namespace keyhole {

/// The film's pixels, and the window around them that paths are sampled in. The window is a little wider than the film,
/// so that reconstruction and photon lookups at its border see what lies beyond.
struct ImageWindow {
    int width = 1, height = 1; ///< pixels of the film
    float margin = 0;          ///< pixels by which the window exceeds the film on each side

    /// Window coordinates [0,1)^2 (y down) to pixel coordinates; the film is [0,width) x [0,height).
    Vec2 to_pixel(const Vec2& p) const {
        return {p.x * (static_cast<float>(width) + 2 * margin) - margin,
                p.y * (static_cast<float>(height) + 2 * margin) - margin};
    }
    Vec2 to_window(const Vec2& pixel) const {
        return {(pixel.x + margin) / (static_cast<float>(width) + 2 * margin),
                (pixel.y + margin) / (static_cast<float>(height) + 2 * margin)};
    }
    double size() const { return static_cast<double>(width) * height; } ///< pixels of the film
    /// Window area in pixels; a mean over the window times this is a sum over pixels.
    double pixels() const {
        return (static_cast<double>(width) + 2.0 * margin) * (static_cast<double>(height) + 2.0 * margin);
    }
};

/// What a camera is made from.
struct CameraParameters {
    Vec3 origin{0, 0, 0};
    Vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}; ///< unit and perpendicular; right may be mirrored
    float fov_degrees = 40;                              ///< full angle along the shorter side of the film
    float lens_radius = 0;                               ///< 0: pinhole
    float focus_distance = 1;                            ///< distance of the plane in focus, along `forward`
    /// Where the middle of the picture is off `forward`, to the right and up, over the film's shorter side.
    Imath::V2d shift{0, 0};
    float near = 0; ///< distance from `origin` within which nothing is seen
    bool sees_surroundings =
        true; ///< the environment, where nothing is before it; by way of surfaces it is seen anyway
};

/// Distance from which an orthographic camera looks, over the shorter side of what it sees.
constexpr double kOrthographicDistance = 1000;

/// The camera in the place of an orthographic one whose plane goes through the origin of `camera` and sees `size`
/// metres along the film's shorter side: a pinhole so far behind the plane that lines of sight are parallel within
/// 0.0005, and that sees nothing before the plane. Depths of as much as `size` change lengths by a thousandth. Lens and
/// focus distance of `camera` are meant in its plane and from there: at a distance d, things that are f = focus
/// distance away in focus, a point is a disc of radius |1 - d / f| times that of the lens.
CameraParameters orthographic(CameraParameters camera, double size);

/// What orthographic() was given for such a camera; others as they are.
CameraParameters at_its_plane(CameraParameters camera);

/// Pixels of a film: columns [x0, x1) and rows [y0, y1), from the top.
struct CropWindow {
    int x0, y0, x1, y1;
};

/// What a camera on `film` sees through `crop`, which becomes the film.
CameraParameters cropped(CameraParameters camera, const ImageWindow& film, const CropWindow& crop);

/// Pinhole or thin-lens camera. The image measure is uniform on the window: the importance of every point of the
/// window is 1, so that the mean over the window is the measurement.
class Camera {
  public:
    Camera() = default;
    Camera(const CameraParameters& parameters, const ImageWindow& window);

    const ImageWindow& window() const { return window_; }
    const CameraParameters& parameters() const { return parameters_; }
    bool has_lens() const { return parameters_.lens_radius > 0; }

    /// The eye vertex: the pinhole, or a point on the lens, uniform by area, from two numbers in [0,1).
    SurfacePoint eye(double u0, double u1) const;
    /// Density of eye() per lens area [1/m^2]; 1 for a pinhole.
    double eye_pdf() const;

    /// Direction from the eye vertex through window point `image`. The window may be left a little: it is no bound.
    Vec3 ray_direction(const SurfacePoint& eye, const Vec2& image) const;

    /// Window point that the eye sees along unit direction `w`; none behind the eye or outside the window.
    std::optional<Vec2> image_point(const SurfacePoint& eye, const Vec3& w) const;

    /// Density per solid angle of `w` at the eye when the window point is uniform; 0 behind the eye.
    double direction_pdf(const Vec3& w) const;

  private:
    CameraParameters parameters_;
    ImageWindow window_;
    double half_x_ = 1, half_y_ = 1; // half extent of the window on the plane at distance 1
    Imath::V2d middle_{0, 0};        // of the window, there
};

} // namespace keyhole
