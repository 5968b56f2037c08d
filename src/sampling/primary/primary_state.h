// A state of primary sample space with what it makes.
#pragma once

#include "sampling/primary/path_builder.h"
#include "sampling/primary/primary_vector.h"

#include <utility>

namespace keyhole {

/// The `Space` of PrimaryKernel over the numbers that a path builder draws. Candidates and the state leave their
/// sub-paths in different rooms of the thread. Refers to itself: neither copied nor moved.
class PrimaryState {
  public:
    /// `builder` and `rng` must outlive the state.
    PrimaryState(const PathBuilder& builder, Rng& rng)
        : builder_(&builder), eye_(clock_, rng), light_(clock_, rng), choice_(clock_, rng) {
        candidate_.set_room(1);
    }
    PrimaryState(const PrimaryState&) = delete;
    PrimaryState& operator=(const PrimaryState&) = delete;

    /// The state becomes what `sources` make.
    void start(PrimarySources sources) {
        state_.clear();
        Recorder eye(sources.eye, eye_), light(sources.light, light_), choice(sources.choice, choice_);
        builder_->build({eye, light, choice}, state_);
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
        for (PrimaryStream* s : {&eye_, &light_, &choice_}) s->accept();
        ++clock_.now;
        if (clock_.step == Step::large) clock_.last_large = clock_.now;
        adopt();
    }

    /// The coordinates of the state itself, from their start.
    PrimarySources replay() {
        clock_.step = Step::stay;
        return rewound();
    }
    /// What the state's coordinates make, after some were set; the candidate.
    double rebuild() {
        clock_.step = Step::stay;
        build_candidate();
        return candidate_.target();
    }
    /// The candidate, such as that of rebuild(), is the state's sample.
    void adopt() {
        std::swap(state_, candidate_);
        path_is_kept_ = true;
    }
    /// Whether the state's sub-paths are where its builder left them. False once other states had their turn.
    bool path_is_kept() const { return path_is_kept_; }
    void set_path_kept(bool kept) { path_is_kept_ = kept; }

    double target() const { return state_.target(); }
    const PathSample& sample() const { return state_; }
    const PathSample& candidate() const { return candidate_; }
    /// Candidates with a value that was not a number.
    std::uint64_t broken() const { return broken_; }

    PrimaryStream& eye() { return eye_; }
    PrimaryStream& light() { return light_; }
    PrimaryStream& choice() { return choice_; }

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

    PrimarySources rewound() {
        for (PrimaryStream* s : {&eye_, &light_, &choice_}) s->rewind();
        return {eye_, light_, choice_};
    }
    void build_candidate() {
        candidate_.clear();
        builder_->build(rewound(), candidate_);
    }

    const PathBuilder* builder_;
    PrimaryClock clock_;
    PrimaryStream eye_, light_, choice_;
    PathSample state_, candidate_;
    std::uint64_t broken_ = 0;
    bool path_is_kept_ = false;
};

} // namespace keyhole
