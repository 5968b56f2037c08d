// Whether methods find the same light: small pictures by each of them, and one that the others are held against.
#pragma once

#include "core/settings.h"
#include "scene/scene.h"

#include <vector>

namespace keyhole::test {

/// `settings` by each of the methods.
std::vector<Settings> by_methods(const Settings& settings, const std::vector<const char*>& methods);

/// Renders 48 x 32 pixels of `scene` with each of `settings`, `runs` times, and expects what `reference` shows: no
/// block off by more than 3 % and chance, the whole by no more than 3 %.
void expect_same_light(Scene& scene, Settings reference, const std::vector<Settings>& settings, int runs);

} // namespace keyhole::test
