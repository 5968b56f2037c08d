// Choice of an emitter by what it may do at a point.
#pragma once

#include "scene/emitter.h"

#include <vector>

namespace keyhole {

/// A binary tree over emitters with bounds on where they are, where they shine and how much (Conty Estevez and Kulla
/// 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; one path from the root, no splitting).
/// Emitters at infinity stand beside it, by the irradiance they bring everywhere. A share of the choice goes by power
/// alone, so that none starves where the bounds are wrong about it. With less than three emitters all of it goes by
/// power. Immutable and thread-safe.
class LightTree {
  public:
    LightTree() = default;
    LightTree(const std::vector<std::unique_ptr<Emitter>>& emitters, const EmitterDistribution& by_power,
              const BoundingSphere& scene);

    struct Choice {
        std::uint32_t emitter;
        double probability;
    };
    /// An emitter for `point`, by u in [0,1). Not to be called when nothing emits.
    Choice sample(const SurfacePoint& point, double u) const;
    /// Probability with which sample() chooses `emitter` for `point`.
    double probability(const SurfacePoint& point, std::uint32_t emitter) const;

  private:
    struct Node {
        EmitterBounds bounds;              ///< of all emitters below
        std::uint32_t left = 0, right = 0; ///< children; 0, 0 for a leaf
        std::uint32_t parent = 0;
        std::uint32_t emitter = 0;                              ///< of a leaf
        double cos_spread = -1, sin_spread = 0, cos_reach = -1; ///< of the bounds' angles
    };
    struct Far {
        std::uint32_t emitter;
        double irradiance; ///< [W/m^2]
    };

    static double importance(const SurfacePoint& point, const Node& node);
    std::uint32_t build(std::vector<Node>& leaves, std::size_t begin, std::size_t end, std::uint32_t parent);
    Choice sample_by_effect(const SurfacePoint& point, double u) const;
    double effect_probability(const SurfacePoint& point, std::uint32_t emitter) const;
    /// Of the left one of two children.
    double left_share(const SurfacePoint& point, const Node& node) const;

    const EmitterDistribution* by_power_ = nullptr;
    std::vector<Node> nodes_;            // [0] is the root
    std::vector<std::uint32_t> leaf_of_; // by emitter; kNone for those far away; empty: all goes by power
    std::vector<Far> far_;
    double far_irradiance_ = 0;
};

} // namespace keyhole
