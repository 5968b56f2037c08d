#include "sampling/paths/independent_paths.h"

namespace keyhole {

double bidirectional_density(const Path& path) {
    const std::size_t n = path.x.size();
    double density = 0, from_light = 1;
    for (std::size_t s = 0; s < n; ++s) {
        if (s == 0 || joinable(path.x[s - 1], path.x[s])) {
            double product = from_light;
            for (std::size_t i = s; i < n; ++i) product *= path.x[i].pdf_from_eye;
            density += product;
        }
        from_light *= path.x[s].pdf_from_light;
    }
    return density;
}

} // namespace keyhole
