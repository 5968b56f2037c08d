// What stands in the scene of a glTF file beside its meshes.
#pragma once

#include "scene/camera.h"
#include "scene/emitter.h"
#include "scene/load/gltf/document.h"

#include <memory>
#include <optional>
#include <vector>

namespace keyhole::gltf {

struct View {
    CameraParameters camera;
    ImageWindow window;
};

struct LightsAndCamera {
    std::vector<std::unique_ptr<Emitter>> emitters; ///< of KHR_lights_punctual
    std::optional<View> view;                       ///< of the first camera
};

/// Walks the default scene.
LightsAndCamera read_nodes(const Document& document);

} // namespace keyhole::gltf
