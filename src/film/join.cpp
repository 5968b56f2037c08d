#include "film/join.h"

#include "core/error.h"
#include "core/work_item_set.h"
#include "film/accumulation_buffer.h"
#include "film/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <sstream>
#include <vector>

namespace keyhole {
namespace {

[[noreturn]] void refuse(const NamedPicture& p, const std::string& why) {
    throw InputError(fmt::format("{}: {}", p.name, why));
}

const std::string& attribute(const NamedPicture& p, const std::string& key) {
    const auto found = p.picture.metadata.find(key);
    if (found == p.picture.metadata.end())
        refuse(p, fmt::format("found no attribute '{}', expected a picture that this version of the "
                              "program wrote",
                              key));
    return found->second;
}

bool is_share(const NamedPicture& p) { return !p.picture.sums.empty(); }

/// Samples per pixel. A share may have none: its units may be groups of chains that no round of samples fell to.
double samples(const NamedPicture& p) {
    const std::string& text = attribute(p, "samples");
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || !(value >= 0) || !std::isfinite(value))
        refuse(p, fmt::format("found {} samples, expected a finite number that is not negative", text));
    return value;
}

AccumulationBuffer empty_buffer_for(const NamedPicture& p) {
    const auto& sums = p.picture.sums;
    const bool film = sums.contains("samples"), drawn = sums.contains("drawn");
    return {p.picture.width, p.picture.height, PixelFilter(),
            film && drawn ? AccumulationBuffer::Parts::both
            : film        ? AccumulationBuffer::Parts::film
                          : AccumulationBuffer::Parts::drawn};
}

void set_sums(AccumulationBuffer& buffer, const NamedPicture& p) {
    try {
        buffer.set_sums(p.picture.sums);
    } catch (const InputError& e) {
        refuse(p, e.what());
    }
}

/// Lines of both texts, each once.
std::string joined_lines(const std::string& a, const std::string& b) {
    std::string all = a;
    std::istringstream lines(b);
    for (std::string line; std::getline(lines, line);)
        if (("\n" + all).find("\n" + line + "\n") == std::string::npos) all += line + "\n";
    return all;
}

void check_same(const NamedPicture& a, const NamedPicture& b, const char* key) {
    if (attribute(a, key) != attribute(b, key))
        refuse(b, fmt::format("found another value of '{}' than that of {}: {} and {}", key, a.name, attribute(b, key),
                              attribute(a, key)));
}

/// Whatever else they differ in.
void check_same_scene(const NamedPicture& a, const NamedPicture& b) {
    for (const char* key : {"scene hash", "program"}) check_same(a, b, key);
}

/// Pictures of different seeds.
Picture average(const std::vector<NamedPicture>& pictures) {
    Picture result = pictures.front().picture;
    result.sums.clear();
    result.metadata.erase("units");
    double total = 0;
    std::string seeds, warnings;
    for (const NamedPicture& p : pictures) {
        if (samples(p) == 0) refuse(p, "found 0 samples, expected some");
        total += samples(p);
        try {
            blend(result, p.picture, samples(p) / total);
        } catch (const InputError& e) {
            refuse(p, e.what());
        }
        seeds += (seeds.empty() ? "" : ",") + attribute(p, "seed");
        if (const auto w = p.picture.metadata.find("warnings"); w != p.picture.metadata.end())
            warnings = joined_lines(warnings, w->second);
    }
    copy_masks(pictures.front().picture, result);
    result.metadata["seed"] = seeds;
    result.metadata["samples"] = fmt::format("{}", total);
    result.metadata["warnings"] = warnings;
    return result;
}

} // namespace

std::map<std::string, std::string> words_by_key(const std::string& text) {
    std::map<std::string, std::string> by_key;
    std::istringstream words(text);
    for (std::string word; words >> word;) by_key[word.substr(0, word.find('='))] = word;
    return by_key;
}

std::map<std::string, std::string> settings_of(const NamedPicture& p) { return words_by_key(attribute(p, "settings")); }

