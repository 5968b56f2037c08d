#include "scene/media/density_grid.h"

#include "core/error.h"

#include <Imath/ImathBoxAlgo.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

/// Steps of bisection between Newton's are never needed more often.
constexpr int kMostSteps = 64;
/// As far away as other geometry may be [m].
constexpr double kFarthest = 1e13;

} // namespace

DensityGrid::DensityGrid(Values values, const Imath::Box3d& box, const Imath::M44d& to_world)
    : values_(std::move(values)) {
    const auto [nx, ny, nz] = values_.size;
    const auto count = static_cast<double>(nx) * ny * nz;
    if (nx < 1 || ny < 1 || nz < 1 || count != static_cast<double>(values_.density.size()))
        throw InputError(
            fmt::format("found {} densities for a grid of {} x {} x {}", values_.density.size(), nx, ny, nz));
    const Imath::V3d extent = box.size();
    Imath::M44d from_unit, shift;
    from_unit.setScale(Imath::V3d(extent.x / nx, extent.y / ny, extent.z / nz));
    shift.setTranslation(Imath::V3d(0.5)); // values lie in the middle of cells
    Imath::M44d corner;
    corner.setTranslation(box.min);
    const Imath::M44d to_world_from_grid = shift * from_unit * corner * to_world;
    to_grid_ = to_world_from_grid.inverse();
    const bool has_volume = extent.x > 0 && extent.y > 0 && extent.z > 0 && std::isnormal(to_grid_.determinant()) &&
                            std::isnormal(to_world_from_grid.determinant());
    if (!has_volume) throw InputError("found a grid of densities without a volume, or of too large a one");
    const Imath::Box3d placed = Imath::transform(box, to_world);
    if (!(std::max(placed.min.length(), placed.max.length()) <= kFarthest))
        throw InputError("found a grid of densities that is too far away");
    bounds_ = {Vec3(placed.min), Vec3(placed.max)};
}

double DensityGrid::value(int x, int y, int z) const {
    const auto [nx, ny, nz] = values_.size;
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return 0;
    return values_.density[(static_cast<std::size_t>(z) * static_cast<std::size_t>(ny) + static_cast<std::size_t>(y)) *
                               static_cast<std::size_t>(nx) +
                           static_cast<std::size_t>(x)];
}

double DensityGrid::interpolated(const Place& p) const {
    Place low; // one off at most, by rounding
    for (int i = 0; i < 3; ++i)
        low[i] = std::floor(std::clamp(p[i], -1.0, static_cast<double>(values_.size[static_cast<std::size_t>(i)])));
    const Place d = p - low;
    const int x = static_cast<int>(low.x), y = static_cast<int>(low.y), z = static_cast<int>(low.z);
    // std::lerp() has care for infinities, which costs more than all else here.
    const auto between = [](double a, double b, double t) { return a + t * (b - a); };
    const auto row = [&](int j, int k) { return between(value(x, j, k), value(x + 1, j, k), d.x); };
    const auto layer = [&](int k) { return between(row(y, k), row(y + 1, k), d.y); };
    return between(layer(z), layer(z + 1), d.z);
}

double DensityGrid::density(const Vec3& p) const {
    Place at;
    to_grid_.multVecMatrix(Imath::V3d(p), at);
    for (int i = 0; i < 3; ++i)
        if (!(at[i] >= -0.5 && at[i] <= values_.size[static_cast<std::size_t>(i)] - 0.5)) return 0;
    return interpolated(at);
}

void DensityGrid::add_to(Hash& hash) const {
    hash.add(values_.size);
    hash.add(values_.density);
    hash.add(to_grid_);
}

DensityGrid::Ray DensityGrid::local(const Vec3& origin, const Vec3& w) const {
    Ray ray;
    to_grid_.multVecMatrix(Imath::V3d(origin), ray.origin);
    to_grid_.multDirMatrix(Imath::V3d(w), ray.w);
    return ray;
}

/// Simpson's rule is exact for cubics.
double DensityGrid::cubic_integral(const Ray& ray, double a, double b, double at_a, double at_b) const {
    return (b - a) / 6 * (at_a + 4 * interpolated(ray.at((a + b) / 2)) + at_b);
}

/// Calls f(a, b, density at a, density at b), which returns whether to go on, for the parts of the ray between planes
/// through values, in order.
template <class F> void DensityGrid::for_each_part(const Ray& ray, double t0, double t1, F&& f) const {
    constexpr double inf = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) { // the box
        const double low = -0.5, high = values_.size[static_cast<std::size_t>(i)] - 0.5, o = ray.origin[i],
                     w = ray.w[i];
        if (w == 0) {
            if (o < low || o > high) return;
            continue;
        }
        const auto [enter, leave] = std::minmax({(low - o) / w, (high - o) / w});
        t0 = std::max(t0, enter);
        t1 = std::min(t1, leave);
    }
    if (!(t0 < t1)) return;
    const Place start = ray.at(t0);
    double plane[3], next[3]; // by axis: that which comes next, and when
    for (int i = 0; i < 3; ++i) {
        plane[i] = ray.w[i] > 0 ? std::floor(start[i]) + 1 : std::ceil(start[i]) - 1;
        next[i] = ray.w[i] == 0 ? inf : (plane[i] - ray.origin[i]) / ray.w[i];
    }
    double a = t0, at_a = interpolated(start);
    while (a < t1) {
        const auto axis = std::min_element(next, next + 3) - next;
        const double b = std::clamp(next[axis], a, t1), at_b = interpolated(ray.at(b));
        if (b > a && !f(a, b, at_a, at_b)) return;
        a = b;
        at_a = at_b;
        plane[axis] += ray.w[static_cast<int>(axis)] > 0 ? 1 : -1;
        next[axis] = (plane[axis] - ray.origin[static_cast<int>(axis)]) / ray.w[static_cast<int>(axis)];
    }
}

double DensityGrid::integral(const Vec3& origin, const Vec3& w, double t0, double t1) const {
    const Ray ray = local(origin, w);
    double sum = 0;
    for_each_part(ray, t0, t1, [&](double a, double b, double at_a, double at_b) {
        sum += cubic_integral(ray, a, b, at_a, at_b);
        return true;
    });
    return sum;
}

std::optional<double> DensityGrid::reach(const Vec3& origin, const Vec3& w, double t0, double t1, double amount) const {
    const Ray ray = local(origin, w);
    std::optional<double> found;
    for_each_part(ray, t0, t1, [&](double a, double b, double at_a, double at_b) {
        const double whole = cubic_integral(ray, a, b, at_a, at_b);
        if (whole < amount) {
            amount -= whole;
            return true;
        }
        // The integral rises: Newton's method, kept between two bounds.
        double low = a, high = b, t = a + (b - a) * (whole > 0 ? amount / whole : 1);
        for (int i = 0; i < kMostSteps && low < high; ++i) {
            const double density = interpolated(ray.at(t)), over = cubic_integral(ray, a, t, at_a, density) - amount;
            (over < 0 ? low : high) = t;
            const double newton = density > 0 ? t - over / density : low;
            const double next = newton > low && newton < high ? newton : (low + high) / 2;
            if (std::abs(next - t) <= 1e-12 * (b - a)) break;
            t = next;
        }
        found = t;
        return false;
    });
    return found;
}

} // namespace keyhole
