#include "scene/load/pbrt/build.h"

#include "core/parallel.h"
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <exception>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace keyhole::pbrt {
namespace {

/// Runs body(i) for all i at once; mistakes are noted in the order of i.
template <class Body> void parallel_attempt(std::size_t n, Mistakes& mistakes, const Body& body) {
    std::vector<std::exception_ptr> errors(n);
    parallel_for(static_cast<std::int64_t>(n), [&](std::int64_t i) {
        try {
            body(static_cast<std::size_t>(i));
        } catch (...) {
            errors[static_cast<std::size_t>(i)] = std::current_exception();
        }
    });
    for (const auto& error : errors)
        if (error) mistakes.attempt([&] { std::rethrow_exception(error); });
}

/// Triangles `begin` to `end` of a mesh, with the positions that they use.
TriangleMesh part_of(const TriangleMesh& mesh, std::size_t begin, std::size_t end) {
    TriangleMesh part;
    for (std::size_t i = begin; i < end; ++i) {
        const auto first = static_cast<std::uint32_t>(part.positions.size());
        for (const auto k : mesh.triangles[i]) {
            part.positions.push_back(mesh.positions[k]);
            if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[k]);
            if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[k]);
        }
        part.triangles.push_back({first, first + 1, first + 2});
    }
    return part;
}

class Builder {
  public:
    Builder(std::vector<ShapeRecord> records, const std::vector<Placement>& placements, Warnings& warnings,
            Mistakes& mistakes)
        : records_(std::move(records)), placements_(placements), warnings_(warnings), mistakes_(mistakes),
          uses_(records_.size(), 0) {
        for (const Placement& p : placements_) ++uses_[p.record];
    }

    void resolve_materials(const Library& library) {
        for (ShapeRecord& r : records_) {
            if (!r.material_name.empty())
                mistakes_.attempt(
                    [&] { r.material = r.named_by->look_up(library.materials, "material", r.material_name); });
            if (!r.light || !r.material.is_interface) continue;
            r.light.reset();
            warnings_.add(r.directive.position, "interface light",
                          r.directive.title() + ": the area light is ignored, as pbrt does on the material interface");
        }
    }

    /// Files that several records name are read once.
    void read_meshes() {
        std::map<std::string, std::vector<std::size_t>> users;
        for (std::size_t i = 0; i < records_.size(); ++i)
            if (!records_[i].source.ply_path.empty()) users[records_[i].source.ply_path].push_back(i);
        std::vector<const std::vector<std::size_t>*> files;
        files.reserve(users.size());
        for (const auto& [path, list] : users) files.push_back(&list);
        parallel_attempt(files.size(), mistakes_, [&](std::size_t f) {
            const ShapeRecord& first = records_[files[f]->front()];
            TriangleMesh mesh;
            try {
                mesh = read_ply(first.source.ply_path);
            } catch (const InputError& e) {
                first.directive.fail(e.what());
            }
            for (std::size_t k = 1; k < files[f]->size(); ++k) records_[(*files[f])[k]].source.geometry = mesh;
            records_[files[f]->front()].source.geometry = std::move(mesh);
        });
    }

    /// A curve has texture coordinates only where something reads them.
    void make_curves() {
        parallel_attempt(records_.size(), mistakes_, [&](std::size_t i) {
            ShapeRecord& record = records_[i];
            if (record.source.curves.curves.empty()) return;
            const MaterialPtr& material = record.material.material;
            try {
                record.source.geometry = mesh_of_curves(
                    record.source.curves, is_textured(record) || (material && material->reads_parametrisation()));
            } catch (const InputError& e) {
                record.directive.fail(e.what());
            }
            record.source.curves = {};
        });
    }

