// Paths traced from the light that the eye sees by way of flat mirrors.
#pragma once

#include "sampling/proposals/light_walk.h"
#include "sampling/proposals/mirror_images.h"

namespace keyhole {

/// Light sub-paths joined to the lens by way of flat mirrors. The join is to the image of the eye: what is between its
/// last D and the image plane is one edge of the unfolded length, and leaves nothing to choose. Immutable and
/// thread-safe.
class MirroredLightPaths {
  public:
    /// `context`: its scene, set and number of scatterings. The scene and the set's gather coverage must outlive it.
    explicit MirroredLightPaths(const ProposalContext& context)
        : scene_(*context.scene), set_(context.set), walk_(context), mirrors_(scene_), most_(context.max_scatterings) {}

    /// Whether the eye sees no flat mirror, and there is nothing to sample.
    bool empty() const { return mirrors_.empty(); }

    /// A path, evaluated; none where it can't be made, for the reason in `why`.
    std::optional<Path> draw(Rng& rng, Failure& why) const;
    /// Density of the measured path y among those of draw(), in the convention of measure.h.
    double draw_density(const Path& y) const;

  private:
    bool meet_mirrors(SubPath& eye, const MirrorImages::Way& way, Vec3 w, Failure& why) const;
    MirrorImages::Way way_between(const Path& y, int last, int eye) const;

    const Scene& scene_;
    PathSet set_;
    LightWalk walk_;
    MirrorImages mirrors_;
    int most_; ///< scatterings
};

} // namespace keyhole
