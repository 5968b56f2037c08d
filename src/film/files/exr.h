// Pictures as OpenEXR files.
#pragma once

#include "film/picture.h"

#include <map>
#include <string>

namespace keyhole {

/// Writes one part of 32-bit scan lines, ZIP compressed. The layer "beauty" becomes R, G, B, "alpha" A; others
/// `layer.R` and so on, "normal" `normal.X`, `.Y`, `.Z`, layers of one channel `depth.Z` and `layer.Y`. Metadata become
/// string attributes, sums channels of whole numbers `sums.KIND.NNN`. Layers have 1, 3 or 4 channels. Atomic: see
/// write_file_atomically().
/// @throws InputError with the path and the reason.
void write_exr(const std::string& path, const Picture& picture);

/// Reads the first part of any flat OpenEXR file back by the same names; numbers of any type become floats. The picture
/// is the file's data window, whatever its display window.
/// @throws InputError with the path and the reason.
Picture read_exr(const std::string& path);
/// Its metadata alone. @throws InputError as read_exr(), for what is no OpenEXR file.
std::map<std::string, std::string> read_exr_metadata(const std::string& path);

} // namespace keyhole
