// What a metal is described by in scene files.
#pragma once

#include "scene/load/properties.h"
#include "scene/materials/make_material.h"

#include <fmt/format.h>

namespace keyhole {

/// What metals are in pbrt's files that say nothing.
const Rgb kCopperEta{0.2004377, 0.9240334, 1.1022120}, kCopperK{3.9129485, 2.4528477, 2.1421880};

/// A part of a complex index.
inline Rgb read_index(Properties& p, Key key, const Rgb& otherwise) {
    return p.color(key, ColorUse::index, {"a part of a complex index", 0, 1000}, otherwise);
}

/// Calls `make` with the complex index of a metal, or with its reflectance.
template <class Make> MaterialPtr read_metal(Properties& p, Key eta, Key k, Make&& make) {
    const bool by_index = p.has(eta) || p.has(k), by_reflectance = p.has("reflectance");
    if (p.has(eta) != p.has(k) && !p.is_pbrt())
        p.fail(fmt::format("found '{}' alone, expected 'eta' and 'k', or 'reflectance'", p.has(eta) ? "eta" : "k"));
    if (by_index && by_reflectance) p.fail("found 'reflectance' beside 'eta' and 'k', expected one or the other");
    // A metal without either is copper in pbrt's files, and light grey in ours.
    if (by_index || (p.is_pbrt() && !by_reflectance))
        return make(read_index(p, eta, kCopperEta), read_index(p, k, kCopperK));
    return make(p.color_texture("reflectance", p.is_pbrt() ? 0.5 : 0.9));
}

} // namespace keyhole
