// Random numbers: a source of numbers in [0,1), and the generator behind it.
#pragma once

#include <pcg_random.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace keyhole {

/// A stream of numbers in [0,1). Path builders draw from this, so that the same builder serves independent
/// sampling and primary sample space, where the numbers themselves are the state of a chain.
class SampleSource {
  public:
    virtual ~SampleSource() = default;

    /// The next number, uniform in [0,1) unless a chain says otherwise; never 1.
    virtual double next() = 0;

    /// The numbers that as many calls of next() would give: one call where several are needed at once.
    virtual void fill(std::span<double> numbers) {
        for (double& u : numbers) u = next();
    }
    template <std::size_t N> std::array<double, N> take() {
        std::array<double, N> numbers;
        fill(numbers);
        return numbers;
    }
};

/// What a random stream is for. Streams of different purposes never coincide, whatever their indices.
enum class StreamPurpose : std::uint64_t {
    path_tracing = 1,
    brightness,
    seed_choice,
    importance,
    chain,
    thinning,
    emission,
    gather,
    test,
    cache,
    irradiance,
    lattice,
    chain_points,
    primary_start = 101,
    primary_chain,
    failure_study,
    bidirectional,
    survey,
    hot_spots,
    coverage,
    coverage_trial,
    light_beyond_coverage,
    image_weight,
    proposal_tuning,
    learned_emission,
    learned_direct_light,
    openings,
    passages,
    guidance_gain,
    inspection,
    masks,
    sampling_density,
    lobe_techniques,
    each_emitter,
    emission_trial,
    scene_hash,
    filter,
    mirror_images,
};

/// PCG32 (O'Neill 2014). One for each chain and each pixel, never for each thread, so that a picture does not
/// depend on how work was divided.
class Rng : public SampleSource {
  public:
    Rng(std::uint64_t seed, StreamPurpose purpose, std::uint64_t index)
        : engine_(mix(seed, index), mix(index, static_cast<std::uint64_t>(purpose))) {}

    double next() final { return static_cast<double>(engine_()) * 0x1p-32; }
    void fill(std::span<double> numbers) final {
        for (double& u : numbers) u = Rng::next();
    }

    /// A point of the unit square, uniform and independent of all that this stream gave before. Streams that run side
    /// by side may spread theirs evenly among each other.
    virtual std::array<double, 2> next_point() {
        const double x = next();
        return {x, next()};
    }

    /// Uniform integer in [0, n); n > 0.
    std::uint32_t below(std::uint32_t n) { return engine_(n); }

  private:
    /// SplitMix64's finaliser over both words: neighbouring seeds and indices give unrelated streams.
    static std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
        std::uint64_t z = a * 0x9E3779B97F4A7C15ULL + b + 0x632BE59BD9B4E019ULL;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }

    pcg32 engine_;
};

} // namespace keyhole
