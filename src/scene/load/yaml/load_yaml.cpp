#include "scene/load/load.h"

#include "scene/load/input.h"
#include "scene/load/yaml/camera.h"
#include "scene/load/yaml/shapes.h"

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

    /// Reads a file with all that it includes. Mistakes wait for finish().
    void read(const std::string& path) {
        try {
            read_file(path, nullptr);
            shapes_.check_unused_groups();
        } catch (const InputError& e) {
            mistakes_.note(e);
            view_is_lost_ = true;
        }
    }

    /// @throws InputErrors for all mistakes.
    LoadedScene finish(const std::vector<std::string>& overrides) {
        if (mistakes_.empty()) mistakes_.attempt([&] { check_not_empty(); });
        if (!view_is_lost_) mistakes_.attempt([&] { camera_.camera(*documents_.front()); });
        mistakes_.report();
        LoadedScene scene;
        scene.description.camera = camera_.camera(*documents_.front());
        scene.description.window = camera_.window();
        scene.description.shapes = shapes_.take_shapes();
        scene.description.emitters = std::move(emitters_);
        scene.description.medium = std::move(outermost_);
        scene.settings = settings_;
        scene.user_paths = std::move(user_paths_);
        scene.instances = instances_ + shapes_.instances();
        for (const auto& o : overrides) apply_override(scene.settings, o, warnings_out_);
        return scene;
    }

  private:
    void check_not_empty() const {
        if (!shapes_.empty() || std::ranges::any_of(emitters_, [](const auto& e) { return is_environment(*e); }))
            return;
        const YamlNode& root = *documents_.front();
        const YamlNode* section = MapReader(root, "a scene").find("shapes");
        fail(section != nullptr ? *section : root,
             "found an empty scene, expected at least one shape or an environment");
    }

    /// Reads included files first, so that their materials stand ready and this file overrules their settings.
    void read_file(const std::string& path, const YamlNode* includer) {
        std::error_code error;
        const auto canonical = std::filesystem::weakly_canonical(path, error).string();
        if (std::find(open_.begin(), open_.end(), canonical) != open_.end())
            fail(*includer, fmt::format("found '{}' including itself, expected no cycle", path));
        if (!seen_.insert(canonical).second) return; // two includes may share a third
        if (is_pbrt(path)) return read_pbrt(path, *includer);
        if (open_.size() == 32) fail(*includer, "found includes nested more than 32 deep, expected fewer levels");
        const YamlPtr document = parse_yaml(read_text(path, includer), path);
        if (document->kind != YamlNode::Kind::map) fail_expected(*document, "a map that describes a scene");
        documents_.push_back(document);
        open_.push_back(canonical);
        read_sections(*document);
        open_.pop_back();
    }

    static std::string read_text(const std::string& path, const YamlNode* includer,
                                 std::string_view what = "a scene file") {
        if (includer == nullptr) return read_text_file(path);
        try {
            return read_text_file(path, what);
        } catch (const InputError& e) {
            fail(*includer, e.what());
        }
    }

    void read_pbrt(const std::string& path, const YamlNode& includer) {
        LoadedScene part;
        try {
            part = load_pbrt(path, warnings_out_, settings_);
        } catch (const InputErrors& e) {
            std::vector<std::string> lines;
            for (const std::string& line : e.lines()) lines.push_back(includer.position().to_string() + ": " + line);
            throw InputErrors(std::move(lines));
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
        static const std::vector<std::string_view> kSections{"include",  "film",   "camera",    "materials",
                                                             "media",    "medium", "groups",    "shapes",
                                                             "emitters", "render", "user_paths"};
        // A section whose name is misspelt may have had all that is missing.
        if (!mistakes_.attempt_definition([&] { MapReader(root, "a scene", kSections); })) view_is_lost_ = true;
        const MapReader map(root, "a scene");
        const auto section = [&](std::string_view key, auto&& read) {
            const YamlNode* node = map.find(key);
            return node == nullptr || mistakes_.attempt([&] { read(*node); });
        };
        const auto definitions = [&](std::string_view key, auto&& read) {
            if (!section(key, read)) mistakes_.lose_names();
        };
        section("include", [&](const YamlNode& node) { read_includes(node); });
        section("film", [&](const YamlNode& node) { camera_.read_film(node); });
        if (!section("camera", [&](const YamlNode& node) { camera_.read_camera(node); })) view_is_lost_ = true;
        definitions("materials", [&](const YamlNode& node) {
            materials_.read(node, "materials", mistakes_,
                            [&](const YamlNode& m) { return read_material(m, materials_); });
        });
        definitions("media", [&](const YamlNode& node) { media_.read(node, "media", mistakes_, read_medium); });
        section("medium", [&](const YamlNode& node) { outermost_ = media_.resolve(node); });
        definitions("groups", [&](const YamlNode& node) { shapes_.read_groups(node); });
        section("shapes", [&](const YamlNode& node) { shapes_.read_shapes(node); });
        section("emitters", [&](const YamlNode& node) { read_emitters(node); });
        section("render", [&](const YamlNode& node) { read_settings(node); });
        section("user_paths", [&](const YamlNode& node) {
            const std::string path = resolve_path(node, "the path of a file of user paths");
            read_text(path, &node, "a file of user paths"); // where there is none, this line says so
            user_paths_ = load_user_paths(path);
        });
    }

    static std::shared_ptr<const Medium> read_medium(const YamlNode& node) {
        const MapReader map(node, "a medium", {"absorption", "scattering", "anisotropy"});
        const YamlNode *absorption = map.find("absorption"), *scattering = map.find("scattering");
        if (absorption == nullptr && scattering == nullptr) fail_expected(node, "'absorption', 'scattering' or both");
        Medium medium;
        if (absorption != nullptr) medium.absorption = read_color(*absorption, {"an absorption coefficient", 0, 1e30});
        if (scattering != nullptr) medium.scattering = read_color(*scattering, {"a scattering coefficient", 0, 1e30});
        medium.anisotropy = static_cast<float>(map.number("anisotropy", {"an anisotropy", -0.9999, 0.9999}, 0));
        return std::make_shared<const Medium>(std::move(medium));
    }

    void read_includes(const YamlNode& node) {
        if (node.kind != YamlNode::Kind::list) return read_include(node);
        for (const auto& item : node.items) read_include(*item);
    }

    /// A file that can't be read may have had all that is missing.
    void read_include(const YamlNode& node) {
        if (mistakes_.attempt_definition(
                [&] { read_file(resolve_path(node, "the path of a scene file, or a list of them"), &node); }))
            return;
        view_is_lost_ = true;
    }

    void read_emitters(const YamlNode& section) {
        for (const auto& item : read_list(section, "emitters"))
            mistakes_.attempt([&] {
                if (auto emitter = read_emitter(*item)) emitters_.push_back(std::move(emitter));
            });
    }

    void read_settings(const YamlNode& section) {
        for (const YamlNode::Entry& entry : read_names(section, "settings"))
            mistakes_.attempt([&] { read_setting(*entry.key, *entry.value); });
    }

    void read_setting(const YamlNode& key, const YamlNode& value) {
        const std::string text = value.kind == YamlNode::Kind::scalar ? value.text : std::string();
        std::string warning;
        const auto error = set_setting(settings_, key.text, text, &warning);
        if (!warning.empty()) warnings_.add(key.position(), warning, warning);
        if (error) {
            if (!error->in_key && value.kind != YamlNode::Kind::scalar) fail_expected(value, "a number or a word");
            fail(error->in_key ? key : value, error->message);
        }
    }

    std::vector<std::string>* warnings_out_; // may be null
    Warnings warnings_;
    Mistakes mistakes_;
    bool view_is_lost_ = false;      // in what could not be read
    std::vector<YamlPtr> documents_; // what is read keeps pointers into them
    std::vector<std::string> open_;
    std::set<std::string> seen_;
    CameraReader camera_;
    MaterialTable materials_{"material"};
    MediumTable media_{"medium"};
    std::shared_ptr<const Medium> outermost_;
    ShapeReader shapes_{materials_, media_, warnings_, mistakes_};
    std::vector<std::unique_ptr<Emitter>> emitters_;
    Settings settings_;
    UserPathFile user_paths_;
    std::size_t instances_ = 0; // in included pbrt files
};

} // namespace

LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides,
                       std::vector<std::string>* warnings) {
    SceneReader reader(warnings);
    reader.read(path);
    return reader.finish(overrides);
}

} // namespace keyhole
