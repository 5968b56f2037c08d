#include "film/exr_names.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::string_view kSums = "sums.";

std::string_view last_part(std::string_view channel) {
    const auto dot = channel.rfind('.');
    return dot == std::string_view::npos ? channel : channel.substr(dot + 1);
}

std::string_view letters(const std::string& layer, int channels) {
    switch (channels) {
    case 1:
        return layer == "depth" ? "Z" : "Y";
    case 3:
        return layer == "normal" ? "XYZ" : "RGB";
    case 4:
        return "RGBA";
    default:
        return "";
    }
}

} // namespace

std::vector<std::string> exr_channel_names(const std::string& layer, int channels) {
    const std::string prefix = layer == "beauty" ? "" : layer + ".";
    std::vector<std::string> names;
    for (const char letter : letters(layer, channels)) names.push_back(prefix + letter);
    return names;
}

std::string exr_layer_of(const std::string& channel) {
    const auto dot = channel.rfind('.');
    if (dot != std::string::npos) return channel.substr(0, dot);
    return channel.size() == 1 && std::string_view("RGBAY").find(channel[0]) != std::string_view::npos ? "beauty"
                                                                                                       : channel;
}

void sort_exr_channels(std::vector<std::string>& channels) {
    constexpr std::string_view kOrder = "RGBAXYZ";
    std::ranges::sort(channels, {}, [&](const std::string& channel) {
        const std::string_view part = last_part(channel);
        return std::pair(part.size() == 1 ? kOrder.find(part[0]) : std::string_view::npos, channel);
    });
}

std::string exr_sum_name(const std::string& kind, int w) { return fmt::format("{}{}.{:03}", kSums, kind, w); }

bool is_exr_sum(std::string_view channel) { return channel.starts_with(kSums); }

std::string exr_sum_kind(const std::string& channel) {
    return channel.substr(kSums.size(), channel.rfind('.') - kSums.size());
}

} // namespace keyhole
