// Settings as the command line gives them.
#pragma once

#include "scene/load/yaml/settings_text.h"

#include <sstream>
#include <string>

namespace keyhole::test {

/// `settings` with what `words` say: "spp=2 mutations=30k".
inline Settings settings_from(const std::string& words, Settings settings = {}) {
    std::istringstream text(words);
    for (std::string word; text >> word;) apply_override(settings, word);
    return settings;
}

} // namespace keyhole::test
