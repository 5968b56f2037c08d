// Alpha and Cryptomatte: what covers pixels, in files as others read them.
#include "film/cryptomatte.h"
#include "film/files/exr.h"
#include "methods/method.h"
#include "methods/render.h"
#include "scene/emitters/emitters.h"
#include "support/program.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>

#include <bit>
#include <numeric>

namespace keyhole {
namespace {

using testing::HasSubstr;

TEST(Murmur3, HasItsKnownValues) {
    EXPECT_EQ(murmur3_32(""), 0u);
    EXPECT_EQ(murmur3_32("hello"), 0x248bfa47u);
    EXPECT_EQ(murmur3_32("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(murmur3_32("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(CryptomatteId, IsAnOrdinaryNumberAsAFloat) {
    for (int i = 0; i < 10'000; ++i) {
        const std::string name = "name " + std::to_string(i);
        const std::uint32_t id = cryptomatte_id(name), hash = murmur3_32(name);
        EXPECT_TRUE(std::isnormal(std::bit_cast<float>(id))) << name;
        EXPECT_TRUE(id == hash || id == (hash ^ 1u << 23)) << name;
    }
}

TEST(CryptomatteLayers, RankNamesByCoverage) {
    CryptomatteLayers layers("CryptoObject", 1, 1);
    std::vector<std::int64_t> samples{2, 0, 1, 2, 2, -1, 0, 2};
    const std::vector<std::string> names{"a", "b", "c"};
    layers.set(0, 0, samples, {cryptomatte_id("a"), cryptomatte_id("b"), cryptomatte_id("c")});
    Picture picture;
    std::move(layers).add_to(picture, names);
    const auto first = picture.layers.at("CryptoObject00").data, second = picture.layers.at("CryptoObject01").data;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(first[0]), cryptomatte_id("c"));
    EXPECT_EQ(first[1], 0.5f);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(first[2]), cryptomatte_id("a"));
    EXPECT_EQ(first[3], 0.25f);
    EXPECT_EQ(std::bit_cast<std::uint32_t>(second[0]), cryptomatte_id("b"));
    EXPECT_EQ(second[1], 0.125f);
    EXPECT_EQ(second[3], 0);
}

class MasksOfAFile : public Program {
  protected:
    void SetUp() override {
        scratch.write(
            "scene.yaml",
            "film: {resolution: [24, 16], transparent: true}\n"
            "camera: {from: [0, 0, 6], to: [0, 0, 0]}\n"
            "materials: {clay: {type: diffuse}, \"say \\\"x\\\"\": {type: diffuse}}\n"
            "groups: {pair: [{type: sphere, material: clay, transform: {translate: [1.2, 0, 0]}},\n"
            "                {type: sphere, name: own, material: clay, transform: {translate: [1.2, 4, 0]}}]}\n"
            "shapes:\n"
            "  - {type: sphere, name: ball, material: \"say \\\"x\\\"\", transform: {translate: [-1.2, 0, 0]}}\n"
            "  - {type: instance, group: pair, name: both}\n"
            "emitters: [{type: environment, radiance: [1, 2, 3]}]\n"
            "render: {method: path, spp: 4, cryptomatte: true}\n");
    }
};

TEST_F(MasksOfAFile, AreCoveredByWhatMediaTake) {
    scratch.write("cloud.yaml", "film: {resolution: [16, 16], transparent: true}\n"
                                "camera: {from: [0, 0, 9], to: [0, 0, 0], fov: 60}\n"
                                "media: {smoke: {absorption: 0.2, scattering: 0.3}}\n"
                                "shapes: [{type: box, min: [-2, -2, -2], max: [2, 2, 2], material: {type: interface}, "
                                "inside: smoke}]\n"
                                "emitters: [{type: environment, radiance: 1}]\n"
                                "render: {method: path, spp: 1}\n");
    ASSERT_EQ(run("render cloud.yaml -q"), 0) << read("err");
    const Image alpha = read_exr(scratch.path("cloud.exr")).layers.at("alpha");
    EXPECT_NEAR(alpha.at(8, 8)[0], 1 - std::exp(-0.5 * 4), 0.01);
    EXPECT_EQ(alpha.at(0, 0)[0], 0);
}

TEST_F(MasksOfAFile, TellObjectsMaterialsAndAlpha) {
    ASSERT_EQ(run("render scene.yaml -q"), 0) << read("err");
    const Picture p = read_exr(scratch.path("scene.exr"));
    EXPECT_EQ(p.layers.at("beauty").channels, 3);
    const Image& alpha = p.layers.at("alpha");
    EXPECT_EQ(alpha.at(0, 0)[0], 0);
    EXPECT_EQ(p.layers.at("beauty").at(0, 0)[2], 0) << "the sky is not seen";
    EXPECT_GT(p.layers.at("beauty").at(7, 8)[2], 0.5f) << "but shines";
    EXPECT_EQ(alpha.at(7, 8)[0], 1);
    const auto id = [&](const char* layer, int x) {
        const float* at = p.layers.at(layer).at(x, 8);
        EXPECT_EQ(at[1], 1);
        return std::bit_cast<std::uint32_t>(at[0]);
    };
    EXPECT_EQ(id("CryptoObject00", 7), cryptomatte_id("ball"));
    EXPECT_EQ(id("CryptoObject00", 16), cryptomatte_id("both"));
    EXPECT_EQ(id("CryptoMaterial00", 7), cryptomatte_id("say \"x\""));
    EXPECT_EQ(id("CryptoMaterial00", 16), cryptomatte_id("clay"));
    for (std::size_t i = 0; i < alpha.data.size(); ++i) {
        float covered = 0;
        for (const char* layer : {"CryptoObject00", "CryptoObject01", "CryptoObject02"})
            covered += p.layers.at(layer).data[4 * i + 1] + p.layers.at(layer).data[4 * i + 3];
        EXPECT_NEAR(covered, alpha.data[i], 1e-6);
    }
    const std::string key = fmt::format("cryptomatte/{:08x}", murmur3_32("CryptoObject")).substr(0, 19) + "/";
    EXPECT_EQ(p.metadata.at(key + "name"), "CryptoObject");
    EXPECT_EQ(p.metadata.at(key + "hash"), "MurmurHash3_32");
    EXPECT_EQ(p.metadata.at(key + "conversion"), "uint32_to_float32");
    const auto entry = [](const char* name) { return fmt::format("\"{}\":\"{:08x}\"", name, cryptomatte_id(name)); };
    EXPECT_EQ(p.metadata.at(key + "manifest"), fmt::format("{{{},{},{}}}", entry("ball"), entry("both"), entry("own")));
}

TEST_F(MasksOfAFile, OutliveMerging) {
    ASSERT_EQ(run("render scene.yaml -q -o a.exr"), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml -q -o b.exr --seed 2"), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml -q -o c.exr --passes 4 --pass-range 0:2"), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml -q -o d.exr --passes 4 --pass-range 2:4"), 0) << read("err");
    const Picture a = read_exr(scratch.path("a.exr"));
    for (const char* parts : {"a.exr b.exr", "c.exr d.exr"}) {
        ASSERT_EQ(run(std::string("merge ") + parts + " -o m.exr --no-png"), 0) << read("err");
        const Picture m = read_exr(scratch.path("m.exr"));
        for (const char* layer : {"alpha", "CryptoObject00", "CryptoMaterial00"}) {
            const auto& x = a.layers.at(layer).data;
            const auto& y = m.layers.at(layer).data;
            EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(float)), 0) << parts << " " << layer;
        }
    }
}

/// Mean brightness of the whole picture, and what its upper left pixel shows.
std::pair<double, float> shown(const char* method, bool sees_surroundings) {
    SceneDescription d;
    Shape& ball = d.shapes.emplace_back();
    ball.geometry = Sphere{{0, 0, 0}, 1};
    ball.material = make_diffuse(Rgb(0.6));
    d.emitters.push_back(make_constant_environment(Rgb(1.0)));
    d.camera.origin = {0, 0, 4};
    d.camera.sees_surroundings = sees_surroundings;
    d.window = {24, 16, 0};
    Scene scene(std::move(d));
    Settings s = test::settings_from(
        "spp=16 brightness_samples=20k importons=10k mutations=100k light_paths=50k photons=20k chains=50");
    s.method = &method_named(method);
    const Image beauty = render(scene, s, {}).picture.layers.at("beauty");
    return {std::accumulate(beauty.data.begin(), beauty.data.end(), 0.0) / static_cast<double>(beauty.data.size()),
            beauty.data[0]};
}

TEST(TransparentFilm, ShowsNoSurroundingsByAnyMethod) {
    // What is left is the ball, of radiance 0.6.
    const double whole = shown("path", true).first, ball = shown("path", false).first;
    EXPECT_NEAR((1 - whole) / ball, 0.4 / 0.6, 0.02);
    for (const char* method : {"bdpt", "mlt", "pssmlt", "mmlt", "rjmlt", "pm", "ipm", "mps"}) {
        const auto [mean, corner] = shown(method, false);
        EXPECT_EQ(corner, 0) << method;
        EXPECT_NEAR(mean / ball, 1, 0.05) << method;
        EXPECT_NEAR(shown(method, true).second, 1, 0.2) << method;
    }
}

} // namespace
} // namespace keyhole
