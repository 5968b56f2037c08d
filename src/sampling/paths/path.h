// Paths from a light to the eye, as plain values.
#pragma once

#include "core/inline_vector.h"
#include "scene/bsdf.h"
#include "scene/surface_point.h"

#include <cstdint>

namespace keyhole {

// The classes of paths, and what each of them stores. This is the only place that says so: tracers, targets of chains,
// photon stores and final gather all ask here.
//
// In Heckbert's notation (1990) L is a point on a light, E the eye, S a specular vertex and D any other, glossy ones
// included; S* stands for any number of S, S+ for at least one. d1 and d2 are the first and the second D that a walk
// from the eye meets. Jensen (2001, chapter 9) splits light in the same way: direct light is sampled, the caustic map
// is asked at d1, and the global map at d2, where the rays of the final gather end.

enum class LightClass {
    emission, ///< L S* E
    direct,   ///< L D S* E
    caustic,  ///< L S+ D S* E
    second,   ///< L D S* D S* E: direct light at the second D seen
    indirect, ///< everything else with two or more D
};

/// d1 and d2 of a path by their index from the light's end, where x0 lies on the emitter; 0: there is none.
struct DiffuseVertices {
    int d1 = 0, d2 = 0;
};

/// Those of the path whose vertex `eye` is the eye; specular(i) says so of its vertex i.
template <class Specular> DiffuseVertices find_diffuse(int eye, const Specular& specular) {
    DiffuseVertices found;
    for (int i = eye - 1; i > 0 && found.d2 == 0; --i)
        if (!specular(i)) (found.d1 == 0 ? found.d1 : found.d2) = i;
    return found;
}

/// By whether light has been scattered before the last D, and by how many D there are. `lit`: the first vertex that it
/// comes straight to, by its index; beyond 1 where it goes through clear glass (clear_glass.h), which counts as
/// nothing.
constexpr LightClass light_class(const DiffuseVertices& d, int lit) {
    if (d.d2 > 0) return d.d2 > lit ? LightClass::indirect : LightClass::second;
    return d.d1 == 0 ? LightClass::emission : d.d1 > lit ? LightClass::caustic : LightClass::direct;
}

/// Which photon map a path stores its light sub-path in.
enum class PhotonKind { none, global, caustic };

/// What a path stores; `covered`: whether gather rays come to its d2 (GatherCoverage). Global: at d2, unless light came
/// to it straight from the emitter: that is direct light, which final gather has from next-event estimation; near a
/// lamp it varies so fast that no density estimate could follow. Caustic: at d1, when light came to it through specular
/// vertices only, or from a d2 that gather rays don't come to.
constexpr PhotonKind stored_kind(LightClass light, bool covered) {
    switch (light) {
    case LightClass::caustic:
        return PhotonKind::caustic;
    case LightClass::second:
        return covered ? PhotonKind::none : PhotonKind::caustic;
    case LightClass::indirect:
        return covered ? PhotonKind::global : PhotonKind::caustic;
    case LightClass::emission:
    case LightClass::direct:
        break;
    }
    return PhotonKind::none;
}

/// The same; covered() is asked only where it matters.
template <class Covered> PhotonKind ask_stored_kind(LightClass light, const Covered& covered) {
    const bool matters = stored_kind(light, true) != stored_kind(light, false);
    return stored_kind(light, !matters || covered());
}

/// Whether it stores in `kind`; covered() is asked only where this matters.
template <class Covered> bool stores_in(PhotonKind kind, LightClass light, const Covered& covered) {
    const bool if_covered = stored_kind(light, true) == kind, if_not = stored_kind(light, false) == kind;
    return if_covered == if_not ? if_covered : covered() == if_covered;
}

/// Where a path stores a photon.
struct StoragePoint {
    PhotonKind kind = PhotonKind::none;
    int vertex = 0; ///< from the light's end; 0: none
};

constexpr StoragePoint storage_point(const DiffuseVertices& d, PhotonKind kind) {
    return {kind, kind == PhotonKind::global ? d.d2 : kind == PhotonKind::caustic ? d.d1 : 0};
}

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
