#include "photonmap/photon_map.h"

#include "photon_support.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace keyhole {
namespace {

using namespace photon_test;

/// Photons of all normals in the unit cube: most must be turned away.
std::vector<Photon> cloud(int n) {
    Rng rng = make_rng(1);
    std::vector<Photon> photons;
    for (int i = 0; i < n; ++i) {
        const Vec3 p(static_cast<float>(rng.next()), static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        const Vec3 normal = uniform_sphere(rng.next(), rng.next());
        photons.emplace_back(p, normal, normal, Rgb(i));
    }
    return photons;
}

std::vector<Neighbour> nearest_by_trying_all(const PhotonMap& map, const PhotonQuery& q) {
    std::vector<Neighbour> all;
    for (std::uint32_t i = 0; i < map.photons().size(); ++i) {
        const float d2 = q.region.distance2(map[i].position());
        if (d2 <= q.max_radius * q.max_radius && q.region.accepts(map[i].normal().unnormalised()))
            all.push_back({d2, i});
    }
    std::sort(all.begin(), all.end());
    all.resize(std::min(all.size(), static_cast<std::size_t>(q.k)));
    return all;
}

std::vector<std::uint32_t> sorted_indices(std::span<const Neighbour> found) {
    std::vector<Neighbour> sorted(found.begin(), found.end());
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> indices;
    for (const Neighbour& n : sorted) indices.push_back(n.index);
    return indices;
}

TEST(PhotonMap, FindsWhatTryingAllFinds) {
    const PhotonMap map(cloud(20'000));
    Rng rng = make_rng(2);
    int full = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 p(static_cast<float>(rng.next()), static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        const PhotonQuery q{{p, uniform_sphere(rng.next(), rng.next())}, i % 2 == 0 ? 0.15f : 1.5f, 1 + i % 40};
        const Neighbourhood near = map.nearest(q);
        const auto expected = nearest_by_trying_all(map, q);
        ASSERT_EQ(sorted_indices(near.found), sorted_indices(expected));
        ASSERT_EQ(near.full, expected.size() == static_cast<std::size_t>(q.k));
        if (near.full) {
            ++full;
            EXPECT_EQ(near.radius2, expected.back().distance2);
            EXPECT_EQ(near.found.front().index, expected.back().index);
        } else {
            EXPECT_EQ(near.radius2, q.max_radius * q.max_radius);
        }
    }
    EXPECT_GT(full, 50);
    EXPECT_LT(full, 250);
}

TEST(PhotonMap, FindsTheNearestOneByItself) {
    for (const auto wanted : {PhotonMap::Wanted::many, PhotonMap::Wanted::one}) {
        const PhotonMap map(cloud(5000), wanted);
        Rng rng = make_rng(4);
        const auto red = [](const Photon& p) { return std::lrint(p.power().x) % 3 == 0; };
        int found = 0;
        for (int i = 0; i < 300; ++i) {
            const auto at = [&] { return static_cast<float>(1.4 * rng.next() - 0.2); };
            const float x = at(), y = at(), z = at();
            const PhotonQuery q{{{x, y, z}, uniform_sphere(rng.next(), rng.next())}, i % 2 == 0 ? 0.1f : 1.5f, 5000};
            const auto all = nearest_by_trying_all(map, q);
            const auto one = map.nearest_one(q.region, q.max_radius);
            ASSERT_EQ(one.has_value(), !all.empty());
            const auto flat = map.nearest_one(q.region, q.max_radius, PhotonMap::Expected::none);
            ASSERT_EQ(flat.has_value(), one.has_value());
            if (!one) continue;
            ++found;
            EXPECT_EQ(one->index, all[0].index);
            EXPECT_EQ(one->distance2, all[0].distance2);
            EXPECT_EQ(flat->index, one->index);
            const auto first =
                std::find_if(all.begin(), all.end(), [&](const Neighbour& n) { return red(map[n.index]); });
            const auto accepted = map.nearest_accepted(q.region, q.max_radius, red);
            ASSERT_EQ(accepted.has_value(), first != all.end());
            if (accepted) {
                EXPECT_EQ(accepted->index, first->index);
            }
        }
        EXPECT_GT(found, 150);
        EXPECT_LT(found, 300);
    }
}

TEST(PhotonMap, KeepsEveryPhotonAndReordersThem) {
    std::vector<Photon> before = cloud(4000); // whose power is their number, exactly
    const PhotonMap map(before);
    std::vector<bool> seen(before.size());
    for (const Photon& p : map.photons()) {
        const auto id = static_cast<std::size_t>(std::lrint(p.power().x));
        ASSERT_EQ(p, before[id]);
        seen[id] = true;
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool b) { return b; }));
}

TEST(PhotonMap, DecidesTiesByIndex) {
    std::vector<Photon> photons;
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            photons.emplace_back(Vec3(static_cast<float>(x), static_cast<float>(y), 0), Vec3(0, 0, 1), Vec3(0, 0, 1),
                                 Rgb(1.0));
    const PhotonMap map(std::move(photons));
    for (int k = 1; k < 60; ++k) {
        const PhotonQuery q{{Vec3(20, 20, 0), Vec3(0, 0, 1)}, 10, k};
        EXPECT_EQ(sorted_indices(map.nearest(q).found), sorted_indices(nearest_by_trying_all(map, q)));
    }
}

TEST(PhotonMap, StaysBelow32BytesAPhotonWithItsIndex) {
    constexpr int n = 100'000;
    Rng rng = make_rng(3);
    std::vector<Photon> photons;
    photons.reserve(n);
    throw_photons(kUnitSquare, n, rng, photons);
    EXPECT_LE(PhotonMap(std::move(photons)).bytes(), 32u * n);
}

TEST(PhotonMap, TakesManyPhotonsOnOneSpotAndNone) {
    const PhotonQuery q{{Vec3(0), Vec3(0, 0, 1)}, 1, 10};
    EXPECT_TRUE(PhotonMap({}).nearest(q).found.empty());
    const PhotonMap map(std::vector<Photon>(1000, Photon(Vec3(0), Vec3(0, 0, 1), Vec3(0, 0, 1), Rgb(1.0))));
    EXPECT_EQ(map.nearest(q).found.size(), 10u);
    EXPECT_EQ(map.nearest(q).radius2, 0.0f);
}

TEST(PhotonMap, AnswersManyThreadsAlike) {
    const PhotonMap map(cloud(20'000));
    const PhotonQuery q{{Vec3(0.5f), Vec3(0, 0, 1)}, 1, 25};
    const auto expected = sorted_indices(map.nearest(q).found);
    std::vector<std::vector<std::uint32_t>> answers(4);
    std::vector<std::thread> threads;
    for (auto& answer : answers)
        threads.emplace_back([&] {
            for (int i = 0; i < 50; ++i) answer = sorted_indices(map.nearest(q).found);
        });
    for (std::thread& t : threads) t.join();
    for (const auto& answer : answers) EXPECT_EQ(answer, expected);
}

} // namespace
} // namespace keyhole
