// The scenes after those of papers on Metropolis light transport are what their first lines say.
#include "sampling/paths/walk.h"
#include "scene/load/load.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace keyhole {
namespace {

SceneDescription describe(const std::string& name) {
    return load_scene(std::string(KEYHOLE_SOURCE_DIR "/scenes/") + name + ".yaml").description;
}

std::size_t triangles_of(const SceneDescription& d, const std::string& material) {
    std::size_t n = 0;
    for (const Shape& s : d.shapes)
        if (const auto* mesh = std::get_if<TriangleMesh>(&s.geometry);
            mesh != nullptr && s.material && s.material->kind() == material)
            n += mesh->triangles.size();
    return n;
}

TEST(PaperScenes, Load) {
    const std::map<std::string, std::size_t> emitters{
        {"glossy", 1}, {"egg", 2}, {"tube", 1}, {"ball", 2}, {"disco", 8}};
    for (const auto& [name, count] : emitters) EXPECT_EQ(Scene(describe(name)).emitters().size(), count) << name;
}

TEST(Disco, HasEightyFacetsHalfOfThemMirrors) {
    const SceneDescription d = describe("disco");
    EXPECT_EQ(triangles_of(d, "glass"), 80u);
    EXPECT_EQ(triangles_of(d, "mirror"), 40u);
}

TEST(Tube, LetsLightInAfterManyBouncesOnly) {
    const Scene scene(describe("tube"));
    int entered = 0, few = 0, many = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        Rng rng(1, StreamPurpose::test, i);
        Vertex v = sample_emitter(scene, rng)->vertex;
        Vec3 w = scene.emitter(v.point.emitter).sample_ray(v.point, rng).w;
        int bounces = 0;
        for (; bounces < 200; ++bounces) {
            const auto hit = next_vertex(scene, v, w);
            ASSERT_TRUE(hit) << "the tube leaks";
            v = *hit;
            const auto next = continue_walk(v, -w, From::light, rng);
            if (!next || next->event != Event::reflect) break;
            w = next->w;
        }
        if (!(v.point.p.y < 1.999f)) continue; // back into the lamp
        ++entered;
        few += bounces < 1 ? 1 : 0;
        many += bounces > 3 ? 1 : 0;
    }
    EXPECT_GT(entered, 500);
    EXPECT_EQ(few, 0);
    EXPECT_GT(many, entered / 2);
}

} // namespace
} // namespace keyhole
