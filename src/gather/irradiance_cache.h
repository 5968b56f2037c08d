// Irradiance at few places, interpolated between them (Ward, Rubinstein and Clear 1988; gradients: Ward and Heckbert
// 1992; neighbour clamping: Krivanek, Bouatouch, Pattanaik and Zara 2006).
#pragma once

#include "gather/hemisphere.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include <tsl/robin_map.h>

namespace keyhole {

/// A place whose irradiance is known.
struct IrradianceRecord {
    Vec3 position; ///< world space
    Vec3 normal;   ///< unit, on the side that light arrives at
    HemisphereEstimate light;
    float min_radius, max_radius; ///< bounds on how far it is used [m], 0 < min <= max
    /// The lower bound unless surfaces around are so near that it has to be less [m]: light that was found, which is
    /// noisy, doesn't shorten it further.
    float min_radius_by_light = 0;
};

/// A wall that stands on a surface, as seen from a place of that: what lies at an offset `d` from the place is behind
/// it where d . normal > distance.
struct Wall {
    Vec3 normal{0, 0, 0};                                    ///< unit; 0: there is none
    float distance = std::numeric_limits<float>::infinity(); ///< [m]
};
/// The first wall between a place, on the side of unit `normal`, and another one; none if they see each other.
using WallBetween = std::function<std::optional<Wall>(const Vec3& from, const Vec3& normal, const Vec3& to)>;

/// Records with an index. Filled by one thread; then immutable and thread-safe. The same records in the same order give
/// the same answers.
class IrradianceCache {
  public:
    /// Around a record there is no need of another one within `error` times its distance to surrounding surfaces
    /// (Ward's a). It is used `overlap` times as far, at least 1: records stand about a radius apart, so that several
    /// have a say everywhere and their noise averages out. Two of them may predict each other wrongly, beyond noise, by
    /// `doubt` times `error` of their light.
    explicit IrradianceCache(float error, float overlap = 2, float doubt = 1.0f / 3)
        : error_(error), overlap_(overlap), doubt_(doubt) {}

    /// Clamps the record's radius by its neighbours' and theirs by its: what one of them sees close by is close to the
    /// others, too, even where their rays missed it (neighbour clamping, Krivanek et al. 2006). Where one record's
    /// gradients contradict what another found by more than noise, both shrink until they agree; where something stands
    /// between them they end before it, whatever their lower bounds.
    void insert(const IrradianceRecord& record, const WallBetween& wall = {});

    /// Standard error of the light around each record, relative to that light: told by the others that have a say
    /// there. So it doesn't depend on the record's own light, which may be refined by it and stay right on average.
    std::vector<double> relative_noise() const;
    /// The same of all records together: a few percent, unless what lights them is so small that few of their rays meet
    /// it.
    double noise() const;

    /// Takes in what more rays found at record `i`: its light becomes a mean of both, in which `more` has the weight
    /// `share` in [0,1]. How far it is used stays as it is.
    void refine(std::size_t i, const HemisphereEstimate& more, double share);

    /// The irradiance that a neighbour's gradients predict at a record (Ward and Heckbert 1992).
    struct Prediction {
        std::uint32_t record;
        double weight;
        Rgb irradiance; ///< that it predicts there [W/m^2]
    };
    /// The predictions of all other records whose weight at record `i` is positive.
    std::vector<Prediction> others_at(std::uint32_t i) const;
    /// Takes `change` [W/m^2] into record `i`, whose gradients change in proportion. No channel becomes negative.
    void change(std::uint32_t i, const Rgb& change);

    struct Answer {
        Rgb irradiance{0.0}; ///< [W/m^2]
        double error = 0;    ///< standard error of its luminance by the rays that records had at first [W/m^2]
        bool known = false;  ///< whether any record had a say
    };
    /// @param longer by how many vertices the way from here to the eye is longer than a straight one: light that was
    ///     scattered too often to take it is left out
    Answer irradiance(const Vec3& position, const Vec3& normal, int longer = 0) const;

