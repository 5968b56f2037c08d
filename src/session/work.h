// The loop over units of work that all methods share.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "core/work_item_set.h"
#include "film/accumulation_buffer.h"
#include "scene/camera.h"
#include "session/work_partition.h"

#include <chrono>
#include <optional>
#include <vector>

namespace keyhole {

/// How far the mean over passes still is from where it goes. Watches a picture from pass to pass and estimates the
/// noise of the mean from how the passes differ: they are independent. What all of them share, such as the bias of a
/// lookup's radius, it can't see.
class PassError {
  public:
    /// To be called after each pass, with the mean over all so far.
    void add(const AccumulationBuffer& mean);

    std::int64_t passes() const { return passes_; }

    /// Root of the mean over pixels of var(mean) / (mean^2 + 0.01 Mean^2), on luminance, `Mean` that of the picture:
    /// the root of what `keyhole diff` calls relmse. Infinite before the second pass.
    double relative() const;

    /// What is known by pixel, as it stands in memory, and back. `passes`: calls of add() until then.
    AccumulatorState words() const;
    void set_words(const AccumulatorState& words, std::int64_t passes);

  private:
    struct Pixel {
        double mean = 0, m2 = 0;
    };
    std::vector<Pixel> pixels_;
    std::int64_t passes_ = 0;
};

/// The warning where a stop came before anything was done beyond a checkpoint.
inline constexpr const char* kNothingAdded = "stopped before a unit of work was whole: the checkpoint is as it was";

/// Hands out units of work, adds up what they gather, and saves it now and then.
///
///     while (const auto unit = work.take(context)) { ...; work.unit().film->add(...); work.end_unit(stats); }
///     result.picture = work.finish(stats);
class Work {
  public:
    /// What a process does before its first unit of a pass. Where that costs more than a unit, processes take whole
    /// passes, as long as there are enough for all of them.
    enum class PassStart { free, costly };
    /// @param units_per_pass units that settings.passes counts as one.
    /// @throws InputError for a `share.done` that isn't of this render.
    Work(const Settings& settings, const ImageWindow& window, AccumulationBuffer::Parts parts,
         const WorkPartition& share, std::int64_t units_per_pass, PassStart start);

    /// The next unit to do; none: all are done, the error is small enough, or it is time to stop and there is something
    /// to show.
    std::optional<std::int64_t> take(const RunContext& context);
    std::int64_t pass_of(std::int64_t unit) const { return unit / per_pass_; }
    /// Those that do a pass together; null: each does its own.
    Communicator* communicator() const { return communicator_; }
    /// The first pass from `pass` on of which units were left to do when the render began; none: all were done.
    std::optional<std::int64_t> pass_from(std::int64_t pass) const;
    /// Where the unit under way goes.
    AccumulationBuffer& unit() { return pending_ ? *pending_ : total_; }
    /// Which of the picture's halves it belongs to.
    Half half() const { return half_of(under_way_); }
    /// The unit is whole. What of one is in unit() when work ends counts for the picture, but isn't saved.
    void end_unit(const RenderStats& stats);
    /// Units of the share that are left, for a display of progress; 0 where there is no end.
    std::int64_t left() const;
    /// Whether no unit is whole yet: one that is cut short is better than nothing then.
    bool is_first() const { return done_.empty(); }
    /// Whether units are kept for who goes on, or for who joins them: those that are cut short must not be among them.
    bool keeps_units() const { return pending_.has_value(); }
    /// Whole ones that are done.
    std::int64_t passes() const { return done_.size() / per_pass_; }

    /// The picture. Puts passes, their error, pixels without samples, dropped samples and whether all of the share was
    /// done into `stats`, and the warnings of the part that was done before.
    Picture finish(RenderStats& stats);

  private:
    void load(const Picture& done);
    Picture snapshot(const RenderStats& stats) const;
    bool enough() const;
    double samples() const; // as RenderStats::samples

    Settings settings_;
    WorkPartition share_;
    std::int64_t per_pass_, begin_, end_; // in units
    std::int64_t per_number_ = 1;         // units that a number stands for
    Communicator* communicator_ = nullptr;
    std::optional<std::int64_t> number_; // taken last
    AccumulationBuffer total_;
    std::optional<AccumulationBuffer> pending_; // where sums must not have a part of a unit in them
    WorkItemSet before_, done_;                 // what was done elsewhere; all that is
    std::int64_t taken_ = 0, under_way_ = 0;
    PassError error_;
    bool knows_error_ = true; // not once parts were joined
    std::vector<std::string> old_warnings_;
    std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
};

} // namespace keyhole