    std::vector<Shape> place() {
        share_meshes();
        check_limits();
        std::vector<std::vector<Shape>> made(placements_.size());
        parallel_attempt(placements_.size(), mistakes_, [&](std::size_t i) { made[i] = place(i); });
        if (!mistakes_.empty()) return {};
        for (std::size_t i = 0; i < made.size(); ++i)
            if (made[i].empty()) warn_of_flat(records_[placements_[i].record]);
        std::vector<Shape> shapes;
        for (auto& list : made)
            for (Shape& shape : list) shapes.push_back(std::move(shape));
        if (shapes.size() > kMaxShapes)
            throw InputError(fmt::format("found more than {} shapes, expected fewer", kMaxShapes));
        return shapes;
    }

  private:
    void check_limits() const {
        std::size_t triangles = 0, shapes = 0;
        std::vector<bool> held(records_.size(), false);
        for (std::size_t i = 0; i < placements_.size(); ++i) {
            const std::size_t record = placements_[i].record;
            const ShapeRecord& r = records_[record];
            const std::optional<SharedMesh>& shared = shared_[record];
            const bool instance = shared && shared->stands_as_instance(*copies_[i]);
            if (!instance || !held[record]) triangles += shared ? shared->mesh().triangles.size() : triangles_of(r);
            held[record] = held[record] || instance;
            if (++shapes > kMaxShapes || triangles > kMaxTriangles)
                r.directive.fail(fmt::format("found more than {} shapes or {} triangles, expected fewer", kMaxShapes,
                                             kMaxTriangles));
        }
    }

    static std::size_t triangles_of(const ShapeRecord& record) {
        const auto* mesh = std::get_if<TriangleMesh>(&record.source.geometry);
        return mesh != nullptr ? mesh->triangles.size() : 0;
    }

    /// Whether there are copies of an object that hold the mesh of a record in common. There are no lights among them.
    bool is_shared(std::size_t record) const { return is_worth_sharing(triangles_of(records_[record]), uses_[record]); }

    void share_meshes() {
        shared_.resize(records_.size());
        parallel_attempt(records_.size(), mistakes_, [&](std::size_t i) {
            ShapeRecord& record = records_[i];
            if (!is_shared(i)) return;
            const Transform to_object = record.to_world;
            check_regular(record, to_object);
            Geometry geometry = put(record, std::move(record.source.geometry), to_object);
            shared_[i].emplace(std::move(std::get<TriangleMesh>(geometry)));
        });
        std::shared_ptr<const ObjectToWorld> last;
        std::size_t copy = 0; // that it is of
        for (const Placement& p : placements_) {
            if (shared_[p.record] && p.copy != copy) {
                last = std::make_shared<const ObjectToWorld>(p.to_world);
                copy = p.copy;
            }
            copies_.push_back(shared_[p.record] ? last : nullptr);
        }
    }

    static void check_regular(const ShapeRecord& record, const Transform& t) {
        if (!(regularity(t) > 1e-12))
            record.directive.fail("found a transform that flattens the shape, expected a regular one");
    }

    static Geometry put(const ShapeRecord& record, Geometry geometry, const Transform& to) {
        if (is_textured(record)) parametrise(geometry);
        transform_geometry(geometry, to);
        if (auto* mesh = std::get_if<TriangleMesh>(&geometry)) turn_triangles_to_normals(*mesh);
        if (record.reversed) flip(geometry);
        if (!has_bounded_positions(geometry))
            record.directive.fail("found a shape too large or too far, expected it within 1e13");
        return geometry;
    }

    std::vector<Shape> place(std::size_t i) {
        const Placement& placement = placements_[i];
        ShapeRecord& record = records_[placement.record];
        const Transform to_world = record.to_world * placement.to_world;
        check_regular(record, to_world);
        if (const std::optional<SharedMesh>& shared = shared_[placement.record]) {
            Geometry geometry = shared->placed(copies_[i]);
            if (std::holds_alternative<TriangleMesh>(geometry) && !has_bounded_positions(geometry))
                record.directive.fail("found a shape too large or too far, expected it within 1e13");
            return finish(record, std::move(geometry));
        }
        const bool once = uses_[placement.record] == 1;
        return finish(record, put(record, once ? std::move(record.source.geometry) : record.source.geometry, to_world));
    }

