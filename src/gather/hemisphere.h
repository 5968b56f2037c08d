// Irradiance and its gradients from a stratified hemisphere of rays (Ward and Heckbert 1992, "Irradiance Gradients").
#pragma once

#include "photonmap/photon.h"

#include <array>
#include <span>
#include <vector>

namespace keyhole {

/// What one ray of a hemisphere brings.
struct HemisphereRay {
    Rgb radiance{0.0};  ///< [W/(m^2 sr)]
    float distance = 0; ///< to what it hit [m]; infinite if nothing
};

/// Three vectors, one for each channel.
using RgbGradient = std::array<Vec3, 3>;
inline const RgbGradient kNoGradient{Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};

/// Irradiance about a point. Gradients lie in the tangent plane, in world space.
struct HemisphereEstimate {
    Rgb irradiance{0.0}; ///< [W/m^2]
    RgbGradient rotation =
        kNoGradient; ///< derivative with respect to the normal [W/m^2]: E(n') ~ E + rotation . (n' - n)
    RgbGradient translation = kNoGradient; ///< derivative with respect to the position [W/m^3]
    double distance = 0;                   ///< harmonic mean of the rays' [m]; infinite if nothing was hit
    double variance = 0;                   ///< of the irradiance's luminance, at most [(W/m^2)^2]
    LongerWays reaching{1, 1, 1, 1};       ///< shares of `irradiance`; whoever has the rays tells
};

/// The cells of a hemisphere: `rows` polar angles times `columns` azimuths, each with the same share of the cosine.
class HemisphereGrid {
  public:
    /// About `rays` cells, 8 at least, whose two sides are alike.
    explicit HemisphereGrid(int rays);

    int rows() const { return rows_; }
    int columns() const { return columns_; }
    /// Number of cells; cell i lies in row i / columns().
    int size() const { return rows_ * columns_; }

    /// The direction at (u0, u1) in [0,1)^2 of a cell, around +z: density cos / pi over the whole, per solid angle.
    Vec3 direction(int cell, double u0, double u1) const;

    /// `rays` has size() entries, one drawn in each cell of `frame`. Between cells light is taken to change at their
    /// borders, at the distance of the nearer of the two. The variance is told from how unlike neighbours are: cells
    /// that share one radiance have none.
    HemisphereEstimate estimate(std::span<const HemisphereRay> rays, const Frame& frame) const;

  private:
    double mean_tangent(int row) const;
    void add_translation(std::span<const HemisphereRay> rays, const Frame& frame, RgbGradient& sum) const;

    /// Unit vectors in the plane.
    struct Azimuths {
        Vec2 middle, border; ///< of a column, and between it and the one before
    };

    int rows_, columns_;
    std::vector<double> mean_tangents_; // by row
    std::vector<Azimuths> azimuths_;    // by column
};

} // namespace keyhole
