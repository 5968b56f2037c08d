// The data of an inspection's page, as the scripts of page/ read them.
#pragma once

#include "methods/inspection/inspection.h"
#include "scene/load/yaml/user_path_file.h"

#include <nlohmann/json.hpp>

#include <string>

namespace keyhole {

/// What the page says besides what the inspection found.
struct PageSubject {
    std::string scene; ///< its file's name
    double seconds;    ///< that the renders took
    UserPathFile user_paths;
};

nlohmann::ordered_json page_data(const Scene& scene, const Inspection& inspection, const PageSubject& subject);

} // namespace keyhole
