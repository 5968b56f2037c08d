// "Did you mean ...?" for words that are nearly right.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// "expected one of a, b, c", ending in "; did you mean 'b'?" if `word` is a near miss of one of `choices`: within a
/// third of its length, at least one edit. Edits insert, delete, replace a letter or exchange neighbours (Damerau
/// 1964).
std::string expected_one_of(std::string_view word, const std::vector<std::string_view>& choices);

} // namespace keyhole
