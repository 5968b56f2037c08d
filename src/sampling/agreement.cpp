#include "sampling/agreement.h"

#include "core/statistics.h"

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

void AgreementMonitor::Stretch::operator+=(const Stretch& next) {
    steps += next.steps;
    for (std::size_t g = 0; g < kGroups; ++g)
        for (std::size_t b = 0; b < kBlocks; ++b) sums[g][b] += next.sums[g][b];
}

void AgreementMonitor::end_round(std::int64_t steps) {
    Stretch round;
    round.steps = steps;
    for (std::size_t g = 0; g < kGroups; ++g)
        for (std::size_t b = 0; b < kBlocks; ++b) round.sums[g][b] = sums_[g][b].take();
    if (!stretches_.empty() && stretches_.back().steps < length_) {
        stretches_.back() += round;
        return;
    }
    if (stretches_.size() == kMostStretches) halve();
    stretches_.push_back(round);
    length_ = std::max(length_, stretches_.front().steps);
}

void AgreementMonitor::halve() {
    for (std::size_t i = 0; i < kMostStretches / 2; ++i) {
        stretches_[i] = stretches_[2 * i];
        stretches_[i] += stretches_[2 * i + 1];
    }
    stretches_.resize(kMostStretches / 2);
    length_ = stretches_.front().steps;
}

double AgreementMonitor::mean(std::size_t block, std::size_t group) const {
    double sum = 0, steps = 0;
    for (const Stretch& s : stretches_) {
        sum += s.sums[group][block];
        steps += static_cast<double>(s.steps);
    }
    return sum / steps;
}

std::optional<Agreement> AgreementMonitor::agreement() const {
    std::size_t full = stretches_.size();
    if (full > 0 && stretches_.back().steps < length_) --full;
    if (full < 4) return std::nullopt;
    std::array<RunningStats, kBlocks> by_group;
    double total = 0;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        for (std::size_t g = 0; g < kGroups; ++g) by_group[b].add(mean(b, g));
        total += by_group[b].mean();
    }
    Agreement a{1, 0};
    if (!(total > 0)) return a;
    for (std::size_t b = 0; b < kBlocks; ++b) {
        a.error += by_group[b].standard_error() / total;
        if (by_group[b].mean() * kBlocks < 0.25 * total) continue;
        std::array<std::vector<double>, kGroups> series;
        for (std::size_t g = 0; g < kGroups; ++g)
            for (std::size_t i = 0; i < full; ++i)
                series[g].push_back(stretches_[i].sums[g][b] / static_cast<double>(stretches_[i].steps));
        a.r_hat = std::max(a.r_hat, split_r_hat(series));
    }
    return a;
}

} // namespace keyhole
