// Settings from text: the `render:` section of scene files, and `key=value` of the command line.
#pragma once

#include "core/settings.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace keyhole {

/// The bounds of a setting, "1 to 126", as one would write them: those of memory in KiB, MiB or GiB.
std::string bounds_text(std::int64_t minimum, std::int64_t maximum);
std::string bounds_text(double minimum, double maximum);

/// Why a setting was refused.
struct SettingError {
    bool in_key; ///< the key is at fault, else the value
    std::string message;
};

/// Sets one setting, checked against visit_settings(). Whole numbers may be written 1e6 or with k, M or G for powers of
/// a thousand (kB, MB or GB for bytes), KiB, MiB or GiB for powers of 1024. Leaves `settings` as they are on an error.
/// @param warning is written where the key is an old name; may be null.
std::optional<SettingError> set_setting(Settings& settings, const std::string& key, const std::string& value,
                                        std::string* warning = nullptr);

/// Applies one `key=value`. @throws InputError with what was found and what was expected.
/// @param warnings receives those of old names; may be null.
void apply_override(Settings& settings, const std::string& key_equals_value,
                    std::vector<std::string>* warnings = nullptr);

} // namespace keyhole
