// From primary samples to paths.
#pragma once

#include "core/inline_vector.h"
#include "sampling/paths/bidirectional_tracer.h"
#include "sampling/paths/path.h"

#include <memory>

namespace keyhole {

/// An estimate of radiance at a window point.
struct Splat {
    Vec2 image;
    LightClass light;
    Rgb value; ///< [W/(m^2 sr)], window density 1
};

/// The splats of one sample, and the scalar that a chain samples in proportion to. Kelemen's "I"; deposits divide by
/// the same number.
class PathSample {
  public:
    double target() const { return target_; } ///< luminance of all splats; 0: a failed sample
    const auto& splats() const { return splats_; }
    bool broken() const { return broken_; } ///< a value was not a number and was left out
    /// In which of its thread's SubPathPair::scratch() a builder may leave the sub-paths. Swapped with the rest.
    std::size_t room() const { return room_; }
    void set_room(std::size_t room) { room_ = room; }

    void clear() {
        splats_.clear();
        target_ = 0;
        broken_ = false;
    }

    /// Adds to the splat of the same kind at the same place, if there is one.
    void add(const Vec2& image, LightClass light, const Rgb& value) {
        const double y = luminance(value);
        if (!std::isfinite(y) || !is_finite(value)) {
            broken_ = true;
            return;
        }
        if (!(y > 0)) return;
        target_ += y;
        for (Splat& s : splats_)
            if (s.light == light && s.image == image) {
                s.value += value;
                return;
            }
        splats_.push_back({image, light, value});
    }

  private:
    /// One place for the eye's sub-path with five kinds of light, and one for each connection with the eye itself.
    InlineVector<Splat, kMaxScatterings + 8> splats_;
    double target_ = 0;
    bool broken_ = false;
    std::size_t room_ = 0;
};

/// The coordinates of eye, light and discrete choices are kept apart, so that one sub-path stays what it was where the
/// other asks for more or fewer numbers than before.
struct PrimarySources {
    SampleSource &eye, &light, &choice;
};

/// Maps primary samples, uniform in [0,1), to splats whose expected value is the picture. Immutable and thread-safe.
class PathBuilder {
  public:
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

/// The connection of what the numbers of a multiplexed builder make; the sub-paths are left in `room`. None if one ends
/// too early or where nothing can be joined.
std::optional<Connection> multiplexed_connection(const Scene& scene, int scatterings, PrimarySources sources,
                                                 SubPathPair& room);

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
