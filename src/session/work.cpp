#include "session/work.h"

#include "core/error.h"
#include "core/percent.h"
#include "film/image_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr const char* kUnits = "units";
constexpr const char* kWarnings = "warnings";
constexpr const char* kError = "error"; // sums that only a render that goes on reads

/// Fewer passes tell no error: what they differ in is chance.
constexpr std::int64_t kLeastPasses = 4;

/// Units in so many passes; as many as there are numbers if they don't fit.
std::int64_t units(std::int64_t passes, std::int64_t per_pass) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max() / 2;
    return passes > most / per_pass ? most : passes * per_pass;
}

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> found;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        found.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return found;
}

} // namespace

void PassError::add(const AccumulationBuffer& mean) {
    pixels_.resize(mean.pixels());
    ++passes_;
    const auto passes = static_cast<double>(passes_);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        // Welford 1962, by the mean: the pass that moved it from there to here was passes * (here - there) off.
        const double moved = mean.luminance(i) - p.mean;
        p.mean += moved;
        p.m2 += passes * (passes - 1) * moved * moved;
    }
}

double PassError::relative() const {
    if (passes_ < 2) return std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(pixels_.size()), passes = static_cast<double>(passes_);
    double picture = 0, sum = 0;
    for (const Pixel& p : pixels_) picture += p.mean / n;
    for (const Pixel& p : pixels_) {
        const double variance = p.m2 / (passes - 1) / passes;
        if (variance > 0) sum += variance / error_unit(p.mean, picture) / n;
    }
    return std::sqrt(sum);
}

AccumulatorState PassError::words() const { return accumulator_state(pixels_); }

void PassError::set_words(const AccumulatorState& words, std::int64_t passes) {
    pixels_.resize(words.data.size() * sizeof(std::uint32_t) / sizeof(Pixel));
    set_pixels(pixels_, words);
    passes_ = passes;
}

Work::Work(const Settings& settings, const ImageWindow& window, AccumulationBuffer::Parts parts,
           const WorkPartition& share, std::int64_t units_per_pass, PassStart start)
    : settings_(settings), share_(share), per_pass_(units_per_pass), begin_(units(share.first_pass, per_pass_)),
      end_(units(
          share.end_pass.value_or(settings.passes > 0 ? settings.passes : std::numeric_limits<std::int64_t>::max()),
          per_pass_)),
      total_(window.width, window.height, PixelFilter(settings), parts) {
    if (share_.keep_sums || share_.save) pending_.emplace(window.width, window.height, PixelFilter(settings), parts);
    if (share_.done != nullptr) load(*share_.done);
    knows_error_ = knows_error_ && !share_.take_number;
    if (start == PassStart::free) return;
    if ((end_ - begin_) / per_pass_ >= share_.processes)
        per_number_ = per_pass_;
    else
        communicator_ = share_.communicator;
}

std::optional<std::int64_t> Work::pass_from(std::int64_t pass) const {
    const std::int64_t from = std::max(begin_, pass * per_pass_);
    const std::int64_t unit = before_.missing(0, from);
    return unit < end_ ? std::optional(pass_of(unit)) : std::nullopt;
}

void Work::load(const Picture& done) {
    const auto text = done.metadata.find(kUnits);
    if (text == done.metadata.end()) throw InputError("found a picture without the sums that a render can go on from");
    before_ = WorkItemSet::parse(text->second);
    if (done.sums.empty()) return;
    done_ = before_;
    total_.set_sums(done.sums);
    const auto words = done.sums.find(kError);
    if (words != done.sums.end()) error_.set_words(words->second, done_.size() / per_pass_);
    knows_error_ = words != done.sums.end() || done_.size() < per_pass_;
    if (const auto old = done.metadata.find(kWarnings); old != done.metadata.end()) old_warnings_ = lines(old->second);
}

std::int64_t Work::left() const {
    if (settings_.passes == 0 && !share_.end_pass) return 0;
    std::int64_t done = 0;
    for (const WorkItemSet::Range& r : done_.ranges())
        done += std::max<std::int64_t>(0, std::min(r.end, end_) - std::max(r.begin, begin_));
    return end_ - begin_ - done;
}

