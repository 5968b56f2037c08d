#!/usr/bin/env bash
# build.sh TARGET...: installs what is missing and builds the targets with the preset $KEYHOLE_PRESET (default: release).
# Everything it says goes to stderr; if nothing is to be done it says nothing.
set -euo pipefail

root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
preset=${KEYHOLE_PRESET:-release}
build=$root/build
[[ $preset == release ]] || build=$root/build-$preset

"$root/scripts/install_dependencies.sh" >&2
quiet=(--quiet)
if [[ ! -f $build/built-$1 ]]; then
    echo "Building Keyhole in $build; this takes a few minutes, once" >&2
    quiet=()
fi
# A tree that was configured elsewhere, say on another machine's copy, is configured anew.
if [[ ! -f $build/build.ninja ]]; then
    (cd "$root" && cmake --preset "$preset" --log-level=WARNING) >&2
fi
cmake --build "$build" --target "$@" -- "${quiet[@]}" >&2
touch "$build/built-$1"
