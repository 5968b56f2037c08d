// How layers are named among the channels of an OpenEXR file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// The channels of a layer of `channels` channels, in order; empty for a number that has no names.
std::vector<std::string> exr_channel_names(const std::string& layer, int channels);

/// The layer that a channel of a file belongs to: what stands before the last dot; "beauty" for R, G, B, A and Y
/// without one, the name itself for other channels without one.
std::string exr_layer_of(const std::string& channel);

/// Sorts channels of one layer as they are stored in an Image: R, G, B, A or X, Y, Z; others by name.
void sort_exr_channels(std::vector<std::string>& channels);

/// The channel of word `w` of sums (Picture::sums), whether a channel is one, and of which kind.
std::string exr_sum_name(const std::string& kind, int w);
bool is_exr_sum(std::string_view channel);
std::string exr_sum_kind(const std::string& channel);

} // namespace keyhole