bool Work::enough() const {
    return settings_.target_error > 0 && done_.size() % per_pass_ == 0 && passes() >= kLeastPasses &&
           error_.relative() <= settings_.target_error;
}

std::optional<std::int64_t> Work::take(const RunContext& context) {
    if ((context.stopped() && taken_ + done_.size() > 0) || enough()) return std::nullopt;
    const std::int64_t of_number = taken_ % per_number_;
    if (of_number == 0) number_ = share_.take_number ? share_.take_number() : taken_ / per_number_;
    if (!number_) return std::nullopt;
    const std::int64_t unit = before_.missing(*number_ * per_number_ + of_number, begin_);
    if (unit >= end_) return std::nullopt;
    ++taken_;
    under_way_ = unit;
    return unit;
}

void Work::end_unit(const RenderStats& stats) {
    done_.add(under_way_);
    if (pending_) {
        total_.merge(*pending_);
        pending_->clear();
    }
    if (settings_.passes != 1 && knows_error_ && done_.size() % per_pass_ == 0) error_.add(total_);
    const auto now = std::chrono::steady_clock::now();
    if (share_.save && std::chrono::duration<double>(now - saved_).count() >= share_.save_every) {
        share_.save(snapshot(stats));
        saved_ = std::chrono::steady_clock::now();
    }
    if (share_.look && share_.wants_look()) share_.look(total_.to_picture());
}

double Work::samples() const {
    if (total_.film) return total_.film->samples_per_pixel();
    return static_cast<double>(done_.size()) / static_cast<double>(per_pass_) *
           static_cast<double>(settings_.mutations) / static_cast<double>(total_.pixels());
}

Picture Work::snapshot(const RenderStats& stats) const {
    Picture picture = total_.to_picture();
    erase_noise_layers(picture); // it follows from the sums
    picture.sums = total_.sums();
    if (error_.passes() > 0 && knows_error_) picture.sums[kError] = error_.words();
    picture.metadata[kUnits] = done_.to_string();
    picture.metadata["units of all"] =
        settings_.passes > 0 ? fmt::format("{}", units(settings_.passes, per_pass_)) : "?";
    picture.metadata["samples"] = fmt::format("{}", samples());
    std::string& text = picture.metadata[kWarnings];
    for (const auto* warnings : {&old_warnings_, &stats.warnings})
        for (const std::string& w : *warnings) text += w + "\n";
    return picture;
}

Picture Work::finish(RenderStats& stats) {
    for (const std::string& w : old_warnings_)
        if (std::ranges::find(stats.warnings, w) == stats.warnings.end()) stats.warnings.push_back(w);
    old_warnings_.clear();
    // With a time or an error to go for, there is no number of passes that would be all of them.
    const bool open = settings_.passes == 0 || settings_.target_error > 0;
    const bool missed = settings_.target_error > 0 && !enough();
    stats.complete = open ? passes() > 0 && !missed : done_.missing(0, begin_) >= end_;
    stats.passes = passes();
    if (passes() > 1 && settings_.passes != 1 && knows_error_) stats.values["relative error"] = error_.relative();
    if (share_.save && done_.size() > 0) share_.save(snapshot(stats)); // nothing is not worth an older checkpoint
    if (share_.save && !share_.take_number && taken_ > 0 && done_.size() == before_.size())
        stats.warnings.emplace_back(
            done_.empty() ? "stopped before its first unit of work was whole: there is no checkpoint" : kNothingAdded);
    if (missed) // not in the checkpoint: who goes on may reach it
        stats.warnings.push_back(
            passes() < kLeastPasses
                ? fmt::format(
                      "found {} pass{}, expected {} at least: fewer don't tell whether the relative error is {}; a "
                      "smaller spp makes passes shorter",
                      passes(), passes() == 1 ? "" : "es", kLeastPasses, percent(settings_.target_error))
                : fmt::format("the relative error is {} after {} passes, not {} as was asked for",
                              knows_error_ ? percent(error_.relative()) : "unknown", passes(),
                              percent(settings_.target_error)));
    if (pending_ && !share_.keep_sums) total_.merge(*pending_);
    if (total_.film) total_.film->report(stats);
    stats.samples = samples();
    return share_.keep_sums ? snapshot(stats) : total_.to_picture();
}

} // namespace keyhole
