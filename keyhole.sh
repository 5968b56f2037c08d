#!/usr/bin/env bash
# keyhole.sh ARGUMENT...: sets Keyhole up if need be, and runs it. For example: ./keyhole.sh render scenes/box.yaml
# keyhole.sh blender ARGUMENT...: opens Blender, which is installed if need be, with Keyhole as a render engine.
set -euo pipefail
root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")

unset KEYHOLE_PRESET
"$root/scripts/build.sh" keyhole
if [[ ${1-} == blender ]]; then
    shift
    "$root/scripts/install_dependencies.sh" --blender >&2
    exec "$root/scripts/open_blender.sh" "$root/build/keyhole" "$@"
fi
exec "$root/build/keyhole" "$@"
