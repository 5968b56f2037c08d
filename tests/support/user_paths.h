// User paths for the scenes that tests share.
#pragma once

#include "sampling/guidance/user_paths.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace keyhole::test {

/// A path with one angle for all segments [rad].
UserPathSpec user_path(const std::string& name, const std::vector<Vec3>& points, double beta);

/// The same, but what follows after the last of `before` in the direction `towards` is traced through specular vertices
/// to the first surface that is not; then come the points of `rest`. Path tracing, which the tests start from, never
/// finds light that comes from a point light by way of specular vertices alone.
UserPathSpec specular_user_path(const Scene& scene, const std::string& name, const std::vector<Vec3>& before,
                                const Vec3& towards, const std::vector<Vec3>& rest, double beta);

/// Paths for the scenes of test_scenes.h: they overlap, some go through specular vertices, some end where the eye sees
/// them.
UserPathFile diffuse_box_paths(const Scene& scene);
UserPathFile mirror_glass_box_paths(const Scene& scene);
UserPathFile point_light_box_paths(const Scene& scene);
/// For two_rooms(): through the slit.
UserPathFile two_rooms_paths(const Scene& scene, float slit);
/// The same by openings: behind one bounce or more, and behind a point through part of the slit, askew.
UserPathFile opening_paths(const Scene& scene, float slit, int most_bounces = 2);
/// Those of them that have bounces, bound: the other's cone would have to hit a narrow slit.
UserPaths bounces_through(const Scene& scene, float slit, int most_bounces);

/// A scene with user paths.
struct GuidedScene {
    const char* name;
    std::unique_ptr<Scene> (*make)();
    UserPathFile (*paths)(const Scene&);
};
std::span<const GuidedScene> guided_scenes();

} // namespace keyhole::test
