// The filter at the end of a render, in the time that there is for it.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "film/denoise/denoise.h"

#include <cstddef>
#include <optional>

namespace keyhole {

class Denoising {
  public:
    /// Of nothing.
    Denoising() = default;
    /// @param pixels of the picture; png: whether there will be one.
    Denoising(Denoise what, bool png, std::size_t pixels, int threads);

    /// Keeps a part of the render's time [s], or of its CPU time, for itself. Returns how much.
    double reserve_of_time(double seconds) { return reserve_of_cpu_time(seconds * threads_) / threads_; }
    double reserve_of_cpu_time(double seconds);

    /// The picture without grain; none if it isn't asked for, the picture's noise is not known, somebody who has
    /// interrupted the render would wait too long, or interrupts this. Puts its time into `stats`.
    std::optional<Image> apply(const Picture& picture, const StopToken& stop, RenderStats& stats) const;

  private:
    std::size_t pixels_ = 0;
    int threads_ = 1, reach_ = 0;
};

} // namespace keyhole
