// A render that several did shares of, or that was broken off, is the one that one run makes, bit for bit.
#include "core/error.h"
#include "core/parallel.h"
#include "film/join.h"
#include "methods/render.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace keyhole {
namespace {

class Shares : public testing::TestWithParam<const char*> {
  protected:
    static Settings settings() {
        Settings s = test::settings_from("passes=4 spp=2 brightness_error=0.05 importons=5k chains=40 chain_groups=3 "
                                         "mutations=8k light_paths=8k photons=5k");
        s.method = &method_named(GetParam());
        s.brightness_samples = 2'000; // more than one round of them
        return s;
    }
    static RenderResult make(const WorkPartition& share, int threads = 2, const Settings& s = settings()) {
        RenderResult result;
        with_threads(threads, [&] {
            const auto scene = test::mirror_glass_box();
            scene->set_window({24, 16, 0});
            result = render(*scene, s, {}, {}, share);
        });
        for (const auto& [key, value] : {std::pair("program", "p"),
                                         {"scene hash", "h"},
                                         {"settings", "spp=2"},
                                         {"seed", "1"},
                                         {"user paths", "none"}})
            result.picture.metadata[key] = value;
        return result;
    }
    static NamedPicture passes(std::int64_t begin, std::int64_t end, int threads) {
        WorkPartition share;
        share.first_pass = begin;
        share.end_pass = end;
        share.keep_sums = true;
        return {std::to_string(begin), make(share, threads).picture};
    }
    static void expect_same(const Picture& a, const Picture& b) {
        EXPECT_EQ(a.layers.size(), b.layers.size());
        for (const auto& [name, image] : a.layers) EXPECT_EQ(image.data, b.layers.at(name).data) << name;
    }
};

TEST_P(Shares, JoinedAreTheWhole) {
    const Picture whole = make({}).picture;
    const std::vector<NamedPicture> shares{passes(3, 4, 1), passes(0, 1, 3), passes(1, 3, 4)};
    expect_same(join_pictures(shares), whole);
    // In two steps, the first of which leaves a gap.
    const NamedPicture ends{"ends", join_pictures(std::span(shares).first(2))};
    EXPECT_FALSE(ends.picture.sums.empty());
    const Picture joined = join_pictures(std::vector{shares[2], ends});
    expect_same(joined, whole);
    EXPECT_TRUE(joined.sums.empty());
    EXPECT_EQ(joined.metadata.at("complete"), "yes");
}

TEST_P(Shares, OfOneUnitEachAreTheWholeThoughSomeHaveNoSamples) {
    Settings s = settings();
    s.passes = 1;
    s.chain_groups = 4; // more than there are samples of a pixel to share out
    const RenderResult whole = make({}, 2, s);
    std::vector<NamedPicture> shares;
    for (std::int64_t unit = 0;; ++unit) {
        WorkPartition share;
        share.keep_sums = true;
        share.processes = 8; // more than there are passes, so that units are handed out one by one
        bool given = false;
        share.take_number = [&]() -> std::optional<std::int64_t> {
            if (std::exchange(given, true)) return std::nullopt;
            return unit;
        };
        const Picture picture = make(share, 2, s).picture;
        if (!picture.metadata.contains("units") || picture.metadata.at("units").empty()) break;
        shares.push_back({std::to_string(unit), picture});
    }
    const Picture joined = join_pictures(shares);
    expect_same(joined, whole.picture);
    EXPECT_EQ(joined.metadata.at("complete"), "yes");
    EXPECT_NEAR(std::stod(joined.metadata.at("samples")), whole.stats.samples, 1e-6 * whole.stats.samples);
}

TEST_P(Shares, OfABrokenOffRenderAreGoneOnFrom) {
    std::vector<Picture> saved;
    WorkPartition saving;
    saving.save = [&](const Picture& p) { saved.push_back(p); };
    saving.save_every = 0;
    const RenderResult whole = make(saving);
    expect_same(whole.picture, make({}).picture);
    ASSERT_GE(saved.size(), 5u);
    for (const Picture& done : {saved[0], saved[saved.size() / 2], saved.back()}) {
        WorkPartition resuming;
        resuming.done = &done;
        const RenderResult rest = make(resuming, 3);
        expect_same(rest.picture, whole.picture);
        EXPECT_TRUE(rest.stats.complete);
        EXPECT_EQ(rest.stats.passes, 4);
        EXPECT_EQ(rest.stats.values.at("relative error"), whole.stats.values.at("relative error"));
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, Shares,
                         testing::Values("mps", "ipm", "pm", "mlt", "path", "bdpt", "pssmlt", "mmlt", "rjmlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
