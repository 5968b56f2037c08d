#include "support/test_scenes.h"

#include "scene/emitters/emitters.h"
#include "scene/load/load_mesh.h"

namespace keyhole::test {

SceneMaker& SceneMaker::rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, const MaterialPtr& m,
                                  const Rgb& radiance, bool two_sided) {
    Shape s;
    TriangleMesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    s.geometry = mesh;
    s.material = m;
    if (!is_black(radiance)) s.emission = std::make_unique<SurfaceEmission>(SurfaceEmission{radiance, two_sided});
    d_.shapes.push_back(std::move(s));
    return *this;
}

SceneMaker& SceneMaker::sphere(const Vec3& center, float radius, const MaterialPtr& m) {
    Shape s;
    s.geometry = Sphere{center, radius, false};
    s.material = m;
    d_.shapes.push_back(std::move(s));
    return *this;
}

SceneMaker& SceneMaker::box(const Vec3& lower, const Vec3& upper, const MaterialPtr& m) {
    Shape s;
    s.geometry = make_box(lower, upper);
    s.material = m;
    d_.shapes.push_back(std::move(s));
    return *this;
}

SceneMaker& SceneMaker::room(const Vec3& lower, const Vec3& upper, const MaterialPtr& m, const Rgb& radiance) {
    const Vec3 e = upper - lower, x(e.x, 0, 0), y(0, e.y, 0), z(0, 0, e.z);
    rectangle(lower, z, x, m, radiance);            // floor, faces up
    rectangle(lower + y, x, z, m, radiance);        // ceiling
    rectangle(lower, x, y, m, radiance);            // back, faces +z
    rectangle(lower + z, y, x, m, radiance);        // front
    rectangle(lower, y, z, m, radiance);            // left, faces +x
    return rectangle(lower + x, z, y, m, radiance); // right
}

SceneMaker& SceneMaker::alpha(double opacity) {
    d_.shapes.back().alpha = constant_texture(opacity);
    return *this;
}

SceneMaker& SceneMaker::profile(const EmissionProfile& profile) {
    d_.shapes.back().emission->profile = profile;
    return *this;
}

SceneMaker& SceneMaker::media(std::shared_ptr<const Medium> inside, std::shared_ptr<const Medium> outside) {
    d_.shapes.back().inside = std::move(inside);
    d_.shapes.back().outside = std::move(outside);
    return *this;
}

SceneMaker& SceneMaker::medium(std::shared_ptr<const Medium> outermost) {
    d_.medium = std::move(outermost);
    return *this;
}

SceneMaker& SceneMaker::cloud(const Vec3& lower, const Vec3& upper, const std::shared_ptr<const Medium>& inside,
                              const std::shared_ptr<const Medium>& around) {
    const std::size_t first = d_.shapes.size();
    room(lower, upper, nullptr); // its sides face inwards: their outside is the cloud's inside
    for (std::size_t i = first; i < d_.shapes.size(); ++i) {
        d_.shapes[i].outside = inside;
        d_.shapes[i].inside = around;
    }
    return *this;
}

SceneMaker& SceneMaker::shape(Shape s) {
    d_.shapes.push_back(std::move(s));
    return *this;
}

SceneMaker& SceneMaker::emitter(std::unique_ptr<Emitter> e) {
    d_.emitters.push_back(std::move(e));
    return *this;
}

SceneMaker& SceneMaker::camera(const Vec3& from, const Vec3& to, float fov, float lens_radius, float focus) {
    CameraParameters c;
    c.origin = from;
    c.forward = (to - from).normalized();
    c.right = c.forward.cross(Vec3(0, 1, 0)).normalized();
    c.up = c.right.cross(c.forward);
    c.fov_degrees = fov;
    c.lens_radius = lens_radius;
    c.focus_distance = focus;
    d_.camera = c;
    return *this;
}

SceneMaker& SceneMaker::orthographic(double size, float lens_radius, float focus) {
    d_.camera.lens_radius = lens_radius;
    d_.camera.focus_distance = focus;
    d_.camera = keyhole::orthographic(d_.camera, size);
    return *this;
}

SceneMaker& SceneMaker::window(int width, int height, float margin) {
    d_.window = {width, height, margin};
    return *this;
}

std::unique_ptr<Scene> SceneMaker::build() { return std::make_unique<Scene>(std::move(d_)); }

