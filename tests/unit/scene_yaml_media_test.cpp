// Media, alpha and bumps in scene files.
#include "core/error.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

class SceneYamlMedia : public testing::Test {
  protected:
    SceneDescription load_shapes(const std::string& shapes, const std::string& more = "") {
        return load(directory.write("s.yaml", "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n"
                                              "materials: {white: {type: diffuse}, none: {type: interface}}\n"
                                              "media: {fog: {absorption: 0.1}, tea: {absorption: [1, 2, 3]}}\n" +
                                                  more + "shapes: [" + shapes + "]\n"))
            .description;
    }
    ScratchDirectory directory;
};

} // namespace

TEST_F(SceneYamlMedia, FillWhatTheirBoundariesEnclose) {
    const auto scene = load_shapes("{type: sphere, material: none, inside: tea, outside: fog}, "
                                   "{type: box, material: none, inside: tea}, {type: rectangle, material: white}",
                                   "medium: fog\n");
    ASSERT_EQ(scene.shapes.size(), 3u);
    EXPECT_EQ(scene.shapes[0].inside->absorption, Rgb(1, 2, 3));
    EXPECT_EQ(scene.shapes[0].inside, scene.shapes[1].inside) << "one name, one medium";
    EXPECT_EQ(scene.shapes[0].outside, scene.medium);
    EXPECT_EQ(scene.shapes[1].outside, nullptr) << "a vacuum";
    EXPECT_TRUE(is_interface(scene.shapes[0]));
    EXPECT_FALSE(bounds_media(scene.shapes[2]));
}

TEST_F(SceneYamlMedia, OfAnIncludedPbrtFileStayUnlessOverruled) {
    directory.write("s.pbrt", "MakeNamedMedium \"air\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 5 5 5 ] "
                              "\"rgb sigma_s\" [ 0 0 0 ]\nMediumInterface \"\" \"air\" Camera \"perspective\"\n"
                              "WorldBegin\nShape \"sphere\"\n");
    const auto load_with = [&](const std::string& yaml) {
        return load(directory.write("t.yaml", "include: s.pbrt\n" + yaml)).description;
    };
    EXPECT_EQ(load_with("").medium->absorption, Rgb(5.0));
    EXPECT_EQ(load_with("media: {thin: {absorption: 1}}\nmedium: thin\n").medium->absorption, Rgb(1.0));
}

TEST_F(SceneYamlMedia, AlphaIsANumberOrATexture) {
    const auto scene = load_shapes("{type: rectangle, material: white, alpha: 0.25}, "
                                   "{type: rectangle, material: white, alpha: {type: checkerboard, a: 0, b: 1}}, "
                                   "{type: rectangle, material: white}");
    SurfacePoint there;
    there.uv = {1.5f, 0.5f};
    EXPECT_EQ(scene.shapes[0].alpha->value(there), 0.25);
    EXPECT_EQ(scene.shapes[1].alpha->value(there), 1);
    EXPECT_EQ(scene.shapes[2].alpha, nullptr);
}

TEST_F(SceneYamlMedia, MayScatter) {
    const auto scene = load(directory.write(
        "milk.yaml", "camera: {from: [0, 0, 3], to: [0, 0, 0]}\nmedia: {milk: {scattering: [1, 2, 3], anisotropy: "
                     "0.7}}\nshapes: [{type: sphere, material: {type: interface}, inside: milk}]\n"));
    const Medium& milk = *scene.description.shapes[0].inside;
    EXPECT_EQ(milk.absorption, Rgb(0.0));
    EXPECT_EQ(milk.scattering, Rgb(1, 2, 3));
    EXPECT_EQ(milk.anisotropy, 0.7f);
}

TEST_F(SceneYamlMedia, BumpTurnsTheShadingNormal) {
    const auto scene = load_shapes("{type: rectangle, material: {type: diffuse, bump: {type: mix, a: 0, b: 0.1, "
                                   "amount: {type: image, file: ramp.pfm}}}}",
                                   [&] {
                                       std::string ramp = "Pf\n2 1\n-1.0\n";
                                       const float values[2] = {0, 1};
                                       ramp.append(reinterpret_cast<const char*>(values), sizeof values);
                                       directory.write("ramp.pfm", ramp);
                                       return std::string();
                                   }());
    SurfacePoint middle;
    middle.ng = middle.ns = Vec3(0, 0, 1);
    middle.uv = {0.5f, 0.5f};
    // The height rises by 0.1 m over half of the rectangle's parameter u, which is 1 m here: a slope of 0.2.
    const Vec3 n = scene.shapes[0].material->bsdf(middle).shading_normal();
    EXPECT_NEAR(n.x / n.z, -0.2, 1e-3);
    EXPECT_NEAR(n.y, 0, 1e-4);
}

TEST_F(SceneYamlMedia, MistakesAreErrors) {
    for (const char* shape :
         {"{type: sphere, material: none, inside: milk}", "{type: sphere, material: none, inside: 1}",
          "{type: sphere, material: white, alpha: 1.5}", "{type: sphere, material: white, alpha: x}"})
        EXPECT_THROW(load_shapes(shape), InputError) << shape;
    for (const char* more : {"medium: milk\n", "medium: [tea]\n"})
        EXPECT_THROW(load_shapes("{type: sphere, material: white}", more), InputError) << more;
    const std::string world = "camera: {from: [0, 0, 3], to: [0, 0, 0]}\nshapes: [{type: sphere, material: {type: "
                              "diffuse}}]\n";
    for (const char* media : {"media: {a: {absorption: -1}}\n", "media: {a: {}}\n", "media: {a: 1}\n", "media: 1\n",
                              "media: {a: {scattering: -1}}\n", "media: {a: {scattering: 1, anisotropy: 1}}\n",
                              "media: {a: {anisotropy: 0}}\n"})
        EXPECT_THROW(load(directory.write("bad.yaml", world + media)), InputError) << media;
}

} // namespace keyhole
