// Emitters that shine from one point.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

/// What such emitters have in common: their light leaves `position`, which is no surface, and no ray meets it.
class EmitterAtAPoint : public Emitter {
  public:
    Site site() const final { return Site::point; }
    bool is_delta() const final { return true; }
    EmitterPoint sample_point(SampleSource& /*source*/) const final {
        SurfacePoint point;
        point.p = position_;
        point.site = Site::point;
        return {point, 1.0};
    }
    double point_pdf(const SurfacePoint& /*point*/) const final { return 1; }

  protected:
    /// World space [m].
    explicit EmitterAtAPoint(const Vec3& position) : position_(position) {}
    const Vec3& position() const { return position_; }

  private:
    Vec3 position_;
};

} // namespace keyhole
