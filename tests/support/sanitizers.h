// Whether a sanitizer watches, for tests of time and memory.
#pragma once

namespace keyhole::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
/// So many times as long does what is watched take.
inline constexpr double kSlowdown = kSanitized ? 20 : 1;

} // namespace keyhole::test
