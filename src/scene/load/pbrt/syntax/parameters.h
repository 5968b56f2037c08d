// Typed access to the parameters of a directive.
#pragma once

#include "core/vec.h"
#include "scene/load/input.h"
#include "scene/load/pbrt/spectrum.h"
#include "scene/load/pbrt/syntax/directive.h"

#include <initializer_list>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole::pbrt {

/// Numbers allowed for a parameter, both ends included.
struct Bounds {
    constexpr Bounds(double least_allowed = -1e30, double most_allowed = 1e30)
        : least(least_allowed), most(most_allowed) {}
    constexpr Bounds(const NumberRange& range) : least(range.minimum), most(range.maximum) {}

    double least, most;
};
constexpr Bounds kPositive{1e-12, 1e12};

/// What the readers of all families need.
struct ReadContext {
    Warnings& warnings;
    std::string directory; ///< that paths are relative to

    std::string resolve(const std::string& path) const;
};

/// Parameters of one directive, with those that an `Attribute` set for its kind. All functions throw InputError, with
/// the position of the parameter, where it has another type or is out of range.
class Parameters {
  public:
    /// `inherited` may be null.
    Parameters(const Directive& directive, const std::vector<Parameter>* inherited, const ReadContext& context)
        : directive_(directive), inherited_(inherited), context_(context) {}

    const Directive& directive() const { return directive_; }
    const ReadContext& context() const { return context_; }

    /// Null where it is not given. The parameter counts as read.
    const Parameter* find(std::string_view name);
    /// Of one of these types.
    const Parameter* find(std::string_view name, std::initializer_list<std::string_view> types);
    bool has(std::string_view name) { return find(name) != nullptr; }

    double number(std::string_view name, double otherwise, const Bounds& bounds = {});
    std::int64_t integer(std::string_view name, std::int64_t otherwise, std::int64_t least, std::int64_t most);
    bool boolean(std::string_view name, bool otherwise);
    std::string string(std::string_view name, const std::string& otherwise);
    Imath::V3d point(std::string_view name, const Imath::V3d& otherwise);
    Rgb spectrum(std::string_view name, const Rgb& otherwise, ColorUse use);
    /// As many numbers as there are, in groups of `type`; empty where it is not given.
    std::vector<double> numbers(std::string_view name, std::initializer_list<std::string_view> types);

    /// Names that change nothing here, and are no mistake.
    void ignore(std::initializer_list<std::string_view> names);
    /// Warns of parameters that nothing read.
    void warn_of_the_rest();

    void warn(const std::string& kind, const std::string& message);
    [[noreturn]] void fail(const std::string& message) const { directive_.fail(message); }

  private:
    const Parameter& single(const Parameter& parameter, std::size_t values) const;

    const Directive& directive_;
    const std::vector<Parameter>* inherited_;
    const ReadContext& context_;
    std::set<std::string, std::less<>> known_;
};

} // namespace keyhole::pbrt
