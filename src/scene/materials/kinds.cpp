// The kinds of materials that scene files know. A new file of this folder gets its function here.
#include "scene/load/properties.h"

namespace keyhole {
namespace {

/// pbrt's is a file. Null where there are none.
ColorTexture read_normals(Properties& p) {
    const Key file{"", "normalmap"};
    if (!p.has(file)) return p.find_color_texture({"normal_map", ""}, kNormal);
    const std::string path = p.path(file, "an image");
    return p.make_at(file, [&] { return image_texture<Rgb>(path, {.encoding = Encoding::linear}); });
}

} // namespace

MaterialKinds coated_kinds(), conductor_kinds(), dielectric_kinds(), diffuse_kinds(), mix_kinds(), principled_kinds(),
    substitute_kinds(), subsurface_kinds();

const MaterialKinds& material_kinds() {
    static const MaterialKinds kinds =
        joined<MaterialPtr>({coated_kinds(), conductor_kinds(), dielectric_kinds(), diffuse_kinds(), substitute_kinds(),
                             mix_kinds(), principled_kinds(), subsurface_kinds()});
    return kinds;
}

MaterialPtr read_material(const Kind<MaterialPtr>& kind, Properties& p) {
    MaterialPtr material = kind.read(p);
    if (ColorTexture normals = read_normals(p)) material = with_normals(std::move(material), std::move(normals));
    const bool v4 = p.has({"", "displacement"});
    FloatTexture bump = p.find_number_texture({"bump", v4 ? "displacement" : "bumpmap"}, kCoordinate);
    return bump ? with_bump(std::move(material), std::move(bump)) : material;
}

} // namespace keyhole
