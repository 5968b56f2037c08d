// Perturbations where surfaces touch: steps there may be smaller than what positions can tell apart.
#include "sampling/proposals/edit.h"
#include "sampling/proposals/registry.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// L D S S D E: light leaves the floor, a tenth of a millimetre below the glass ball that rests on it, through the ball
/// to a wall that the eye sees.
std::optional<Path> path_below_the_ball(const Scene& scene, Rng& rng) {
    const auto x0 = sample_emitter(scene, rng);
    SurfacePoint above;
    above.site = Site::point;
    above.p = Vec3(0.341302f, 1e-5f, 0.502935f);
    const auto floor = next_vertex(scene, above, Vec3(0, -1, 0));
    SubPath light, eye;
    light.push_back(x0->vertex);
    light.push_back(*floor);
    Path like;
    like.x = light;
    for (const Event event : {Event::transmit, Event::transmit, Event::finite}) {
        like.x.push_back(Vertex());
        like.x.back().event = event;
    }
    Failure why{};
    const Vec3 w = Vec3(static_cast<float>(rng.next() - 0.5), 1, static_cast<float>(-rng.next())).normalized();
    if (!retrace_specular_chain(scene, light, floor->point, w, like, 2, 4, why)) return std::nullopt;
    eye.push_back(sample_eye(scene, rng));
    const auto path = join(scene, PathSet::all, light, eye, {0, 0}, why);
    return path && path->target > 0 ? path : std::nullopt;
}

TEST(CausticPerturbation, TakesNoStepThatRoundingSwallows) {
    const auto scene = test::mirror_glass_box();
    const ProposalList made = proposals::caustic_perturbation.make({scene.get(), PathSet::all, 8});
    const PathProposal& kind = made.front().proposal;
    Rng rng(3, StreamPurpose::test, 0);
    int proposed = 0, unchanged = 0;
    for (int k = 0; k < 200'000 && proposed < 20'000; ++k) {
        const auto x = path_below_the_ball(*scene, rng);
        if (!x) continue;
        Failure why{};
        const auto y = kind->propose(*x, rng, why);
        unchanged += !y && why == Failure::unchanged ? 1 : 0;
        if (!y || !(y->target > 0)) continue;
        ++proposed;
        const double there = kind->transition_density(*x, *y), back = kind->transition_density(*y, *x);
        ASSERT_TRUE(there > 0 && std::isfinite(there)) << there;
        ASSERT_TRUE(back > 0 && std::isfinite(back)) << back;
    }
    EXPECT_GT(proposed, 1000);
    EXPECT_GT(unchanged, 10) << "no step was small enough";
}

} // namespace
} // namespace keyhole
