#include "photonmap/power/power.h"

#include "core/integer_power.h"
#include "scene/scene.h"

#include <cmath>

namespace keyhole {

double literal_factor(const Path& path, int d2, const Rgb& flux) {
    const int eye = path.vertices() - 1;
    Rgb rest = flux * path.x[eye].value;
    for (int i = d2; i < eye; ++i) rest *= path.x[i].value * geometry_term(path.x[i].point, path.x[i + 1].point);
    const double visible = luminance(rest);
    return visible > 0 && std::isfinite(1 / visible) ? 1 / visible : 0.0;
}

double unit_of_power(const Scene& scene) {
    const double radius = scene.bounding_sphere().radius;
    return power_of_two_near(radius * radius);
}

} // namespace keyhole