namespace {

/// Walls of [-1,1] x [0,2] x [-1,3] with a red left wall, and the camera that all boxes share.
SceneMaker box_shell(const MaterialPtr& right, float lens_radius = 0) {
    const auto white = make_diffuse(Rgb(0.75)), red = make_diffuse(Rgb(0.75, 0.25, 0.2));
    SceneMaker m;
    m.rectangle({-1, 0, -1}, {0, 0, 4}, {2, 0, 0}, white)
        .rectangle({-1, 2, -1}, {2, 0, 0}, {0, 0, 4}, white)
        .rectangle({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, white)
        .rectangle({-1, 0, 3}, {0, 2, 0}, {2, 0, 0}, white)
        .rectangle({-1, 0, -1}, {0, 2, 0}, {0, 0, 4}, red)
        .rectangle({1, 0, -1}, {0, 0, 4}, {0, 2, 0}, right)
        .camera({0, 1, 2.9f}, {0, 0.95f, -1}, 42, lens_radius, 2.5f)
        .window(64, 48);
    return m;
}

void add_light(SceneMaker& m) {
    m.rectangle({-0.1f, 1.95f, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, make_diffuse(Rgb(0.0)), Rgb(60.0));
}

} // namespace

std::unique_ptr<Scene> diffuse_box() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    add_light(m);
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_diffuse(Rgb(0.5)));
    return m.build();
}

std::unique_ptr<Scene> mirror_glass_box(float lens_radius) {
    SceneMaker m = box_shell(make_mirror(Rgb(0.9)), lens_radius);
    add_light(m);
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    m.sphere({0.35f, 0.4f, 0.5f}, 0.4f, make_glass(1.5));
    return m.build();
}

std::unique_ptr<Scene> mirror_corner_box(float lens_radius) {
    SceneMaker m = box_shell(make_mirror(Rgb(0.9)), lens_radius);
    m.rectangle({-0.6f, 1.95f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f}, make_diffuse(Rgb(0.0)), Rgb(2.0));
    m.rectangle({-0.2f, 0.2f, -0.95f}, {1.1f, 0, 0}, {0, 1.5f, 0}, make_mirror(Rgb(0.6, 0.8, 0.7)));
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    return m.build();
}

std::unique_ptr<Scene> parallel_sight_box(float lens_radius) {
    SceneMaker m = box_shell(make_mirror(Rgb(0.9)));
    add_light(m);
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    m.sphere({0.35f, 0.4f, 0.5f}, 0.4f, make_glass(1.5));
    return m.orthographic(1.8, lens_radius, 2).build();
}

std::unique_ptr<Scene> hazy_box() {
    const auto green = std::make_shared<Medium>(Medium{Rgb(2.0, 0.4, 1.5)});
    const auto haze = std::make_shared<Medium>(Medium{Rgb(0.3, 0.5, 0.8)});
    SceneMaker m = box_shell(make_mirror(Rgb(0.9)));
    add_light(m);
    m.sphere({0.1f, 0.4f, 0.5f}, 0.4f, make_glass(1.5)).media(green);
    m.cloud({-0.9f, 0.3f, -0.8f}, {-0.4f, 1.6f, 1.5f}, haze);
    return m.build();
}

std::unique_ptr<Scene> foggy_box(bool grey) {
    const auto color = [grey](double r, double g, double b) { return grey ? Rgb((r + g + b) / 3) : Rgb(r, g, b); };
    const auto medium = [](const Medium& m) { return std::make_shared<const Medium>(m); };
    const auto fog = medium({color(0.05, 0.1, 0.02), color(0.3, 0.2, 0.25), 0.5f});
    const auto milk = medium({color(0.1, 0.3, 1.0), color(3, 4, 2)});
    DensityGrid::Values values{{2, 3, 2}, {1, 0, 3, 0.5f, 0, 2, 1, 1, 2, 0, 0.2f, 4}};
    const Imath::Box3d box(Imath::V3d(-0.9, 0.3, -0.8), Imath::V3d(-0.4, 1.6, 1.5));
    const auto grid = std::make_shared<const DensityGrid>(std::move(values), box, Imath::M44d());
    const auto smoke = medium({color(1.0, 0.5, 0.5), Rgb(1.0), -0.3f, grid});
    const auto dye = medium({Rgb(2.0, 0.4, 1.5)}); // which scatters nothing
    SceneMaker m = box_shell(make_mirror(Rgb(0.9)));
    add_light(m);
    m.sphere({0.1f, 0.4f, 0.5f}, 0.4f, make_glass(1.3)).media(milk, fog);
    m.sphere({0.5f, 0.3f, -0.4f}, 0.3f, make_glass(1.5)).media(dye, fog);
    m.cloud({-0.9f, 0.3f, -0.8f}, {-0.4f, 1.6f, 1.5f}, smoke, fog);
    return m.medium(fog).build();
}

