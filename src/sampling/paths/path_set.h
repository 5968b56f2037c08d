// Which paths chains sample, and in proportion to what.
#pragma once

#include "sampling/paths/clear_glass.h"
#include "sampling/paths/gather_coverage.h"
#include "sampling/paths/image_weight.h"
#include "sampling/paths/path.h"

namespace keyhole {

/// The paths that stages one and two sample, and where they store photons.
struct PathSet {
    bool everything = false;                  ///< also paths that store none
    const GatherCoverage* coverage = nullptr; ///< of gather rays; null: they come everywhere. Must outlive the set
    const ImageWeight* weight = nullptr;      ///< of pixels; null: 1 everywhere. Must outlive the set

    static const PathSet stored; ///< those that store a photon; the rest stage three has exactly
    static const PathSet all;    ///< every path, for methods that draw them directly

    double weight_at(const Vec2& image) const { return weight == nullptr ? 1.0 : (*weight)(image); }
    /// What chains sample a path of RGB contribution `f` in proportion to.
    double target(const Rgb& f, const Vec2& image) const { return luminance(f) * weight_at(image); }

    /// Whether a path of class `light` is in the set; covered() is asked only where it matters.
    template <class Covered> bool contains(LightClass light, const Covered& covered) const {
        return everything || !stores_in(PhotonKind::none, light, covered);
    }

    /// Finds and keeps in the path where it stores a photon. This is where rays may be traced to find out whether its
    /// d2 is covered, unless the vertex knows: never inside target().
    const StoragePoint& find_storage(Path& path) const {
        const DiffuseVertices d = diffuse_vertices(path);
        const auto at = static_cast<std::size_t>(d.d2);
        const auto covered = [&] {
            return is_covered(coverage, path.x[at], direction(path.x[at].point, path.x[at - 1].point));
        };
        return path.storage = storage_point(d, ask_stored_kind(light_class(d, first_lit(path)), covered));
    }
};

inline constexpr PathSet PathSet::stored{};
inline constexpr PathSet PathSet::all{.everything = true};

} // namespace keyhole
