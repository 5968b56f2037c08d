// What gather rays make of the photons around the point that they meet.
#include "gather/gather_rays.h"

#include "mapped_gather.h"
#include "photon_support.h"
#include "scene/material.h"
#include "scene/warp.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace keyhole {
namespace {

using namespace photon_test;

constexpr float kReach = 0.1f; // of lookups [m]

LookupOptions lookups(double least_alpha = 0) {
    return {.max_radius = kReach, .caustic_radius = kReach, .least_alpha = least_alpha};
}

MaterialPtr metal(double roughness) {
    return make_conductor(constant_texture(Rgb(0.8)), constant_texture(roughness), constant_texture(roughness));
}

/// Rectangles of one material; nothing emits.
Scene scene_of(const std::vector<Rectangle>& rectangles, const MaterialPtr& material) {
    SceneDescription d;
    for (const Rectangle& r : rectangles) {
        d.shapes.push_back(shape_of(r));
        d.shapes.back().material = material;
    }
    return Scene(std::move(d));
}

/// What a ray straight down from a point finds.
GatherRays::Arrival below(const MappedGather& gather, const Vec3& point, Rng& rng) {
    return gather.along(point, {0, -1, 0}, rng);
}

/// The mean of what rays straight down from `height` find at `x`, for z from `margin` to 1 - margin [W/(m^2 sr)].
double mean_below(const MappedGather& gather, float x, float height, float margin, Rng& rng) {
    RunningStats found;
    for (float z = margin; z < 1 - margin; z += 0.02f)
        found.add(luminance(below(gather, {x, height, z}, rng).indirect));
    return found.mean();
}

/// A floor of 1 x 1 m with a wall across it at x = 0.5 m, and photons on it; nothing emits.
class Floor {
  public:
    explicit Floor(const MaterialPtr& material) : Floor(material, material) {}
    Floor(const MaterialPtr& material, const MaterialPtr& wall)
        : scene_(make_scene(material, wall)), patches_(*scene_) {}

    /// Photons of power 1 W from straight above on the part of the floor between two x [m]: so many main ones, and a
    /// pilot for each ten.
    void throw_on(float from, float to, int count, bool caustic = false) {
        const Rectangle part{{from, 0, 0}, {0, 0, 1}, {to - from, 0, 0}};
        throw_photons(part, count, rng_, photons_.main_photons);
        throw_photons(part, count / 10, rng_, photons_.pilots);
        for (std::size_t i = photons_.main_photons.size() - static_cast<std::size_t>(count);
             caustic && i < photons_.main_photons.size(); ++i) {
            Photon& p = photons_.main_photons[i];
            p = Photon(p.position(), p.normal().decode(), p.direction(), p.power(), {.caustic = true});
        }
    }
    /// Mean of what rays from straight above find at `x` [W/(m^2 sr)].
    double seen_at(float x, float height = 0.25f) {
        return mean_below({*scene_, patches_, photons_, lookups()}, x, height, 0.2f, rng_);
    }

  private:
    static std::unique_ptr<Scene> make_scene(const MaterialPtr& material, const MaterialPtr& wall) {
        SceneDescription d;
        d.shapes.push_back(shape_of({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}));
        d.shapes.push_back(shape_of({{0.5f, 0, 0}, {0, 0.3f, 0}, {0, 0, 1}}));
        d.shapes[0].material = material;
        d.shapes[1].material = wall;
        return std::make_unique<Scene>(std::move(d));
    }

