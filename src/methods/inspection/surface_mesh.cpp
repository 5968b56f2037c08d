#include "methods/inspection/inspection.h"

#include "film/tonemap.h"
#include "scene/geometry.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace keyhole {
namespace {

using Triangle = SurfaceMesh::Triangle;
using Colour = std::array<std::uint8_t, 3>;

/// Of one shape or of several.
struct Part {
    std::vector<Vec3> positions;
    std::vector<Colour> colours;
    std::vector<Triangle> triangles;

    void add(const Part& o) {
        const auto first = static_cast<std::uint32_t>(positions.size());
        positions.insert(positions.end(), o.positions.begin(), o.positions.end());
        colours.insert(colours.end(), o.colours.begin(), o.colours.end());
        for (const Triangle& t : o.triangles) triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
};

Colour colour(const Rgb& c) {
    const auto byte = [](double x) {
        return static_cast<std::uint8_t>(std::lround(255 * srgb_encode(static_cast<float>(x))));
    };
    return {byte(c.x), byte(c.y), byte(c.z)};
}

/// What reflects in no way that has a colour of its own.
constexpr Colour kMetal{196, 198, 204}, kClear{186, 214, 226}, kBlack{24, 24, 26};

Colour colour_at(const SurfacePoint& point) {
    if (point.material == nullptr) return kBlack;
    const Bsdf bsdf = point.material->bsdf(point);
    const Rgb diffuse = bsdf.diffuse_reflectance(point.ns) * kPi;
    if (luminance(diffuse) > 0) return colour(diffuse);
    return bsdf.traits().finite || bsdf.traits().delta ? kMetal : kBlack;
}

/// Whether it lets light through as glass does.
bool is_clear(const Shape& shape, SurfacePoint point) {
    if (shape.material == nullptr) return bounds_media(shape);
    const BsdfTraits traits = shape.material->traits();
    if (traits.diffuse) return false;
    point.material = shape.material.get();
    const Bsdf bsdf = shape.material->bsdf(point);
    return bsdf.delta(point.ns, Event::transmit).has_value() || !is_black(bsdf.eval(-point.ns, point.ns));
}

/// Of `around` times as many triangles.
TriangleMesh tessellated(const Sphere& sphere, std::uint32_t around) {
    const std::uint32_t down = around / 2;
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= down; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double theta = kPi * j / down, phi = 2 * kPi * i / around;
            const Imath::V3d n(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
            mesh.positions.push_back(sphere.center + Vec3(n) * sphere.radius);
        }
    for (std::uint32_t j = 0; j < down; ++j)
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t a = j * around + i, b = j * around + (i + 1) % around;
            mesh.triangles.push_back({a, b, a + around});
            mesh.triangles.push_back({b, b + around, a + around});
        }
    return mesh;
}

/// Makes each of the mesh's corners one that stands for all in its cell, of width `cell` [m].
Part clustered(const TriangleMesh& mesh, double cell, const Vec3& origin) {
    Part part;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> cells;
    std::vector<std::uint32_t> index(mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Imath::V3d at = Imath::V3d(mesh.positions[i] - origin) / cell;
        const std::array key{std::llround(at.x), std::llround(at.y), std::llround(at.z)};
        const auto [found, added] = cells.try_emplace({key[0], key[1], key[2]}, part.positions.size());
        if (added) part.positions.push_back(mesh.positions[i]);
        index[i] = found->second;
    }
    for (const auto& t : mesh.triangles) {
        const Triangle moved{index[t[0]], index[t[1]], index[t[2]]};
        if (moved[0] != moved[1] && moved[1] != moved[2] && moved[2] != moved[0]) part.triangles.push_back(moved);
    }
    return part;
}

/// That many of the triangles, from all over the list.
Part thinned(const Part& all, std::size_t count) {
    Part part;
    std::map<std::uint32_t, std::uint32_t> index;
    const auto moved = [&](std::uint32_t i) {
        const auto [known, fresh] = index.try_emplace(i, part.positions.size());
        if (fresh) part.positions.push_back(all.positions[i]);
        return known->second;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const Triangle& t = all.triangles[i * all.triangles.size() / count];
        part.triangles.push_back({moved(t[0]), moved(t[1]), moved(t[2])});
    }
    return part;
}

/// Of as many triangles as that at most, and of some. Where all are narrower than cells they don't become larger ones,
/// and some are left out.
Part simplified(const TriangleMesh& mesh, std::size_t most) {
    Part part{mesh.positions, {}, {}};
    for (const auto& t : mesh.triangles) part.triangles.push_back({t[0], t[1], t[2]});
    if (part.triangles.size() <= most) return part;
    Imath::Box3f box;
    for (const Vec3& p : mesh.positions) box.extendBy(p);
    const double size = std::max(1e-9f, box.size().length());
    for (double parts = 2 * std::sqrt(static_cast<double>(most)); parts >= 1; parts /= 1.4) {
        Part coarser = clustered(mesh, size / parts, box.min);
        if (coarser.triangles.empty()) break;
        part = std::move(coarser);
        if (part.triangles.size() <= most) return part;
    }
    return part.triangles.size() <= most ? part : thinned(part, most);
}

using MeshPtr = std::shared_ptr<const TriangleMesh>;

/// A mesh that has copies, as simplified() makes it.
MeshPtr of_few_triangles(const MeshPtr& mesh, std::size_t most) {
    if (mesh->triangles.size() <= most) return mesh;
    Part part = simplified(*mesh, most);
    return std::make_shared<TriangleMesh>(TriangleMesh{std::move(part.positions), {}, {}, std::move(part.triangles)});
}

/// The mesh, with the colour that each position has on one of the triangles that meet there.
Part coloured(const Shape& shape, const TriangleMesh& mesh, std::size_t most) {
    Part part = simplified(mesh, most);
    TriangleMesh all; // triangles of what is left
    all.positions = part.positions;
    for (const Triangle& t : part.triangles) all.triangles.push_back({t[0], t[1], t[2]});
    // Textures follow the parametrisation, which only the mesh as it was has.
    const bool whole = all.positions.size() == mesh.positions.size();
    const TriangleMesh& read = whole ? mesh : all;
    const bool clear = !read.triangles.empty() && is_clear(shape, triangle_point(read, 0, 0.3f, 0.3f));
    part.colours.assign(part.positions.size(), clear ? kClear : kBlack);
    if (clear) return part;
    std::vector<bool> done(part.positions.size());
    constexpr std::array<Vec2, 3> kCorners{Vec2(0.01f, 0.01f), Vec2(0.98f, 0.01f), Vec2(0.01f, 0.98f)};
    for (std::size_t t = 0; t < read.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t at = read.triangles[t][k];
            if (done[at]) continue;
            SurfacePoint point = triangle_point(read, static_cast<std::uint32_t>(t), kCorners[k].x, kCorners[k].y);
            point.material = shape.material.get();
            part.colours[at] = colour_at(point);
            done[at] = true;
        }
    return part;
}

Colour colour_of(const SurfaceEmission& emission) {
    const double most = std::max({emission.radiance.x, emission.radiance.y, emission.radiance.z});
    return most > 0 ? colour(emission.radiance / most) : kBlack;
}

} // namespace

