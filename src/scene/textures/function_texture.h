// Textures that are functions of the point, or of other textures.
#pragma once

#include "scene/texture.h"

#include <utility>

namespace keyhole {

template <class T, class F> class FunctionTexture final : public Texture<T> {
  public:
    explicit FunctionTexture(F f) : f_(std::move(f)) {}
    T value(const SurfacePoint& point) const override { return f_(point); }

  private:
    F f_;
};

/// The texture whose value is `f(point)`. With `textures`, of which that is to be a function: where all of them are
/// constant, so is this.
template <class T, class F, class... Of>
std::shared_ptr<const Texture<T>> function_texture(F f, const std::shared_ptr<const Texture<Of>>&... textures) {
    if constexpr (sizeof...(textures) > 0)
        if ((textures->is_constant() && ...)) return constant_texture(T(f(SurfacePoint())));
    return std::make_shared<FunctionTexture<T, F>>(std::move(f));
}

/// The texture whose value is `f` of those of others. Textures must not be null.
template <class F, class... Of> auto computed_texture(F f, const std::shared_ptr<const Texture<Of>>&... of) {
    using T = decltype(f(of->value({})...));
    return function_texture<T>([=](const SurfacePoint& point) { return f(of->value(point)...); }, of...);
}

} // namespace keyhole
