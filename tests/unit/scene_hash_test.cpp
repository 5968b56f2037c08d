// Scenes that look otherwise have other hashes, also where no light comes; the same scene has the same.
#include "sampling/scene_hash.h"

#include "scene/load/load.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace keyhole {
namespace {

/// A grey PFM of 64 x 64 pixels, one of which is `spot`.
std::string picture(float spot) {
    std::string bytes = "Pf\n64 64\n-1.0\n";
    for (int i = 0; i < 64 * 64; ++i) {
        const float x = i == 2222 ? spot : static_cast<float>(i % 97) / 100;
        bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
    }
    return bytes;
}

/// The light is shut in: nothing of it comes to what is seen.
constexpr const char* kDarkRoom = R"(film: {resolution: [24, 16]}
camera: {from: [0, 0, 3], to: [0, 0, 0], fov: 40}
media: {tea: {absorption: [0.2, 1.1, 6]}, haze: {scattering: 0.1, anisotropy: 0.5}}
materials:
  paper: {type: diffuse, reflectance: {type: image, file: p.pfm, mapping: uv, repeat: [3, 1]}}
  marble: {type: diffuse, reflectance: {type: checkerboard, a: 0.1, b: 0.6, repeat: [5, 5]}}
  glass: {type: dielectric, ior: 1.5}
  ground: {type: dielectric, ior: 1.5, roughness: 0.2}
  metal: {type: conductor, reflectance: [0.9, 0.8, 0.7], roughness: 0.1}
  varnish: {type: coated_diffuse, reflectance: 0.5, ior: 1.4}
  plastic: {type: principled, base_color: [0.2, 0.3, 0.4], specular: 0.4, sheen: 0.1}
shapes:
  - {type: sphere, center: [9, 9, 9], radius: 0.5, emission: {radiance: 60}}
  - {type: box, min: [8, 8, 8], max: [10, 10, 10], material: paper}
  - {type: rectangle, corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], material: paper}
  - {type: sphere, center: [0, 0, -2], material: marble, alpha: 0.7}
  - {type: sphere, center: [0, 0, -4], material: glass, inside: tea}
  - {type: sphere, center: [0, 0, -6], material: ground, outside: haze}
  - {type: sphere, center: [0, 0, -8], material: metal}
  - {type: sphere, center: [0, 0, -10], material: varnish}
  - {type: sphere, center: [0, 0, -12], material: plastic}
)";

class HashOfScene : public testing::Test {
  protected:
    HashOfScene() { directory_.write("p.pfm", picture(0.5f)); }

    /// Of the dark room with `from` replaced.
    std::uint64_t hash(const std::string& from = {}, const std::string& to = {}) const {
        std::string text = kDarkRoom;
        if (!from.empty()) {
            const auto at = text.find(from);
            EXPECT_NE(at, std::string::npos) << from;
            text.replace(at, from.size(), to);
        }
        directory_.write("room.yaml", text);
        return scene_hash(Scene(load_scene(directory_.path("room.yaml")).description));
    }

    ScratchDirectory directory_;
};

TEST_F(HashOfScene, IsTheSameOfTheSameScene) {
    EXPECT_EQ(hash(), hash());
    EXPECT_EQ(hash(), hash("marble: {type", "marble:   {type")) << "a blank";
    EXPECT_EQ(hash(), hash("camera:", "render: {spp: 7}\ncamera:")) << "settings are compared on their own";
}

TEST_F(HashOfScene, SeesEveryNumber) {
    std::set<std::uint64_t> hashes{hash()};
    const std::pair<const char*, const char*> changes[] = {
        {"repeat: [3, 1]", "repeat: [3, 2]"},
        {"a: 0.1", "a: 0.11"},
        {"b: 0.6", "b: 0.61"},
        {"repeat: [5, 5]", "repeat: [5, 6]"},
        {"ior: 1.5}", "ior: 1.51}"},
        {"roughness: 0.2", "roughness: 0.21"},
        {"0.9, 0.8, 0.7", "0.9, 0.8, 0.71"},
        {"roughness: 0.1", "roughness: 0.11"},
        {"reflectance: 0.5", "reflectance: 0.51"},
        {"ior: 1.4", "ior: 1.41"},
        {"0.2, 0.3, 0.4", "0.2, 0.3, 0.41"},
        {"specular: 0.4", "specular: 0.41"},
        {"sheen: 0.1", "sheen: 0.11"},
        {"alpha: 0.7", "alpha: 0.71"},
        {"0.2, 1.1, 6", "0.2, 1.1, 6.1"},
        {"scattering: 0.1", "scattering: 0.11"},
        {"anisotropy: 0.5", "anisotropy: 0.51"},
        {"outside: haze", "inside: haze"},
        {"radiance: 60", "radiance: 61"},
        {"radiance: 60", "radiance: [60, 61, 60]"},
        {"fov: 40", "fov: 41"},
        {"material: metal", "material: varnish"},
        {"radius: 0.5", "radius: 0.51"},
        {"shapes:", "medium: haze\nshapes:"},
        {"shapes:", "emitters: [{type: point, position: [1, 1, 1], intensity: 1}]\nshapes:"},
    };
    for (const auto& [from, to] : changes) EXPECT_TRUE(hashes.insert(hash(from, to)).second) << from << " -> " << to;
}

TEST_F(HashOfScene, SeesEveryPixelOfATexture) {
    const std::uint64_t before = hash();
    directory_.write("p.pfm", picture(0.6f));
    EXPECT_NE(before, hash());
}

/// Light comes through a window there, and finds little of what is seen.
TEST(HashOfKitchen, SeesEveryMaterialTurnBlue) {
    const auto load = [] { return load_scene(KEYHOLE_SOURCE_DIR "/scenes/kitchen.yaml").description; };
    std::vector<std::string> names;
    for (const Shape& shape : load().shapes)
        if (std::ranges::find(names, shape.material_name) == names.end()) names.push_back(shape.material_name);
    ASSERT_GE(names.size(), 15u);
    std::set<std::uint64_t> hashes{scene_hash(Scene(load()))};
    const MaterialPtr blue = make_diffuse(Rgb(0.1, 0.1, 0.9));
    for (const std::string& name : names) {
        SceneDescription description = load();
        for (Shape& shape : description.shapes)
            if (shape.material_name == name) shape.material = blue;
        EXPECT_TRUE(hashes.insert(scene_hash(Scene(std::move(description)))).second) << name;
    }
}

} // namespace
} // namespace keyhole
