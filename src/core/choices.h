// Settings that are one of a few words. An enum has, beside its definition, words_of(): a word for each of its values
// in their order. Scene files, the command line and reports use the words, everything else the values.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <type_traits>

namespace keyhole {

template <class E>
concept Choice = std::is_enum_v<E> && requires(E e) {
    words_of(e);
};

template <Choice E> constexpr std::string_view word_of(E value) {
    return words_of(value)[static_cast<std::size_t>(value)];
}

/// The value that a word stands for; none: it is no word for any.
template <Choice E> constexpr std::optional<E> choice_of(std::string_view word) {
    const auto words = words_of(E{});
    const auto found = std::ranges::find(words, word);
    return found == words.end() ? std::nullopt : std::optional(static_cast<E>(found - words.begin()));
}

/// What is left out of a render.
enum class Plan {
    fitting, ///< maps, proposals and stages that the scene has no use for
    all,     ///< nothing
};
constexpr auto words_of(Plan) { return std::to_array<std::string_view>({"auto", "all"}); }

enum class FilterShape { gaussian, box, triangle };
constexpr auto words_of(FilterShape) { return std::to_array<std::string_view>({"gaussian", "box", "triangle"}); }

/// How the camera sub-path is taken out of a photon's power; docs/photon-maps.md compares them.
enum class PowerRule {
    marginal,   ///< divided by the importance map's E: consistent, and every photon weighs the same where it is asked;
                ///< `reciprocal` where importons are too few to say, or where some may lie behind a wall:
                ///< 1 / E would have a heavy tail
    reciprocal, ///< weighed by a density of camera sub-paths, normalised by drawing them until one is valid: unbiased,
                ///< but for places that so few leave that drawing is given up
    literal,    ///< MPS 3.2 to the letter, brought to the right total: for comparison only
};
constexpr auto words_of(PowerRule) { return std::to_array<std::string_view>({"marginal", "reciprocal", "literal"}); }

/// Paths that the chains of mps sample.
enum class SampledPaths {
    stored, ///< those that store a photon
    all,
};
constexpr auto words_of(SampledPaths) { return std::to_array<std::string_view>({"stored", "all"}); }

/// How techniques that make the same path share it (Veach 1997, section 9.2).
enum class MisHeuristic { balance, power, maximum };
constexpr auto words_of(MisHeuristic) { return std::to_array<std::string_view>({"balance", "power", "maximum"}); }

/// How pssmlt makes a path of a point in primary sample space.
enum class PathBuilderKind { path, endpoints, bidirectional };
constexpr auto words_of(PathBuilderKind) {
    return std::to_array<std::string_view>({"path", "endpoints", "bidirectional"});
}

/// Treatment of failed proposals in primary sample space, those of target 0.
enum class Failures {
    exclude, ///< left out of the chain, as published (Zeng and Wei 2019). The stationary density becomes target times
             ///< the probability that a proposal succeeds: biased where that depends on the state
    reject,  ///< the chain stays where it is: plain Metropolis-Hastings
    exclude_large, ///< only large steps are left out. They succeed with the same probability from every state: exact
    delay,         ///< a second proposal before the chain stays: delayed rejection (Tierney and Mira 1999). Exact
};
constexpr auto words_of(Failures) {
    return std::to_array<std::string_view>({"exclude", "reject", "exclude_large", "delay"});
}

/// What is filtered of the picture, once it is rendered.
enum class Denoise {
    png, ///< what is looked at
    exr, ///< the EXR's R, G, B, too
    off, ///< nothing
};
constexpr auto words_of(Denoise) { return std::to_array<std::string_view>({"png", "exr", "off"}); }

} // namespace keyhole
