#include "core/work_item_set.h"

#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace keyhole {
namespace {

[[noreturn]] void refuse(std::string_view text) {
    throw InputError(fmt::format("found '{}', expected ranges like 0:3,6:9", text));
}

std::int64_t number(std::string_view text, std::string_view whole) {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 0) refuse(whole);
    return value;
}

} // namespace

WorkItemSet::WorkItemSet(std::int64_t begin, std::int64_t end) {
    if (begin < end) ranges_.push_back({begin, end});
}

WorkItemSet WorkItemSet::parse(std::string_view text) {
    WorkItemSet set;
    for (std::string_view rest = text; !rest.empty();) {
        const auto comma = std::min(rest.find(','), rest.size());
        const std::string_view range = rest.substr(0, comma);
        const auto colon = range.find(':');
        if (colon == std::string_view::npos) refuse(text);
        const std::int64_t begin = number(range.substr(0, colon), text), end = number(range.substr(colon + 1), text);
        if (begin >= end || !set.add(WorkItemSet(begin, end))) refuse(text);
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return set;
}

std::string WorkItemSet::to_string() const {
    std::string text;
    for (const Range& r : ranges_) text += fmt::format("{}{}:{}", text.empty() ? "" : ",", r.begin, r.end);
    return text;
}

bool WorkItemSet::add(const WorkItemSet& other) {
    std::vector<Range> all = ranges_, joined;
    all.insert(all.end(), other.ranges_.begin(), other.ranges_.end());
    std::ranges::sort(all, {}, &Range::begin);
    for (const Range& r : all) {
        if (!joined.empty() && r.begin < joined.back().end) return false;
        if (!joined.empty() && r.begin == joined.back().end)
            joined.back().end = r.end;
        else
            joined.push_back(r);
    }
    ranges_ = std::move(joined);
    return true;
}

bool WorkItemSet::contains(std::int64_t unit) const {
    return std::ranges::any_of(ranges_, [=](const Range& r) { return r.begin <= unit && unit < r.end; });
}

bool WorkItemSet::contains(const WorkItemSet& other) const {
    // Ranges here have gaps between them, so one of there lies within one of here.
    return std::ranges::all_of(other.ranges_, [&](const Range& there) {
        return std::ranges::any_of(
            ranges_, [&](const Range& here) { return here.begin <= there.begin && there.end <= here.end; });
    });
}

std::int64_t WorkItemSet::size() const {
    std::int64_t n = 0;
    for (const Range& r : ranges_) n += r.end - r.begin;
    return n;
}

std::int64_t WorkItemSet::missing(std::int64_t k, std::int64_t begin) const {
    std::int64_t at = begin + k;
    for (const Range& r : ranges_) {
        if (r.end <= begin) continue;
        if (at < r.begin) break;
        at += r.end - std::max(r.begin, begin);
    }
    return at;
}

} // namespace keyhole
