// What of a chain's stay becomes one photon.
#include "photonmap/deposit.h"

#include "sampling/paths/path_tracer.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Keeps a path whose photon is two edges and more from the light.
struct LongPath {
    const Scene& scene;
    std::optional<Path> found;

    bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& /*value*/, LightClass /*light*/) {
        Path path = complete_path(scene, walk, x0, {0.5f, 0.5f});
        const StoragePoint at = PathSet::stored.find_storage(path);
        if (at.kind == PhotonKind::global && at.vertex >= 2) found = path;
    }
};

class Deposit : public testing::Test {
  protected:
    Deposit() : scene(test::diffuse_box()) {
        LongPath look{*scene, {}};
        Rng rng(1, StreamPurpose::test, 0);
        while (!look.found) trace_path(*scene, {0.5f, 0.5f}, 6, rng, look);
        path = *look.found;
    }
    /// Photons of two paths that take turns.
    PhotonBuffer photons_of(const Path& a, const Path& b) {
        DepositOptions options;
        options.rule = PowerRule::reciprocal;
        options.scene = scene.get();
        options.set = PathSet::stored;
        MapBuffers buffers;
        PathDepositor depositor(options, Rng(2, StreamPurpose::test, 1), buffers);
        for (int i = 0; i < 3; ++i) {
            depositor.deposit(a, 1);
            depositor.deposit(b, 2);
        }
        depositor.flush();
        return buffers.global;
    }

    std::unique_ptr<Scene> scene;
    Path path;
};

TEST_F(Deposit, MakesOnePhotonOfPathsThatShareTheLightsSide) {
    Path other = path;
    other.image = Vec2(0.4f, 0.5f); // another eye, as far as the photon can tell
    const PhotonBuffer found = photons_of(path, other);
    ASSERT_EQ(found.photons.size(), 1u);
    EXPECT_FLOAT_EQ(found.weights[0], 9);
}

TEST_F(Deposit, KeepsTheColoursOfTwoLightsApart) {
    Path other = path;
    other.x[0].value *= Rgb(2, 1, 0.25); // the same last edge to the light, at whose end another emitter is seen
    const PhotonBuffer found = photons_of(path, other);
    ASSERT_EQ(found.photons.size(), 2u);
    EXPECT_FLOAT_EQ(found.weights[0] + found.weights[1], 9);
    const auto red = [&](std::size_t i) { return found.photons[i].power().x / found.photons[i].power().z; };
    EXPECT_NEAR(std::max(red(0), red(1)) / std::min(red(0), red(1)), 8, 0.1);
}

} // namespace
} // namespace keyhole
