// The classic artefacts of photon maps and irradiance caches, each a tiny scene with a number that must stay small.
#include "methods/method.h"
#include "scene/emitters/emitters.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

Settings small_settings() {
    Settings s =
        test::settings_from("spp=8 brightness_samples=50k importons=50k mutations=200k light_paths=200k photons=40k");
    s.method = &methods::ipm; // `auto` may take a method without a gather
    return s;
}

bool warns(Scene& scene, const Settings& settings, const std::string& of) {
    const std::vector<std::string> warnings = render(scene, settings, {}).stats.warnings;
    return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(of) != std::string::npos; });
}

/// Luminance of one layer.
struct Grey {
    int width, height;
    std::vector<double> data;

    double at(int x, int y) const { return data[static_cast<std::size_t>(y * width + x)]; }
    double mean(int x0, int x1) const {
        double sum = 0;
        for (int y = 0; y < height; ++y)
            for (int x = x0; x < x1; ++x) sum += at(x, y);
        return sum / (height * (x1 - x0));
    }
};

Grey render_layer(Scene& scene, const Settings& settings, const std::string& layer) {
    const Picture picture = render(scene, settings, {}).picture;
    const Image& image = picture.layers.at(layer);
    Grey grey{image.width, image.height, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* p = image.at(x, y);
            grey.data.push_back(luminance(Rgb(p[0], p[1], p[2])));
        }
    return grey;
}

TEST(Gallery, NoLightLeaksUnderAThinWall) {
    // A floor with a wall across it, seen from above. The lamp stands left of the wall, and lower than its top: nothing
    // reaches the right half. All of it is one floor to a density estimate.
    const auto white = make_diffuse(Rgb(0.8));
    test::SceneMaker m;
    m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white)
        .rectangle({0, 0, -1}, {0, 0, 2}, {0, 1, 0}, white)
        .emitter(make_point_emitter({-0.5f, 0.3f, 0}, Rgb(5.0)))
        .camera({0, 4, 0.01f}, {0, 0, 0}, 24)
        .window(40, 40);
    const auto scene = m.build();
    const Grey grey = render_layer(*scene, small_settings(), "indirect");
    const double lit = grey.mean(4, 17), dark = grey.mean(23, 36);
    EXPECT_GT(lit, 0.01);
    EXPECT_LT(dark / lit, 2e-3);
}

TEST(Gallery, RecordsDoNotShineThroughAWall) {
    // The same, with a lamp of a hundredth of the power on the right, right beside the wall: records are used over
    // eight pixels at least, and stand on one floor.
    const auto white = make_diffuse(Rgb(0.8));
    const auto beside_wall = [&](double left) {
        test::SceneMaker m;
        m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, white)
            .rectangle({0, 0, -1}, {0, 0, 2}, {0, 1, 0}, white)
            .emitter(make_point_emitter({0.5f, 0.3f, 0}, Rgb(0.05)))
            .camera({0, 4, 0.01f}, {0, 0, 0}, 24)
            .window(40, 40);
        if (left > 0) m.emitter(make_point_emitter({-0.5f, 0.3f, 0}, Rgb(left)));
        const auto scene = m.build();
        Settings settings = small_settings();
        settings.cache_min_reach = 8;
        return render_layer(*scene, settings, "indirect").mean(21, 24);
    };
    const double alone = beside_wall(0);
    EXPECT_GT(alone, 0);
    EXPECT_LT(beside_wall(5) / alone, 1.5) << "76 where records go on behind the wall";
}

TEST(Gallery, CornersAreNotDarkened) {
    // A closed box of uniform emission has the same radiance everywhere, corners included.
    const auto scene_of = [] {
        test::SceneMaker m;
        m.room({-1, -1, -1}, {1, 1, 1}, make_diffuse(Rgb(0.5)), Rgb(1.0));
        m.camera({0.5f, 0.5f, 0.5f}, {-1, -1, -1}, 20).window(32, 32);
        return m.build();
    };
    const auto scene = scene_of();
    const Grey grey = render_layer(*scene, small_settings(), "indirect");
    double worst = 0;
    constexpr int kBlock = 4;
    for (int y = 0; y < grey.height; y += kBlock)
        for (int x = 0; x < grey.width; x += kBlock) {
            double sum = 0;
            for (int i = 0; i < kBlock * kBlock; ++i) sum += grey.at(x + i % kBlock, y + i / kBlock);
            worst = std::max(worst, std::abs(sum / (kBlock * kBlock) / 0.5 - 1));
        }
    EXPECT_LT(worst, 0.06);
}

