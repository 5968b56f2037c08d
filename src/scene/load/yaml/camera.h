// Film and camera in scene files.
#pragma once

#include "scene/camera.h"
#include "scene/load/yaml/tree.h"

#include <Imath/ImathVec.h>

#include <optional>

namespace keyhole {

/// Keeps pointers to the nodes that it reads. Film and camera, gathered from `film:` and `camera:` sections of which
/// later ones overrule earlier ones key by key.
class CameraReader {
  public:
    /// @throws InputError for mistakes in the section.
    void read_film(const YamlNode& section);
    /// @throws InputError for mistakes in the section.
    void read_camera(const YamlNode& section);

    /// A camera and a film that stand ready, for the sections to overrule.
    void set_base(const CameraParameters& camera, const ImageWindow& window);

    /// What is left of it after the crop.
    ImageWindow window() const;
    /// @throws InputError at the responsible key where the view is degenerate; at `scene` where `from` or `to` is
    /// missing.
    CameraParameters camera(const YamlNode& scene) const;

  private:
    void read_resolution(const YamlNode& node);
    void read_crop(const YamlNode& node);
    CameraParameters uncropped(const YamlNode& scene) const;

    ImageWindow window_{640, 480, 0};
    std::optional<Imath::V3d> from_, to_;
    Imath::V3d up_{0, 1, 0};
    const YamlNode* to_node_ = nullptr; ///< for messages, as the next
    const YamlNode* up_node_ = nullptr;
    std::optional<double> fov_, orthographic_, lens_radius_, focus_distance_;
    std::optional<Imath::V2d> shift_;
    std::optional<CropWindow> crop_;
    const YamlNode* crop_node_ = nullptr;
    bool transparent_ = false;
    std::optional<CameraParameters> base_;
};

} // namespace keyhole
