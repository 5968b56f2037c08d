#!/usr/bin/env bash
# test.sh [--all] [CTEST ARGUMENT...]: sets Keyhole up if need be, and runs its tests, with --all those that render for
# long (tests/long_tests.cmake), too. For example: ./test.sh -L unit
# KEYHOLE_PRESET chooses how they are built: release (default), debug, asan, tsan.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")

chosen=(-LE -long)
if [ "${1:-}" = --all ]; then
    chosen=()
    shift
fi
"$root/scripts/build.sh" all
cd "$root"
exec ctest --preset "${KEYHOLE_PRESET:-release}" -j "$(nproc)" "${chosen[@]}" "$@"
