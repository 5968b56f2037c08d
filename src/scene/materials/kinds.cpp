// The kinds of materials that scene files know. A new file of this folder gets a line here.
#include "scene/load/properties.h"

#define KEYHOLE_MATERIAL_FILES(FILE)                                                                                   \
    FILE(coated)                                                                                                       \
    FILE(conductor)                                                                                                    \
    FILE(dielectric)                                                                                                   \
    FILE(diffuse)                                                                                                      \
    FILE(mix)                                                                                                          \
    FILE(principled)

namespace keyhole {

#define KEYHOLE_DECLARE(FILE) MaterialKinds FILE##_kinds();
KEYHOLE_MATERIAL_FILES(KEYHOLE_DECLARE)

const MaterialKinds& material_kinds() {
#define KEYHOLE_LIST(FILE) FILE##_kinds(),
    static const MaterialKinds kinds = joined<MaterialPtr>({KEYHOLE_MATERIAL_FILES(KEYHOLE_LIST)});
    return kinds;
}

MaterialPtr read_material(const Kind<MaterialPtr>& kind, Properties& p) {
    MaterialPtr material = kind.read(p);
    const bool v4 = p.has({"", "displacement"});
    FloatTexture bump = p.find_number_texture({"bump", v4 ? "displacement" : "bumpmap"}, kCoordinate);
    return bump ? with_bump(std::move(material), std::move(bump)) : material;
}

} // namespace keyhole
