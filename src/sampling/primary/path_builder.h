// From primary samples to paths.
#pragma once

#include "sampling/bidirectional_tracer.h"
#include "sampling/primary/path_sample.h"

#include <array>
#include <memory>

namespace keyhole {

/// The coordinates of eye, light and discrete choices are kept apart, so that one sub-path stays what it was where the
/// other asks for more or fewer numbers than before.
struct PrimarySources {
    SampleSource &eye, &light, &choice;

    std::array<SampleSource*, 3> all() const { return {&eye, &light, &choice}; }
};

/// Maps primary samples, uniform in [0,1), to splats whose expected value is the picture. Immutable and thread-safe.
class PathBuilder {
  public:
    using Sources = PrimarySources;
    using Sample = PathSample;

    virtual ~PathBuilder() = default;
    /// Fills `sample`, which is empty. It stays so where no path is completed.
    virtual void build(PrimarySources sources, PathSample& sample) const = 0;
};

/// What builders have in common.
struct BuilderContext {
    const Scene* scene;
    int max_scatterings;
    MisHeuristic heuristic = MisHeuristic::power;
};

/// Path tracing with next-event estimation.
std::unique_ptr<PathBuilder> make_path_builder(const BuilderContext& context);

/// Sub-paths of random lengths from the eye and from the light, joined at their end points only.
std::unique_ptr<PathBuilder> make_endpoint_builder(const BuilderContext& context);

/// Bidirectional path tracing: all pairs of vertices are joined.
std::unique_ptr<PathBuilder> make_bidirectional_builder(const BuilderContext& context);

/// Paths with `scatterings` vertices between light and eye by one technique, chosen evenly by a number of its own
/// (Hachisuka, Kaplanyan and Dachsbacher 2014).
std::unique_ptr<PathBuilder> make_multiplexed_builder(const BuilderContext& context, int scatterings);

/// The joint of what the numbers of a multiplexed builder make; the sub-paths are left in `room`. None if one ends too
/// early or where nothing can be joined.
std::optional<Joint> multiplexed_joint(const Scene& scene, int scatterings, PrimarySources sources, SubPathPair& room);

/// Of a multiplexed builder: the number of techniques, and that which a number in [0,1) chooses, by its s.
inline int technique_count(int scatterings) { return scatterings + 2; }
inline int chosen_technique(double u, int scatterings) { return static_cast<int>(u * technique_count(scatterings)); }

/// The window point of two numbers in [0,1).
inline Vec2 window_point(SampleSource& source) {
    const auto [x, y] = source.take<2>();
    const auto below_one = [](double u) { return std::min(static_cast<float>(u), 0x1.fffffep-1f); };
    return {below_one(x), below_one(y)};
}

} // namespace keyhole
