#include "sampling/paths/image_weight.h"

#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/path_tracer.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace keyhole {
namespace {

constexpr int kCells = ImageWeight::kCells;
constexpr std::int64_t kSamplesOfCell = 64; // before filtering, which joins about ten cells
constexpr int kFilters = 2;                 // times that the filter is applied

/// Binomial filter, 1 2 1 along both axes; the border counts as going on.
ImageWeight::Cells filtered(const ImageWeight::Cells& from) {
    ImageWeight::Cells to;
    const auto at = [&](int x, int y) {
        const auto cx = static_cast<std::size_t>(std::clamp(x, 0, kCells - 1));
        return from[static_cast<std::size_t>(std::clamp(y, 0, kCells - 1)) * kCells + cx];
    };
    const auto row = [&](int x, int y) { return (at(x - 1, y) + 2 * at(x, y) + at(x + 1, y)) / 4; };
    for (int y = 0; y < kCells; ++y)
        for (int x = 0; x < kCells; ++x)
            to[static_cast<std::size_t>(y) * kCells + static_cast<std::size_t>(x)] =
                (row(x, y - 1) + 2 * row(x, y) + row(x, y + 1)) / 4;
    return to;
}

/// Adds up what paths bring.
struct LuminanceSink {
    using LooksThroughGlass = std::true_type;
    double luminance_sum = 0;

    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass /*light*/) {
        const double y = luminance(value);
        if (std::isfinite(y)) luminance_sum += y;
    }
};

} // namespace

ImageWeight::ImageWeight(const Cells& luminance) {
    // Not the mean: a lamp in view would make all the rest look equally dark.
    std::vector<double> lit;
    std::ranges::copy_if(luminance, std::back_inserter(lit), [](double y) { return y > 0; });
    cells_.fill(1);
    if (lit.empty()) return;
    const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
    std::ranges::nth_element(lit, middle);
    for (std::size_t i = 0; i < cells_.size(); ++i)
        cells_[i] = *middle / std::clamp(luminance[i], *middle / kMost, *middle * kMost);
}

std::size_t ImageWeight::index(const Vec2& image) {
    const auto cell = [](float x) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(x * kCells), 0, kCells - 1));
    };
    return cell(image.y) * kCells + cell(image.x);
}

ImageWeight measure_image_weight(const Scene& scene, int max_scatterings, std::uint64_t seed,
                                 const RunContext& context) {
    constexpr std::int64_t kSamples = kSamplesOfCell * kCells * kCells, kBlocks = 64, kBlock = kSamples / kBlocks;
    const ProgressStage progress(context, "brightness of pixels", kSamples, "paths");
    const auto measure_block = [&](Range range) {
        ImageWeight::Cells part{};
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(seed, StreamPurpose::image_weight, static_cast<std::uint64_t>(i));
            const Vec2 image = lattice_image_point(seed, StreamPurpose::image_weight, i);
            LuminanceSink sink;
            trace_path(scene, image, max_scatterings, rng, sink);
            part[ImageWeight::index(image)] += sink.luminance_sum;
        }
        context.advance(range.size());
        return part;
    };
    ImageWeight::Cells sum{};
    for (const ImageWeight::Cells& part : make_blocks({0, kBlocks * kBlock}, kBlock, context, measure_block))
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
    for (int i = 0; i < kFilters; ++i) sum = filtered(sum);
    return ImageWeight(sum);
}

} // namespace keyhole
