#include "gather/irradiance_cache.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace keyhole {
namespace {

/// Share of a record's radius below which that of another one tells of something that the first doesn't see.
constexpr float kMuchFiner = 0.6f;
/// Records whose normals differ by more than this (1 - cos) have no say: about 20 degrees.
constexpr float kNormalReach = 0.06f;
/// How much more a distance along the normal counts than one across it, squared: steps and shelves keep to themselves.
/// Along the normal a record is used no farther than it keeps others away.
constexpr float kHeight2 = 16;

/// Light that is fainter than this part of the mean counts as if it weren't: it doesn't show.
constexpr double kDark = 0.1;
/// Of its lower bound, how far a record is used at least where a wall ends it.
constexpr float kLeastOfBound = 1e-3f;

Rgb to_rgb(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 to_vec(const Rgb& c) { return {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)}; }

float luminance_of(const Vec3& c) { return c.dot(Vec3(0.2126f, 0.7152f, 0.0722f)); }

/// A record is found by new ones whose reach is up to so many times, as a power of two, that of its own.
constexpr int kLevelsOfStanding = 10;

/// The level whose cells are about as wide as a record's radius of use, so that each record overlaps 8 to 27 of them:
/// larger cells would offer more records in vain.
int level_of(float reach) { return static_cast<int>(std::ceil(std::log2(reach))); }

struct CellIndex {
    std::int64_t x, y, z;
};

/// 2^e for -126 <= e < 128, without the call that std::ldexp() is: lookups ask for it at each level.
float power_of_two(int e) { return std::bit_cast<float>(static_cast<std::uint32_t>(127 + e) << 23); }

CellIndex cell_at(const Vec3& p, int level) {
    const float scale = power_of_two(-level);
    const auto floor = [&](float v) { return static_cast<std::int64_t>(std::floor(v * scale)); };
    return {floor(p.x), floor(p.y), floor(p.z)};
}

/// 19 bits an axis and 7 for the level. Cells further apart than that share a key, which costs time only.
std::uint64_t key(const CellIndex& c, int level) {
    const auto bits = [](std::int64_t v) { return static_cast<std::uint64_t>(v) & 0x7FFFF; };
    return bits(c.x) | bits(c.y) << 19 | bits(c.z) << 38 | (static_cast<std::uint64_t>(level) & 0x7F) << 57;
}

/// Calls visit(cell) for the cells of a level that the box of half width `reach` around `p` overlaps.
template <class Visit> void for_cells(const Vec3& p, float reach, int level, const Visit& visit) {
    const CellIndex lo = cell_at(p - Vec3(reach), level), hi = cell_at(p + Vec3(reach), level);
    for (auto x = lo.x; x <= hi.x; ++x)
        for (auto y = lo.y; y <= hi.y; ++y)
            for (auto z = lo.z; z <= hi.z; ++z) visit(CellIndex{x, y, z});
}

/// Falls from 1 at 0 to 0 at 1, smoothly at both, so that no border of a record shows.
float kernel(float x2) { return x2 < 1 ? (1 - x2) * (1 - x2) : 0.0f; }

} // namespace

template <class Visit> void IrradianceCache::visit_near(const Vec3& position, Visit&& visit) const {
    for (int level = lowest_level_; level <= highest_level_; ++level) {
        const auto cell = cells_.find(key(cell_at(position, level), level));
        if (cell == cells_.end()) continue;
        for (const std::uint32_t i : cell->second) visit(i);
    }
}

float IrradianceCache::weight_of(const Stored& r, float as_far, const Vec3& d, const Vec3& normal) {
    const float height = d.dot(r.normal), height2 = height * height;
    const float apart2 = (d.length2() - height2) / (as_far * as_far) + kHeight2 * height2 / (r.radius * r.radius);
    if (!(apart2 < 1) || d.dot(r.wall.normal) > r.wall.distance) return 0;
    // What lies behind the record may be in the dark behind an edge.
    if (d.dot(normal + r.normal) < -0.1f * r.radius) return 0;
    const float turned = (normal - r.normal).length2() / (2 * kNormalReach);
    return kernel(std::max(apart2, turned));
}

