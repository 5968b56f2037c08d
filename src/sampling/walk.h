// Sub-paths traced from either end.
#pragma once

#include "core/rng.h"
#include "sampling/path.h"
#include "scene/scene.h"

#include <optional>

namespace keyhole {

/// A vertex at `point` with its BSDF looked up.
Vertex make_vertex(const SurfacePoint& point);

/// x0 on an emitter chosen by power. None if nothing emits.
std::optional<Vertex> sample_emitter(const Scene& scene, SampleSource& source);

/// Direction in which light leaves x0.
EmitterDirection sample_emission(const Scene& scene, const Vertex& x0, SampleSource& source);

/// The eye vertex.
Vertex sample_eye(const Scene& scene, SampleSource& source);

/// The next vertex along `w`; none where nothing is hit.
std::optional<Vertex> next_vertex(const Scene& scene, const Vertex& from, const Vec3& w);

/// Continues from `v`, reached along `from` (pointing back), by sampling its BSDF: sets v.event and returns the direction.
std::optional<Vec3> continue_walk(Vertex& v, const Vec3& from, SampleSource& source);

} // namespace keyhole
