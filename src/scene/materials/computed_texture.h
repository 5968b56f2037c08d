// Textures that are functions of others.
#pragma once

#include "scene/texture.h"

#include <tuple>
#include <utility>

namespace keyhole {

/// The texture whose value is `f` of those of others, at each place.
template <class T, class F, class... Of> class ComputedTexture final : public Texture<T> {
  public:
    explicit ComputedTexture(F f, std::shared_ptr<const Texture<Of>>... of) : f_(std::move(f)), of_(std::move(of)...) {}
    T value(const SurfacePoint& point) const override {
        return std::apply([&](const auto&... of) { return f_(of->value(point)...); }, of_);
    }
    bool is_constant() const override {
        return std::apply([](const auto&... of) { return (of->is_constant() && ...); }, of_);
    }

  private:
    F f_;
    std::tuple<std::shared_ptr<const Texture<Of>>...> of_;
};

/// Its constant where all others are constant. Textures must not be null.
template <class F, class... Of> auto computed_texture(F f, std::shared_ptr<const Texture<Of>>... of) {
    using T = decltype(f(of->value({})...));
    using Result = std::shared_ptr<const Texture<T>>;
    if ((of->is_constant() && ...)) return Result(constant_texture(f(of->value({})...)));
    return Result(std::make_shared<ComputedTexture<T, F, Of...>>(std::move(f), std::move(of)...));
}

} // namespace keyhole
