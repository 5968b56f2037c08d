#include "support/invariance.h"

#include "core/parallel.h"
#include "support/chance.h"

#include <fmt/format.h>

#include <array>

namespace keyhole::test {
namespace {

constexpr int kStatistics = 15;
constexpr std::array<const char*, kStatistics> kNames{
    "vertices", "specular", "image left", "image top", "image diagonal", "light x",     "light next z", "stored x",
    "stored y", "stored z", "d1 x",       "d1 z",      "caustic",        "transmitted", "redness"};

std::array<double, kStatistics> statistics(const Path& path) {
    double specular = 0, transmitted = 0;
    for (const Vertex& v : path.x) {
        specular += v.specular() ? 1 : 0;
        transmitted += v.event == Event::transmit ? 1 : 0;
    }
    const StoragePoint& storage = path.storage;
    const Vec3 s = path.x[static_cast<std::size_t>(storage.vertex)].point.p;
    const Vec3 d1 = path.x[static_cast<std::size_t>(nth_finite_from_eye(path, 1))].point.p;
    const double y = luminance(path.contribution);
    return {static_cast<double>(path.vertices()),
            specular,
            path.image.x < 0.5f ? 1.0 : 0.0,
            path.image.y < 0.4f ? 1.0 : 0.0,
            path.image.x > path.image.y ? 1.0 : 0.0,
            path.x[0].point.p.x,
            path.x[1].point.p.z,
            s.x,
            s.y,
            s.z,
            d1.x,
            d1.z,
            storage.kind == PhotonKind::caustic ? 1.0 : 0.0,
            transmitted,
            y > 0 ? path.contribution.x / y : 0.0};
}

struct Sink {
    const Mixture<Path>& mixture;
    PathSet set;
    Rng rng;
    std::array<double, kStatistics> change{};
    Ledger ledger{};
    std::uint64_t paths = 0;

    void contribution(const Rgb& value, PhotonKind, auto&& make_path) {
        const double weight = luminance(value);
        if (!(weight > 0)) return;
        Path x = make_path();
        set.find_storage(x);
        x.target = luminance(x.contribution);
        if (!(x.target > 0)) return;
        ++paths;
        const auto before = statistics(x);
        std::array<double, kStatistics> step{}; // expected values after it, less those before
        for (std::size_t k = 0; k < kStatistics; ++k) step[k] = -before[k];
        Chain<Path> chain(x, mixture, Rng(rng.below(1u << 31), StreamPurpose::test, rng.below(1u << 31)));
        chain.step([&](const Path& p, double w) {
            const auto after = statistics(p);
            for (std::size_t k = 0; k < kStatistics; ++k) step[k] += w * after[k];
        });
        // What a step can't change, such as the place of a point light, comes back rounded.
        for (std::size_t k = 0; k < kStatistics; ++k)
            if (std::abs(step[k]) > 1e-12) change[k] += weight * step[k];
        merge(ledger, chain.ledger());
    }
};

} // namespace

Invariance measure_invariance(const Scene& scene, const Mixture<Path>& mixture, PathSet set, std::int64_t samples,
                              std::uint64_t seed, int max_scatterings, Technique technique) {
    constexpr std::int64_t blocks = 64;
    std::vector<Invariance> parts(blocks);
    parallel_for(blocks, [&](std::int64_t b) {
        Invariance& part = parts[static_cast<std::size_t>(b)];
        for (const char* name : kNames) part.lines.push_back({name, {}});
        const Range range = split(samples, blocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(seed, StreamPurpose::test, static_cast<std::uint64_t>(i));
            Sink sink{mixture, set, Rng(seed + 1, StreamPurpose::test, static_cast<std::uint64_t>(i))};
            const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
            trace_independent(technique, scene, image, {max_scatterings, set}, rng, sink);
            for (std::size_t k = 0; k < kStatistics; ++k) part.lines[k].change.add(sink.change[k]);
            merge(part.ledger, sink.ledger);
            part.paths += sink.paths;
        }
    });
    Invariance all = parts[0];
    for (std::size_t b = 1; b < parts.size(); ++b) {
        for (std::size_t k = 0; k < kStatistics; ++k) all.lines[k].change.merge(parts[b].lines[k].change);
        merge(all.ledger, parts[b].ledger);
        all.paths += parts[b].paths;
    }
    return all;
}

double Invariance::worst() const {
    double z = 0;
    for (const Line& l : lines) z = std::max(z, std::abs(l.z()));
    return z;
}

double Invariance::bound() { return most_errors(kStatistics); }

std::string Invariance::report() const {
    std::string s = fmt::format("{} paths\n", paths);
    for (const Line& l : lines)
        s += fmt::format("  {:15} change {:+.3e} +- {:.1e}  z {:+.2f}\n", l.statistic, l.change.mean(),
                         l.change.standard_error(), l.z());
    for (const LedgerEntry& e : ledger)
        s += fmt::format("  proposed {} zero {} nan {} rejected {} accepted {}\n", e.proposed, e.zero, e.nan,
                         e.rejected, e.accepted);
    return s;
}

} // namespace keyhole::test
