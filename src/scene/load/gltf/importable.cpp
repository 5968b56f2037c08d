#include "scene/load/gltf/importable.h"

#include "core/base64.h"
#include "scene/load/gltf/accessors.h"
#include "scene/load/gltf/extensions.h"
#include "scene/load/gltf/primitives.h"
#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace keyhole::gltf {
namespace {

constexpr int kFloat = 5126;
constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Whether an attribute is read as vectors of floats.
bool is_vector(const std::string& name) {
    constexpr std::array kNames{"POSITION", "NORMAL", "TANGENT", "TEXCOORD_"};
    return std::ranges::any_of(kNames, [&](const char* known) { return name.starts_with(known); });
}

/// Another column.
void add_ones(NumberTable& table) {
    NumberTable wider{table.count, table.width + 1, {}};
    for (std::size_t i = 0; i < table.values.size(); ++i) {
        wider.values.push_back(table.values[i]);
        if ((i + 1) % table.width == 0) wider.values.push_back(1);
    }
    table = std::move(wider);
}

class Rewriter {
  public:
    explicit Rewriter(const Document& document)
        : document_(document), root_(document.root()), reader_(document), indices_(document, reader_) {}

    std::string rewrite() {
        check_extensions(document_);
        keep_meshes();
        number_materials();
        name_nodes();
        Json& meshes = list_of(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i)
            document_.within(called("mesh", i, meshes[i]), [&] {
                for (Json& primitive : list_of(meshes[i], "primitives"))
                    if (primitive.is_object()) rewrite(primitive);
            });
        for (const char* owner : {"meshes", "nodes"})
            for (const Json& entry : list_of(root_, owner)) tell_of_targets(entry);
        check_matrices();
        mend_rotations();
        const std::size_t nodes = list_of(root_, "nodes").size(); // more are added behind them
        for (std::size_t i = 0; i < nodes; ++i) place_instances(i);
        if (!numbers_.empty()) add_buffer();
        return document_.with_root(root_);
    }

  private:
    void rewrite(Json& primitive) {
        const bool packed = stays_packed(primitive);
        check_indices(primitive);
        if (!packed) indices_.check(primitive); // before positions are others
        if (!packed) widen(primitive);
        primitive.erase("targets");
    }

    /// The list at a key; an empty one where there is none.
    Json& list_of(Json& object, const char* key) {
        const auto found = object.is_object() ? object.find(key) : object.end();
        return found != object.end() && found->is_array() ? *found : none_;
    }

    /// Without what is read elsewhere, or not at all: Assimp finds the nodes of lights, cameras and bones by their
    /// names, which others may have in glTF, and refuses the file then.
    void keep_meshes() {
        constexpr const char* kLights = "KHR_lights_punctual";
        for (const char* key : {"cameras", "skins", "animations"}) root_.erase(key);
        if (extension(root_, kLights) != nullptr) root_["extensions"].erase(kLights);
        for (Json& node : list_of(root_, "nodes")) {
            if (!node.is_object()) continue;
            for (const char* key : {"camera", "skin"}) node.erase(key);
            if (extension(node, kLights) != nullptr) node["extensions"].erase(kLights);
        }
    }

    /// Those with a mesh, by which shapes are called: Assimp makes up names of its own.
    void name_nodes() {
        Json& nodes = list_of(root_, "nodes");
        const Json& meshes = list_of(root_, "meshes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (!nodes[i].is_object() || nodes[i].contains("name") || !nodes[i].contains("mesh")) continue;
            nodes[i]["name"] = fmt::format("node {}", i);
            const Json& mesh = nodes[i]["mesh"];
            if (!mesh.is_number_unsigned() || mesh.get<std::size_t>() >= meshes.size()) continue;
            const Json& name = member(meshes[mesh.get<std::size_t>()], "name");
            if (name.is_string()) nodes[i]["name"] = name;
        }
    }

    void number_materials() {
        Json& materials = list_of(root_, "materials");
        for (std::size_t i = 0; i < materials.size(); ++i)
            if (materials[i].is_object()) materials[i]["name"] = std::to_string(i);
    }

