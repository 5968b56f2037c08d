// Camera, film, sampler and integrator of pbrt's format.
#pragma once

#include "core/settings.h"
#include "scene/camera.h"
#include "scene/load/load_mesh.h"
#include "scene/load/pbrt/syntax/parameters.h"

#include <optional>

namespace keyhole::pbrt {

/// What a picture is taken with.
struct View {
    CameraParameters camera;
    ImageWindow window;
    std::optional<CropWindow> crop{}; ///< of the film; taken out by read_camera()
    double exposure = 1;              ///< factor on all light: shutter time times ISO speed over 100
};

/// Reads a `Film` directive.
/// @throws InputError for impossible sizes.
void read_film(Parameters& parameters, View& view);

/// Reads a `Camera` directive, the film being known.
/// @param camera_to_world the inverse of the transform that stands when the camera is named.
/// @throws InputError for kinds other than perspective, for transforms that stretch, and for windows that have oblong
/// pixels.
void read_camera(Parameters& parameters, const Transform& camera_to_world, View& view);

/// Samples per pixel.
void read_sampler(Parameters& parameters, Settings& settings);
/// The most scatterings of a path; pbrt counts them as we do.
void read_integrator(Parameters& parameters, Settings& settings);
/// Warns of filters with negative lobes, which the Gaussian stands in for.
void read_filter(Parameters& parameters, Settings& settings);

} // namespace keyhole::pbrt
