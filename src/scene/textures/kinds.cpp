// The kinds of textures that scene files know. A new file of this folder gets a line here.
#include "scene/load/properties.h"

#define KEYHOLE_TEXTURE_FILES(FILE)                                                                                    \
    FILE(image)                                                                                                        \
    FILE(noise)                                                                                                        \
    FILE(simple)

namespace keyhole {

#define KEYHOLE_DECLARE(FILE) template <class T> TextureKinds<T> FILE##_kinds();
KEYHOLE_TEXTURE_FILES(KEYHOLE_DECLARE)

template <class T> const TextureKinds<T>& texture_kinds() {
#define KEYHOLE_LIST(FILE) FILE##_kinds<T>(),
    static const TextureKinds<T> kinds =
        joined<std::shared_ptr<const Texture<T>>>({KEYHOLE_TEXTURE_FILES(KEYHOLE_LIST)});
    return kinds;
}

template const TextureKinds<Rgb>& texture_kinds();
template const TextureKinds<double>& texture_kinds();

} // namespace keyhole
