#!/usr/bin/env bash
# build.sh TARGET...: installs what is missing and builds the targets with the preset $KEYHOLE_PRESET (default: release).
# Everything it says goes to stderr; if nothing is to be done it says nothing.
set -euo pipefail

root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
preset=${KEYHOLE_PRESET:-release}
build=$root/build
[[ $preset == release ]] || build=$root/build-$preset

"$root/scripts/install_dependencies.sh" >&2
if [[ -f $build/built-$1 ]]; then
    # Ninja says that there is nothing to do even when told to be quiet.
    make() { cmake --build "$build" --target "$@" -- --quiet | sed '/^ninja: no work to do\.$/d'; }
else
    echo "Building Keyhole in $build; this takes a few minutes, once" >&2
    make() { cmake --build "$build" --target "$@"; }
fi
if [[ ! -f $build/build.ninja ]]; then
    (cd "$root" && cmake --preset "$preset" --log-level=WARNING) >&2
fi
make "$@" >&2
touch "$build/built-$1"
