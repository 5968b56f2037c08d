// The scenes that come with the program: they load, are as large and as closed as they say, and are what generate.py
// makes.
#include "core/rng.h"
#include "scene/load/load.h"
#include "scene/warp.h"
#include "support/scratch_directory.h"
#include "support/signed_volume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <tuple>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = KEYHOLE_SOURCE_DIR;

SceneDescription describe(const std::string& file) { return load_scene((kRoot / file).string()).description; }

std::string content(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// File names, and what the files hold.
std::map<std::string, std::string> files_in(const fs::path& directory) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(directory)) {
        if (entry.is_regular_file()) files[entry.path().filename().string()] = content(entry.path());
    }
    return files;
}

/// Same names with same bytes; lists what differs, not the bytes.
void expect_same_files(const fs::path& made, const fs::path& committed) {
    const auto a = files_in(made), b = files_in(committed);
    EXPECT_FALSE(a.empty());
    std::ostringstream differences;
    for (const auto& [name, bytes] : a) {
        if (!b.contains(name))
            differences << name << " is not committed\n";
        else if (b.at(name) != bytes)
            differences << name << " is not what generate.py writes\n";
    }
    for (const auto& [name, bytes] : b) {
        if (!a.contains(name)) differences << name << " is not written by generate.py\n";
    }
    EXPECT_EQ(differences.str(), "");
}

/// How many directed edges have no opposite: 0 for closed bodies whose outsides agree.
std::size_t open_edges(const TriangleMesh& mesh) {
    using Corner = std::tuple<float, float, float>;
    std::map<std::pair<Corner, Corner>, int> edges;
    const auto corner = [&](std::uint32_t i) {
        const Vec3& p = mesh.positions[i];
        return Corner{p.x, p.y, p.z};
    };
    for (const auto& t : mesh.triangles) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner a = corner(t[i]), b = corner(t[(i + 1) % 3]);
            ++edges[{a, b}];
            --edges[{b, a}];
        }
    }
    return static_cast<std::size_t>(
        std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second > 0; }));
}

struct Expected {
    const char* file;
    int width, height;
    std::size_t least, most; ///< triangles
    std::size_t emitters;
};

std::ostream& operator<<(std::ostream& out, const Expected& e) { return out << e.file; }

class ShippedScene : public testing::TestWithParam<Expected> {};

TEST_P(ShippedScene, HasTheStatedSize) {
    SceneDescription description = describe(GetParam().file);
    EXPECT_EQ(description.window.width, GetParam().width);
    EXPECT_EQ(description.window.height, GetParam().height);
    const Scene scene(std::move(description));
    EXPECT_GE(scene.triangle_count(), GetParam().least);
    EXPECT_LE(scene.triangle_count(), GetParam().most);
    EXPECT_EQ(scene.emitters().size(), GetParam().emitters);
}

TEST_P(ShippedScene, LetsNoRayOut) {
    const Scene scene(describe(GetParam().file));
    Rng rng(1, StreamPurpose::test, 0);
    for (int walk = 0; walk < 500; ++walk) { // long enough to find its way through the doorway
        SurfacePoint at = scene.camera().eye(0.5, 0.5);
        Vec3 back{0, 0, 0}; // towards where the walk came from: it stays on that side of every surface
        for (int step = 0; step < 50; ++step) {
            const double u0 = rng.next(), u1 = rng.next();
            Vec3 w = uniform_sphere(u0, u1);
            if (w.dot(at.ng) * back.dot(at.ng) < 0) w = -w;
            const auto next = scene.trace(at, w);
            ASSERT_TRUE(next) << "from " << at.p << " along " << w;
            at = *next;
            back = -w;
        }
    }
}

TEST_P(ShippedScene, HasClosedGlassThatFacesOutward) {
    const SceneDescription description = describe(GetParam().file);
    int glasses = 0;
    for (const Shape& shape : description.shapes) {
        if (!shape.material || std::string(shape.material->kind()) != "glass") continue;
        ++glasses;
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
            EXPECT_EQ(open_edges(*mesh), 0u);
            EXPECT_GT(test::signed_volume(*mesh), 0);
        } else {
            EXPECT_FALSE(std::get<Sphere>(shape.geometry).inward);
        }
    }
    EXPECT_GT(glasses, 0);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene,
                         testing::Values(Expected{"scenes/box.yaml", 640, 480, 12, 16, 1},
                                         Expected{"scenes/rooms.yaml", 720, 405, 41'000, 43'500, 4},
                                         Expected{"scenes/lantern.yaml", 684, 513, 25'000, 35'000, 1},
                                         Expected{"tests/data/rooms_low/rooms.yaml", 720, 405, 1'000, 12'000, 4}),
                         [](const auto& info) {
                             return std::string(info.index == 3 ? "rooms_low"
                                                                : fs::path(info.param.file).stem().string());
                         });

TEST(Rooms, HaveMostOfTheirPowerWhereTheCameraIsNot) {
    const Scene scene(describe("scenes/rooms.yaml"));
    double here = 0, all = 0;
    Rng rng(1, StreamPurpose::test, 0);
    for (const auto& emitter : scene.emitters()) {
        all += emitter->power();
        if (emitter->sample_point(rng).point.p.z > 0)
            here += emitter->power(); // the wall between the rooms is at z = 0
    }
    EXPECT_GT(here, 0);
    EXPECT_LT(here, 0.2 * all);
}

TEST(Rooms, ShowNoLightOfTheOtherRoom) {
    const Scene scene(describe("scenes/rooms.yaml"));
    const SurfacePoint eye = scene.camera().eye(0.5, 0.5);
    int mirrored = 0;
    for (int y = 0; y < 300; ++y) {
        for (int x = 0; x < 500; ++x) {
            Vec3 w = scene.camera().ray_direction(eye, {(x + 0.5f) / 500, (y + 0.5f) / 300});
            auto seen = scene.trace(eye, w);
            if (seen && seen->material && std::string(seen->material->kind()) == "mirror") {
                ++mirrored;
                w -= seen->ng * (2 * w.dot(seen->ng));
                seen = scene.trace(*seen, w);
            }
            ASSERT_TRUE(seen);
            ASSERT_FALSE(seen->is_emitter() && seen->p.z < 0) << "at " << x << ", " << y << ": " << seen->p;
        }
    }
    EXPECT_GT(mirrored, 0);
}

TEST(Generator, WritesTheCommittedMeshes) {
    const ScratchDirectory scratch;
    const std::string generate = "python3 " + (kRoot / "scenes/generate.py").string();
    if (std::system("python3 -c '' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no Python";
    ASSERT_EQ(std::system((generate + " --out " + scratch.path("fine")).c_str()), 0);
    ASSERT_EQ(std::system((generate + " --low " + scratch.path("low")).c_str()), 0);
    expect_same_files(scratch.path("fine"), kRoot / "scenes/meshes");
    expect_same_files(scratch.path("low/meshes"), kRoot / "tests/data/rooms_low/meshes");
    expect_same_files(scratch.path("low"), kRoot / "tests/data/rooms_low");
}

} // namespace
} // namespace keyhole
