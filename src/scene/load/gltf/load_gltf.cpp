#include "scene/load/load.h"

#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/load/gltf/importable.h"
#include "scene/load/gltf/materials.h"
#include "scene/load/gltf/nodes.h"
#include "scene/load/load_mesh.h"
#include "scene/material.h"

#include <Imath/ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <map>
#include <memory>

namespace keyhole {
namespace {

using gltf::Document;
using gltf::Json;
using gltf::MaterialData;

/// Holds everything. Of copies the boxes of their meshes, each found once.
Imath::Box3d box_of(const std::vector<Shape>& shapes) {
    Imath::Box3d box;
    std::map<const TriangleMesh*, Imath::Box3d> meshes;
    for (const Shape& shape : shapes) {
        const TriangleMesh& mesh = *held_mesh(shape);
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        if (instance == nullptr) {
            box.extendBy(box_of(mesh));
            continue;
        }
        const auto [known, fresh] = meshes.try_emplace(&mesh);
        if (fresh) known->second = box_of(mesh);
        const std::array corners{known->second.min, known->second.max};
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 corner(Imath::V3d(corners[i & 1].x, corners[i >> 1 & 1].y, corners[i >> 2].z));
            box.extendBy(Imath::V3d(instance->to_world->point(corner)));
        }
    }
    return box;
}

/// Looks at everything from above one corner.
gltf::View view_of_all(const std::vector<Shape>& shapes) {
    const Imath::Box3d box = box_of(shapes);
    gltf::View view;
    view.window.width = 640;
    view.window.height = 480;
    const Vec3 back = Vec3(0.6F, 0.5F, 1).normalized();
    const double distance = box.size().length() / 2 / std::sin(view.camera.fov_degrees / 2 * kPi / 180);
    view.camera.origin = Vec3(box.center()) + back * static_cast<float>(distance);
    view.camera.forward = -back;
    view.camera.right = view.camera.forward.cross(Vec3(0, 1, 0)).normalized();
    view.camera.up = view.camera.right.cross(view.camera.forward);
    return view;
}

class SceneBuilder {
  public:
    SceneBuilder(const std::string& path, std::vector<std::string>* warnings)
        : path_(path), warnings_(warnings), document_(path, warnings_) {}

    LoadedScene build() {
        LoadedScene scene;
        const std::string content = gltf::importable(document_);
        gltf::LightsAndCamera scene_lights = gltf::read_nodes(document_); // before the importer, which says less of it
        scene.description.shapes = shapes(content);
        scene.instances = static_cast<std::size_t>(std::ranges::count_if(
            scene.description.shapes, [](const Shape& s) { return std::holds_alternative<MeshInstance>(s.geometry); }));
        scene.description.emitters = std::move(scene_lights.emitters);
        light_up(scene.description);
        if (!scene_lights.view) {
            document_.warn("found no camera: one sees everything");
            scene_lights.view = view_of_all(scene.description.shapes);
        }
        scene.description.camera = scene_lights.view->camera;
        scene.description.window = scene_lights.view->window;
        if (document_.root().contains("animations")) document_.warn("animations are left out");
        return scene;
    }

  private:
    std::vector<Shape> shapes(const std::string& content) {
        std::vector<Shape> shapes;
        for (MeshPart& part : import_parts(path_, &content)) {
            const std::size_t material = number_of(part.material);
            const gltf::VertexColors colors = gltf::vertex_colors(part);
            const bool own = colors.color != nullptr || colors.opacity != nullptr;
            const MaterialData data = own ? read(material, colors) : material_of(material);
            Shape shape;
            shape.geometry = std::move(part.geometry);
            shape.material = data.material;
            shape.alpha = data.alpha;
            shape.name = std::move(part.name);
            shape.material_name = name_of(material);
            if (!is_black(data.emission.radiance)) {
                shape.emission = std::make_unique<SurfaceEmission>(data.emission);
                emitting_ += triangle_count(shape);
                if (emitting_ > kMaxTriangles)
                    document_.fail(fmt::format("found more than {} triangles that emit", kMaxTriangles));
            }
            fill(shape, data.inside);
            shapes.push_back(std::move(shape));
        }
        return shapes;
    }

    /// A medium ends where its mesh ends: one with holes would let it out everywhere.
    void fill(Shape& shape, const std::shared_ptr<const Medium>& inside) {
        if (inside == nullptr) return;
        const auto* instance = std::get_if<MeshInstance>(&shape.geometry);
        bool closed = false, told = false;
        if (instance != nullptr) {
            const auto [known, fresh] = closed_.try_emplace(instance->mesh);
            if (fresh) known->second = is_closed(*instance->mesh);
            closed = known->second;
            told = !fresh;
        } else {
            closed = is_closed(std::get<TriangleMesh>(shape.geometry));
        }
        if (closed)
            shape.inside = inside;
        else if (!told)
            document_.warn(fmt::format("the mesh '{}' isn't closed: nothing in its glass of the material '{}' absorbs",
                                       shape.name, shape.material_name));
    }

    /// One beyond the last for meshes that name none, for which the importer has a material of its own.
    std::size_t number_of(const std::string& name) const {
        const std::size_t count = gltf::member(document_.root(), "materials").size();
        std::size_t number = count;
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
        return error == std::errc() && *end == '\0' ? std::min(number, count) : count;
    }

    const MaterialData& material_of(std::size_t material) {
        const auto [known, fresh] = materials_.try_emplace(material);
        if (!fresh) return known->second;
        return known->second = read(material, {});
    }

    MaterialData read(std::size_t material, const gltf::VertexColors& colors) {
        const Json& all = gltf::member(document_.root(), "materials");
        if (material >= all.size()) return gltf::read_material(document_, Json::object(), colors);
        return document_.within(gltf::called("material", material, all[material]),
                                [&] { return gltf::read_material(document_, all[material], colors); });
    }

    std::string name_of(std::size_t material) const {
        const Json& all = gltf::member(document_.root(), "materials");
        if (material >= all.size() || !all[material].is_object()) return {};
        const auto name = all[material].find("name");
        return name != all[material].end() && name->is_string() ? name->get<std::string>() : std::string();
    }

    void light_up(SceneDescription& scene) const {
        if (!scene.emitters.empty() ||
            std::ranges::any_of(scene.shapes, [](const Shape& s) { return s.emission != nullptr; }))
            return;
        document_.warn("found no light: there is a white sky");
        scene.emitters.push_back(make_constant_environment(Rgb(1.0)));
    }

    std::string path_;
    Warnings warnings_;
    Document document_;
    std::map<std::size_t, MaterialData> materials_;
    std::size_t emitting_ = 0;                                   ///< triangles, of each copy
    std::map<std::shared_ptr<const TriangleMesh>, bool> closed_; ///< of those that have copies
};

/// What `read` makes of a file.
template <class Read> auto with_errors_of(const std::string& path, Read&& read) {
    try {
        return read();
    } catch (const Json::exception& e) {
        throw InputError({path, 0, 0}, gltf::words_of(e));
    } catch (const gltf::BadValue& e) {
        throw InputError({path, 0, 0}, gltf::words_of(e));
    }
}

} // namespace

bool is_gltf(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    return extension == ".gltf" || extension == ".glb";
}

LoadedScene load_gltf(const std::string& path, std::vector<std::string>* warnings) {
    return with_errors_of(path, [&] { return SceneBuilder(path, warnings).build(); });
}

std::string importable_gltf(const std::string& path) {
    return with_errors_of(path, [&] {
        Warnings unheard(nullptr);
        return gltf::importable(Document(path, unheard));
    });
}

} // namespace keyhole
