// The files that a render makes, and the filter at its end.
#pragma once

#include "cli/pictures/files_apart.h"
#include "core/choices.h"
#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "film/picture.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keyhole {

/// The filter at the end of a render, in the time that there is for it.
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

/// Where results go; empty: nowhere.
struct Outputs {
    std::string exr, png, stats;
    std::optional<double> exposure{}; ///< of the PNG, in stops; none: tone-mapped
    bool noise_layers = false;        ///< whether the EXR gets the picture's
    Denoise denoise = Denoise::png;   ///< which of them show the picture filtered

    /// Finds out before the render whether all of them can be written.
    /// @throws InputError for names that are no EXR's, or that can't be written.
    void check() const;
    /// For check_apart().
    std::vector<NamedFile> files() const;

    /// The picture without grain, with its layers and their noise; none if there is no time for that.
    using Filter = std::function<std::optional<Image>(const Picture&)>;
    /// Writes the files: first what can't be made again. An EXR that shows the picture filtered has what it was as
    /// layer "unfiltered". @param stats_json called last. @throws InputError as check().
    void write(Picture picture, const Filter& filter, const std::function<std::string()>& stats_json) const;
};

/// Names that nobody gave: the scene's with .exr, in the current folder; the EXR's with .png.
std::string default_exr(const std::string& scene);
std::string default_png(const std::string& exr);

} // namespace keyhole
