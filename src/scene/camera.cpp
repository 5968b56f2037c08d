#include "scene/camera.h"

#include "scene/warp.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

CameraParameters cropped(CameraParameters camera, const ImageWindow& film, const CropWindow& crop) {
    const int shorter = std::min(film.width, film.height), rest = std::min(crop.x1 - crop.x0, crop.y1 - crop.y0);
    const double half = std::tan(static_cast<double>(camera.fov_degrees) * kPi / 360);
    camera.fov_degrees = static_cast<float>(std::atan(half * rest / shorter) * 360 / kPi);
    const Imath::V2d moved((crop.x0 + crop.x1 - film.width) / 2.0, (film.height - crop.y0 - crop.y1) / 2.0);
    camera.shift = (camera.shift * shorter + moved) / rest;
    return camera;
}

CameraParameters orthographic(CameraParameters camera, double size) {
    const double distance = kOrthographicDistance * size;
    camera.origin -= camera.forward * static_cast<float>(distance);
    camera.near = static_cast<float>(distance);
    camera.fov_degrees = static_cast<float>(std::atan(0.5 / kOrthographicDistance) * 360 / kPi);
    // The cone through a point in focus is as wide as before.
    const double focus = camera.focus_distance;
    camera.lens_radius = static_cast<float>(camera.lens_radius * (distance + focus) / focus);
    camera.focus_distance = static_cast<float>(distance + focus);
    return camera;
}

CameraParameters at_its_plane(CameraParameters camera) {
    if (!(camera.near > 0)) return camera;
    const float focus = camera.focus_distance - camera.near;
    camera.lens_radius *= focus / camera.focus_distance;
    camera.focus_distance = focus;
    camera.origin += camera.forward * camera.near;
    camera.near = 0;
    return camera;
}

Camera::Camera(const CameraParameters& parameters, const ImageWindow& window)
    : parameters_(parameters), window_(window) {
    const double half = std::tan(static_cast<double>(parameters.fov_degrees) * kPi / 360);
    const double pixel = 2 * half / std::min(window.width, window.height); // side of a pixel at distance 1
    half_x_ = pixel * (window.width / 2.0 + window.margin);
    half_y_ = pixel * (window.height / 2.0 + window.margin);
    middle_ = parameters.shift * (2 * half);
}

SurfacePoint Camera::eye(double u0, double u1) const {
    SurfacePoint e;
    e.site = Site::point;
    e.ng = e.ns = parameters_.forward;
    e.p = parameters_.origin;
    e.offset = parameters_.near;
    if (has_lens()) {
        const Vec2 d = uniform_disc(u0, u1) * parameters_.lens_radius;
        const Vec3 across = parameters_.right * d.x + parameters_.up * d.y;
        e.p += across;
        // Rays aslant have farther to go to the plane before which nothing is seen.
        e.offset *= std::hypot(1.0f, across.length() / parameters_.focus_distance);
    }
    return e;
}

double Camera::eye_pdf() const {
    const double r = parameters_.lens_radius;
    return has_lens() ? 1 / (kPi * r * r) : 1.0;
}

Vec3 Camera::ray_direction(const SurfacePoint& eye, const Vec2& image) const {
    const auto x = static_cast<float>((2.0 * image.x - 1) * half_x_ + middle_.x);
    const auto y = static_cast<float>((1 - 2.0 * image.y) * half_y_ + middle_.y);
    const Vec3 through = parameters_.forward + parameters_.right * x + parameters_.up * y;
    if (!has_lens()) return through.normalized();
    return (through * parameters_.focus_distance - (eye.p - parameters_.origin)).normalized();
}

std::optional<Vec2> Camera::image_point(const SurfacePoint& eye, const Vec3& w) const {
    const float c = w.dot(parameters_.forward);
    if (c <= 0) return std::nullopt;
    Vec3 through = w / c; // on the plane at distance 1
    if (has_lens()) through += (eye.p - parameters_.origin) / parameters_.focus_distance;
    const double x = (through.dot(parameters_.right) - middle_.x) / half_x_,
                 y = (through.dot(parameters_.up) - middle_.y) / half_y_;
    if (!(std::abs(x) < 1 && std::abs(y) < 1)) return std::nullopt;
    return Vec2(static_cast<float>((x + 1) / 2), static_cast<float>((1 - y) / 2));
}

double Camera::direction_pdf(const Vec3& w) const {
    const double c = w.dot(parameters_.forward);
    return c > 0 ? 1 / (4 * half_x_ * half_y_ * c * c * c) : 0.0;
}

} // namespace keyhole
