#include "methods/choice/mean_render.h"

#include "film/join.h"

#include <utility>

namespace keyhole {
namespace {

/// Renders with less weight than this share of a later one's tell nothing that it doesn't.
constexpr double kNegligible = 0.05;

/// Gives either picture what only the other has: methods that draw all light know no surfaces.
void share_layers(Picture& a, Picture& b) {
    for (const auto& [name, image] : a.layers) b.layers.emplace(name, image);
    for (const auto& [name, image] : b.layers) a.layers.emplace(name, image);
}

} // namespace

void MeanRender::add(RenderResult&& result, double weight) {
    if (!result_ || weight_ <= kNegligible * weight) {
        if (result_) leave_out(result_->stats);
        result_ = std::move(result);
        weight_ = most_ = weight;
        return;
    }
    weight_ += weight;
    share_layers(result_->picture, result.picture);
    blend(result_->picture, result.picture, weight / weight_);
    result_->picture.sums.clear(); // they are of one render
    const double samples = result_->stats.samples + result.stats.samples;
    if (weight > most_) {
        most_ = weight;
        std::swap(result_->stats, result.stats);
        result_->settings = result.settings;
    }
    result_->stats.samples = samples;
    leave_out(result.stats);
}

void MeanRender::leave_out(const RenderStats& stats) {
    of_map_.take_word_of_map(stats);
    for (const StageStats& stage : stats.stages) {
        others_.wall_seconds += stage.wall_seconds;
        others_.cpu_seconds += stage.cpu_seconds;
        others_.rays += stage.rays;
    }
}

RenderResult MeanRender::take() {
    auto& stages = result_->stats.stages;
    if (others_.cpu_seconds > 0) stages.insert(stages.begin(), others_);
    result_->stats.take_word_of_map(of_map_);
    return std::move(*result_);
}

} // namespace keyhole
