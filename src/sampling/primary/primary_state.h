// A state of primary sample space with the path that it makes.
#pragma once

#include "sampling/primary/path_builder.h"
#include "sampling/primary/primary_vector.h"

#include <array>
#include <utility>

namespace keyhole {

/// The `Space` of PrimaryKernel. Refers to itself: neither copied nor moved.
class PrimaryState {
  public:
    /// `builder` and `rng` must outlive the state.
    PrimaryState(const PathBuilder& builder, Rng& rng)
        : builder_(&builder), streams_{PrimaryStream(clock_, rng), PrimaryStream(clock_, rng),
                                       PrimaryStream(clock_, rng)} {}
    PrimaryState(const PrimaryState&) = delete;
    PrimaryState& operator=(const PrimaryState&) = delete;

    /// The state becomes what `sources` make.
    void start(PrimarySources sources) {
        Recorder eye(sources.eye, streams_[0]), light(sources.light, streams_[1]), choice(sources.choice, streams_[2]);
        state_.clear();
        builder_->build({eye, light, choice}, state_);
    }

    double propose(Step step) {
        clock_.after_large = step == Step::second && clock_.step == Step::large;
        clock_.attempt += step == Step::second ? 0 : 1;
        clock_.step = step;
        for (PrimaryStream& s : streams_) s.rewind();
        candidate_.clear();
        builder_->build({streams_[0], streams_[1], streams_[2]}, candidate_);
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
    PrimarySources replay() {
        clock_.step = Step::stay;
        for (PrimaryStream& s : streams_) s.rewind();
        return {streams_[0], streams_[1], streams_[2]};
    }
    /// What the state's coordinates make, after some were set; the candidate.
    double rebuild() {
        candidate_.clear();
        builder_->build(replay(), candidate_);
        return candidate_.target();
    }
    /// The sample of rebuild() is the state's.
    void adopt() { std::swap(state_, candidate_); }

    PrimaryStream& eye() { return streams_[0]; }
    PrimaryStream& light() { return streams_[1]; }
    PrimaryStream& choice() { return streams_[2]; }

    double target() const { return state_.target(); }
    const PathSample& sample() const { return state_; }
    const PathSample& candidate() const { return candidate_; }
    /// Candidates with a value that was not a number.
    std::uint64_t broken() const { return broken_; }

  private:
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

    const PathBuilder* builder_;
    PrimaryClock clock_;
    std::array<PrimaryStream, 3> streams_; ///< eye, light, choice
    PathSample state_, candidate_;
    std::uint64_t broken_ = 0;
};

} // namespace keyhole
