#include "scene/load/yaml/user_path_file.h"

#include "scene/load/input.h"
#include "scene/load/yaml/reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace keyhole {
namespace {

constexpr NumberRange kBeta{"an angle in degrees", 0, 90, true};
constexpr NumberRange kAnyBeta{"an angle in degrees", 0, 90};
constexpr NumberRange kWeight{"a weight", 1e-6, 1e6};
constexpr std::int64_t kMostBounces = 24;
constexpr NumberRange kBounces{"a number of bounces", 1, kMostBounces};

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

Opening read_opening(const YamlNode& node) {
    const MapReader map(node, "an opening", {"corner", "u", "v"});
    const auto edge = [&](std::string_view key) { return read_vec3(map.at(key), kCoordinate); };
    Opening opening{edge("corner"), edge("u"), edge("v")};
    if (!(opening.u.cross(opening.v).length() > 1e-9 * opening.u.length() * opening.v.length()))
        fail_expected(node, "edges u and v that are neither zero nor parallel");
    return opening;
}

/// Numbers of bounces: from the first to the last.
struct Bounces {
    std::int64_t least, most;
};

Bounces read_bounces(const YamlNode& node) {
    if (node.kind != YamlNode::Kind::list) {
        const std::int64_t n = read_integer(node, kBounces);
        return {n, n};
    }
    const auto range = read_numbers(node, 2, kBounces);
    if (range[0] > range[1] || range[0] != std::floor(range[0]) || range[1] != std::floor(range[1]))
        fail_expected(node, "the least and the largest number of bounces");
    return {static_cast<std::int64_t>(range[0]), static_cast<std::int64_t>(range[1])};
}

/// The points of a path as they stand in the file, and what lies between them.
struct PointList {
    std::vector<UserPathPoint> points;
    std::optional<Bounces> bounces; ///< behind the first point
};

PointList read_points(const YamlNode& node) {
    PointList list;
    std::optional<Opening> through;
    for (const auto& item : read_list(node, "points")) {
        if (item->kind != YamlNode::Kind::map) {
            if (list.bounces && list.points.size() == 1 && !through)
                fail_expected(*item,
                              "an opening behind bounces: there is no other telling where light goes from anywhere");
            list.points.push_back({read_vec3(*item, kCoordinate), item->position(), through});
            through.reset();
            continue;
        }
        const MapReader map(*item, "what lies between two points", {"through", "bounces"});
        if (const YamlNode* bounces = map.find("bounces")) {
            if (list.points.size() != 1 || list.bounces || through)
                fail_expected(*item, "bounces behind the first point");
            list.bounces = read_bounces(*bounces);
        }
        if (const YamlNode* opening = map.find("through")) {
            if (list.points.empty() || through) fail_expected(*item, "an opening between two points");
            through = read_opening(*opening);
        }
    }
    if (through || (list.bounces && list.points.size() < 2)) fail_expected(node, "a point behind the last opening");
    return list;
}

/// `path` with so many bounces behind its first point.
UserPathSpec with_bounces(UserPathSpec path, std::int64_t count) {
    const auto n = static_cast<std::size_t>(count);
    path.points.insert(path.points.begin() + 1, n, UserPathPoint{.where = path.points[0].where, .bounce = true});
    path.beta.insert(path.beta.begin(), n, kDefaultBeta);
    return path;
}

/// What tells the paths of one entry apart.
std::string bounces_text(auto count) { return fmt::format(", {} bounce{}", count, count == 1 ? "" : "s"); }

/// One path, or one for each number of bounces.
std::vector<UserPathSpec> read_paths(const YamlNode& node, std::size_t number, const Defaults& defaults) {
    const MapReader map(node, "a user path", {"name", "weight", "points", "beta", "patch", "tolerance"});
    UserPathSpec path;
    path.where = node.position();
    path.name = fmt::format("path {}", number);
    if (const YamlNode* name = map.find("name")) path.name = read_string(*name, "the name of a path");
    path.weight = map.number("weight", kWeight, 1);
    const YamlNode& points = map.at("points");
    PointList list = read_points(points);
    path.points = std::move(list.points);
    const std::size_t bounces = list.bounces ? static_cast<std::size_t>(list.bounces->most) : 0;
    if (path.points.size() < 2 || path.points.size() > kMostUserPoints - bounces)
        fail_expected(points, fmt::format("2 to {} points, from the light on", kMostUserPoints - bounces));
    path.beta = read_beta(map.find("beta"), path.points.size() - 1, defaults.beta);
    path.patch = read_length(map, "patch", defaults.patch);
    path.tolerance = read_length(map, "tolerance", defaults.tolerance);
    if (!list.bounces) return {path};
    const Bounces range = *list.bounces;
    const double total = (1 - std::pow(kNextBounce, range.most - range.least + 1)) / (1 - kNextBounce);
    std::vector<UserPathSpec> paths;
    for (std::int64_t n = range.least; n <= range.most; ++n) {
        paths.push_back(with_bounces(path, n));
        paths.back().weight *= std::pow(kNextBounce, n - range.least) / total;
        if (range.most > range.least) paths.back().name += bounces_text(n);
    }
    return paths;
}

std::size_t bounces_of(const UserPathSpec& path) {
    return static_cast<std::size_t>(
        std::ranges::count_if(path.points, [](const UserPathPoint& p) { return p.bounce; }));
}

/// The name without its number of bounces.
std::string_view entry_name(const UserPathSpec& path) {
    const std::string bounces = bounces_text(bounces_of(path));
    std::string_view name = path.name;
    if (name.ends_with(bounces)) name.remove_suffix(bounces.size());
    return name;
}

/// Whether two paths are of one entry: the second has one bounce more.
bool follows(const UserPathSpec& path, const UserPathSpec& next) {
    const std::string_view name = entry_name(path);
    const bool same_entry = path.where.line == next.where.line && path.where.column == next.where.column;
    return same_entry && bounces_of(path) > 0 && bounces_of(next) == bounces_of(path) + 1 && !name.empty() &&
           name != path.name && name == entry_name(next) && name != next.name;
}

/// A word in YAML's double quotes, which know escapes for what no line may hold.
std::string quoted(const std::string& word) {
    std::string s = "\"";
    for (const char c : word) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            s += fmt::format("\\x{:02x}", byte);
        else
            s += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
    }
    return s + "\"";
}

