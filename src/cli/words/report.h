// What a render says at its end, in words and as JSON.
#pragma once

#include "core/render_stats.h"

#include <nlohmann/json.hpp>

#include <string>

namespace keyhole {

/// On stderr, a line each.
void print_warnings(const RenderStats& stats);

/// Stages, photons and the ledger of proposals, as tables on stderr.
void print_report(const RenderStats& stats);

/// Statistics of a render: keys are the members' names; numbers that are not finite become null.
nlohmann::ordered_json stats_json(const RenderStats& stats);

/// JSON for people. Files may have names, and hold words, that are not UTF-8: what isn't is replaced.
template <class Json> std::string json_text(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}
/// The same in one line, for programs.
template <class Json> std::string json_line(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace keyhole
