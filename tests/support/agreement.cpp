#include "support/agreement.h"

#include "methods/render.h"
#include "support/chance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole::test {
namespace {

constexpr int kBlock = 16;
constexpr double kNoisy = 0.25;

} // namespace

int blocks_across(int pixels) { return (pixels + kBlock - 1) / kBlock; }

std::vector<double> block_means(const Image& image) {
    const auto across = static_cast<std::size_t>(blocks_across(image.width));
    std::vector<RunningStats> blocks(across * static_cast<std::size_t>(blocks_across(image.height)));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            blocks[static_cast<std::size_t>(y / kBlock) * across + static_cast<std::size_t>(x / kBlock)].add(
                luminance(Rgb(p[0], p[1], p[2])));
        }
    std::vector<double> means;
    for (const RunningStats& b : blocks) means.push_back(b.mean());
    return means;
}

Blocks render_blocks(Scene& scene, Settings settings, int runs, const std::string& layer,
                     const UserPathFile& user_paths) {
    Blocks blocks;
    for (int run = 0; run < runs; ++run, ++settings.seed) {
        const Picture picture = render(scene, settings, {}, user_paths).picture;
        const std::vector<double> means = block_means(picture.layers.at(layer));
        blocks.resize(means.size());
        for (std::size_t b = 0; b < means.size(); ++b) blocks[b].add(means[b]);
    }
    return blocks;
}

Disagreement compare(const Blocks& a, const Blocks& b, double tolerance) {
    Disagreement d;
    std::vector<double> p(a.size());
    double sum_a = 0, sum_b = 0, variance = 0, quiet_a = 0, quiet_b = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double va = a[i].variance() / static_cast<double>(a[i].count());
        const double vb = b[i].variance() / static_cast<double>(b[i].count());
        const double difference = std::abs(a[i].mean() - b[i].mean()), reference = b[i].mean();
        const double excess = std::max(0.0, difference - tolerance * reference);
        const double dof =
            (va + vb) * (va + vb) /
            (va * va / static_cast<double>(a[i].count() - 1) + vb * vb / static_cast<double>(b[i].count() - 1));
        p[i] = va + vb > 0 ? student_p_value(excess / std::sqrt(va + vb), dof) : (excess > 0 ? 0.0 : 1.0);
        d.worst = std::max(d.worst, reference > 0 ? difference / reference : 0.0);
        const double error = reference > 0 ? std::sqrt(va) / reference : 0.0;
        d.largest_error = std::max(d.largest_error, error);
        const bool noisy = error > kNoisy;
        d.noisy += noisy ? 1 : 0;
        quiet_a += noisy ? 0 : a[i].mean();
        quiet_b += noisy ? 0 : reference;
        sum_a += a[i].mean();
        variance += va;
        sum_b += b[i].mean();
    }
    d.ratio = sum_a / sum_b;
    d.ratio_error = std::sqrt(variance) / sum_b;
    d.quiet_ratio = quiet_a / quiet_b;
    std::vector<std::size_t> order(a.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t i = order[k];
        if (p[i] >= 0.01 / static_cast<double>(order.size() - k)) break;
        ++d.rejected;
        d.report += fmt::format("  block {}: {:.5g} +- {:.2g} against {:.5g} +- {:.2g}, p = {:.1e}\n", i, a[i].mean(),
                                a[i].standard_error(), b[i].mean(), b[i].standard_error(), p[i]);
    }
    return d;
}

} // namespace keyhole::test
