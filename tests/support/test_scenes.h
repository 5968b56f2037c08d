// Small scenes for tests.
#pragma once

#include "scene/scene.h"

#include <memory>

namespace keyhole::test {

using MaterialPtr = std::shared_ptr<const Material>;

/// Collects shapes; build() makes the scene.
class SceneMaker {
  public:
    SceneMaker& rectangle(const Vec3& corner, const Vec3& u, const Vec3& v, const MaterialPtr& m,
                          const Rgb& radiance = Rgb(0.0), bool two_sided = false);
    SceneMaker& sphere(const Vec3& center, float radius, const MaterialPtr& m);
    /// A solid [lower, upper], one shape.
    SceneMaker& box(const Vec3& lower, const Vec3& upper, const MaterialPtr& m);
    /// Six walls of [lower, upper] that face inwards.
    SceneMaker& room(const Vec3& lower, const Vec3& upper, const MaterialPtr& m, const Rgb& radiance = Rgb(0.0));
    /// The opacity of the last shape.
    SceneMaker& alpha(double opacity);
    /// How the light of the last shape spreads about its normal.
    SceneMaker& profile(const EmissionProfile& profile);
    /// The media inside and outside of the last shape.
    SceneMaker& media(std::shared_ptr<const Medium> inside, std::shared_ptr<const Medium> outside = nullptr);
    /// Fills what no shape encloses.
    SceneMaker& medium(std::shared_ptr<const Medium> outermost);
    /// A box of `inside` without a surface, in `around`; null: vacuum.
    SceneMaker& cloud(const Vec3& lower, const Vec3& upper, const std::shared_ptr<const Medium>& inside,
                      const std::shared_ptr<const Medium>& around = nullptr);
    SceneMaker& shape(Shape s);
    SceneMaker& emitter(std::unique_ptr<Emitter> e);
    SceneMaker& camera(const Vec3& from, const Vec3& to, float fov, float lens_radius = 0, float focus = 1);
    /// Makes the camera see along parallels, `size` metres of the film's shorter side.
    SceneMaker& orthographic(double size, float lens_radius = 0, float focus = 1);
    SceneMaker& window(int width, int height, float margin = 0);
    std::unique_ptr<Scene> build();

  private:
    SceneDescription d_;
};

/// A closed room of 2 x 2 x 4 m, diffuse and coloured, with a small light under the ceiling.
std::unique_ptr<Scene> diffuse_box();

/// The same with a mirror wall, a mirror ball at the rear and a glass ball in front.
std::unique_ptr<Scene> mirror_glass_box(float lens_radius = 0);

/// A box with a mirror wall and a mirror before the rear wall, which meet in a corner, a mirror ball, and a lamp so
/// large that paths from the eye find it readily.
std::unique_ptr<Scene> mirror_corner_box(float lens_radius = 0);

/// mirror_glass_box() seen along parallels from a plane within it.
std::unique_ptr<Scene> parallel_sight_box(float lens_radius = 0);

/// diffuse_box() lit by a point light.
std::unique_ptr<Scene> point_light_box();

/// The shell of diffuse_box() with a diffuse ball, lit by a large lamp in plain view that no ray can hit.
std::unique_ptr<Scene> invisible_lamp_box();

/// The shell of diffuse_box() with a mirror ball, lit by a lamp behind a grid, a spot that has an extent and is not
/// seen, and a lamp that shines to either side within an angle.
std::unique_ptr<Scene> narrow_beams_box();

/// diffuse_box() with a pane of glass across it, between its light at the rear and the eye.
std::unique_ptr<Scene> glass_wall_box();

/// Closed box of albedo `rho` whose walls all emit 1 W/(m^2 sr): radiance is 1 / (1 - rho) everywhere. `specular`: with
/// a mirror ball and a glass ball that swallow nothing, and so change nothing.
std::unique_ptr<Scene> furnace(double rho, bool specular = false);

/// furnace() with two balls of a white base under a smooth coat, which swallow nothing, either.
std::unique_ptr<Scene> varnished_furnace(double rho);

/// furnace() with what is white at some of its places only: a ball that is a mirror at the others, one with nothing
/// there, and a screen that is a pane of glass.
std::unique_ptr<Scene> patchy_furnace(double rho);

/// A thick cloud that scatters forwards and swallows nothing, in surroundings of radiance 2; nothing else.
std::unique_ptr<Scene> forward_furnace();

/// furnace() full of fog, with balls of milk and of white; nothing is swallowed.
std::unique_ptr<Scene> foggy_furnace(double rho);

/// Two diffuse rooms joined by a slit of the given width [m]; the light is in the far one. `thin`: what parts them is a
/// plane, in which an opening lies as well.
std::unique_ptr<Scene> two_rooms(float slit, bool thin = false, bool mirror_outside = false);

/// mirror_glass_box() with a ball of green glass, and a block of haze that has no surface.
std::unique_ptr<Scene> hazy_box();

/// mirror_glass_box() full of fog, with balls of milk and of dye, and a cloud of uneven smoke. `grey`: it scatters all
/// primaries alike.
std::unique_ptr<Scene> foggy_box(bool grey = false);

/// A ball in the middle of a cloud that is much larger, in the sun under a sky.
std::unique_ptr<Scene> cloud_in_the_sky();

/// Two rough walls of metal under a smooth coat, which now and then swallow what they scatter, in a diffuse room.
std::unique_ptr<Scene> coated_box();

/// diffuse_box() whose walls are varnished with coats of roughness `alpha`, on bases of the same colours. Its light
/// shines at the ceiling alone, so that most of what is seen comes by way of a coat. With a mirror ball.
std::unique_ptr<Scene> varnished_box(double alpha);

/// Open: a diffuse floor with a mirror ball and a glass ball under a sky that is bright on one side.
std::unique_ptr<Scene> sky_box();

/// Open, under light from one direction. A roof shades the glass ball from it: the path tracer, which the tests start
/// from, never finds a caustic of a light without extent.
std::unique_ptr<Scene> distant_light_scene();

/// The shell of diffuse_box() with a mirror ball, lit by a spot light beside the ball.
std::unique_ptr<Scene> spot_scene();

} // namespace keyhole::test