    /// Of nodes that have one. What isn't a matrix at all is refused where it is read.
    void check_matrices() {
        const Json& nodes = list_of(root_, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Json& matrix = nodes[i].is_object() ? member(nodes[i], "matrix") : none_;
            if (matrix.size() != 16 || !std::ranges::all_of(matrix, &Json::is_number)) continue;
            constexpr double kRounded = 1e-5;
            const auto at = [&](std::size_t column) { return matrix[4 * column + 3].get<double>(); };
            if (std::abs(at(0)) + std::abs(at(1)) + std::abs(at(2)) + std::abs(at(3) - 1) <= kRounded) continue;
            document_.fail(fmt::format("found 'matrix' of the node {} with the last row {}, {}, {}, {}, expected "
                                       "0, 0, 0, 1",
                                       i, at(0), at(1), at(2), at(3)));
        }
    }

    /// Assimp scales by quaternions that aren't of length 1; lights and cameras turn by what they say.
    void mend_rotations() {
        Json& nodes = list_of(root_, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const Json rotation = nodes[i].is_object() ? member(nodes[i], "rotation") : none_;
            if (rotation.size() != 4 || !std::ranges::all_of(rotation, &Json::is_number)) continue;
            double squares = 0;
            for (const Json& x : rotation) squares += x.get<double>() * x.get<double>();
            if (!std::isfinite(squares)) continue;
            if (squares > 0) {
                for (Json& x : nodes[i]["rotation"]) x = x.get<double>() / std::sqrt(squares);
                continue;
            }
            document_.warn(fmt::format("found a 'rotation' of the node {} that is 0, expected one of length 1: it "
                                       "isn't turned",
                                       i));
            nodes[i].erase("rotation");
        }
    }

    /// Targets without weights change nothing.
    void tell_of_targets(const Json& entry) const {
        const Json& weights = entry.is_object() ? member(entry, "weights") : entry;
        if (std::any_of(weights.begin(), weights.end(), [](const Json& w) { return w.is_number() && w != 0; }))
            document_.warn("morph targets are left out: meshes stand as if their weights were 0");
    }

    void widen(Json& primitive) {
        if (!member(primitive, "attributes").is_object() || !primitive.contains("attributes")) return;
        for (auto& [name, accessor] : primitive["attributes"].items())
            if (const bool color = name.starts_with("COLOR_"); color || is_vector(name))
                accessor = in_floats(value_of<std::size_t>(accessor, name.c_str()), color);
    }

    /// By the format indices lie tight. Assimp reads sparse ones as if they did.
    void check_indices(const Json& primitive) const {
        if (!primitive.contains("indices")) return;
        const auto index = value_of<std::size_t>(primitive["indices"], "indices");
        const Json& accessor = document_.entry("accessors", index);
        if (accessor.contains("sparse") && accessor.contains("bufferView") &&
            document_.entry("bufferViews", accessor["bufferView"].get<std::size_t>()).contains("byteStride"))
            document_.fail(fmt::format("found 'byteStride' of the view of accessor {}, expected none: it holds sparse "
                                       "indices",
                                       index));
    }

    /// Whether Assimp has to unpack KHR_draco_mesh_compression, if it can: into the components that accessors name, so
    /// they must be floats. If all numbers are there unpacked, too, those are taken.
    bool stays_packed(Json& primitive) const {
        if (extension(primitive, kDraco) == nullptr) return false;
        const auto is_plain = [&](const Json& accessor) {
            return document_.entry("accessors", accessor.get<std::size_t>()).contains("bufferView");
        };
        const Json& attributes = primitive["attributes"];
        if (std::all_of(attributes.begin(), attributes.end(), is_plain) &&
            (!primitive.contains("indices") || is_plain(primitive["indices"]))) {
            primitive["extensions"].erase(kDraco);
            return false;
        }
        for (const auto& [name, accessor] : attributes.items())
            if (is_vector(name) && document_.entry("accessors", accessor).at("componentType") != kFloat)
                document_.fail(fmt::format("found integers packed by {}, expected floats: export it without", kDraco));
        return true;
    }