    void warn_of_flat(const ShapeRecord& record) const {
        const std::string& path = record.source.ply_path;
        warnings_.add_flat_mesh(record.directive.position,
                                record.directive.title() + (path.empty() ? "" : " '" + path + "'"));
    }

    static bool is_textured(const ShapeRecord& record) {
        return record.material.is_textured || record.alpha || (record.light && record.light->picture);
    }

    static void parametrise(Geometry& geometry) {
        if (const auto* sphere = std::get_if<Sphere>(&geometry))
            geometry = parametrised_sphere(static_cast<double>(sphere->radius));
        else if (std::get<TriangleMesh>(geometry).uvs.empty())
            assume_uvs(std::get<TriangleMesh>(geometry));
    }

    /// Where power is given each triangle or patch has it, so that they part ways. None where no ray could hit any.
    static std::vector<Shape> finish(const ShapeRecord& record, Geometry geometry) {
        std::vector<Shape> shapes;
        if (!has_area(geometry)) return shapes;
        const auto* mesh = std::get_if<TriangleMesh>(&geometry);
        const std::size_t step = record.source.faces_per_patch;
        if (mesh != nullptr && record.light && record.light->power > 0 && mesh->triangles.size() > step) {
            if (mesh->triangles.size() / step > kMaxShapes)
                record.directive.fail(fmt::format("found more than {} lights, expected fewer", kMaxShapes));
            for (std::size_t i = 0; i < mesh->triangles.size(); i += step)
                shapes.push_back(make_shape(record, part_of(*mesh, i, std::min(i + step, mesh->triangles.size()))));
        } else {
            shapes.push_back(make_shape(record, std::move(geometry)));
        }
        return shapes;
    }

    static Shape make_shape(const ShapeRecord& record, Geometry geometry) {
        Shape shape;
        shape.geometry = std::move(geometry);
        shape.material = record.material.material;
        shape.alpha = record.alpha;
        shape.inside = record.inside;
        shape.outside = record.outside;
        const double area = record.light ? surface_area(shape) : 0;
        if (area > 0) shape.emission = emission_of(*record.light, area);
        return shape;
    }

    std::vector<ShapeRecord> records_;
    const std::vector<Placement>& placements_;
    Warnings& warnings_;
    Mistakes& mistakes_;
    std::vector<std::size_t> uses_;
    std::vector<std::optional<SharedMesh>> shared_;            ///< by record
    std::vector<std::shared_ptr<const ObjectToWorld>> copies_; ///< by placement: the same one within a copy; of no
                                                               ///< shared mesh null
};

bool same_opacity(const FloatTexture& a, const FloatTexture& b) {
    return a == b || (a && b && a->is_constant() && b->is_constant() && a->value({}) == b->value({}));
}

} // namespace

bool look_alike(const ShapeRecord& a, const ShapeRecord& b) {
    return !a.light && !b.light && a.to_world == b.to_world && a.reversed == b.reversed &&
           a.material.material == b.material.material && a.material_name == b.material_name &&
           same_opacity(a.alpha, b.alpha) && a.inside == b.inside && a.outside == b.outside;
}

std::vector<Shape> build_shapes(std::vector<ShapeRecord> records, const std::vector<Placement>& placements,
                                const Library& library, Warnings& warnings, Mistakes& mistakes) {
    Builder builder(std::move(records), placements, warnings, mistakes);
    builder.resolve_materials(library);
    builder.read_meshes();
    builder.make_curves();
    std::vector<Shape> shapes;
    if (mistakes.empty()) mistakes.attempt([&] { shapes = builder.place(); });
    return shapes;
}

} // namespace keyhole::pbrt
