#include "sampling/markov/convergence.h"

#include "core/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {

double split_r_hat(std::span<const std::vector<double>> series) {
    RunningStats means, variances;
    const std::size_t n = series.front().size() / 2;
    for (const std::vector<double>& s : series) {
        // Of an odd number of draws the first goes.
        for (auto half = s.end() - static_cast<std::ptrdiff_t>(2 * n); half != s.end();
             half += static_cast<std::ptrdiff_t>(n)) {
            RunningStats draws;
            std::for_each(half, half + static_cast<std::ptrdiff_t>(n), [&](double x) { draws.add(x); });
            means.add(draws.mean());
            variances.add(draws.variance());
        }
    }
    const double between = means.variance(), within = variances.mean();
    if (!(between > 0)) return 1;
    if (!(within > 0)) return std::numeric_limits<double>::infinity();
    const auto draws = static_cast<double>(n);
    return std::sqrt((draws - 1) / draws + between / within);
}

void ConvergenceMonitor::Batch::operator+=(const Batch& next) {
    steps += next.steps;
    for (std::size_t g = 0; g < kGroups; ++g)
        for (std::size_t b = 0; b < kBlocks; ++b) sums[g][b] += next.sums[g][b];
}

void ConvergenceMonitor::end_round(std::int64_t steps) {
    Batch round;
    round.steps = steps;
    for (std::size_t g = 0; g < kGroups; ++g)
        for (std::size_t b = 0; b < kBlocks; ++b) round.sums[g][b] = sums_[g][b].take();
    if (!batches_.empty() && batches_.back().steps < length_) {
        batches_.back() += round;
        return;
    }
    if (batches_.size() == kMostBatches) halve();
    batches_.push_back(round);
    length_ = std::max(length_, batches_.front().steps);
}

void ConvergenceMonitor::halve() {
    for (std::size_t i = 0; i < kMostBatches / 2; ++i) {
        batches_[i] = batches_[2 * i];
        batches_[i] += batches_[2 * i + 1];
    }
    batches_.resize(kMostBatches / 2);
    length_ = batches_.front().steps;
}

double ConvergenceMonitor::mean(std::size_t block, std::size_t group) const {
    double sum = 0, steps = 0;
    for (const Batch& s : batches_) {
        sum += s.sums[group][block];
        steps += static_cast<double>(s.steps);
    }
    return sum / steps;
}

std::optional<ConvergenceDiagnostic> ConvergenceMonitor::diagnostic() const {
    std::size_t full = batches_.size();
    if (full > 0 && batches_.back().steps < length_) --full;
    if (full < 4) return std::nullopt;
    std::array<RunningStats, kBlocks> by_group;
    double total = 0;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        for (std::size_t g = 0; g < kGroups; ++g) by_group[b].add(mean(b, g));
        total += by_group[b].mean();
    }
    ConvergenceDiagnostic a{1, 0};
    if (!(total > 0)) return a;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        a.error += by_group[b].standard_error() / total;
        if (by_group[b].mean() * kBlocks < 0.25 * total) continue;
        std::array<std::vector<double>, kGroups> series;
        for (std::size_t g = 0; g < kGroups; ++g)
            for (std::size_t i = 0; i < full; ++i)
                series[g].push_back(batches_[i].sums[g][b] / static_cast<double>(batches_[i].steps));
        a.r_hat = std::max(a.r_hat, split_r_hat(series));
    }
    return a;
}

void GuidanceTally::add(std::int64_t chain, const Vec2& image, double weight) {
    const auto block = [](float x) { return std::clamp(static_cast<int>(x * kAcross), 0, kAcross - 1); };
    sums_[static_cast<std::size_t>(chain)][static_cast<std::size_t>(block(image.y) * kAcross + block(image.x))] +=
        weight;
}

std::optional<GuidanceEffect> GuidanceTally::effect() const {
    GuidanceEffect effect;
    double scale = 0;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        RunningStats with, without;
        for (std::size_t c = 0; c < sums_.size(); ++c)
            (is_control(first_ + static_cast<std::int64_t>(c)) ? without : with).add(sums_[c][b]);
        effect.chains_with = static_cast<std::size_t>(with.count());
        effect.chains_without = static_cast<std::size_t>(without.count());
        if (effect.chains_with < 2 || effect.chains_without < 2) return std::nullopt;
        effect.with += with.variance();
        effect.without += without.variance();
        RunningStats all = with;
        all.merge(without);
        scale += all.mean() * all.mean();
    }
    if (!(scale > 0)) return std::nullopt;
    effect.with /= scale;
    effect.without /= scale;
    return effect;
}

} // namespace keyhole
