#include "sampling/scene_hash.h"

#include "core/bytes.h"
#include "scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace keyhole {
namespace {

/// Questions to all materials together, and to all emitters. A scene of a dozen is asked in milliseconds.
constexpr std::size_t kQuestions = 1 << 14;
/// To one of so many: enough for values that vary, and at least what tells two constants apart.
std::size_t questions_for_each(std::size_t count) {
    return std::clamp<std::size_t>(kQuestions / std::max<std::size_t>(count, 1), 4, 256);
}

/// Numbers are added as floats: the last bits of doubles, and of what is none, are the library's affair.
void add_number(Hash& hash, double x) { hash.add(std::isnan(x) ? 0.0f : static_cast<float>(x)); }
void add_color(Hash& hash, const Rgb& c) {
    for (int i = 0; i < 3; ++i) add_number(hash, c[i]);
}

/// Uniform in a ball, made unit: without functions that libraries round in different ways.
Vec3 any_direction(Rng& rng) {
    while (true) {
        Vec3 w;
        for (int i = 0; i < 3; ++i) w[i] = static_cast<float>(2 * rng.next() - 1);
        if (const float r2 = w.length2(); r2 <= 1 && r2 > 1e-4f) return w / std::sqrt(r2);
    }
}

SurfacePoint any_point(const Shape& shape, Rng& rng) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return sphere_point(*sphere, any_direction(rng));
    const auto triangle = rng.below(static_cast<std::uint32_t>(held_mesh(shape)->triangles.size()));
    auto u = static_cast<float>(rng.next()), v = static_cast<float>(rng.next());
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return triangle_point(shape, triangle, u, v);
}

void add_bsdf(Hash& hash, const Bsdf& bsdf, Rng& rng) {
    for (int i = 0; i < 2; ++i) {
        const Vec3 a = any_direction(rng), b = any_direction(rng);
        for (const Vec3& to : {b, -b}) {
            const Bsdf::Finite f = bsdf.finite(a, to);
            add_color(hash, f.value);
            for (const double pdf : {f.pdf_to_light, f.pdf_to_eye}) add_number(hash, pdf);
        }
        for (const Event event : {Event::reflect, Event::transmit})
            if (const auto d = bsdf.delta(a, event)) {
                add_color(hash, d->coefficient);
                for (const double x : {d->probability, d->eta}) add_number(hash, x);
            }
    }
}

/// Things that shapes share, each once, in the order in which shapes name them.
template <class... Parts> class Distinct {
  public:
    using Key = std::tuple<const Parts*...>;
    /// @returns its number
    std::size_t add(const Key& key, std::size_t shape) {
        const auto [at, added] = numbers_.try_emplace(key, uses_.size());
        if (added) uses_.push_back({key, {}});
        uses_[at->second].second.push_back(shape);
        return at->second;
    }
    /// With the shapes that name them.
    const std::vector<std::pair<Key, std::vector<std::size_t>>>& uses() const { return uses_; }

  private:
    std::map<Key, std::size_t> numbers_;
    std::vector<std::pair<Key, std::vector<std::size_t>>> uses_;
};

/// Of copies the mesh once.
void add_geometry(const Shape& shape, std::map<const TriangleMesh*, std::size_t>& meshes, Hash& hash) {
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
        hash.add(sphere->center);
        hash.add(sphere->radius);
        hash.add(sphere->inward);
        return;
    }
    const TriangleMesh& mesh = *held_mesh(shape);
    if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) {
        const auto [known, fresh] = meshes.try_emplace(&mesh, meshes.size());
        const Imath::M44d& m = instance->to_world->matrix();
        for (const Imath::V3d& v : {row_of(m, 0), row_of(m, 1), row_of(m, 2), m.translation()})
            for (int i = 0; i < 3; ++i) add_number(hash, v[i]);
        hash.add(known->second);
        if (!fresh) return;
    }
    hash.add(mesh.positions);
    hash.add(mesh.normals);
    hash.add(mesh.uvs);
    hash.add(mesh.triangles);
}

using Appearances = Distinct<Material, Texture<double>>;