std::string entry_text(const UserPathEntry& entry) {
    const UserPathSpec& path = entry.paths.front();
    const std::size_t bounces = entry.least_bounces;
    std::string text = fmt::format("  - name: {}\n    weight: {:.4g}\n    beta: [", quoted(entry.name), entry.weight);
    for (std::size_t i = bounces; i < path.beta.size(); ++i)
        text += fmt::format("{}{:.3g}", i > bounces ? ", " : "", path.beta[i] * 180 / kPi);
    text += "]\n";
    if (path.patch) text += fmt::format("    patch: {:.4g}\n", *path.patch);
    if (path.tolerance) text += fmt::format("    tolerance: {:.4g}\n", *path.tolerance);
    text += "    points:\n";
    // All digits: along a chain of mirrors the last one decides where light goes, and edges may be nearly parallel.
    const auto list = [](const Imath::V3d& p) { return fmt::format("[{}, {}, {}]", p.x, p.y, p.z); };
    for (const UserPathPoint& p : path.points) {
        if (p.bounce) continue;
        if (const auto& o = p.through)
            text +=
                fmt::format("      - through: {{corner: {}, u: {}, v: {}}}\n", list(o->corner), list(o->u), list(o->v));
        text += fmt::format("      - {}\n", list(p.p));
        if (&p != path.points.data() || bounces == 0) continue;
        text += entry.paths.size() > 1 ? fmt::format("      - bounces: [{}, {}]\n", bounces, entry.most_bounces)
                                       : fmt::format("      - bounces: {}\n", bounces);
    }
    return text;
}

} // namespace

UserPathFile load_user_paths(const std::string& path) {
    const YamlPtr root = parse_yaml(read_text_file(path, "a file of user paths"), path, "user paths");
    const MapReader map(*root, "user paths", {"paths", "beta", "patch", "tolerance"});
    Defaults defaults;
    if (const YamlNode* beta = map.find("beta")) defaults.beta = radians(read_number(*beta, kBeta));
    defaults.patch = read_length(map, "patch", std::nullopt);
    defaults.tolerance = read_length(map, "tolerance", std::nullopt);
    UserPathFile file;
    std::set<std::string> names;
    const YamlNode& paths = map.at("paths");
    for (const auto& item : read_list(paths, "user paths")) {
        for (UserPathSpec& path : read_paths(*item, file.paths.size() + 1, defaults)) {
            if (!names.insert(path.name).second)
                fail(*item, fmt::format("found the name '{}' again, expected each path to have its own", path.name));
            file.paths.push_back(std::move(path));
        }
    }
    if (file.paths.empty()) fail_expected(paths, "at least one user path");
    return file;
}

std::vector<UserPathEntry> entries_of(const UserPathFile& file) {
    std::vector<UserPathEntry> entries;
    for (const UserPathSpec& path : file.paths) {
        if (entries.empty() || !follows(entries.back().paths.back(), path))
            entries.push_back({.name = path.name, .paths = {&path, 0}, .least_bounces = bounces_of(path)});
        UserPathEntry& entry = entries.back();
        entry.paths = {entry.paths.data(), entry.paths.size() + 1};
        if (entry.paths.size() == 2) entry.name = entry_name(path);
        entry.weight += path.weight;
        entry.most_bounces = bounces_of(path);
    }
    return entries;
}

std::string user_paths_text(const UserPathFile& file, const std::string& comment) {
    std::string text;
    for (std::size_t at = 0; at < comment.size();) {
        const std::size_t end = std::min(comment.find('\n', at), comment.size());
        text += "# " + comment.substr(at, end - at) + "\n";
        at = end + 1;
    }
    text += "paths:\n";
    for (const UserPathEntry& entry : entries_of(file)) text += entry_text(entry);
    return text;
}

} // namespace keyhole