WorkItemSet units_of(const NamedPicture& p) {
    try {
        return WorkItemSet::parse(attribute(p, "units"));
    } catch (const InputError& e) {
        refuse(p, e.what());
    }
}

void check_same_render(const NamedPicture& a, const NamedPicture& b, SameRender same) {
    check_same_scene(a, b);
    if (same == SameRender::seed) check_same(a, b, "user paths"); // which change no expectation
    if (a.picture.width != b.picture.width || a.picture.height != b.picture.height)
        refuse(b, fmt::format("found {} x {} pixels, expected {} x {} as in {}", b.picture.width, b.picture.height,
                              a.picture.width, a.picture.height, a.name));
    std::set<std::string_view> free{"denoise", "noise_layers"}; // what is done with the picture afterwards
    if (same != SameRender::seed) {
        free.insert("seed");
        free.insert(kSettingsOfEffort.begin(), kSettingsOfEffort.end());
    }
    const auto of_a = settings_of(a), of_b = settings_of(b);
    for (const auto& [key, word] : of_a) {
        if (free.contains(key)) continue;
        const auto other = of_b.find(key);
        if (other == of_b.end() || other->second != word)
            refuse(b, fmt::format("found {}, expected {} as in {}", other == of_b.end() ? "no " + key : other->second,
                                  word, a.name));
    }
}

Picture join_shares(std::span<const NamedPicture> shares) {
    const NamedPicture& first = shares.front();
    AccumulationBuffer all = empty_buffer_for(first), one = empty_buffer_for(first);
    WorkItemSet units;
    double total = 0;
    std::string warnings;
    for (const NamedPicture& share : shares) {
        if (!is_share(share))
            refuse(share, fmt::format("found the seed {} again, expected another, or shares made with --pass-range",
                                      attribute(share, "seed")));
        check_same_render(first, share, SameRender::seed);
        if (!units.add(units_of(share)))
            refuse(share, fmt::format("found work that is in another of the pictures too: {} of {}",
                                      attribute(share, "units"), units.to_string()));
        set_sums(one, share);
        all.merge(one);
        total += samples(share);
        warnings = joined_lines(warnings, attribute(share, "warnings"));
    }
    Picture result = all.to_picture();
    result.sums = all.sums();
    copy_masks(first.picture, result);
    result.metadata = first.picture.metadata;
    result.metadata["samples"] = fmt::format("{}", total);
    result.metadata["units"] = units.to_string();
    result.metadata["warnings"] = warnings;
    const bool whole = units.to_string() == fmt::format("0:{}", attribute(first, "units of all"));
    result.metadata["complete"] = whole ? "yes" : "no";
    return result;
}

Picture join_pictures(std::span<const NamedPicture> pictures) {
    std::map<std::string, std::vector<NamedPicture>> by_seed;
    for (const NamedPicture& p : pictures) {
        check_same_scene(pictures.front(), p); // before the same seed is taken for a mistake
        by_seed[attribute(p, "seed")].push_back(p);
    }
    std::vector<NamedPicture> joined;
    for (const auto& [seed, group] : by_seed) {
        NamedPicture& one = joined.emplace_back(group.front());
        if (group.size() > 1 || is_share(one)) one.picture = join_shares(group);
        check_same_render(joined.front(), one, SameRender::method);
    }
    Picture result = joined.size() > 1 ? average(joined) : std::move(joined.front().picture);
    // A share that has all units is the render itself.
    if (result.metadata["complete"] == "yes") result.sums.clear();
    return result;
}

void blend(Picture& picture, const Picture& other, double weight) {
    for (auto& [name, image] : picture.layers) {
        const auto layer = other.layers.find(name);
        if (layer == other.layers.end() || layer->second.data.size() != image.data.size())
            throw InputError("found no layer '" + name + "'");
        std::ranges::transform(image.data, layer->second.data, image.data.begin(), [&](float a, float b) {
            return static_cast<float>(std::lerp(static_cast<double>(a), static_cast<double>(b), weight));
        });
    }
}

} // namespace keyhole