std::unique_ptr<Scene> coated_box() {
    const auto white = make_diffuse(Rgb(0.7));
    const auto number = [](double x) { return constant_texture(x); };
    const Coat coat{.eta = 1.5, .alpha_x = number(0), .alpha_y = number(0), .thickness = number(0.01)};
    const auto coated = make_coated_conductor(coat, constant_texture(Rgb(0.9)), number(0.5), number(0.5));
    SceneMaker m;
    m.rectangle({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, coated)
        .rectangle({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, coated)
        .rectangle({-1, 1, 1}, {0, 0, -2}, {2, 0, 0}, white)
        .rectangle({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, white)
        .rectangle({1, -1, 1}, {0, 2, 0}, {0, 0, -2}, white)
        .rectangle({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white)
        .rectangle({-0.3f, 0.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_diffuse(Rgb(0.0)), Rgb(9.0))
        .camera({0, 0, 0.9f}, {0, 0, 0}, 90)
        .window(32, 32);
    return m.build();
}

std::unique_ptr<Scene> point_light_box() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    m.emitter(make_point_emitter({0.2f, 1.7f, 0.3f}, Rgb(2.0, 1.8, 1.5)));
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    return m.build();
}

std::unique_ptr<Scene> invisible_lamp_box() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    m.rectangle({-0.4f, 1.1f, -0.6f}, {0.8f, 0, 0}, {0, 0.2f, 0.6f}, make_diffuse(Rgb(0.5)), Rgb(6.0, 5.0, 4.0), true);
    m.alpha(0).sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_diffuse(Rgb(0.5)));
    return m.build();
}

std::unique_ptr<Scene> narrow_beams_box() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    m.rectangle({-0.6f, 1.95f, -0.6f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_diffuse(Rgb(0.5)), Rgb(20.0))
        .profile(EmissionProfile::grid(70));
    m.rectangle({0.4f, 1.2f, -0.4f}, {0, 0.3f, -0.2f}, {0, 0.1f, 0.3f}, make_diffuse(Rgb(0.5)), Rgb(9.0, 7.0, 5.0))
        .profile(EmissionProfile::cone(25, 40))
        .alpha(0);
    m.rectangle({-0.9f, 0.1f, 0.5f}, {0.3f, 0, 0}, {0, 0.5f, 0}, make_diffuse(Rgb(0.5)), Rgb(2.0), true)
        .profile(EmissionProfile::cone(0, 60));
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    return m.build();
}

std::unique_ptr<Scene> glass_wall_box() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    add_light(m);
    const auto glass = make_glass(1.5);
    m.rectangle({-1, 0, 0.8f}, {0, 2, 0}, {2, 0, 0}, glass); // faces away from the eye
    m.rectangle({-1, 0, 0.9f}, {2, 0, 0}, {0, 2, 0}, glass);
    return m.build();
}

std::unique_ptr<Scene> furnace(double rho, bool specular) {
    SceneMaker m;
    m.room({-1, -1, -1}, {1, 1, 1}, make_diffuse(Rgb(rho)), Rgb(1.0));
    if (specular)
        m.sphere({-0.5f, 0.1f, -0.5f}, 0.35f, make_mirror(Rgb(1.0))).sphere({0.4f, 0, 0}, 0.35f, make_glass(1.5));
    m.camera({0, 0, 0.9f}, {0, 0, -1}, 60).window(32, 32);
    return m.build();
}

std::unique_ptr<Scene> foggy_furnace(double rho) {
    const auto fog = std::make_shared<Medium>(Medium{Rgb(0.0), Rgb(0.2, 0.5, 0.8), 0.6f});
    const auto milk = std::make_shared<Medium>(Medium{Rgb(0.0), Rgb(3.0), -0.4f});
    SceneMaker m;
    m.room({-1, -1, -1}, {1, 1, 1}, make_diffuse(Rgb(rho)), Rgb(1.0))
        .sphere({0.4f, 0, 0}, 0.35f, make_glass(1.3))
        .media(milk, fog)
        .sphere({-0.45f, 0.2f, -0.4f}, 0.35f, make_diffuse(Rgb(1.0)))
        .camera({0, 0, 0.9f}, {0, 0, -1}, 60)
        .window(32, 32);
    return m.medium(fog).build();
}

std::unique_ptr<Scene> cloud_in_the_sky() {
    const auto cloud = std::make_shared<const Medium>(Medium{Rgb(0.02, 0.01, 0.0), Rgb(0.5, 0.6, 0.7), 0.6f});
    SceneMaker m;
    m.sphere({0, 0, 0}, 0.5f, make_diffuse(Rgb(0.4)))
        .cloud({-2, -1.5, -2}, {2, 1.5, 2}, cloud)
        .emitter(make_constant_environment(Rgb(0.3, 0.4, 0.6)))
        .emitter(make_distant_emitter(Vec3(0.6f, -0.6f, -0.5f).normalized(), Rgb(2.0)))
        .camera({0, 0, 6}, {0, 0, 0}, 40)
        .window(32, 32);
    return m.build();
}

std::unique_ptr<Scene> forward_furnace() {
    SceneMaker m;
    m.cloud({-1, -1, -1}, {1, 1, 1}, std::make_shared<const Medium>(Medium{Rgb(0.0), Rgb(5.0), 0.9f}))
        .emitter(make_constant_environment(Rgb(2.0)))
        .camera({0, 0, 4}, {0, 0, 0}, 30)
        .window(32, 32);
    return m.build();
}

namespace {

MaterialPtr varnished(const Rgb& base, double alpha) {
    return make_coated_diffuse(constant_texture(base), constant_texture(alpha), constant_texture(alpha), 1.5,
                               constant_texture(0.0));
}

} // namespace

std::unique_ptr<Scene> varnished_furnace(double rho) {
    SceneMaker m;
    const auto white = varnished(Rgb(1.0), 0);
    m.room({-1, -1, -1}, {1, 1, 1}, make_diffuse(Rgb(rho)), Rgb(1.0))
        .sphere({-0.5f, 0.1f, -0.5f}, 0.35f, white)
        .sphere({0.4f, 0, 0}, 0.35f, white)
        .camera({0, 0, 0.9f}, {0, 0, -1}, 60)
        .window(32, 32);
    return m.build();
}

std::unique_ptr<Scene> patchy_furnace(double rho) {
    SceneMaker m;
    const auto white = make_diffuse(Rgb(1.0)),
               half_mirror = make_mix(white, make_mirror(Rgb(1.0)), constant_texture(0.5)),
               half_pane = make_mix(white, make_thin_dielectric(1.5), constant_texture(0.6));
    m.room({-1, -1, -1}, {1, 1, 1}, make_diffuse(Rgb(rho)), Rgb(1.0))
        .sphere({-0.45f, 0.2f, -0.4f}, 0.35f, half_mirror)
        .sphere({0.4f, 0.2f, -0.2f}, 0.35f, white)
        .alpha(0.5)
        .rectangle({-0.6f, -0.8f, -0.3f}, {1.2f, 0, 0}, {0, 0.5f, -0.2f}, half_pane)
        .camera({0, 0, 0.9f}, {0, 0, -1}, 60)
        .window(32, 32);
    return m.build();
}

std::unique_ptr<Scene> varnished_box(double alpha) {
    const auto white = varnished(Rgb(0.75), alpha), red = varnished(Rgb(0.75, 0.25, 0.2), alpha),
               blue = varnished(Rgb(0.2, 0.4, 0.7), alpha);
    SceneMaker m;
    m.rectangle({-1, 0, -1}, {0, 0, 4}, {2, 0, 0}, white)
        .rectangle({-1, 2, -1}, {2, 0, 0}, {0, 0, 4}, white)
        .rectangle({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, make_diffuse(Rgb(0.6)))
        .rectangle({-1, 0, 3}, {0, 2, 0}, {2, 0, 0}, white)
        .rectangle({-1, 0, -1}, {0, 2, 0}, {0, 0, 4}, red)
        .rectangle({1, 0, -1}, {0, 0, 4}, {0, 2, 0}, blue)
        .rectangle({-0.3f, 1.4f, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(40.0))
        .sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)))
        .camera({0, 1, 2.9f}, {0, 0.95f, -1}, 42)
        .window(64, 48);
    return m.build();
}

