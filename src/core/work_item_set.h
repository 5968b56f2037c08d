// Which of a render's units of work are done.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// A set of whole numbers from 0 on, as ranges.
class WorkItemSet {
  public:
    struct Range {
        std::int64_t begin, end; ///< half-open
    };

    WorkItemSet() = default;
    /// [begin, end)
    WorkItemSet(std::int64_t begin, std::int64_t end);
    /// Reads what to_string() wrote. @throws InputError
    static WorkItemSet parse(std::string_view text);

    /// "0:3,6:9" for {0, 1, 2, 6, 7, 8}.
    std::string to_string() const;

    void add(std::int64_t unit) { add(WorkItemSet(unit, unit + 1)); }
    /// Adds the units of another set. @returns false, and adds nothing, if they have one in common.
    bool add(const WorkItemSet& other);

    bool contains(std::int64_t unit) const;
    bool contains(const WorkItemSet& other) const;
    const std::vector<Range>& ranges() const { return ranges_; } ///< sorted, with gaps between them
    std::int64_t size() const;
    bool empty() const { return ranges_.empty(); }
    /// The number that is left out `k`-th (k from 0), counted from `begin`.
    std::int64_t missing(std::int64_t k, std::int64_t begin) const;

    bool operator==(const WorkItemSet& other) const { return to_string() == other.to_string(); }

  private:
    std::vector<Range> ranges_;
};

} // namespace keyhole
