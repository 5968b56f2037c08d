// Emitters in scene files.
#pragma once

#include "scene/emitter.h"
#include "scene/load/yaml_tree.h"

namespace keyhole {

/// Reads an item of an `emitters:` section. Null for one that is black.
/// @throws InputError for mistakes, with their positions.
std::unique_ptr<Emitter> read_emitter(const YamlNode& node);

} // namespace keyhole
