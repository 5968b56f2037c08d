// Saved photon maps: the same picture, or a refusal in words.
#include "core/error.h"
#include "methods/method.h"
#include "sampling/guidance/user_paths.h"
#include "support/scratch_directory.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

namespace keyhole {
namespace {

using testing::HasSubstr;

Settings small_settings() { return test::settings_from("method=pm spp=1 light_paths=5k"); }

std::string refusal(Scene& scene, const Settings& settings) {
    try {
        render(scene, settings, {});
    } catch (const InputError& e) {
        return e.what();
    }
    return "none";
}

class SavedMap : public testing::Test {
  protected:
    void SetUp() override {
        Settings s = small_settings();
        s.save_map = file_;
        picture_ = render(*scene_, s, {}).picture;
    }
    Settings loading() const {
        Settings s = small_settings();
        s.method = &methods::automatic; // not asked: the photons are there
        s.load_map = file_;
        return s;
    }
    /// Changes one byte of the file.
    void damage(std::streamoff offset) const {
        std::fstream f(file_, std::ios::binary | std::ios::in | std::ios::out);
        f.seekg(offset);
        const auto byte = static_cast<char>(f.get() ^ 1);
        f.seekp(offset);
        f.put(byte);
    }

    ScratchDirectory directory_;
    std::string file_ = directory_.path("map.photons");
    std::unique_ptr<Scene> scene_ = test::mirror_glass_box();
    Picture picture_;
};

TEST_F(SavedMap, MakesTheSamePicture) {
    const Picture again = render(*scene_, loading(), {}).picture;
    for (const auto& [name, image] : picture_.layers) EXPECT_EQ(image.data, again.layers.at(name).data) << name;
}

TEST_F(SavedMap, IsReplacedByNoPartOfAnother) {
    const auto content = [this] {
        std::ifstream stream(file_, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    };
    const auto stopped = [this] {
        Settings s = small_settings();
        s.light_paths = 1'000'000'000;
        s.save_map = file_;
        StopToken stop;
        stop.set_cpu_limit(cpu_seconds() + 0.2);
        RunContext context;
        context.stop = &stop;
        return render(*scene_, s, context).stats.warnings;
    };
    const std::string good = content();
    EXPECT_THAT(stopped(), testing::Contains(HasSubstr("were there: the older file stays")));
    EXPECT_EQ(content(), good);
    std::filesystem::remove(file_);
    EXPECT_THAT(stopped(), testing::Contains(HasSubstr("were there: the file has a part of them")));
    EXPECT_TRUE(std::filesystem::exists(file_));
}

/// Rough metal asks the map in another way where its photons lie wherever light comes.
TEST(SavedMapOfAll, MakesTheSamePictureOfRoughMetal) {
    const auto value = [](double x) { return constant_texture(x); };
    const MaterialPtr metal = make_conductor(constant_texture(Rgb(0.8)), value(0.2), value(0.2));
    test::SceneMaker m;
    const auto scene = m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.6)))
                           .rectangle({-0.5f, 1.9f, -0.5f}, {0, 0, 1}, {1, 0, 0}, make_black(), Rgb(5.0))
                           .rectangle({-0.9f, 0.01f, -0.9f}, {0, 0, 2}, {1.8f, 0, 0}, metal)
                           .sphere({0.3f, 0.5f, 0}, 0.4f, metal)
                           .camera({0, 1, 2.9f}, {0, 0.95f, -1}, 50)
                           .window(24, 16)
                           .build();
    ScratchDirectory directory;
    Settings s = small_settings();
    s.method = &methods::ipm;
    s.gather_coverage = false;
    s.save_map = directory.path("map.photons");
    const Image saved = render(*scene, s, {}).picture.layers.at("beauty");
    std::swap(s.save_map, s.load_map);
    EXPECT_EQ(render(*scene, s, {}).picture.layers.at("beauty").data, saved.data);
}

TEST_F(SavedMap, IsRefusedForAnotherScene) {
    auto other = test::diffuse_box();
    EXPECT_THAT(refusal(*other, loading()), HasSubstr("another scene"));
    auto moved = test::mirror_glass_box(0.01f); // another lens
    EXPECT_THAT(refusal(*moved, loading()), HasSubstr("another scene"));
}

/// Of what a picture shows and a map of another shape lacks there is no trace: the light is missing.
class SavedMapOfWhatIsSeen : public testing::TestWithParam<const char*> {};

