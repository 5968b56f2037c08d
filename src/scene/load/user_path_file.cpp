#include "scene/load/user_path_file.h"

#include "scene/load/yaml_reader.h"

#include <fmt/format.h>

#include <set>

namespace keyhole {
namespace {

constexpr NumberRange kBeta{"an angle in degrees", 0, 90, true};
constexpr NumberRange kAnyBeta{"an angle in degrees", 0, 90};
constexpr NumberRange kWeight{"a weight", 1e-6, 1e6};

/// What a file says for all paths that say nothing themselves.
struct Defaults {
    double beta = kDefaultBeta;
    std::optional<double> patch, tolerance;
};

double radians(double degrees) { return degrees * kPi / 180; }

std::optional<double> read_length(const MapReader& map, std::string_view key, std::optional<double> otherwise) {
    const YamlNode* node = map.find(key);
    return node != nullptr ? read_number(*node, kLength) : otherwise;
}

std::vector<double> read_beta(const YamlNode* node, std::size_t segments, double otherwise) {
    if (node == nullptr) return std::vector<double>(segments, otherwise);
    if (node->kind != YamlNode::Kind::list) return std::vector<double>(segments, radians(read_number(*node, kBeta)));
    if (node->items.size() != segments)
        fail_expected(*node, fmt::format("one angle in degrees, or a list of {}: one for each segment", segments));
    std::vector<double> beta;
    for (const auto& item : node->items) beta.push_back(radians(read_number(*item, kAnyBeta)));
    return beta;
}

UserPathSpec read_path(const YamlNode& node, std::size_t number, const Defaults& defaults) {
    const MapReader map(node, "a user path", {"name", "weight", "points", "beta", "patch", "tolerance"});
    UserPathSpec path;
    path.where = node.position();
    path.name = fmt::format("path {}", number);
    if (const YamlNode* name = map.find("name")) path.name = read_string(*name, "the name of a path");
    path.weight = map.number("weight", kWeight, 1);
    const YamlNode& points = map.at("points");
    for (const auto& item : read_list(points, "points"))
        path.points.push_back({read_vec3(*item, kCoordinate), item->position()});
    if (path.points.size() < 2 || path.points.size() > kMostUserPoints)
        fail_expected(points, fmt::format("2 to {} points, from the light on", kMostUserPoints));
    path.beta = read_beta(map.find("beta"), path.points.size() - 1, defaults.beta);
    path.patch = read_length(map, "patch", defaults.patch);
    path.tolerance = read_length(map, "tolerance", defaults.tolerance);
    return path;
}

/// A word in YAML's single quotes.
std::string quoted(const std::string& word) {
    std::string s = "'";
    for (const char c : word) s += c == '\'' ? std::string("''") : std::string(1, c);
    return s + "'";
}

} // namespace

UserPathFile load_user_paths(const std::string& path) {
    const YamlPtr root = parse_yaml(read_text_file(path), path);
    const MapReader map(*root, "user paths", {"paths", "beta", "patch", "tolerance"});
    Defaults defaults;
    if (const YamlNode* beta = map.find("beta")) defaults.beta = radians(read_number(*beta, kBeta));
    defaults.patch = read_length(map, "patch", std::nullopt);
    defaults.tolerance = read_length(map, "tolerance", std::nullopt);
    UserPathFile file;
    std::set<std::string> names;
    const YamlNode& paths = map.at("paths");
    for (const auto& item : read_list(paths, "user paths")) {
        file.paths.push_back(read_path(*item, file.paths.size() + 1, defaults));
        if (!names.insert(file.paths.back().name).second)
            fail(*item,
                 fmt::format("found the name '{}' again, expected each path to have its own", file.paths.back().name));
    }
    if (file.paths.empty()) fail_expected(paths, "at least one user path");
    return file;
}

std::string user_paths_text(const UserPathFile& file, const std::string& comment) {
    std::string text;
    for (std::size_t at = 0; at < comment.size();) {
        const std::size_t end = std::min(comment.find('\n', at), comment.size());
        text += "# " + comment.substr(at, end - at) + "\n";
        at = end + 1;
    }
    text += "paths:\n";
    const auto degrees = [](double radians) { return radians * 180 / kPi; };
    for (const UserPathSpec& path : file.paths) {
        text += fmt::format("  - name: {}\n    weight: {:.4g}\n    beta: [", quoted(path.name), path.weight);
        for (std::size_t i = 0; i < path.beta.size(); ++i)
            text += fmt::format("{}{:.3g}", i > 0 ? ", " : "", degrees(path.beta[i]));
        text += "]\n";
        if (path.patch) text += fmt::format("    patch: {:.4g}\n", *path.patch);
        if (path.tolerance) text += fmt::format("    tolerance: {:.4g}\n", *path.tolerance);
        text += "    points:\n";
        for (const UserPathPoint& p : path.points)
            text += fmt::format("      - [{:.7g}, {:.7g}, {:.7g}]\n", p.p.x, p.p.y, p.p.z);
    }
    return text;
}

} // namespace keyhole
