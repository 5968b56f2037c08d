// Pictures by other renderers of the same files, where ../shared is there. `path` is held against them (`mps` where
// paths from the eye miss the light): brightness, and the means of 16 x 16 blocks of the picture.
// KEYHOLE_REFERENCES=long renders at the references' own size, with many more samples: `KEYHOLE_REFERENCES=long
// build/tests/test_agreement --gtest_filter='*References*'`.
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
    std::string name, scene;
    std::vector<std::string> files{}; ///< independent pictures: their mean counts
    int shrink = 1;                   ///< the short test renders at 1 / shrink of the picture's size
    int spp = 8;                      ///< of a run of the short test
    std::vector<std::string> settings{"method=path"};
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

/// Block means of the reference, at 1 / shrink of its size, and that size.
struct Expected {
    std::vector<double> means;
    int width = 0, height = 0;
};
Expected expectation(const Reference& r, const fs::path& root, int shrink, const Area& mask) {
    Expected e;
    for (const std::string& file : r.files) {
        const Image picture = shrunk(read_exr((root / file).string()).layers.at("beauty"), shrink);
        const auto means = block_means(picture, kBlock, mask);
        e.means.resize(means.size(), 0);
        for (std::size_t b = 0; b < means.size(); ++b) e.means[b] += means[b] / static_cast<double>(r.files.size());
        e.width = picture.width;
        e.height = picture.height;
    }
    return e;
}

/// Block means of independent pictures.
std::vector<RunningStats> rendered(LoadedScene loaded, int spp, const Area& mask) {
    Settings settings = loaded.settings;
    settings.spp = spp;
    Scene scene(std::move(loaded.description));
    std::vector<RunningStats> found;
    for (int run = 0; run < kRuns; ++run, ++settings.seed) {
        const auto means = block_means(render(scene, settings, {}).picture.layers.at("beauty"), kBlock, mask);
        found.resize(means.size());
        for (std::size_t b = 0; b < means.size(); ++b) found[b].add(means[b]);
    }
    return found;
}

class References_Agree : public testing::TestWithParam<Reference> {};

} // namespace

TEST_P(References_Agree, InBrightnessAndBlocks) {
    const Reference& r = GetParam();
    const fs::path root = fs::path(KEYHOLE_SOURCE_DIR) / "../shared";
    if (!fs::exists(root / r.scene)) GTEST_SKIP() << "no " << (root / r.scene);
    const int grow = long_form() ? r.shrink : 1, shrink = r.shrink / grow;
    const Area mask{r.mask.x0 * grow, r.mask.y0 * grow, r.mask.x1 * grow, r.mask.y1 * grow};
    const Expected expected = expectation(r, root, shrink, mask);
    LoadedScene loaded = load((root / r.scene).string(), r.settings);
    loaded.description.window = {expected.width, expected.height, 0};
    if (shrink > 1) { // as the reference is shrunk
        loaded.settings.filter = "box";
        loaded.settings.filter_radius = 0.5;
    }
    const auto found = rendered(std::move(loaded), long_form() ? 1 + r.spp * 16 / (grow * grow) : r.spp, mask);

    const double whole = expected.means.back();
    const int across = (expected.width + kBlock - 1) / kBlock;
    double worst = 0;
    std::string wrong;
    for (std::size_t b = 0; b + 1 < found.size(); ++b) {
        const int x = static_cast<int>(b) % across, y = static_cast<int>(b) / across;
        double bound = r.block;
        for (const Exception& e : r.exceptions)
            if (e.blocks.holds(x / grow, y / grow)) bound = std::max(bound, e.bound);
        // What is nearly black may be off by as much as a hundredth of the picture's mean would.
        const double scale = std::max(expected.means[b], 0.01 * whole);
        const double difference = (found[b].mean() - expected.means[b]) / scale,
                     error = found[b].standard_error() / scale;
        worst = std::max(worst, std::abs(difference));
        if (std::abs(difference) > bound + 4 * error)
            wrong += fmt::format("block ({}, {}): {:+.1f} %, standard error {:.1f} %\n", x, y, 100 * difference,
                                 100 * error);
    }
    const double ratio = found.back().mean() / whole, error = found.back().standard_error() / whole;
    const std::string figures =
        fmt::format("brightness ratio {:.4f}, standard error {:.4f}; largest difference of a block {:.1f} %", ratio,
                    error, 100 * worst);
    std::printf("%s: %s\n", r.name.c_str(), figures.c_str());
    EXPECT_LE(std::abs(ratio - 1), r.ratio + 4 * error) << figures;
    EXPECT_EQ(wrong, "") << figures;
}

namespace {

/// Made with Tungsten at 1024 x 1024, in RGB as we are: exact but for noise.
Reference exact(const char* name, const std::string& folder) {
    return {.name = name,
            .scene = "scenes/" + folder + "/scene.pbrt",
            .files = {"scenes/" + folder + "/TungstenRender.exr"},
            .shrink = 8,
            .ratio = 0.01,
            .block = 0.03};
}

/// By pbrt-v4, which is spectral, and Mitsuba at 320 x 240.
Reference peers(const std::string& name) {
    return {.name = name,
            .scene = "scenes/mps/" + name + ".pbrt",
            .files = {"references/mps/" + name + ".a.exr", "references/mps/" + name + ".b.exr"},
            .shrink = 2,
            .ratio = 0.01,
            .block = 0.03};
}

/// By pbrt-v4 at about 128 x 128: within 2 % on grey surfaces and 10 % beside saturated ones and on coateddiffuse.
Reference approximate(const char* name, const std::string& folder, const std::vector<std::string>& files) {
    Reference r{.name = name, .scene = "scenes/" + folder + "/scene.pbrt", .ratio = 0.02, .block = 0.1};
    for (const std::string& file : files) r.files.push_back("references/" + file + ".exr");
    return r;
}

std::vector<Reference> references() {
    std::vector<Reference> list{exact("cornell_box", "cornell-box"),
                                exact("veach_bidir", "veach-bidir"),
                                exact("water_caustic", "water-caustic"),
                                peers("box"),
                                peers("rooms"),
                                peers("lantern"),
                                approximate("veach_ajar", "veach-ajar", {"veach-ajar.a", "veach-ajar.b"}),
                                approximate("coffee", "coffee", {"coffee"}),
                                approximate("dining_room", "dining-room", {"dining-room"}),
                                approximate("bathroom", "bathroom", {"bathroom"})};
    list[5].mask = {55, 35, 95, 80}; // the lantern itself
    // The lamp is 5 x 4 mm, the camera and most of the room are under water.
    list[2].settings = {"method=mps", "mutations=400k", "photons=100k", "brightness_samples=100k"};
    list[2].spp = 1;
    return list;
}

INSTANTIATE_TEST_SUITE_P(Shared, References_Agree, testing::ValuesIn(references()),
                         [](const auto& info) { return info.param.name; });

} // namespace
} // namespace keyhole
