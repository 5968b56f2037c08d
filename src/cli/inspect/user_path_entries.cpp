#include "cli/inspect/user_path_entries.h"

#include "sampling/guidance/user_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Imath::V3d& v) { return {v.x, v.y, v.z}; }

/// Degrees as they were given, but for the last digits that the way to radians and back costs.
double degrees(double radians) {
    const double d = radians * 180 / kPi;
    return std::stod(fmt::format("{:.12g}", d));
}

std::size_t bounces_of(const UserPathSpec& path) {
    return static_cast<std::size_t>(
        std::ranges::count_if(path.points, [](const UserPathPoint& p) { return p.bounce; }));
}

/// Whether `next` goes on with an entry of which `path` is the one before.
bool continues(const UserPathSpec& path, const UserPathSpec& next, std::size_t bounces) {
    return path.where.line == next.where.line && path.where.column == next.where.column && bounces > 0 &&
           bounces_of(next) == bounces + 1;
}

Json points_json(const UserPathSpec& path) {
    Json points = Json::array();
    for (const UserPathPoint& p : path.points) {
        if (p.bounce) continue;
        Json point{{"p", vector_json(p.p)}};
        if (p.through)
            point["through"] = {{"corner", vector_json(p.through->corner)},
                                {"u", vector_json(p.through->u)},
                                {"v", vector_json(p.through->v)}};
        points.push_back(point);
    }
    return points;
}

Json entry_json(const UserPathSpec& first) {
    Json entry{{"name", first.name}, {"weight", first.weight}, {"paths", {first.name}}};
    const std::size_t bounces = bounces_of(first);
    Json beta = Json::array();
    for (std::size_t i = bounces; i < first.beta.size(); ++i) beta.push_back(degrees(first.beta[i]));
    entry["beta"] = beta;
    entry["patch"] = first.patch ? Json(*first.patch) : Json();
    entry["tolerance"] = first.tolerance ? Json(*first.tolerance) : Json();
    entry["bounces"] = bounces > 0 ? Json{bounces, bounces} : Json();
    entry["points"] = points_json(first);
    return entry;
}

void add_outcome(const Scene& scene, const UserPathSpec& path, Json& entry) {
    try {
        const UserPath bound = bind_user_path(scene, path);
        entry["signature"] = bound.signature();
        entry["seen"] = bound.seen;
    } catch (const InputError& e) {
        entry["error"] = e.what();
    }
}

} // namespace

Json user_path_entries(const UserPathFile& file, const Scene& scene) {
    Json entries = Json::array();
    const UserPathSpec* last = nullptr;
    for (const UserPathSpec& path : file.paths) {
        const std::size_t bounces = last != nullptr ? bounces_of(*last) : 0;
        if (last != nullptr && continues(*last, path, bounces)) {
            Json& entry = entries.back();
            entry["bounces"][1] = bounces + 1;
            entry["weight"] = entry["weight"].get<double>() + path.weight;
            entry["paths"].push_back(path.name);
            const std::string suffix = fmt::format(", {} bounces", bounces + 1);
            if (path.name.ends_with(suffix)) entry["name"] = path.name.substr(0, path.name.size() - suffix.size());
        } else {
            entries.push_back(entry_json(path));
            add_outcome(scene, path, entries.back());
        }
        last = &path;
    }
    for (Json& entry : entries) entry["weight"] = std::stod(fmt::format("{:.12g}", entry["weight"].get<double>()));
    return entries;
}

UserPathFile working_paths(const UserPathFile& file, const Scene& scene) {
    UserPathFile working;
    std::ranges::copy_if(file.paths, std::back_inserter(working.paths), [&](const UserPathSpec& path) {
        try {
            bind_user_path(scene, path);
            return true;
        } catch (const InputError&) {
            return false;
        }
    });
    return working;
}

} // namespace keyhole