template <class Visit> void IrradianceCache::visit_standing(const Vec3& position, float reach, Visit&& visit) const {
    const int level = level_of(reach);
    for_cells(position, reach, level, [&](const CellIndex& c) {
        const auto cell = standing_.find(key(c, level));
        if (cell == standing_.end()) return;
        for (const std::uint32_t i : cell->second) visit(i);
    });
}

IrradianceCache::Answer IrradianceCache::irradiance(const Vec3& position, const Vec3& normal, int longer) const {
    Vec3 sum(0.0f);
    float weights = 0, variance = 0;
    visit_near(position, [&](std::uint32_t i) {
        const Stored& r = records_[i];
        const Vec3 d = position - r.position;
        const float w = weight_of(r, r.reach, d, normal);
        if (!(w > 0)) return;
        sum += irradiance_at(r, d, normal - r.normal) * (longer > 0 ? w * by_way(r.reaching, longer) : w);
        weights += w;
        variance += w * w * r.variance;
    });
    if (!(weights > 0)) return {};
    sum /= weights;
    return {Rgb(sum.x, sum.y, sum.z), std::sqrt(variance) / weights, true};
}

bool IrradianceCache::covers(const Vec3& position, const Vec3& normal, float share,
                             const std::function<bool(const Vec3& record)>& sees) const {
    float covered = 0;
    visit_near(position, [&](std::uint32_t i) {
        if (covered >= share) return;
        const Stored& r = records_[i];
        const float w = weight_of(r, r.radius, position - r.position, normal);
        if (w > 0 && sees(r.position)) covered += w;
    });
    return covered >= share;
}

/// What `r` predicts at an offset `to` from it, where normals are turned by `turn`.
Vec3 IrradianceCache::irradiance_at(const Stored& r, const Vec3& to, const Vec3& turn) {
    Vec3 e = r.irradiance;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        e[c] = std::max(0.0f, e[c] + r.rotation[k].dot(turn) + r.translation[k].dot(to));
    }
    return e;
}

void IrradianceCache::insert(const IrradianceRecord& record, const WallBetween& wall) {
    const HemisphereEstimate& e = record.light;
    Stored r{.position = record.position,
             .normal = record.normal,
             .irradiance = to_vec(e.irradiance),
             .rotation = e.rotation,
             .translation = e.translation,
             .variance = static_cast<float>(e.variance),
             .variance_by_all = static_cast<float>(e.variance),
             .around = static_cast<float>(std::min(e.distance, 1e30)),
             .distance = static_cast<float>(std::min(e.distance, 1e30)),
             .wall = {},
             .min_radius = record.min_radius,
             .max_radius = record.max_radius,
             .min_radius_by_light = record.min_radius_by_light,
             .reaching = e.reaching};
    // Where irradiance changes by its own size within that distance, first order says nothing beyond (Ward, Heckbert).
    const float y = static_cast<float>(luminance(e.irradiance));
    const Vec3 slope = r.translation[0] * 0.2126f + r.translation[1] * 0.7152f + r.translation[2] * 0.0722f;
    if (y < slope.length() * r.distance) r.distance = y / slope.length();
    update_radius(r);
    clamp_with_neighbours(r);
    // A radius held up by its lower bound would stretch the gradient beyond where it holds.
    r.held = std::min(1.0f, error_ * r.distance / r.radius);
    for (Vec3& g : r.translation) g *= r.held;
    end_where_wrong(r, wall);
    records_.push_back(r);
    index(static_cast<std::uint32_t>(records_.size() - 1));
}

struct IrradianceCache::Sums {
    double variance = 0, light = 0, light2 = 0, count = 0;

    void add(const Stored& r) {
        const double y = luminance_of(r.irradiance);
        variance += r.variance;
        light += y;
        light2 += y * y;
        ++count;
    }
    /// Standard error over the light, as a whole, which is taken to be `dark` in each at least.
    double noise(double dark) const {
        const double least2 = light2 + count * dark * dark;
        return least2 > 0 ? std::sqrt(variance / least2) : 0.0;
    }
};

IrradianceCache::Sums IrradianceCache::sum_of_all() const {
    Sums all;
    for (const Stored& r : records_) all.add(r);
    return all;
}

