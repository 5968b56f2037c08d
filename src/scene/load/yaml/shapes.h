// Shapes in scene files.
#pragma once

#include "scene/load/input.h"
#include "scene/load/load_mesh.h"
#include "scene/load/yaml/properties.h"
#include "scene/shape.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keyhole {

/// The named media of a scene and its includes. The same object for the same name: shapes tell media apart by it.
using MediumTable = NamedTable<std::shared_ptr<const Medium>>;

/// Meshes already imported, by path.
using MeshCache = std::map<std::string, TriangleMesh>;

/// Reads lists of shapes and puts them into world space. Holds the named groups and the meshes already imported.
class ShapeReader {
  public:
    /// All must outlive it.
    ShapeReader(const MaterialTable& materials, const MediumTable& media, Warnings& warnings, Mistakes& mistakes)
        : materials_(materials), media_(media), warnings_(warnings), mistakes_(mistakes) {}

    // Mistakes are noted: of each group and each item of the list of shapes the first.

    /// Keeps the groups of a `groups:` section.
    void read_groups(const YamlNode& section);

    /// Appends the shapes of a `shapes:` section. @throws FatalInputError for too many.
    void read_shapes(const YamlNode& section);

    /// Reads the groups that nothing used and forgets their shapes, so that mistakes in them don't lie in wait.
    void check_unused_groups();

    /// Appends shapes that stand ready.
    void append(std::vector<Shape> shapes);

    std::vector<Shape> take_shapes() { return std::move(shapes_); }
    bool empty() const { return shapes_.empty(); }
    /// Groups placed by name, as often as they are.
    std::size_t instances() const { return instances_; }

  private:
    /// What the shapes in a group inherit.
    struct Placement {
        Transform to_world;
        Transform to_object;                       ///< from there: the space of the innermost instance
        std::shared_ptr<const ObjectToWorld> copy; ///< from that to the world; null: not in an instance
        std::shared_ptr<const Material> material;  ///< for those without one; may be null
        std::string name, material_name;           ///< of those without one; may be empty
        int depth = 0;                             ///< groups around
    };
    struct Group {
        YamlPtr key, shapes;
        bool used = false;
        bool open = false;  ///< being read, so that an instance of it would be within itself
        bool empty = false; ///< holds no shape
    };
    /// A mesh of a group: held once for all of its instances as soon as there are enough of them.
    struct GroupMesh {
        Transform to_object; ///< an alias of the same map may have another one
        struct Copy {
            std::size_t shape;
            std::shared_ptr<const ObjectToWorld> to_world;
        };
        std::vector<Copy> copies; ///< with meshes of their own, until it is shared
        std::optional<SharedMesh> shared;
    };

    void add_group(const YamlNode::Entry& entry);
    void read_list_of_shapes(const YamlNode& list, const Placement& placement);
    void read_shape(const YamlNode& node, const Placement& placement);
    void read_instance(const YamlNode& node, const Placement& placement);
    void read_group(const YamlNode& node, const Placement& placement);
    Placement inherit(const MapReader& map, const Placement& placement) const;
    void read_named_group(Group& group, const YamlNode& user, const Placement& placement);
    GroupMesh* group_mesh(const YamlNode& node, const Placement& own);
    void add_copy(GroupMesh& mesh, const YamlNode& node, const Placement& own);
    void check_limits(const YamlNode& node) const;

    const MaterialTable& materials_;
    const MediumTable& media_;
    Warnings& warnings_;
    Mistakes& mistakes_;
    std::map<std::string, Group> groups_;
    MeshCache meshes_;
    std::map<const YamlNode*, GroupMesh> group_meshes_;
    std::vector<Shape> shapes_;
    std::size_t triangles_ = 0, instances_ = 0;
    std::size_t leaves_ = 0; ///< shapes that were read, those without an area and parts of one file as one
};

} // namespace keyhole
