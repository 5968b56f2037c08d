// The camera sub-path of a stored photon: how light goes on from d2 to the eye.
#pragma once

#include "core/rng.h"
#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>

namespace keyhole {

/// Density with which sample_camera_subpath() draws the camera sub-path of a measured path from vertex d2 on, in the
/// coordinates of the path. 0 where it never does: where specular vertices stand on both sides of d1.
double camera_subpath_density(const Scene& scene, const Path& path, int d2);

/// Draws a camera sub-path for `d2`, which light reaches from `to_light`: by scattering there and a straight edge from
/// d1 to the eye, or, where the scene has specular surfaces, from the eye through some of them to d1 and a straight
/// edge to d2. Whether that is a path that carries light, with at most `max_scatterings` vertices between d2 and the
/// eye.
bool sample_camera_subpath(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                           SampleSource& source);

/// The number of draws until one carries light: its expectation is the reciprocal of the probability of that (Booth
/// 2007; Zeltner et al. 2020). None after `most` draws.
std::optional<std::int64_t> draws_until_valid(const Scene& scene, const Vertex& d2, const Vec3& to_light,
                                              int max_scatterings, std::int64_t most, SampleSource& source);

} // namespace keyhole
