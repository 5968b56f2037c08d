// What one vector of primary samples makes.
#pragma once

#include "core/inline_vector.h"
#include "sampling/light_class.h"

namespace keyhole {

/// An estimate of radiance at a window point.
struct Splat {
    Vec2 image;
    LightClass light;
    Rgb value; ///< [W/(m^2 sr)], window density 1
};

/// The splats of one sample, and the scalar that a chain samples in proportion to. Kelemen's "I"; deposits divide by
/// the same number.
class PathSample {
  public:
    double target() const { return target_; } ///< luminance of all splats; 0: a failed sample
    const auto& splats() const { return splats_; }
    bool broken() const { return broken_; } ///< a value was not a number and was left out
    /// In which of its thread's SubPathPair::scratch() a builder may leave the sub-paths. Swapped with the rest.
    std::size_t room() const { return room_; }
    void set_room(std::size_t room) { room_ = room; }

    void clear() {
        splats_.clear();
        target_ = 0;
        broken_ = false;
    }

    /// Adds to the splat of the same kind at the same place, if there is one.
    void add(const Vec2& image, LightClass light, const Rgb& value) {
        const double y = luminance(value);
        if (!std::isfinite(y) || !is_finite(value)) {
            broken_ = true;
            return;
        }
        if (!(y > 0)) return;
        target_ += y;
        for (Splat& s : splats_)
            if (s.light == light && s.image == image) {
                s.value += value;
                return;
            }
        splats_.push_back({image, light, value});
    }

  private:
    /// One place for the eye's sub-path with five kinds of light, and one for each joint with the eye itself.
    InlineVector<Splat, kMaxScatterings + 8> splats_;
    double target_ = 0;
    bool broken_ = false;
    std::size_t room_ = 0;
};

} // namespace keyhole
