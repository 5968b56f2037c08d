// How many gather rays pay: by what noise and cost are made of.
#include "gather/gather_effort.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// Variance a + b / rays, cost c + d rays.
struct Model {
    double a, b, c, d;
    GatherEffort at(double rays) const { return {rays, a + b / rays, c + d * rays}; }
    double squared_error(double rays) const { return at(rays).variance * at(rays).cost; }
};

TEST(GatherEffort, LeavesTheLeastErrorForTheCost) {
    for (const Model& model : {Model{1, 4, 2, 1}, Model{1, 0.5, 30, 1}, Model{0.2, 1, 1, 0.7}}) {
        const double best = best_gather_rays(model.at(1), model.at(8));
        EXPECT_GT(best, 1) << model.b;
        EXPECT_LT(best, 8) << model.b;
        for (const double factor : {0.8, 1.25})
            EXPECT_GT(model.squared_error(factor * best), model.squared_error(best)) << model.b << ' ' << factor;
    }
}

TEST(GatherEffort, StaysBetweenWhatWasTried) {
    EXPECT_EQ(best_gather_rays(Model{1, 0, 1, 1}.at(1), Model{1, 0, 1, 1}.at(8)), 1);
    EXPECT_EQ(best_gather_rays({1, 0.9, 2}, {8, 1.1, 9}), 1) << "noise of the trial";
    EXPECT_EQ(best_gather_rays(Model{0, 1, 1, 1}.at(1), Model{0, 1, 1, 1}.at(8)), 8) << "all noise is that of rays";
    EXPECT_EQ(best_gather_rays({1, 2, 1}, {8, 1, 1}), 8) << "rays that cost nothing";
    EXPECT_EQ(best_gather_rays({1, 0, 1}, {8, 0, 1}), 1) << "black";
}

} // namespace
} // namespace keyhole
