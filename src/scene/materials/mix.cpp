#include "scene/load/properties.h"
#include "scene/material.h"
#include "scene/textures/function_texture.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

class MixMaterial final : public Material {
  public:
    MixMaterial(MaterialPtr a, MaterialPtr b, FloatTexture amount)
        : a_(std::move(a)), b_(std::move(b)), amount_(std::move(amount)), salt_(1 + std::max(salt(*a_), salt(*b_))),
          traits_(a_->traits() | b_->traits()), surface_(mixed_surface()), finite_share_(mixed_share()) {}

    Bsdf bsdf(const SurfacePoint& point) const override {
        return (place_hash(point, salt_) < amount_->value(point) ? b_ : a_)->bsdf(point);
    }
    BsdfTraits traits() const override { return traits_; }
    FloatTexture finite_share() const override { return finite_share_; }
    const char* kind() const override { return "mix"; }
    SurfaceDefaults surface() const override { return surface_; }

  private:
    /// Mixes of mixes must choose independently.
    static std::uint32_t salt(const Material& m) {
        const auto* mix = dynamic_cast<const MixMaterial*>(&m);
        return mix != nullptr ? mix->salt_ : 0;
    }
    /// The opacity of the material that is at a place.
    SurfaceDefaults mixed_surface() const {
        const FloatTexture a = a_->surface().alpha, b = b_->surface().alpha;
        if (a == nullptr && b == nullptr) return {};
        return {function_texture<double>([a, b, amount = amount_, salt = salt_](const SurfacePoint& point) {
            const FloatTexture& here = place_hash(point, salt) < amount->value(point) ? b : a;
            return here != nullptr ? here->value(point) : 1.0;
        })};
    }
    FloatTexture mixed_share() const {
        const FloatTexture a = a_->finite_share(), b = b_->finite_share();
        if (a == nullptr && b == nullptr && a_->traits().finite == b_->traits().finite) return nullptr;
        const auto of = [](const FloatTexture& share, const Material& m) {
            return share != nullptr ? share : constant_texture(m.traits().finite ? 1.0 : 0.0);
        };
        return mix_texture<double>(of(a, *a_), of(b, *b_), amount_);
    }

    MaterialPtr a_, b_;
    FloatTexture amount_;
    std::uint32_t salt_;
    BsdfTraits traits_; // kept, for a mix of mixes may have each of them many times
    SurfaceDefaults surface_;
    FloatTexture finite_share_;
};

void refuse_emission(Properties& p, const MaterialPtr& part) {
    if (!is_black(part->surface().emission))
        p.fail("found a mix of a material with 'emission', expected 'emission' of the shape");
}

/// pbrt-v4 names both in one list; v3's amount is the share of the first.
MaterialPtr read_mix(Properties& p) {
    const FloatTexture amount = p.number_texture("amount", kShare, 0.5);
    if (!p.is_pbrt()) {
        const MaterialPtr a = p.materials("a")[0], b = p.materials("b")[0];
        refuse_emission(p, a);
        refuse_emission(p, b);
        return make_mix(a, b, amount);
    }
    const Key list{"", "materials"}, first{"", "namedmaterial1"}, second{"", "namedmaterial2"};
    if (p.has(list)) {
        const auto both = p.materials(list);
        if (both.size() != 2) p.fail(fmt::format("found {} 'materials', expected 2", both.size()));
        return make_mix(both[0], both[1], amount);
    }
    if (!p.has(first) || !p.has(second)) p.fail("found no 'materials', expected the names of two");
    return make_mix(p.materials(second)[0], p.materials(first)[0], amount);
}

} // namespace

MaterialPtr make_mix(MaterialPtr a, MaterialPtr b, FloatTexture amount) {
    return std::make_shared<MixMaterial>(std::move(a), std::move(b), std::move(amount));
}

MaterialKinds mix_kinds() {
    return {{"mix", "a mix of materials", {"a", "b", "amount", "bump", "normal_map"}, read_mix}};
}

} // namespace keyhole