double IrradianceCache::noise() const { return sum_of_all().noise(0); }

std::vector<double> IrradianceCache::relative_noise() const {
    const Sums all = sum_of_all();
    const double dark = all.count > 0 ? kDark * all.light / all.count : 0;
    std::vector<double> found;
    found.reserve(records_.size());
    for (const Stored& r : records_) {
        Sums around;
        visit_near(r.position, [&](std::uint32_t i) {
            const Stored& other = records_[i];
            const bool near = (other.position - r.position).length2() < other.reach * other.reach;
            if (&other != &r && near && (other.normal - r.normal).length2() < 2 * kNormalReach) around.add(other);
        });
        found.push_back((around.count > 0 ? around : all).noise(dark));
    }
    return found;
}

void IrradianceCache::refine(std::size_t i, const HemisphereEstimate& more, double share) {
    Stored& r = records_[i];
    const auto s = static_cast<float>(share);
    const auto before = (1 - s) * static_cast<float>(luminance(to_rgb(r.irradiance)));
    const auto added = s * static_cast<float>(luminance(more.irradiance));
    if (before + added > 0)
        for (std::size_t k = 0; k < r.reaching.size(); ++k)
            r.reaching[k] = (before * r.reaching[k] + added * more.reaching[k]) / (before + added);
    r.irradiance += (to_vec(more.irradiance) - r.irradiance) * s;
    r.variance_by_all = (1 - s) * (1 - s) * r.variance_by_all + s * s * static_cast<float>(more.variance);
    for (std::size_t c = 0; c < 3; ++c) {
        r.rotation[c] += (more.rotation[c] - r.rotation[c]) * s;
        r.translation[c] += (more.translation[c] * r.held - r.translation[c]) * s;
    }
}

std::vector<IrradianceCache::Prediction> IrradianceCache::others_at(std::uint32_t i) const {
    const Stored& here = records_[i];
    std::vector<Prediction> found;
    visit_near(here.position, [&](std::uint32_t k) {
        if (k == i) return;
        const Stored& r = records_[k];
        const Vec3 d = here.position - r.position;
        const float weight = weight_of(r, r.reach, d, here.normal);
        if (!(weight > 0)) return;
        const Vec3 e = irradiance_at(r, d, here.normal - r.normal);
        found.push_back({k, weight, Rgb(e.x, e.y, e.z)});
    });
    return found;
}

void IrradianceCache::change(std::uint32_t i, const Rgb& change) {
    Stored& r = records_[i];
    const float before = luminance_of(r.irradiance);
    for (int c = 0; c < 3; ++c) r.irradiance[c] = std::max(0.0f, r.irradiance[c] + static_cast<float>(change[c]));
    if (!(before > 0)) return;
    const float scale = luminance_of(r.irradiance) / before;
    for (Vec3& g : r.rotation) g *= scale;
    for (Vec3& g : r.translation) g *= scale;
}

void IrradianceCache::update_radius(Stored& r) const {
    const float least = std::max(r.min_radius, std::min(error_ * r.around, r.min_radius_by_light));
    const float radius = error_ * r.distance;
    r.radius = std::clamp(radius, least, r.max_radius);
    // Not so where the lower bound decides: things are smaller there than the bound is.
    r.reach = std::clamp(overlap_ * radius, least, overlap_ * r.max_radius);
    r.reach = std::min({r.reach, std::max(r.radius, r.border), r.other_wall});
    r.radius = std::min(r.radius, r.other_wall);
}

void IrradianceCache::clamp_with_neighbours(Stored& r) {
    visit_near(r.position, [&](std::uint32_t i) {
        const Stored& other = records_[i];
        const float apart = (other.position - r.position).length();
        r.distance = std::min(r.distance, other.distance + apart);
        r.around = std::min(r.around, other.around + apart);
    });
    update_radius(r);
    visit_near(r.position, [&](std::uint32_t i) {
        Stored& other = records_[i];
        const float apart = (other.position - r.position).length();
        other.distance = std::min(other.distance, r.distance + apart);
        other.around = std::min(other.around, r.around + apart);
        update_radius(other);
        // Where light changes over a shorter distance than a record knows of, it ends.
        if (r.radius < kMuchFiner * other.radius) other.border = std::min(other.border, apart);
        if (other.radius < kMuchFiner * r.radius) r.border = std::min(r.border, apart);
        update_radius(other);
    });
    update_radius(r);
}