SurfaceMesh surface_mesh(const Scene& scene, std::size_t most) {
    Part opaque, emitters, clear;
    const auto spheres = static_cast<double>(std::ranges::count_if(
        scene.shapes(), [](const Shape& s) { return std::holds_alternative<Sphere>(s.geometry); }));
    const double around = std::clamp(std::sqrt(static_cast<double>(most) / 2 / std::max(1.0, spheres)), 4.0, 48.0);
    SurfaceMesh out;
    out.of_scene = scene.triangle_count();
    const double share =
        std::min(1.0, static_cast<double>(most) / static_cast<double>(std::max<std::size_t>(1, out.of_scene)));
    constexpr std::size_t kFew = 16; // triangles of a shape, which nobody needs to save where there are few shapes
    const std::size_t least = std::clamp(most / std::max<std::size_t>(1, scene.shapes().size()), std::size_t{1}, kFew);
    std::map<MeshPtr, MeshPtr> simple; // those of copies
    for (const Shape& shape : scene.shapes()) {
        TriangleMesh made;
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (const auto* sphere = std::get_if<Sphere>(&shape.geometry))
            mesh = &(made = tessellated(*sphere, static_cast<std::uint32_t>(around)));
        const double own = share * static_cast<double>((mesh != nullptr ? mesh : held_mesh(shape))->triangles.size());
        const auto few = std::max(least, static_cast<std::size_t>(own));
        if (const auto* instance = std::get_if<MeshInstance>(&shape.geometry)) {
            MeshPtr& known = simple[instance->mesh];
            if (known == nullptr) known = of_few_triangles(instance->mesh, few);
            mesh = &(made = flattened({known, instance->to_world}));
        }
        if (mesh->triangles.empty()) continue;
        Part part = coloured(shape, *mesh, few);
        if (shape.emission != nullptr) {
            part.colours.assign(part.positions.size(), colour_of(*shape.emission));
            emitters.add(part);
        } else {
            const bool through = !part.colours.empty() && part.colours[0] == kClear;
            (through ? clear : opaque).add(part);
        }
    }
    out.emitters = opaque.triangles.size();
    opaque.add(emitters);
    out.clear = opaque.triangles.size();
    opaque.add(clear);
    out.positions = std::move(opaque.positions);
    out.colours = std::move(opaque.colours);
    out.triangles = std::move(opaque.triangles);
    return out;
}

} // namespace keyhole
