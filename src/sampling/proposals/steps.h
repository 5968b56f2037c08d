// Small steps in the image and in direction, with their densities.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "scene/warp.h"

#include <algorithm>

namespace keyhole {

/// Radius log-uniform between two bounds, angle uniform: small features and large ones are explored alike (Kelemen et
/// al. 2002, section 3; Veach 1997, section 11.3.1).
class LogUniformRadius {
  public:
    constexpr LogUniformRadius(double least, double most) : least_(least), most_(most) {}

    double sample(double u) const { return least_ * std::pow(most_ / least_, u); }
    /// Per unit of radius. Radii are measured again from positions, which are floats: what lies a little outside the
    /// bounds was drawn inside them, and at 0, too. The density is the same both ways, so this slack cancels in an
    /// acceptance.
    double density(double r) const {
        if (!(r <= most_ * 1.02)) return 0;
        return 1 / (measured(r) * std::log(most_ / least_));
    }
    /// What a measured radius counts as.
    double measured(double r) const { return std::max(r, least_); }

  private:
    double least_, most_;
};

/// A step in the image, in pixels.
class ImageStep {
  public:
    constexpr ImageStep(double least, double most) : radius_(least, most) {}

    Vec2 sample(SampleSource& source) const {
        const double r = radius_.sample(source.next()), phi = 2 * kPi * source.next();
        return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi))};
    }
    /// Per square pixel.
    double density(const Vec2& step) const {
        const double r = std::hypot(step.x, step.y);
        return radius_.density(r) / (2 * kPi * radius_.measured(r));
    }

  private:
    LogUniformRadius radius_;
};

/// A step from one direction to another, by its angle [rad].
class DirectionStep {
  public:
    constexpr DirectionStep(double least, double most) : angle_(least, most) {}

    Vec3 sample(const Vec3& from, SampleSource& source) const {
        const double theta = angle_.sample(source.next()), phi = 2 * kPi * source.next();
        const double s = std::sin(theta);
        const Vec3 local(static_cast<float>(s * std::cos(phi)), static_cast<float>(s * std::sin(phi)),
                         static_cast<float>(std::cos(theta)));
        return Frame(from).to_world(local).normalized();
    }
    /// Per solid angle.
    double density(const Vec3& from, const Vec3& to) const {
        const double chord = Imath::V3d(to - from).length();
        const double theta = 2 * std::asin(std::min(1.0, chord / 2));
        return angle_.density(theta) / (2 * kPi * std::sin(angle_.measured(theta)));
    }

  private:
    LogUniformRadius angle_;
};

/// Directions within a fixed angle of an axis, uniform in the cone.
class Cone {
  public:
    /// @param half_angle in (0, pi] [rad]
    explicit Cone(double half_angle) : half_angle_(half_angle), cosine_(std::cos(half_angle)) {}

    Vec3 sample(const Vec3& axis, SampleSource& source) const {
        const double u0 = source.next(), u1 = source.next();
        return Frame(axis).to_world(uniform_cone(u0, u1, cosine_)).normalized();
    }
    /// Per solid angle: 1 / (2 pi (1 - cos)), and 0 outside.
    double density(const Vec3& axis, const Vec3& w) const {
        const double chord = Imath::V3d(w - axis).length();
        if (!(2 * std::asin(std::min(1.0, chord / 2)) <= half_angle_)) return 0;
        const double s = std::sin(half_angle_ / 2); // 1 - cos of a small angle would cancel
        return 1 / (4 * kPi * s * s);
    }

  private:
    double half_angle_, cosine_;
};

/// A step across a beam of parallel light, as a share of the radius of the scene.
class BeamStep {
  public:
    constexpr BeamStep(double least, double most) : radius_(least, most) {}

    /// Displacement in the plane across `w`.
    Vec3 sample(const Vec3& w, double scene_radius, SampleSource& source) const {
        const double r = radius_.sample(source.next()) * scene_radius, phi = 2 * kPi * source.next();
        return Frame(w).to_world(Vec3(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), 0));
    }
    /// Per area of the beam's cross-section. What `displacement` has along `w` doesn't count.
    double density(const Vec3& displacement, const Vec3& w, double scene_radius) const {
        const Imath::V3d d(displacement), axis(w);
        const double r = (d - axis * d.dot(axis)).length() / scene_radius;
        return radius_.density(r) / (2 * kPi * radius_.measured(r) * scene_radius * scene_radius);
    }

  private:
    LogUniformRadius radius_;
};

} // namespace keyhole
