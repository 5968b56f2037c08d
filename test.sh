#!/usr/bin/env bash
# test.sh [CTEST ARGUMENT...]: sets Keyhole up if need be, and runs its tests. For example: ./test.sh -L unit
# KEYHOLE_PRESET chooses how they are built: release (default), debug, asan, tsan.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")

"$root/scripts/build.sh" all
cd "$root"
exec ctest --preset "${KEYHOLE_PRESET:-release}" -j "$(nproc)" "$@"
