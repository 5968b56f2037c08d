#include "support/user_paths.h"

#include "sampling/guidance/found/find_openings.h"
#include "sampling/guidance/nearest_emitter.h"
#include "support/test_scenes.h"

namespace keyhole::test {
UserPathSpec user_path(const std::string& name, const std::vector<Vec3>& points, double beta) {
    UserPathSpec spec;
    spec.name = name;
    for (const Vec3& p : points) spec.points.push_back({Imath::V3d(p)});
    spec.beta.assign(points.size() - 1, beta);
    return spec;
}

UserPathSpec specular_user_path(const Scene& scene, const std::string& name, const std::vector<Vec3>& before,
                                const Vec3& towards, const std::vector<Vec3>& rest, double beta) {
    SurfacePoint start = nearest_emitter_point(scene, Imath::V3d(before[0]), Imath::V3d(towards))->point;
    std::vector<Vec3> points{start.p};
    for (std::size_t i = 1; i < before.size(); ++i) {
        start = *scene.trace(start, (before[i] - start.p).normalized());
        points.push_back(start.p);
    }
    for (const Vertex& v : follow_light(scene, start, (towards - start.p).normalized(), 10))
        points.push_back(v.point.p);
    points.insert(points.end(), rest.begin(), rest.end());
    return user_path(name, points, beta);
}

UserPathFile diffuse_box_paths(const Scene& /*scene*/) {
    std::vector<UserPathSpec> specs{
        user_path("floor, right wall", {{0, 1.95f, 0}, {0.4f, 0, 0.3f}, {1, 0.9f, 0.4f}}, 0.9),
        user_path("floor, red wall", {{0.05f, 1.95f, 0.05f}, {0.2f, 0, 0.4f}, {-1, 1, 0.5f}}, 0.8),
        user_path("floor, right wall too", {{0, 1.95f, 0}, {0.6f, 0, 0.1f}, {1, 1.1f, 0.2f}}, 0.6)};
    specs[1].weight = 2;
    return {specs};
}

UserPathFile mirror_glass_box_paths(const Scene& scene) {
    const Vec3 light(0, 1.95f, 0), ball(0.35f, 0.4f, 0.5f);
    std::vector<UserPathSpec> specs{
        specular_user_path(scene, "glass", {light}, ball, {}, 0.4),
        specular_user_path(scene, "glass, off centre", {light}, ball + Vec3(0.1f, 0, 0.1f), {}, 0.15),
        specular_user_path(scene, "floor, glass", {light, {-0.5f, 0, 0.8f}}, ball, {}, 0.6),
        specular_user_path(scene, "mirror wall", {light}, {1, 0.9f, -0.6f}, {{-1, 1.6f, 0.6f}}, 0.5),
        user_path("floor", {light, {0, 0, 0.3f}, {-1, 1, 0.4f}}, 0.7)};
    specs[0].patch = 0.03;
    return {specs};
}

UserPathFile point_light_box_paths(const Scene& scene) {
    const Vec3 light(0.2f, 1.7f, 0.3f);
    return {{user_path("floor, right wall", {light, {0.4f, 0, 0.3f}, {1, 0.9f, 0.4f}}, 0.9),
             user_path("floor, red wall", {light, {0.2f, 0, 0.4f}, {-1, 1, 0.5f}}, 0.8),
             specular_user_path(scene, "mirror ball", {light, {-0.3f, 0, 0.6f}}, {-0.4f, 0.5f, 0}, {}, 0.5)}};
}

UserPathFile two_rooms_paths(const Scene& /*scene*/, float slit) {
    const Vec3 light(-1.2f, 2.45f, -2.2f), door(1.2f + slit / 2, 1, -0.05f);
    const Vec3 floor(0.5f, 0, -2), beyond = floor + (door - floor) * ((2 - floor.x) / (door.x - floor.x));
    return {{user_path("floor, through the slit", {light, floor, beyond}, 0.9),
             user_path("wall, through the slit", {light, {-2, 1, -2}, {2, 1.2f, 0.27f}}, 0.8)}};
}

UserPathFile opening_paths(const Scene& /*scene*/, float slit, int most_bounces) {
    constexpr float kPlane = -0.0625f; // where a thin wall stands, to the last bit: points on it are on no side
    const Vec3 light(-1.2f, 2.45f, -2.2f), beyond(1.2f + slit / 2, 1.2f, 4);
    const Opening all{{1.2, 2.5, kPlane}, {slit, 0, 0}, {0, -2.5, 0}};
    std::vector<UserPathSpec> specs;
    for (int bounces = 1; bounces <= most_bounces; ++bounces) {
        specs.push_back(user_path(std::to_string(bounces) + " bounces", {light, beyond}, 0.9));
        UserPathSpec& spec = specs.back();
        spec.points[1].through = all;
        for (int i = 0; i < bounces; ++i) {
            spec.points.insert(spec.points.begin() + 1, UserPathPoint{.bounce = true});
            spec.beta.push_back(0);
        }
    }
    const Vec3 floor(0.5f, 0, -2), middle(1.2f + slit / 2, 1, kPlane);
    specs.push_back(
        user_path("floor", {light, floor, floor + (middle - floor) * ((2 - floor.x) / (middle.x - floor.x))}, 0.9));
    specs.back().points[2].through = Opening{{1.2 + 0.1 * slit, 0.1, kPlane}, {0.8 * slit, 0.4, 0}, {0, 1.5, 0}};
    return {specs};
}

UserPaths bounces_through(const Scene& scene, float slit, int most_bounces) {
    UserPathFile file = opening_paths(scene, slit, most_bounces);
    file.paths.pop_back();
    return bind_user_paths(scene, file);
}

std::span<const GuidedScene> guided_scenes() {
    static constexpr float kSlit = 1, kNarrow = 0.15f;
    static const GuidedScene scenes[] = {
        {"DiffuseBox", diffuse_box, diffuse_box_paths},
        {"MirrorGlassBox", [] { return mirror_glass_box(); }, mirror_glass_box_paths},
        {"ThinLens", [] { return mirror_glass_box(0.1f); }, mirror_glass_box_paths},
        {"PointLight", point_light_box, point_light_box_paths},
        {"TwoRooms", [] { return two_rooms(kSlit); }, [](const Scene& scene) { return two_rooms_paths(scene, kSlit); }},
        {"Opening", [] { return two_rooms(kSlit); }, [](const Scene& scene) { return opening_paths(scene, kSlit); }},
        {"OpeningInAPlane", [] { return two_rooms(kNarrow, true); },
         [](const Scene& scene) { return opening_paths(scene, kNarrow, 6); }},
        {"FoundOpening", [] { return two_rooms(kNarrow, true); },
         [](const Scene& scene) {
             return find_openings(scene, trace_transport_ends(scene, 2048, 1, {}), {.max_scatterings = 7}, {}).paths;
         }},
    };
    return scenes;
}

} // namespace keyhole::test
