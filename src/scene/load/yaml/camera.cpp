#include "scene/load/yaml/camera.h"

#include "scene/load/yaml/reader.h"

#include <fmt/format.h>

namespace keyhole {

void CameraReader::read_film(const YamlNode& section) {
    const MapReader map(section, "a film", {"resolution", "crop", "transparent"});
    if (const YamlNode* resolution = map.find("resolution")) read_resolution(*resolution);
    if (const YamlNode* crop = map.find("crop")) read_crop(*crop);
    transparent_ = map.boolean("transparent", transparent_);
}

void CameraReader::read_resolution(const YamlNode& node) {
    constexpr NumberRange kPixels{"a number of pixels", 1, 65536};
    if (node.kind != YamlNode::Kind::list || node.items.size() != 2) fail_expected(node, "[width, height] in pixels");
    const auto width = read_integer(*node.items[0], kPixels), height = read_integer(*node.items[1], kPixels);
    constexpr std::int64_t kMost = std::int64_t{1} << 28;
    if (width * height > kMost) fail(node, fmt::format("found {} pixels, expected at most {}", width * height, kMost));
    window_.width = static_cast<int>(width);
    window_.height = static_cast<int>(height);
}

void CameraReader::read_crop(const YamlNode& node) {
    if (node.kind != YamlNode::Kind::list || node.items.size() != 4)
        fail_expected(node, "[left, top, right, bottom] in pixels");
    constexpr NumberRange kPixel{"a pixel", 0, 65536};
    const auto at = [&](std::size_t i) { return static_cast<int>(read_integer(*node.items[i], kPixel)); };
    crop_ = CropWindow{at(0), at(1), at(2), at(3)};
    crop_node_ = &node;
}

ImageWindow CameraReader::window() const {
    if (!crop_) return window_;
    return {crop_->x1 - crop_->x0, crop_->y1 - crop_->y0, window_.margin};
}

void CameraReader::read_camera(const YamlNode& section) {
    constexpr NumberRange kFov{"a field of view in degrees", 0.001, 179};
    constexpr NumberRange kLens{"a radius", 0, 1e12};
    const MapReader map(section, "a camera",
                        {"from", "to", "up", "fov", "orthographic", "shift", "lens_radius", "focus_distance"});
    if (const YamlNode* from = map.find("from")) from_ = read_vec3(*from, kCoordinate);
    if (const YamlNode* to = map.find("to")) to_ = read_vec3(*(to_node_ = to), kCoordinate);
    if (const YamlNode* up = map.find("up")) {
        up_ = read_vec3(*(up_node_ = up), kCoordinate);
        if (!(up_.length() > 0)) fail(*up, "found the direction [0, 0, 0], expected one with a length");
    }
    if (const YamlNode* fov = map.find("fov")) fov_ = read_number(*fov, kFov);
    if (const YamlNode* size = map.find("orthographic")) {
        if (const YamlNode* fov = map.find("fov"))
            fail(*fov, "found 'fov' beside 'orthographic', expected one of them");
        orthographic_ = read_number(*size, {"a length", 1e-9, 1e9});
        fov_.reset();
    } else if (fov_ && map.find("fov") != nullptr) {
        orthographic_.reset();
    }
    if (const YamlNode* shift = map.find("shift")) {
        const auto xy = read_numbers(*shift, 2, {"a shift", -100, 100});
        shift_ = Imath::V2d(xy[0], xy[1]);
    }
    if (const YamlNode* lens = map.find("lens_radius")) lens_radius_ = read_number(*lens, kLens);
    if (const YamlNode* focus = map.find("focus_distance")) focus_distance_ = read_number(*focus, kLength);
}

void CameraReader::set_base(const CameraParameters& camera, const ImageWindow& window) {
    base_ = camera;
    window_ = window;
    from_.reset();
    to_.reset();
    fov_.reset();
    orthographic_.reset();
    lens_radius_.reset();
    focus_distance_.reset();
    shift_.reset();
    crop_.reset();
}

CameraParameters CameraReader::camera(const YamlNode& scene) const {
    CameraParameters all = uncropped(scene);
    all.sees_surroundings = all.sees_surroundings && !transparent_;
    if (!crop_) return all;
    const CropWindow& c = *crop_;
    if (!(c.x0 < c.x1 && c.y0 < c.y1 && c.x1 <= window_.width && c.y1 <= window_.height))
        fail(*crop_node_, fmt::format("found a crop from ({}, {}) to ({}, {}), expected pixels of a film of {} x {}",
                                      c.x0, c.y0, c.x1, c.y1, window_.width, window_.height));
    return cropped(all, window_, c);
}

CameraParameters CameraReader::uncropped(const YamlNode& scene) const {
    CameraParameters camera = base_.value_or(CameraParameters{});
    std::optional<double> size = orthographic_;
    if (!size && !fov_ && camera.near > 0) size = static_cast<double>(camera.near) / kOrthographicDistance;
    camera = at_its_plane(camera);
    const auto finished = [&] { return size ? orthographic(camera, *size) : camera; };
    if (fov_) camera.fov_degrees = static_cast<float>(*fov_);
    if (lens_radius_) camera.lens_radius = static_cast<float>(*lens_radius_);
    if (focus_distance_) camera.focus_distance = static_cast<float>(*focus_distance_);
    if (shift_) camera.shift = *shift_;
    if (base_ && !from_ && !to_) return finished();
    if (!from_ || !to_)
        fail(scene, fmt::format("found no '{}' of the camera, expected camera: {{from: [x, y, z], to: [x, y, z]}}",
                                from_ ? "to" : "from"));
    const Imath::V3d view = *to_ - *from_;
    if (!(view.length() > 1e-9 * (from_->length() + to_->length()))) // the difference must survive in floats, too
        fail(*to_node_, "found 'from' and 'to' at one place, expected two");
    const Imath::V3d forward = view.normalized(), right = forward.cross(up_.normalized());
    if (!(right.length() > 1e-6))
        fail(up_node_ != nullptr ? *up_node_ : *to_node_, "found 'up' along the view, expected another direction");
    camera.origin = Vec3(*from_);
    camera.forward = Vec3(forward);
    camera.right = Vec3(right.normalized());
    camera.up = Vec3(right.normalized().cross(forward));
    if (!focus_distance_) camera.focus_distance = static_cast<float>(view.length());
    return finished();
}

} // namespace keyhole
