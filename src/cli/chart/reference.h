// What the pictures of a chart are held against.
#pragma once

#include "cli/chart/renderer.h"
#include "film/picture.h"

#include <optional>

namespace keyhole {

struct Reference {
    Image first;
    std::optional<Image> second; ///< independent of the first; their mean is the reference
    std::string method;          ///< that made them; empty: they were given
    double standard_error = 0;   ///< root of the relative squared error of their mean; 0: unknown
    double cpu_seconds = 0;      ///< that they took
};

/// The pictures that the options name, or two that are rendered: by whichever of path, bdpt and mlt is surest here,
/// longer and longer until the standard error or the time that the options name is reached. Parts stay in
/// FOLDER/references, under a name with the scene's hash, and are used again.
/// @throws InputError for pictures of another size.
Reference make_reference(const ChartScene& scene, const ChartOptions& options, const Renderer& renderer, int jobs);

} // namespace keyhole
