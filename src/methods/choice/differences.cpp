#include "methods/choice/differences.h"

#include <fmt/format.h>

#include <vector>

namespace keyhole {

std::string differences(const Settings& a, Settings b) {
    b.seed = a.seed;
    const auto list = [](const Settings& s) {
        std::vector<std::string> texts;
        visit_settings(s, [&](const char* key, const auto& value, const auto&...) {
            texts.push_back(fmt::format(" {}={}", key, printable(value)));
        });
        return texts;
    };
    const std::vector<std::string> from = list(a), to = list(b);
    std::string text;
    for (std::size_t i = 0; i < to.size(); ++i)
        if (to[i] != from[i]) text += to[i];
    return text;
}

} // namespace keyhole
