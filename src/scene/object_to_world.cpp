#include "scene/object_to_world.h"

#include <array>
#include <cmath>

namespace keyhole {
namespace {

using Imath::V3d;

/// Half a dozen roundings of a float, one after the other: each of the origin, of the inverse of the matrix, which
/// Embree makes of it, and of its determinant.
constexpr double kRoundings = 5e-7;
/// Rounding that is larger, relative to coordinates, would move rays visibly off surfaces.
constexpr float kMostRounding = 3e-5f;

/// What rounding in a cross product is relative to.
V3d size_of_cross(const V3d& a, const V3d& b) {
    return {a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
}

/// With A for sizes of the elements of a matrix, and the inverse as the adjugate over the determinant: rounding of what
/// goes to the object and back is relative to A(M) A(adj M) / |det M|, where sums are of sizes.
Imath::M33f rounding_of(const Imath::M44d& m) {
    const std::array row{absolute(row_of(m, 0)), absolute(row_of(m, 1)), absolute(row_of(m, 2))};
    const std::array adjugate{size_of_cross(row[1], row[2]), size_of_cross(row[2], row[0]),
                              size_of_cross(row[0], row[1])};
    const double det = std::abs(linear_determinant(m)), cancelled = row[0].dot(adjugate[0]) / det;
    Imath::M33f rounding;
    for (int from = 0; from < 3; ++from)
        for (int to = 0; to < 3; ++to) {
            double sum = 0;
            for (std::size_t i = 0; i < 3; ++i) sum += adjugate[i][from] / det * row[i][to];
            rounding[from][to] = static_cast<float>(kRoundings * (1 + cancelled) * sum);
        }
    return rounding;
}

} // namespace

ObjectToWorld::ObjectToWorld(const Imath::M44d& matrix)
    : matrix_(matrix), rounding_(rounding_of(matrix)), origin_(absolute(matrix.translation())) {
    const Imath::M44d covectors = matrix.inverse().transposed();
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) covectors_[i][k] = covectors[i][k];
    mirrored_ = linear_determinant(matrix) < 0;
}

float ObjectToWorld::rounding_along(const Vec3& n, const Vec3& size) const {
    return absolute(n).dot((size + origin_) * rounding_);
}

float ObjectToWorld::relative_rounding() const {
    float sum = 0;
    for (int from = 0; from < 3; ++from)
        for (int to = 0; to < 3; ++to) sum += rounding_[from][to] * rounding_[from][to];
    return std::sqrt(sum);
}

bool ObjectToWorld::rounds_little() const { return relative_rounding() <= kMostRounding; } // not of what is no number

} // namespace keyhole
