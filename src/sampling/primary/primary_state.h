// A state of primary sample space with what it makes.
#pragma once

#include "sampling/primary/path_builder.h"
#include "sampling/primary/primary_vector.h"

#include <array>
#include <utility>

namespace keyhole {

/// The `Space` of PrimaryKernel over the numbers that a `Builder` draws from its `Builder::Sources`, an aggregate of
/// references with
///     std::array<SampleSource*, N> all() const;
/// Builder::build(sources, sample) makes a `Builder::Sample` of them, which has a target. Refers to itself: neither
/// copied nor moved.
template <class Builder> class PrimaryStateOf {
  public:
    using Sources = typename Builder::Sources;
    using Sample = typename Builder::Sample;

    /// `builder` and `rng` must outlive the state.
    PrimaryStateOf(const Builder& builder, Rng& rng)
        : builder_(&builder), streams_(make_streams(clock_, rng, std::make_index_sequence<kStreams>())) {}
    PrimaryStateOf(const PrimaryStateOf&) = delete;
    PrimaryStateOf& operator=(const PrimaryStateOf&) = delete;

    /// The state becomes what `sources` make.
    void start(Sources sources) {
        state_.clear();
        start(sources.all(), std::make_index_sequence<kStreams>());
    }

    double propose(Step step) {
        clock_.after_large = step == Step::delayed && clock_.step == Step::large;
        clock_.attempt += step == Step::delayed ? 0 : 1;
        clock_.step = step;
        build_candidate();
        broken_ += candidate_.broken() ? 1 : 0;
        return candidate_.target();
    }

    void accept() {
        for (PrimaryStream& s : streams_) s.accept();
        ++clock_.now;
        if (clock_.step == Step::large) clock_.last_large = clock_.now;
        std::swap(state_, candidate_);
    }

    /// The coordinates of the state itself, from their start.
    Sources replay() {
        clock_.step = Step::stay;
        return rewound(std::make_index_sequence<kStreams>());
    }
    /// What the state's coordinates make, after some were set; the candidate.
    double rebuild() {
        clock_.step = Step::stay;
        build_candidate();
        return candidate_.target();
    }
    /// The sample of rebuild() is the state's.
    void adopt() { std::swap(state_, candidate_); }

    double target() const { return state_.target(); }
    const Sample& sample() const { return state_; }
    const Sample& candidate() const { return candidate_; }
    /// Candidates with a value that was not a number.
    std::uint64_t broken() const { return broken_; }

  protected:
    PrimaryStream& stream(std::size_t i) { return streams_[i]; }
    Sample& candidate_sample() { return candidate_; }

  private:
    static constexpr std::size_t kStreams = std::tuple_size_v<decltype(std::declval<Sources>().all())>;
    using Streams = std::array<PrimaryStream, kStreams>;

    /// Notes down what another source says.
    class Recorder final : public SampleSource {
      public:
        Recorder(SampleSource& from, PrimaryStream& to) : from_(&from), to_(&to) {}
        double next() override {
            const double u = from_->next();
            to_->push(u);
            return u;
        }

      private:
        SampleSource* from_;
        PrimaryStream* to_;
    };

    template <std::size_t... I> static Streams make_streams(PrimaryClock& clock, Rng& rng, std::index_sequence<I...>) {
        return {((void)I, PrimaryStream(clock, rng))...};
    }
    template <std::size_t... I> void start(const std::array<SampleSource*, kStreams>& from, std::index_sequence<I...>) {
        std::array<Recorder, kStreams> recorders{Recorder(*from[I], streams_[I])...};
        builder_->build(Sources{recorders[I]...}, state_);
    }
    template <std::size_t... I> Sources rewound(std::index_sequence<I...>) {
        for (PrimaryStream& s : streams_) s.rewind();
        return {streams_[I]...};
    }
    void build_candidate() {
        candidate_.clear();
        builder_->build(rewound(std::make_index_sequence<kStreams>()), candidate_);
    }

    const Builder* builder_;
    PrimaryClock clock_;
    Streams streams_;
    Sample state_, candidate_;
    std::uint64_t broken_ = 0;
};

/// Of whole paths. Candidates and the state leave their sub-paths in different rooms of the thread.
class PrimaryState final : public PrimaryStateOf<PathBuilder> {
  public:
    PrimaryState(const PathBuilder& builder, Rng& rng) : PrimaryStateOf(builder, rng) {
        candidate_sample().set_room(1);
    }

    void accept() {
        PrimaryStateOf::accept();
        path_is_kept_ = true;
    }
    void adopt() {
        PrimaryStateOf::adopt();
        path_is_kept_ = true;
    }
    /// Whether the state's sub-paths are where its builder left them. False once other states had their turn.
    bool path_is_kept() const { return path_is_kept_; }
    void set_path_kept(bool kept) { path_is_kept_ = kept; }

    PrimaryStream& eye() { return stream(0); }
    PrimaryStream& light() { return stream(1); }
    PrimaryStream& choice() { return stream(2); }

  private:
    bool path_is_kept_ = false;
};

} // namespace keyhole