TEST_P(SavedMapOfWhatIsSeen, IsRefusedForAnotherShapeOfThePicture) {
    const auto scene = test::mirror_glass_box();
    ScratchDirectory directory;
    Settings s = test::settings_from(GetParam(), small_settings());
    scene->set_window({24, 16, 0});
    s.save_map = directory.path("map.photons");
    render(*scene, s, {});
    std::swap(s.save_map, s.load_map);
    for (const auto& [width, height] : {std::pair(48, 16), {16, 16}, {16, 24}}) {
        scene->set_window({width, height, 0});
        EXPECT_THAT(refusal(*scene, s), HasSubstr("found the photon map of a picture of 24x16"));
        EXPECT_THAT(refusal(*scene, s), HasSubstr(fmt::format("expected one of the shape of {}x{}", width, height)));
    }
    for (const auto& [width, height] : {std::pair(24, 16), {48, 32}, {19, 13}, {12, 8}}) {
        scene->set_window({width, height, 0});
        EXPECT_EQ(refusal(*scene, s), "none") << width << "x" << height << ": the same shape, to a pixel";
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, SavedMapOfWhatIsSeen,
                         testing::Values("method=mps mutations=5k brightness_samples=5k importons=5k",
                                         "method=ipm importons=5k plan=all"),
                         [](const auto& info) { return std::string(info.param, 7, 3); });

TEST_F(SavedMap, IsGoodForAnotherShapeWhereItsPhotonsLieEverywhere) {
    scene_->set_window({16, 40, 0});
    EXPECT_EQ(refusal(*scene_, loading()), "none");
}

TEST_F(SavedMap, SaysWhatHasNoSayWhereItIsLoaded) {
    Settings s = loading();
    EXPECT_THAT(render(*scene_, s, {}).stats.remarks, testing::Not(testing::Contains(HasSubstr("--load-map"))));
    s.photons = 100;
    s.photon_memory = 1 << 18;
    const UserPathFile paths = load_user_paths(
        directory_.write("p.yaml", "paths: [{points: [[0, 1.95, 0], [0.6, 0, -0.7], [-1, 1, 0.5]]}]\n"));
    const RenderStats stats = render(*scene_, s, {}, paths).stats;
    EXPECT_THAT(stats.remarks, testing::Contains(HasSubstr("photons=100 has no effect with --load-map")));
    EXPECT_THAT(stats.remarks, testing::Contains(HasSubstr("user paths have no effect with --load-map")));
    EXPECT_THAT(stats.warnings, testing::Contains(HasSubstr("photon_memory holds"))) << "whatever `photons` says";
}

TEST_F(SavedMap, IsRefusedForAnotherDepth) {
    Settings s = loading();
    s.max_depth = 5;
    EXPECT_THAT(refusal(*scene_, s), HasSubstr("max_depth=24, expected max_depth=5"));
}

TEST_F(SavedMap, IsRefusedForAnotherReach) {
    Settings s = loading();
    s.plan = Plan::all; // also light outside the coverage of gather rays, which the map gathers
    EXPECT_THAT(refusal(*scene_, s), HasSubstr("nothing outside the coverage of gather rays"));
}

TEST_F(SavedMap, IsRefusedWhereItIsNoWholeMap) {
    damage(0);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("found no photon map"));
    damage(0);
    damage(12);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("version"));
    damage(12);
    damage(1000);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("damaged"));
    damage(1000);
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("damaged"));
    std::filesystem::resize_file(file_, 10);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("found no photon map"));
    std::filesystem::remove(file_);
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("cannot be opened"));
}

TEST_F(SavedMap, IsRefusedWhereItsCountsAreOthersOfTheSameSum) {
    std::fstream f(file_, std::ios::binary | std::ios::in | std::ios::out);
    constexpr std::streamoff kCounts = 40; // in the header
    std::array<std::uint64_t, 4> counts{};
    const auto bytes = static_cast<std::streamsize>(sizeof counts);
    f.seekg(kCounts);
    f.read(reinterpret_cast<char*>(counts.data()), bytes);
    ASSERT_GT(counts[1], 0u);
    --counts[1], ++counts[2];
    f.seekp(kCounts);
    f.write(reinterpret_cast<const char*>(counts.data()), bytes);
    f.close();
    EXPECT_THAT(refusal(*scene_, loading()), HasSubstr("damaged"));
}

TEST_F(SavedMap, IsOnePass) {
    Settings s = loading();
    s.passes = 2;
    EXPECT_THAT(refusal(*scene_, s), HasSubstr("expected one pass"));
}

} // namespace
} // namespace keyhole
