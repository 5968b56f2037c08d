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

} // namespace keyhole