TEST(Gallery, CrevicesHaveTheirLight) {
    // A board 12 cm before a wall, seen from before the mouth between them. Far in there, few photons fall or none, and
    // gather rays meet nothing else: it is not as dark as that, and not as bright as the room.
    test::SceneMaker m;
    const auto white = make_diffuse(Rgb(0.7));
    m.room({-1, 0, -1}, {1, 2, 3}, white);
    m.rectangle({0.88f, 0, -1}, {0, 2, 0}, {0, 0, 1}, white, Rgb(0.0), true);
    m.rectangle({-0.3f, 1.95f, 1}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_diffuse(Rgb(0.0)), Rgb(20.0));
    m.camera({0.94f, 1, 1.5f}, {0.94f, 1, -1}, 3.6f).window(24, 24);
    const auto scene = m.build();
    const auto mean = [&](const char* method, int seeds) {
        Settings settings = small_settings();
        settings.method = &method_named(method);
        settings.light_paths = 2000;
        double sum = 0;
        for (int seed = 1; seed <= seeds; ++seed) {
            settings.seed = seed;
            sum += render_layer(*scene, settings, "indirect").mean(0, 24) / seeds;
        }
        return sum;
    };
    EXPECT_NEAR(mean("ipm", 32) / mean("path", 64), 1, 0.12);
}

TEST(Gallery, LowQualityShowsNoDiscs) {
    // A plain wall. Records are few and noisy, but their borders make no step from pixel to pixel.
    test::SceneMaker m;
    m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.7)));
    m.rectangle({-0.1f, 1.95f, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, make_diffuse(Rgb(0.0)), Rgb(60.0));
    m.camera({0, 1, 2}, {0, 1, -1}, 30).window(64, 64);
    const auto scene = m.build();
    Settings settings = small_settings();
    settings.cache_rays = 64;
    settings.cache_error = 0.5;
    const Grey grey = render_layer(*scene, settings, "indirect");
    std::vector<double> steps;
    for (int y = 0; y < grey.height; ++y)
        for (int x = 0; x + 1 < grey.width; ++x) steps.push_back(std::abs(grey.at(x + 1, y) - grey.at(x, y)));
    EXPECT_LT(*std::max_element(steps.begin(), steps.end()) / grey.mean(0, grey.width), 0.05);
}

TEST(Gallery, CloseGatherHitsLeaveNoSpeckles) {
    // A lamp close to a corner: what gather rays find there is a thousand times brighter than the rest.
    test::SceneMaker m;
    m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.7)));
    m.rectangle({-0.95f, 0.1f, -0.95f}, {0, 0, 0.1f}, {0.1f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(200.0));
    m.camera({0.3f, 0.8f, 0.8f}, {-0.8f, 0.2f, -0.8f}, 40).window(48, 48);
    const auto scene = m.build();
    const Grey grey = render_layer(*scene, small_settings(), "indirect");
    double worst = 0;
    for (int y = 2; y + 2 < grey.height; ++y)
        for (int x = 2; x + 2 < grey.width; ++x) {
            std::vector<double> around;
            for (int i = 0; i < 25; ++i) around.push_back(grey.at(x - 2 + i % 5, y - 2 + i / 5));
            std::nth_element(around.begin(), around.begin() + 20, around.end());
            worst = std::max(worst, grey.at(x, y) / around[20]);
        }
    EXPECT_LT(worst, 1.3);
}

TEST(Gallery, ACacheThatKnowsLittleOfWhatIsSeenSaysSo) {
    // A cloud of balls far smaller than a pixel: each sample meets another one, of which no record can be there. And a
    // plain room, of which the cache knows everything.
    const auto warned = [](int balls) {
        test::SceneMaker m;
        m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.7)));
        m.rectangle({-0.3f, 1.95f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_diffuse(Rgb(0.0)), Rgb(20.0));
        Rng rng(1, StreamPurpose::test, 0);
        for (int i = 0; i < balls; ++i) {
            const auto at = [&](float from, float to) { return std::lerp(from, to, static_cast<float>(rng.next())); };
            const float x = at(-0.9f, 0.9f), y = at(0.1f, 1.7f), z = at(-0.9f, 0);
            m.sphere({x, y, z}, 0.01f, make_diffuse(Rgb(0.5)));
        }
        m.camera({0, 1, 2}, {0, 1, -1}, 50).window(24, 24);
        const auto scene = m.build();
        return warns(*scene, small_settings(), "irradiance cache has no record");
    };
    EXPECT_TRUE(warned(8000));
    EXPECT_FALSE(warned(0));
}

