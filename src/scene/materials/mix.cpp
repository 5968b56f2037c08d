#include "scene/material.h"

#include <algorithm>

namespace keyhole {
namespace {

class MixMaterial final : public Material {
  public:
    MixMaterial(MaterialPtr a, MaterialPtr b, FloatTexture amount)
        : a_(std::move(a)), b_(std::move(b)), amount_(std::move(amount)), salt_(1 + std::max(salt(*a_), salt(*b_))) {}

    Bsdf bsdf(const SurfacePoint& point) const override {
        return (place_hash(point, salt_) < amount_->value(point) ? b_ : a_)->bsdf(point);
    }
    BsdfTraits traits() const override {
        const BsdfTraits a = a_->traits(), b = b_->traits();
        return {a.finite || b.finite, a.delta || b.delta, a.near_lambertian || b.near_lambertian};
    }
    const char* kind() const override { return "mix"; }

  private:
    /// Mixes of mixes must choose independently.
    static std::uint32_t salt(const Material& m) {
        const auto* mix = dynamic_cast<const MixMaterial*>(&m);
        return mix != nullptr ? mix->salt_ : 0;
    }

    MaterialPtr a_, b_;
    FloatTexture amount_;
    std::uint32_t salt_;
};

} // namespace

MaterialPtr make_mix(MaterialPtr a, MaterialPtr b, FloatTexture amount) {
    return std::make_shared<MixMaterial>(std::move(a), std::move(b), std::move(amount));
}

} // namespace keyhole
