// The classes of paths, and what each of them stores. This is the only place that says so: tracers, targets of chains,
// photon stores and final gather all ask here.
//
// In Heckbert's notation (1990) L is a point on a light, E the eye, S a specular vertex and D any other, glossy ones
// included; S* stands for any number of S, S+ for at least one. d1 and d2 are the first and the second D that a walk
// from the eye meets. Jensen (2001, chapter 9) splits light in the same way: direct light is sampled, the caustic map
// is asked at d1, and the global map at d2, where the rays of the final gather end.
#pragma once

namespace keyhole {

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

} // namespace keyhole
