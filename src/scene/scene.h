// The scene: geometry behind Embree, materials, emitters and the camera. Immutable once built, but for the camera's
// window, which trials make smaller, and for how points on emitters are drawn, which renders learn: both are set before
// and after anybody traces.
#pragma once

#include "scene/camera.h"
#include "scene/emitter.h"
#include "scene/emitters/direct_light_sampler.h"
#include "scene/light_tree.h"
#include "scene/media/media.h"
#include "scene/shape.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keyhole {

/// Everything that a scene is built from. Loaders fill one in.
struct SceneDescription {
    std::vector<Shape> shapes;
    std::vector<std::unique_ptr<Emitter>> emitters; ///< those without geometry; area lights follow from shapes. Several
                                                    ///< environments become one, their sum
    std::shared_ptr<const Medium> medium;           ///< fills what no shape encloses; null: vacuum
    CameraParameters camera;
    ImageWindow window;
};

/// Thread-safe. Rays never start on a surface themselves: callers pass SurfacePoints, whose offset keeps a ray off its
/// own surface (an error bound after Pharr, Jakob and Humphreys, not a constant of the scene).
class Scene {
  public:
    /// @throws InputError for bad geometry (indices, non-finite positions), and for neither geometry nor environment.
    explicit Scene(SceneDescription description);
    ~Scene() = default;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    /// The first place seen from `from` along unit direction `w`. With an environment, a miss is a point at infinity.
    std::optional<SurfacePoint> trace(const SurfacePoint& from, const Vec3& w) const;
    /// The same into `found`; false, and nothing there, where nothing is seen. `found` may be `from`.
    bool trace(const SurfacePoint& from, const Vec3& w, SurfacePoint& found) const;

    /// Whether nothing stands between two points. At most one of them is infinite.
    bool visible(const SurfacePoint& a, const SurfacePoint& b) const { return visible(a, b, direction(a, b)); }
    /// The same; `a_to_b` is the direction from `a` to `b`, for callers that know it.
    bool visible(const SurfacePoint& a, const SurfacePoint& b, const Vec3& a_to_b) const;
    /// Whether nothing lies between two places in space [m], which are on no surface.
    bool visible(const Vec3& a, const Vec3& b) const;

    /// Share of light that media leave along the edge between two points: 1 without them.
    Rgb transmittance(const SurfacePoint& a, const SurfacePoint& b) const {
        return media_.empty() ? Rgb(1.0) : media_.transmittance(a, b);
    }

    /// Whether any medium scatters light.
    bool has_scattering_media() const { return media_.scatter(); }
    /// What no shape encloses; null: vacuum.
    const Medium* outermost_medium() const { return media_.outermost(); }
    Attenuation attenuation(const SurfacePoint& a, const SurfacePoint& b) const { return media_.attenuation(a, b); }
    /// Media::fly().
    FreeFlight fly(const SurfacePoint& from, const Vec3& w, const SurfacePoint* to, int primary, double u) const {
        return media_.fly(from, w, to, primary, u);
    }

    const Camera& camera() const { return camera_; }
    /// Not while anybody renders.
    void set_window(const ImageWindow& window) { camera_ = Camera(camera_.parameters(), window); }

    const std::vector<std::unique_ptr<Emitter>>& emitters() const { return emitters_; }
    const Emitter& emitter(std::uint32_t i) const { return *emitters_[i]; }
    /// Index of the emitter that a shape is, or SurfacePoint::kNone.
    std::uint32_t emitter_of_shape(std::size_t shape) const { return emitter_of_shape_[shape]; }
    /// By power; empty if nothing emits.
    const EmitterDistribution& emitter_distribution() const { return emitter_distribution_; }
    /// By what they may do at a point. Nothing to be asked where the distribution is empty.
    const LightTree& light_tree() const { return light_tree_; }
    /// What draws points on emitters for next-event estimation, where that has been learned; null: the light tree does.
    const DirectLightSampler* direct_light() const { return direct_light_.get(); }
    /// Not while anybody renders.
    void set_direct_light(std::shared_ptr<const DirectLightSampler> sampler) { direct_light_ = std::move(sampler); }

    /// Whether what is seen first has a sample of each emitter, and not of one that is chosen.
    bool takes_each_emitter() const { return takes_each_emitter_; }
    void set_takes_each_emitter(bool each) { takes_each_emitter_ = each; }
    const std::vector<Shape>& shapes() const { return shapes_; }
    /// Union of what the materials may do.
    const BsdfTraits& traits() const { return traits_; }
    /// Whether a ray from `from` along unit direction `w` meets what may be clear glass, panes or what is flat in part,
    /// whatever else stands in its way. Much faster than to trace it.
    bool meets_clear_glass(const SurfacePoint& from, const Vec3& w) const;

    /// Bounding box of the geometry, and of media that scatter, world space; where there is none, a box around the
    /// camera.
    const Vec3& lower() const { return lower_; }
    const Vec3& upper() const { return upper_; }
    /// Holds all geometry, and all that scatters. A little too large, so that a beam as wide as the sphere misses
    /// nothing by rounding.
    BoundingSphere bounding_sphere() const { return {(lower_ + upper_) / 2, 1.001f * (upper_ - lower_).length() / 2}; }

    /// Those that rays meet.
    std::size_t triangle_count() const;
    /// Bound on the error along unit `n` of a position on a surface [m], whatever the surface:
    /// keyhole::rounding_along(), and what instances add to it.
    float rounding_along(const Vec3& n, const Vec3& p) const;
    /// Bound on what the transforms of instances add to the error of a position on a surface [m], whatever the surface
    /// and the normal. Much larger, mostly, than what it is on any one of them. 0 if there are none.
    float instance_rounding(const Vec3& p) const;
    /// Memory of the structures that rays are traced with.
    std::size_t accelerator_bytes() const {
        return accelerator_.bytes() + media_.accelerator_bytes() + (clear_glass_ ? clear_glass_->bytes() : 0);
    }

  private:
    void attach_shapes();
    /// Of points in space eyes alone see surroundings, or not; lights there don't care.
    bool hides_surroundings(const SurfacePoint& from) const {
        return from.site == Site::point && !camera_.parameters().sees_surroundings;
    }
    void prepare_emitters();

    std::vector<Shape> shapes_;
    Media media_;
    std::vector<std::unique_ptr<Emitter>> emitters_;
    EmitterDistribution emitter_distribution_;
    LightTree light_tree_;
    std::shared_ptr<const DirectLightSampler> direct_light_;
    bool takes_each_emitter_ = false;
    std::vector<std::uint32_t> emitter_of_shape_;
    std::uint32_t environment_ = SurfacePoint::kNone; // index of the emitter that misses meet
    Camera camera_;
    BsdfTraits traits_;
    Vec3 lower_{0, 0, 0}, upper_{0, 0, 0};
    /// The largest of all instances.
    struct InstanceRounding {
        /// @param reach distance of the mesh's farthest position from the object's origin
        void add(const ObjectToWorld& to_world, float reach);

        float relative = 0; // to the distances of a point and of a copy's own origin from the world's
        float origins = 0;  // of copies' own origins [m]
        float reaches = 0;  // relative one times the distance of a copy's points from its own origin [m]
    } rounding_;
    Accelerator accelerator_;
    std::unique_ptr<Accelerator> clear_glass_; // over what may be that; null if there is none
};

} // namespace keyhole
