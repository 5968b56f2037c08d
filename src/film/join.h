// Several pictures of one scene made into one.
#pragma once

#include "core/work_item_set.h"
#include "film/picture.h"

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace keyhole {

/// Every layer of `picture` becomes (1 - weight) times itself plus `weight` times that of `other`, which has it in the
/// same size; layers that only `other` has are ignored.
/// @throws InputError that names a layer which `other` lacks.
void blend(Picture& picture, const Picture& other, double weight);

/// A picture as `keyhole render` wrote it, with the name that messages call it by.
struct NamedPicture {
    std::string name;
    Picture picture;
};

/// What follows from an effort: settings by which renders that end by time differ.
inline constexpr std::array<std::string_view, 11> kSettingsOfEffort{
    "passes",    "spp",         "photons",         "light_paths", "mutations", "brightness_samples",
    "importons", "cache_error", "cache_min_reach", "cache_rays",  "keep_spp"};

/// How alike two renders have to be: in all settings; in all but the seed and how many samples were taken.
enum class SameRender { seed, method };

/// Checks by their metadata that two pictures show the same scene, by the same program and settings; pictures of
/// other seeds may have had another effort, as those that end by time have.
/// @throws InputError that says what differs.
void check_same_render(const NamedPicture& a, const NamedPicture& b, SameRender same);

/// The words "key=value" of a text, by key.
std::map<std::string, std::string> words_by_key(const std::string& text);

/// The settings that a picture was rendered with: by key, each as "key=value". @throws InputError without them.
std::map<std::string, std::string> settings_of(const NamedPicture& p);

/// The units of work in a share. @throws InputError
WorkItemSet units_of(const NamedPicture& p);

/// The sum of shares of one render, a share itself. There is at least one.
/// @throws InputError for shares that don't belong together or overlap.
Picture join_shares(std::span<const NamedPicture> shares);

/// Joins shares of one render, those with the same seed, to what one run would have made, bit for bit: their sums add
/// up (see AccumulationBuffer). As long as some of it is missing the result is itself a share. Pictures of different
/// seeds are averaged with weights as their samples.
/// @throws InputError for pictures that don't belong together, shares that overlap, and a seed that comes twice.
Picture join_pictures(std::span<const NamedPicture> pictures);

} // namespace keyhole
