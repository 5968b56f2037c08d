// The kinds of textures that scene files know. A new file of this folder gets its function here.
#include "scene/load/properties.h"

namespace keyhole {

template <class T> TextureKinds<T> image_kinds();
template <class T> TextureKinds<T> noise_kinds();
template <class T> TextureKinds<T> simple_kinds();

template <class T> const TextureKinds<T>& texture_kinds() {
    static const TextureKinds<T> kinds =
        joined<std::shared_ptr<const Texture<T>>>({image_kinds<T>(), noise_kinds<T>(), simple_kinds<T>()});
    return kinds;
}

template const TextureKinds<Rgb>& texture_kinds();
template const TextureKinds<double>& texture_kinds();

} // namespace keyhole