namespace {

/// One side of the partition of two rooms at `z`, with the slit from a to b.
void add_leaf(SceneMaker& m, float a, float b, float z, const std::shared_ptr<const Material>& white) {
    m.rectangle({-2, 0, z}, {a + 2, 0, 0}, {0, 2.5f, 0}, white);
    m.rectangle({b, 0, z}, {2 - b, 0, 0}, {0, 2.5f, 0}, white);
}

} // namespace

std::unique_ptr<Scene> two_rooms(float slit, bool thin, bool mirror_outside) {
    const auto white = make_diffuse(Rgb(0.75));
    SceneMaker m;
    m.room({-2, 0, -4}, {2, 2.5f, 4}, white);
    const float a = 1.2f, b = 1.2f + slit;
    if (thin) {
        add_leaf(m, a, b, -0.0625f, white);
    } else {
        add_leaf(m, a, b, 0, white);
        add_leaf(m, a, b, -0.1f, white);
        m.rectangle({a, 0, -0.1f}, {0, 0, 0.1f}, {0, 2.5f, 0}, white)
            .rectangle({b, 0, -0.1f}, {0, 2.5f, 0}, {0, 0, 0.1f}, white);
    }
    m.rectangle({-1.6f, 2.45f, -2.6f}, {0.8f, 0, 0}, {0, 0, 0.8f}, make_diffuse(Rgb(0.0)), Rgb(200.0));
    if (mirror_outside) m.sphere({0, -3, 0}, 1, make_mirror(Rgb(0.9)));
    m.camera({-1.5f, 1.4f, 3.7f}, {0.7f, 1, 0}, 58).window(64, 48);
    return m.build();
}