/// What materials and opacities say at points of the shapes that have them.
void add_appearances(const std::vector<Shape>& shapes, const Appearances& appearances, Hash& hash) {
    const std::size_t questions = questions_for_each(appearances.uses().size());
    for (std::size_t n = 0; n < appearances.uses().size(); ++n) {
        const auto& [key, users] = appearances.uses()[n];
        const auto& [material, alpha] = key;
        Rng rng(0, StreamPurpose::scene_hash, n);
        for (std::size_t i = 0; i < questions; ++i) {
            const std::size_t shape = users[i * users.size() / questions];
            SurfacePoint point = any_point(shapes[shape], rng);
            point.shape = static_cast<std::uint32_t>(shape);
            point.material = material;
            if (alpha != nullptr) add_number(hash, alpha->value(point));
            if (material == nullptr) continue;
            if (const FloatTexture share = material->finite_share()) add_number(hash, share->value(point));
            add_bsdf(hash, material->bsdf(point), rng);
        }
    }
}

void add_medium(const Medium* medium, Hash& hash) {
    if (medium == nullptr) return;
    const auto& [absorption, scattering, anisotropy, density] = *medium; // another member belongs here, too
    hash.add(absorption);
    hash.add(scattering);
    hash.add(anisotropy);
    if (density) density->add_to(hash);
}

void add_emitter(const Emitter& emitter, std::size_t questions, Rng& rng, Hash& hash) {
    add_number(hash, emitter.power());
    for (std::size_t i = 0; i < questions; ++i) {
        const EmitterPoint from = emitter.sample_point(rng);
        const EmitterRay ray = emitter.sample_ray(from.point, rng);
        for (const double pdf : {from.pdf, ray.pdf}) add_number(hash, pdf);
        for (int k = 0; k < 3; ++k) hash.add(from.point.p[k]);
        add_color(hash, emitter.radiance(from.point, ray.w));
    }
    if (!is_environment(emitter)) return;
    for (std::size_t i = 0; i < kQuestions; ++i) {
        const Vec3 w = any_direction(rng);
        add_color(hash, emitter.radiance(infinite_point(-w), w));
    }
}

void add_camera(const Camera& camera, Hash& hash) {
    // Another member belongs here, too.
    const auto& [origin, right, up, forward, fov_degrees, lens_radius, focus_distance, shift, near, sees_surroundings] =
        camera.parameters();
    for (const Vec3& v : {origin, right, up, forward}) hash.add(v);
    for (const float f : {fov_degrees, lens_radius, focus_distance, near}) hash.add(f);
    for (const double d : {shift.x, shift.y}) hash.add(d);
    hash.add(sees_surroundings);
}

/// In an order that doesn't depend on where files lie.
void add_images(Hash& hash) {
    std::vector<std::uint64_t> hashes;
    for (const LoadedImage& image : loaded_images()) hashes.push_back(image.hash);
    std::ranges::sort(hashes);
    hash.add(hashes);
}

} // namespace

std::uint64_t scene_hash(const Scene& scene) {
    Hash hash;
    std::map<const TriangleMesh*, std::size_t> meshes;
    Appearances appearances;
    Distinct<Medium> media;
    media.add({scene.outermost_medium()}, 0);
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        add_geometry(shape, meshes, hash);
        const bool has_points = has_area(shape.geometry);
        hash.add(has_points ? appearances.add({shape.material.get(), shape.alpha.get()}, i) : ~std::size_t{0});
        for (const auto& side : {shape.inside, shape.outside}) hash.add(media.add({side.get()}, i));
    }
    add_appearances(scene.shapes(), appearances, hash);
    for (const auto& [key, shapes] : media.uses()) add_medium(std::get<0>(key), hash);
    const std::size_t questions = questions_for_each(scene.emitters().size());
    for (std::size_t i = 0; i < scene.emitters().size(); ++i) {
        Rng rng(1, StreamPurpose::scene_hash, i);
        add_emitter(*scene.emitters()[i], questions, rng, hash);
    }
    add_camera(scene.camera(), hash);
    add_images(hash);
    return hash.value();
}

} // namespace keyhole