    std::unique_ptr<Scene> scene_;
    SurfacePatches patches_;
    PhotonSet photons_;
    Rng rng_ = make_rng(1);
};

TEST(GatherRays, SeeNoPhotonsFromBehindAWallInAShinyFloor) {
    Floor floor(metal(0.5));
    floor.throw_on(0.5f, 1, 2000);
    const double alone = floor.seen_at(0.52f);
    ASSERT_GT(alone, 0);
    EXPECT_NEAR(alone, floor.seen_at(0.8f), 0.3 * alone) << "the area behind the wall counted, too";
    floor.throw_on(0, 0.5f, 200'000);
    EXPECT_NEAR(floor.seen_at(0.52f), alone, 0.3 * alone);
}

TEST(GatherRays, TakeNothingFromPlacesThatLieBeyondTheirOwnEstimates) {
    Floor floor(make_diffuse(Rgb(0.5)), make_diffuse(Rgb(0.0))); // from whose wall no light comes
    floor.throw_on(0.5f, 0.6f, 20'000);
    EXPECT_NEAR(floor.seen_at(0.55f), 0.5 / kPi * 20'000 / 0.1, 0.1 * 0.5 / kPi * 20'000 / 0.1);
    EXPECT_EQ(floor.seen_at(0.8f), 0) << "light from 0.2 m away";
}

/// White surfaces, a roof of reflectance `roof` 0.5 m above the floor from x = `edge` on, and a white lamp of 1 cm 1 m
/// above x = 0.25 m.
std::unique_ptr<Scene> under_a_lamp(std::vector<Rectangle> surfaces, float edge, double roof, double radiance) {
    surfaces.push_back({{edge, 0.5f, -1}, {0.6f, 0, 0}, {0, 0, 3}});
    surfaces.push_back({{0.245f, 1, 0.495f}, {0.01f, 0, 0}, {0, 0, 0.01f}});
    SceneDescription d;
    for (const Rectangle& r : surfaces) {
        d.shapes.push_back(shape_of(r));
        d.shapes.back().material = make_diffuse(Rgb(0.5));
    }
    d.shapes[d.shapes.size() - 2].material = make_diffuse(Rgb(roof));
    d.shapes.back().emission =
        std::make_unique<SurfaceEmission>(SurfaceEmission{.radiance = Rgb(radiance), .two_sided = true});
    return std::make_unique<Scene>(std::move(d));
}

/// A roof keeps the lamp's light from x > 0.55 m. Photons, and with them places of the map, are in the light alone.
TEST(GatherRays, DontTakeDirectLightToTheShadowBesideIt) {
    const auto made = under_a_lamp({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}}, 0.4f, 0.5, 1e11);
    const Scene& scene = *made;
    const SurfacePatches patches(scene);
    Rng rng = make_rng(7);
    PhotonSet photons;
    const Rectangle lit{{0, 0, 0}, {0, 0, 1}, {0.5f, 0, 0}};
    throw_photons(lit, 2000, rng, photons.main_photons);
    throw_photons(lit, 200, rng, photons.pilots);
    const MappedGather gather(scene, patches, photons, lookups());
    const auto seen_at = [&](float x) { return mean_below(gather, x, 0.25f, 0.3f, rng); };
    ASSERT_GT(seen_at(0.48f), 0);
    EXPECT_LT(seen_at(0.57f), 0.01 * seen_at(0.48f));
}

/// Beside a slab lies the floor, lower by less than lookups reach, and in the shadow of a roof. Photons, and with them
/// places of the map, are on the slab alone.
class Slab {
  public:
    /// `radiance`: of the lamp [W/(m^2 sr)]. The roof's shadow begins at 0.47 m.
    explicit Slab(double radiance)
        : scene_(under_a_lamp({{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, kTop}, 0.36f, 0, radiance)), patches_(*scene_) {
        throw_photons(kTop, 20'000, rng_, photons_.main_photons);
        throw_photons(kTop, 150, rng_, photons_.pilots); // so few that estimates look as far as they may
    }

    /// Mean of what rays from straight above find at `x` [W/(m^2 sr)].
    double seen_at(float x) { return mean_below({*scene_, patches_, photons_, lookups()}, x, 0.25f, 0.3f, rng_); }

  private:
    inline static const Rectangle kTop{{0, 0.03f, 0}, {0, 0, 1}, {0.45f, 0, 0}};

    std::unique_ptr<Scene> scene_;
    SurfacePatches patches_;
    PhotonSet photons_;
    Rng rng_ = make_rng(8);
};

TEST(GatherRays, TakeNothingFromASlabBesideThemThatIsHigher) {
    Slab slab(0);
    ASSERT_GT(slab.seen_at(0.4f), 0);
    // A ray that is traced on for the last time takes what it finds.
    EXPECT_LT(slab.seen_at(0.48f), 0.05 * slab.seen_at(0.4f));
}

TEST(GatherRays, DontTakeDirectLightFromASlabThatIsHigher) {
    Slab slab(1e11);
    ASSERT_GT(slab.seen_at(0.4f), 100 * Slab(0).seen_at(0.4f)) << "direct light is the lesser part";
    EXPECT_LT(slab.seen_at(0.48f), 0.01 * slab.seen_at(0.4f));
}

/// From nearer than the estimate looks rays are traced on, and the estimate doesn't count: but no ray that is traced on
/// finds the light that came here by way of a mirror alone.
TEST(GatherRays, KeepCausticsWhereTheyAreTracedOn) {
    const auto mirror = metal(0);
    const auto white = make_diffuse(Rgb(0.5));
    const auto plastic = make_coated_diffuse(constant_texture(Rgb(0.5)), constant_texture(0.4), constant_texture(0.4),
                                             1.5, constant_texture(0));
    for (const auto& material : {white, plastic}) {
        Floor floor(material, mirror);
        floor.throw_on(0.5f, 1, 100'000);
        const double far = floor.seen_at(0.75f);
        EXPECT_GT(far, 0.3 / kPi * 200'000);
        EXPECT_EQ(floor.seen_at(0.75f, 0.004f), 0) << "found what rays that are traced on should find";
        floor.throw_on(0.5f, 1, 100'000, true);
        EXPECT_NEAR(floor.seen_at(0.75f), 2 * far, 0.3 * far);
        EXPECT_NEAR(floor.seen_at(0.75f, 0.004f), far, 0.2 * far);
    }
}

/// A row of slats 1 mm wide, 4 mm apart, has a fifth of the area of a floor.
TEST(GatherRays, AreTracedOnFromSlatsThatAreFinerThanTheEstimate) {
    std::vector<Rectangle> slats;
    for (int i = 0; i < 200; ++i) slats.push_back({{0.005f * static_cast<float>(i), 0, 0}, {0, 0, 1}, {0.001f, 0, 0}});
    const Scene scene = scene_of(slats, make_diffuse(Rgb(0.5)));
    const SurfacePatches patches(scene);
    Rng rng = make_rng(5);
    PhotonSet photons;
    for (const Rectangle& slat : slats) {
        throw_photons(slat, 100, rng, photons.main_photons);
        throw_photons(slat, 10, rng, photons.pilots);
    }
    const MappedGather gather(scene, patches, photons, lookups());
    const GatherRays::Arrival found = below(gather, {0.5005f, 0.25f, 0.5f}, rng);
    EXPECT_NEAR(found.distance, 0.25, 1e-4);
    EXPECT_EQ(luminance(found.indirect), 0) << "a mean over slats";
}

/// What is known of a strip 2 mm wide, the next place of the map: photons on the metal beside it lie 80 times as wide.
TEST(GatherRays, DontTakeAreasFromPlacesThatLieBeyondTheirOwnEstimates) {
    const Rectangle strip{{0, 0, 0}, {0, 0, 1}, {0.002f, 0, 0}}, floor{{0.05f, 0, 0}, {0, 0, 1}, {0.95f, 0, 0}};
    const Scene scene = scene_of({strip, floor}, metal(0.5));
    const SurfacePatches patches(scene);
    Rng rng = make_rng(7);
    PhotonSet photons;
    throw_photons(strip, 100, rng, photons.pilots);
    throw_photons(floor, 10'000, rng, photons.main_photons);
    const double unknown = mean_below({scene, patches, photons, lookups()}, 0.16f, 0.25f, 0.2f, rng);
    throw_photons(floor, 1000, rng, photons.pilots);
    const double known = mean_below({scene, patches, photons, lookups()}, 0.16f, 0.25f, 0.2f, rng);
    ASSERT_GT(known, 0);
    EXPECT_NEAR(unknown, known, 0.3 * known);
}

/// No photon lies on the side that the ray meets, so that nothing is known there.
TEST(GatherRays, FindLightThatComesThroughFromTheOtherSide) {
    const Rectangle pane{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const Scene scene = scene_of({pane}, test::ground_glass());
    const SurfacePatches patches(scene);
    Rng rng = make_rng(5);
    PhotonSet photons;
    throw_photons(pane, 20'000, rng, photons.main_photons, Rgb(1.0), -1);
    throw_photons(pane, 2'000, rng, photons.pilots, Rgb(1.0), -1);
    const MappedGather gather(scene, patches, photons, lookups());
    EXPECT_GT(luminance(below(gather, {0.5f, 0.25f, 0.5f}, rng).indirect), 0);
}

/// Irradiance [W/m^2] a little above the middle of a metal floor of roughness 0.02, on which 100 kW/m^2 fall from
/// straight above, by rays that each look at the photons where they end.
RunningStats irradiance_above_metal(double least_alpha) {
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const Scene scene = scene_of({floor}, metal(0.02));
    const SurfacePatches patches(scene);
    Rng rng = make_rng(3);
    PhotonSet photons;
    throw_photons(floor, 100'000, rng, photons.main_photons);
    throw_photons(floor, 10'000, rng, photons.pilots);
    const MappedGather gather(scene, patches, photons, lookups(least_alpha));
    const Frame down({0, -1, 0});
    RunningStats found;
    for (int i = 0; i < 100'000; ++i) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec3 w = down.to_world(cosine_hemisphere(u0, u1));
        found.add(kPi * luminance(gather.along({0.5f, 0.05f, 0.5f}, w, rng).indirect));
    }
    return found;
}

TEST(GatherRays, SeeAsMuchOfAShinyFloorWithLessNoiseWhereItsLobeIsWidened) {
    const RunningStats narrow = irradiance_above_metal(0), wide = irradiance_above_metal(0.2);
    const double noise = std::hypot(narrow.standard_error(), wide.standard_error());
    EXPECT_NEAR(narrow.mean(), 80e3, 4 * narrow.standard_error() + 0.05 * 80e3);
    EXPECT_NEAR(wide.mean(), narrow.mean(), 4 * noise + 0.03 * narrow.mean());
    EXPECT_LT(wide.variance(), 0.05 * narrow.variance());
}

} // namespace
} // namespace keyhole
