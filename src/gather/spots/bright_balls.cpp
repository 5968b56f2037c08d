#include "gather/spots/bright_balls.h"

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr double kBright = 3;         // square of what a bright ray brings over the mean of all
constexpr std::size_t kFew = 4;       // fewer bright rays may have come from anywhere
constexpr double kLeastShare = 0.002; // of the second moment of what rays bring
constexpr double kContrast = 10;      // that share over the one of all directions that a ball fills
constexpr double kGain = 0.8;         // deviation that balls for either part leave over that of one for all, at most
constexpr double kSmallest = 0.002;   // radius over the distance of what rays meet
constexpr int kDepth = 12;            // divisions on top of each other

/// Of a ball about so many samples, over the distance of the farthest: others would be met farther out.
float margin(std::size_t samples) { return 1 + static_cast<float>(kFew) / static_cast<float>(samples); }

/// What is left of samples.
struct Left {
    double aimed = 0; ///< sum of the standard deviations of those in balls, up to a factor
    double rest2 = 0; ///< second moment of the others

    /// Of a mean of rays that are shared out as is best.
    double deviation() const { return aimed + std::sqrt(rest2); }
};
Left operator+(const Left& a, const Left& b) { return {a.aimed + b.aimed, a.rest2 + b.rest2}; }

double square(const RadianceSample& f) { return f.radiance * f.radiance; }

double moment2(std::span<const RadianceSample> samples) {
    double sum = 0;
    for (const RadianceSample& f : samples) sum += square(f);
    return sum;
}

void sort_along(int axis, std::span<RadianceSample> samples) {
    std::ranges::stable_sort(samples, {}, [axis](const RadianceSample& f) { return f.place[axis]; });
}

/// Where half of the second moment lies on either side, along each axis.
Vec3 median(std::span<RadianceSample> samples) {
    const double half = moment2(samples) / 2;
    Vec3 middle(0);
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(axis, samples);
        double before = 0;
        for (const RadianceSample& f : samples) {
            middle[axis] = f.place[axis];
            if ((before += square(f)) >= half) break;
        }
    }
    return middle;
}

Vec3 mean(std::span<const RadianceSample> samples) {
    Vec3 sum(0);
    const double all = moment2(samples);
    for (const RadianceSample& f : samples) sum += f.place * static_cast<float>(square(f) / all);
    return sum;
}

/// A ball around some of the samples.
struct Ball {
    Vec3 centre{0, 0, 0};
    float radius = 0;
    std::size_t inside = 0; ///< that many of the samples, which come first
};

/// Distance of what rays meet, as a rule. What is bright is met from nearby above all, where it fills many directions
/// and makes little noise; far off it is dim, and all the noise that there is.
double typical_distance(std::span<const RadianceSample> samples) {
    std::vector<float> distances;
    for (const RadianceSample& f : samples)
        if (f.distance > 0) distances.push_back(f.distance);
    if (distances.empty()) return 1;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::ranges::nth_element(distances, middle);
    return static_cast<double>(*middle);
}

/// Sorts samples so that the two parts are as compact as can be, and returns the size of the first.
std::size_t split(std::span<RadianceSample> samples) {
    /// The second moment times the variance of places.
    struct Sums {
        double all = 0, of_squares = 0;
        Imath::V3d of_places{0, 0, 0};
        void add(const RadianceSample& f) {
            const Imath::V3d place(f.place);
            all += square(f);
            of_places += place * square(f);
            of_squares += place.length2() * square(f);
        }
        double size() const { return all > 0 ? std::max(0.0, of_squares - of_places.length2() / all) : 0; }
    };
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = kFew;
    int best_axis = 0;
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(axis, samples);
        std::vector<double> before;
        Sums sums;
        for (const RadianceSample& f : samples) {
            before.push_back(sums.size());
            sums.add(f);
        }
        sums = {};
        for (std::size_t i = samples.size() - 1; i >= kFew; --i) {
            sums.add(samples[i]);
            if (samples.size() - i >= kFew && before[i] + sums.size() < least) {
                least = before[i] + sums.size();
                best = i;
                best_axis = axis;
            }
        }
    }
    sort_along(best_axis, samples);
    return best;
}

class Division {
  public:
    Division(double whole2, double distance) : whole2_(whole2), distance_(distance) {}

    /// Adds balls for samples, which are sorted anew, and returns what these leave of them.
    Left divide(std::span<RadianceSample> samples, int depth, std::vector<BrightBall>& balls) const {
        const double all = moment2(samples);
        if (samples.size() < kFew || all < kLeastShare * whole2_) return {0, all};
        Ball one = best_ball(samples, median(samples));
        one = best_ball(samples, mean(samples.first(one.inside)));
        const double inside = moment2(samples.first(one.inside)), share = inside / whole2_;
        const bool stands_out = share > kLeastShare && kContrast * filled(one.radius) <= share;
        const Left by_one = stands_out ? left_by(one, inside, all) : Left{0, all};
        if (depth < kDepth && samples.size() >= 2 * kFew) {
            std::vector<BrightBall> parts;
            const std::size_t first = split(samples);
            // One after the other: both add to the parts.
            const Left by_first = divide(samples.first(first), depth + 1, parts);
            const Left by_two = by_first + divide(samples.subspan(first), depth + 1, parts);
            if (by_two.deviation() < kGain * by_one.deviation()) {
                balls.insert(balls.end(), parts.begin(), parts.end());
                return by_two;
            }
        }
        if (stands_out) balls.push_back({one.centre, one.radius, share});
        return by_one;
    }

  private:
    /// Share of all directions that a ball fills.
    double filled(float radius) const {
        return std::min(1.0, static_cast<double>(radius * radius) / (2 * distance_ * distance_));
    }
    Left left_by(const Ball& ball, double inside2, double all2) const {
        return {std::sqrt(inside2 * filled(ball.radius)), std::max(0.0, all2 - inside2)};
    }
    /// The ball about a centre that leaves the least. Sorts the samples by their distance from there.
    Ball best_ball(std::span<RadianceSample> samples, const Vec3& centre) const {
        std::ranges::stable_sort(samples, {}, [&](const RadianceSample& f) { return (f.place - centre).length2(); });
        const double all = moment2(samples);
        double inside = 0, least = std::numeric_limits<double>::infinity();
        Ball best;
        for (std::size_t n = 1; n <= samples.size(); ++n) {
            const RadianceSample& farthest = samples[n - 1];
            inside += square(farthest);
            if (n < kFew) continue;
            const float reach = margin(n) * (farthest.place - centre).length();
            const Ball ball{centre, std::max(reach, static_cast<float>(kSmallest * distance_)), n};
            const double left = left_by(ball, inside, all).deviation();
            if (left < least) {
                least = left;
                best = ball;
            }
        }
        return best;
    }

    double whole2_;
    double distance_; // typical_distance()
};

} // namespace

BrightBalls find_bright_balls(std::span<const RadianceSample> samples) {
    BrightBalls found;
    const double whole2 = moment2(samples);
    if (!(whole2 > 0)) return found;
    std::vector<RadianceSample> bright;
    for (const RadianceSample& f : samples)
        if (square(f) > kBright * whole2 / static_cast<double>(samples.size())) bright.push_back(f);
    const double dim2 = std::max(0.0, whole2 - moment2(bright));
    const double left =
        (Division(whole2, typical_distance(samples)).divide(bright, 0, found.balls) + Left{0, dim2}).deviation();
    found.left = std::min(1.0, left * left / whole2);
    std::ranges::stable_sort(found.balls, std::ranges::greater{}, &BrightBall::share);
    return found;
}

} // namespace keyhole