    /// Whether a place is covered by at least `share` by the records within whose radius it lies, those of which
    /// `sees(record)` says that they are in sight of it: each covers the place where it stands by 1, and nothing at its
    /// radius. `sees` is asked as seldom as possible.
    bool covers(const Vec3& position, const Vec3& normal, float share,
                const std::function<bool(const Vec3& record)>& sees) const;

    std::size_t size() const { return records_.size(); }
    std::size_t bytes() const;
    /// Power of the number of pixels that a picture's records are proportional to in number, as fill_cache() tells it.
    double growth() const { return growth_; }
    void set_growth(double growth) { growth_ = growth; }
    const Vec3& position(std::size_t i) const { return records_[i].position; }
    const Vec3& normal(std::size_t i) const { return records_[i].normal; }
    /// How far around record `i` there is no need of another one [m].
    float radius(std::size_t i) const { return records_[i].radius; }
    /// How far it is used [m].
    float reach(std::size_t i) const { return records_[i].reach; }
    Rgb light(std::size_t i) const {
        const Vec3& e = records_[i].irradiance;
        return {e.x, e.y, e.z};
    }
    /// Of the luminance of light(i), by all rays that it has [(W/m^2)^2].
    double variance(std::size_t i) const { return records_[i].variance_by_all; }

  private:
    /// What decides whether a record has a say comes first: most of those asked have none.
    struct Stored {
        Vec3 position, normal;
        float reach = 0;  ///< how far it is used [m]
        float radius = 0; ///< how far there is no need of another record [m]
        Vec3 irradiance;
        RgbGradient rotation, translation;
        float variance;        ///< of the luminance of `irradiance`, by the rays it had at first [(W/m^2)^2]
        float variance_by_all; ///< and by all of them
        float around;          ///< distance to surrounding surfaces, clamped by neighbours' [m]
        float distance;        ///< within which light changes by its own size, at most `around`; the same [m]
        float border = std::numeric_limits<float>::infinity(); ///< to where it ends unless its radius is larger [m]
        Wall wall;                                             ///< where it ends in any case
        float other_wall =
            std::numeric_limits<float>::infinity(); ///< and how far it is used for the sake of others [m]
        float min_radius, max_radius, min_radius_by_light;
        float held = 1; ///< factor of its translation gradient
        LongerWays reaching;
    };
    using Cell = std::vector<std::uint32_t>;
    struct HashOfCell {
        /// Fibonacci hashing, whose upper bits are the good ones (Knuth, The Art of Computer Programming 3, 6.4).
        std::size_t operator()(std::uint64_t key) const {
            const std::uint64_t product = key * 0x9E3779B97F4A7C15;
            return product ^ product >> 32;
        }
    };

    struct Sums;
    Sums sum_of_all() const;
    /// What record `r` counts at an offset `d` from it where the normal is `normal`, if it is used `as_far` [m].
    static float weight_of(const Stored& r, float as_far, const Vec3& d, const Vec3& normal);
    void update_radius(Stored& r) const;
    void clamp_with_neighbours(Stored& r);
    void end_where_wrong(Stored& r, const WallBetween& wall);
    void end_at_wall(Stored& r, const Stored& other, const WallBetween& wall) const;
    static float wrong_at(const Stored& r, const Stored& other);
    float good_between(const Stored& a, const Stored& b, float wrong) const;
    void end_at(Stored& r, float good) const;
    static Vec3 irradiance_at(const Stored& r, const Vec3& to, const Vec3& turn);
    void index(std::uint32_t i);
    /// Calls visit(record) for all whose reach may include `position`.
    template <class Visit> void visit_near(const Vec3& position, Visit&& visit) const;
    /// Calls visit(record) for all of shorter reach than `reach` that stand in a box which has those within it.
    template <class Visit> void visit_standing(const Vec3& position, float reach, Visit&& visit) const;

    float error_, overlap_, doubt_;
    double growth_ = 0;
    std::vector<Stored> records_;
    // Hashed grids for each power of two of the reach: a record is in all cells that its reach overlaps.
    using Grid = tsl::robin_map<std::uint64_t, Cell, HashOfCell>;
    Grid cells_;
    Grid standing_; // in those where it stands, of its own power of two and larger ones
    int lowest_level_ = 0, highest_level_ = -1;
};

} // namespace keyhole
