// Saved photon maps: the same picture, or a refusal in words.
#include "core/error.h"
#include "methods/method.h"
#include "support/scratch_directory.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST_F(SavedMap, IsOnePass) {
    Settings s = loading();
    s.passes = 2;
    EXPECT_THAT(refusal(*scene_, s), HasSubstr("expected one pass"));
}

} // namespace
} // namespace keyhole
