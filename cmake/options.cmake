# Build options, and the flags that every target of ours gets through keyhole_flags.
include(architecture)

option(KEYHOLE_TESTS "Build the tests" ON)
option(KEYHOLE_BENCHMARKS "Build the benchmarks (needs Google Benchmark)" OFF)
option(KEYHOLE_FUZZ "Build the fuzz targets (needs clang)" OFF)
option(KEYHOLE_UNITY "Compile the sources of a folder at once: all in half the time, one that changed in more" OFF)
option(KEYHOLE_WARNINGS_AS_ERRORS "Treat warnings as errors" OFF)
keyhole_detect_arch(detected)
set(KEYHOLE_ARCH "${detected}" CACHE STRING "Value of -march; empty: the compiler's default")
set(KEYHOLE_SANITIZE "" CACHE STRING "Sanitizers to build with, for example address,undefined")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

# No contraction: a fused multiply-add here and none there would make pictures depend on the compiler's mood.
add_library(keyhole_flags INTERFACE)
target_compile_options(keyhole_flags INTERFACE -Wall -Wextra -Wpedantic -fno-math-errno -ffp-contract=off)
if(KEYHOLE_WARNINGS_AS_ERRORS)
  target_compile_options(keyhole_flags INTERFACE -Werror)
endif()
if(KEYHOLE_ARCH)
  target_compile_options(keyhole_flags INTERFACE -march=${KEYHOLE_ARCH})
endif()
if(KEYHOLE_SANITIZE)
  # -fno-sanitize-recover: undefined behaviour ends a test instead of scrolling by.
  target_compile_options(keyhole_flags INTERFACE
    -fsanitize=${KEYHOLE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
  target_link_options(keyhole_flags INTERFACE -fsanitize=${KEYHOLE_SANITIZE})
endif()
if(KEYHOLE_FUZZ)
  target_compile_options(keyhole_flags INTERFACE -fsanitize=fuzzer-no-link) # lets the fuzzer see which code ran
endif()