    /// The accessor itself, or one that has its numbers as floats, row by row. Colours have an opacity, which Assimp
    /// takes for 0 if none is given. Of sparse ones Assimp takes the rows for tight, and reads beyond those that
    /// aren't.
    std::size_t in_floats(std::size_t accessor, bool color) {
        const auto [known, fresh] = widened_.try_emplace({accessor, color}, accessor);
        const Json& old = document_.entry("accessors", accessor);
        const bool opaque = color && old.at("type") == "VEC3";
        if (!fresh || (old.at("componentType") == kFloat && !opaque && !old.contains("sparse"))) return known->second;
        NumberTable table = reader_.read(accessor);
        if (opaque) add_ones(table);
        const std::size_t bytes = table.values.size() * sizeof(float);
        Json& views = root_["bufferViews"];
        views.push_back(
            {{"buffer", member(root_, "buffers").size()}, {"byteOffset", numbers_.size()}, {"byteLength", bytes}});
        numbers_.append(reinterpret_cast<const char*>(table.values.data()), bytes);
        Json& accessors = root_["accessors"];
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", kFloat},
                             {"count", table.count},
                             {"type", opaque ? "VEC4" : old.at("type")}});
        return known->second = accessors.size() - 1;
    }

    /// EXT_mesh_gpu_instancing: one child for each instance of a node's mesh.
    void place_instances(std::size_t index) {
        Json& nodes = root_["nodes"];
        const Json* instancing =
            nodes[index].is_object() ? extension(nodes[index], "EXT_mesh_gpu_instancing") : nullptr;
        if (instancing == nullptr || !nodes[index].contains("mesh")) return;
        std::vector<Json> instances;
        constexpr std::array<std::pair<const char*, const char*>, 3> kKeys{
            {{"TRANSLATION", "translation"}, {"ROTATION", "rotation"}, {"SCALE", "scale"}}};
        for (const auto& [attribute, key] : kKeys) {
            const auto found = member(*instancing, "attributes").find(attribute);
            if (found == member(*instancing, "attributes").end()) continue;
            set_each(instances, key, instance_rows(*found, attribute, instances.size()));
        }
        if (instances.empty()) return;
        const std::size_t first = nodes.size();
        Json children = list_of(nodes[index], "children");
        for (std::size_t i = 0; i < instances.size(); ++i) {
            instances[i]["mesh"] = nodes[index]["mesh"];
            if (nodes[index].contains("name")) instances[i]["name"] = nodes[index]["name"];
            children.push_back(first + i);
        }
        nodes[index].erase("mesh");
        nodes[index]["children"] = std::move(children);
        for (Json& instance : instances) nodes.push_back(std::move(instance));
    }

    /// @param expected 0: any
    NumberTable instance_rows(const Json& accessor, const std::string& attribute, std::size_t expected) {
        NumberTable table = reader_.read(accessor.get<std::size_t>());
        const std::size_t width = attribute == "ROTATION" ? 4 : 3;
        if (table.width != width)
            document_.fail(
                fmt::format("found {} numbers a row of {} of instances, expected {}", table.width, attribute, width));
        if (table.count > kMaxShapes || (expected > 0 && table.count != expected))
            document_.fail(fmt::format("found {} of {} of instances, expected {}", table.count, attribute,
                                       expected > 0 ? expected : kMaxShapes));
        return table;
    }

    static void set_each(std::vector<Json>& instances, const char* key, const NumberTable& table) {
        instances.resize(table.count, Json::object());
        for (std::size_t i = 0; i < table.count; ++i) {
            const auto row = table.values.begin() + static_cast<std::ptrdiff_t>(i * table.width);
            std::vector<float> numbers(row, row + static_cast<std::ptrdiff_t>(table.width));
            const double length = std::sqrt(std::inner_product(numbers.begin(), numbers.end(), numbers.begin(), 0.0));
            if (numbers.size() == 4 && length > 0) // a rotation, which integers round
                for (float& number : numbers) number = static_cast<float>(number / length);
            instances[i][key] = std::move(numbers);
        }
    }

    void add_buffer() {
        root_["buffers"].push_back(
            {{"byteLength", numbers_.size()}, {"uri", "data:application/octet-stream;base64," + to_base64(numbers_)}});
    }

    const Document& document_;
    Json root_;
    AccessorReader reader_;
    IndexCheck indices_;
    /// Accessors, each as colours or not, and those that stand for them.
    std::map<std::pair<std::size_t, bool>, std::size_t> widened_;
    std::string numbers_; ///< of a buffer that is added
    Json none_ = Json::array();
};

} // namespace

std::string importable(const Document& document) { return Rewriter(document).rewrite(); }

} // namespace keyhole::gltf
