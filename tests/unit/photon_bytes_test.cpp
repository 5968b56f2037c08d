// What a photon costs, by what the allocator gave away: itself and its index, and what is computed beforehand for it.
#include "gather/direct_irradiance_cache.h"
#include "photonmap/emission.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "support/sanitizers.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <malloc.h>

namespace keyhole {
namespace {

/// Memory that the program holds [bytes], of large blocks that are mapped one by one as well.
double allocated() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

class PhotonBytes : public testing::TestWithParam<std::size_t> {};

TEST_P(PhotonBytes, AreAtMost32WithIndexIrradianceAndDirectLight) {
    if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator keeps no such account";
    const std::size_t n = GetParam();
    const auto scene = test::mirror_glass_box(); // photons of many normals, and both maps
    const SurfacePatches patches(*scene);
    // What TBB and the threads keep for themselves is not a photon's: all of it is there before the count begins.
    emit_photons(*scene, {}, {.paths = 4000, .photons = 4000, .seed = 2}, {});
    IrradianceMap(PhotonMap({}), PhotonMap({}), {.max_radius = 0.1f, .patches = &patches}, {});
    const double before = allocated();
    // So many arrive that the stores are full.
    EmittedPhotons photons =
        emit_photons(*scene, {}, {.paths = static_cast<std::int64_t>(n), .photons = n, .seed = 1}, {});
    const auto stored = static_cast<double>(photons.global.size() + photons.caustic.size());
    EXPECT_GT(stored, 0.85 * static_cast<double>(n)) << "the test wants full stores";
    const double bytes_of_stores = static_cast<double>(photons.bytes);
    const PilotedMap global(std::move(photons.global)), caustic(std::move(photons.caustic));
    const double with_index = (allocated() - before) / static_cast<double>(n);
    // Few photons in an estimate: what they cost is time.
    const IrradianceMap irradiance(global.pilots(), global.main_photons(),
                                   {.k = 4, .max_radius = 0.02f, .patches = &patches, .scene = scene.get()}, {});
    const DirectIrradianceCache direct(*scene, irradiance.places(), kMostFaces, {}, {});
    const double per_photon = (allocated() - before) / static_cast<double>(n);
    RecordProperty("bytes_per_photon_with_index", std::to_string(with_index));
    RecordProperty("bytes_per_photon", std::to_string(per_photon));
    RecordProperty("bytes_per_photon_stored", std::to_string(per_photon * static_cast<double>(n) / stored));
    RecordProperty("bytes_per_photon_in_stores", std::to_string(bytes_of_stores / static_cast<double>(n)));
    std::cout << with_index << " bytes a photon with its index, " << per_photon
              << " with irradiance, indirect and direct\n";
    EXPECT_LE(per_photon, 32 + 49152 / static_cast<double>(n)) << "32 each, and what a dozen blocks round up to";
    EXPECT_GT(with_index, 24) << "the allocator was asked, and not some other";
    EXPECT_LE(bytes_of_stores, 32 * static_cast<double>(n));
    // And by what the maps say of themselves, which the ceiling on memory goes by.
    const double said = static_cast<double>(global.bytes() + caustic.bytes() + irradiance.bytes() + direct.bytes());
    EXPECT_NEAR(said / static_cast<double>(n), per_photon, 0.1 + 65536 / static_cast<double>(n));
}

INSTANTIATE_TEST_SUITE_P(Photons, PhotonBytes, testing::Values(50'000, 300'000, 1'000'000));

} // namespace
} // namespace keyhole
