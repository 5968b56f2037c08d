// Irradiance made of photons beforehand.
#include "photonmap/irradiance/irradiance_map.h"

#include "photon_support.h"
#include "scene/material.h"
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr float kReach = 0.1f; // of estimates [m]

/// Mean of the estimates made between `from` and `to` along x, over the irradiance there, of photons on a floor whose
/// density is density(x) [1/m^2], up to a factor.
template <class Density> double over_truth(const Density& density, int photons, float from, float to) {
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    std::vector<Shape> shapes;
    shapes.push_back(shape_of(floor));
    Rng rng = make_rng(5);
    std::vector<Photon> main_photons, pilots;
    double mean = 0;
    constexpr int kSteps = 1000;
    for (int i = 0; i < kSteps; ++i) mean += density(0.5 * (i + 0.5) / kSteps) / kSteps;
    while (static_cast<int>(main_photons.size()) < photons) {
        const auto x = static_cast<float>(0.5 * rng.next()), z = static_cast<float>(rng.next());
        if (rng.next() < density(x)) main_photons.emplace_back(Vec3(x, 0, z), Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
    }
    for (int i = 0; i < 40; ++i) // so few that estimates look as far as they may
        pilots.emplace_back(
            Vec3(from + (to - from) * static_cast<float>(rng.next()), 0, static_cast<float>(0.2 + 0.6 * rng.next())),
            Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
    const PhotonMap main_map(std::move(main_photons)), pilot_map(std::move(pilots), PhotonMap::Wanted::one);
    const SurfacePatches patches(shapes);
    const IrradianceMap map(pilot_map, main_map, {.k = 1000, .max_radius = kReach, .patches = &patches}, {});
    double found = 0, truth = 0;
    for (const Photon& p : map.places()) {
        found += map.irradiance(p.position(), Vec3(0, 1, 0)).irradiance.x;
        truth += photons / 0.5 * density(p.position().x) / mean;
    }
    return found / truth;
}

TEST(IrradianceMap, IsTheMeanOfItsPhotonsWhereLightIsEvenOrFallsEvenly) {
    const auto even = [](double) { return 1.0; };
    EXPECT_NEAR(over_truth(even, 100'000, 0.2f, 0.3f), 1, 0.03);
    EXPECT_NEAR(over_truth(even, 1000, 0.2f, 0.3f), 1, 0.1);
    const auto slope = [](double x) { return 1 - x; };
    EXPECT_NEAR(over_truth(slope, 100'000, 0.2f, 0.3f), 1, 0.03);
}

using Piece = std::pair<Rectangle, MaterialPtr>;

SceneDescription pieces(const std::vector<Piece>& all) {
    SceneDescription d;
    for (const auto& [rectangle, material] : all) {
        d.shapes.push_back(shape_of(rectangle));
        d.shapes.back().material = material;
    }
    return d;
}

/// A board lies above the floor, by less than estimates look, and all light on the board.
TEST(IrradianceMap, IsNotKnownUnderABoardThatHasAllTheLight) {
    constexpr float kHeight = 0.2f * kReach;
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, board{{0, kHeight, 0}, {0, 0, 1}, {1, 0, 0}};
    const auto white = make_diffuse(Rgb(0.5));
    const Scene scene(pieces({{floor, white}, {board, white}}));
    const SurfacePatches patches(scene);
    Rng rng = make_rng(6);
    const PhotonMap main_photons(throw_photons(board, 10'000, rng));
    const PhotonMap pilots(throw_photons(board, 200, rng), PhotonMap::Wanted::one);
    const IrradianceMap map(pilots, main_photons,
                            {.k = 1000, .max_radius = kReach, .patches = &patches, .scene = &scene}, {});
    EXPECT_TRUE(map.irradiance(Vec3(0.5f, kHeight, 0.5f), Vec3(0, 1, 0)).known);
    EXPECT_FALSE(map.irradiance(Vec3(0.5f, 0, 0.5f), Vec3(0, 1, 0)).known);
}

/// A board lies low above a floor, and light comes in from its edge at x = 0 only: it falls to a third over the height.
TEST(IrradianceMap, IsNoMeanOverMoreThanTheWidthOfACrevice) {
    constexpr float kHeight = 0.2f * kReach;
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}}, board{{0, kHeight, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    const auto density = [](float x) { return std::exp(-x / kHeight); };
    const auto map_of = [&](const std::vector<Piece>& all, const auto& look) {
        const Scene scene(pieces(all));
        const SurfacePatches patches(scene);
        Rng rng = make_rng(7);
        const auto at = [&](float x) {
            return Photon(Vec3(x, 0, static_cast<float>(rng.next())), Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
        };
        std::vector<Photon> main_photons, pilots;
        while (main_photons.size() < 100'000)
            main_photons.push_back(at(std::min(-kHeight * static_cast<float>(std::log(1 - rng.next())), 0.499f)));
        for (int i = 0; i < 40; ++i) pilots.push_back(at((3 + static_cast<float>(rng.next())) * kHeight));
        const double scale = static_cast<double>(main_photons.size()) / kHeight;
        const PhotonMap main_map(std::move(main_photons)), pilot_map(std::move(pilots), PhotonMap::Wanted::one);
        look(IrradianceMap(pilot_map, main_map, {.k = 1000, .max_radius = kReach, .patches = &patches, .scene = &scene},
                           {}),
             scale);
    };
    const auto over_truth = [&](const IrradianceMap& map, double scale) {
        double found = 0, truth = 0;
        for (const Photon& p : map.places()) {
            found += map.irradiance(p.position(), Vec3(0, 1, 0)).irradiance.x;
            truth += scale * density(p.position().x);
        }
        return found / truth;
    };
    const auto white = make_diffuse(Rgb(0.5)), pane = make_thin_dielectric(1.5);
    map_of({{floor, white}, {board, white}}, [&](const IrradianceMap& map, double scale) {
        EXPECT_TRUE(map.is_in_crevice(0));
        EXPECT_NEAR(over_truth(map, scale), 1.6, 0.3);
    });
    // So much a mean over the whole reach is too large; light goes through a pane as if it weren't there.
    map_of({{floor, white}}, [&](const IrradianceMap& map, double scale) { EXPECT_GT(over_truth(map, scale), 3); });
    map_of({{floor, white}, {board, pane}},
           [&](const IrradianceMap& map, double scale) { EXPECT_GT(over_truth(map, scale), 3); });
}

} // namespace
} // namespace keyhole
