// Where light is sent first, and from where: a density of the first edges of light paths.
#pragma once

#include "sampling/guidance/learned/ball_tree.h"
#include "sampling/guidance/learned/direction_histogram.h"
#include "sampling/guidance/learned/look_for_light.h"
#include "scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// The first edge of a light path. The density of `ray` isn't set.
struct FirstEdge {
    SurfacePoint x0;
    EmitterRay ray;
};

/// The ray along light from infinite point `x0` through `p`: it begins before everything in the scene.
EmitterRay parallel_ray(const Scene& scene, const SurfacePoint& x0, const Vec3& p);

/// A kernel density estimate (Silverman 1986, section 5.3, with a radius for each sample) of lines of light, over the
/// places where paths from the eye found light that counts. A target is drawn by its share of the light, and a line
/// through the ball around it, whatever stands before it: light that is to come through a window meets what stands
/// behind that as well, glass and chrome where no path from the eye could tell. Lines from an environment pass the
/// plane where those that were found meet, such as a window's, or have directions by a histogram: one for each cell of
/// surfaces by place and normal. Immutable and thread-safe.
class EmissionTargets {
  public:
    EmissionTargets() = default;
    /// @param seen in any order; there may be nothing
    EmissionTargets(const Scene& scene, std::span<const SeenLight> seen);

    bool empty() const { return choice_.empty(); }

    /// An edge by `u` in [0,1) and more numbers. Not to be called when empty.
    FirstEdge sample(double u, SampleSource& source) const;
    /// Density with which sample() makes it: that of the emitter's point times that of EmitterRay.
    double pdf(const FirstEdge& edge) const;
    std::size_t bytes() const;

  private:
    /// How a line may have been drawn, as densities that are the same for all targets of a group.
    struct Ways {
        double parallel = 0; ///< its direction, and then a point of the disc across it in a target's ball
        Vec3 from{0, 0, 0};  ///< a point of it that was drawn,
        double from_pdf = 0; ///< and then a direction into the ball

        /// Density of the line, given the target.
        double pdf(const Ball& target, const Vec3& w) const;
    };
    /// Targets of an emitter in a cell.
    struct Group {
        std::uint32_t emitter;
        DirectionHistogram directions; ///< towards an environment; empty: points by the emitter

        /// Of lines from an environment, those whose direction comes from the octahedral map.
        double map_share() const { return directions.has_plane() ? DirectionHistogram::kNotOnPlane : 1; }
        /// `own`: density of x0 by the emitter; `on_map`: place of the direction towards it.
        Ways ways(const SurfacePoint& x0, const EmitterRay& ray, double own,
                  const DirectionHistogram::Place& on_map) const;
    };
    void add_cell(std::span<const SeenLight* const> seen, std::vector<Ball>& balls, std::vector<double>& weights);

    const Scene* scene_ = nullptr;
    BallTree targets_;
    EmitterDistribution choice_;          // of a target
    std::vector<std::uint32_t> group_of_; // by target
    std::vector<Group> groups_;
};

} // namespace keyhole
