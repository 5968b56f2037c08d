// --resolution
#pragma once

#include "scene/camera.h"

#include <string>

namespace keyhole {

/// Sets the film's size from "WIDTHxHEIGHT". @throws InputError with what was found and what was expected.
void set_resolution(ImageWindow& window, const std::string& text);

} // namespace keyhole
