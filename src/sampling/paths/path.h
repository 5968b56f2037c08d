// Paths from a light to the eye, as plain values.
#pragma once

#include "core/inline_vector.h"
#include "sampling/paths/path_class.h"
#include "scene/bsdf.h"
#include "scene/surface_point.h"

#include <cstdint>

namespace keyhole {

/// Most scattering vertices a path may have between the light and the eye.
constexpr int kMaxScatterings = 126;

/// What is known of whether gather rays come to a vertex, on either side of its surface. To find out may cost some
/// rays: it is done once.
struct KnownCoverage {
    std::uint8_t asked = 0, covered = 0; ///< a bit for each side

    /// The bit of the side of unit direction `w`, where the geometric normal is `ng`.
    static std::uint8_t side(const Vec3& ng, const Vec3& w) { return ng.dot(w) < 0 ? 2 : 1; }
};

/// One vertex with all that is known of it. The fields below the line are filled in by measure().
struct Vertex {
    SurfacePoint point;
    Bsdf bsdf;
    Event event = Event::finite; ///< how light goes on here; finite at both ends of a path
    KnownCoverage coverage;      ///< kept by PathSet

    // ---- measure() ----
    Rgb value{0.0};            ///< emitted radiance at x0, scattering inside, camera importance at the eye; times what
                               ///< media leave of it on the way to the next vertex towards the eye
    double pdf_from_light = 0; ///< density of this vertex when traced from its neighbour on the light's side
    double pdf_from_eye = 0;   ///< density of this vertex when traced from its neighbour on the eye's side

    bool specular() const { return is_specular(event); }
};

/// x[0] lies on an emitter, x.back() is the eye; between them light is scattered.
///
/// Densities and contribution follow the convention of measure.h, in which only their ratios mean anything where
/// specular vertices take part.
struct Path {
    Path() {} // NOLINT(modernize-use-equals-default): that would let std::optional clear the room for all vertices

    InlineVector<Vertex, kMaxScatterings + 2> x;
    Vec2 image{0, 0};      ///< window point of the eye edge
    Rgb contribution{0.0}; ///< f of measure.h
    StoragePoint storage;  ///< PathSet::find_storage()
    double target = 0;     ///< what a chain samples in proportion to: PathSet::target(), or 0 outside the path set

    int vertices() const { return static_cast<int>(x.size()); }
    /// Number of vertices between the light and the eye.
    int scatterings() const { return vertices() - 2; }
};

inline DiffuseVertices diffuse_vertices(const Path& path) {
    return find_diffuse(path.vertices() - 1, [&](int i) { return path.x[static_cast<std::size_t>(i)].specular(); });
}

/// Index of the n-th non-specular scattering vertex seen from the eye (n = 1: d1; n = 2: d2), or 0 if there are fewer.
inline int nth_finite_from_eye(const Path& path, int n) {
    const DiffuseVertices d = diffuse_vertices(path);
    return n == 1 ? d.d1 : d.d2;
}

} // namespace keyhole
