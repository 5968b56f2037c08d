// Pictures by other renderers of the same files, where ../shared is there. `path` is held against them: brightness, and
// the means of 16 x 16 blocks of the picture. KEYHOLE_REFERENCES=long renders at the references' own size, with many
// more samples: `KEYHOLE_REFERENCES=long build/tests/test_agreement --gtest_filter='*References*'`.
#include "film/exr.h"
#include "render/render.h"
#include "scene/load/load.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

constexpr int kBlock = 16, kRuns = 8;

/// Blocks, or pixels, from (x0, y0) up to and without (x1, y1).
struct Area {
    int x0, y0, x1, y1;
    bool holds(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// Blocks that are farther off than the rest, and why.
struct Exception {
    Area blocks;
    double bound;
    const char* reason;
};

/// A picture to be held against. Bounds are relative; the README of ../shared says how far each can be trusted.
struct Reference {
    const char *name, *scene;
    std::vector<const char*> files; ///< independent pictures: their mean counts
    int shrink;                     ///< the short test renders at 1 / shrink of the picture's size
    int spp;                        ///< of a run of the short test
    double ratio, block;
    Area mask{0, 0, 0, 0}; ///< pixels of the short test's picture that don't count
    std::vector<Exception> exceptions{};
};

std::ostream& operator<<(std::ostream& out, const Reference& r) { return out << r.name; }

/// Luminance, averaged over squares of `shrink` pixels. Pixels that are not finite are left out.
Image shrunk(const Image& image, int shrink) {
    Image out(image.width / shrink, image.height / shrink, 1);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            double sum = 0;
            int n = 0;
            for (int i = 0; i < shrink * shrink; ++i) {
                const float* p = image.at(x * shrink + i % shrink, y * shrink + i / shrink);
                const double v = luminance(Rgb(p[0], p[1], p[2]));
                if (!std::isfinite(v)) continue;
                sum += v;
                ++n;
            }
            *out.at(x, y) = static_cast<float>(n > 0 ? sum / n : 0);
        }
    return out;
}

/// Means of blocks, those cut by the border included; then the mean of the picture.
std::vector<double> block_means(const Image& image, int block, const Area& mask) {
    const int across = (image.width + block - 1) / block, down = (image.height + block - 1) / block;
    const auto count = static_cast<std::size_t>(across * down);
    std::vector<double> sums(count + 1, 0), pixels(count + 1, 0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (mask.holds(x, y)) continue;
            const float* p = image.at(x, y);
            const double v = image.channels == 1 ? *p : luminance(Rgb(p[0], p[1], p[2]));
            for (const std::size_t b : {static_cast<std::size_t>(y / block * across + x / block), count}) {
                sums[b] += v;
                ++pixels[b];
            }
        }
    for (std::size_t b = 0; b <= count; ++b) sums[b] /= std::max(1.0, pixels[b]);
    return sums;
}

bool long_form() {
    const char* form = std::getenv("KEYHOLE_REFERENCES");
    return form != nullptr && std::strcmp(form, "long") == 0;
}

class References_Agree : public testing::TestWithParam<Reference> {};

} // namespace

