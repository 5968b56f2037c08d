#include "methods/masks.h"

#include "core/kronecker.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "film/cryptomatte.h"
#include "film/filter.h"

#include <fmt/format.h>

#include <atomic>
#include <map>

namespace keyhole {
namespace {

/// Names of one kind, and which of them each shape has.
struct Names {
    std::vector<std::string> names;
    std::vector<std::int64_t> of_shape;
    std::vector<std::uint32_t> ids;

    void add(const std::string& name) {
        const auto [known, fresh] = index_.try_emplace(name, static_cast<std::int64_t>(names.size()));
        if (fresh) {
            names.push_back(name);
            ids.push_back(cryptomatte_id(name));
        }
        of_shape.push_back(known->second);
    }

  private:
    std::map<std::string, std::int64_t> index_;
};

Names object_names(const Scene& scene) {
    Names all;
    for (const Shape& shape : scene.shapes())
        all.add(shape.name.empty() ? fmt::format("shape {}", all.of_shape.size() + 1) : shape.name);
    return all;
}

Names material_names(const Scene& scene) {
    Names all;
    std::map<const Material*, std::size_t> nameless;
    for (const Shape& shape : scene.shapes()) {
        if (!shape.material_name.empty()) {
            all.add(shape.material_name);
            continue;
        }
        const auto number = nameless.try_emplace(shape.material.get(), nameless.size() + 1).first->second;
        all.add(fmt::format("material {}", number));
    }
    return all;
}

/// The shape that each of `samples` rays through a pixel meets first; negative: none. @returns what they are covered by
/// on average, media included where they meet nothing.
double trace_pixel(const Scene& scene, const PixelFilter& filter, std::uint64_t seed, int x, int y,
                   std::vector<std::int64_t>& shapes) {
    const Camera& camera = scene.camera();
    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(camera.window().width) +
                       static_cast<std::uint64_t>(x);
    double covered = 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        LatticeSource source(Rng(seed, StreamPurpose::masks, pixel), i, Rng(seed, StreamPurpose::masks, ~pixel));
        const auto [u0, u1, u2, u3] = source.take<4>();
        const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const SurfacePoint eye = camera.eye(u2, u3);
        const Vec2 image = camera.window().to_window(centre + filter.sample_offset(u0, u1));
        const Vec3 w = camera.ray_direction(eye, image);
        const auto seen = scene.trace(eye, w);
        shapes[i] = seen && seen->shape != SurfacePoint::kNone ? std::int64_t{seen->shape} : -1;
        covered += shapes[i] >= 0 ? 1 : 1 - luminance(scene.transmittance(eye, infinite_point(w)));
    }
    return covered / static_cast<double>(shapes.size());
}

} // namespace

void add_masks(Picture& picture, const Scene& scene, const Settings& settings, const StopToken& stop) {
    const int width = picture.width, height = picture.height;
    const bool transparent = !scene.camera().parameters().sees_surroundings;
    if (!transparent && !settings.cryptomatte) return;
    const PixelFilter filter(settings);
    Image alpha(width, height, 1);
    const Names objects = object_names(scene), materials = material_names(scene);
    CryptomatteLayers object_layers("CryptoObject", width, height), material_layers("CryptoMaterial", width, height);
    std::atomic<bool> whole = true;
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        std::vector<std::int64_t> shapes(static_cast<std::size_t>(settings.mask_rays)), names(shapes.size());
        for (int x = 0; x < width; ++x) {
            if (stop.requested()) {
                whole = false;
                return;
            }
            *alpha.at(x, y) = static_cast<float>(trace_pixel(scene, filter, settings.seed, x, y, shapes));
            const auto named = [&](const Names& all, CryptomatteLayers& layers) {
                std::ranges::transform(shapes, names.begin(), [&](std::int64_t shape) {
                    return shape < 0 ? -1 : all.of_shape[static_cast<std::size_t>(shape)];
                });
                layers.set(x, y, names, all.ids);
            };
            if (!settings.cryptomatte) continue;
            named(objects, object_layers);
            named(materials, material_layers);
        }
    });
    if (!whole) return;
    if (transparent) picture.layers["alpha"] = std::move(alpha);
    if (!settings.cryptomatte) return;
    std::move(object_layers).add_to(picture, objects.names);
    std::move(material_layers).add_to(picture, materials.names);
}

} // namespace keyhole
