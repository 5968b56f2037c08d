// Primary sample space: the random numbers that make a path are the state of a chain (Kelemen, Szirmay-Kalos, Antal and
// Csonka 2002).
#pragma once

#include "core/rng.h"

#include <cmath>
#include <vector>

namespace keyhole {

/// How a candidate differs from the state.
enum class Step {
    small,   ///< every coordinate moves a little
    large,   ///< every coordinate is drawn anew: a sample that does not depend on the state
    delayed, ///< a small step away from a candidate that failed, mostly back towards the state
    stay,    ///< no coordinate moves
};

/// Kelemen's small step: a distance between 1/1024 and 1/64 to either side, its logarithm uniform; coordinates wrap.
class SmallStep {
  public:
    /// The step of a number in [0,1): half of them go each way.
    explicit SmallStep(double u) : forward_(u < 0.5), exponent_(2 * u - (u < 0.5 ? 0 : 1)) {}

    double distance() const {
        const double root = inverse_exp2(exponent_), square = root * root; // kOctaves is 4
        return (forward_ ? kLongest : -kLongest) * (square * square);
    }
    /// The step with the same sign whose logarithm is shifted by `shift` of its range, wrapping around in it. A shift
    /// and its negative undo each other, and a uniform exponent stays uniform.
    SmallStep shifted(double shift) const {
        SmallStep s = *this;
        s.exponent_ += shift;
        s.exponent_ -= std::floor(s.exponent_);
        return s;
    }

    static constexpr double kLongest = 1.0 / 64;
    static constexpr double kOctaves = 4; ///< down to 1/1024

  private:
    /// 2^-x on [0,1], within 2e-9 of itself and exact at both ends. Steps are symmetric whatever the function, so that
    /// nothing rests on its last digits; std::exp2() costs several times as much.
    static double inverse_exp2(double x) {
        constexpr double c0 = -0.1931470559801298, c1 = 0.04707718642286481, c2 = -0.008412958562425854,
                         c3 = 0.001164919420027142, c4 = -0.00010857510041638492;
        const double x2 = x * x, correction = (c0 + c1 * x) + x2 * ((c2 + c3 * x) + x2 * c4);
        return 1 - x / 2 + (x - x2) * correction;
    }

    bool forward_;
    double exponent_;
};

/// Brings a number back into [0,1).
inline double wrap(double x) {
    x -= std::floor(x);
    return x < 1 ? x : 0.0;
}

/// What the streams of one state share: time, counted in accepted candidates, and the kind of candidate in the making.
struct PrimaryClock {
    std::uint64_t now = 0, last_large = 0;
    std::uint64_t attempt = 0; ///< of a candidate; a delayed one belongs to the same
    Step step = Step::large;
    bool after_large = false; ///< a delayed step follows a large one that failed
};

/// One run of coordinates, in the order in which a path builder asks for them: eye and light have one each. Coordinates
/// come into being when they are first asked for; small steps that one missed are made up for when it is asked again.
class PrimaryStream final : public SampleSource {
  public:
    PrimaryStream(PrimaryClock& clock, Rng& rng) : clock_(&clock), rng_(&rng) {}

    /// The candidate's next coordinate.
    double next() override {
        double u;
        fill({&u, 1});
        return u;
    }
    void fill(std::span<double> numbers) override;
    /// From here on next() makes a candidate by clock.step.
    void rewind() { used_ = 0; }
    /// The candidate's coordinates become the state's. The clock goes on afterwards, for all streams at once.
    void accept();
    /// Coordinates that the candidate asked for.
    std::size_t used() const { return used_; }
    /// The state's coordinate i.
    double value(std::size_t i);
    /// Sets the state's coordinate i.
    void set(std::size_t i, double value);
    /// Appends a coordinate to the state.
    void push(double value) { coordinates_.push_back({value, 0, 0, 0, clock_->now}); }

  private:
    struct Coordinate {
        double value;          ///< of the state
        double candidate;      ///< of the candidate
        std::uint64_t attempt; ///< for which `first` was drawn
        double first;          ///< the number of the first try's SmallStep
        std::uint64_t moved;   ///< when value was up to date
    };
    void bring_up_to_date(Coordinate& c) {
        if (c.moved != clock_->now) make_up_for_steps(c);
    }
    void make_up_for_steps(Coordinate& c);
    double small(Coordinate& c);
    double delayed(Coordinate& c);
    double candidate(Coordinate& c);

    PrimaryClock* clock_;
    Rng* rng_;
    std::vector<Coordinate> coordinates_;
    std::size_t used_ = 0;
};

} // namespace keyhole
