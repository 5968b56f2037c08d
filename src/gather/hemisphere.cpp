#include "gather/hemisphere.h"

#include "scene/warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace keyhole {
namespace {

/// sum += v times each channel.
void add(RgbGradient& sum, const Rgb& c, const Vec3& v) {
    sum[0] += v * static_cast<float>(c.x);
    sum[1] += v * static_cast<float>(c.y);
    sum[2] += v * static_cast<float>(c.z);
}

double square(double x) { return x * x; }

Vec2 direction_at(double azimuth) {
    return {static_cast<float>(std::cos(azimuth)), static_cast<float>(std::sin(azimuth))};
}

/// Vector of the tangent plane.
Vec3 tangent(const Frame& frame, const Vec2& v) { return frame.s * v.x + frame.t * v.y; }

} // namespace

HemisphereGrid::HemisphereGrid(int rays)
    : rows_(std::max(2, static_cast<int>(std::lround(std::sqrt(rays / kPi))))),
      columns_(std::max(4, static_cast<int>(std::lround(static_cast<double>(rays) / rows_)))) {
    for (int row = 0; row < rows_; ++row) mean_tangents_.push_back(mean_tangent(row));
    const double width = 2 * kPi / columns_;
    for (int k = 0; k < columns_; ++k) azimuths_.push_back({direction_at(width * (k + 0.5)), direction_at(width * k)});
}

Vec3 HemisphereGrid::direction(int cell, double u0, double u1) const {
    const int row = cell / columns_;
    const double sin2 = (row + u0) / rows_;
    return spherical(std::sqrt(1 - sin2), 2 * kPi * (cell % columns_ + u1) / columns_);
}

/// Of the polar angle over a row's cells: that of single directions has infinite variance at the horizon.
double HemisphereGrid::mean_tangent(int row) const {
    const auto integral = [](double sin2) { return std::asin(std::sqrt(sin2)) - std::sqrt(sin2 * (1 - sin2)); };
    return rows_ * (integral(static_cast<double>(row + 1) / rows_) - integral(static_cast<double>(row) / rows_));
}

HemisphereEstimate HemisphereGrid::estimate(std::span<const HemisphereRay> rays, const Frame& frame) const {
    assert(rays.size() == static_cast<std::size_t>(size()));
    HemisphereEstimate e;
    double inverse_distance = 0, unlike = 0;
    std::vector<double> before; // luminance of the last column's, which is the first one's neighbour
    before.reserve(static_cast<std::size_t>(rows_));
    for (int j = 0; j < rows_; ++j)
        before.push_back(luminance(rays[static_cast<std::size_t>((j + 1) * columns_ - 1)].radiance));
    for (int k = 0; k < columns_; ++k) {
        Rgb turned(0.0);
        for (int j = 0; j < rows_; ++j) {
            const HemisphereRay& ray = rays[static_cast<std::size_t>(j * columns_ + k)];
            e.irradiance += ray.radiance;
            const double y = luminance(ray.radiance);
            unlike += square(y - before[static_cast<std::size_t>(j)]);
            before[static_cast<std::size_t>(j)] = y;
            turned += ray.radiance * mean_tangents_[static_cast<std::size_t>(j)];
            if (ray.distance > 0) inverse_distance += 1 / static_cast<double>(ray.distance);
        }
        add(e.rotation, turned, tangent(frame, azimuths_[static_cast<std::size_t>(k)].middle));
    }
    const double share = kPi / size();
    e.irradiance *= share;
    e.variance = unlike / 2 * square(share);
    for (Vec3& v : e.rotation) v *= static_cast<float>(share);
    add_translation(rays, frame, e.translation);
    e.distance = size() / inverse_distance;
    return e;
}

/// Ward and Heckbert's sum over the borders between cells: as the point moves, each border moves past it by the angle
/// that its distance gives, and what one cell gains the other loses.
void HemisphereGrid::add_translation(std::span<const HemisphereRay> rays, const Frame& frame, RgbGradient& sum) const {
    const auto at = [&](int row, int column) -> const HemisphereRay& {
        return rays[static_cast<std::size_t>(row * columns_ + column)];
    };
    const auto cross = [&](const HemisphereRay& a, const HemisphereRay& b, double length, const Vec3& towards) {
        add(sum, (b.radiance - a.radiance) * (length / std::min(a.distance, b.distance)), towards);
    };
    const double width = 2 * kPi / columns_;
    for (int k = 0; k < columns_; ++k) {
        const int before = (k + columns_ - 1) % columns_;
        const Azimuths& azimuths = azimuths_[static_cast<std::size_t>(k)];
        const Vec3 u = tangent(frame, azimuths.middle), v = tangent(frame, {-azimuths.border.y, azimuths.border.x});
        for (int j = 0; j < rows_; ++j) {
            const double inner2 = static_cast<double>(j) / rows_, outer2 = static_cast<double>(j + 1) / rows_;
            if (j > 0) cross(at(j - 1, k), at(j, k), width * std::sqrt(inner2) * (1 - inner2), u);
            cross(at(j, before), at(j, k), std::sqrt(outer2) - std::sqrt(inner2), v);
        }
    }
}

} // namespace keyhole
