// The kinds of materials that scene files know. A new file of this folder gets a line here.
#include "scene/load/properties.h"

#define KEYHOLE_MATERIAL_FILES(FILE)                                                                                   \
    FILE(coated)                                                                                                       \
    FILE(conductor)                                                                                                    \
    FILE(dielectric)                                                                                                   \
    FILE(diffuse)                                                                                                      \
    FILE(hair)                                                                                                         \
    FILE(measured)                                                                                                     \
    FILE(mix)                                                                                                          \
    FILE(principled)                                                                                                   \
    FILE(subsurface)

namespace keyhole {

#define KEYHOLE_DECLARE(FILE) MaterialKinds FILE##_kinds();
KEYHOLE_MATERIAL_FILES(KEYHOLE_DECLARE)

const MaterialKinds& material_kinds() {
#define KEYHOLE_LIST(FILE) FILE##_kinds(),
    static const MaterialKinds kinds = joined<MaterialPtr>({KEYHOLE_MATERIAL_FILES(KEYHOLE_LIST)});
    return kinds;
}

namespace {

/// pbrt's is a file. Null where there are none.
ColorTexture read_normals(Properties& p) {
    const Key file{"", "normalmap"};
    if (!p.has(file)) return p.find_color_texture({"normal_map", ""}, kNormal);
    const std::string path = p.path(file, "an image");
    return p.make_at(file, [&] { return image_texture<Rgb>(path, {.encoding = Encoding::linear}); });
}

} // namespace

MaterialPtr read_material(const Kind<MaterialPtr>& kind, Properties& p) {
    MaterialPtr material = kind.read(p);
    if (ColorTexture normals = read_normals(p)) material = with_normals(std::move(material), std::move(normals));
    const bool v4 = p.has({"", "displacement"});
    FloatTexture bump = p.find_number_texture({"bump", v4 ? "displacement" : "bumpmap"}, kCoordinate);
    return bump ? with_bump(std::move(material), std::move(bump)) : material;
}

} // namespace keyhole
