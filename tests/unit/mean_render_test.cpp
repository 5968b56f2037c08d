// The mean of renders by methods that don't have the same layers.
#include "methods/choice/mean_render.h"

#include "film/accumulation_buffer.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// One pixel with direct light 2 by sampling it, or indirect light 4 that was drawn, without surfaces.
RenderResult result_of(AccumulationBuffer::Parts parts) {
    AccumulationBuffer buffer(1, 1, PixelFilter(), parts);
    if (buffer.film) {
        PixelSample sample;
        sample.direct = Rgb(2.0);
        sample.albedo = Rgb(0.5);
        buffer.film->add(0, 0, sample);
    }
    RenderResult result;
    result.picture = buffer.to_picture();
    if (!buffer.film) result.picture.layers.at("beauty").data.assign(3, 4);
    return result;
}

} // namespace

TEST(MeanRender_OfMethodsThatKnowSurfacesAndNone, KeepsBothInEitherOrder) {
    for (const bool drawn_first : {false, true}) {
        using Parts = AccumulationBuffer::Parts;
        MeanRender mean;
        mean.add(result_of(drawn_first ? Parts::drawn : Parts::film), 1);
        mean.add(result_of(drawn_first ? Parts::film : Parts::drawn), 1);
        EXPECT_FLOAT_EQ(mean.picture().layers.at("beauty").data[0], 3);
        EXPECT_FLOAT_EQ(mean.picture().layers.at("albedo").data[0], 0.5f);
        EXPECT_FLOAT_EQ(mean.picture().layers.at("noise.direct").data[0], 0);
    }
}

TEST(MeanRender, TellsOfPhotonsThatAnyOfThemDidNotKeep) {
    for (const double later : {0.5, 2.0, 1000.0}) { // the lesser one, the greater one, and one that replaces it
        MeanRender mean;
        RenderResult first = result_of(AccumulationBuffer::Parts::film);
        first.stats.unsaved = "disk full";
        mean.add(std::move(first), 1);
        mean.add(result_of(AccumulationBuffer::Parts::film), later);
        EXPECT_EQ(mean.take().stats.unsaved, "disk full") << later;
    }
    MeanRender mean;
    RenderStats without_picture;
    without_picture.unsaved = "disk full";
    mean.leave_out(without_picture);
    mean.add(result_of(AccumulationBuffer::Parts::film), 1);
    EXPECT_EQ(mean.take().stats.unsaved, "disk full");
}

} // namespace keyhole