TEST_P(References_Agree, InBrightnessAndBlocks) {
    const Reference& r = GetParam();
    const fs::path root = fs::path(KEYHOLE_SOURCE_DIR) / "../shared";
    if (!fs::exists(root / r.scene)) GTEST_SKIP() << "no " << (root / r.scene);
    const int shrink = long_form() ? 1 : r.shrink, grow = r.shrink / shrink;
    const Area mask{r.mask.x0 * grow, r.mask.y0 * grow, r.mask.x1 * grow, r.mask.y1 * grow};
    std::vector<double> expected;
    Image size;
    for (const char* file : r.files) {
        const Image reference = shrunk(read_exr((root / file).string()).layers.at("beauty"), shrink);
        const auto means = block_means(reference, kBlock, mask);
        expected.resize(means.size(), 0);
        for (std::size_t b = 0; b < means.size(); ++b) expected[b] += means[b] / static_cast<double>(r.files.size());
        size = reference;
    }

    LoadedScene loaded = load((root / r.scene).string());
    loaded.description.window = {size.width, size.height, 0};
    Settings settings = loaded.settings;
    settings.method = "path";
    settings.spp = long_form() ? r.spp * 16 / (grow * grow) + 1 : r.spp;
    if (shrink > 1) settings.filter = "box", settings.filter_radius = 0.5;
    Scene scene(std::move(loaded.description));
    std::vector<RunningStats> found(expected.size());
    for (int run = 0; run < kRuns; ++run, ++settings.seed) {
        const Picture picture = render(scene, settings, {}).picture;
        const auto means = block_means(picture.layers.at("beauty"), kBlock, mask);
        for (std::size_t b = 0; b < means.size(); ++b) found[b].add(means[b]);
    }

    const double whole = expected.back();
    const int across = (size.width + kBlock - 1) / kBlock;
    double worst = 0;
    int wrong = 0;
    std::string report;
    for (std::size_t b = 0; b + 1 < expected.size(); ++b) {
        const int x = static_cast<int>(b) % across, y = static_cast<int>(b) / across;
        double bound = r.block;
        for (const Exception& e : r.exceptions)
            if (e.blocks.holds(x * shrink / r.shrink, y * shrink / r.shrink)) bound = std::max(bound, e.bound);
        // What is nearly black may be off by as much as a hundredth of the picture's mean would.
        const double difference = found[b].mean() - expected[b], scale = std::max(expected[b], 0.01 * whole);
        worst = std::max(worst, std::abs(difference) / scale);
        if (std::abs(difference) <= bound * scale + 4 * found[b].standard_error()) continue;
        ++wrong;
        report += fmt::format("block ({}, {}): {:+.1f} %, standard error {:.1f} %\n", x, y, 100 * difference / scale,
                              100 * found[b].standard_error() / scale);
    }
    const double ratio = found.back().mean() / whole, error = found.back().standard_error() / whole;
    const std::string figures =
        fmt::format("brightness ratio {:.4f}, standard error {:.4f}; largest difference of a block {:.1f} %", ratio,
                    error, 100 * worst);
    RecordProperty("figures", figures);
    std::printf("%s: %s\n", r.name, figures.c_str());
    EXPECT_LE(std::abs(ratio - 1), r.ratio + 4 * error) << figures;
    EXPECT_EQ(wrong, 0) << report;
}

namespace {

const char* const kFlat = "pbrt's coateddiffuse ends walks within the coat after ten events, five of them at the base";

INSTANTIATE_TEST_SUITE_P(
    Shared, References_Agree,
    testing::Values(
        Reference{"cornell_box",
                  "scenes/cornell-box/scene.pbrt",
                  {"scenes/cornell-box/TungstenRender.exr"},
                  8,
                  32,
                  0.01,
                  0.03},
        Reference{"veach_bidir",
                  "scenes/veach-bidir/scene.pbrt",
                  {"scenes/veach-bidir/TungstenRender.exr"},
                  8,
                  32,
                  0.01,
                  0.03},
        Reference{"water_caustic",
                  "scenes/water-caustic/scene.pbrt",
                  {"scenes/water-caustic/TungstenRender.exr"},
                  8,
                  32,
                  0.01,
                  0.03},
        Reference{
            "box", "scenes/mps/box.pbrt", {"references/mps/box.a.exr", "references/mps/box.b.exr"}, 2, 16, 0.02, 0.03},
        Reference{"rooms",
                  "scenes/mps/rooms.pbrt",
                  {"references/mps/rooms.a.exr", "references/mps/rooms.b.exr"},
                  2,
                  16,
                  0.01,
                  0.03},
        Reference{"lantern",
                  "scenes/mps/lantern.pbrt",
                  {"references/mps/lantern.a.exr", "references/mps/lantern.b.exr"},
                  2,
                  16,
                  0.01,
                  0.03,
                  {55, 35, 95, 80}},
        Reference{"veach_ajar",
                  "scenes/veach-ajar/scene.pbrt",
                  {"references/veach-ajar.a.exr", "references/veach-ajar.b.exr"},
                  1,
                  16,
                  0.02,
                  0.1},
        Reference{"coffee", "scenes/coffee/scene.pbrt", {"references/coffee.exr"}, 1, 16, 0.1, 0.1},
        Reference{"dining_room", "scenes/dining-room/scene.pbrt", {"references/dining-room.exr"}, 1, 16, 0.02, 0.1},
        Reference{"bathroom", "scenes/bathroom/scene.pbrt", {"references/bathroom.exr"}, 1, 16, 0.02, 0.1}),
    [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace keyhole
