// Next-event estimation that follows what shadow rays have found: which emitters shine at a place, and from where in
// the sky.
#pragma once

#include "sampling/guidance/learned/wider_cells.h"
#include "scene/scene.h"

#include <Imath/ImathBox.h>

#include <cstdint>
#include <span>
#include <vector>

namespace keyhole {

/// With which probability samples of direct light go to an emitter.
struct EmitterChance {
    std::uint32_t emitter;
    double probability;
    std::vector<Vec3> towards{}; ///< of an environment: directions as they are drawn, unit; none: by the emitter
};

/// Surfaces in cells by place and normal, in each of which emitters are chosen by the root of the second moment of what
/// they were found to bring, visibility included (Vevoda, Kondapaneni and Krivanek 2018, "Bayesian Online Regression
/// for Adaptive Direct Illumination Sampling", cells and moments; theirs are regularised where these fall back on the
/// light tree), and directions to an environment by a histogram, with that of a wider cell behind it. Of all samples a
/// share goes by the light tree as if nothing were known: in each cell that which would have left the least second
/// moment of light that the histogram was not made from. Immutable and thread-safe.
class LearnedDirectLight final : public DirectLightSampler {
  public:
    /// @param found what shadow rays found, in any order; there may be nothing
    LearnedDirectLight(const Scene& scene, std::span<const FoundLight> found);

    EmitterPoint sample(const SurfacePoint& at, SampleSource& source) const override;
    double pdf(const SurfacePoint& at, const SurfacePoint& x0) const override;
    double probability(const SurfacePoint& at, std::uint32_t emitter) const override;
    EmitterPoint sample_of(const SurfacePoint& at, std::uint32_t emitter, double u,
                           SampleSource& source) const override;
    /// The same for a sample that was found.
    double pdf(const FoundLight& found) const;

    /// What is known of emitters at a place, the likeliest first, each with at most `directions` directions; empty
    /// where the light tree chooses alone.
    std::vector<EmitterChance> chances(const SurfacePoint& at, int directions) const;

    /// Expected second moment of samples over that of the light tree's, the mean over what was found.
    double second_moment_ratio() const { return ratio_; }
    std::uint32_t cells() const { return tree_.size(); }
    std::size_t bytes() const;

  private:
    struct Share {
        std::uint32_t emitter;
        double probability = 0;
        double up_to = 0;   ///< sum of the probabilities so far
        double by_tree = 0; ///< probability that the light tree has for the middle of the cell
        std::shared_ptr<const NestedHistogram> directions{}; ///< to an environment; null: by the emitter
    };
    struct Cell {
        double plain = 1;     ///< share of samples by the light tree
        bool at_place = true; ///< whether the light tree is asked for each place; else for `middle`, which is cheaper
        SurfacePoint middle;
        Imath::Box3f known{};      ///< around what was found; beyond it nothing is known
        std::vector<Share> shares; ///< of the others; by emitter
        double ratio = 1;          ///< of second moments
        std::size_t count = 0;     ///< of samples that it was made from

        const Share* share_of(std::uint32_t emitter) const;
        /// Of a sample by the shares, at `p` in direction `w`; `point_pdf` as in FoundLight.
        double pdf(std::uint32_t emitter, const Vec3& p, const Vec3& w, double point_pdf) const;
        double pdf(const FoundLight& f) const { return pdf(f.emitter, f.at.p, f.towards, f.point_pdf); }
    };
    /// `like`: planes of the histograms are those that these have.
    static std::vector<Share> make_shares(std::span<const FoundLight* const> found, const WiderCells::Directions& wider,
                                          const Cell* like = nullptr);
    Cell make_cell(std::span<const FoundLight* const> found, const WiderCells& wider) const;
    const Cell& cell_of(const SurfaceCells::Place& at) const;
    const Cell& cell_of(const SurfacePoint& at) const { return cell_of(SurfaceCells::Place{at.p, at.ng}); }
    /// What the light tree is asked for.
    static const SurfacePoint& asked_for(const Cell& cell, const SurfacePoint& at) {
        return cell.at_place ? at : cell.middle;
    }
    /// Of an emitter that has `share` in the cell, or none, where the light tree chooses it with `by_tree`.
    static double probability(const Cell& cell, const Share* share, double by_tree) {
        return cell.plain * by_tree + (share != nullptr ? (1 - cell.plain) * share->probability : 0);
    }
    /// A point on an emitter as its share has it; null: there is none, and the emitter draws it.
    SurfacePoint point_by_share(const Share* share, const SurfacePoint& at, std::uint32_t emitter,
                                SampleSource& source) const;
    /// With which the light tree chooses an emitter that has `share` in the cell, or none.
    double by_tree(const Cell& cell, const SurfacePoint& at, const Share* share, std::uint32_t emitter) const;
    double pdf(const Cell& cell, const SurfacePoint& at, const SurfacePoint& x0, double by_tree) const;

    const Scene* scene_;
    SurfaceCells tree_;
    std::vector<Cell> cells_;
    Cell unknown_; ///< the light tree's choice
    double ratio_ = 1;
    std::size_t bytes_of_wider_ = 0; ///< of histograms that cells share
};

} // namespace keyhole
