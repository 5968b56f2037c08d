// What a photon map stores: a photon, or its adjoint, an importon.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>

namespace keyhole {

// Unit vectors and colours in few bytes, with their errors stated.

/// A unit vector as a point of the octahedral map (Cigolle et al. 2014, "A Survey of Efficient Representations for
/// Independent Unit Vectors"), one signed integer an axis. Axes and edge diagonals come back exactly. Largest error:
/// 0.0037 degrees with 16 bits a coordinate, 0.95 degrees with 8 bits.
template <class Int> class OctahedralVector {
  public:
    OctahedralVector() = default;

    /// `v` is unit.
    explicit OctahedralVector(const Vec3& v) {
        const float l1 = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
        float x = v.x / l1, y = v.y / l1;
        if (v.z < 0) {
            const float folded = std::copysign(1 - std::abs(y), x);
            y = std::copysign(1 - std::abs(x), y);
            x = folded;
        }
        x_ = quantise(x);
        y_ = quantise(y);
    }

    /// The vector up to its length: a test against a cone needs no more.
    Vec3 unnormalised() const {
        float x = static_cast<float>(x_), y = static_cast<float>(y_);
        const float z = kScale - std::abs(x) - std::abs(y);
        if (z < 0) {
            const float unfolded = std::copysign(kScale - std::abs(y), x);
            y = std::copysign(kScale - std::abs(x), y);
            x = unfolded;
        }
        return {x, y, z};
    }

    Vec3 decode() const { return unnormalised().normalized(); }

    bool operator==(const OctahedralVector&) const = default;

  private:
    static constexpr float kScale = std::numeric_limits<Int>::max();
    static Int quantise(float x) { return static_cast<Int>(std::lrint(std::clamp(x, -1.0f, 1.0f) * kScale)); }

    Int x_ = 0, y_ = 0;
};

/// A non-negative RGB triple in 6 bytes: 12 bits a channel under one exponent of 7 bits (as RGB9E5, but wider), and
/// five bits for whoever has a use for them. Rounded to nearest, so that errors average out: at most 2^-12 of the
/// largest channel, in every channel. From 2^-79 (less becomes black) to 2^47 (more is held there).
class SharedExponentRgb {
  public:
    SharedExponentRgb() = default;

    /// `c` is finite and has no negative channel.
    /// @param marks 0 to 31
    explicit SharedExponentRgb(const Rgb& c, unsigned marks = 0) {
        words_[1] = static_cast<std::uint16_t>(marks >> 4 << 15);
        words_[2] = static_cast<std::uint16_t>(marks << kBits);
        assert(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0);
        const double largest = std::max({c.x, c.y, c.z});
        int exponent = 0;
        std::frexp(largest, &exponent);
        // Rounding up may need one more bit than there is.
        if (std::lrint(std::ldexp(largest, kBits - exponent)) > kMask) ++exponent;
        if (largest == 0 || exponent < kLeast) return;
        const bool overflow = exponent > kMost;
        if (overflow) exponent = kMost;
        const double scale = std::ldexp(1.0, kBits - exponent);
        const auto biased = static_cast<long>(exponent + kBias);
        const std::array<long, 3> parts{biased & 15, biased >> 4, 0};
        for (unsigned i = 0; i < 3; ++i) {
            const double m = std::min(c[static_cast<int>(i)] * scale, static_cast<double>(kMask));
            words_[i] = static_cast<std::uint16_t>(words_[i] | std::lrint(m) | parts[i] << kBits);
        }
    }

    Rgb decode() const {
        const int biased = words_[0] >> kBits | (words_[1] >> kBits & 7) << 4;
        const int exponent = biased - kBias - kBits;
        // 2^exponent put together from its bits: ldexp is slow, and this is the innermost loop of a lookup.
        const auto scale = std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
        return {(words_[0] & kMask) * scale, (words_[1] & kMask) * scale, (words_[2] & kMask) * scale};
    }

