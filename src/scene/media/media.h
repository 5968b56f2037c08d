// What media do to light along the edges of paths.
#pragma once

#include "scene/accelerator.h"
#include "scene/media/medium.h"

#include <Imath/ImathBox.h>

#include <memory>
#include <optional>
#include <vector>

namespace keyhole {

/// Where along a ray the search for its next boundary begins, once a search from `nearest` has met one at `met`: at
/// least `skip` beyond it, and always farther on than before. An accelerator may find what lies a rounding error before
/// where it was told to begin, and would find that for ever.
float beyond_boundary(float nearest, float met, float skip);

/// What media leave of light along an edge.
struct Attenuation {
    Rgb transmittance{1.0}; ///< share that is neither absorbed nor scattered
    Rgb uncollided{1.0};    ///< the same of media that scatter alone: for each primary, the probability with which a
                            ///< free flight gets from one end to the other

    /// Through so much of a medium; as Medium::transmittance().
    void pass(const Medium& medium, double depth) {
        const Rgb left = medium.transmittance(depth);
        transmittance *= left;
        if (medium.scatters()) uncollided *= left;
    }
};

/// Where a medium scatters what flies through it.
struct Collision {
    Vec3 p;
    Rgb scattering, extinction; ///< coefficients there [1/m]
    float anisotropy;
};

/// A flight through media.
struct FreeFlight {
    std::optional<Collision> collision; ///< none: it gets to its end
    Attenuation attenuation;            ///< on the way to there
};

/// Knows which medium lies where from the shapes whose sides differ in it. An edge asks for itself, with a ray that
/// meets nothing but those shapes: nobody carries a medium along a path, and both directions of transport get the same
/// answer. Thread-safe. Invariant: without media, nothing is built and nothing is asked.
class Media {
  public:
    /// `shapes` must outlive this. `outermost` fills what no shape encloses; null: vacuum.
    Media(const std::vector<Shape>& shapes, std::shared_ptr<const Medium> outermost);

    bool empty() const { return accelerator_ == nullptr && outermost_ == nullptr; }
    /// Whether any of them does.
    bool scatter() const { return scatter_; }
    /// What no shape encloses; null: vacuum.
    const Medium* outermost() const { return outermost_.get(); }
    std::size_t accelerator_bytes() const { return accelerator_ ? accelerator_->bytes() : 0; }

    /// Share of light that an edge between two points lets through. At most one of them is infinite.
    Rgb transmittance(const SurfacePoint& a, const SurfacePoint& b) const { return attenuation(a, b).transmittance; }
    Attenuation attenuation(const SurfacePoint& a, const SurfacePoint& b) const;

    /// Follows a primary, 0 to 2, from `from` along unit direction `w` as far as `to`; null: without end. It ends
    /// before where a medium scatters it, by u in [0, 1): the density of that per length is extinction times
    /// Attenuation::uncollided, and the probability that it gets there the latter.
    FreeFlight fly(const SurfacePoint& from, const Vec3& w, const SurfacePoint* to, int primary, double u) const;
    /// The box that holds all boundaries, and all grids of densities; empty where nothing scatters.
    Imath::Box3f bounds_of_scattering() const;

  private:
    struct Edge {
        Vec3 origin, w;
        float end; ///< may be infinite
        const SurfacePoint& from;
    };
    static Edge edge(const SurfacePoint& from, const Vec3& w, const SurfacePoint* to);
    const Medium* medium_beside(const SurfacePoint& point, const Vec3& w) const;
    template <class F> void for_each_part(const Edge& edge, F&& f) const;

    const std::vector<Shape>& shapes_;
    std::shared_ptr<const Medium> outermost_;
    bool scatter_;
    std::unique_ptr<Accelerator> accelerator_; // over the boundaries; null if there are none
};

} // namespace keyhole
