// Carries out the directives of a scene, one after the other.
#pragma once

#include "core/settings.h"
#include "scene/load/input.h"
#include "scene/load/pbrt/build.h"
#include "scene/load/pbrt/camera_film.h"
#include "scene/load/pbrt/syntax/include_stack.h"
#include "scene/scene.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace keyhole::pbrt {

/// What directives change for the shapes and lights that follow, until their block ends.
struct GraphicsState {
    Transform to_world; ///< the current transformation matrix: from the space of what is named next
    bool reversed = false;
    MaterialEntry material;
    std::string material_name;                 ///< of a named material; empty: the one above
    std::shared_ptr<const Directive> named_by; ///< the `NamedMaterial`
    std::optional<AreaLight> area_light;
    std::string inside_medium, outside_medium;
    std::map<std::string, std::vector<Parameter>> attributes; ///< defaults by what they are for: "shape", "light" ...
};

/// A directive that changes the transform: `Identity`, `Translate`, `Scale`, `Rotate`, `LookAt`, `Transform` or
/// `ConcatTransform`. @returns whether it is one.
/// @throws InputError for axes without length and singular matrices.
bool apply_transform(const Directive& directive, Transform& to_world);

/// A scene in the making. Directives go to the member functions that rules() names.
class Importer {
  public:
    Importer(const std::string& path, std::vector<std::string>* warnings, const Settings& settings);

    /// Reads everything, and notes the mistakes in it. Call it once.
    void run();

    /// @throws InputErrors for all mistakes, those in what the shapes are built from included.
    SceneDescription take_description();
    const Settings& settings() const { return settings_; }
    /// Objects placed, as often as they are.
    std::size_t instances() const { return instances_; }

  private:
    enum class Where { options, world, anywhere }; ///< before WorldBegin, after it, or either
    struct Rule {
        Where where;
        void (Importer::*act)(const Directive&); ///< null: it changes no picture
        bool defines_a_name = false;
    };
    /// Of all directives but those that apply_transform() knows.
    static const std::map<std::string_view, Rule>& rules();

    std::optional<Directive> next();
    void carry_out(const Directive& directive);
    void leave_imports();
    Parameters parameters(const Directive& directive, const char* attribute = nullptr) const;

    // Before the world, and anywhere: importer.cpp.
    void note_option(const Directive& directive);
    void note_camera(const Directive& directive);
    void begin_world(const Directive& directive);
    void begin_block(const Directive& directive);
    void end_block(const Directive& directive);
    void set_attribute(const Directive& directive);
    void set_coordinate_system(const Directive& directive);
    void use_coordinate_system(const Directive& directive);
    void reverse_orientation(const Directive& directive);
    void set_active_transform(const Directive& directive);
    void set_color_space(const Directive& directive);
    void include(const Directive& directive);
    void import(const Directive& directive);

    // The world: importer_world.cpp.
    void begin_object(const Directive& directive);
    void place_object(const Directive& directive);
    void define_texture(const Directive& directive);
    void define_material(const Directive& directive);
    void define_medium(const Directive& directive);
    void use_material(const Directive& directive);
    void use_named_material(const Directive& directive);
    void use_media(const Directive& directive);
    void add_area_light(const Directive& directive);
    void add_light(const Directive& directive);
    void add_shape(const Directive& directive);
    bool add_to_last(const ShapeRecord& record);

    struct Block {
        Directive begin;
        GraphicsState outer;
    };
    struct OpenImport {
        std::size_t depth; ///< of the imported file
        GraphicsState outer;
    };

    Warnings warnings_;
    Mistakes mistakes_;
    IncludeStack files_;
    ReadContext context_;

    GraphicsState state_;
    std::vector<Block> blocks_;
    std::vector<OpenImport> imports_;
    std::map<std::string, Transform> coordinate_systems_;
    bool moves_end_only_ = false; ///< transforms are for the time when the shutter closes

    std::map<std::string, Directive> options_; ///< by name; read when the world begins, as they depend on each other
    Transform camera_to_world_;
    std::string camera_medium_;
    bool in_world_ = false;
    View view_;
    Settings settings_;

    Library library_;
    std::vector<ShapeRecord> records_;
    std::vector<Placement> placements_;
    std::size_t instances_ = 0;
    std::map<std::string, std::vector<std::size_t>> objects_; ///< records by the name of their object
    std::vector<std::size_t>* open_object_ = nullptr;         ///< the one that shapes go to now
    std::vector<std::size_t>* last_object_ = nullptr;         ///< the one that the last of records_ went to
    std::vector<EmitterPtr> emitters_, environments_;
};

} // namespace keyhole::pbrt
