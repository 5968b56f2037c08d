#include "scene/load/scene_yaml.h"

#include "scene/load/yaml_camera.h"
#include "scene/load/yaml_emitters.h"
#include "scene/load/yaml_materials.h"
#include "scene/load/yaml_reader.h"
#include "scene/load/yaml_shapes.h"
#include "scene/pbrt/load_pbrt.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace keyhole {
namespace {

/// Gathers a scene from a file and its includes.
class SceneReader {
  public:
    explicit SceneReader(std::vector<std::string>* warnings) : warnings_out_(warnings), warnings_(warnings) {}

    /// Reads included files first, so that their materials stand ready and this file overrules their settings.
    void read_file(const std::string& path, const YamlNode* includer) {
        std::error_code error;
        const auto canonical = std::filesystem::weakly_canonical(path, error).string();
        if (std::find(open_.begin(), open_.end(), canonical) != open_.end())
            fail(*includer, fmt::format("found '{}' including itself, expected no cycle", path));
        if (!seen_.insert(canonical).second) return; // two includes may share a third
        if (is_pbrt(path)) return read_pbrt(path, *includer);
        open_.push_back(canonical);
        if (open_.size() > 32) fail(*includer, "found includes nested more than 32 deep, expected fewer levels");
        documents_.push_back(parse_yaml(read_text(path, includer), path));
        read_sections(*documents_.back());
        open_.pop_back();
    }

    LoadedScene finish(const std::vector<std::string>& overrides) {
        const YamlNode& root = *documents_.front();
        shapes_.check_unused_groups();
        if (shapes_.empty() && std::ranges::none_of(emitters_, [](const auto& e) { return is_environment(*e); })) {
            const YamlNode* section = MapReader(root, "a scene").find("shapes");
            fail(section != nullptr ? *section : root,
                 "found an empty scene, expected at least one shape or an environment");
        }
        LoadedScene scene;
        scene.description.camera = camera_.camera(root);
        scene.description.window = camera_.window();
        scene.description.shapes = shapes_.take_shapes();
        scene.description.emitters = std::move(emitters_);
        scene.description.medium = std::move(outermost_);
        scene.settings = settings_;
        scene.user_paths = std::move(user_paths_);
        scene.instances = instances_ + shapes_.instances();
        for (const auto& o : overrides) apply_override(scene.settings, o);
        return scene;
    }

  private:
    static std::string read_text(const std::string& path, const YamlNode* includer) {
        if (includer == nullptr) return read_text_file(path);
        try {
            return read_text_file(path);
        } catch (const InputError& e) {
            fail(*includer, e.what());
        }
    }

    void read_pbrt(const std::string& path, const YamlNode& includer) {
        LoadedScene part;
        try {
            part = load_pbrt(path, warnings_out_, settings_);
        } catch (const InputError& e) {
            fail(includer, e.what());
        }
        settings_ = part.settings;
        outermost_ = part.description.medium;
        instances_ += part.instances;
        camera_.set_base(part.description.camera, part.description.window);
        shapes_.append(std::move(part.description.shapes));
        for (auto& emitter : part.description.emitters) emitters_.push_back(std::move(emitter));
    }

    void read_sections(const YamlNode& root) {
        const MapReader map(root, "a scene",
                            {"include", "film", "camera", "materials", "media", "medium", "groups", "shapes",
                             "emitters", "render", "user_paths"});
        if (const YamlNode* include = map.find("include")) read_includes(*include);
        if (const YamlNode* film = map.find("film")) camera_.read_film(*film);
        if (const YamlNode* camera = map.find("camera")) camera_.read_camera(*camera);
        if (const YamlNode* materials = map.find("materials")) materials_.read(*materials);
        if (const YamlNode* media = map.find("media")) media_.read(*media);
        if (const YamlNode* medium = map.find("medium")) outermost_ = media_.resolve(*medium);
        if (const YamlNode* groups = map.find("groups")) shapes_.read_groups(*groups);
        if (const YamlNode* shapes = map.find("shapes")) shapes_.read_shapes(*shapes);
        if (const YamlNode* emitters = map.find("emitters")) read_emitters(*emitters);
        if (const YamlNode* render = map.find("render")) read_settings(*render);
        if (const YamlNode* paths = map.find("user_paths"))
            user_paths_ = load_user_paths(resolve_path(*paths, "the path of a file of user paths"));
    }

    void read_includes(const YamlNode& node) {
        constexpr std::string_view kWhat = "the path of a scene file, or a list of them";
        if (node.kind != YamlNode::Kind::list) return read_file(resolve_path(node, kWhat), &node);
        for (const auto& item : node.items) read_file(resolve_path(*item, kWhat), item.get());
    }

    void read_emitters(const YamlNode& section) {
        for (const auto& item : read_list(section, "emitters"))
            if (auto emitter = read_emitter(*item)) emitters_.push_back(std::move(emitter));
    }

    void read_settings(const YamlNode& section) {
        for (const auto& [key, value] : read_names(section, "settings")) {
            const std::string text = value->kind == YamlNode::Kind::scalar ? value->text : std::string();
            if (const auto error = set_setting(settings_, key->text, text)) {
                if (!error->in_key && value->kind != YamlNode::Kind::scalar)
                    fail_expected(*value, "a number or a word");
                fail(error->in_key ? *key : *value, error->message);
            }
        }
    }

    std::vector<std::string>* warnings_out_; // may be null
    Warnings warnings_;
    std::vector<YamlPtr> documents_; // what is read keeps pointers into them
    std::vector<std::string> open_;
    std::set<std::string> seen_;
    CameraReader camera_;
    MaterialTable materials_;
    MediumTable media_;
    std::shared_ptr<const Medium> outermost_;
    ShapeReader shapes_{materials_, media_, warnings_};
    std::vector<std::unique_ptr<Emitter>> emitters_;
    Settings settings_;
    UserPathFile user_paths_;
    std::size_t instances_ = 0; // in included pbrt files
};

} // namespace

LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                       std::vector<std::string>* warnings) {
    SceneReader reader(warnings);
    reader.read_file(path, nullptr);
    return reader.finish(overrides);
}

} // namespace keyhole