TEST(Gallery, GatherRaysThatHardlyFindLightSaySo) {
    // Two rooms, a lamp in one and the eye in the other, and a door between them: wide, or a crack.
    const auto warned = [](float door) {
        test::SceneMaker m;
        const auto white = make_diffuse(Rgb(0.7));
        m.room({-2, 0, -1}, {2, 2, 1}, white);
        m.rectangle({0, 0, -1}, {0, 2, 0}, {0, 0, 1 - door / 2}, white);
        m.rectangle({0, 0, door / 2}, {0, 2, 0}, {0, 0, 1 - door / 2}, white);
        m.rectangle({-1.5f, 1.95f, 0.4f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_diffuse(Rgb(0.0)), Rgb(20.0));
        m.camera({0.3f, 1, -0.8f}, {2, 1, 0.3f}, 60).window(24, 16);
        const auto scene = m.build();
        Settings settings = small_settings();
        settings.gather_coverage = false;
        settings.find_openings = false; // else gather rays of one seed in four seem to find enough
        settings.light_paths = 100'000;
        return warns(*scene, settings, "so few gather rays find light");
    };
    EXPECT_TRUE(warned(0.002f));
    EXPECT_FALSE(warned(0.8f));
}

/// A point light over a floor and a mirror beside it, seen from above: what it throws on the floor has sharp edges, and
/// is known in closed form from the light's mirror image.
class CausticEdges : public testing::TestWithParam<const char*> {
  protected:
    static constexpr int kSize = 64;

    static std::unique_ptr<Scene> make() {
        test::SceneMaker m;
        m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, make_diffuse(Rgb(0.6)))
            .rectangle({1, 0.2f, -0.3f}, {0, 0.4f, 0}, {0, 0, 0.6f}, make_mirror(Rgb(0.9)), Rgb(0.0), true)
            .emitter(make_point_emitter({0, 1, 0}, Rgb(5.0)))
            .camera({0, 4, 0.001f}, {0, 0, 0}, 28)
            .window(kSize, kSize);
        return m.build();
    }
    /// Where a ray through window point (u, v) meets the floor, which fills the picture.
    static Vec3 on_floor(const Scene& scene, float u, float v) {
        const SurfacePoint eye = scene.camera().eye(0, 0);
        const Vec3 w = scene.camera().ray_direction(eye, {u, v});
        return eye.p + w * (eye.p.y / -w.y);
    }
    /// Irradiance up to a factor, 0 outside. `margin`: how far the edges of the mirror are moved out, as seen from the
    /// light's image [m].
    static double exact(const Vec3& p, double margin) {
        const Imath::V3d image(2, 1, 0), d = Imath::V3d(p) - image;
        const double t = -1 / d.x; // where the way from there passes the plane of the mirror
        if (!(t > 0)) return 0;
        const double y = 1 + t * d.y, z = t * d.z;
        const bool inside = y > 0.2 - margin && y < 0.6 + margin && std::abs(z) < 0.3 + margin;
        return inside ? 1 / std::pow(d.length(), 3) : 0;
    }
};

TEST_P(CausticEdges, AreSharpAndNeitherDarkNorBright) {
    const auto scene = make();
    Settings settings = small_settings();
    settings.method = &method_named(GetParam());
    settings.light_paths = 2'000'000;
    settings.mutations = 2'000'000;
    settings.photons = 200'000;
    const Grey grey = render_layer(*scene, settings, "caustic");
    // Lookups reach a fiftieth of the scene at most, two pixels here; seen at the mirror, that is less than this.
    constexpr double kEdge = 0.06;
    double found = 0, expected = 0, outside = 0, total = 0;
    std::vector<std::pair<double, double>> inside;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const Vec3 p =
                on_floor(*scene, (static_cast<float>(x) + 0.5f) / kSize, (static_cast<float>(y) + 0.5f) / kSize);
            total += grey.at(x, y);
            if (exact(p, kEdge) == 0) outside += grey.at(x, y);
            if (const double e = exact(p, -kEdge); e > 0) {
                inside.emplace_back(grey.at(x, y), e);
                found += grey.at(x, y);
                expected += e;
            }
        }
    ASSERT_GT(inside.size(), 200u);
    double square = 0;
    for (const auto& [a, e] : inside) square += std::pow(a * expected / (e * found) - 1, 2);
    EXPECT_LT(outside / total, 0.01);
    EXPECT_LT(std::sqrt(square / static_cast<double>(inside.size())), 0.1);
}

INSTANTIATE_TEST_SUITE_P(Gallery, CausticEdges, testing::Values("ipm", "mps", "pm"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