void IrradianceCache::end_where_wrong(Stored& r, const WallBetween& wall) {
    visit_near(r.position, [&](std::uint32_t i) {
        Stored& other = records_[i];
        if (!((r.position - other.position).length() < std::max(r.reach, other.reach))) return;
        const float good = good_between(r, other, std::max(wrong_at(other, r), wrong_at(r, other)));
        if (good == std::numeric_limits<float>::infinity()) return;
        for (Stored* s : {&r, &other}) end_at(*s, good);
        end_at_wall(r, other, wall);
        end_at_wall(other, r, wall);
    });
    // Those that don't reach as far as here have no say here, and this one may have none there.
    visit_standing(r.position, r.reach, [&](std::uint32_t i) {
        const Stored& other = records_[i];
        if (!((other.position - r.position).length() < r.reach)) return;
        const float good = good_between(r, other, wrong_at(r, other));
        if (good == std::numeric_limits<float>::infinity()) return;
        end_at(r, good);
        end_at_wall(r, other, wall);
    });
}

/// What a wall hides from a record is not served by it. One wall is known as a plane, so that the record goes on beside
/// it; others end it all around.
void IrradianceCache::end_at_wall(Stored& r, const Stored& other, const WallBetween& wall) const {
    const Vec3 to = other.position - r.position;
    if (!wall || to.dot(r.wall.normal) > r.wall.distance) return;
    const auto found = wall(r.position, r.normal, other.position);
    if (!found) return;
    if (r.wall.normal == Vec3(0, 0, 0)) {
        r.wall = *found;
        return;
    }
    r.other_wall = std::min(r.other_wall, std::max(found->distance, kLeastOfBound * r.min_radius));
    update_radius(r);
}

/// By how much the luminance that `r` predicts at another record is wrong; 0 where it predicts nothing.
float IrradianceCache::wrong_at(const Stored& r, const Stored& other) {
    const Vec3 turn = other.normal - r.normal;
    if (turn.length2() > 2 * kNormalReach) return 0;
    return std::abs(luminance_of(irradiance_at(r, other.position - r.position, turn)) - luminance_of(other.irradiance));
}

/// How far two records are good for where one predicts the other with an error: all of the way where that may be noise.
float IrradianceCache::good_between(const Stored& a, const Stored& b, float wrong) const {
    const float allowed = doubt_ * error_ * std::max(luminance_of(a.irradiance), luminance_of(b.irradiance));
    const float noise2 = 4 * (a.variance + b.variance);
    if (!(wrong * wrong > allowed * allowed + noise2)) return std::numeric_limits<float>::infinity();
    // What first order leaves out grows as the square of the distance.
    return (a.position - b.position).length() * std::sqrt(allowed / wrong);
}

void IrradianceCache::end_at(Stored& r, float good) const {
    if (!(good < error_ * r.distance)) return;
    r.distance = good / error_;
    update_radius(r);
}

void IrradianceCache::index(std::uint32_t i) {
    const Stored& r = records_[i];
    const int level = level_of(r.reach);
    lowest_level_ = records_.size() == 1 ? level : std::min(lowest_level_, level);
    highest_level_ = std::max(records_.size() == 1 ? level : highest_level_, level);
    for_cells(r.position, r.reach, level, [&](const CellIndex& c) { cells_[key(c, level)].push_back(i); });
    for (int l = level; l < level + kLevelsOfStanding; ++l) standing_[key(cell_at(r.position, l), l)].push_back(i);
}

std::size_t IrradianceCache::bytes() const {
    using Bucket = std::pair<Grid::value_type, std::uint64_t>; // with how far from its place it stands
    std::size_t sum = records_.capacity() * sizeof(Stored);
    for (const Grid* grid : {&cells_, &standing_}) {
        sum += grid->bucket_count() * sizeof(Bucket);
        for (const auto& [k, cell] : *grid) sum += cell.capacity() * sizeof(std::uint32_t);
    }
    return sum;
}

} // namespace keyhole
