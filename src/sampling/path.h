// Paths from a light to the eye, as plain values.
#pragma once

#include "core/inline_vector.h"
#include "sampling/image_weight.h"
#include "sampling/reach.h"
#include "scene/bsdf.h"
#include "scene/surface_point.h"

namespace keyhole {

/// Most scattering vertices a path may have between the light and the eye.
constexpr int kMaxScatterings = 126;

/// One vertex with all that is known of it. The fields below the line are filled in by measure().
struct Vertex {
    SurfacePoint point;
    Bsdf bsdf;
    Event event = Event::finite; ///< how light goes on here; finite at both ends of a path

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
    double target = 0;     ///< what a chain samples in proportion to: PathSet::target(), or 0 outside the path set

    int vertices() const { return static_cast<int>(x.size()); }
    /// Number of vertices between the light and the eye.
    int scatterings() const { return vertices() - 2; }
};

/// Index of the n-th non-specular scattering vertex seen from the eye (n = 1: d1), or 0 if there are fewer.
inline int nth_finite_from_eye(const Path& path, int n) {
    for (int i = path.vertices() - 2; i > 0; --i) {
        if (!path.x[static_cast<std::size_t>(i)].specular() && --n == 0) return i;
    }
    return 0;
}

/// Which photon map a path stores its light sub-path in.
enum class PhotonKind { none, global, caustic };

/// Where a path stores a photon.
struct StoragePoint {
    PhotonKind kind = PhotonKind::none;
    int vertex = 0;
};

/// The paths that stage two samples, and where they store photons.
struct PathSet {
    bool everything = false;             ///< also paths that store none
    const Reach* reach = nullptr;        ///< of gather rays; null: they come everywhere. Must outlive the set
    const ImageWeight* weight = nullptr; ///< of pixels; null: 1 everywhere. Must outlive the set

    static const PathSet stored; ///< those that store a photon; the rest stage three has exactly
    static const PathSet all;    ///< every path, for methods that draw them directly

    double weight_at(const Vec2& image) const { return weight == nullptr ? 1.0 : (*weight)(image); }
    /// What chains sample a path of RGB contribution `f` in proportion to.
    double target(const Rgb& f, const Vec2& image) const { return luminance(f) * weight_at(image); }

    /// Whether gather rays come to `d2` on the side where light arrives from `before`, the vertex on its light's side.
    bool reaches(const SurfacePoint& d2, const SurfacePoint& before) const {
        return reach == nullptr || reach->comes_to(d2.p, facing(d2.ng, direction(d2, before)));
    }

    /// Global: at d2, the second non-specular vertex from the eye, unless light came to it straight from the emitter:
    /// that is direct light, which stage three has from next-event estimation. Near a lamp it varies so fast that no
    /// density estimate could follow. Caustic: at d1, when light came to it through specular vertices only, or from a
    /// d2 beyond the reach of gather rays.
    StoragePoint storage_point(const Path& path) const {
        const int d1 = nth_finite_from_eye(path, 1), d2 = nth_finite_from_eye(path, 2);
        if (d2 == 0) return d1 > 1 ? StoragePoint{PhotonKind::caustic, d1} : StoragePoint{};
        const auto at = static_cast<std::size_t>(d2);
        if (!reaches(path.x[at].point, path.x[at - 1].point)) return {PhotonKind::caustic, d1};
        return d2 > 1 ? StoragePoint{PhotonKind::global, d2} : StoragePoint{};
    }
};

inline constexpr PathSet PathSet::stored{};
inline constexpr PathSet PathSet::all{.everything = true};

} // namespace keyhole
