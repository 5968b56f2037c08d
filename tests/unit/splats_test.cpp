#include "film/splats.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

Picture blank(int width, int height) {
    Picture p{width, height, {}, {}, {}};
    for (const char* layer :
         {"beauty", "direct", "indirect", "caustic", "noise.direct", "noise.indirect", "noise.caustic"})
        p.layers[layer] = Image(width, height, 3);
    return p;
}

/// Adds scale times the splats to a picture.
void draw(const SplatFilm& splats, double scale, Picture& picture) {
    SplattedLight light(picture.width, picture.height);
    light.add(splats, scale);
    light.add_to(picture);
}

// A film is a mean over samples spread as its filter: uniform splats of value 1 must give 1 everywhere, borders
// included if splats fall beyond them.
TEST(Splats_OfUniformPoints, FillTheFilmEvenly) {
    constexpr int width = 5, height = 3, margin = 2, per_unit = 64;
    SplatFilm splats(width, height);
    for (int j = 0; j < (height + 2 * margin) * per_unit; ++j)
        for (int i = 0; i < (width + 2 * margin) * per_unit; ++i)
            splats.add({(static_cast<float>(i) + 0.5f) / per_unit - margin,
                        (static_cast<float>(j) + 0.5f) / per_unit - margin},
                       SplatFilm::Layer::caustic, Rgb(1, 2, 3));
    Picture picture = blank(width, height);
    picture.layers["beauty"].data.assign(picture.layers["beauty"].data.size(), 10.0f);
    draw(splats, 1.0 / (per_unit * per_unit), picture);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(picture.layers["caustic"].at(x, y)[c], c + 1.0, 1e-3);
                EXPECT_NEAR(picture.layers["beauty"].at(x, y)[c], c + 11.0, 1e-3);
                EXPECT_EQ(picture.layers["indirect"].at(x, y)[c], 0);
            }
}

TEST(SplattedLight_OfUnitsOfBothHalves, TellsWhatTheyDifferIn) {
    SplatFilm splats(1, 1);
    splats.add({0.5f, 0.5f}, SplatFilm::Layer::indirect, Rgb(1, 2, 3));
    const double unit = splats.sums(0)[3];
    SplattedLight light(1, 1);
    light.add(splats, 1, Half::first);
    light.add(splats, 5, Half::second);
    Picture picture = blank(1, 1);
    light.add_to(picture);
    EXPECT_NEAR(picture.layers["indirect"].at(0, 0)[0], 3 * unit, 1e-5 * unit);
    EXPECT_NEAR(picture.layers["noise.indirect"].at(0, 0)[0], -2 * unit, 1e-3 * unit);
    EXPECT_EQ(picture.layers["noise.direct"].at(0, 0)[0], 0);
}

// Splats read the filter from a table.
TEST(Splat_Alone, IsSpreadByTheFilter) {
    for (const FilterShape kind : {FilterShape::gaussian, FilterShape::triangle, FilterShape::box})
        for (const double radius : {0.0, 2.3}) {
            Settings settings;
            settings.filter = kind;
            settings.filter_radius = radius;
            const PixelFilter filter(settings);
            constexpr int size = 8;
            for (const Vec2& at : {Vec2(3.137f, 4.71f), Vec2(0.2f, 7.9f), Vec2(4, 4), Vec2(-0.3f, 2)}) {
                SplatFilm splats(size, size, filter);
                splats.add(at, SplatFilm::Layer::direct, Rgb(1, 2, 0.5));
                for (std::size_t i = 0; i < splats.pixels(); ++i) {
                    const Vec2 centre(static_cast<float>(i % size) + 0.5f, static_cast<float>(i / size) + 0.5f);
                    const double expected = filter.density(at - centre);
                    EXPECT_NEAR(splats.sums(i)[0], expected, 2e-6);
                    EXPECT_NEAR(splats.sums(i)[1], 2 * expected, 4e-6);
                }
            }
        }
}

TEST(Splats_FromManyThreads, AddUpTheSame) {
    std::vector<float> first;
    for (const int threads : {1, 4}) {
        SplatFilm splats(4, 4);
        with_threads(threads, [&] {
            parallel_for(64, [&](std::int64_t i) {
                Rng rng(1, StreamPurpose::test, static_cast<std::uint64_t>(i));
                for (int k = 0; k < 500; ++k)
                    splats.add({static_cast<float>(4 * rng.next()), static_cast<float>(4 * rng.next())},
                               SplatFilm::Layer::indirect, Rgb(rng.next()));
            });
        });
        Picture picture = blank(4, 4);
        draw(splats, 1, picture);
        if (first.empty()) first = picture.layers["indirect"].data;
        EXPECT_EQ(first, picture.layers["indirect"].data);
    }
}

} // namespace
} // namespace keyhole
