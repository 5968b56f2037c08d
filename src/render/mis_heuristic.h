// The word of the setting `mis`.
#pragma once

#include "sampling/bidirectional_joint.h"

#include <string_view>

namespace keyhole {

inline MisHeuristic mis_heuristic(std::string_view word) {
    return word == "balance" ? MisHeuristic::balance : word == "maximum" ? MisHeuristic::maximum : MisHeuristic::power;
}

} // namespace keyhole