    unsigned marks() const { return words_[2] >> kBits | static_cast<unsigned>(words_[1] >> 15) << 4; }

    bool operator==(const SharedExponentRgb&) const = default;

  private:
    static constexpr int kBits = 12, kMask = (1 << kBits) - 1, kBias = 80;
    static constexpr int kLeast = 1 - kBias, kMost = 127 - kBias; // exponents

    // Mantissa below; above it four bits of the exponent in the first word, three in the second, and the marks in what
    // is left.
    std::array<std::uint16_t, 3> words_{};
};

/// Of some light, as shares of it or as luminance, what may take a way to the eye that is longer than the shortest by
/// 1, 2, ... vertices: see Photon::spare(). Longer ways than these are treated like the longest.
constexpr int kLongerWays = 4;
using LongerWays = std::array<float, kLongerWays>;
/// The entry for a way that is longer by `longer`, which is positive.
inline float by_way(const LongerWays& ways, int longer) {
    return ways[static_cast<std::size_t>(std::min(longer, kLongerWays) - 1)];
}

/// What a photon was before it arrived.
struct PhotonPast {
    static constexpr int kMostSpare = 7;

    bool caustic = false;   ///< see Photon::caustic()
    int spare = kMostSpare; ///< see Photon::spare(); not negative
};

/// Light that arrived at a surface, in 24 bytes. An importon has the same form: `direction` is then towards the eye's
/// side, and `power` the RGB importance that arrived from there.
class Photon {
  public:
    /// `ng` is the geometric normal; `direction` is unit and points away from the surface to where the light came from.
    /// `power` [W, or importance] is finite and not negative.
    Photon(const Vec3& position, const Vec3& ng, const Vec3& direction, const Rgb& power, const PhotonPast& past = {})
        : position_(position),
          power_(power, (past.caustic ? kCaustic : 0) | (ng.dot(direction) < 0 ? kBehind : 0) |
                            static_cast<unsigned>(std::min(past.spare, PhotonPast::kMostSpare)) << kSpare),
          direction_(direction), normal_(facing(ng, direction)) {}

    const Vec3& position() const { return position_; }
    /// Geometric normal on the side that the light arrived at, so that the two sides of a sheet are told apart.
    const OctahedralVector<std::int8_t>& normal() const { return normal_; }
    Vec3 direction() const { return direction_.decode(); }
    Rgb power() const { return power_.decode(); }
    /// Whether specular vertices alone scattered the light before (L S+ D). A photon of the global map may be one, too.
    /// In the caustic map those of small lamps aren't marked: no ray looks for these (is_large_lamp()).
    bool caustic() const { return (power_.marks() & kCaustic) != 0; }
    /// Whether it arrived on the side that the surface's geometric normal turns away from.
    bool behind() const { return (power_.marks() & kBehind) != 0; }
    /// By how many vertices its way to the eye may be longer than the shortest one, which is straight from d1, or from
    /// d2 by way of d1, before the path has more scatterings than `max_depth` allows; PhotonPast::kMostSpare: by so
    /// many or more. Of an importon: by how many the way that it came from the eye is longer.
    int spare() const { return static_cast<int>(power_.marks() >> kSpare); }
    /// Whether it may reach the eye by a way that is longer than the shortest one by `longer` vertices.
    bool reaches(int longer) const { return spare() >= std::min(longer, PhotonPast::kMostSpare); }
    void set_power(const Rgb& power) { power_ = SharedExponentRgb(power, power_.marks()); }

    bool operator==(const Photon&) const = default;

  private:
    static constexpr unsigned kCaustic = 1, kBehind = 2;
    static constexpr int kSpare = 2; // bit of the marks

    Vec3 position_;
    SharedExponentRgb power_;
    OctahedralVector<std::int16_t> direction_;
    OctahedralVector<std::int8_t> normal_;
};

static_assert(sizeof(Photon) == 24);

} // namespace keyhole
