// Materials that are measured reflection, in files that we don't read: what lies nearest to any is a grey of some
// gloss.
#include "scene/load/properties.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

/// One that pbrt's files name by `kind`, with its file as `file`.
MaterialPtr read_measured(Properties& p, const char* kind, const char* file) {
    const std::string path = p.word({"", file});
    p.warn(fmt::format("{} {}", kind, path),
           fmt::format("the material '{}' becomes a principled one of reflectance 0.5 and roughness 0.5: the measured "
                       "reflection in '{}' is not read",
                       kind, path));
    PrincipledTextures t = principled_textures(1.5, constant_texture(0.5));
    t.base_color = constant_texture(Rgb(0.5));
    return make_principled(t);
}

} // namespace

MaterialKinds measured_kinds() {
    return {{{"", "measured"}, "", {}, [](Properties& p) { return read_measured(p, "measured", "filename"); }},
            {{"", "fourier"}, "", {}, [](Properties& p) { return read_measured(p, "fourier", "bsdffile"); }}};
}

} // namespace keyhole