namespace {

/// A floor and a wall outside.
SceneMaker outside() {
    SceneMaker m;
    m.rectangle({-1.5f, 0, -1.5f}, {0, 0, 3}, {3, 0, 0}, make_diffuse(Rgb(0.6, 0.5, 0.4)))
        .rectangle({-1.5f, 0, -1.2f}, {3, 0, 0}, {0, 1, 0}, make_diffuse(Rgb(0.3, 0.5, 0.7)))
        .camera({0, 1.2f, 3}, {0, 0.35f, 0}, 45)
        .window(64, 48);
    return m;
}

} // namespace

std::unique_ptr<Scene> sky_box() {
    SceneMaker m = outside();
    m.sphere({-0.5f, 0.4f, -0.2f}, 0.4f, make_mirror(Rgb(0.9))).sphere({0.45f, 0.4f, 0.3f}, 0.4f, make_glass(1.5));
    m.emitter(make_constant_environment(Rgb(0.6, 0.8, 1.0)));
    return m.build();
}

std::unique_ptr<Scene> distant_light_scene() {
    SceneMaker m = outside();
    m.sphere({-0.5f, 0.4f, -0.2f}, 0.4f, make_glass(1.5));
    m.rectangle({-0.9f, 1.3f, -0.6f}, {1.7f, 0, 0}, {0, 0, 1.7f}, make_diffuse(Rgb(0.7)));
    m.emitter(make_distant_emitter(Vec3(-0.5f, -1, -0.6f).normalized(), Rgb(3.0, 2.8, 2.5)));
    return m.build();
}

std::unique_ptr<Scene> spot_scene() {
    SceneMaker m = box_shell(make_diffuse(Rgb(0.2, 0.4, 0.7)));
    m.sphere({-0.45f, 0.4f, -0.4f}, 0.4f, make_mirror(Rgb(0.9)));
    m.emitter(make_spot_emitter({.position = {0.4f, 1.8f, 0.4f},
                                 .axis = Vec3(0.2f, -1, 0.4f).normalized(),
                                 .intensity = Rgb(8.0, 7.0, 6.0),
                                 .full_degrees = 15,
                                 .edge_degrees = 35}));
    return m.build();
}

} // namespace keyhole::test
